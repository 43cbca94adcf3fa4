//! The range of velocities that are safe to command next.

use jbtg::Interval;

/// Velocities that one period can reach and that keep every limit now and for ever.
///
/// Never empty: min ≤ max always.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SafeRange {
    /// Least safe velocity at the end of the next period [rad/s or m/s].
    pub min: f64,
    /// Greatest safe velocity at the end of the next period [rad/s or m/s].
    pub max: f64,
    /// The fail-safe's velocity, in [min, max]: towards zero by as much as one period allows, or the slowest way
    /// back from outside the position limits [rad/s or m/s].
    pub brake: f64,
    /// Whether the position limits narrowed what one period can reach.
    pub narrowed: bool,
    /// What the range can promise.
    pub status: RangeStatus,
}

/// What a [`SafeRange`] can promise, given where it starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RangeStatus {
    /// Every limit is kept, now and for ever.
    Safe,
    /// The velocity is beyond [`Planner::velocity`](jbtg::Planner::velocity): its limit, less what the shape's own
    /// velocity overshoots. The range leads back inside as fast as one period allows; position limits are kept.
    VelocityOutside,
    /// The position is inside its limits, but no braking stops the joint there. The range holds nothing that goes
    /// further out than braking at once.
    CannotStop,
    /// The position is outside its limits. The range holds braking while the joint still moves out, and then
    /// velocities that bring it back, none of them zero.
    PositionOutside,
    /// Position or velocity is NaN or infinite. The range is the one braking velocity, or zero if the velocity
    /// is not known.
    Unknown,
}

impl SafeRange {
    /// All of what is `reachable`.
    #[inline]
    pub(crate) const fn free(reachable: Interval, brake: f64) -> Self {
        let Interval { min, max } = reachable;
        Self { min, max, brake, narrowed: false, status: RangeStatus::Safe }
    }

    /// The velocity that an action in [−1, 1] stands for, [P, Eq. (mapping)] [rad/s or m/s].
    ///
    /// −1 is exactly `min`, 1 exactly `max`. Total: an action beyond ±1 counts as ±1, NaN as `brake`;
    /// [`SafeZone::command`](crate::SafeZone::command) does the same and says so in its result.
    ///
    /// # Examples
    /// ```
    /// # use safezone::{RangeStatus, SafeRange};
    /// let range = SafeRange { min: -0.1, max: 0.3, brake: 0.0, narrowed: false, status: RangeStatus::Safe };
    /// assert_eq!(range.map_action(-1.0), -0.1);
    /// assert!((range.map_action(0.0) - 0.1).abs() < 1e-15);
    /// assert_eq!(range.map_action(1.0), 0.3);
    /// ```
    #[must_use]
    #[inline]
    pub fn map_action(&self, action: f64) -> f64 {
        if action.is_nan() {
            self.brake
        } else if action >= 1.0 {
            self.max
        } else {
            let share = 0.5 * (1.0 + action.max(-1.0));
            (self.min + share * (self.max - self.min)).min(self.max)
        }
    }

    /// Whether `velocity` is in the range. False for NaN.
    #[must_use]
    pub fn contains(&self, velocity: f64) -> bool {
        self.min <= velocity && velocity <= self.max
    }
}
