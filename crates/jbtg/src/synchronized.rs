//! Several joints that share a period and their share of every velocity change.

mod errors;

pub use errors::SynchronizedError;

use crate::{Direction, Interval, Planner, Timing, Trajectory};

/// Plans steps of `N` joints, all one common period long and all by the same share of what was asked for.
///
/// A change of the velocity vector that one joint cannot make in one period is shortened for all of them, so that the
/// vector at the end of every period lies on the straight line between the two. With
/// [`Synchronized::in_step`] it also moves along that line within the period.
///
/// # Examples
/// ```
/// # use jbtg::{Interval, Limits, Planner, PlannerSpec, Shape, SymmetricLimits, Synchronized, Timing};
/// let planner = |velocity, acceleration, jerk| {
///     let position = Interval::new(-1.0, 1.0);
///     let limits = Limits::try_from(SymmetricLimits { position, velocity, acceleration, jerk })?;
///     let (shape, timing) = (Shape::Smoothstep, Timing::Stretched);
///     Ok::<_, Box<dyn std::error::Error>>(Planner::try_from(PlannerSpec { limits, shape, timing, period: 0.05 })?)
/// };
/// let joints = Synchronized::in_step([planner(0.5, 2.0, 100.0)?, planner(0.3, 1.0, 50.0)?])?;
/// let step = joints.ramp([0.0, 0.0], [0.0, 0.0], [0.04, 0.02])?;
/// assert!(step.share == 1.0 || step.trajectories[0].end().velocity < 0.04);
/// let [a, b] = step.trajectories.map(|step| step.state_at(0.013).velocity);
/// assert!((a - 2.0 * b).abs() < 1e-15); // on the straight line from (0, 0) to (0.04, 0.02)
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Synchronized<const N: usize> {
    planners: [Planner; N],
}

/// One period of `N` joints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SynchronizedStep<const N: usize> {
    /// One trajectory per joint.
    pub trajectories: [Trajectory; N],
    /// Share of the velocity change that the step makes, in [0, 1]: the largest that every joint can reach.
    pub share: f64,
}

impl<const N: usize> Synchronized<N> {
    /// Joints that share their period and nothing else: each takes its own time course within it.
    ///
    /// # Errors
    /// [`SynchronizedError::Period`] if a joint has another period than the first.
    pub fn new(planners: [Planner; N]) -> Result<Self, SynchronizedError> {
        const { assert!(N > 0, "no joints to synchronize") };
        let expected = planners[0].period();
        match planners.iter().position(|planner| planner.period() != expected) {
            None => Ok(Self { planners }),
            Some(joint) => {
                Err(SynchronizedError::Period { joint, period: planners[joint].period(), expected })
            }
        }
    }

    /// Joints that follow one time course: all ramps last as long as the slowest joint's, so that every velocity is
    /// v₁ + share·(v₂ − v₁)·σ(t) with one σ and the velocity vector moves on a straight line.
    ///
    /// A joint that could ramp quicker gives up some authority for it; [`Planner::authority`] of
    /// [`Synchronized::planners`] tells what is left.
    ///
    /// # Errors
    /// [`SynchronizedError::Period`] if a joint has another period than the first, [`SynchronizedError::Course`] if
    /// one has another shape or is not [`Timing::Stretched`], [`SynchronizedError::Planner`] if the common ramps
    /// leave it too little.
    pub fn in_step(planners: [Planner; N]) -> Result<Self, SynchronizedError> {
        let Self { mut planners } = Self::new(planners)?;
        let (shape, period) = (planners[0].spec().shape, planners[0].period());
        let other =
            |planner: &Planner| planner.spec().timing != Timing::Stretched || planner.spec().shape != shape;
        if let Some(joint) = planners.iter().position(other) {
            return Err(SynchronizedError::Course { joint });
        }
        let authorities = planners
            .iter()
            .flat_map(|p| [Direction::Increasing, Direction::Decreasing].map(|d| p.authority(d)));
        let (up, down) =
            authorities.fold((0.0, 0.0), |(up, down), a| (a.ramp_up.max(up), a.ramp_down.max(down)));
        let excess = f64::max((up + down) / period, 1.0);
        for (joint, planner) in planners.iter_mut().enumerate() {
            *planner = planner
                .with_ramps(up / excess, down / excess)
                .map_err(|error| SynchronizedError::Planner { joint, error })?;
        }
        Ok(Self { planners })
    }

