//! A training that is killed again and again ends as one that never was.
#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "helpers of tests are tests too")]

mod support;

use std::fs;
use std::process::{Child, Stdio};
use std::time::Duration;

use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{RngCore, SeedableRng};
use runner::checkpoint;
use support::learning::{runner, small_project, train};
use support::{Project, check_success};

/// Moments at which the training is killed.
const KILLS: u32 = 20;

/// Episodes of the training: more than are played between so many kills.
const EPISODES: u64 = 240;

/// A moment is drawn within so many bytes of `metrics.jsonl` behind the last checkpoint: some ten episodes, where a
/// checkpoint is made after every third.
const BYTES: u64 = 3_500;

/// And then within so many looks at the file, so that it may fall anywhere between two lines, a checkpoint included.
const LOOKS: u64 = 4_000;

const FOLDER: &str = "runs/killed/purple";

fn length(project: &Project) -> u64 {
    fs::metadata(project.path(&format!("{FOLDER}/metrics.jsonl"))).map_or(0, |file| file.len())
}

/// The training, begun or continued.
fn spawn(project: &Project, resumes: bool) -> Child {
    let mut command = runner();
    command.args("train --quiet --stage purple --run killed --episodes".split(' '));
    command.arg(EPISODES.to_string());
    if resumes {
        command.arg("--resume");
    }
    command.current_dir(project.path("")).stdout(Stdio::null()).spawn().unwrap()
}

#[test]
fn a_training_killed_at_twenty_random_moments_ends_as_one_that_never_was() {
    let project = small_project();
    check_success(&train(&project, &format!("--stage purple --run whole --episodes {EPISODES}")));
    let whole = project.bytes("runs/whole/purple/metrics.jsonl");
    let mut random = Xoshiro256PlusPlus::seed_from_u64(20);
    for kill in 0..KILLS {
        let latest = project.path(&format!("{FOLDER}/checkpoints/latest"));
        let resumes = latest.exists();
        let kept = if resumes { checkpoint::read(&latest).unwrap().0.metrics_length } else { 0 };
        let stale = length(&project);
        let (bytes, looks) = (kept + random.next_u64() % BYTES, random.next_u64() % LOOKS);
        let mut training = spawn(&project, resumes);
        let mut wait = || {
            assert!(training.try_wait().unwrap().is_none(), "kill {kill}: it ended before");
            std::thread::sleep(Duration::from_micros(100));
        };
        // It first drops what was written after its checkpoint.
        while stale > kept && length(&project) == stale {
            wait();
        }
        while length(&project) < bytes {
            wait();
        }
        for _ in 0..looks {
            length(&project);
        }
        training.kill().unwrap();
        training.wait().unwrap();
        let written = project.bytes(&format!("{FOLDER}/metrics.jsonl"));
        assert!(
            whole.starts_with(&written),
            "kill {kill}, at {bytes} bytes and {looks} looks: what it wrote is not what the whole training wrote"
        );
    }
    check_success(&train(&project, &format!("--stage purple --run killed --resume --episodes {EPISODES}")));
    let files = ["metrics.jsonl", "eval.json", "certificate.json", "purple.policy", "checkpoints/latest"];
    for file in files {
        let of = |run: &str| project.bytes(&format!("runs/{run}/purple/{file}"));
        assert!(of("whole") == of("killed"), "{file}");
    }
}
