//! Every configuration in `assets/config` is sound, and the paper's is the paper's.

mod support;

use runner::config::{ConfigSpec, Feedforward};
use runner::stage::Stage;
use support::{Project, check_success};

#[test]
fn every_configuration_has_its_tables() {
    let project = Project::new();
    let mut count = 0;
    for entry in std::fs::read_dir(project.path("assets/config")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        check_success(&project.kinematics(&format!("tables --check --config assets/config/{name}")));
        count += 1;
    }
    assert!(count >= 3, "{count} configurations");
}

#[test]
fn the_paper_s_configuration_is_table_1_with_the_paper_s_ramps() {
    let project = Project::new();
    let config = ConfigSpec::read(&project.path("assets/config/paper.ron")).unwrap();
    let default = ConfigSpec::read(&project.path(runner::config::DEFAULT)).unwrap();
    assert_eq!(
        (config.motion.shape, config.motion.timing),
        (jbtg::Shape::SineQuintic, jbtg::Timing::Fastest)
    );
    // The paper's law knows no model, and does not keep the limits.
    assert_eq!(config.crane.feedforward, Feedforward::Nominal);
    assert_eq!((config.rates.policy_period(), config.task.max_steps), (0.05, 300));
    assert_eq!((config.task.reach_distance, config.task.reach_speed), (0.05, 0.1));
    let episodes: u64 = Stage::ALL.map(|stage| config.curriculum.of(stage).max_episodes).iter().sum();
    assert_eq!(episodes, 3000);
    // What the paper leaves open is as in the default.
    assert_eq!((&config.task, &config.reward), (&default.task, &default.reward));
    assert_eq!(config.motion.tracking_margin, default.motion.tracking_margin);
    #[cfg(feature = "training")]
    assert_eq!(config.learner, sac_burn::Config::table_1());
}