    /// The joints' planners; with [`Synchronized::in_step`], those with common ramps.
    #[must_use]
    pub const fn planners(&self) -> &[Planner; N] {
        &self.planners
    }

    /// Duration of every step \[s\].
    #[must_use]
    pub const fn period(&self) -> f64 {
        self.planners[0].period()
    }

    /// The largest share in [0, 1] of the change from `v1` to `v2` [rad/s or m/s] that every joint can make in one
    /// period.
    ///
    /// # Errors
    /// [`SynchronizedError::NotFinite`] for a NaN or an infinity, [`SynchronizedError::Outside`] if one of `v1` is
    /// beyond its joint's limits: the way back is each joint's own, [`Planner::ramp`].
    pub fn share(&self, v1: &[f64; N], v2: &[f64; N]) -> Result<f64, SynchronizedError> {
        let mut share = 1.0;
        for (joint, (planner, (v1, v2))) in self.planners.iter().zip(v1.iter().zip(v2)).enumerate() {
            check_finite(joint, "initial velocity", *v1)?;
            check_finite(joint, "final velocity", *v2)?;
            let velocity = planner.velocity();
            if !velocity.contains(*v1) {
                return Err(SynchronizedError::Outside { joint, velocity: *v1, limit: velocity });
            }
            let Interval { min, max } = planner.reachable(*v1);
            // Not v₂ − v₁, which may overflow; its half does not.
            let half = |to: f64| 0.5 * to - 0.5 * v1;
            if *v2 > max {
                share = f64::min(share, half(max) / half(*v2));
            } else if *v2 < min {
                share = f64::min(share, half(min) / half(*v2));
            }
        }
        Ok(share)
    }

    /// The step of all joints from `positions` and `v1` towards `v2`, by the largest share that all can reach.
    ///
    /// With share 1 the end velocities are `v2` bit for bit.
    ///
    /// # Errors
    /// Those of [`Synchronized::share`]; [`SynchronizedError::NotFinite`] for a position, too.
    pub fn ramp(
        &self,
        positions: [f64; N],
        v1: [f64; N],
        v2: [f64; N],
    ) -> Result<SynchronizedStep<N>, SynchronizedError> {
        let share = self.share(&v1, &v2)?;
        for (joint, position) in positions.iter().enumerate() {
            check_finite(joint, "position", *position)?;
        }
        let trajectories = core::array::from_fn(|joint| {
            let (planner, from, to) = (&self.planners[joint], v1[joint], v2[joint]);
            let end = if share < 1.0 { (1.0 - share) * from + share * to } else { to };
            planner.step(positions[joint], from, planner.reachable(from).clamp(end))
        });
        Ok(SynchronizedStep { trajectories, share })
    }

    /// Number of periods in which [`Synchronized::ramp`], asked again and again, takes all joints from `v1` to `v2`.
    ///
    /// Where the slowest joint needs a whole number of full steps exactly, rounding may make it one more.
    ///
    /// # Errors
    /// Those of [`Synchronized::share`]; [`SynchronizedError::Outside`] also if one of `v2` is beyond its limits and
    /// so is never reached.
    pub fn periods(&self, v1: &[f64; N], v2: &[f64; N]) -> Result<u64, SynchronizedError> {
        self.share(v1, v2)?;
        let mut periods = 0.0;
        for (joint, (planner, (v1, v2))) in self.planners.iter().zip(v1.iter().zip(v2)).enumerate() {
            let limit = planner.velocity();
            if !limit.contains(*v2) {
                return Err(SynchronizedError::Outside { joint, velocity: *v2, limit });
            }
            let direction = if v2 < v1 { Direction::Decreasing } else { Direction::Increasing };
            let needed = (v2 - v1).abs() / planner.authority(direction).velocity_change;
            periods = f64::max(periods, needed);
        }
        let whole = periods as u64; // saturates
        Ok(if (whole as f64) < periods { whole.saturating_add(1) } else { whole })
    }
}

fn check_finite(joint: usize, name: &'static str, value: f64) -> Result<(), SynchronizedError> {
    if value.is_finite() { Ok(()) } else { Err(SynchronizedError::NotFinite { joint, name, value }) }
}
