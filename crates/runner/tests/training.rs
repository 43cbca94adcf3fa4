//! Training on the real crane, small networks: repeats, resumes, survives being killed, and proves its limits.
#![expect(clippy::unwrap_used, reason = "helpers of tests are tests too")]

mod support;

use std::fs;
use std::process::{Command, Stdio};

use runner::config::ConfigSpec;
use runner::stage::Stage;
use serde_json::Value;
use support::learning::{runner, small_project, train};
use support::{Project, check_refusal, check_success};

/// Episodes of a small training; half of them is a whole number too.
const EPISODES: u64 = 12;

fn json(project: &Project, path: &str) -> Value {
    serde_json::from_str(&project.text(path)).unwrap()
}

#[test]
fn every_stage_trains_in_order_and_proves_its_limits() {
    let project = small_project();
    let report = check_success(&train(&project, &format!("--all --run a --episodes {EPISODES}")));
    for stage in Stage::ALL {
        assert!(report.contains(&format!("{stage}: ")), "{report}");
        let folder = format!("runs/a/{stage}");
        let metrics = project.text(&format!("{folder}/metrics.jsonl"));
        let records: Vec<Value> = metrics.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        assert_eq!(records.len() as u64, EPISODES);
        let last = records.last().unwrap();
        assert!(last["step"].as_u64().unwrap() > 100, "{last}");
        for loss in ["critic", "actor", "entropy_temperature", "mean_q", "entropy"] {
            assert!(last["losses"][loss].as_f64().unwrap().is_finite(), "{loss} in {last}");
        }
        let certificate = json(&project, &format!("{folder}/certificate.json"));
        assert_eq!(certificate["violations"]["reference"], 0, "{certificate}");
        assert_eq!(certificate["violations"]["actual"], 0, "{certificate}");
        for part in ["training", "evaluation"] {
            let part = &certificate[part];
            assert_eq!(part["empty_ranges"], 0);
            assert!(part["ranges"].as_u64().unwrap() > 100);
            for joint in ["lift_joint", "tilt_joint", "telescope_joint", "slew_joint", "wrist_pitch_joint"] {
                for motion in ["reference", "actual"] {
                    for quantity in ["position", "velocity", "acceleration", "jerk"] {
                        let margin = part["joints"][joint][motion][quantity].as_f64().unwrap();
                        assert!((0.0..=1.0).contains(&margin), "{joint} {motion} {quantity}: {margin}");
                    }
                }
            }
        }
        let resolved = ConfigSpec::read(&project.path(&format!("{folder}/config.ron"))).unwrap();
        assert_eq!(resolved, ConfigSpec::read(&project.path(runner::config::DEFAULT)).unwrap());
    }
}

#[test]
fn one_seed_is_one_training_and_another_is_another() {
    let project = small_project();
    for run in ["a --seed 3", "b --seed 3", "c --seed 4"] {
        check_success(&train(&project, &format!("--stage purple --run {run} --episodes {EPISODES}")));
    }
    for file in ["metrics.jsonl", "eval.json", "certificate.json", "checkpoints/latest", "checkpoints/best"] {
        let of = |run: &str| project.bytes(&format!("runs/{run}/purple/{file}"));
        assert!(of("a") == of("b"), "{file} differs between two runs with one seed");
        assert!(of("a") != of("c"), "{file} does not depend on the seed");
    }
}

#[test]
fn a_resumed_training_equals_one_that_never_stopped() {
    let project = small_project();
    check_success(&train(&project, &format!("--stage purple --run whole --episodes {EPISODES}")));
    check_success(&train(&project, &format!("--stage purple --run halves --episodes {}", EPISODES / 2)));
    let half = project.text("runs/halves/purple/metrics.jsonl");
    assert_eq!(half.lines().count() as u64, EPISODES / 2);
    check_success(&train(&project, &format!("--stage purple --run halves --resume --episodes {EPISODES}")));
    check_same_training(&project, "whole", "halves");
}

