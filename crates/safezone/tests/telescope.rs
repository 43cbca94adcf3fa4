//! The joint of the worked examples.

use jbtg::{Interval, Limits, Planner, PlannerSpec, Shape, SymmetricLimits, Timing};

/// Position interval [m].
pub(crate) const POSITION: Interval = Interval::new(0.14, 0.50);

/// A joint with the paper's numbers: 0.15 m/s, 1 m/s², 100 m/s³, a step every 50 ms.
pub(crate) fn planner(shape: Shape, timing: Timing) -> Planner {
    let limits = SymmetricLimits { position: POSITION, velocity: 0.15, acceleration: 1.0, jerk: 100.0 };
    let limits = Limits::try_from(limits).expect("the paper's limits");
    Planner::try_from(PlannerSpec { limits, shape, timing, period: 0.05 }).expect("the paper's period")
}

pub(crate) const ALL: [(Shape, Timing); 4] = [
    (Shape::Smoothstep, Timing::Stretched),
    (Shape::Smoothstep, Timing::Fastest),
    (Shape::SineQuintic, Timing::Stretched),
    (Shape::SineQuintic, Timing::Fastest),
];
