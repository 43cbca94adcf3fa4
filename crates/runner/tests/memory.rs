//! A training whose replay is full stays within its memory, checkpoints and closing evaluation included.
#![cfg(target_os = "linux")]
#![expect(clippy::unwrap_used, reason = "helpers of tests are tests too")]

mod support;

use runner::checkpoint;
use runner::config::ConfigSpec;
use sac_burn::{Agent, Outcome, Transition};
use serde_json::Value;
use support::learning::{runner, train};
use support::{Project, check_success};

/// The most that a training may take \[bytes\]: 1.5 GiB.
const MOST: u64 = 3 << 29;

/// Less than the replay itself would be a measurement of something else \[bytes\].
const LEAST: u64 = 1_000_000 * 4 * (2 * 32 + 3 + 2);

#[test]
fn a_training_with_a_full_replay_takes_less_than_one_and_a_half_gibibytes() {
    // The default configuration with the larger networks; only its updates do not wait, and its episodes are short.
    let project = Project::new();
    let mut config = ConfigSpec::read(&project.path(runner::config::DEFAULT)).unwrap();
    let hidden = vec![256, 256];
    let learner =
        sac_burn::ConfigSpec { hidden, random_steps: 0, update_after: 1, ..config.learner.spec().clone() };
    assert_eq!(learner.replay_capacity, 1_000_000);
    config.learner = sac_burn::Config::try_from(learner).unwrap();
    config.task.max_steps = 20;
    config.curriculum.purple.confirm_episodes = 4;
    project.write(runner::config::DEFAULT, config.to_ron().unwrap());
    check_success(&train(&project, "--stage purple --run a --episodes 1"));

    // The same training with its replay full.
    let path = project.path("runs/a/purple/checkpoints/latest");
    let (header, mut agent) = checkpoint::read(&path).unwrap();
    fill(&mut agent);
    assert_eq!(agent.replay_len(), 1_000_000);
    checkpoint::write(&path, &header, &agent).unwrap();
    drop(agent);

    // It reads that checkpoint, learns on, writes it twice, and reads one beside itself for its evaluation.
    check_success(&project.run(runner(), "train --quiet --stage purple --run a --resume --episodes 3"));
    let timing: Value = serde_json::from_str(&project.text("runs/a/purple/timing.json")).unwrap();
    assert!(timing["updates"].as_u64().unwrap() > 10, "{timing}");
    let peak = timing["peak_memory"].as_u64().unwrap();
    eprintln!("peak memory {:.0} MiB", peak as f64 / f64::from(1 << 20));
    assert!((LEAST..MOST).contains(&peak), "{peak} bytes");
}

/// Remembers transitions until the memory is full.
fn fill(agent: &mut Agent) {
    let mut observation = vec![0.0; agent.observation_dim()];
    for number in 0..1_000_000_u32 {
        observation[0] = (number % 1000) as f32 / 1000.0;
        let transition = Transition {
            observation: &observation,
            action: &[0.1, -0.2, 0.3],
            reward: -observation[0],
            next_observation: &observation,
            outcome: Outcome::Continues,
        };
        agent.remember(&transition).unwrap();
    }
}
