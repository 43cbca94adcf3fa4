use jbtg::Planner;
use jbtg::strategies::planners;
use proptest::prelude::*;

use super::SafeZone;

/// The same zone without the short ways for joints far from a limit.
fn plodding<'a>(zone: &SafeZone<'a>) -> SafeZone<'a> {
    let mut zone = zone.clone();
    for braking in [&mut zone.upper, &mut zone.lower] {
        (braking.far_until, braking.free_until) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
    }
    zone
}

/// Positions right before and behind those at which a limit begins to matter, from `velocity` and at all.
fn edges(planner: &Planner, zone: &SafeZone<'_>, velocity: f64) -> [f64; 6] {
    let braking = &zone.upper;
    let way = |end: f64| end * braking.period + braking.distance(end);
    let reach = planner.displacement(velocity, velocity + braking.largest_climb);
    let from_here = braking.kept - reach - braking.distance(velocity + braking.largest_climb);
    let far = way(planner.velocity().max);
    let off = 1e-9 * far + 1e-12 * braking.limit.abs();
    [braking.far_until, from_here, braking.kept - far]
        .map(|edge| [edge - off, edge + off])
        .as_flattened()
        .try_into()
        .expect("six")
}

proptest! {
    #![proptest_config(ProptestConfig { max_global_rejects: u32::MAX, ..ProptestConfig::with_cases(500) })]

    #[test]
    fn the_short_ways_give_the_range_of_the_long_one(
        planner in planners(),
        starts in prop::collection::vec((-2.0..3.0, prop_oneof![Just(1.0), -0.2..1.2, -4.0..5.0]), 8),
    ) {
        let Ok(zone) = SafeZone::closed_form(planner) else { return Ok(()) };
        let (limits, bounds) = (planner.limits().position(), planner.velocity());
        for (position, velocity) in starts {
            let velocity = bounds.min + velocity * bounds.width();
            let inside = limits.min + position * limits.width();
            for position in [inside].into_iter().chain(edges(&planner, &zone, velocity)) {
                prop_assert_eq!(zone.range(position, velocity), plodding(&zone).range(position, velocity));
            }
        }
    }
}
