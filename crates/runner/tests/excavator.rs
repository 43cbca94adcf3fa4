//! The second machine goes the same way as the first: nothing here knows how many joints a crane has or how they are
//! called.

mod support;

use std::path::Path;
use std::sync::Arc;

use runner::config::ConfigSpec;
use runner::draw::{Purpose, Stream};
use runner::environment::Environment;
use runner::machine::Machine;
use runner::stage::Stage;
use support::{Project, check_refusal, check_success};

const CONFIG: &str = "assets/config/excavator.ron";

/// A policy that knows nothing: step and its own draws give an action for each of two joints.
type Policy = fn(u32, &mut Stream) -> [f32; 2];

const POLICIES: &[(&str, Policy)] = &[
    ("alternating", |step, _| if step % 2 == 0 { [1.0; 2] } else { [-1.0; 2] }),
    ("either end at random", |_, draws| {
        std::array::from_fn(|_| if draws.uniform(-1.0, 1.0) > 0.0 { 1.0 } else { -1.0 })
    }),
    ("long swings", |step, _| [29, 37].map(|period| if step / period % 2 == 0 { 1.0 } else { -1.0 })),
];

#[test]
fn no_policy_breaks_a_limit_of_the_excavator() {
    std::env::set_current_dir(support::workspace_root()).unwrap();
    let machine = Arc::new(Machine::load(&ConfigSpec::read(Path::new(CONFIG)).unwrap()).unwrap());
    for (name, policy) in POLICIES {
        let mut environment = Environment::new(Arc::clone(&machine), true);
        for number in 0..4 {
            let mut draws = Stream::of_episode(17, Purpose::Evaluation, Stage::Orange, number);
            let episode = environment.draw(machine.regions().of(Stage::Orange), &mut draws).unwrap();
            environment.start(&episode).unwrap();
            for step in 0..300 {
                if environment.step(&policy(step, &mut draws)).unwrap().ending.is_some() {
                    break;
                }
            }
        }
        let seen = environment.take_evidence();
        assert_eq!(seen.reference_violations, 0, "{name}: reference {:#?}", seen.joints);
        assert_eq!(seen.actual_violations, 0, "{name}: actual {:#?}", seen.joints);
        assert_eq!(seen.empty_ranges, 0, "{name}");
        assert_eq!(seen.saturated_commands, 0, "{name}: the limits are to leave effort for every reference");
        assert!(seen.held_joint_tip_error < 1e-3, "{name}: held joints {} m", seen.held_joint_tip_error);
    }
}

#[test]
fn its_tables_are_up_to_date_and_its_joints_have_zones() {
    let project = Project::new();
    check_success(&project.kinematics(&format!("tables --check --config {CONFIG}")));
    let zone = format!("zone --position 0 --velocity 0 --config {CONFIG}");
    check_success(&project.kinematics(&format!("{zone} --joint bucket_joint")));
    check_refusal(
        &project.kinematics(&format!("{zone} --joint lift_joint")),
        &["lift_joint", "bucket_joint"],
    );
}
