//! Proptest strategies: every planner that double precision can hold, over six decades of each limit.

use proptest::prelude::*;

use crate::{Interval, Limits, LimitsSpec, Planner, PlannerSpec, Shape, Timing};

/// Planners of all shapes and timings, periods 1 ms to 1 s, bounds that differ between the directions by up to a
/// factor of ten.
///
/// Three in four have limits in proportion to each other, so that all of them come into play; the others draw each from
/// six decades on its own. The position interval may lie up to a thousand times its width away from 0.
pub fn planners() -> impl Strategy<Value = Planner> {
    (prop_oneof![3 => proportionate_limits(), 1 => independent_limits()], shapes(), timings())
        .prop_filter_map(
            "the limits and the period are out of proportion",
            |((limits, period), shape, timing)| {
                Planner::try_from(PlannerSpec { limits, shape, timing, period }).ok()
            },
        )
}

/// Every shape.
pub fn shapes() -> impl Strategy<Value = Shape> {
    prop_oneof![Just(Shape::Smoothstep), Just(Shape::SineQuintic)]
}

/// Every timing.
pub fn timings() -> impl Strategy<Value = Timing> {
    prop_oneof![Just(Timing::Stretched), Just(Timing::Fastest)]
}

/// 10 to a power between `low` and `high`.
pub fn decades(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low..=high).prop_map(|exponent| 10_f64.powf(exponent))
}

/// [−a, b] with the larger magnitude `scale` and the smaller one at least a tenth of it.
fn interval(scale: f64) -> impl Strategy<Value = Interval> {
    let share = prop_oneof![Just(1.0), decades(-1.0, 0.0)];
    (share, any::<bool>()).prop_map(move |(share, flip)| {
        let interval = Interval::new(-scale * share, scale);
        if flip { interval.mirrored() } else { interval }
    })
}

fn position(width: f64) -> impl Strategy<Value = Interval> {
    let offset = prop_oneof![
        Just(0.0),
        Just(-0.5),
        -1.0..0.0,
        decades(-1.0, 3.0),
        decades(-1.0, 3.0).prop_map(|o| -o)
    ];
    offset.prop_map(move |offset| Interval::new(offset * width, offset * width + width))
}

fn limits(
    (position, velocity, acceleration, jerk): (Interval, Interval, Interval, Interval),
) -> Option<Limits> {
    Limits::try_from(LimitsSpec { position, velocity, acceleration, jerk }).ok()
}

fn proportionate_limits() -> impl Strategy<Value = (Limits, f64)> {
    let scales =
        (decades(-3.0, 0.0), decades(-3.0, 3.0), decades(-2.5, 3.5), decades(-2.0, 4.0), decades(-3.0, 3.0));
    scales.prop_flat_map(|(period, acceleration, jerk, velocity, width)| {
        let (jerk, velocity) = (jerk * acceleration / period, velocity * acceleration * period);
        let width = width * velocity * (velocity / acceleration + period);
        let intervals = (position(width), interval(velocity), interval(acceleration), interval(jerk));
        (intervals.prop_filter_map("limits", limits), Just(period))
    })
}

fn independent_limits() -> impl Strategy<Value = (Limits, f64)> {
    let scales = [(); 4].map(|()| decades(-3.0, 3.0));
    (scales, decades(-3.0, 0.0)).prop_flat_map(|([width, velocity, acceleration, jerk], period)| {
        let intervals = (position(width), interval(velocity), interval(acceleration), interval(jerk));
        (intervals.prop_filter_map("limits", limits), Just(period))
    })
}
