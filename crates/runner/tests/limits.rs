//! Every limit holds, of the reference and of the actual motion, whatever a policy does.
#![expect(clippy::unwrap_used, reason = "helpers of tests are tests too")]

mod support;

use std::sync::Arc;

use runner::config::ConfigSpec;
use runner::draw::{Purpose, Stream};
use runner::environment::{Ending, Environment, Episode};
use runner::evidence::Evidence;
use runner::machine::Machine;
use runner::stage::Stage;
use safezone::Request;

/// A policy that knows nothing: step and its own draws give an action for each joint.
type Policy = fn(u32, &mut Stream) -> [f32; 3];

const POLICIES: &[(&str, Policy)] = &[
    ("always the largest", |_, _| [1.0; 3]),
    ("always the smallest", |_, _| [-1.0; 3]),
    ("alternating", |step, _| if step % 2 == 0 { [1.0; 3] } else { [-1.0; 3] }),
    (
        "alternating against each other",
        |step, _| if step % 2 == 0 { [1.0, -1.0, 1.0] } else { [-1.0, 1.0, -1.0] },
    ),
    ("either end at random", |_, draws| {
        std::array::from_fn(|_| if draws.uniform(-1.0, 1.0) > 0.0 { 1.0 } else { -1.0 })
    }),
    ("anything at random", |_, draws| std::array::from_fn(|_| draws.uniform(-1.0, 1.0) as f32)),
    ("long swings", |step, _| [29, 37, 43].map(|period| if step / period % 2 == 0 { 1.0 } else { -1.0 })),
];

fn machine(change: impl FnOnce(&mut ConfigSpec)) -> Arc<Machine> {
    std::env::set_current_dir(support::workspace_root()).unwrap();
    let mut config = ConfigSpec::read(runner::config::DEFAULT.as_ref()).unwrap();
    change(&mut config);
    Arc::new(Machine::load(&config).unwrap())
}

fn play(machine: &Arc<Machine>, episodes: u64, policy: Policy) -> Evidence {
    let mut environment = Environment::new(Arc::clone(machine), true);
    for number in 0..episodes {
        let mut draws = Stream::of_episode(17, Purpose::Evaluation, Stage::Orange, number);
        let region = machine.regions().of(Stage::Orange);
        let episode = environment.draw(region, &mut draws).unwrap();
        environment.start(&episode).unwrap();
        for step in 0..300 {
            if environment.step(&policy(step, &mut draws)).unwrap().ending.is_some() {
                break;
            }
        }
    }
    environment.take_evidence()
}

#[test]
fn no_policy_breaks_a_limit() {
    let machine = machine(|_| {});
    for (name, policy) in POLICIES {
        let seen = play(&machine, 4, *policy);
        assert_eq!(seen.reference_violations, 0, "{name}: reference {:#?}", seen.joints);
        assert_eq!(seen.actual_violations, 0, "{name}: actual {:#?}", seen.joints);
        assert_eq!(seen.empty_ranges, 0, "{name}");
        assert_eq!(seen.saturated_commands, 0, "{name}: the limits are to leave effort for every reference");
        assert!(seen.held_joint_tip_error < 1e-4, "{name}: held joints {} m", seen.held_joint_tip_error);
    }
}

#[test]
fn an_episode_in_which_the_load_cannot_be_held_ends_as_an_overload() {
    // A load that can be held low, and then up with it: more than lift bears.
    let machine = machine(|config| config.crane.payload = 700.0);
    let mut environment = Environment::new(Arc::clone(&machine), false);
    let mut posture = machine.rest_posture().to_vec();
    for (&joint, position) in machine.moving().iter().zip([0.16, 0.16, 0.23]) {
        posture[joint] = position;
    }
    environment.start(&Episode { start: posture, target: [9.0, 0.0, 9.0] }).unwrap();
    let ending = (0..300).find_map(|_| environment.step(&[1.0, 0.0, 0.0]).unwrap().ending);
    assert_eq!(ending, Some(Ending::Overload));
    let overload = environment.motion().overload().unwrap();
    assert!(
        machine.moving().iter().any(|&joint| machine.joints()[joint].name == overload.joint),
        "{overload:?}"
    );
}

#[test]
fn the_count_of_violations_can_fail() {
    // Without feedforward the wrist is shaken by the booms far beyond its acceleration limit.
    let machine = machine(|config| config.crane.feedforward = runner::config::Feedforward::None);
    let (_, policy) = POLICIES[4];
    let seen = play(&machine, 1, policy);
    assert_eq!(seen.reference_violations, 0);
    assert!(seen.actual_violations > 1000, "{}", seen.actual_violations);
}

#[test]
fn an_unknown_payload_breaks_no_limit_of_position() {
    let machine = machine(|config| config.crane.payload = 200.0);
    for (name, policy) in &POLICIES[5..] {
        let seen = play(&machine, 2, *policy);
        assert_eq!(seen.reference_violations, 0, "{name}");
        for (joint, evidence) in machine.joints().iter().zip(&seen.joints) {
            assert!(evidence.actual.position >= 0.0, "{name}: {} {evidence:?}", joint.name);
        }
    }
}

#[test]
fn a_policy_that_falls_silent_is_braked_to_rest_inside_the_limits() {
    let machine = machine(|_| {});
    let mut motion = runner::motion::Motion::new(Arc::clone(&machine), false);
    motion.start(machine.rest_posture()).unwrap();
    for _ in 0..20 {
        motion.advance(&[Request::Action(1.0); 3]).unwrap();
    }
    let fast = machine.moving().iter().map(|&joint| motion.velocity()[joint].abs()).fold(0.0, f64::max);
    assert!(fast > 0.1, "{fast} m/s");
    for silence in
        [Request::Missing, Request::Late, Request::Action(f64::NAN), Request::Action(f64::INFINITY)]
    {
        for _ in 0..5 {
            motion.advance(&[silence; 3]).unwrap();
        }
    }
    let seen = motion.take_evidence();
    assert_eq!((seen.reference_violations, seen.actual_violations), (0, 0), "{:#?}", seen.joints);
    assert_eq!(seen.failsafe_commands, 60);
    for &joint in machine.moving() {
        assert_eq!(motion.reference()[joint].velocity, 0.0);
        assert!(motion.velocity()[joint].abs() < 1e-4, "{} m/s", motion.velocity()[joint]);
    }
}

#[test]
fn an_action_beyond_the_ends_is_counted_never_clamped_in_silence() {
    let machine = machine(|_| {});
    let mut motion = runner::motion::Motion::new(Arc::clone(&machine), false);
    motion.start(machine.rest_posture()).unwrap();
    motion.advance(&[Request::Action(1.5), Request::Action(0.0), Request::Action(-2.0)]).unwrap();
    assert_eq!(motion.take_evidence().clamped_actions, 2);
}

#[test]
fn a_start_under_load_begins_at_rest() {
    for payload in [0.0, 150.0] {
        let machine = machine(|config| config.crane.payload = payload);
        let mut motion = runner::motion::Motion::new(Arc::clone(&machine), true);
        motion.start(machine.rest_posture()).unwrap();
        for _ in 0..20 {
            motion.advance(&[Request::Missing; 3]).unwrap();
        }
        let seen = motion.take_evidence();
        for (joint, evidence) in machine.joints().iter().zip(&seen.joints) {
            assert!(evidence.velocity_error_max < 1e-6, "{} with {payload} kg: {evidence:?}", joint.name);
        }
    }
}
