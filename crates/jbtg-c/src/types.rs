//! The values that cross the border. Any bits are legal in all of them.

use jbtg::{LimitsSpec, Shape, Timing};

use crate::status::{RangeStatus, Status};

/// Shape of the acceleration ramps: jerk is zero at both ends. The default.
pub const JBTG_SMOOTHSTEP: u32 = 0;
/// Shape of the acceleration ramps: the paper's quintic.
pub const JBTG_SINE_QUINTIC: u32 = 1;
/// Timing of a step: the velocity change is spread over the whole period. The default.
pub const JBTG_STRETCHED: u32 = 0;
/// Timing of a step: ramp at the limits, then cruise for what is left of the period.
pub const JBTG_FASTEST: u32 = 1;

/// Closed interval of one quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Interval {
    /// Lower end.
    pub min: f64,
    /// Upper end.
    pub max: f64,
}

impl From<Interval> for jbtg::Interval {
    fn from(interval: Interval) -> Self {
        Self::new(interval.min, interval.max)
    }
}

impl From<jbtg::Interval> for Interval {
    fn from(interval: jbtg::Interval) -> Self {
        Self { min: interval.min, max: interval.max }
    }
}

/// Limits of one joint: position with min < max, all others with min < 0 < max.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Limits {
    /// Position [rad or m].
    pub position: Interval,
    /// Velocity [rad/s or m/s].
    pub velocity: Interval,
    /// Acceleration [rad/s^2 or m/s^2].
    pub acceleration: Interval,
    /// Jerk [rad/s^3 or m/s^3].
    pub jerk: Interval,
}

impl TryFrom<Limits> for jbtg::Limits {
    type Error = Status;

    fn try_from(limits: Limits) -> Result<Self, Status> {
        let Limits { position, velocity, acceleration, jerk } = limits;
        let spec = LimitsSpec {
            position: position.into(),
            velocity: velocity.into(),
            acceleration: acceleration.into(),
            jerk: jerk.into(),
        };
        Ok(Self::try_from(spec)?)
    }
}

/// What a joint is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Spec {
    /// Limits of the joint.
    pub limits: Limits,
    /// Duration of one step in seconds, > 0.
    pub period: f64,
    /// Shape of the acceleration ramps, a constant.
    pub shape: u32,
    /// Timing of a step, a constant.
    pub timing: u32,
}

impl TryFrom<Spec> for jbtg::PlannerSpec {
    type Error = Status;

    fn try_from(spec: Spec) -> Result<Self, Status> {
        let shape = match spec.shape {
            JBTG_SMOOTHSTEP => Shape::Smoothstep,
            JBTG_SINE_QUINTIC => Shape::SineQuintic,
            _ => return Err(Status::UnknownChoice),
        };
        let timing = match spec.timing {
            JBTG_STRETCHED => Timing::Stretched,
            JBTG_FASTEST => Timing::Fastest,
            _ => return Err(Status::UnknownChoice),
        };
        Ok(Self { limits: spec.limits.try_into()?, shape, timing, period: spec.period })
    }
}

/// Velocities that are safe to command next. Never empty.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Range {
    /// Least safe velocity at the end of the next period [rad/s or m/s].
    pub min: f64,
    /// Greatest safe velocity at the end of the next period [rad/s or m/s].
    pub max: f64,
    /// Braking, or the slowest way back from outside; within the range [rad/s or m/s].
    pub brake: f64,
    /// What the range can promise.
    pub status: RangeStatus,
    /// Whether the position limits narrowed what one period can reach.
    pub narrowed: bool,
}

impl From<safezone::SafeRange> for Range {
    fn from(range: safezone::SafeRange) -> Self {
        let safezone::SafeRange { min, max, brake, narrowed, status } = range;
        Self { min, max, brake, status: status.into(), narrowed }
    }
}

/// The velocity to command, and the range that it is from.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Command {
    /// Velocity at the end of the next step [rad/s or m/s].
    pub velocity: f64,
    /// The range that it was chosen from.
    pub range: Range,
    /// Whether the fail-safe chose it: the request or the state was not finite.
    pub is_fail_safe: bool,
    /// Whether the request was outside what is safe and counted as the nearest velocity that is.
    pub is_clamped: bool,
}

/// What one period can do to the velocity in one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Authority {
    /// Largest velocity change within one period [rad/s or m/s].
    pub velocity_change: f64,
    /// What zero acceleration at both ends of every period leaves of the acceleration limit, in (0, 1).
    pub share: f64,
}

/// Motion of one joint at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct State {
    /// Position [rad or m].
    pub position: f64,
    /// Velocity [rad/s or m/s].
    pub velocity: f64,
    /// Acceleration [rad/s^2 or m/s^2].
    pub acceleration: f64,
    /// Jerk [rad/s^3 or m/s^3].
    pub jerk: f64,
}

impl From<jbtg::State> for State {
    fn from(state: jbtg::State) -> Self {
        let jbtg::State { position, velocity, acceleration, jerk } = state;
        Self { position, velocity, acceleration, jerk }
    }
}

impl From<State> for jbtg::State {
    fn from(state: State) -> Self {
        let State { position, velocity, acceleration, jerk } = state;
        Self { position, velocity, acceleration, jerk }
    }
}

/// The state of a joint at one tick.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Sample {
    /// Where the joint should be.
    pub state: State,
    /// Whether no velocity was there when the period began, so that the joint brakes or rests.
    pub is_braking: bool,
    /// Whether this tick ends a period: without a command before the next one the joint brakes.
    pub is_due: bool,
}

/// Exact extrema of every quantity over one step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Extrema {
    /// Position [rad or m].
    pub position: Interval,
    /// Velocity [rad/s or m/s].
    pub velocity: Interval,
    /// Acceleration [rad/s^2 or m/s^2].
    pub acceleration: Interval,
    /// Jerk [rad/s^3 or m/s^3].
    pub jerk: Interval,
}

impl From<jbtg::Extrema> for Extrema {
    fn from(extrema: jbtg::Extrema) -> Self {
        Self {
            position: extrema.position.into(),
            velocity: extrema.velocity.into(),
            acceleration: extrema.acceleration.into(),
            jerk: extrema.jerk.into(),
        }
    }
}
