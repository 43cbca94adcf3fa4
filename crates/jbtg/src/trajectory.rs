//! A chain of quintic segments.

use crate::extrema::{self, Extrema};
use crate::pulse::Pulse;
use crate::segment::{Ramp, Segment, State};
use crate::shape::ShapeConstants;

/// Most quintics of one trajectory, [P, Alg. 3]: up to eight control points.
pub const MAX_SEGMENTS: usize = 7;

/// One control point between quintics, [P, Alg. 1], step 5.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControlPoint {
    /// Time since the start of the trajectory \[s\].
    pub time: f64,
    /// State there. Where the jerk jumps this is the side after the jump; at the end there is none, and it is 0.
    pub state: State,
}

/// Motion of one joint over one period, from a state with zero acceleration to another.
///
/// Position, velocity and acceleration are continuous; so is jerk with [`Shape::Smoothstep`](crate::Shape). The
/// end state is exact: its velocity is the commanded one bit for bit, so that steps chain without drift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trajectory {
    segments: [Segment; MAX_SEGMENTS],
    count: usize,
    duration: f64,
    end: State,
}

impl Trajectory {
    /// The step from (position, v1) by the signed `pulse`, ending exactly at `end`.
    #[inline]
    pub(crate) fn from_pulse(
        position: f64,
        velocity: f64,
        (pulse, duration): (Pulse, f64),
        end: (f64, f64),
        shape: &ShapeConstants,
    ) -> Self {
        let mut trajectory = Self {
            segments: [Segment::EMPTY; MAX_SEGMENTS],
            count: 0,
            duration,
            end: State { position: end.0, velocity: end.1, acceleration: 0.0, jerk: 0.0 },
        };
        let Pulse { acceleration: a, ramp_up, cruise, ramp_down, rest } = pulse;
        let (mut time, mut p, mut v) = (0.0, position, velocity);
        if a != 0.0 {
            trajectory.push(Segment::new(time, ramp_up, (p, v), (Ramp::Rising, a), shape));
            p += ramp_up * (v + shape.displacement * a * ramp_up);
            v += 0.5 * a * ramp_up;
            time += ramp_up;
            if cruise > 0.0 {
                trajectory.push(Segment::new(time, cruise, (p, v), (Ramp::Constant, a), shape));
                p += cruise * (v + 0.5 * a * cruise);
                v += a * cruise;
                time += cruise;
            }
            trajectory.push(Segment::new(time, ramp_down, (p, v), (Ramp::Falling, a), shape));
            p += ramp_down * (v + (0.5 - shape.displacement) * a * ramp_down);
            time += ramp_down;
        }
        let rest = if a == 0.0 { duration } else { rest }; // a tiny change may need none that a number can hold
        if rest > 0.0 {
            trajectory.push(Segment::new(time, rest, (p, end.1), (Ramp::Constant, 0.0), shape));
        }
        trajectory
    }

    /// A trajectory without segments, to be filled by [`push`](Self::push).
    pub(crate) const fn unfilled(duration: f64, end: State) -> Self {
        Self { segments: [Segment::EMPTY; MAX_SEGMENTS], count: 0, duration, end }
    }

    /// Adds a segment after the others; at most [`MAX_SEGMENTS`] fit.
    #[inline]
    pub(crate) fn push(&mut self, segment: Segment) {
        debug_assert!(self.count < MAX_SEGMENTS, "no motion has more phases");
        if let Some(slot) = self.segments.get_mut(self.count) {
            *slot = segment;
            self.count += 1;
        }
    }

    /// This one, ending at `end` after `duration`; without any segment so far it rests there for no time.
    pub(crate) fn finish(mut self, duration: f64, end: State) -> Self {
        (self.duration, self.end) = (duration, end);
        if self.count == 0 {
            self.push(Segment { coefficients: [end.position, 0.0, 0.0, 0.0, 0.0, 0.0], ..Segment::EMPTY });
        }
        self
    }

    /// The same motion in the opposite direction, bit for bit.
    pub(crate) fn mirrored(mut self) -> Self {
        for segment in self.segments.iter_mut().take(self.count) {
            segment.coefficients = segment.coefficients.map(|c| 0.0 - c);
        }
        let State { position, velocity, .. } = self.end;
        self.end = State { position: 0.0 - position, velocity: 0.0 - velocity, ..self.end };
        self
    }

    /// State at `time` since the start \[s\].
    ///
    /// Total: before the start it is the first state, from the end on the end state. A NaN time gives the end
    /// state.
    #[must_use]
    #[inline]
    pub fn state_at(&self, time: f64) -> State {
        if time < self.duration {
            let time = if time > 0.0 { time } else { 0.0 };
            let begun = self.segments().iter().rev().find(|segment| segment.start <= time);
            begun.map_or(self.end, |segment| segment.state_at(time - segment.start))
        } else {
            self.end
        }
    }

    /// Duration \[s\]: the planner's period, exactly, or a stop's own.
    #[must_use]
    pub const fn duration(&self) -> f64 {
        self.duration
    }

    /// State at the end: the commanded velocity bit for bit, zero acceleration and jerk.
    #[must_use]
    pub const fn end(&self) -> State {
        self.end
    }

    /// The quintics in order of time; at least one, at most [`MAX_SEGMENTS`].
    #[must_use]
    pub fn segments(&self) -> &[Segment] {
        self.segments.get(..self.count).unwrap_or(&self.segments)
    }

    /// The control points in order of time: the start of every quintic, and the end.
    pub fn control_points(&self) -> impl Iterator<Item = ControlPoint> + '_ {
        self.segments()
            .iter()
            .map(|segment| ControlPoint { time: segment.start, state: segment.state_at(0.0) })
            .chain(core::iter::once(ControlPoint { time: self.duration, state: self.end }))
    }

    /// Least and greatest position, velocity, acceleration and jerk over the whole trajectory.
    ///
    /// Exact: taken at the ends and at the roots of the quintics' derivatives, never by sampling. Where the jerk
    /// jumps between segments both sides count.
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
    /// let turn = planner.ramp(0.3, 0.01, -0.01)?.extrema();
    /// assert!(turn.position.max > 0.3); // it still moves on before it turns
    /// assert!(turn.acceleration.min >= -1.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn extrema(&self) -> Extrema {
        let mut extrema = Extrema::at(self.end);
        for segment in self.segments() {
            extrema::include_segment(&mut extrema, segment);
        }
        extrema
    }
}
