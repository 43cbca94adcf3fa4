//! What a controller must know about its joint: tick, inertia, effort.

/// Two numbers as written down; not yet checked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The smaller one.
    pub lower: f64,
    /// The larger one.
    pub upper: f64,
}

/// Effort that one actuator can exert [N·m or N]. Invariant: finite, lower < upper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EffortLimits {
    lower: f64,
    upper: f64,
}

impl EffortLimits {
    /// The same effort both ways.
    ///
    /// # Errors
    /// [`LimitsError`] unless `effort` is finite and > 0.
    pub fn symmetric(effort: f64) -> Result<Self, LimitsError> {
        if !(effort.is_finite() && effort > 0.0) {
            return Err(LimitsError::NotPositive { quantity: "effort limit", value: effort });
        }
        Ok(Self { lower: -effort, upper: effort })
    }

    /// Least effort [N·m or N].
    pub fn lower(&self) -> f64 {
        self.lower
    }

    /// Greatest effort [N·m or N].
    pub fn upper(&self) -> f64 {
        self.upper
    }

    /// Cuts `effort`, which must not be NaN, to the limits and says which one did.
    pub(crate) fn saturate(&self, effort: f64) -> (f64, crate::Saturation) {
        if effort < self.lower {
            (self.lower, crate::Saturation::AtLower)
        } else if effort > self.upper {
            (self.upper, crate::Saturation::AtUpper)
        } else {
            (effort, crate::Saturation::None)
        }
    }
}

impl TryFrom<Bounds> for EffortLimits {
    type Error = LimitsError;

    fn try_from(bounds: Bounds) -> Result<Self, LimitsError> {
        let Bounds { lower, upper } = bounds;
        for value in [lower, upper] {
            if !value.is_finite() {
                return Err(LimitsError::NotFinite { quantity: "effort limit", value });
            }
        }
        if lower >= upper {
            return Err(LimitsError::Empty { quantity: "effort limits", lower, upper });
        }
        Ok(Self { lower, upper })
    }
}

/// Range of A, the inverse of the inertia that the joint's actuator moves, over the workspace
/// [1/kg or 1/(kg·m²)]. Invariant: finite, 0 < min ≤ max.
///
/// A is the joint's own diagonal element of the inverse mass matrix: its acceleration per effort with
/// the other joints free to move, the actuator's reflected inertia counted. The inverse of the mass
/// matrix's diagonal, with the other joints locked, is smaller (five times on a loader crane) and gives
/// gains that are too high: [`coupled_damping_per_tick`](crate::coupled_damping_per_tick) shows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InverseInertia {
    min: f64,
    max: f64,
}

impl InverseInertia {
    /// From the range of effective inertia instead [kg or kg·m²].
    ///
    /// # Errors
    /// As for the inverse: finite, > 0, in order.
    pub fn of_inertia(inertia: Bounds) -> Result<Self, LimitsError> {
        Self::try_from(inertia)?;
        Self::try_from(Bounds { lower: 1.0 / inertia.upper, upper: 1.0 / inertia.lower })
    }

    /// A where the joint is heaviest [1/kg or 1/(kg·m²)].
    pub fn min(&self) -> f64 {
        self.min
    }

    /// A where the joint is lightest [1/kg or 1/(kg·m²)].
    pub fn max(&self) -> f64 {
        self.max
    }
}

impl TryFrom<Bounds> for InverseInertia {
    type Error = LimitsError;

    fn try_from(bounds: Bounds) -> Result<Self, LimitsError> {
        let Bounds { lower, upper } = bounds;
        for value in [lower, upper] {
            if !(value.is_finite() && value > 0.0) {
                return Err(LimitsError::NotPositive { quantity: "inertia", value });
            }
        }
        if lower > upper {
            return Err(LimitsError::Empty { quantity: "inertia range", lower, upper });
        }
        Ok(Self { min: lower, max: upper })
    }
}

/// What a controller must know about its joint. The period is checked when the controller is built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointSpec {
    /// T_s, the time between two calls of `step`, in seconds: finite, > 0.
    pub period: f64,
    /// Range of A over the workspace.
    pub inverse_inertia: InverseInertia,
    /// What the actuator can exert.
    pub effort_limits: EffortLimits,
}

/// A joint's numbers make no sense.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum LimitsError {
    /// NaN or infinite.
    #[error("{quantity} must be finite, got {value}")]
    NotFinite {
        /// Which number.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// Not finite, zero or negative.
    #[error("{quantity} must be finite and > 0, got {value}")]
    NotPositive {
        /// Which number.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// The bounds are the wrong way round or leave nothing between them.
    #[error("{quantity} must be in order, got [{lower}, {upper}]")]
    Empty {
        /// Which range.
        quantity: &'static str,
        /// Its lower bound.
        lower: f64,
        /// Its upper bound.
        upper: f64,
    },
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Saturation;

    #[test]
    fn refuses_efforts_that_leave_nothing_between_them() {
        for bad in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
            assert!(EffortLimits::symmetric(bad).is_err(), "{bad}");
        }
        for (lower, upper) in [(1.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (0.0, f64::INFINITY)] {
            assert!(EffortLimits::try_from(Bounds { lower, upper }).is_err(), "[{lower}, {upper}]");
        }
        assert_eq!(EffortLimits::try_from(Bounds { lower: -2.0, upper: 1.0 }).unwrap().lower(), -2.0);
    }

    #[test]
    fn refuses_inertia_that_is_not_positive_or_out_of_order() {
        for (lower, upper) in [(0.0, 1.0), (-1.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (1.0, f64::INFINITY)] {
            assert!(InverseInertia::try_from(Bounds { lower, upper }).is_err(), "[{lower}, {upper}]");
            assert!(InverseInertia::of_inertia(Bounds { lower, upper }).is_err(), "[{lower}, {upper}]");
        }
    }

    #[test]
    fn inverse_of_the_inertia_range_is_swapped() {
        let range = InverseInertia::of_inertia(Bounds { lower: 4.0, upper: 8.0 }).unwrap();
        assert_eq!((range.min(), range.max()), (0.125, 0.25));
    }

    #[test]
    fn saturation_names_the_limit_that_cut() {
        let limits = EffortLimits::try_from(Bounds { lower: -2.0, upper: 1.0 }).unwrap();
        assert_eq!(limits.saturate(-2.5), (-2.0, Saturation::AtLower));
        assert_eq!(limits.saturate(f64::INFINITY), (1.0, Saturation::AtUpper));
        assert_eq!(limits.saturate(1.0), (1.0, Saturation::None));
    }
}
