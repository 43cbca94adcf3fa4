//! A closed interval of one quantity.

/// Closed interval [min, max] of one quantity, in that quantity's unit.
///
/// A plain pair: any values are legal here. What needs an order or finite ends checks it
/// ([`Limits`](crate::Limits) does).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Interval {
    /// Lower end.
    pub min: f64,
    /// Upper end.
    pub max: f64,
}

impl Interval {
    /// The interval [min, max].
    #[must_use]
    pub const fn new(min: f64, max: f64) -> Self {
        Self { min, max }
    }

    /// The interval [−bound, bound].
    #[must_use]
    pub const fn symmetric(bound: f64) -> Self {
        Self { min: -bound, max: bound }
    }

    /// Length of the interval, max − min.
    #[must_use]
    pub fn width(self) -> f64 {
        self.max - self.min
    }

    /// Whether `value` lies in the closed interval. False for NaN.
    #[must_use]
    pub fn contains(self, value: f64) -> bool {
        self.min <= value && value <= self.max
    }

    /// The point of the interval nearest to `value`. NaN stays NaN; `min` wins where the interval is empty.
    #[must_use]
    pub fn clamp(self, value: f64) -> f64 {
        if value < self.min {
            self.min
        } else if value > self.max {
            self.max.max(self.min)
        } else {
            value
        }
    }

    /// The smallest interval that holds this one and `value`.
    #[must_use]
    pub fn including(self, value: f64) -> Self {
        Self { min: self.min.min(value), max: self.max.max(value) }
    }

    /// The smallest interval that holds this one and `other`.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The interval of the mirrored quantity, [−max, −min].
    #[must_use]
    pub fn mirrored(self) -> Self {
        Self { min: -self.max, max: -self.min }
    }
}

#[cfg(test)]
mod tests {
    use super::Interval;

    #[test]
    fn clamp_returns_the_nearest_point() {
        let interval = Interval::new(-1.0, 2.0);
        assert_eq!(interval.clamp(-3.0), -1.0);
        assert_eq!(interval.clamp(0.5), 0.5);
        assert_eq!(interval.clamp(3.0), 2.0);
        assert!(interval.clamp(f64::NAN).is_nan());
    }

    #[test]
    fn a_mirrored_interval_swaps_and_negates_its_ends() {
        assert_eq!(Interval::new(-1.0, 2.0).mirrored(), Interval::new(-2.0, 1.0));
    }
}
