//! The adaptive controller around a simulated joint ẍ = A·(u + disturbance).
#![expect(clippy::unwrap_used, reason = "helpers of tests are tests too")]

use adaptive_ctrl::{
    AdaptiveController, Bounds, EffortLimits, Gains, GainsSpec, InverseInertia, JointController, JointSpec,
    Measurement, Reference, Saturation, UltimateBound,
};
use proptest::prelude::*;

const PERIOD: f64 = 0.0005;
/// Inertia that the controller is built for [kg].
const LIGHT: f64 = 3900.0;
const HEAVY: f64 = 22_000.0;
const GAINS: GainsSpec =
    GainsSpec { k1: 160.0, k2: 5.7e4, k3: 5.0, k4: 1.0, k5: 6e6, k6: 2.2e5, k7: 5.0, k8: 1.0 };

fn controller(effort: f64) -> AdaptiveController {
    let joint = JointSpec {
        period: PERIOD,
        inverse_inertia: InverseInertia::of_inertia(Bounds { lower: LIGHT, upper: HEAVY }).unwrap(),
        effort_limits: EffortLimits::symmetric(effort).unwrap(),
    };
    AdaptiveController::new(Gains::try_from(GAINS).unwrap(), joint).unwrap()
}

/// One joint whose effort is held over each period: integrated exactly.
struct Joint {
    inertia: f64,
    position: f64,
    velocity: f64,
}

impl Joint {
    fn advance(&mut self, force: f64) {
        let acceleration = force / self.inertia;
        self.position += PERIOD * (self.velocity + 0.5 * PERIOD * acceleration);
        self.velocity += PERIOD * acceleration;
    }

    fn measured(&self) -> Measurement {
        Measurement { position: self.position, velocity: self.velocity }
    }
}

