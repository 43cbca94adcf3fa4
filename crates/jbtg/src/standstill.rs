//! Where a trajectory comes to a standstill.

use crate::roots::Roots;
use crate::segment::{Segment, State};
use crate::{ControlPoint, Trajectory};

impl Trajectory {
    /// The first instant at which the velocity is 0, whether it changes its sign there or stays 0, and the state then.
    /// `None` if there is none, the end included.
    ///
    /// The time is a root of the quintic's derivative to within rounding, not a sample; the state is the trajectory's
    /// there, its velocity set to 0. A velocity that only touches 0 between two control points and stays on one side
    /// can be missed where rounding lifts it off; one that comes to rest at a control point, as every stop does, is
    /// not.
    ///
    /// # Examples
    /// ```
    /// # use jbtg::{Interval, Limits, Planner, PlannerSpec, Shape, SymmetricLimits, Timing};
    /// # let limits = Limits::try_from(SymmetricLimits {
    /// #     position: Interval::new(0.14, 0.50), velocity: 0.15, acceleration: 1.0, jerk: 100.0,
    /// # })?;
    /// # let planner = Planner::try_from(PlannerSpec {
    /// #     limits, shape: Shape::Smoothstep, timing: Timing::Stretched, period: 0.05,
    /// # })?;
    /// let turn = planner.ramp(0.30, 0.01, -0.01)?;
    /// let still = turn.standstill().expect("a change of sign");
    /// assert_eq!(still.time, 0.025); // halfway, by symmetry
    /// assert_eq!(still.state.position, turn.extrema().position.max);
    /// assert!(planner.ramp(0.30, 0.01, 0.02)?.standstill().is_none());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn standstill(&self) -> Option<ControlPoint> {
        let start = self.segments().first().map_or(0.0, |segment| segment.coefficients[1]);
        let goes_on = |velocity: f64| (start > 0.0 && velocity > 0.0) || (start < 0.0 && velocity < 0.0);
        for segment in self.segments() {
            // A root that rounding hides at the end of a segment shows in the sign at the start of the next.
            let is_past = !goes_on(segment.coefficients[1]);
            if let Some(passed) = if is_past { Some(0.0) } else { first_root(segment) } {
                let state = State { velocity: 0.0, ..segment.state_at(passed) };
                return Some(ControlPoint { time: segment.start + passed, state });
            }
        }
        let state = State { velocity: 0.0, ..self.end() };
        (!goes_on(self.end().velocity)).then(|| ControlPoint { time: self.duration(), state })
    }
}

/// Time of the first change of the velocity's sign within `segment`, since its start.
fn first_root(segment: &Segment) -> Option<f64> {
    let t = segment.duration;
    let [_, b1, b2, b3, b4, b5] = segment.coefficients;
    // In u = t/T, as in `extrema`.
    let velocity = [b1, 2.0 * b2 * t, 3.0 * b3 * t * t, 4.0 * b4 * t * t * t, 5.0 * b5 * t * t * t * t];
    let [_, c1, c2, c3, c4] = velocity;
    let jerk = Roots::of_quadratic([2.0 * c2, 6.0 * c3, 12.0 * c4]);
    let acceleration = Roots::between(&jerk, [c1, 2.0 * c2, 3.0 * c3, 4.0 * c4]);
    let root = Roots::between(&acceleration, velocity).iter().next()?;
    Some(polished(segment, root * t))
}

/// The root near `time` to within rounding: `Roots` are as exact as an extremum of the position needs, which is less.
fn polished(segment: &Segment, mut time: f64) -> f64 {
    let mut state = segment.state_at(time);
    for _ in 0..8 {
        let next = time - state.velocity / state.acceleration;
        let after = segment.state_at(next);
        if !(next >= 0.0 && next <= segment.duration && after.velocity.abs() < state.velocity.abs()) {
            break;
        }
        (time, state) = (next, after);
    }
    time
}
