//! A stop as fast as the limits allow, from any state.

mod motion;

use core::fmt;

use crate::extrema::{self, Extrema};
use crate::pulse::MIN_RAMP_SHARE;
use crate::segment::{Segment, State};
use crate::{Interval, Planner, Quantity, Trajectory};
use motion::Motion;

/// Time that jerk is given to vanish in at least, as a share of the shortest full ramp. What velocity and acceleration gain
/// meanwhile is lost in rounding.
const SHORTEST: f64 = 1e-14;

/// Excess over a limit that counts as rounding, relative to the limits' width.
const EXCESS: f64 = 1e-12;

/// Whether a stop keeps the limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopStatus {
    /// The whole stop keeps velocity, acceleration and jerk limits, to 1e-12 of their widths.
    WithinLimits,
    /// The stop is beyond the limit of this quantity (the first in the order of [`Quantity`]) for a while: because the
    /// state is, or because its acceleration or jerk carry it there, however fast they are ended. Velocity and
    /// acceleration come back without a detour; jerk is cut to its limit at once.
    Recovering(Quantity),
}

/// A motion to rest, and where it begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// The motion to rest, of its own duration; from its end on it holds.
    pub trajectory: Trajectory,
    /// Time of the interrupted step at which `trajectory` takes over \[s\]; 0 where no step was given.
    pub begin: f64,
    /// Whether it keeps the limits.
    pub status: StopStatus,
}

/// Why there is no stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StopError {
    /// An argument is NaN or infinite.
    NotFinite {
        /// The argument.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// The state is so many orders of magnitude beyond the limits that double precision cannot hold the stop.
    OutOfScale,
}

impl fmt::Display for StopError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { name, value } => write!(f, "{name} must be finite, got {value}"),
            Self::OutOfScale => f.write_str("state and limits are out of proportion"),
        }
    }
}

impl core::error::Error for StopError {}

impl Planner {
    /// The stop from `state`, right now and as fast as the limits allow: to rest, which then holds.
    ///
    /// Acceleration follows cubics from (a₀, j₀) to (a₁, 0), as short as the jerk bound allows: the first continues
    /// the state's own jerk, so that jerk is continuous from the state on; the rest are smoothsteps, whatever the
    /// planner's shape. While the velocity suffices for it the way to rest is monotone. If braking is so strong already
    /// that ending it takes more velocity than there is, the motion passes 0 by that much and comes back.
    ///
    /// From every state on a trajectory of this planner velocity, acceleration and jerk keep their limits. From a
    /// state with zero acceleration it travels no farther than braking step by step. Position limits are not its
    /// business: in the middle of a step that turns back it may travel on farther than that step would;
    /// [`Planner::interrupt`] rules that out.
    ///
    /// Total: a state beyond a limit is recovered from, and the status says so. A stop from rest takes no time: its
    /// one segment has a duration of 0.
    ///
    /// # Errors
    /// [`StopError::NotFinite`] for a NaN or an infinity, [`StopError::OutOfScale`] for a state that overflows.
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
    /// let step = planner.ramp(0.30, 0.10, 0.12)?;
    /// let stop = planner.stop(step.state_at(0.02))?.trajectory;
    /// assert_eq!(stop.end().velocity, 0.0);
    /// assert!(stop.extrema().acceleration.min >= -1.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn stop(&self, state: State) -> Result<Stop, StopError> {
        let named = [
            ("position", state.position),
            ("velocity", state.velocity),
            ("acceleration", state.acceleration),
            ("jerk", state.jerk),
        ];
        for (name, value) in named {
            if !value.is_finite() {
                return Err(StopError::NotFinite { name, value });
            }
        }
        let trajectory = Motion::new(state, self.limits(), self.stop_scales()).into_stop();
        // Of its derivatives too.
        let is_finite = |segment: &Segment| segment.coefficients.iter().all(|c| (120.0 * c).is_finite());
        let end = trajectory.end().position + trajectory.duration();
        if !(end.is_finite() && trajectory.segments().iter().all(is_finite)) {
            return Err(StopError::OutOfScale);
        }
        Ok(Stop { trajectory, begin: 0.0, status: self.status(state, &trajectory) })
    }

    /// The stop from `time` in `step` on that never travels farther, in either direction, than finishing the step and
    /// stopping then, and so never farther than finishing it and braking step by step: if `safezone` chose the step,
    /// the stop keeps the position limits too.
    ///
    /// It is [`Planner::stop`] right away where that keeps the promise. Where it does not (a step that turns back is
    /// at its farthest soon, and a stop would ease off before), the step goes on to the end of its present quintic,
    /// or of a later one, at worst to its own end: [`Stop::begin`] says until when. Times outside the step count as
    /// its start or end.
    ///
    /// # Errors
    /// Those of [`Planner::stop`]; a NaN time is [`StopError::NotFinite`].
    pub fn interrupt(&self, step: &Trajectory, time: f64) -> Result<Stop, StopError> {
        if time.is_nan() {
            return Err(StopError::NotFinite { name: "time", value: time });
        }
        let now = time.clamp(0.0, step.duration());
        let last = Stop { begin: step.duration(), ..self.stop(step.end())? };
        let allowed = remaining(step, now).union(last.trajectory.extrema()).position;
        let later = step.segments().iter().map(Segment::start).filter(|start| *start > now);
        for begin in core::iter::once(now).chain(later).take_while(|begin| *begin < step.duration()) {
            let stop = self.stop(step.state_at(begin))?;
            if contains(allowed, stop.trajectory.extrema().position) {
                return Ok(Stop { begin, ..stop });
            }
        }
        Ok(last)
    }

    /// The steepest jerk that quintics can hold, and the shortest time for jerk to vanish in.
    fn stop_scales(&self) -> (f64, f64) {
        let (a, ramp) = self.largest_pulse();
        (1.5 * a / (MIN_RAMP_SHARE * self.period()), SHORTEST * ramp)
    }

    fn status(&self, state: State, trajectory: &Trajectory) -> StopStatus {
        let (limits, extrema) = (self.limits(), trajectory.extrema());
        let jerk = Interval::new(state.jerk, state.jerk);
        let named = [
            (Quantity::Velocity, extrema.velocity, limits.velocity()),
            (Quantity::Acceleration, extrema.acceleration, limits.acceleration()),
            (Quantity::Jerk, jerk, limits.jerk()),
        ];
        let is_beyond = |found: Interval, limit: Interval| {
            (found.max - limit.max).max(limit.min - found.min) > EXCESS * limit.width()
        };
        let beyond = named.into_iter().find(|(_, found, limit)| is_beyond(*found, *limit));
        beyond.map_or(StopStatus::WithinLimits, |(quantity, ..)| StopStatus::Recovering(quantity))
    }
}

/// Extrema of `step` from `now` on.
fn remaining(step: &Trajectory, now: f64) -> Extrema {
    let mut extrema = Extrema::at(step.state_at(now)).union(Extrema::at(step.end()));
    for segment in step.segments() {
        let passed = now - segment.start;
        if passed <= 0.0 {
            extrema::include_segment(&mut extrema, segment);
        } else if passed < segment.duration {
            extrema::include_segment(&mut extrema, &segment.from(passed));
        }
    }
    extrema
}

/// Whether `inner` lies in `outer`, up to a few roundings of positions.
fn contains(outer: Interval, inner: Interval) -> bool {
    let slack = 8.0 * f64::EPSILON * outer.max.abs().max(outer.min.abs());
    inner.min >= outer.min - slack && inner.max <= outer.max + slack
}
