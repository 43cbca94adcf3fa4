//! A trained policy as a file: what it holds, that it is what was evaluated, and what is refused.
#![expect(clippy::unwrap_used, reason = "helpers of tests are tests too")]

mod support;

use std::fs;

use serde_json::Value;
use support::learning::{runner, small_project, train};
use support::{Project, check_refusal, check_success};

const FILE: &str = "runs/a/purple/purple.policy";

/// Bytes before the header: magic, version, length, checksum.
const FRAME: usize = 24;

fn trained_project() -> Project {
    let project = small_project();
    check_success(&train(&project, "--stage purple --run a --seed 3 --episodes 6"));
    project
}

fn header(bytes: &[u8]) -> Value {
    let length = u64::from_le_bytes(bytes[12..20].try_into().unwrap()) as usize;
    serde_json::from_slice(&bytes[FRAME..FRAME + length]).unwrap()
}

#[test]
fn a_policy_holds_what_it_needs_to_be_used_judged_and_trained_again() {
    let project = trained_project();
    let bytes = project.bytes(FILE);
    assert!(bytes.len() < 40_000, "{} bytes", bytes.len());
    let header = header(&bytes);
    let json = |path: &str| -> Value { serde_json::from_str(&project.text(path)).unwrap() };
    assert_eq!(header["evaluation"], json("runs/a/purple/eval.json"));
    assert_eq!(header["certificate"], json("runs/a/purple/certificate.json"));
    assert_eq!(
        (&header["stage"], &header["seed"], &header["episodes"]),
        (&"purple".into(), &3.into(), &6.into())
    );
    assert_eq!(header["config"]["learner"]["hidden"], serde_json::json!([16, 16]));
    assert_eq!(header["scaling"]["scale"].as_array().unwrap().len(), 32);
    assert!(header["program"].as_str().unwrap().starts_with("runner "), "{}", header["program"]);
    check_success(&train(&project, "--stage purple --run b --seed 3 --episodes 6"));
    assert!(bytes == project.bytes("runs/b/purple/purple.policy"), "one seed, one file");
}

#[test]
fn an_evaluation_of_the_file_is_the_one_that_closed_the_stage_wherever_the_file_lies() {
    let project = trained_project();
    let closing = project.text("runs/a/purple/eval.json");
    fs::create_dir_all(project.path("assets/policies")).unwrap();
    fs::copy(project.path(FILE), project.path("assets/policies/purple.policy")).unwrap();
    let eval = |whose: &str| project.run(runner(), &format!("eval {whose} --stage purple --episodes 4"));
    for whose in ["--run a", "--policy purple", &format!("--policy {FILE}")] {
        assert_eq!(check_success(&eval(whose)), closing, "{whose}");
    }
    // The training's own checkpoints are not needed any more.
    fs::remove_dir_all(project.path("runs/a/purple/checkpoints")).unwrap();
    assert_eq!(check_success(&eval("--run a")), closing);
    // A policy may be judged in any region.
    let elsewhere = project.run(runner(), "eval --policy purple --stage orange --episodes 4");
    assert_ne!(check_success(&elsewhere), closing);
}

