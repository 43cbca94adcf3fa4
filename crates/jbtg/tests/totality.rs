//! Nothing panics, whatever the input.

use jbtg::strategies::planners;
use jbtg::{Interval, Limits, LimitsSpec, Planner, PlannerSpec, RampError, Shape, Timing};
use proptest::num::f64::ANY;
use proptest::prelude::*;

use crate::tolerance;

/// Any bit pattern: NaN, infinities, zeros and subnormal numbers included, and the largest ones more often than chance.
fn numbers() -> impl Strategy<Value = f64> {
    let special = [0.0, -0.0, f64::MIN_POSITIVE, 5e-324, f64::MAX, f64::MIN, f64::NAN, f64::INFINITY];
    prop_oneof![6 => ANY, 1 => prop::sample::select(special.to_vec()), 3 => -1e3..1e3]
}

/// Magnitudes over all of double precision's range.
fn magnitudes() -> impl Strategy<Value = f64> {
    prop_oneof![3 => (-320.0..308.3_f64).prop_map(|e| 10_f64.powf(e)), 1 => (-9.0..9.0_f64).prop_map(|e| 10_f64.powf(e))]
}

fn specs() -> impl Strategy<Value = (LimitsSpec, f64)> {
    let interval = || (magnitudes(), magnitudes()).prop_map(|(a, b)| Interval::new(-a, b));
    let spec = (interval(), interval(), interval(), interval()).prop_map(
        |(position, velocity, acceleration, jerk)| LimitsSpec { position, velocity, acceleration, jerk },
    );
    (spec, magnitudes())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn a_step_is_finite_or_refused(planner in planners(), p in numbers(), v1 in numbers(), v2 in numbers()) {
        let reachable = planner.reachable(v1);
        prop_assert!(v1.is_nan() || reachable.min <= reachable.max || !v1.is_finite(), "{reachable:?} from {v1:e}");
        match planner.ramp(p, v1, v2) {
            Ok(step) => prop_assert!(reachable.contains(v2) && step.end().velocity == v2),
            Err(RampError::NotFinite { .. }) => {
                prop_assert!(!(p.is_finite() && v1.is_finite() && v2.is_finite()));
            }
            Err(RampError::Unreachable { .. }) => prop_assert!(!reachable.contains(v2)),
        }
        if let Ok(step) = planner.ramp_saturated(p, v1, v2) {
            prop_assert!(reachable.contains(step.end().velocity));
            let _ = (step.extrema(), step.state_at(v2), step.state_at(f64::NAN));
        }
    }

    #[test]
    fn limits_of_any_size_are_planned_with_or_refused(
        (spec, period) in specs(),
        shape in jbtg::strategies::shapes(),
        timing in jbtg::strategies::timings(),
    ) {
        let Ok(limits) = Limits::try_from(spec) else { return Ok(()) };
        let Ok(planner) = Planner::try_from(PlannerSpec { limits, shape, timing, period }) else { return Ok(()) };
        for v1 in [planner.velocity().min, 0.0, planner.velocity().max] {
            let reachable = planner.reachable(v1);
            for v2 in [reachable.min, 0.5 * reachable.min + 0.5 * reachable.max, reachable.max] {
                let extrema = planner.ramp(0.0, v1, reachable.clamp(v2))?.extrema();
                let pairs = [
                    (extrema.velocity, limits.velocity()),
                    (extrema.acceleration, limits.acceleration()),
                    (extrema.jerk, limits.jerk()),
                ];
                for (found, limit) in pairs {
                    let excess = (found.max - limit.max).max(limit.min - found.min);
                    prop_assert!(excess <= tolerance::LIMIT * limit.width(), "{found:?} exceeds {limit:?}");
                }
            }
        }
    }
}

#[test]
fn numbers_that_are_no_limits_are_refused() {
    let good = LimitsSpec {
        position: Interval::new(0.0, 1.0),
        velocity: Interval::symmetric(1.0),
        acceleration: Interval::symmetric(1.0),
        jerk: Interval::symmetric(10.0),
    };
    for bad in [0.0, -0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let interval = Interval::new(-1.0, bad);
        let specs = [
            LimitsSpec { velocity: interval, ..good },
            LimitsSpec { acceleration: interval, ..good },
            LimitsSpec { jerk: interval, ..good },
            LimitsSpec { position: Interval::new(0.0, bad), ..good },
        ];
        for spec in specs {
            assert!(Limits::try_from(spec).is_err(), "{bad} was accepted in {spec:?}");
        }
    }
}

#[test]
fn numbers_that_are_no_period_are_refused() {
    let limits = Limits::try_from(LimitsSpec {
        position: Interval::new(0.0, 1.0),
        velocity: Interval::symmetric(1.0),
        acceleration: Interval::symmetric(1.0),
        jerk: Interval::symmetric(10.0),
    })
    .unwrap();
    for period in [0.0, -0.0, -1.0, 5e-324, 1e-300, 1e-9, 1e300, f64::MAX, f64::NAN, f64::INFINITY] {
        for timing in [Timing::Stretched, Timing::Fastest] {
            let spec = PlannerSpec { limits, shape: Shape::Smoothstep, timing, period };
            assert!(Planner::try_from(spec).is_err(), "{period} was accepted with {timing:?}");
        }
    }
}
