//! What several modules share.

use jbtg::{Interval, Limits, Planner, PlannerSpec, Shape, SymmetricLimits, Timing};

/// The paper's telescope.
pub(crate) fn paper_spec(period: f64) -> PlannerSpec {
    let limits = SymmetricLimits {
        position: Interval::new(0.14, 0.50),
        velocity: 0.15,
        acceleration: 1.0,
        jerk: 100.0,
    };
    let limits = Limits::try_from(limits).expect("limits around zero");
    PlannerSpec { limits, shape: Shape::Smoothstep, timing: Timing::Stretched, period }
}

pub(crate) fn paper_planner(period: f64) -> Planner {
    Planner::try_from(paper_spec(period)).expect("a period of many ramps")
}

/// The point of `interval` at `share` of its width.
pub(crate) fn within(interval: Interval, share: f64) -> f64 {
    interval.clamp(interval.min + share * interval.width())
}
