//! Why joints cannot be synchronised, or a step of theirs was refused.

use core::fmt;

use crate::{Interval, PlannerError};

/// Why joints cannot be synchronised, or a step of theirs was refused. `joint` counts from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SynchronizedError {
    /// A joint has another period than the first.
    Period {
        /// The joint.
        joint: usize,
        /// Its period \[s\].
        period: f64,
        /// The first joint's period \[s\].
        expected: f64,
    },
    /// A joint has another shape than the first, or not [`Timing::Stretched`](crate::Timing), so that there is no
    /// common time course.
    Course {
        /// The joint.
        joint: usize,
    },
    /// A joint cannot ramp as slowly as the others.
    Planner {
        /// The joint.
        joint: usize,
        /// Why not.
        error: PlannerError,
    },
    /// An argument is NaN or infinite.
    NotFinite {
        /// The joint.
        joint: usize,
        /// The argument.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// A velocity is beyond its limits.
    Outside {
        /// The joint.
        joint: usize,
        /// The velocity [rad/s or m/s].
        velocity: f64,
        /// Its limits [rad/s or m/s].
        limit: Interval,
    },
}

impl fmt::Display for SynchronizedError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Period { joint, period, expected } => {
                write!(f, "joint {joint} has a period of {period} s, the first one of {expected} s")
            }
            Self::Course { joint } => {
                write!(f, "joint {joint} has another shape than the first, or timing other than stretched")
            }
            Self::Planner { joint, error } => write!(f, "joint {joint} with common ramps: {error}"),
            Self::NotFinite { joint, name, value } => {
                write!(f, "{name} of joint {joint} must be finite, got {value}")
            }
            Self::Outside { joint, velocity, limit: Interval { min, max } } => {
                write!(f, "velocity {velocity} of joint {joint} is beyond its limits {min} to {max}")
            }
        }
    }
}

impl core::error::Error for SynchronizedError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Planner { error, .. } => Some(error),
            _ => None,
        }
    }
}
