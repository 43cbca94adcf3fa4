//! The serde form: what it accepts, and that it keeps every bit.

use jbtg::strategies::planners;
use jbtg::{Limits, PlannerSpec};
use proptest::prelude::*;

proptest! {
    #[test]
    fn a_specification_survives_its_text_bit_for_bit(planner in planners()) {
        let text = ron::to_string(planner.spec())?;
        prop_assert_eq!(&ron::from_str::<PlannerSpec>(&text)?, planner.spec());
    }
}

#[track_caller]
fn check_refused(text: &str, reason: &str) {
    let error = ron::from_str::<Limits>(text).expect_err("bad limits").to_string();
    assert!(error.contains(reason), "expected {reason:?} in {error:?}");
}

#[test]
fn limits_from_text_pass_the_same_gate() {
    let limits = |jerk: &str| {
        format!(
            "(position: (min: 0, max: 1), velocity: (min: -1, max: 1), acceleration: (min: -1, max: 1), jerk: {jerk})"
        )
    };
    assert!(ron::from_str::<Limits>(&limits("(min: -9, max: 9)")).is_ok());
    check_refused(&limits("(min: 0, max: 9)"), "jerk limits must satisfy min < 0 < max");
    check_refused(&limits("(min: -9, max: inf)"), "jerk limit must be finite, got inf");
    check_refused(&limits("(min: -9, max: 9, mean: 0)"), "mean");
    check_refused(&limits("(min: -9, max: 9), snap: 1"), "snap");
}