/// Sine of 0.1 m and 0.1 m/s about 0.3 m.
fn sine(tick: u32) -> Reference {
    let t = f64::from(tick) * PERIOD;
    Reference {
        position: 0.3 + 0.1 * t.sin(),
        velocity: 0.1 * t.cos(),
        acceleration: -0.1 * t.sin(),
        effort: 0.0,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Inertia within the stated range and up to four times beyond it: heavier than stated is less
    /// damped, never unstable.
    #[test]
    fn tracks_within_load_over_stiffness_for_any_inertia_and_bounded_load(
        inertia in LIGHT..4.0 * HEAVY,
        constant in -20e3..20e3_f64,
        swing in 0.0..10e3_f64,
        frequency in 0.1..5.0_f64,
        offset in -0.002..0.002_f64,
    ) {
        let mut controller = controller(1e6);
        let mut joint = Joint { inertia, position: 0.3 + offset, velocity: 0.1 };
        let (mut worst, mut worst_late) = (0.0_f64, 0.0_f64);
        for tick in 0..6000 {
            let reference = sine(tick);
            let command = controller.step(reference, joint.measured());
            let t = f64::from(tick) * PERIOD;
            joint.advance(command.effort + constant + swing * (frequency * t).sin());
            let parameters = controller.parameters();
            prop_assert!(parameters.position >= 0.0 && parameters.velocity >= 0.0);
            let error = (joint.position - sine(tick + 1).position).abs();
            worst = worst.max(error);
            if tick >= 4000 {
                worst_late = worst_late.max(error);
            }
        }
        // Load and inertial force over the stiffness without adaptation; twice that for overshoot.
        let stiffness = 0.25 * GAINS.k1 * GAINS.k5;
        let ball = 2.0 * (constant.abs() + swing + 0.1 * inertia) / stiffness + 1e-6;
        prop_assert!(worst <= 2.0 * offset.abs() + ball, "worst error {worst}");
        prop_assert!(worst_late <= ball, "error {worst_late} after 2 s, expected {ball}");
    }
}

/// A joint of constant inertia about rest, from its adaptive controller's point of view.
fn ball(inertia: f64, start: (f64, f64), disturbance: f64) -> UltimateBound {
    let range = InverseInertia::of_inertia(Bounds { lower: inertia, upper: inertia }).unwrap();
    let ceilings = controller(1e7).parameter_ceilings();
    UltimateBound::of_adaptive(&GAINS, ceilings, PERIOD, range, start, disturbance).unwrap().unwrap().0
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// The disturbance is any bounded sequence, worst ones among them: `pattern` names its sign tick by tick.
    #[test]
    fn errors_never_leave_the_predicted_ball_once_inside(
        inertia in LIGHT..HEAVY,
        bound in 100.0..20e3_f64,
        position in -5e-4..5e-4_f64,
        velocity in -0.02..0.02_f64,
        run_length in 1u32..400,
        pattern in proptest::collection::vec(-1.0..1.0_f64, 32),
        extreme in any::<bool>(),
    ) {
        let predicted = ball(inertia, (position, velocity), bound);
        let mut controller = controller(1e7);
        let mut joint = Joint { inertia, position, velocity };
        let radius = predicted.radius(bound);
        let mut allowed = predicted.distance(position, velocity);
        for tick in 0..6000_u32 {
            let share = pattern[(tick / run_length) as usize % pattern.len()];
            let share = if extreme { share.signum() } else { share };
            let command = controller.step(Reference::default(), joint.measured());
            joint.advance(command.effort + bound * share);
            // Contracts towards the ball tick by tick, and stays in it.
            allowed = predicted.contraction() * allowed + (1.0 - predicted.contraction()) * radius;
            let distance = predicted.distance(joint.position, joint.velocity);
            prop_assert!(
                distance <= allowed * (1.0 + 1e-9),
                "tick {tick}: {distance} exceeds {allowed}, ball {radius}"
            );
        }
        prop_assert!(allowed <= radius * 1.01, "3 s should bring any start to the ball: {allowed}, {radius}");
    }
}

#[test]
fn the_ball_is_not_much_larger_than_what_the_worst_load_does() {
    // A constant load at the bound is the plainest disturbance; the ball must not be orders above it.
    for inertia in [LIGHT, 9000.0, HEAVY] {
        let predicted = ball(inertia, (0.0, 0.0), 5e3);
        let (mut controller, mut joint) = (controller(1e7), Joint { inertia, position: 0.0, velocity: 0.0 });
        for _ in 0..6000 {
            let command = controller.step(Reference::default(), joint.measured());
            joint.advance(command.effort + 5e3);
        }
        let bound = predicted.position(predicted.radius(5e3));
        assert!(bound < 8.0 * joint.position.abs(), "{bound} against {}", joint.position);
    }
}

/// V₂ of the paper about the linear equilibrium, φ₁* and φ₂* taken as 0 (no load, no uncertainty).
fn lyapunov(controller: &AdaptiveController, joint: &Joint) -> f64 {
    let (e1, e2, parameters) = (joint.position, joint.velocity, controller.parameters());
    let z1 = e1;
    let z2 = e2 + 0.5 * (GAINS.k1 + GAINS.k2 * parameters.position) * z1;
    0.5 * z1 * z1
        + 0.5 * joint.inertia * z2 * z2
        + 0.5 * parameters.position.powi(2) / GAINS.k3
        + 0.5 * parameters.velocity.powi(2) / GAINS.k7
}

#[test]
fn lyapunov_function_falls_outside_a_ball() {
    for inertia in [LIGHT, 9000.0, HEAVY] {
        for (position, velocity) in [(1e-3, 0.0), (-2e-3, 0.05), (5e-4, -0.1)] {
            let mut controller = controller(1e6);
            let mut joint = Joint { inertia, position, velocity };
            let start = lyapunov(&controller, &joint);
            // u̇_v is a disturbance in the proof, so V need not fall on every tick but on every few.
            let (mut last, mut ticks_outside) = (start, 0);
            while last > 1e-6 * start && ticks_outside < 4000 {
                for _ in 0..40 {
                    let command = controller.step(Reference::default(), joint.measured());
                    joint.advance(command.effort);
                }
                let now = lyapunov(&controller, &joint);
                assert!(now < last, "inertia {inertia}, from {position}, {velocity}: V {last} to {now}");
                last = now;
                ticks_outside += 40;
            }
            assert!(last <= 1e-6 * start, "V fell from {start} only to {last}");
        }
    }
}

#[test]
fn a_loaded_joint_does_not_drop_when_it_is_taken_over() {
    let load = -20e3;
    let drop = |bumpless: bool| {
        let mut controller = controller(95_500.0);
        let mut joint = Joint { inertia: 9000.0, position: 0.3, velocity: 0.0 };
        let at_joint = Reference { position: 0.3, ..Reference::default() };
        let held = controller.start_holding(joint.measured(), -load).unwrap();
        let reference = if bumpless {
            held
        } else {
            controller.reset();
            at_joint
        };
        (0..2000).fold(0.0_f64, |worst, _| {
            let command = controller.step(reference, joint.measured());
            joint.advance(command.effort + load);
            worst.max((joint.position - 0.3).abs())
        })
    };
    assert!(drop(true) < 1e-12, "dropped by {}", drop(true));
    assert!(drop(false) > 5e-5, "the plain start should drop by load / stiffness, got {}", drop(false));
}

#[test]
fn adaptation_makes_the_loaded_joint_stiffer() {
    let rest = |adapts: bool| {
        let mut controller = controller(95_500.0);
        let mut joint = Joint { inertia: 9000.0, position: 0.0, velocity: 0.0 };
        for _ in 0..10_000 {
            let command = controller.step(Reference::default(), joint.measured());
            joint.advance(command.effort + 50e3);
            if !adapts {
                controller.reset();
            }
        }
        joint.position
    };
    let (with, without) = (rest(true), rest(false));
    let linear = 50e3 / (1.0 + 0.25 * GAINS.k1 * GAINS.k5);
    assert!((without / linear - 1.0).abs() < 1e-6, "{without} against {linear}");
    assert!(with < 0.9 * without, "{with} against {without}");
}

#[test]
fn an_overloaded_joint_recovers_without_windup() {
    let mut controller = controller(95_500.0);
    let mut joint = Joint { inertia: 9000.0, position: 0.0, velocity: 0.0 };
    let mut cut = 0;
    for tick in 0..4000 {
        let before = controller.parameters();
        let command = controller.step(Reference::default(), joint.measured());
        if command.saturation != Saturation::None {
            cut += 1;
            assert_eq!(controller.parameters(), before, "adapted while cut, tick {tick}");
        }
        // Twice what the actuator can hold, for 20 ms.
        joint.advance(command.effort + if tick < 40 { 200e3 } else { 0.0 });
    }
    assert!(cut > 40, "the load should saturate the actuator, did on {cut} ticks");
    assert!(joint.position.abs() < 1e-9, "still off by {}", joint.position);
}
