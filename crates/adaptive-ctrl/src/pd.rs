//! Proportional-derivative control, a baseline.

use crate::gains::check_positive;
use crate::interface::check_hold;
use crate::stability::LinearLaw;
use crate::{
    Command, EffortLimits, Gains, GainsError, HoldError, Input, JointController, JointSpec, Measurement,
    Reference, Saturation, StabilityError,
};

/// PD gains of one joint as written down; not yet checked.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize), serde(deny_unknown_fields))]
pub struct PdGainsSpec {
    /// Effort per position error [N/m or N·m/rad].
    pub proportional: f64,
    /// Effort per velocity error [N·s/m or N·m·s/rad].
    pub derivative: f64,
}

/// PD gains of one joint. Invariant: both finite and > 0.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Deserialize, serde::Serialize),
    serde(try_from = "PdGainsSpec", into = "PdGainsSpec")
)]
pub struct PdGains(PdGainsSpec);

impl PdGains {
    /// What the adaptive law is without adaptation: u = −(1 + ¼k₁k₅)·e₁ − ½k₅·e₂.
    ///
    /// The fair baseline for it: whatever differs then is the adaptation's doing.
    ///
    /// # Errors
    /// [`GainsError`] if the product overflows.
    pub fn without_adaptation(gains: &Gains) -> Result<Self, GainsError> {
        let gains = gains.values();
        Self::try_from(PdGainsSpec {
            proportional: 1.0 + 0.25 * gains.k1 * gains.k5,
            derivative: 0.5 * gains.k5,
        })
    }

    /// The two numbers, to read.
    pub fn values(&self) -> PdGainsSpec {
        self.0
    }
}

impl TryFrom<PdGainsSpec> for PdGains {
    type Error = GainsError;

    fn try_from(spec: PdGainsSpec) -> Result<Self, GainsError> {
        check_positive("proportional", spec.proportional)?;
        check_positive("derivative", spec.derivative)?;
        Ok(Self(spec))
    }
}

impl From<PdGains> for PdGainsSpec {
    fn from(gains: PdGains) -> Self {
        gains.0
    }
}

/// u = u_r − P·e₁ − D·e₂ with the feedforward u_r, cut to the effort limits.
///
/// Under constant load it keeps an error of load / P.
#[derive(Clone, Debug, PartialEq)]
pub struct PdController {
    gains: PdGainsSpec,
    effort_limits: EffortLimits,
    last_effort: f64,
}

impl PdController {
    /// A controller at rest.
    ///
    /// # Errors
    /// [`StabilityError`] unless D·A_max·T_s ≤ [`MAX_DAMPING_PER_TICK`](crate::MAX_DAMPING_PER_TICK) and
    /// the sampled loop is stable at A_min and A_max, with a damping ratio of at least
    /// [`MIN_DAMPING_RATIO`](crate::MIN_DAMPING_RATIO).
    pub fn new(gains: PdGains, joint: JointSpec) -> Result<Self, StabilityError> {
        let PdGainsSpec { proportional, derivative } = gains.values();
        LinearLaw { stiffness: proportional, damping: derivative, integral: 0.0 }.check(&joint)?;
        let effort_limits = joint.effort_limits;
        Ok(Self { gains: gains.values(), effort_limits, last_effort: effort_limits.saturate(0.0).0 })
    }
}

impl JointController for PdController {
    fn step(&mut self, reference: Reference, measurement: Measurement) -> Command {
        let e1 = measurement.position - reference.position;
        let e2 = measurement.velocity - reference.velocity;
        let u = reference.effort - self.gains.proportional * e1 - self.gains.derivative * e2;
        if !(e1.is_finite() && e2.is_finite() && reference.effort.is_finite() && !u.is_nan()) {
            return Command { effort: self.last_effort, saturation: Saturation::None, input: Input::Refused };
        }
        let (effort, saturation) = self.effort_limits.saturate(u);
        self.last_effort = effort;
        Command { effort, saturation, input: Input::Used }
    }

    fn reset(&mut self) {
        self.last_effort = self.effort_limits.saturate(0.0).0;
    }

