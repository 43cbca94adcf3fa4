//! From a policy's request to the velocity of the next step, with the fail-safe in between.

use crate::range::{RangeStatus, SafeRange};
use crate::zone::SafeZone;

/// What the policy delivered for this step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Request {
    /// An action, meant to be in [−1, 1].
    Action(f64),
    /// No action at all.
    Missing,
    /// An action that came after its time.
    Late,
}

impl From<f64> for Request {
    fn from(action: f64) -> Self {
        Self::Action(action)
    }
}

impl From<Option<f64>> for Request {
    fn from(action: Option<f64>) -> Self {
        action.map_or(Self::Missing, Self::Action)
    }
}

/// The velocity to command and who chose it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Command {
    /// Velocity at the end of the next step [rad/s or m/s], in `range`.
    pub velocity: f64,
    /// Who chose it.
    pub source: Source,
    /// The range that it was chosen from.
    pub range: SafeRange,
}

/// Who chose a velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// The policy, by an action in [−1, 1].
    Policy,
    /// The policy, by a finite action outside [−1, 1] that counted as the nearer end.
    PolicyClamped {
        /// The action as delivered.
        action: f64,
    },
    /// The fail-safe: the joint brakes.
    FailSafe(FailSafeReason),
}

/// Why the fail-safe acted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FailSafeReason {
    /// There was no action.
    Missing,
    /// The action came too late.
    Late,
    /// The action was NaN or infinite.
    NonFinite,
    /// Position or velocity was NaN or infinite, so that no range is known.
    UnknownState,
}

impl SafeZone<'_> {
    /// The velocity of the next step from `position` and `velocity`, as the policy's `request` has it.
    ///
    /// A finite action is mapped into the safe range by [P, Eq. (mapping)]; one outside [−1, 1] counts as the nearer
    /// end and is reported as [`Source::PolicyClamped`]. A missing, late or non-finite action brakes, towards zero by as
    /// much as one period allows, and so does an unknown state: repeated, the joint comes to rest inside its limits.
    /// Outside its position limits it first comes back.
    ///
    /// # Examples
    /// ```
    /// # use jbtg::{Interval, Limits, Planner, PlannerSpec, Shape, SymmetricLimits, Timing};
    /// # use safezone::{FailSafeReason, Request, SafeZone, Source};
    /// # let limits = Limits::try_from(SymmetricLimits {
    /// #     position: Interval::new(0.14, 0.50), velocity: 0.15, acceleration: 1.0, jerk: 100.0,
    /// # })?;
    /// # let planner = Planner::try_from(PlannerSpec {
    /// #     limits, shape: Shape::Smoothstep, timing: Timing::Stretched, period: 0.05,
    /// # })?;
    /// let zone = SafeZone::closed_form(planner)?;
    /// let command = zone.command(0.3, 0.02, Request::Late);
    /// assert_eq!(command.source, Source::FailSafe(FailSafeReason::Late));
    /// assert_eq!(command.velocity, 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn command(&self, position: f64, velocity: f64, request: impl Into<Request>) -> Command {
        let range = self.range(position, velocity);
        let reason = match request.into() {
            _ if range.status == RangeStatus::Unknown => FailSafeReason::UnknownState,
            Request::Action(action) if action.is_finite() => {
                let source =
                    if action.abs() <= 1.0 { Source::Policy } else { Source::PolicyClamped { action } };
                return Command { velocity: range.map_action(action), source, range };
            }
            Request::Action(_) => FailSafeReason::NonFinite,
            Request::Missing => FailSafeReason::Missing,
            Request::Late => FailSafeReason::Late,
        };
        Command { velocity: range.brake, source: Source::FailSafe(reason), range }
    }
}
