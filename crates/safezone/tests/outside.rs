//! Ranges from beyond a limit and from rest right at it: how wide they are, not only that they lead back.

use jbtg::strategies::planners;
use jbtg::{Direction, Interval, Limits, Planner, PlannerSpec, Shape, SymmetricLimits, Timing};
use proptest::prelude::*;
use safezone::{RangeStatus, Request, SafeZone, Side, Source};

use crate::telescope;
use crate::tolerance::LIMIT;

fn zone(limits: SymmetricLimits, shape: Shape, timing: Timing, period: f64) -> SafeZone<'static> {
    let limits = Limits::try_from(limits).expect("limits");
    let planner = Planner::try_from(PlannerSpec { limits, shape, timing, period }).expect("a period");
    SafeZone::closed_form(planner).expect("room to move")
}

/// About an ulp of the position for each period of the way to the other limit, and no more than twice that with what one
/// range rounds.
#[test]
fn from_beyond_a_limit_the_other_keeps_the_rounding_of_the_way() {
    let position = Interval::new(0.0, 1000.0);
    let limits = SymmetricLimits { position, velocity: 400.0, acceleration: 1.0, jerk: 100.0 };
    for timing in [Timing::Stretched, Timing::Fastest] {
        let zone = zone(limits, Shape::Smoothstep, timing, 0.1);
        let planner = zone.planner();
        let step = planner.authority(Direction::Decreasing).velocity_change;
        let mut judged = 0;
        for start in 1..=40 {
            let (mut position, mut velocity) = (-500.0 * f64::from(start), 0.0);
            while position < 0.0 {
                let range = zone.range(position, velocity);
                if range.brake < range.max && range.max < planner.reachable(velocity).max {
                    let way = planner.displacement(velocity, range.max) + zone.stopping_distance(range.max);
                    let ulps = (1000.0 - zone.guard(Side::Upper) - position - way)
                        / (f64::EPSILON * f64::max(-position, 1000.0));
                    let periods = range.max / step;
                    assert!(
                        0.8 * periods <= ulps && ulps <= 2.0 * periods + 40.0,
                        "{position:e}: {ulps} for {periods} periods"
                    );
                    judged += 1;
                }
                (position, velocity) = (position + planner.displacement(velocity, range.max), range.max);
            }
        }
        assert!(judged > 1000, "{judged} judged");
    }
}

/// Where the interval lies so far from 0 that the rounding of a whole way is wider than the interval, the way in is open
/// all the same.
#[test]
fn rounding_never_closes_the_way_in() {
    let position = Interval::new(1e12, 1e12 + 0.1);
    let limits = SymmetricLimits { position, velocity: 2e-6, acceleration: 1.5e-3, jerk: 1e3 };
    let zone = zone(limits, Shape::Smoothstep, Timing::Stretched, 1e-3);
    for beyond in [0.01, 0.1, 0.3, 1.0, 2.0, 10.0, 1e3] {
        let range = zone.range(1e12 - beyond, 0.0);
        assert_eq!(range.status, RangeStatus::PositionOutside);
        assert!(range.min > 0.0 && range.max == zone.planner().reachable(0.0).max, "{beyond}: {range:?}");
    }
}

/// A sine's step starts against its own direction: from rest next to a limit, towards it.
#[test]
fn a_step_away_from_a_limit_does_not_first_overrun_it() {
    for timing in [Timing::Stretched, Timing::Fastest] {
        let planner = telescope::planner(Shape::SineQuintic, timing);
        let zone = SafeZone::closed_form(planner).unwrap();
        let limit = telescope::POSITION.max;
        let mut moved = 0;
        for i in 0..=400 {
            let position = limit - 0.01 * f64::from(i) * zone.guard(Side::Upper);
            let range = zone.range(position, 0.0);
            let found = planner.ramp(position, 0.0, range.min).unwrap().extrema().position.max;
            assert!(found <= limit + LIMIT * telescope::POSITION.width(), "{:e} m beyond", found - limit);
            moved += i32::from(range.min == planner.reachable(0.0).min);
        }
        assert!(moved > 250, "{moved} have the whole range");
    }
}

#[test]
fn an_action_beyond_one_is_the_policy_s_but_clamped() {
    let zone = SafeZone::closed_form(telescope::planner(Shape::Smoothstep, Timing::Stretched)).unwrap();
    let command = |action| zone.command(0.3, 0.02, Request::Action(action));
    for action in [-1.0, -0.3, 0.0, 1.0] {
        assert_eq!(command(action).source, Source::Policy);
    }
    for action in [-1e300, -1.5, 1.0_f64.next_up(), 7.0] {
        assert_eq!(command(action).source, Source::PolicyClamped { action });
        assert_eq!(command(action).velocity, command(action.signum()).velocity);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { max_global_rejects: u32::MAX, ..ProptestConfig::with_cases(300) })]

    /// Or, if that would pass the other limit, what keeps it.
    #[test]
    fn from_rest_outside_the_slowest_way_back_is_half_of_what_a_period_can_do(planner in planners(), share in 1e-3..10.0) {
        let Ok(zone) = SafeZone::closed_form(planner) else { return Ok(()) };
        let limits = planner.limits().position();
        let above = zone.range(limits.max + share * limits.width(), 0.0);
        prop_assert_eq!(above.status, RangeStatus::PositionOutside);
        let slowest = -0.5 * planner.authority(Direction::Decreasing).velocity_change;
        prop_assert_eq!(above.max, slowest.max(above.min));
        let below = zone.range(limits.min - share * limits.width(), 0.0);
        let slowest = 0.5 * planner.authority(Direction::Increasing).velocity_change;
        prop_assert_eq!(below.min, slowest.min(below.max));
    }
}
