//! What the policy sees: Eq. (4a) of the paper, scaled by constants that come from the limits.

use serde::{Deserialize, Serialize};

/// A state of the crane as the policy is shown it, in SI units.
///
/// Source: [P, Eq. (equation: 4a)], f_t, p_t, ṗ_t, x_t, ẋ_t, p and δp_t in this order. Joint positions are those of
/// all actuators, then the angles of the booms that the cylinders turn; tip and target are (x, z) in the crane's
/// plane, in which the whole task takes place. The target is given from the tip, which with the tip's position says the
/// same as the paper's p: both in metres of a workspace of four, their difference would drown near the target, and
/// policies came to rest 6 to 15 cm beside it.
#[derive(Clone, Debug, PartialEq)]
pub struct Features<'a> {
    /// Effort of every actuator [N·m or N].
    pub effort: &'a [f64],
    /// Position of every actuator [rad or m].
    pub position: &'a [f64],
    /// Angle of every boom in a cylinder loop \[rad\].
    pub boom_angle: &'a [f64],
    /// Velocity of every actuator [rad/s or m/s].
    pub velocity: &'a [f64],
    /// Angular velocity of every boom in a cylinder loop [rad/s].
    pub boom_velocity: &'a [f64],
    /// Tip position (x, z) \[m\].
    pub tip: [f64; 2],
    /// Tip velocity (x, z) [m/s].
    pub tip_velocity: [f64; 2],
    /// Target relative to the tip (x, z) \[m\].
    pub target_from_tip: [f64; 2],
    /// Distance of tip and target \[m\].
    pub distance: f64,
}

impl Features<'_> {
    fn values(&self) -> impl Iterator<Item = f64> {
        [self.effort, self.position, self.boom_angle, self.velocity, self.boom_velocity]
            .into_iter()
            .flatten()
            .chain(&self.tip)
            .chain(&self.tip_velocity)
            .chain(&self.target_from_tip)
            .copied()
            .chain([self.distance])
    }
}

/// Constants that bring every feature to the order of one; they travel with the policy.
///
/// Invariant: as many offsets as scales, every scale finite and > 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "ScalingSpec", into = "ScalingSpec")]
pub struct Scaling {
    spec: ScalingSpec,
}

/// Constants as written down; not yet checked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScalingSpec {
    /// Subtracted first, in the feature's unit.
    pub offset: Vec<f64>,
    /// Divided by then, in the feature's unit.
    pub scale: Vec<f64>,
}

/// Constants that are none.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ScalingError {
    /// Lists of different length.
    #[error("{offsets} offsets but {scales} scales")]
    Lengths {
        /// Length of the one.
        offsets: usize,
        /// Length of the other.
        scales: usize,
    },
    /// A number that cannot be used.
    #[error("feature {index}: offset must be finite and scale finite and > 0, got {offset} and {scale}")]
    Value {
        /// Which feature.
        index: usize,
        /// Its offset.
        offset: f64,
        /// Its scale.
        scale: f64,
    },
}

impl TryFrom<ScalingSpec> for Scaling {
    type Error = ScalingError;

    fn try_from(spec: ScalingSpec) -> Result<Self, ScalingError> {
        if spec.offset.len() != spec.scale.len() {
            return Err(ScalingError::Lengths { offsets: spec.offset.len(), scales: spec.scale.len() });
        }
        for (index, (&offset, &scale)) in spec.offset.iter().zip(&spec.scale).enumerate() {
            if !(offset.is_finite() && scale.is_finite() && scale > 0.0) {
                return Err(ScalingError::Value { index, offset, scale });
            }
        }
        Ok(Self { spec })
    }
}

impl From<Scaling> for ScalingSpec {
    fn from(scaling: Scaling) -> Self {
        scaling.spec
    }
}

impl Scaling {
    /// Number of features.
    #[must_use]
    pub fn len(&self) -> usize {
        self.spec.offset.len()
    }

    /// True if there is no feature.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.spec.offset.is_empty()
    }

    /// True if both bring every feature to the same number, but for rounding.
    #[must_use]
    pub fn agrees_with(&self, other: &Self) -> bool {
        let ScalingSpec { offset, scale } = &self.spec;
        let same = |a: &f64, b: &f64, unit: &f64| (a - b).abs() <= 1e-9 * unit;
        self.len() == other.len()
            && offset.iter().zip(&other.spec.offset).zip(scale).all(|((a, b), unit)| same(a, b, unit))
            && scale.iter().zip(&other.spec.scale).all(|(a, b)| same(a, b, a))
    }

    /// The policy's input. Shape: `[len]`.
    ///
    /// The one place where the project's f64 becomes the learner's f32.
    ///
    /// # Panics
    /// `input` or the features have another length than these constants.
    pub fn apply(&self, features: &Features<'_>, input: &mut [f32]) {
        assert_eq!(input.len(), self.len(), "the input has the length of the constants");
        let mut count = 0;
        for (index, value) in features.values().enumerate() {
            input[index] = ((value - self.spec.offset[index]) / self.spec.scale[index]) as f32;
            count += 1;
        }
        assert_eq!(count, self.len(), "every feature has its constants");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn features_keep_the_order_of_the_paper() {
        let features = Features {
            effort: &[1.0],
            position: &[2.0],
            boom_angle: &[3.0],
            velocity: &[4.0],
            boom_velocity: &[5.0],
            tip: [6.0, 7.0],
            tip_velocity: [8.0, 9.0],
            target_from_tip: [10.0, 11.0],
            distance: 12.0,
        };
        let scaling = Scaling::try_from(ScalingSpec { offset: vec![1.0; 12], scale: vec![2.0; 12] }).unwrap();
        let mut input = [0.0; 12];
        scaling.apply(&features, &mut input);
        let expected: Vec<f32> = (0..12).map(|index| index as f32 / 2.0).collect();
        assert_eq!(input.as_slice(), expected);
    }

    #[test]
    fn scalings_agree_up_to_rounding() {
        let of = |offset, scale| {
            Scaling::try_from(ScalingSpec { offset: vec![offset], scale: vec![scale] }).unwrap()
        };
        let scaling = of(0.0, 2.0);
        assert!(scaling.agrees_with(&of(1e-10, 2.0 + 1e-10)));
        assert!(!scaling.agrees_with(&of(1e-6, 2.0)) && !scaling.agrees_with(&of(0.0, 2.0 + 1e-6)));
        let longer = ScalingSpec { offset: vec![0.0; 2], scale: vec![2.0; 2] };
        assert!(!scaling.agrees_with(&Scaling::try_from(longer).unwrap()));
    }

    #[test]
    fn refuses_a_scale_of_zero() {
        let spec = ScalingSpec { offset: vec![0.0, 0.0], scale: vec![1.0, 0.0] };
        assert!(matches!(Scaling::try_from(spec), Err(ScalingError::Value { index: 1, .. })));
        let spec = ScalingSpec { offset: vec![0.0], scale: vec![1.0, 1.0] };
        assert!(matches!(Scaling::try_from(spec), Err(ScalingError::Lengths { .. })));
    }
}
