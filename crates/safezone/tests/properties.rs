//! What holds for every planner, state and policy.

use jbtg::strategies::planners;
use proptest::prelude::*;
use safezone::{BrakingTable, SafeZone};

use crate::adversary::{adversaries, run, safe_state};

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
}
