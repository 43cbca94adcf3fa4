//! What holds for every planner, state and policy.

use jbtg::strategies::planners;
use jbtg::{Interval, Limits, LimitsSpec, Planner, PlannerSpec, Shape, Timing};
use proptest::prelude::*;
use safezone::{BrakingTable, SafeZone, Samples};

use crate::adversary::{ADVERSARIES, adversaries, run, safe_state};

/// Consecutive adversarial steps of one case.
const STEPS: usize = 250;

/// Cases per property; `EXTENSIVE=n` multiplies them by n.
fn cases(plain: u32) -> ProptestConfig {
    let factor = std::env::var("EXTENSIVE").ok().and_then(|text| text.parse().ok()).unwrap_or(1);
    ProptestConfig { max_global_rejects: u32::MAX, ..ProptestConfig::with_cases(plain * factor) }
}

/// Where in an interval: often its very ends.
fn shares() -> impl Strategy<Value = f64> {
    prop_oneof![1 => Just(0.0), 1 => Just(1.0), 1 => Just(0.5), 5 => 0.0..=1.0]
}

/// A sine's step from its lowest velocity to its highest overshoots most with the jerk bounds this far apart.
#[test]
fn steps_between_unequal_jerk_bounds_keep_every_limit() {
    let limits = Limits::try_from(LimitsSpec {
        position: Interval::new(-4.0, 4.0),
        velocity: Interval::symmetric(1.0),
        acceleration: Interval::symmetric(1.0),
        jerk: Interval::new(-1.0, 0.49),
    })
    .unwrap();
    let (shape, timing) = (Shape::SineQuintic, Timing::Stretched);
    let planner = Planner::try_from(PlannerSpec { limits, shape, timing, period: 1.0 }).unwrap();
    let zone = SafeZone::closed_form(planner).unwrap();
    for start in [(0.0, 0.4218), (0.4218, 0.0), (0.4218, 1.0), (1.0, 0.4218)] {
        for adversary in ADVERSARIES {
            run(&zone, safe_state(&zone, start), (adversary, 7), STEPS).unwrap();
        }
    }
}

proptest! {
    #![proptest_config(cases(1_000))]

    #[test]
    fn no_policy_leaves_any_limit(
        planner in planners(),
        start in (shares(), shares()),
        adversary in (adversaries(), any::<u64>()),
    ) {
        let Ok(zone) = SafeZone::closed_form(planner) else { return Ok(()) };
        let result = run(&zone, safe_state(&zone, start), adversary, STEPS);
        prop_assert!(result.is_ok(), "{}", result.unwrap_err());
    }

    #[test]
    fn no_policy_leaves_any_limit_with_a_table(
        planner in planners(),
        start in (shares(), shares()),
        adversary in (adversaries(), any::<u64>()),
    ) {
        let Ok(table) = BrakingTable::build(&planner) else { return Ok(()) };
        let Ok(zone) = SafeZone::new(planner, table) else { return Ok(()) };
        let result = run(&zone, safe_state(&zone, start), adversary, STEPS);
        prop_assert!(result.is_ok(), "{}", result.unwrap_err());
    }

    #[test]
    fn no_policy_leaves_any_limit_with_samples(
        planner in planners(),
        start in (shares(), shares()),
        adversary in (adversaries(), any::<u64>()),
    ) {
        let mut samples = Samples::default();
        let Ok(zone) = SafeZone::sampled(planner, &mut samples) else { return Ok(()) };
        let result = run(&zone, safe_state(&zone, start), adversary, STEPS);
        prop_assert!(result.is_ok(), "{}", result.unwrap_err());
    }
}