#[test]
fn the_episode_that_is_to_be_without_exploration_is_the_first_that_differs() {
    let project = small_project();
    for (run, every) in [("never", 0), ("sixth", 6)] {
        let mut config = ConfigSpec::read(&project.path(runner::config::DEFAULT)).unwrap();
        config.curriculum.noiseless_every = every;
        project.write("this.ron", config.to_ron().unwrap());
        check_success(&train(
            &project,
            &format!("--stage purple --run {run} --episodes 7 --config this.ron"),
        ));
    }
    let [never, sixth] =
        ["never", "sixth"].map(|run| project.text(&format!("runs/{run}/purple/metrics.jsonl")));
    let differing = never.lines().zip(sixth.lines()).position(|(never, sixth)| never != sixth);
    assert_eq!(differing, Some(5));
}

#[test]
fn a_killed_training_resumes_from_its_last_checkpoint() {
    let project = small_project();
    let episodes = 5 * EPISODES;
    check_success(&train(&project, &format!("--stage purple --run whole --episodes {episodes}")));
    let mut killed = runner()
        .args([
            "train",
            "--quiet",
            "--stage",
            "purple",
            "--run",
            "killed",
            "--episodes",
            &episodes.to_string(),
        ])
        .current_dir(project.path(""))
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    // Far enough that it learns; the episodes that follow are lost and come again.
    let metrics = project.path("runs/killed/purple/metrics.jsonl");
    let learns = || fs::read_to_string(&metrics).is_ok_and(|text| text.lines().count() as u64 >= EPISODES);
    while !learns() {
        assert!(killed.try_wait().unwrap().is_none(), "it ended before it was killed");
        std::thread::yield_now();
    }
    killed.kill().unwrap();
    killed.wait().unwrap();
    // What a kill in the middle of a write leaves.
    project.write("runs/killed/purple/checkpoints/latest.1.partial", b"half");
    fs::OpenOptions::new()
        .append(true)
        .open(&metrics)
        .and_then(|mut file| {
            use std::io::Write;
            file.write_all(b"{\"episode\":9")
        })
        .unwrap();
    check_success(&train(&project, &format!("--stage purple --run killed --resume --episodes {episodes}")));
    check_same_training(&project, "whole", "killed");
}

#[test]
#[cfg(unix)]
fn a_training_that_is_asked_to_stop_says_how_to_go_on_and_equals_one_that_never_stopped() {
    let project = small_project();
    let episodes = 5 * EPISODES;
    check_success(&train(&project, &format!("--stage purple --run whole --episodes {episodes}")));
    for signal in ["INT", "TERM"] {
        let arguments = format!("train --plain --stage purple --run {signal} --episodes 100000");
        let child = runner()
            .args(arguments.split(' '))
            .current_dir(project.path(""))
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let metrics = project.path(&format!("runs/{signal}/purple/metrics.jsonl"));
        while !fs::read_to_string(&metrics).is_ok_and(|text| text.lines().count() >= 3) {
            std::thread::yield_now();
        }
        let sent = Command::new("kill").args([&format!("-{signal}"), &child.id().to_string()]).status();
        assert!(sent.unwrap().success());
        let output = child.wait_with_output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(130), "{said}");
        let command = format!("cargo xtask train --stage purple --run {signal} --resume");
        assert!(said.lines().last().unwrap().ends_with(&command), "{said}");
        assert!(said.contains("least margin") && output.stdout.is_empty(), "{said}");
        assert!(!project.path(&format!("runs/{signal}/purple/eval.json")).exists());
        let stopped_after = fs::read_to_string(&metrics).unwrap().lines().count() as u64;
        assert!(stopped_after < episodes, "it went on for {stopped_after} episodes");
        let rest = format!("--stage purple --run {signal} --resume --episodes {episodes}");
        check_success(&train(&project, &rest));
        check_same_training(&project, "whole", signal);
    }
}

#[track_caller]
fn check_same_training(project: &Project, one: &str, other: &str) {
    let of = |run: &str, file: &str| project.bytes(&format!("runs/{run}/purple/{file}"));
    for file in ["metrics.jsonl", "eval.json", "certificate.json"] {
        let (one, other) = (of(one, file), of(other, file));
        assert_eq!(String::from_utf8(one).unwrap(), String::from_utf8(other).unwrap(), "{file}");
    }
    assert!(
        of(one, "checkpoints/latest") == of(other, "checkpoints/latest"),
        "weights, replay or random state"
    );
}

