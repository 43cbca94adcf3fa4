//! Kinematic limits of one joint, [P, Eq. (constraint1)].

use core::fmt;

use crate::Interval;

/// The four limited quantities, always in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Position [rad or m].
    Position,
    /// Velocity [rad/s or m/s].
    Velocity,
    /// Acceleration [rad/s² or m/s²].
    Acceleration,
    /// Jerk [rad/s³ or m/s³].
    Jerk,
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Position => "position",
            Self::Velocity => "velocity",
            Self::Acceleration => "acceleration",
            Self::Jerk => "jerk",
        })
    }
}

/// Limits of one joint as written down; not yet checked.
///
/// Source: [P, Eq. (constraint1)], one interval per quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct LimitsSpec {
    /// Position [rad or m], min < max.
    pub position: Interval,
    /// Velocity [rad/s or m/s], min < 0 < max.
    pub velocity: Interval,
    /// Acceleration [rad/s² or m/s²], min < 0 < max.
    pub acceleration: Interval,
    /// Jerk [rad/s³ or m/s³], min < 0 < max.
    pub jerk: Interval,
}

/// Limits that are the same in both directions, as most data sheets give them; not yet checked.
///
/// # Examples
/// ```
/// use jbtg::{Interval, Limits, SymmetricLimits};
///
/// let limits = Limits::try_from(SymmetricLimits {
///     position: Interval::new(0.14, 0.50),
///     velocity: 0.15,
///     acceleration: 1.0,
///     jerk: 100.0,
/// })?;
/// assert_eq!(limits.velocity(), Interval::new(-0.15, 0.15));
/// # Ok::<(), jbtg::LimitsError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct SymmetricLimits {
    /// Position interval [rad or m], min < max.
    pub position: Interval,
    /// Largest speed [rad/s or m/s], > 0.
    pub velocity: f64,
    /// Largest magnitude of the acceleration [rad/s² or m/s²], > 0.
    pub acceleration: f64,
    /// Largest magnitude of the jerk [rad/s³ or m/s³], > 0.
    pub jerk: f64,
}

/// Checked limits of one joint.
///
/// Invariant: every bound and the position interval's width are finite, the position interval is not empty
/// or a single point, and the intervals of velocity, acceleration and jerk hold 0 in their interior.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "LimitsSpec", into = "LimitsSpec")
)]
pub struct Limits {
    spec: LimitsSpec,
}

impl Limits {
    /// Position interval [rad or m].
    #[must_use]
    pub const fn position(&self) -> Interval {
        self.spec.position
    }

    /// Velocity interval [rad/s or m/s].
    #[must_use]
    pub const fn velocity(&self) -> Interval {
        self.spec.velocity
    }

    /// Acceleration interval [rad/s² or m/s²].
    #[must_use]
    pub const fn acceleration(&self) -> Interval {
        self.spec.acceleration
    }

    /// Jerk interval [rad/s³ or m/s³].
    #[must_use]
    pub const fn jerk(&self) -> Interval {
        self.spec.jerk
    }
}

impl TryFrom<LimitsSpec> for Limits {
    type Error = LimitsError;

    fn try_from(spec: LimitsSpec) -> Result<Self, LimitsError> {
        let LimitsSpec { position, velocity, acceleration, jerk } = spec;
        let named = [
            (Quantity::Position, position),
            (Quantity::Velocity, velocity),
            (Quantity::Acceleration, acceleration),
            (Quantity::Jerk, jerk),
        ];
        for (quantity, interval) in named {
            for value in [interval.min, interval.max, interval.width()] {
                if !value.is_finite() {
                    return Err(LimitsError::NotFinite { quantity, value });
                }
            }
        }
        if position.min >= position.max {
            return Err(LimitsError::EmptyPosition { min: position.min, max: position.max });
        }
        for (quantity, interval) in &named[1..] {
            if !(interval.min < 0.0 && 0.0 < interval.max) {
                let (quantity, min, max) = (*quantity, interval.min, interval.max);
                return Err(LimitsError::ZeroNotInside { quantity, min, max });
            }
        }
        Ok(Self { spec })
    }
}