    fn start_holding(&mut self, measurement: Measurement, effort: f64) -> Result<Reference, HoldError> {
        check_hold(measurement, effort, self.effort_limits)?;
        self.last_effort = effort;
        Ok(Reference {
            position: measurement.position + effort / self.gains.proportional,
            velocity: measurement.velocity,
            acceleration: 0.0,
            effort: 0.0,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Bounds, GainsSpec, InverseInertia};

    fn joint() -> JointSpec {
        JointSpec {
            period: 0.001,
            inverse_inertia: InverseInertia::try_from(Bounds { lower: 0.5, upper: 2.0 }).unwrap(),
            effort_limits: EffortLimits::symmetric(10.0).unwrap(),
        }
    }

    fn controller() -> PdController {
        let gains = PdGains::try_from(PdGainsSpec { proportional: 30.0, derivative: 8.0 }).unwrap();
        PdController::new(gains, joint()).unwrap()
    }

    #[test]
    fn effort_is_the_weighted_errors() {
        let reference = Reference { position: 0.5, velocity: 0.1, acceleration: 9.0, effort: 0.0 };
        let command = controller().step(reference, Measurement { position: 0.6, velocity: -0.2 });
        assert!((command.effort - (-30.0 * 0.1 - 8.0 * -0.3)).abs() < 1e-12, "{command:?}");
        assert_eq!(command.saturation, Saturation::None);
    }

    #[test]
    fn large_errors_saturate() {
        let far = Reference { position: 1.0, ..Reference::default() };
        let command = controller().step(far, Measurement::default());
        assert_eq!((command.effort, command.saturation), (10.0, Saturation::AtUpper));
    }

    #[test]
    fn a_held_joint_gets_its_effort_at_once() {
        let mut controller = controller();
        let measured = Measurement { position: 0.3, velocity: -0.05 };
        let reference = controller.start_holding(measured, -7.0).unwrap();
        assert!((controller.step(reference, measured).effort + 7.0).abs() < 1e-12);
        let error = controller.start_holding(measured, 10.1).unwrap_err();
        assert_eq!(error, HoldError::EffortOutsideLimits { effort: 10.1, lower: -10.0, upper: 10.0 });
    }

    #[test]
    fn not_a_number_repeats_the_last_effort() {
        let mut controller = controller();
        let reference = Reference { position: 0.1, ..Reference::default() };
        let before = controller.step(reference, Measurement::default());
        let bad = controller.step(reference, Measurement { position: f64::NAN, velocity: 0.0 });
        assert_eq!((bad.effort, bad.input), (before.effort, Input::Refused));
    }

    #[test]
    fn equals_the_adaptive_law_that_does_not_adapt() {
        let spec = GainsSpec { k1: 4.0, k2: 1e-9, k3: 1.0, k4: 1.0, k5: 20.0, k6: 1e-9, k7: 1.0, k8: 1.0 };
        let gains = Gains::try_from(spec).unwrap();
        let mut adaptive = crate::AdaptiveController::new(gains, joint()).unwrap();
        let mut pd = PdController::new(PdGains::without_adaptation(&gains).unwrap(), joint()).unwrap();
        for n in 0..50 {
            let phase = f64::from(n);
            let measured = Measurement { position: 0.1 * phase.sin(), velocity: 0.1 * (2.0 * phase).cos() };
            let reference = Reference::default();
            let (a, b) = (adaptive.step(reference, measured), pd.step(reference, measured));
            assert!((a.effort - b.effort).abs() < 1e-12, "{} against {}", a.effort, b.effort);
        }
    }

    #[test]
    fn refuses_damping_that_the_period_does_not_bear() {
        let gains = PdGains::try_from(PdGainsSpec { proportional: 30.0, derivative: 300.0 }).unwrap();
        assert!(matches!(PdController::new(gains, joint()), Err(StabilityError::DampingTooStrong { .. })));
        assert!(PdGains::try_from(PdGainsSpec { proportional: 0.0, derivative: 1.0 }).is_err());
    }
}
