//! What is refused, by which name and with which number; and that nothing is refused for no reason.

use std::error::Error;

use jbtg::{
    Interval, Limits, Planner, PlannerError, PlannerSpec, Shape, State, StopError, SymmetricLimits,
    Synchronized, SynchronizedError, Timing,
};

use crate::support::{paper_planner, paper_spec};

fn planner(velocity: f64, acceleration: f64, jerk: f64, period: f64) -> Result<Planner, PlannerError> {
    let position = Interval::symmetric(1.0);
    let limits = SymmetricLimits { position, velocity, acceleration, jerk };
    let limits = Limits::try_from(limits).expect("limits around zero");
    Planner::try_from(PlannerSpec { limits, shape: Shape::Smoothstep, timing: Timing::Stretched, period })
}

#[test]
fn a_period_that_is_none_is_named() {
    for period in [0.0, -0.0, -1.0, f64::INFINITY, f64::NEG_INFINITY] {
        let error = Planner::try_from(paper_spec(period)).unwrap_err();
        assert_eq!(error, PlannerError::Period { period });
        assert_eq!(error.to_string(), format!("period must be finite and > 0, got {period}"));
    }
    assert!(matches!(Planner::try_from(paper_spec(f64::NAN)), Err(PlannerError::Period { .. })));
}

/// Velocity, acceleration, jerk and period, what of them over- or underflows first, and which it is.
#[test]
fn limits_out_of_scale_are_refused_by_the_number_that_overflows_or_vanishes() {
    let infinite = f64::INFINITY;
    let cases = [
        ((1e205, 1e-45, 1e-253, 1e205), "distance at full speed", infinite),
        ((1e177, 1e-238, 1e-248, 1e-287), "acceleration", 0.0),
        ((1e27, 1e-255, 1.0, 1e-212), "velocity change", 0.0),
        ((1e-57, 1e-125, 1e80, 1e-202), "velocity change", 0.0),
        ((1e-55, 1e240, 1e302, 1e-62), "velocity change squared", infinite),
        ((1e167, 1e45, 1e275, 1e-227), "velocity change squared", 0.0),
        ((1e-163, 1e111, 1e99, 1e-119), "shortest ramp cubed", 0.0),
        ((1e-55, 1e171, 1e279, 1e-106), "shortest ramp cubed", 0.0),
        ((1e-163, 1e-90, 1e-108, 1e225), "shortest ramp cubed", infinite),
        ((1e186, 1e-141, 1e-209, 1e73), "derivative of a quintic", 0.0),
        ((1e-24, 1e200, 1e191, 1e-64), "derivative of a quintic", infinite),
        ((1e-52, 1e-55, 1e-135, 1e84), "quintic coefficient of a small step", 0.0),
        ((1e-226, 1e181, 1e-119, 1e74), "quintic coefficient of a small step", 0.0),
    ];
    for ((velocity, acceleration, jerk, period), name, value) in cases {
        let refused = planner(velocity, acceleration, jerk, period).unwrap_err();
        assert_eq!(refused, PlannerError::OutOfScale { name, value });
        assert!(refused.to_string().ends_with(&format!("{name} comes to {value:e}")), "{refused}");
    }
}

#[test]
fn a_period_too_short_says_what_it_leaves() {
    let refused = planner(0.15, 1.0, 100.0, 5e-6).unwrap_err();
    let PlannerError::PeriodTooShort { period, share } = refused else { panic!("{refused:?}") };
    let text = refused.to_string();
    assert!(text.contains(&period.to_string()) && text.contains(&format!("{share:e}")), "{text}");
}

