//! Checkpoints of earlier versions of the format are read, and their training goes on.
//!
//! `formats/version-N` is a run of purple that the program of that version left after seven episodes: hidden layer of 4,
//! batches of 4, episodes of 8 steps, a memory of 40 transitions, seed 7. `formats/policy-N.policy` is such a run's policy.
#![expect(clippy::unwrap_used, reason = "helpers of tests are tests too")]

mod support;

use std::fs;
use std::path::{Path, PathBuf};

use runner::checkpoint;
use runner::stage::Stage;
use runner::trained::{self, Trained};
use support::learning::{runner, train};
use support::{Project, check_success, workspace_root};

/// Every version but the present one.
const VERSIONS: [u32; 2] = [1, 2];

/// Every version of a policy's file but the present one.
const POLICIES: [u32; 1] = [1];

fn fixture(version: u32) -> PathBuf {
    workspace_root().join(format!("crates/runner/tests/formats/version-{version}"))
}

/// A copy of the run, ready to be resumed.
fn place(project: &Project, version: u32, run: &str) -> PathBuf {
    let folder = project.path(&format!("runs/{run}/purple"));
    fs::create_dir_all(folder.join("checkpoints")).unwrap();
    for file in ["metrics.jsonl", "events.out.tfevents"] {
        fs::copy(fixture(version).join(file), folder.join(file)).unwrap();
    }
    let latest = folder.join("checkpoints/latest");
    fs::copy(fixture(version).join("latest"), &latest).unwrap();
    latest
}

fn version_of(path: &Path) -> u32 {
    u32::from_le_bytes(fs::read(path).unwrap()[8..12].try_into().unwrap())
}

#[test]
fn every_earlier_version_is_there_and_none_is_the_present_one() {
    assert!(VERSIONS.into_iter().eq(1..checkpoint::KIND.version()), "add a run of each earlier version");
    for version in VERSIONS {
        assert_eq!(version_of(&fixture(version).join("latest")), version);
    }
}

#[test]
fn a_policy_of_an_earlier_version_is_read_and_played() {
    assert!(POLICIES.into_iter().eq(1..trained::KIND.version()), "add a policy of each earlier version");
    for version in POLICIES {
        let file = workspace_root().join(format!("crates/runner/tests/formats/policy-{version}.policy"));
        assert_eq!(version_of(&file), version);
        let read = Trained::read(&file).unwrap();
        let header = read.header.as_ref().unwrap();
        assert_eq!((read.stage, header.seed, header.steps), (Stage::Purple, 7, 56));
        let project = Project::new();
        project.write("then.ron", read.config.to_ron().unwrap());
        check_success(&project.kinematics("tables --config then.ron"));
        check_success(&project.run(runner(), &format!("play --policy {}", file.display())));
    }
}

#[test]
fn a_checkpoint_of_an_earlier_version_holds_what_it_held() {
    for version in VERSIONS {
        let (header, agent) = checkpoint::read(&fixture(version).join("latest")).unwrap();
        assert_eq!((header.stage, header.config.seed), (Stage::Purple, 7));
        assert_eq!((header.mastery.episodes, header.steps), (7, 56));
        // Version 1 updated after a step, later ones beside the next.
        let updates = if version == 1 { 45 } else { 44 };
        assert_eq!((agent.steps(), agent.updates(), agent.replay_len()), (56, updates, 40));
        assert_eq!(header.config.learner.spec().hidden, [4]);
        assert_eq!(agent.config(), &header.config.learner, "both halves were brought up to date alike");
        let metrics = fs::metadata(fixture(version).join("metrics.jsonl")).unwrap().len();
        assert_eq!(header.metrics_length, metrics);
        for stage in Stage::ALL {
            assert_eq!(header.config.curriculum.of(stage).max_episodes, 50, "{stage}");
        }
        // Written now it is of the present version, and says the same.
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("again");
        checkpoint::write(&path, &header, &agent).unwrap();
        assert_eq!(version_of(&path), checkpoint::KIND.version());
        let (again, agent_again) = checkpoint::read(&path).unwrap();
        assert_eq!(again, header);
        let bytes = |agent: &sac_burn::Agent| {
            let mut bytes = Vec::new();
            agent.save(&mut bytes).unwrap();
            bytes
        };
        assert!(bytes(&agent) == bytes(&agent_again));
    }
}

#[test]
fn a_training_of_an_earlier_version_goes_on_as_the_same_in_the_present_one() {
    for version in VERSIONS {
        let project = Project::new();
        place(&project, version, "old");
        let path = place(&project, version, "new");
        let (header, agent) = checkpoint::read(&path).unwrap();
        checkpoint::write(&path, &header, &agent).unwrap();
        // The tables of its day: limits and margins may have changed since.
        project.write("then.ron", header.config.to_ron().unwrap());
        check_success(&project.kinematics("tables --config then.ron"));
        for run in ["old", "new"] {
            check_success(&train(&project, &format!("--stage purple --run {run} --resume --episodes 12")));
        }
        let of = |run: &str, file: &str| project.bytes(&format!("runs/{run}/purple/{file}"));
        for file in ["metrics.jsonl", "checkpoints/latest", "purple.policy", "eval.json"] {
            assert!(of("old", file) == of("new", file), "version {version}: {file}");
        }
        let text = String::from_utf8(of("old", "metrics.jsonl")).unwrap();
        assert_eq!(text.lines().count(), 12);
        assert!(text.as_bytes().starts_with(&fs::read(fixture(version).join("metrics.jsonl")).unwrap()));
        check_success(&project.run(runner(), "play --run old --stage purple"));
    }
}
