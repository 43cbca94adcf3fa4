//! States that no step of ours leads to: outside the limits, too fast, not finite.

use jbtg::strategies::planners;
use jbtg::{Direction, Interval, Limits, Planner, PlannerSpec, Shape, SymmetricLimits, Timing};
use proptest::num::f64::ANY;
use proptest::prelude::*;
use safezone::{BrakingTable, FailSafeReason, RangeStatus, Request, SafeZone, Samples, Source};

use crate::adversary::safe_state;
use crate::tolerance::LIMIT;

fn least_change(planner: &Planner) -> f64 {
    let [up, down] =
        [Direction::Increasing, Direction::Decreasing].map(|d| planner.authority(d).velocity_change);
    up.min(down)
}

fn actions() -> impl Strategy<Value = f64> {
    prop_oneof![Just(-1.0), Just(1.0), -1.0..=1.0]
}

/// From far beyond one limit there is more room to the other than a table, which ends with the interval's width, tells
/// distances for.
#[test]
fn the_way_back_from_afar_stops_at_the_other_limit() {
    let position = Interval::new(0.0, 0.01);
    let symmetric = SymmetricLimits { position, velocity: 0.5, acceleration: 1.0, jerk: 100.0 };
    let limits = Limits::try_from(symmetric).unwrap();
    for timing in [Timing::Stretched, Timing::Fastest] {
        let shape = Shape::Smoothstep;
        let planner = Planner::try_from(PlannerSpec { limits, shape, timing, period: 0.05 }).unwrap();
        let table = BrakingTable::build(&planner).unwrap();
        let mut samples = Samples::default();
        let closed_form = SafeZone::closed_form(planner).unwrap();
        let sampled = SafeZone::sampled(planner, &mut samples).unwrap();
        for zone in [SafeZone::new(planner, table).unwrap(), closed_form, sampled] {
            for (start, action) in [(0.31, -1.0), (-0.3, 1.0)] {
                let (mut position, mut velocity) = (start, 0.0);
                for step in 0..200 {
                    let next = zone.command(position, velocity, action).velocity;
                    let ramp = planner.ramp(position, velocity, next).unwrap();
                    let found = ramp.extrema().position;
                    let beyond = if action < 0.0 { -found.min } else { found.max - 0.01 };
                    assert!(beyond <= LIMIT * 0.01, "step {step} from {start} ({timing:?}): {beyond:e}");
                    (position, velocity) = (ramp.end().position, ramp.end().velocity);
                }
                let limit = if action < 0.0 { 0.0 } else { 0.01 };
                assert!(
                    velocity.abs() < 1e-9 && (position - limit).abs() < 1e-4,
                    "{position:e}, {velocity:e}"
                );
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { max_global_rejects: u32::MAX, ..ProptestConfig::with_cases(1500) })]

    #[test]
    fn every_bit_pattern_has_a_range(planner in planners(), position in ANY, velocity in ANY, action in ANY) {
        let Ok(zone) = SafeZone::closed_form(planner) else { return Ok(()) };
        let command = zone.command(position, velocity, action);
        let range = command.range;
        prop_assert!(range.min <= range.brake && range.brake <= range.max, "{range:?}");
        prop_assert!(range.contains(command.velocity), "{command:?}");
        let finite = position.is_finite() && velocity.is_finite();
        prop_assert_eq!(range.status == RangeStatus::Unknown, !finite);
        if finite {
            prop_assert!(zone.planner().ramp(position, velocity, command.velocity).is_ok(), "{command:?}");
        } else {
            prop_assert_eq!(command.source, Source::FailSafe(FailSafeReason::UnknownState));
        }
    }

    #[test]
    fn an_impossible_velocity_falls_in_every_period_until_it_is_possible(
        planner in planners(),
        (share, excess) in (0.0..=1.0, 1e-3..5.0),
        upward in any::<bool>(),
        action in actions(),
    ) {
        let Ok(zone) = SafeZone::closed_form(planner) else { return Ok(()) };
        let bounds = planner.limits().velocity();
        let change = least_change(&planner);
        let mut velocity = if upward { bounds.max + excess * change } else { bounds.min - excess * change };
        let limits = planner.limits().position();
        let mut position = limits.min + share * limits.width();
        prop_assert_ne!(zone.range(position, velocity).status, RangeStatus::Safe);
        for _ in 0..100 {
            if planner.velocity().contains(velocity) {
                return Ok(());
            }
            let next = zone.command(position, velocity, action).velocity;
            let possible = planner.velocity().contains(next);
            prop_assert!(possible || next.abs() < velocity.abs(), "{velocity:e} to {next:e}");
            let step = planner.ramp(position, velocity, next)?;
            (position, velocity) = (step.end().position, step.end().velocity);
        }
        prop_assert!(false, "still {velocity:e} for {bounds:?}");
    }

    #[test]
    fn a_way_back_from_too_fast_keeps_the_opposite_velocity_limit(
        planner in planners(),
        share in 0.0..=1.0,
        excess in prop_oneof![-1e-4..1e-4, 0.0..5.0],
        upward in any::<bool>(),
    ) {
        let Ok(zone) = SafeZone::closed_form(planner) else { return Ok(()) };
        let (ends, limits) = (planner.velocity(), planner.limits().velocity());
        let velocity =
            if upward { ends.max + excess * ends.width() } else { ends.min - excess * ends.width() };
        let position = planner.limits().position();
        let range = zone.range(position.min + share * position.width(), velocity);
        if range.status == RangeStatus::Safe {
            prop_assert!(ends.contains(velocity), "{velocity:e} overshoots {limits:?}");
        }
        for next in [range.min, range.max] {
            let found = planner.ramp(0.5 * (position.min + position.max), velocity, next)?.extrema().velocity;
            let beyond = if upward { limits.min - found.min } else { found.max - limits.max };
            prop_assert!(beyond <= LIMIT * limits.width(), "{velocity:e} to {next:e}: {beyond:e}");
        }
    }

    #[test]
    fn the_fail_safe_brings_the_joint_to_rest_inside(
        planner in planners(),
        start in (0.0..=1.0, 0.0..=1.0),
        request in prop::sample::select(vec![
            Request::Missing, Request::Late, Request::Action(f64::NAN), Request::Action(f64::INFINITY),
        ]),
    ) {
        let Ok(zone) = SafeZone::closed_form(planner) else { return Ok(()) };
        let (mut position, mut velocity) = safe_state(&zone, start);
        let steps = velocity.abs() / least_change(&planner);
        prop_assume!(steps < 5000.0);
        let stop = position + velocity.signum() * zone.stopping_distance(velocity);
        for _ in 0..=steps as usize + 1 {
            let command = zone.command(position, velocity, request);
            prop_assert!(matches!(command.source, Source::FailSafe(_)));
            prop_assert!(command.velocity.abs() <= velocity.abs() && command.velocity * velocity >= 0.0);
            let step = planner.ramp(position, velocity, command.velocity)?;
            (position, velocity) = (step.end().position, step.end().velocity);
        }
        prop_assert_eq!(velocity, 0.0);
        let guard = zone.guard(safezone::Side::Upper).max(zone.guard(safezone::Side::Lower));
        prop_assert!((position - stop).abs() <= guard, "{position:e}, {stop:e} was foretold");
    }
}
