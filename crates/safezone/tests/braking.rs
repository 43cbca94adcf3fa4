//! One braking for all: the zone's fail-safe, the sampler's brake, and the stop that a planner makes of any state.

use std::num::NonZeroU32;

use jbtg::strategies::planners;
use jbtg::{Direction, Origin, Sampler, State};
use proptest::prelude::*;
use safezone::{Request, SafeZone};

proptest! {
    #![proptest_config(ProptestConfig { max_global_rejects: u32::MAX, ..ProptestConfig::with_cases(1000) })]

    #[test]
    fn a_sampler_without_a_command_brakes_as_the_fail_safe_does(
        planner in planners(),
        shares in prop::collection::vec(0.0..=1.0, 1..8),
    ) {
        let Ok(zone) = SafeZone::closed_form(planner) else { return Ok(()) };
        let limits = planner.limits().position();
        let middle = 0.5 * (limits.min + limits.max);
        let mut sampler = Sampler::at_rest(planner, NonZeroU32::MIN, middle)?;
        for share in shares {
            let now = sampler.upcoming();
            let range = zone.range(now.position, now.velocity);
            sampler.command(range.max.min(range.min + share * (range.max - range.min)))?;
            sampler.advance();
        }
        for _ in 0..100 {
            let now = sampler.upcoming();
            let command = zone.command(now.position, now.velocity, Request::Missing);
            prop_assert_eq!(sampler.advance().origin, Origin::Brake);
            prop_assert_eq!(sampler.state().velocity.to_bits(), (command.velocity + 0.0).to_bits());
        }
    }

    /// A stop right away takes no longer way than braking step by step, so what the zone keeps free suffices for it.
    #[test]
    fn a_stop_travels_no_farther_than_the_zone_s_stopping_distance(planner in planners(), share in 0.0..=1.0) {
        let Ok(zone) = SafeZone::closed_form(planner) else { return Ok(()) };
        let bounds = planner.velocity();
        let velocity = bounds.clamp(bounds.min + share * bounds.width());
        let stop = planner.stop(State { velocity, ..State::default() })?.trajectory;
        let distance = zone.stopping_distance(velocity);
        let travel = stop.extrema().position;
        prop_assert!(travel.max.max(-travel.min) <= distance * (1.0 + 1e-12), "{travel:?} {distance:e}");
        let direction = if velocity > 0.0 { Direction::Decreasing } else { Direction::Increasing };
        let periods = (velocity.abs() / planner.authority(direction).velocity_change).ceil();
        prop_assert!(stop.duration() <= planner.period() * (periods + 1e-9), "{} s, {periods} periods", stop.duration());
    }
}
