use super::*;
use crate::{Bounds, InverseInertia};

/// Round numbers: ½k₁ = 2, ½k₅ = 10; A = 0.5 to 2, so ½k₅·A_min = 5 and ½k₅·A_max·T = 0.2.
const GAINS: GainsSpec =
    GainsSpec { k1: 4.0, k2: 3.0, k3: 2.0, k4: 0.5, k5: 20.0, k6: 5.0, k7: 4.0, k8: 0.25 };

fn joint() -> JointSpec {
    JointSpec {
        period: 0.01,
        inverse_inertia: InverseInertia::try_from(Bounds { lower: 0.5, upper: 2.0 }).unwrap(),
        effort_limits: EffortLimits::symmetric(10.0).unwrap(),
    }
}

fn controller() -> AdaptiveController {
    AdaptiveController::new(Gains::try_from(GAINS).unwrap(), joint()).unwrap()
}

fn refusal(gains: GainsSpec, joint: JointSpec) -> StabilityError {
    AdaptiveController::new(Gains::try_from(gains).unwrap(), joint).unwrap_err()
}

#[test]
fn two_ticks_equal_the_hand_computation() {
    let mut controller = controller();
    let reference = Reference { position: 0.5, velocity: 0.1, acceleration: 7.0, effort: 0.0 };
    let measured = Measurement { position: 0.6, velocity: 0.4 };
    // z₁ = 0.1, u_v = −½·4·0.1 = −0.2, z₂ = 0.3 + 0.2 = 0.5, u = −0.1 − ½·20·0.5 = −5.1.
    let first = controller.step(reference, measured);
    assert!((first.effort + 5.1).abs() < 1e-12, "{first:?}");
    assert_eq!((first.saturation, first.input), (Saturation::None, Input::Used));
    // φ̂₁: rate 1/s, source ½·3·2·0.01 = 0.03; φ̂₂: rate 1/s, source ½·5·4·0.25 = 2.5; over 0.01 s.
    let grown = 1.0 - (-0.01_f64).exp();
    let (phi1, phi2) = (0.03 * grown, 2.5 * grown);
    let found = controller.parameters();
    assert!((found.position - phi1).abs() < 1e-15 && (found.velocity - phi2).abs() < 1e-15, "{found:?}");
    // Same errors again, with K₁ = 4 + 3φ̂₁ and K₅ = 20 + 5φ̂₂.
    let z2 = 0.3 + 0.5 * (4.0 + 3.0 * phi1) * 0.1;
    let u = -0.1 - 0.5 * (20.0 + 5.0 * phi2) * z2;
    let second = controller.step(reference, measured);
    assert!((second.effort - u).abs() < 1e-12, "{} against {u}", second.effort);
    assert!((controller.damping() - 0.5 * (20.0 + 5.0 * controller.parameters().velocity)).abs() < 1e-12);
}

#[test]
fn adaptation_stands_still_while_saturated() {
    let mut controller = controller();
    for _ in 0..20 {
        controller.step(Reference::default(), Measurement { position: 0.05, velocity: 0.1 });
    }
    let before = controller.parameters();
    assert!(before.position > 0.0 && before.velocity > 0.0);
    for (position, at) in [(9.0, Saturation::AtLower), (-9.0, Saturation::AtUpper)] {
        let command = controller.step(Reference::default(), Measurement { position, velocity: 0.0 });
        assert_eq!(command.saturation, at);
        assert_eq!(command.effort.abs(), 10.0);
        assert_eq!((controller.parameters(), controller.adaptation()), (before, Adaptation::Frozen));
    }
    // Unsaturated without error: both leak again.
    controller.step(Reference::default(), Measurement::default());
    assert_eq!(controller.adaptation(), Adaptation::Free);
    assert!(controller.parameters().velocity < before.velocity);
}

#[test]
fn parameters_stop_at_what_the_sampled_loop_bears() {
    let mut joint = joint();
    joint.effort_limits = EffortLimits::symmetric(1e9).unwrap();
    let mut controller = AdaptiveController::new(Gains::try_from(GAINS).unwrap(), joint).unwrap();
    let measured = Measurement { position: 40.0, velocity: 0.0 };
    for _ in 0..2000 {
        controller.step(Reference::default(), measured);
    }
    assert_eq!(controller.adaptation(), Adaptation::AtCeiling);
    assert_eq!(controller.parameters(), controller.parameter_ceilings());
    // ½(k₅ + k₆φ̂₂)·A_max·T = 0.5, and ½(k₁ + k₂φ̂₁) with which the least damping, ½k₅, still leaves the least ratio.
    assert!((controller.damping() * 2.0 * 0.01 - MAX_DAMPING_PER_TICK).abs() < 1e-12);
    let rate = 0.5 * (GAINS.k1 + GAINS.k2 * controller.parameters().position);
    let at_heaviest =
        LinearLaw { stiffness: 1.0 + 10.0 * rate, damping: 10.0, integral: 0.0 }.sampled(0.5, 0.01);
    assert!((at_heaviest.damping_ratio() - MIN_DAMPING_RATIO).abs() < 1e-12, "{rate}");
}