impl TryFrom<SymmetricLimits> for Limits {
    type Error = LimitsError;

    fn try_from(limits: SymmetricLimits) -> Result<Self, LimitsError> {
        Self::try_from(LimitsSpec::from(limits))
    }
}

impl From<SymmetricLimits> for LimitsSpec {
    fn from(limits: SymmetricLimits) -> Self {
        Self {
            position: limits.position,
            velocity: Interval::symmetric(limits.velocity),
            acceleration: Interval::symmetric(limits.acceleration),
            jerk: Interval::symmetric(limits.jerk),
        }
    }
}

impl From<Limits> for LimitsSpec {
    fn from(limits: Limits) -> Self {
        limits.spec
    }
}

/// Why limits were refused.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LimitsError {
    /// A bound, or the width between two, is NaN or infinite.
    NotFinite {
        /// The quantity it bounds.
        quantity: Quantity,
        /// The offending bound or width.
        value: f64,
    },
    /// The position interval is empty or a single point.
    EmptyPosition {
        /// Lower bound [rad or m].
        min: f64,
        /// Upper bound [rad or m].
        max: f64,
    },
    /// An interval of velocity, acceleration or jerk does not hold 0 in its interior.
    ZeroNotInside {
        /// The quantity it bounds.
        quantity: Quantity,
        /// Lower bound.
        min: f64,
        /// Upper bound.
        max: f64,
    },
}

impl fmt::Display for LimitsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { quantity, value } => write!(f, "{quantity} limit must be finite, got {value}"),
            Self::EmptyPosition { min, max } => {
                write!(f, "position limits must satisfy min < max, got {min} and {max}")
            }
            Self::ZeroNotInside { quantity, min, max } => {
                write!(f, "{quantity} limits must satisfy min < 0 < max, got {min} and {max}")
            }
        }
    }
}

impl core::error::Error for LimitsError {}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: SymmetricLimits = SymmetricLimits {
        position: Interval::new(0.14, 0.5),
        velocity: 0.15,
        acceleration: 1.0,
        jerk: 100.0,
    };

    #[track_caller]
    fn check_refused(spec: LimitsSpec, expected: LimitsError) {
        assert_eq!(Limits::try_from(spec), Err(expected));
    }

    #[test]
    fn refuses_zero_jerk_and_says_so() {
        let error = Limits::try_from(SymmetricLimits { jerk: 0.0, ..GOOD }).unwrap_err();
        assert_eq!(error.to_string(), "jerk limits must satisfy min < 0 < max, got -0 and 0");
    }

    #[test]
    fn refuses_an_empty_position_interval() {
        let spec = LimitsSpec { position: Interval::new(1.0, 1.0), ..GOOD.into() };
        check_refused(spec, LimitsError::EmptyPosition { min: 1.0, max: 1.0 });
    }

    #[test]
    fn refuses_a_velocity_interval_that_starts_at_zero() {
        let spec = LimitsSpec { velocity: Interval::new(0.0, 1.0), ..GOOD.into() };
        check_refused(spec, LimitsError::ZeroNotInside { quantity: Quantity::Velocity, min: 0.0, max: 1.0 });
    }

    #[test]
    fn refuses_an_infinite_acceleration() {
        let spec = LimitsSpec { acceleration: Interval::new(-1.0, f64::INFINITY), ..GOOD.into() };
        check_refused(
            spec,
            LimitsError::NotFinite { quantity: Quantity::Acceleration, value: f64::INFINITY },
        );
    }

    #[test]
    fn refuses_nan_and_an_overflowing_width() {
        assert!(Limits::try_from(SymmetricLimits { velocity: f64::NAN, ..GOOD }).is_err());
        let position = Interval::new(-f64::MAX, f64::MAX);
        assert!(Limits::try_from(SymmetricLimits { position, ..GOOD }).is_err());
    }
}