/// Half of the period limit 3·A/J, and twice of it, with unequal limits.
#[test]
fn a_period_is_short_for_the_largest_acceleration_and_the_smallest_jerk() {
    let is_short = |acceleration, jerk, period| {
        let limits = jbtg::LimitsSpec {
            position: Interval::symmetric(1.0),
            velocity: Interval::symmetric(1.0),
            acceleration,
            jerk,
        };
        let limits = Limits::try_from(limits).expect("limits around zero");
        Planner::try_from(PlannerSpec { limits, ..paper_spec(period) }).unwrap().is_period_short()
    };
    let (weak, strong) = (Interval::new(-2.0, 1.0), Interval::new(-1.0, 4.0));
    for (jerk, slowest) in [(Interval::new(-50.0, 100.0), 50.0), (Interval::new(-100.0, 80.0), 80.0)] {
        for (acceleration, largest) in [(weak, 2.0), (strong, 4.0)] {
            let limit = 3.0 * largest / slowest;
            assert!(
                is_short(acceleration, jerk, 0.99 * limit) && !is_short(acceleration, jerk, 1.01 * limit)
            );
        }
    }
}

/// Positions and velocities whose product overflows and whose sum does not.
#[test]
fn a_final_position_that_is_finite_is_no_reason_to_refuse() {
    let planner = planner(1e200, 1e100, 1e101, 10.0).unwrap();
    let far = 1e300;
    assert_eq!(planner.ramp(far, 1e150, 1e150).unwrap().end().position, far);
    assert_eq!(planner.ramp_saturated(far, 1e150, 1e150).unwrap().end().position, far);
    let fast = State { position: far, velocity: 1e10, ..State::default() };
    assert_eq!(paper_planner(0.05).stop(fast).unwrap().trajectory.end().position, far);
}

#[test]
fn a_stop_beyond_double_precision_is_refused_in_words() {
    let planner = paper_planner(0.05);
    let refused = planner.stop(State { acceleration: 1e200, ..State::default() }).unwrap_err();
    assert_eq!(refused, StopError::OutOfScale);
    assert_eq!(refused.to_string(), "state and limits are out of proportion");
    let refused = planner.stop(State { velocity: f64::NAN, ..State::default() }).unwrap_err();
    assert_eq!(refused.to_string(), "velocity must be finite, got NaN");
}

/// A ramp from so small an acceleration takes next to no time: its quintic overflows, or only the jerk of it does.
#[test]
fn a_stop_is_finite_or_refused_however_small_the_state() {
    let planner = paper_planner(0.05);
    for exponent in 1..=330 {
        let small = 10_f64.powi(-exponent);
        let state = State { position: 0.3, acceleration: small, ..State::default() };
        match planner.stop(state) {
            Ok(stop) => {
                let State { position, velocity, acceleration, jerk } =
                    stop.trajectory.state_at(0.5 * stop.trajectory.duration());
                assert!([position, velocity, acceleration, jerk].iter().all(|x| x.is_finite()), "{stop:?}");
            }
            Err(error) => assert_eq!(error, StopError::OutOfScale),
        }
    }
}

/// The sine's velocity overshoots by more than the 1e-7 m/s below zero once all ramps are as long as the slow joint's.
#[test]
fn a_joint_that_common_ramps_leave_too_little_passes_on_why() {
    let joint = |velocity, jerk| {
        let limits = jbtg::LimitsSpec {
            position: Interval::symmetric(1.0),
            velocity,
            acceleration: Interval::symmetric(1.0),
            jerk: Interval::symmetric(jerk),
        };
        let limits = Limits::try_from(limits).expect("limits around zero");
        let shape = Shape::SineQuintic;
        Planner::try_from(PlannerSpec { limits, shape, timing: Timing::Stretched, period: 0.8 }).unwrap()
    };
    let slow = joint(Interval::symmetric(1.0), 4.0);
    for velocity in [Interval::new(-1e-7, 1.0), Interval::new(-1.0, 1e-7)] {
        let refused = Synchronized::in_step([slow, joint(velocity, 1e6)]).unwrap_err();
        let SynchronizedError::Planner { joint: 1, error } = refused else { panic!("{refused:?}") };
        assert!(matches!(error, PlannerError::OutOfScale { name: "velocity margin", .. }), "{error}");
        assert_eq!(refused.source().expect("the planner's error").to_string(), error.to_string());
    }
    assert!(SynchronizedError::Course { joint: 1 }.source().is_none());
}
