//! Proportional-integral-derivative control with anti-windup, a baseline.

use crate::gains::check_positive;
use crate::interface::check_hold;
use crate::stability::LinearLaw;
use crate::{
    Command, EffortLimits, GainsError, HoldError, Input, JointController, JointSpec, Measurement, Reference,
    Saturation, StabilityError,
};

/// PID gains of one joint as written down; not yet checked.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize), serde(deny_unknown_fields))]
pub struct PidGainsSpec {
    /// Effort per position error [N/m or N·m/rad].
    pub proportional: f64,
    /// Effort per time integral of the position error [N/(m·s) or N·m/(rad·s)].
    pub integral: f64,
    /// Effort per velocity error [N·s/m or N·m·s/rad].
    pub derivative: f64,
}

/// PID gains of one joint. Invariant: all finite and > 0.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Deserialize, serde::Serialize),
    serde(try_from = "PidGainsSpec", into = "PidGainsSpec")
)]
pub struct PidGains(PidGainsSpec);

impl PidGains {
    /// The three numbers, to read.
    pub fn values(&self) -> PidGainsSpec {
        self.0
    }
}

impl TryFrom<PidGainsSpec> for PidGains {
    type Error = GainsError;

    fn try_from(spec: PidGainsSpec) -> Result<Self, GainsError> {
        check_positive("proportional", spec.proportional)?;
        check_positive("integral", spec.integral)?;
        check_positive("derivative", spec.derivative)?;
        Ok(Self(spec))
    }
}

impl From<PidGains> for PidGainsSpec {
    fn from(gains: PidGains) -> Self {
        gains.0
    }
}

/// u = −P·e₁ − D·e₂ + I with İ = −K·e₁, cut to the effort limits.
///
/// Anti-windup by conditional integration: while the effort is cut, I moves only if that leads back
/// from the limit; and I itself never leaves the effort limits.
#[derive(Clone, Debug, PartialEq)]
pub struct PidController {
    gains: PidGainsSpec,
    period: f64,
    effort_limits: EffortLimits,
    integral_effort: f64, // I
    last_effort: f64,
}

impl PidController {
    /// A controller at rest, with I as close to 0 as the effort limits allow.
    ///
    /// # Errors
    /// [`StabilityError`] unless D·A_max·T_s ≤ [`MAX_DAMPING_PER_TICK`](crate::MAX_DAMPING_PER_TICK) and
    /// the sampled loop, integral included, is stable at A_min and A_max, with a damping ratio of at least
    /// [`MIN_DAMPING_RATIO`](crate::MIN_DAMPING_RATIO).
    pub fn new(gains: PidGains, joint: JointSpec) -> Result<Self, StabilityError> {
        let PidGainsSpec { proportional, integral, derivative } = gains.values();
        LinearLaw { stiffness: proportional, damping: derivative, integral }.check(&joint)?;
        let JointSpec { period, effort_limits, .. } = joint;
        let rest = effort_limits.saturate(0.0).0;
        Ok(Self { gains: gains.values(), period, effort_limits, integral_effort: rest, last_effort: rest })
    }

    /// I [N·m or N]: within the effort limits.
    pub fn integral_effort(&self) -> f64 {
        self.integral_effort
    }
}

impl JointController for PidController {
    fn step(&mut self, reference: Reference, measurement: Measurement) -> Command {
        let e1 = measurement.position - reference.position;
        let e2 = measurement.velocity - reference.velocity;
        let u = reference.effort + self.integral_effort
            - self.gains.proportional * e1
            - self.gains.derivative * e2;
        if !(e1.is_finite() && e2.is_finite() && reference.effort.is_finite() && !u.is_nan()) {
            return Command { effort: self.last_effort, saturation: Saturation::None, input: Input::Refused };
        }
        let (effort, saturation) = self.effort_limits.saturate(u);
        self.last_effort = effort;
        let change = -self.gains.integral * self.period * e1;
        let leads_back = match saturation {
            Saturation::None => true,
            Saturation::AtLower => change > 0.0,
            Saturation::AtUpper => change < 0.0,
        };
        if leads_back {
            self.integral_effort = self.effort_limits.saturate(self.integral_effort + change).0;
        }
        Command { effort, saturation, input: Input::Used }
    }

