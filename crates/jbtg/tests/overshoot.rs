//! What the sine's quintic goes against its direction: how far, and that limits are kept for all that.

use jbtg::{Direction, Interval, Limits, LimitsSpec, Planner, PlannerSpec, RampError, Shape, Timing};

use crate::support::paper_spec;
use crate::tolerance;

fn sine(timing: Timing, period: f64) -> Planner {
    strong_sine(timing, period, 1.0)
}

/// The paper's telescope with another acceleration limit.
fn strong_sine(timing: Timing, period: f64, acceleration: f64) -> Planner {
    let spec = paper_spec(period);
    let (position, velocity, jerk) = (spec.limits.position(), spec.limits.velocity(), spec.limits.jerk());
    let acceleration = Interval::symmetric(acceleration);
    let limits =
        Limits::try_from(LimitsSpec { position, velocity, acceleration, jerk }).expect("limits around zero");
    Planner::try_from(PlannerSpec { limits, shape: Shape::SineQuintic, timing, ..spec })
        .expect("a period of many ramps")
}

/// A stretched pulse scales with its change; a fastest one is worst where its ramps are full and have no cruise.
#[test]
fn the_reverse_travel_is_what_the_worst_step_dips_by() {
    let specs = [Timing::Stretched, Timing::Fastest]
        .map(|timing| [1.0, 0.5].map(|acceleration| (timing, acceleration)));
    for (timing, acceleration) in specs.into_iter().flatten() {
        let planner = strong_sine(timing, 0.05, acceleration);
        let authority = planner.authority(Direction::Increasing);
        for share in [0.2, 0.999, 1.0, 1.3] {
            let change = share * authority.ramps_only;
            let dip = -planner.ramp(0.0, 0.0, change).unwrap().extrema().position.min;
            let bound = authority.reverse_travel * change;
            assert!(dip <= bound * (1.0 + 1e-9), "{timing:?}, {share}: {dip:e} beyond {bound:e}");
            let is_worst = timing == Timing::Stretched || share == 1.0;
            assert!(!is_worst || dip >= 0.9 * bound, "{timing:?}, {share}: {dip:e} of {bound:e}");
        }
    }
}

/// In one step from far above the highest velocity to the lowest, which overshoots by more than a step between both.
#[test]
fn a_step_back_from_beyond_one_velocity_limit_keeps_the_other() {
    for timing in [Timing::Stretched, Timing::Fastest] {
        let planner = sine(timing, 0.8);
        let limits = planner.limits().velocity();
        for excess in [1e-6, 0.01, 0.1, 0.3] {
            let reachable = planner.reachable(limits.max + excess);
            let down = planner.ramp(0.0, limits.max + excess, reachable.min).unwrap().extrema().velocity;
            let slack = tolerance::LIMIT * limits.width();
            assert!(down.min >= limits.min - slack, "{timing:?}, {excess}: {down:?}");
            let reachable = planner.reachable(limits.min - excess);
            let up = planner.ramp(0.0, limits.min - excess, reachable.max).unwrap().extrema().velocity;
            assert!(up.max <= limits.max + slack, "{timing:?}, {excess}: {up:?}");
        }
    }
}

/// Of a change that exceeds the velocity limits' width the overshoot exceeds theirs in proportion.
#[test]
fn a_return_from_beyond_a_limit_leaves_as_much_more_room_as_it_overshoots_more() {
    for timing in [Timing::Stretched, Timing::Fastest] {
        let planner = sine(timing, 0.8);
        let (limits, inner) = (planner.limits().velocity(), planner.velocity());
        let margin = limits.max - inner.max;
        for excess in [0.003, 0.03, 0.3] {
            let more = margin * excess / inner.width();
            let above = planner.reachable(inner.max + excess).min - inner.min;
            let below = inner.max - planner.reachable(inner.min - excess).max;
            assert!(
                more > 0.0 && (above - more).abs() <= 1e-6 * margin,
                "{timing:?}, {excess}: {above:e}, {more:e}"
            );
            assert!((below - more).abs() <= 1e-6 * margin, "{timing:?}, {excess}: {below:e}, {more:e}");
        }
    }
}

/// Next to a velocity limit close to 0 the pulses are as small as their overshoot demands.
#[test]
fn a_velocity_limit_close_to_zero_leaves_small_pulses() {
    for velocity in [Interval::new(-1e-8, 0.15), Interval::new(-0.15, 1e-8)] {
        let spec = paper_spec(0.8);
        let position = spec.limits.position();
        let (acceleration, jerk) = (spec.limits.acceleration(), spec.limits.jerk());
        let limits = Limits::try_from(LimitsSpec { position, velocity, acceleration, jerk }).unwrap();
        let planner = Planner::try_from(PlannerSpec { limits, shape: Shape::SineQuintic, ..spec }).unwrap();
        let Interval { min, max } = planner.velocity();
        assert!(min < 0.0 && max > 0.0 && min - velocity.min <= 0.5e-8, "{min:e} to {max:e}");
    }
}

/// A detour's peak keeps 3e-5 of the limits' width at most, however slow the joint.
#[test]
fn a_detour_rises_to_the_velocity_limit_but_for_its_overshoot() {
    for velocity in [1e-4, 1e-2, 0.15] {
        let limits = jbtg::SymmetricLimits {
            position: Interval::new(0.14, 0.50),
            velocity,
            acceleration: 1.0,
            jerk: 100.0,
        };
        let limits = Limits::try_from(limits).unwrap();
        let planner =
            Planner::try_from(PlannerSpec { limits, shape: Shape::SineQuintic, ..paper_spec(0.8) }).unwrap();
        let peak = planner.detour(0.0, 0.0, Direction::Increasing).unwrap().peak;
        assert!(peak < velocity && velocity - peak <= 3e-5 * 2.0 * velocity, "{peak:e} of {velocity:e}");
    }
}

#[test]
fn a_refusal_names_its_numbers() {
    let planner = sine(Timing::Stretched, 0.05);
    let refused = planner.ramp(0.0, 0.0, 0.5).unwrap_err();
    let RampError::Unreachable { reachable, .. } = refused else { panic!("{refused:?}") };
    let text = refused.to_string();
    for number in [0.5, reachable.min, reachable.max] {
        assert!(text.contains(&number.to_string()), "{text}");
    }
    assert_eq!(planner.ramp(f64::NAN, 0.0, 0.0).unwrap_err().to_string(), "position must be finite, got NaN");
}
