//! The eight gains of the adaptive law.

/// Gains of one joint as written down; not yet checked.
///
/// With effort in N and position in m the units follow from the law; for a revolute joint read N·m
/// and rad.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize), serde(deny_unknown_fields))]
pub struct GainsSpec {
    /// Twice the rate of the virtual control at rest [1/s]: position error decays at ½k₁.
    pub k1: f64,
    /// Weight of φ̂₁ in the virtual control [1/s per unit of φ̂₁].
    pub k2: f64,
    /// Speed of the first adaptive law; k₃·k₄ is its leakage rate [1/s].
    pub k3: f64,
    /// Leakage of the first adaptive law.
    pub k4: f64,
    /// Twice the damping at rest [N·s/m]: velocity error decays at ½k₅·A.
    pub k5: f64,
    /// Weight of φ̂₂ in the control [N·s/m per unit of φ̂₂].
    pub k6: f64,
    /// Speed of the second adaptive law; k₇·k₈ is its leakage rate [1/s].
    pub k7: f64,
    /// Leakage of the second adaptive law.
    pub k8: f64,
}

impl GainsSpec {
    fn named(&self) -> [(&'static str, f64); 8] {
        let Self { k1, k2, k3, k4, k5, k6, k7, k8 } = *self;
        [("k1", k1), ("k2", k2), ("k3", k3), ("k4", k4), ("k5", k5), ("k6", k6), ("k7", k7), ("k8", k8)]
    }
}

/// Gains of one joint. Invariant: every one is finite and > 0, "positive constants" in
/// [P, Eqs. (305) to (311)].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Deserialize, serde::Serialize),
    serde(try_from = "GainsSpec", into = "GainsSpec")
)]
pub struct Gains(GainsSpec);

impl Gains {
    /// The eight numbers, to read.
    pub fn values(&self) -> GainsSpec {
        self.0
    }
}

impl TryFrom<GainsSpec> for Gains {
    type Error = GainsError;

    fn try_from(spec: GainsSpec) -> Result<Self, GainsError> {
        for (gain, value) in spec.named() {
            check_positive(gain, value)?;
        }
        Ok(Self(spec))
    }
}

impl From<Gains> for GainsSpec {
    fn from(gains: Gains) -> Self {
        gains.0
    }
}

/// A gain is not a positive number.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("gain {gain} must be finite and > 0, got {value}")]
pub struct GainsError {
    /// Which gain.
    pub gain: &'static str,
    /// Its value.
    pub value: f64,
}

pub(crate) fn check_positive(gain: &'static str, value: f64) -> Result<(), GainsError> {
    if value.is_finite() && value > 0.0 { Ok(()) } else { Err(GainsError { gain, value }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ONES: GainsSpec =
        GainsSpec { k1: 1.0, k2: 1.0, k3: 1.0, k4: 1.0, k5: 1.0, k6: 1.0, k7: 1.0, k8: 1.0 };

    #[test]
    fn refuses_each_gain_that_is_not_positive_by_its_name() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let specs = [
                ("k1", GainsSpec { k1: bad, ..ONES }),
                ("k2", GainsSpec { k2: bad, ..ONES }),
                ("k3", GainsSpec { k3: bad, ..ONES }),
                ("k4", GainsSpec { k4: bad, ..ONES }),
                ("k5", GainsSpec { k5: bad, ..ONES }),
                ("k6", GainsSpec { k6: bad, ..ONES }),
                ("k7", GainsSpec { k7: bad, ..ONES }),
                ("k8", GainsSpec { k8: bad, ..ONES }),
            ];
            for (name, spec) in specs {
                assert_eq!(Gains::try_from(spec).unwrap_err().gain, name, "with {bad}");
            }
        }
        assert!(Gains::try_from(ONES).is_ok());
    }
}
