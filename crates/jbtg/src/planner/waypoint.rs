//! Steps through a peak velocity: [P, Alg. 3].

use super::{Planner, check_finite};
use crate::detour::{Detour, DetourCase, Plan, PulseKind};
use crate::pulse::Direction;
use crate::{RampError, Trajectory};

impl Planner {
    /// The motion from `position` and `v1` to `v2` in exactly one period by way of the largest reachable velocity if
    /// `v2` ≥ 0, of the smallest if `v2` < 0: [P, Alg. 3], all cases.
    ///
    /// [`Planner::waypoint_towards`] with the direction of the paper's footnote.
    ///
    /// # Errors
    /// Those of [`Planner::ramp`].
    ///
    /// # Examples
    /// ```
    /// # use jbtg::{Interval, Limits, Planner, PlannerSpec, Shape, SymmetricLimits, Timing};
    /// # let limits = Limits::try_from(SymmetricLimits {
    /// #     position: Interval::new(0.14, 0.50), velocity: 0.15, acceleration: 1.0, jerk: 100.0,
    /// # })?;
    /// # let planner = Planner::try_from(PlannerSpec {
    /// #     limits, shape: Shape::Smoothstep, timing: Timing::Stretched, period: 0.5,
    /// # })?;
    /// let there = planner.waypoint(0.30, 0.05, 0.05)?;
    /// assert_eq!(there.segments().len(), 7);
    /// assert_eq!(there.extrema().velocity.max, 0.15);
    /// assert_eq!(there.end().velocity, 0.05);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn waypoint(&self, position: f64, v1: f64, v2: f64) -> Result<Trajectory, RampError> {
        self.waypoint_towards(position, v1, v2, towards(v2))
    }

    /// [`Planner::waypoint`] to the reachable velocity nearest to `v2`: "reduce v₂" of [P, Alg. 1].
    ///
    /// The velocity taken is the trajectory's [`end`](Trajectory::end).
    ///
    /// # Errors
    /// [`RampError::NotFinite`] for a NaN or an infinity.
    pub fn waypoint_saturated(&self, position: f64, v1: f64, v2: f64) -> Result<Trajectory, RampError> {
        check_finite(position, v1, v2)?;
        let v2 = self.reachable(v1).clamp(v2);
        Ok(self.detour_step(position, (v1, v2), towards(v2)))
    }

    /// [`Planner::waypoint`] with a direction of one's choice, by way of the velocity that lies as far in it as time and
    /// limits allow: v_peak of [P, Alg. 3], held for what is left of the period.
    ///
    /// Both ramps, to v_peak and from there to `v2`, are MSAPs or MAPs whatever the planner's timing: their
    /// acceleration ramps are as short as the jerk bounds allow, their peak acceleration is the limit or what the
    /// velocity change needs. So each takes the least time, and no ramp of this kind, with whichever peak
    /// acceleration, leads to a v_peak farther out. With equal jerk bounds none leads to a larger displacement
    /// either; for unequal ones see [`Planner::farthest`].
    ///
    /// The end velocity is `v2` bit for bit. The end position is `position` plus the displacement, rounded once; the
    /// displacement is the closed form v_peak·period − (what both ramps stay behind it). The opposite direction with
    /// all limits mirrored gives the same motion mirrored, bit for bit.
    ///
    /// Where a detour is out of the question the motion is [`Planner::ramp`]: if the direct ramp takes the whole
    /// period, or if `v1` or `v2` lies beyond the velocity limits or within 3e-5 of their width
    /// ([`Shape::SineQuintic`](crate::Shape) only, whose velocity overshoots).
    ///
    /// # Errors
    /// Those of [`Planner::ramp`].
    pub fn waypoint_towards(
        &self,
        position: f64,
        v1: f64,
        v2: f64,
        direction: Direction,
    ) -> Result<Trajectory, RampError> {
        self.check_ramp(position, v1, v2)?;
        Ok(self.detour_step(position, (v1, v2), direction))
    }

    /// The motion from `position` and `v1` to `v2` in exactly one period that leads farthest in `direction`: no ramps
    /// to and from a peak velocity, held or not, with whichever peak accelerations, have a larger displacement.
    ///
    /// With equal jerk bounds this is [`Planner::waypoint_towards`], bit for bit, and so it is if the acceleration may
    /// end more gently at the peak than it begins and ends elsewhere. If it must begin more gently, a peak
    /// acceleration below the one of least time, held for a moment, leads a little farther through a v_peak a little
    /// lower: by up to 1.2 % of period·(largest speed) with jerk bounds ten times apart. Both are then found
    /// by iteration, to 1e-9 of that product (`tests/optimum.rs`), which takes up to two hundred times as long as
    /// [`Planner::waypoint_towards`]: 30 µs for its 0.14 µs. The limits and `v2` are met as exactly as there.
    ///
    /// # Errors
    /// Those of [`Planner::ramp`].
    pub fn farthest(
        &self,
        position: f64,
        v1: f64,
        v2: f64,
        direction: Direction,
    ) -> Result<Trajectory, RampError> {
        self.check_ramp(position, v1, v2)?;
        let ends = (from_frame(v1, direction), from_frame(v2, direction));
        let plan = self.detours.plan_farthest(ends, direction, self.spec.period);
        Ok(self.follow(plan, position, (v1, v2), direction))
    }

    /// Which case of [P, Alg. 3] [`Planner::waypoint_towards`] follows, and its v_peak.
    ///
    /// # Errors
    /// Those of [`Planner::ramp`].
    pub fn detour(&self, v1: f64, v2: f64, direction: Direction) -> Result<Detour, RampError> {
        self.check_ramp(0.0, v1, v2)?;
        let (plan, ends) = self.plan_detour((v1, v2), direction);
        let detour = plan.map_or_else(|| self.direct((v1, v2), direction), |plan| plan.detour(ends));
        Ok(Detour { peak: from_frame(detour.peak, direction), ..detour })
    }

    fn check_ramp(&self, position: f64, v1: f64, v2: f64) -> Result<(), RampError> {
        check_finite(position, v1, v2)?;
        let reachable = self.reachable(v1);
        if reachable.contains(v2) {
            Ok(())
        } else {
            Err(RampError::Unreachable { from: v1, to: v2, reachable })
        }
    }

    /// The plan, and the velocities in its frame.
    fn plan_detour(&self, (v1, v2): (f64, f64), direction: Direction) -> (Option<Plan>, (f64, f64)) {
        let ends = (from_frame(v1, direction), from_frame(v2, direction));
        (self.detours.plan(ends, direction, self.spec.period), ends)
    }

    fn detour_step(&self, position: f64, (v1, v2): (f64, f64), direction: Direction) -> Trajectory {
        let (plan, _) = self.plan_detour((v1, v2), direction);
        self.follow(plan, position, (v1, v2), direction)
    }

    /// The motion of `plan`, or the direct step without one.
    fn follow(
        &self,
        plan: Option<Plan>,
        position: f64,
        (v1, v2): (f64, f64),
        direction: Direction,
    ) -> Trajectory {
        let Some(plan) = plan else { return self.step(position, v1, v2) };
        let ends = (from_frame(v1, direction), from_frame(v2, direction));
        let start = from_frame(position, direction);
        let trajectory = plan.trajectory(start, ends, self.spec.period, &self.shape);
        match direction {
            Direction::Increasing => trajectory,
            Direction::Decreasing => trajectory.mirrored(),
        }
    }

    /// What [`Planner::ramp`] does, as a detour with the peak in the frame of `direction`.
    fn direct(&self, (v1, v2): (f64, f64), direction: Direction) -> Detour {
        let (start, end) = (from_frame(v1, direction), from_frame(v2, direction));
        let pulse = self.signed_pulse(v2 - v1);
        let kind = if pulse.cruise > 0.0 { PulseKind::Msap } else { PulseKind::Map };
        Detour {
            case: if v1 == v2 { DetourCase::Three } else { DetourCase::One },
            peak: start.max(end),
            rise: (end > start).then_some(kind),
            cruise: pulse.rest,
            fall: (end < start).then_some(kind),
        }
    }
}

/// The direction that the footnote of [P, Alg. 3] chooses.
fn towards(v2: f64) -> Direction {
    if v2 >= 0.0 { Direction::Increasing } else { Direction::Decreasing }
}

/// `value` in the frame in which `direction` is upwards, or back from there.
fn from_frame(value: f64, direction: Direction) -> f64 {
    match direction {
        Direction::Increasing => value,
        Direction::Decreasing => 0.0 - value,
    }
}
