//! `runs` tells what is under `runs/` and how to go on with it, from the files that a training leaves.
#![expect(clippy::unwrap_used, reason = "helpers of tests are tests too")]

mod support;

use runner::config::DEFAULT;
use serde_json::Value;
use support::{Project, check_success};

/// Plants a stage of a run as a training leaves it: the default configuration, and `files`.
fn plant(project: &Project, run: &str, stage: &str, files: &[(&str, &str)]) {
    let folder = format!("runs/{run}/{stage}");
    std::fs::create_dir_all(project.path(&format!("{folder}/checkpoints"))).unwrap();
    project.write(&format!("{folder}/config.ron"), project.text(DEFAULT).replace("seed: 0,", "seed: 7,"));
    for (name, contents) in files {
        project.write(&format!("{folder}/{name}"), contents);
    }
}

fn record(episode: u64, success_rate: f64, confirmed: &str) -> String {
    format!(
        "{{\"episode\":{episode},\"step\":{},\"success_rate\":{success_rate},\"confirmed\":{confirmed}}}\n",
        100 * episode
    )
}

/// The entry of a run's stage in the JSON.
fn entry(project: &Project, run: &str, stage: &str) -> Value {
    let entries: Vec<Value> =
        serde_json::from_str(&check_success(&project.kinematics("runs --json"))).unwrap();
    entries.into_iter().find(|entry| entry["run"] == run && entry["stage"] == stage).unwrap()
}

#[test]
fn without_a_run_the_way_to_the_first_is_said() {
    let project = Project::new();
    assert!(check_success(&project.kinematics("runs")).contains("cargo xtask train --stage purple"));
    assert_eq!(check_success(&project.kinematics("runs --json")), "[]\n");
}

#[test]
fn a_mastered_stage_goes_on_with_the_next_and_the_last_with_nothing() {
    let project = Project::new();
    let metrics = record(344, 0.95, "null") + &record(345, 0.97, "1.0");
    let closed = [
        ("metrics.jsonl", metrics.as_str()),
        ("certificate.json", r#"{"episodes":345}"#),
        ("eval.json", r#"{"episodes":200,"success_rate":0.99}"#),
        ("checkpoints/latest", ""),
    ];
    plant(&project, "a", "purple", &closed);
    plant(&project, "b", "orange", &closed);
    let purple = entry(&project, "a", "purple");
    assert_eq!((&purple["state"], &purple["seed"]), (&"mastered".into(), &7.into()));
    assert_eq!((&purple["episodes"], &purple["steps"]), (&345.into(), &34_500.into()));
    assert_eq!(purple["evaluation"]["success_rate"], 0.99);
    assert_eq!(purple["next"], "cargo xtask train --stage yellow --run a");
    assert_eq!(entry(&project, "b", "orange")["next"], Value::Null);
    plant(&project, "a", "yellow", &[]);
    assert_eq!(entry(&project, "a", "purple")["next"], Value::Null, "yellow was begun");
    let text = check_success(&project.kinematics("runs"));
    let result = "mastered after 345 episodes, 34500 steps, then 99.0 % of 200 reached";
    assert!(text.contains(result) && text.lines().count() == 4, "{text}");
}

#[test]
fn a_stopped_stage_resumes_from_its_checkpoint_or_starts_again_without_one() {
    let project = Project::new();
    // A killed training leaves half a line, and an older evaluation may be there.
    let metrics = record(12, 0.25, "null") + "{\"episode\":13,\"st";
    plant(
        &project,
        "stopped",
        "purple",
        &[
            ("metrics.jsonl", metrics.as_str()),
            ("certificate.json", r#"{"episodes":6}"#),
            ("eval.json", r#"{"episodes":200,"success_rate":0.1}"#),
            ("checkpoints/latest", ""),
        ],
    );
    plant(&project, "early", "purple", &[("metrics.jsonl", metrics.as_str())]);
    let stopped = entry(&project, "stopped", "purple");
    assert_eq!((&stopped["state"], &stopped["episodes"]), (&"open".into(), &12.into()));
    assert_eq!(stopped["evaluation"], Value::Null, "it is of an earlier state");
    assert_eq!(stopped["next"], "cargo xtask train --stage purple --run stopped --resume");
    let early = entry(&project, "early", "purple");
    assert_eq!(
        early["next"],
        "cargo xtask train --stage purple --run early --config runs/early/purple/config.ron"
    );
}

#[test]
fn a_stage_that_used_up_its_episodes_goes_on_with_more() {
    let project = Project::new();
    for (run, episodes, flags) in [("few", 6, " --resume"), ("all", 3000, " --resume --episodes 6000")] {
        let certificate = format!("{{\"episodes\":{episodes}}}");
        plant(
            &project,
            run,
            "purple",
            &[
                ("metrics.jsonl", record(episodes, 0.5, "0.6").as_str()),
                ("certificate.json", certificate.as_str()),
                ("eval.json", r#"{"episodes":200,"success_rate":0.6}"#),
                ("checkpoints/latest", ""),
            ],
        );
        let ended = entry(&project, run, "purple");
        assert_eq!(ended["state"], "ended");
        assert_eq!(ended["next"], format!("cargo xtask train --stage purple --run {run}{flags}"));
    }
}

#[test]
fn a_damaged_run_is_listed_with_what_is_wrong_and_others_are_not_hidden() {
    let project = Project::new();
    plant(&project, "broken", "purple", &[]);
    project.write("runs/broken/purple/config.ron", "(schema: 1, sed: 0)");
    plant(&project, "sound", "purple", &[]);
    let broken = entry(&project, "broken", "purple");
    assert_eq!(broken["state"], "damaged");
    assert!(broken["problem"].as_str().unwrap().contains("runs/broken/purple/config.ron:1"), "{broken}");
    assert_eq!(entry(&project, "sound", "purple")["state"], "open");
}