#[test]
fn an_evaluation_has_the_promised_keys_and_repeats() {
    let project = small_project();
    check_success(&train(&project, "--stage purple --run a --episodes 4"));
    let arguments = "eval --run a --stage purple --episodes 5 --seed 11 --json result.json";
    let printed = check_success(&project.run(runner(), arguments));
    assert_eq!(printed, project.text("result.json"));
    assert_eq!(
        printed,
        check_success(&project.run(runner(), arguments)),
        "the same episodes, the same result"
    );
    let result: Value = serde_json::from_str(&printed).unwrap();
    let keys = |value: &Value| value.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    let mut expected = vec![
        "episodes",
        "success_rate",
        "success_ci95",
        "not_reached",
        "time_to_reach_s",
        "tip_error_m",
        "violations",
        "worst_margin",
        "at_success",
        "tracking_error",
        "held_joint_tip_error_m",
        "intervention_rate",
        "saturation_rate",
        "failsafe_count",
    ];
    expected.sort_unstable();
    assert_eq!(keys(&result), expected);
    assert_eq!(keys(&result["time_to_reach_s"]), ["mean", "median", "p95"]);
    assert_eq!(keys(&result["tip_error_m"]), ["max", "mean"]);
    assert_eq!(keys(&result["at_success"]), ["tip_error_m", "tip_speed_m_s"]);
    assert_eq!(keys(&result["violations"]), ["actual", "reference"]);
    assert_eq!(keys(&result["worst_margin"]), ["acceleration", "jerk", "position", "velocity"]);
    assert_eq!(keys(&result["held_joint_tip_error_m"]), ["max"]);
    let tracking = &result["tracking_error"];
    assert_eq!(keys(tracking).len(), 7);
    assert_eq!(keys(&tracking["lift_joint"]), ["position_max", "velocity_max"]);
    assert_eq!(result["episodes"], 5);
    assert_eq!(
        result["violations"]["reference"].as_u64().unwrap()
            + result["violations"]["actual"].as_u64().unwrap(),
        0
    );
}

#[test]
fn a_stage_without_the_one_before_names_the_command_to_run_first() {
    let project = small_project();
    let refused = train(&project, "--stage yellow --run a");
    check_refusal(&refused, &["purple", "cargo xtask train --stage purple --run a"]);
    assert!(!project.path("runs").exists(), "nothing was begun");
    let refused = project.run(runner(), "eval --run a --stage purple");
    check_refusal(&refused, &["cargo xtask train --stage purple --run a"]);
    let refused = train(&project, "--stage purple --run a --resume");
    check_refusal(&refused, &["nothing to resume", "cargo xtask train --stage purple --run a"]);
}

#[test]
fn an_unknown_stage_is_answered_with_the_known_ones() {
    let refused = train(&small_project(), "--stage green");
    check_refusal(&refused, &["green", "purple, yellow and orange"]);
}

#[test]
fn a_finished_stage_is_not_overwritten() {
    let project = small_project();
    check_success(&train(&project, "--stage purple --run a --episodes 4"));
    let before = project.bytes("runs/a/purple/checkpoints/latest");
    check_refusal(&train(&project, "--stage purple --run a"), &["runs/a/purple", "--resume", "--run"]);
    assert!(before == project.bytes("runs/a/purple/checkpoints/latest"));
}

/// The default discount, and the default configuration with 0.9 in its place.
fn another_discount(project: &Project) -> (f64, String) {
    let own = ConfigSpec::read(&project.path(runner::config::DEFAULT)).unwrap().learner.spec().discount;
    let text = project.text(runner::config::DEFAULT).replace(&format!("discount: {own}"), "discount: 0.9");
    (own, text)
}

#[test]
fn a_run_is_not_resumed_with_another_configuration_or_seed() {
    let project = small_project();
    check_success(&train(&project, "--stage purple --run a --episodes 4"));
    let (own, other) = another_discount(&project);
    project.write("other.ron", other.replace("reach_distance: 0.05", "reach_distance: 0.06"));
    let refused = train(&project, "--stage purple --run a --resume --config other.ron");
    check_refusal(
        &refused,
        &[
            &format!("learner.discount: the run has {own}, wanted is 0.9;"),
            "task.reach_distance: the run has 0.05, wanted is 0.06",
        ],
    );
    let refused = train(&project, "--stage purple --run a --resume --seed 9");
    check_refusal(&refused, &["runs/a/purple", "seed: the run has 0, wanted is 9"]);
}