    fn reset(&mut self) {
        self.integral_effort = self.effort_limits.saturate(0.0).0;
        self.last_effort = self.integral_effort;
    }

    /// The integral takes the effort over, so the reference is where the joint is.
    fn start_holding(&mut self, measurement: Measurement, effort: f64) -> Result<Reference, HoldError> {
        check_hold(measurement, effort, self.effort_limits)?;
        self.integral_effort = effort;
        self.last_effort = effort;
        Ok(Reference {
            position: measurement.position,
            velocity: measurement.velocity,
            acceleration: 0.0,
            effort: 0.0,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Bounds, InverseInertia};

    fn joint() -> JointSpec {
        JointSpec {
            period: 0.001,
            inverse_inertia: InverseInertia::try_from(Bounds { lower: 0.5, upper: 2.0 }).unwrap(),
            effort_limits: EffortLimits::symmetric(10.0).unwrap(),
        }
    }

    fn controller() -> PidController {
        let spec = PidGainsSpec { proportional: 25.0, integral: 10.0, derivative: 8.0 };
        PidController::new(PidGains::try_from(spec).unwrap(), joint()).unwrap()
    }

    #[test]
    fn integral_sums_the_error_over_time() {
        let mut controller = controller();
        let measured = Measurement { position: 0.01, velocity: 0.0 };
        for _ in 0..100 {
            controller.step(Reference::default(), measured);
        }
        let expected = -10.0 * 0.01 * 0.1;
        assert!((controller.integral_effort() - expected).abs() < 1e-12);
        let command = controller.step(Reference::default(), measured);
        assert!((command.effort - (expected - 25.0 * 0.01)).abs() < 1e-12);
    }

    #[test]
    fn integral_does_not_wind_up_while_saturated() {
        let mut controller = controller();
        let far = Reference { position: 5.0, ..Reference::default() };
        for _ in 0..10_000 {
            assert_eq!(controller.step(far, Measurement::default()).saturation, Saturation::AtUpper);
        }
        assert_eq!(controller.integral_effort(), 0.0);
        // A limit reached by the integral itself is left again without delay.
        controller.start_holding(Measurement::default(), 10.0).unwrap();
        let past = Measurement { position: 0.001, velocity: -1.0 };
        assert_eq!(controller.step(Reference::default(), past).saturation, Saturation::AtUpper);
        assert!(controller.integral_effort() < 10.0);
    }

    #[test]
    fn constant_load_leaves_no_error() {
        let (mut controller, mut x, mut v) = (controller(), 0.0, 0.0);
        for _ in 0..80_000 {
            let measured = Measurement { position: x, velocity: v };
            let u = controller.step(Reference::default(), measured).effort;
            v += 0.001 * (u - 3.0);
            x += 0.001 * v;
        }
        assert!(x.abs() < 1e-9 && v.abs() < 1e-9, "{x}, {v}");
        assert!((controller.integral_effort() - 3.0).abs() < 1e-6);
    }

    #[test]
    fn a_held_joint_gets_its_effort_at_once() {
        let mut controller = controller();
        let measured = Measurement { position: 0.3, velocity: 0.02 };
        let reference = controller.start_holding(measured, 4.0).unwrap();
        assert_eq!(controller.step(reference, measured).effort, 4.0);
        assert!(controller.start_holding(Measurement { position: 0.0, velocity: f64::NAN }, 0.0).is_err());
        controller.reset();
        assert_eq!(controller.integral_effort(), 0.0);
    }

    #[test]
    fn refuses_an_integral_that_the_heaviest_joint_does_not_bear() {
        let spec = PidGainsSpec { proportional: 25.0, integral: 200.0, derivative: 8.0 }; // K < P·D·A = 100
        let error = PidController::new(PidGains::try_from(spec).unwrap(), joint()).unwrap_err();
        assert!(matches!(error, StabilityError::Unstable { .. }), "{error}");
    }
}
