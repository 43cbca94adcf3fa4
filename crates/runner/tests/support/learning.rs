//! A project that trains within a second: networks of 16, episodes of 20 steps, updates from step 60 on.

use std::process::{Command, Output};

use runner::config::ConfigSpec;

use super::Project;

/// A project whose default configuration is small.
pub fn small_project() -> Project {
    let project = Project::new();
    let mut config = ConfigSpec::read(&project.path(runner::config::DEFAULT)).unwrap();
    let learner = sac_burn::ConfigSpec {
        hidden: vec![16, 16],
        batch_size: 16,
        random_steps: 60,
        update_after: 60,
        replay_capacity: 2_000,
        ..config.learner.spec().clone()
    };
    config.learner = sac_burn::Config::try_from(learner).unwrap();
    config.task.max_steps = 20;
    for goal in [&mut config.curriculum.purple, &mut config.curriculum.yellow, &mut config.curriculum.orange]
    {
        goal.confirm_episodes = 4;
    }
    config.curriculum.checkpoint_every = 50;
    project.write(runner::config::DEFAULT, config.to_ron().unwrap());
    project
}

pub fn runner() -> Command {
    Command::new(env!("CARGO_BIN_EXE_runner"))
}

pub fn train(project: &Project, arguments: &str) -> Output {
    project.run(runner(), &format!("train --quiet {arguments}"))
}
