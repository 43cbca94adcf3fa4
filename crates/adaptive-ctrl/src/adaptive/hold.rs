//! Taking over a joint that is held, without a jump in effort.

use super::{Adaptation, AdaptiveController, Parameters};
use crate::interface::check_hold;
use crate::{HoldError, Measurement, Reference};

impl AdaptiveController {
    /// Reference for which the next step commands `effort` with the parameters as they are now.
    ///
    /// The reference moves with the measured velocity, so e₂ = 0, and
    /// −z₁ − ½(k₅ + k₆φ̂₂)·(0 − u_v) = effort gives z₁ = −effort / [`stiffness`](Self::stiffness). The
    /// controller does not change. The parameters drift from the next tick on, towards where this
    /// z₁ keeps them; [`start_holding`](crate::JointController::start_holding) starts there.
    ///
    /// # Errors
    /// [`HoldError`] if a number is not finite or the effort is outside the limits.
    pub fn holding_reference(&self, measurement: Measurement, effort: f64) -> Result<Reference, HoldError> {
        check_hold(measurement, effort, self.effort_limits)?;
        let z1 = -effort / self.stiffness();
        Ok(Reference {
            position: measurement.position - z1,
            velocity: measurement.velocity,
            acceleration: 0.0,
            effort: 0.0,
        })
    }

    /// Sets the parameters to what they rest at while `effort` holds the joint, and gives the
    /// reference that does so.
    pub(super) fn rest_at(&mut self, measurement: Measurement, effort: f64) -> Result<Reference, HoldError> {
        check_hold(measurement, effort, self.effort_limits)?;
        let at_rest = self.resting_parameters(self.resting_error(effort.abs()));
        self.position_law.set(at_rest.position);
        self.velocity_law.set(at_rest.velocity);
        self.last_effort = effort;
        self.adaptation = Adaptation::Free;
        self.holding_reference(measurement, effort)
    }

    /// |z₁| at which the joint rests under an effort of this size.
    ///
    /// stiffness(resting parameters(|z₁|))·|z₁| grows with |z₁|, and with parameters 0 it is least:
    /// the root lies between 0 and effort / stiffness at 0. Bisected down to neighbouring numbers.
    fn resting_error(&self, effort: f64) -> f64 {
        let none = Parameters { position: 0.0, velocity: 0.0 };
        let (mut low, mut high) = (0.0, effort / Self::linear(&self.gains, none).stiffness);
        loop {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                return high;
            }
            let stiffness = Self::linear(&self.gains, self.resting_parameters(middle)).stiffness;
            if stiffness * middle < effort {
                low = middle;
            } else {
                high = middle;
            }
        }
    }

    /// Where the parameters come to rest with z₁ held and e₂ = 0, so z₂ = ½(k₁ + k₂φ̂₁)·z₁.
    fn resting_parameters(&self, z1: f64) -> Parameters {
        let position = self.position_law.resting_estimate(z1);
        let z2 = 0.5 * (self.gains.k1 + self.gains.k2 * position) * z1;
        Parameters { position, velocity: self.velocity_law.resting_estimate(z2) }
    }
}
