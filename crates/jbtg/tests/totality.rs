//! Nothing panics, whatever the input.

use jbtg::strategies::planners;
use std::num::NonZeroU32;

use jbtg::{
    Direction, Interval, Limits, LimitsSpec, Planner, PlannerError, PlannerSpec, RampError, Sampler, Shape,
    State, Synchronized, Timing,
};
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
                let end = p + planner.displacement(v1, v2);
                prop_assert!(!(p.is_finite() && v1.is_finite() && v2.is_finite() && end.is_finite()));
            }
            Err(RampError::Unreachable { .. }) => prop_assert!(!reachable.contains(v2)),
        }
        let _ = (planner.displacement(v1, v2), planner.authority(Direction::Increasing), planner.is_period_short());
        if let Ok(step) = planner.ramp_saturated(p, v1, v2) {
            prop_assert!(!step.segments().is_empty() && step.end().position.is_finite());
            prop_assert_eq!(step.control_points().count(), step.segments().len() + 1);
            prop_assert!(reachable.contains(step.end().velocity));
            let _ = (step.extrema(), step.state_at(v2), step.state_at(f64::NAN));
        }
    }

    #[test]
    fn a_sampler_takes_any_command_and_stays_finite(
        planner in planners(),
        ticks in 1_u32..9,
        p in numbers(),
        commands in prop::collection::vec((numbers(), any::<bool>()), 6),
    ) {
        let ticks = NonZeroU32::new(ticks).expect("some ticks");
        let Ok(mut sampler) = Sampler::at_rest(planner, ticks, p) else {
            prop_assert!(!p.is_finite());
            return Ok(());
        };
        for (velocity, saturated) in commands {
            let before = sampler.upcoming();
            let taken = if saturated { sampler.command_saturated(velocity).is_ok() } else { sampler.command(velocity).is_ok() };
            prop_assert!(!taken || velocity.is_finite());
            prop_assert_eq!(sampler.upcoming(), before);
            for _ in 0..ticks.get() {
                let State { position, velocity, acceleration, jerk } = sampler.advance().state;
                prop_assert!([position, velocity, acceleration, jerk].iter().all(|x| x.is_finite()));
            }
        }
    }

    #[test]
    fn synchronized_joints_take_any_numbers(
        planners in [planners(), planners()],
        course in any::<bool>(),
        p in [numbers(), numbers()],
        v1 in [numbers(), numbers()],
        v2 in [numbers(), numbers()],
        inside in any::<bool>(),
    ) {
        let period = planners[0].period();
        let second = Planner::try_from(PlannerSpec { period, ..*planners[1].spec() });
        let Ok(second) = second else { return Ok(()) };
        let planners = [planners[0], second];
        let joints = if course { Synchronized::in_step(planners) } else { Synchronized::new(planners) };
        let Ok(joints) = joints else { return Ok(()) };
        let v1 = if inside { [joints.planners()[0].velocity().clamp(v1[0]), joints.planners()[1].velocity().clamp(v1[1])] } else { v1 };
        match joints.ramp(p, v1, v2) {
            Ok(step) => {
                prop_assert!((0.0..=1.0).contains(&step.share));
                for (planner, (trajectory, from)) in joints.planners().iter().zip(step.trajectories.iter().zip(v1)) {
                    prop_assert!(planner.reachable(from).contains(trajectory.end().velocity));
                }
            }
            Err(_) => {
                let finite = p.iter().chain(&v1).chain(&v2).all(|x| x.is_finite());
                let inside = joints.planners().iter().zip(v1).all(|(planner, v)| planner.velocity().contains(v));
                prop_assert!(!finite || !inside);
            }
        }
        let _ = joints.periods(&v1, &v2);
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

/// 60·b₅ of its quintics is infinite, though every coefficient is finite.
#[test]
fn limits_whose_jerk_would_overflow_are_refused() {
    let limits = Limits::try_from(LimitsSpec {
        position: Interval::symmetric(1.0),
        velocity: Interval::new(-1.0, 1.45e249),
        acceleration: Interval::new(-1.0, 3.59e120),
        jerk: Interval::new(-1.85e192, 4.09e295),
    })
    .unwrap();
    let spec = PlannerSpec { limits, shape: Shape::Smoothstep, timing: Timing::Stretched, period: 3.8e-57 };
    let error = Planner::try_from(spec).unwrap_err();
    assert!(matches!(error, PlannerError::OutOfScale { .. }), "{error}");
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

#[test]
fn a_change_too_small_for_an_acceleration_is_a_motion_all_the_same() {
    let limits = Limits::try_from(LimitsSpec {
        position: Interval::new(0.0, 1.0),
        velocity: Interval::symmetric(1.0),
        acceleration: Interval::symmetric(1.0),
        jerk: Interval::symmetric(10.0),
    })
    .unwrap();
    for timing in [Timing::Stretched, Timing::Fastest] {
        let spec = PlannerSpec { limits, shape: Shape::Smoothstep, timing, period: 10.0 };
        let planner = Planner::try_from(spec).unwrap();
        for v2 in [5e-324, -5e-324, 1e-322] {
            let step = planner.ramp(0.5, 0.0, v2).unwrap();
            assert!(!step.segments().is_empty(), "no quintic towards {v2:e}");
            assert_eq!(step.state_at(5.0).position, 0.5);
            assert_eq!(step.end().velocity, v2);
        }
    }
}

#[test]
fn a_final_position_that_overflows_is_refused() {
    let limits = Limits::try_from(LimitsSpec {
        position: Interval::new(0.0, 1.0),
        velocity: Interval::symmetric(1e300),
        acceleration: Interval::symmetric(1e100),
        jerk: Interval::symmetric(1e101),
    })
    .unwrap();
    let spec = PlannerSpec { limits, shape: Shape::Smoothstep, timing: Timing::Stretched, period: 10.0 };
    let planner = Planner::try_from(spec).unwrap();
    let error = planner.ramp(f64::MAX, 1e300, 1e300).unwrap_err();
    assert!(matches!(error, RampError::NotFinite { name: "final position", .. }), "{error}");
    assert!(planner.ramp_saturated(f64::MAX, 1e300, 1e300).is_err());
}

#[test]
fn a_period_that_leaves_nothing_is_refused_and_a_short_one_is_not() {
    let limits = Limits::try_from(LimitsSpec {
        position: Interval::new(0.14, 0.5),
        velocity: Interval::symmetric(0.15),
        acceleration: Interval::symmetric(1.0),
        jerk: Interval::symmetric(100.0),
    })
    .unwrap();
    let planner = |period| {
        Planner::try_from(PlannerSpec { limits, shape: Shape::Smoothstep, timing: Timing::Stretched, period })
    };
    // Two full ramps of 15 ms just fit into 30 ms, and leave half.
    let share = |period| planner(period).unwrap().authority(Direction::Increasing).share;
    assert!((share(0.03) - 0.5).abs() < 1e-12);
    assert!(planner(0.0299).unwrap().is_period_short() && !planner(0.0301).unwrap().is_period_short());
    // Below, the ramps take all of the period, and the share is period/60 ms.
    for period in [0.02, 0.001, 1e-5] {
        assert!((share(period) - period / 0.06).abs() < 1e-12, "{period}: {}", share(period));
    }
    match planner(5e-6) {
        Err(PlannerError::PeriodTooShort { period, share }) => {
            assert!(period == 5e-6 && (share - 5e-6 / 0.06).abs() < 1e-12);
        }
        other => panic!("5 µs leave 8.3e-5 of the acceleration limit: {other:?}"),
    }
}
