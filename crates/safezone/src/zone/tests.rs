use jbtg::strategies::planners;
use jbtg::{Interval, Limits, Planner, PlannerSpec, Shape, SymmetricLimits, Timing};
use proptest::prelude::*;

use super::SafeZone;

/// The same zone without the short way for joints far from a limit.
fn plodding<'a>(zone: &SafeZone<'a>) -> SafeZone<'a> {
    let mut zone = zone.clone();
    zone.upper.set_longest_stop(f64::INFINITY);
    zone.lower.set_longest_stop(f64::INFINITY);
    zone
}

/// The farthest position at which a period at the largest velocity and a stop from it fit in front of the upper limit.
fn edge_of_far(zone: &SafeZone<'_>) -> f64 {
    let braking = &zone.upper;
    braking.limit - braking.guard - (braking.velocity * braking.period + braking.distance(braking.velocity))
}

/// Coming in from beyond the lower limit, where nothing is too near the upper one but for the rounding of the way.
#[test]
fn the_short_way_is_not_taken_where_the_way_in_rounds() {
    for timing in [Timing::Stretched, Timing::Fastest] {
        let position = Interval::new(0.14, 0.145);
        let limits = SymmetricLimits { position, velocity: 0.15, acceleration: 1.0, jerk: 100.0 };
        let limits = Limits::try_from(limits).expect("limits");
        let shape = Shape::Smoothstep;
        let planner =
            Planner::try_from(PlannerSpec { limits, shape, timing, period: 0.05 }).expect("a period");
        let zone = SafeZone::closed_form(planner).expect("a zone");
        let (edge, fastest) = (edge_of_far(&zone), zone.upper.velocity);
        assert!(edge < position.min && zone.upper.is_far(edge.next_down()));
        let range = zone.range(edge.next_down(), fastest);
        assert!(range.max < fastest, "{range:?}");
        assert_eq!(range, plodding(&zone).range(edge.next_down(), fastest));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { max_global_rejects: u32::MAX, ..ProptestConfig::with_cases(500) })]

    #[test]
    fn the_short_way_far_from_a_limit_gives_the_range_of_the_long_one(
        planner in planners(),
        starts in prop::collection::vec((-2.0..3.0, prop_oneof![Just(1.0), -0.2..1.2, -4.0..5.0]), 8),
    ) {
        let Ok(zone) = SafeZone::closed_form(planner) else { return Ok(()) };
        let (limits, bounds) = (planner.limits().position(), planner.velocity());
        for (position, velocity) in starts {
            let velocity = bounds.min + velocity * bounds.width();
            let edge = edge_of_far(&zone);
            let off = 1e-9 * (zone.upper.limit - edge) + 1e-12 * edge.abs();
            for position in [limits.min + position * limits.width(), edge - off, edge + off] {
                prop_assert_eq!(zone.range(position, velocity), plodding(&zone).range(position, velocity));
            }
        }
    }
}
