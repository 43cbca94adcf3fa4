//! Why a planner or a step was refused.

use core::fmt;

use crate::Interval;
use crate::planner::MIN_AUTHORITY_SHARE;

/// Why a planner was refused.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlannerError {
    /// The period is not finite and positive.
    Period {
        /// The period \[s\].
        period: f64,
    },
    /// Nothing useful of the acceleration limit is left when every period starts and ends without acceleration.
    PeriodTooShort {
        /// The period \[s\].
        period: f64,
        /// What it leaves, see [`Authority::share`](crate::Authority::share).
        share: f64,
    },
    /// The limits and the period are so many orders of magnitude apart that double precision cannot hold what
    /// follows from them.
    OutOfScale {
        /// The derived quantity.
        name: &'static str,
        /// Its value: 0, subnormal, infinite, NaN or out of proportion.
        value: f64,
    },
}

impl fmt::Display for PlannerError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Period { period } => write!(f, "period must be finite and > 0, got {period}"),
            Self::PeriodTooShort { period, share } => write!(
                f,
                "a period of {period} s leaves {share:e} of the acceleration limit, at least {MIN_AUTHORITY_SHARE:e} is needed"
            ),
            Self::OutOfScale { name, value } => {
                write!(f, "limits and period are out of proportion: {name} comes to {value:e}")
            }
        }
    }
}

impl core::error::Error for PlannerError {}

/// Why a step was refused.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RampError {
    /// An argument, or the final position, is NaN or infinite.
    NotFinite {
        /// What it is.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// One period does not suffice, or the velocity is beyond its limit.
    Unreachable {
        /// Initial velocity [rad/s or m/s].
        from: f64,
        /// The final velocity that was asked for [rad/s or m/s].
        to: f64,
        /// The final velocities that are reachable [rad/s or m/s].
        reachable: Interval,
    },
}

impl fmt::Display for RampError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { name, value } => write!(f, "{name} must be finite, got {value}"),
            Self::Unreachable { from, to, reachable: Interval { min, max } } => {
                write!(
                    f,
                    "velocity {to} is out of reach from {from} in one period, reachable is {min} to {max}"
                )
            }
        }
    }
}

impl core::error::Error for RampError {}