#[test]
fn a_run_is_not_resumed_with_a_crane_of_other_limits() {
    let project = small_project();
    check_success(&train(&project, "--stage purple --run a --episodes 4"));
    let (old, new) = ("effort: 95500.0", "effort: 95400.0");
    project.edit("assets/hiab/hiab.ron", old, new);
    for next in ["--stage purple --run a --resume --episodes 5", "--stage yellow --run a"] {
        check_refusal(&train(&project, next), &["runs/a/purple", "the limits of the crane changed"]);
    }
    project.edit("assets/hiab/hiab.ron", new, old);
    check_success(&train(&project, "--stage purple --run a --resume --episodes 5"));
}

#[test]
fn what_a_run_was_begun_with_may_be_given_again_and_goes_on_in_the_next_stage() {
    let project = small_project();
    project.write("mine.ron", another_discount(&project).1);
    let given = "--run a --seed 5 --config mine.ron";
    check_success(&train(&project, &format!("--stage purple {given} --episodes 4")));
    check_success(&train(&project, &format!("--stage purple {given} --resume --episodes 5")));
    // The default configuration has another seed and another discount; the run's own is taken.
    check_success(&train(&project, "--all --resume --run a --episodes 6"));
    for stage in Stage::ALL {
        let config = ConfigSpec::read(&project.path(&format!("runs/a/{stage}/config.ron"))).unwrap();
        assert_eq!((config.seed, config.learner.spec().discount), (5, 0.9), "{stage}");
    }
}

#[test]
fn a_damaged_checkpoint_is_refused_and_left_as_it_is() {
    let project = small_project();
    check_success(&train(&project, "--stage purple --run a --episodes 6"));
    let path = "runs/a/purple/checkpoints/latest";
    let whole = project.bytes(path);
    let metrics = project.bytes("runs/a/purple/metrics.jsonl");
    let flipped = |at: usize| {
        let mut bytes = whole.clone();
        bytes[at] ^= 1;
        bytes
    };
    let mut damaged: Vec<Vec<u8>> = [0, 4, 20, 300, whole.len() / 2, whole.len() - 1]
        .iter()
        .map(|&length| whole[..length].to_vec())
        .collect();
    damaged.extend([0, 9, 25, 400, whole.len() / 2, whole.len() - 1].map(flipped));
    damaged.push([whole.as_slice(), b"more"].concat());
    for bytes in damaged {
        project.write(path, &bytes);
        check_refusal(
            &train(&project, "--stage purple --run a --resume --episodes 8"),
            &["checkpoint", path],
        );
        assert!(project.bytes(path) == bytes && project.bytes("runs/a/purple/metrics.jsonl") == metrics);
    }
    project.write(path, &whole);
    check_success(&train(&project, "--stage purple --run a --resume --episodes 8"));
}

#[test]
#[cfg(unix)]
fn a_disk_that_takes_no_more_leaves_the_old_checkpoint_whole() {
    let project = small_project();
    check_success(&train(&project, "--stage purple --run a --episodes 4"));
    let before = project.bytes("runs/a/purple/checkpoints/latest");
    // No file may grow beyond 32 blocks of 512 bytes: every write of a checkpoint fails in its middle.
    let limited = format!(
        "trap '' XFSZ; ulimit -f 32; exec {} train --quiet --stage purple --run a --resume --episodes 8",
        env!("CARGO_BIN_EXE_runner")
    );
    let refused = Command::new("sh").args(["-c", &limited]).current_dir(project.path("")).output().unwrap();
    check_refusal(&refused, &["cannot write", "runs/a/purple/checkpoints", "as it was"]);
    assert!(project.bytes("runs/a/purple/checkpoints/latest") == before);
    let names = fs::read_dir(project.path("runs/a/purple/checkpoints")).unwrap();
    let mut names: Vec<String> =
        names.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    assert_eq!(names, ["best", "latest"], "no part of a file is left");
    check_success(&train(&project, "--stage purple --run a --resume --episodes 8"));
}

#[test]
fn a_name_of_a_run_stays_below_runs() {
    let project = small_project();
    for name in ["../elsewhere", "a/b", ".hidden"] {
        check_refusal(&train(&project, &format!("--stage purple --run {name}")), &["--run", name]);
    }
}
