//! How narrow a position interval may be, and what a range says of itself.

use jbtg::strategies::planners;
use jbtg::{Interval, Limits, LimitsSpec, Planner, PlannerSpec, Shape, Timing};
use proptest::prelude::*;
use safezone::{SafeZone, Side, ZoneError};

use crate::adversary::safe_state;

/// Refused are intervals that both guards leave no half of.
#[test]
fn an_interval_is_too_narrow_once_its_guards_take_half_of_it() {
    let (mut refused, mut accepted) = (0, 0);
    for i in 0..200 {
        let width = 1e-12 * 1.1_f64.powi(i);
        let limits = Limits::try_from(LimitsSpec {
            position: Interval::new(1000.0, 1000.0 + width),
            velocity: Interval::new(-0.1, 0.2),
            acceleration: Interval::new(-1.0, 2.0),
            jerk: Interval::new(-100.0, 50.0),
        })
        .unwrap();
        let (shape, timing) = (Shape::SineQuintic, Timing::Stretched);
        let planner = Planner::try_from(PlannerSpec { limits, shape, timing, period: 0.05 }).unwrap();
        let width = limits.position().width();
        match SafeZone::closed_form(planner) {
            Ok(zone) => {
                let guards = [Side::Upper, Side::Lower].map(|side| zone.guard(side));
                assert!(guards.iter().all(|guard| *guard > 0.0));
                assert!(guards.iter().sum::<f64>() < 0.5 * width, "{guards:?} of {width:e}");
                accepted += 1;
            }
            Err(ZoneError::Narrow { width: found, guard }) => {
                assert_eq!((found, accepted), (width, 0), "a wider interval is no narrower");
                assert!(guard >= 0.5 * width, "{guard:e} of {width:e}");
                refused += 1;
            }
            Err(other) => panic!("{other:?}"),
        }
    }
    assert!(refused > 10 && accepted > 10, "{refused} refused, {accepted} accepted");
}

proptest! {
    #![proptest_config(ProptestConfig { max_global_rejects: u32::MAX, ..ProptestConfig::with_cases(1000) })]

    #[test]
    fn a_range_holds_what_is_between_its_ends_and_says_whether_a_limit_narrowed_it(
        planner in planners(),
        start in (0.0..=1.0, prop_oneof![Just(0.0), Just(1.0), 0.0..=1.0]),
    ) {
        let Ok(zone) = SafeZone::closed_form(planner) else { return Ok(()) };
        let (position, velocity) = safe_state(&zone, start);
        let range = zone.range(position, velocity);
        for inside in [range.min, range.brake, range.max] {
            prop_assert!(range.contains(inside));
        }
        for outside in [range.min.next_down(), range.max.next_up(), f64::NAN] {
            prop_assert!(!range.contains(outside));
        }
        let reachable = planner.reachable(velocity);
        prop_assert_eq!(range.narrowed, range.min > reachable.min || range.max < reachable.max);
    }
}