#[test]
fn non_finite_or_overflowing_input_repeats_the_last_effort_and_moves_nothing() {
    let mut controller = controller();
    let before = controller.step(Reference::default(), Measurement { position: 0.1, velocity: 0.0 });
    let state = controller.parameters();
    let bad = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    let inputs = bad.into_iter().flat_map(|x| {
        [
            (Reference { position: x, ..Reference::default() }, Measurement::default()),
            (Reference { velocity: x, ..Reference::default() }, Measurement::default()),
            (Reference { effort: x, ..Reference::default() }, Measurement::default()),
            (Reference::default(), Measurement { position: x, velocity: 0.0 }),
            (Reference::default(), Measurement { position: 0.0, velocity: x }),
        ]
    });
    let overflow = (Reference::default(), Measurement { position: f64::MAX, velocity: -f64::MAX });
    let overflow_too = (Reference { position: -f64::MAX, ..Reference::default() }, overflow.1);
    for (reference, measured) in inputs.chain([overflow_too]) {
        let command = controller.step(reference, measured);
        assert_eq!(
            (command.effort, command.input),
            (before.effort, Input::Refused),
            "{reference:?} {measured:?}"
        );
        assert_eq!((controller.parameters(), controller.adaptation()), (state, Adaptation::Frozen));
    }
    assert!(controller.step(overflow.0, overflow.1).effort.is_finite());
}

#[test]
fn reference_acceleration_is_not_used() {
    let measured = Measurement { position: 0.02, velocity: 0.01 };
    let with = |acceleration| controller().step(Reference { acceleration, ..Reference::default() }, measured);
    assert_eq!(with(0.0), with(f64::NAN));
}

#[test]
fn feedforward_adds_to_the_law_and_both_are_cut_together() {
    let measured = Measurement { position: 1e-3, velocity: 0.0 };
    let with = |effort| controller().step(Reference { effort, ..Reference::default() }, measured);
    let law = with(0.0).effort;
    assert!(law < 0.0 && (with(2.5).effort - (law + 2.5)).abs() < 1e-12);
    assert_eq!((with(1e3).effort, with(1e3).saturation), (10.0, Saturation::AtUpper));
}

#[test]
fn a_held_joint_gets_its_effort_at_once_and_stays_at_rest() {
    for effort in [-9.9, -3.0, 0.0, 1e-9, 4.0, 10.0] {
        let mut controller = controller();
        let measured = Measurement { position: 0.3, velocity: -0.2 };
        let reference = controller.start_holding(measured, effort).unwrap();
        assert_eq!(reference.velocity, -0.2);
        let at_rest = controller.parameters();
        for _ in 0..1000 {
            let command = controller.step(reference, measured);
            assert!((command.effort - effort).abs() < 1e-11, "{} for {effort}", command.effort);
        }
        let after = controller.parameters();
        let drift = (after.position - at_rest.position).abs() + (after.velocity - at_rest.velocity).abs();
        assert!(drift < 1e-11, "parameters drift by {drift} from {at_rest:?}");
    }
}

#[test]
fn holding_reference_needs_no_change_of_the_controller() {
    let mut controller = controller();
    let measured = Measurement { position: -1.5, velocity: 0.0 };
    // z₁ = −effort / (1 + ¼·4·20) = −6.3/21.
    let reference = controller.holding_reference(measured, 6.3).unwrap();
    assert!((reference.position - (-1.5 + 0.3)).abs() < 1e-15, "{reference:?}");
    assert!((controller.step(reference, measured).effort - 6.3).abs() < 1e-12);
}

#[test]
fn refuses_to_hold_what_the_actuator_cannot() {
    let mut controller = controller();
    let untouched = controller.clone();
    let measured = Measurement { position: 0.3, velocity: 0.0 };
    let error = controller.start_holding(measured, 10.5).unwrap_err();
    assert_eq!(error, HoldError::EffortOutsideLimits { effort: 10.5, lower: -10.0, upper: 10.0 });
    assert!(controller.start_holding(measured, f64::NAN).is_err());
    assert!(controller.start_holding(Measurement { position: f64::INFINITY, velocity: 0.0 }, 1.0).is_err());
    assert_eq!(controller, untouched);
}

#[test]
fn reset_is_the_state_after_construction() {
    let mut controller = controller();
    controller.start_holding(Measurement { position: 0.3, velocity: 0.0 }, 5.0).unwrap();
    controller.step(Reference::default(), Measurement { position: 0.1, velocity: 0.3 });
    controller.reset();
    assert_eq!(controller, self::controller());
}

#[test]
fn refuses_damping_that_one_tick_overdoes_and_says_by_how_much() {
    let error = refusal(GainsSpec { k5: 51.0, ..GAINS }, joint()); // ½·51·2·0.01 = 0.51
    let text = error.to_string();
    assert!(matches!(error, StabilityError::DampingTooStrong { .. }) && text.contains("0.51"), "{text}");
    assert!(text.contains("at most 0.5"), "{text}");
}

#[test]
fn refuses_a_virtual_control_that_velocity_cannot_follow() {
    // ½·9.8 = 4.9 is below ½·20·0.5 = 5, but not below 5/(1 + ½·0.05), which is what sampling leaves.
    let error = refusal(GainsSpec { k1: 9.8, ..GAINS }, joint());
    assert!(
        matches!(error, StabilityError::Underdamped { damping_ratio, inverse_inertia, .. }
            if inverse_inertia == 0.5 && damping_ratio > 0.48 && damping_ratio < MIN_DAMPING_RATIO),
        "{error}"
    );
    assert!(
        AdaptiveController::new(Gains::try_from(GainsSpec { k1: 9.4, ..GAINS }).unwrap(), joint()).is_ok()
    );
}

#[test]
fn refuses_a_loop_whose_eigenvalues_leave_the_unit_circle() {
    // Hardly any damping beside the stiffness of 1 that z₁ itself brings.
    let error = refusal(GainsSpec { k1: 1e-6, k5: 1e-3, ..GAINS }, joint());
    assert!(matches!(error, StabilityError::Unstable { .. }), "{error}");
}

#[test]
fn refuses_a_period_that_is_not_positive() {
    for period in [0.0, -0.01, f64::NAN, f64::INFINITY] {
        let error = refusal(GAINS, JointSpec { period, ..joint() });
        assert!(matches!(error, StabilityError::Limits(_)), "{period}: {error}");
    }
}
