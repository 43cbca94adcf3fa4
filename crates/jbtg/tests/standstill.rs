//! Where trajectories come to a standstill.

use jbtg::strategies::planners;
use jbtg::{Direction, State};
use proptest::prelude::*;

use crate::properties::{cases, shares, within};
use crate::tolerance;

proptest! {
    #![proptest_config(cases(20_000))]

    #[test]
    fn the_velocity_is_zero_at_a_standstill_and_of_one_sign_before(
        planner in planners(),
        shares in (shares(), shares()),
        is_detour in any::<bool>(),
    ) {
        let v1 = within(planner.velocity(), shares.0);
        let v2 = within(planner.reachable(v1), shares.1);
        let step = if is_detour {
            planner.farthest(0.0, v1, v2, Direction::Increasing)?
        } else {
            planner.ramp(0.0, v1, v2)?
        };
        let still = step.standstill();
        // Of velocities, and of the time at which they are asked for.
        let width = planner.velocity().width() + planner.period() * planner.limits().acceleration().width();
        let rounding = tolerance::JOINT_ULPS * f64::EPSILON * width;
        let until = still.map_or(step.duration(), |still| still.time);
        let velocities = (0..=256).map(|i| step.state_at(until * f64::from(i) / 256.0).velocity);
        let (min, max) = velocities.fold((f64::INFINITY, f64::NEG_INFINITY), |(min, max), v| (min.min(v), max.max(v)));
        prop_assert!(min >= -rounding || max <= rounding, "velocity {min:e} to {max:e} before {still:?}");
        if let Some(still) = still {
            let State { position, velocity, .. } = step.state_at(still.time);
            prop_assert!(velocity.abs() <= rounding, "{velocity:e} at {still:?}");
            let travelled = planner.period() * planner.velocity().width();
            prop_assert!((position - still.state.position).abs() <= tolerance::JOINT_ULPS * f64::EPSILON * travelled);
            prop_assert_eq!(still.state.velocity, 0.0);
        } else {
            prop_assert!(v1 * v2 > 0.0);
        }
    }

    #[test]
    fn a_stop_is_at_a_standstill_at_its_end_or_where_it_turns(planner in planners(), shares in (shares(), shares(), shares())) {
        let v1 = within(planner.velocity(), shares.0);
        let v2 = within(planner.reachable(v1), shares.1);
        let step = planner.ramp(0.0, v1, v2)?;
        let stop = planner.stop(step.state_at(shares.2 * step.duration()))?.trajectory;
        let still = stop.standstill().expect("a stop");
        prop_assert!(still.time <= stop.duration());
        prop_assert!(still.time == stop.duration() || stop.extrema().velocity.min < 0.0 || still.time == 0.0
            || stop.extrema().velocity.max > 0.0);
    }
}