#[test]
fn an_episode_is_played_step_by_step_as_in_the_evaluation() {
    let project = trained_project();
    let printed = check_success(
        &project.run(runner(), &format!("play --policy {FILE} --episode 2 --json episode.json")),
    );
    let episode: Value = serde_json::from_str(&project.text("episode.json")).unwrap();
    let steps = episode["steps"].as_array().unwrap();
    assert_eq!((&episode["stage"], &episode["seed"]), (&"purple".into(), &3.into()));
    // Two lines of what it is, one empty; two of heads; the steps; one empty, and the result.
    assert_eq!(printed.lines().count(), 3 + 2 + steps.len() + 2, "{printed}");
    let result = &episode["result"];
    let last = printed.lines().last().unwrap();
    let word = if result["reached"] == true { "reached after" } else { "not reached after" };
    assert!(
        last.starts_with(word) && last.contains("violations of limits 0 (reference) and 0 (actual)"),
        "{last}"
    );
    let closing: Value = serde_json::from_str(&project.text("runs/a/purple/eval.json")).unwrap();
    let named = closing["not_reached"].as_array().unwrap();
    assert_eq!(named.contains(&2.into()), result["reached"] == false, "{named:?}");
    let sum: f64 = steps.iter().map(|step| step["reward"].as_f64().unwrap()).sum();
    assert!((sum - result["return"].as_f64().unwrap()).abs() < 1e-12, "{sum} against {result}");
    for step in steps {
        let of = |point: &Value| [0, 1, 2].map(|axis| point[axis].as_f64().unwrap());
        let (tip, target) = (of(&step["tip"]), of(&episode["target"]));
        let distance = tip.iter().zip(target).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        assert!((distance - step["distance"].as_f64().unwrap()).abs() < 1e-12, "{step}");
        assert_eq!(step["action"].as_array().unwrap().len(), 3);
    }
    // The actions that `record` keeps of the same episode are the same.
    check_success(&project.run(runner(), &format!("record --policy {FILE} --episode 2 --out recorded.ron")));
    let recorded = project.text("recorded.ron");
    for action in steps[steps.len() - 1]["action"].as_array().unwrap() {
        let action = action.as_f64().unwrap() as f32;
        assert!(recorded.contains(&ron::to_string(&action).unwrap()), "{action} is not in {recorded}");
    }
}

#[test]
fn a_policy_that_is_not_there_or_not_whole_is_refused() {
    let project = trained_project();
    let eval = |whose: &str| project.run(runner(), &format!("eval {whose} --stage purple --episodes 1"));
    fs::create_dir_all(project.path("assets/policies")).unwrap();
    fs::copy(project.path(FILE), project.path("assets/policies/mine.policy")).unwrap();
    check_refusal(&eval("--policy yours"), &["no policy is called 'yours'", "assets/policies holds mine"]);
    check_refusal(&eval("--policy gone.policy"), &["gone.policy does not exist"]);
    check_refusal(&eval("--policy mine --run a"), &["either --run NAME or --policy"]);
    check_refusal(&eval("--run b"), &["cargo xtask train --stage purple --run b"]);
    let whole = project.bytes(FILE);
    let flipped = |at: usize| {
        let mut bytes = whole.clone();
        bytes[at] ^= 1;
        bytes
    };
    let changed = |at: usize, value: u8| {
        let mut bytes = whole.clone();
        bytes[at] = value;
        bytes
    };
    for (bytes, cause) in [
        (whole[..4].to_vec(), "cut"),
        (whole[..200].to_vec(), "cut"),
        (whole[..whole.len() - 1].to_vec(), "truncated"),
        (flipped(0), "this is no policy"),
        (changed(8, 200), "version 200 of the format"),
        (flipped(FRAME + 100), "checksum"),
        (flipped(whole.len() - 100), "checksum"),
        ([whole.as_slice(), b"more"].concat(), "what follows the policy"),
    ] {
        project.write("broken.policy", &bytes);
        check_refusal(&eval("--policy broken.policy"), &["policy broken.policy", cause]);
    }
}

#[test]
fn the_policies_in_the_box_reach_their_targets_within_all_limits() {
    let project = Project::new();
    for (stage, least) in [("purple", 0.9), ("yellow", 0.95), ("orange", 0.95)] {
        let line = format!("eval --policy {stage} --stage {stage} --episodes 40 --seed 77");
        let result: Value = serde_json::from_str(&check_success(&project.run(runner(), &line))).unwrap();
        assert!(result["success_rate"].as_f64().unwrap() >= least, "{stage}: {result}");
        assert_eq!(result["violations"], serde_json::json!({"reference": 0, "actual": 0}), "{stage}");
    }
}
