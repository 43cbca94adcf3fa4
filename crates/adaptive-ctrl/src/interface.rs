//! What every joint controller takes and gives.

use crate::EffortLimits;

/// Where one joint should be now. Any values are legal; see [`Input::Refused`] for non-finite ones.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reference {
    /// x_r [rad or m].
    pub position: f64,
    /// ẋ_r [rad/s or m/s].
    pub velocity: f64,
    /// ẍ_r [rad/s² or m/s²].
    ///
    /// No controller of this crate uses it: the law of the paper treats ẍ_r as a bounded disturbance
    /// (it is part of d̄₂ there). It is in the interface so that one that does can take its place.
    pub acceleration: f64,
    /// Feedforward: the effort that a model of the machine expects here, 0 without a model [N·m or N].
    ///
    /// Every controller of this crate adds it to what its law asks for. The paper has none. It changes
    /// nothing in the proof, where what it leaves of load and coupling takes their place in the bounded
    /// uncertainty; `docs/control.md` says what it is worth.
    pub effort: f64,
}

/// Where one joint is now. Any values are legal; see [`Input::Refused`] for non-finite ones.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measurement {
    /// χ₁ [rad or m].
    pub position: f64,
    /// χ₂ [rad/s or m/s].
    pub velocity: f64,
}

/// What one joint's actuator is asked to do until the next tick, and what became of the input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Command {
    /// u [N·m for a revolute joint, N for a prismatic one]: finite, within the effort limits.
    pub effort: f64,
    /// Whether a limit cut the effort that the law asked for.
    pub saturation: Saturation,
    /// Whether the law could use its input.
    pub input: Input,
}

/// Whether the actuator's limits cut the effort.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Saturation {
    /// The effort is what the law asked for.
    None,
    /// The law asked for less than the lower limit, which is what was commanded.
    AtLower,
    /// The law asked for more than the upper limit, which is what was commanded.
    AtUpper,
}

/// Whether reference and measurement could be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    /// Every number was finite, and so was what the law made of them.
    Used,
    /// A number was not finite, or so large that the law overflowed. The command repeats the last
    /// effort and the controller's state has not moved. How long that may go on is for the
    /// caller to say.
    Refused,
}

/// One joint's controller.
pub trait JointController {
    /// Effort for the tick that begins now, and one tick of the controller's own state.
    ///
    /// Called once per period. Never fails, allocates or blocks.
    fn step(&mut self, reference: Reference, measurement: Measurement) -> Command;

    /// Puts the controller's state back to what it was when it was built.
    fn reset(&mut self);

    /// Takes over a joint that `effort` holds now: gives the reference for which the next
    /// [`step`](Self::step) commands that effort, and brings the controller's state to rest there.
    ///
    /// With a feedforward that stays, `effort` is what it leaves to the law. The reference has the measured
    /// velocity, so e₂ = 0, no acceleration and no feedforward. Start the reference
    /// generator from it: a start at the measured position instead would command no effort at all
    /// with a law that has no feedforward, and a loaded joint would drop until its error has grown
    /// to what holds it.
    ///
    /// # Errors
    /// [`HoldError`] if a number is not finite or the effort is outside the limits; the
    /// controller has not changed then.
    fn start_holding(&mut self, measurement: Measurement, effort: f64) -> Result<Reference, HoldError>;
}

/// A joint cannot be taken over as asked.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum HoldError {
    /// A number is NaN or infinite.
    #[error("{quantity} must be finite, got {value}")]
    NotFinite {
        /// Which number.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// The actuator cannot exert the effort [N·m or N].
    #[error("holding effort {effort} is outside the actuator's limits [{lower}, {upper}]")]
    EffortOutsideLimits {
        /// What was asked for.
        effort: f64,
        /// Lower effort limit.
        lower: f64,
        /// Upper effort limit.
        upper: f64,
    },
}

/// Refuses what no controller can start from.
pub(crate) fn check_hold(
    measurement: Measurement,
    effort: f64,
    limits: EffortLimits,
) -> Result<(), HoldError> {
    let numbers =
        [("position", measurement.position), ("velocity", measurement.velocity), ("holding effort", effort)];
    for (quantity, value) in numbers {
        if !value.is_finite() {
            return Err(HoldError::NotFinite { quantity, value });
        }
    }
    let (lower, upper) = (limits.lower(), limits.upper());
    if effort < lower || effort > upper {
        return Err(HoldError::EffortOutsideLimits { effort, lower, upper });
    }
    Ok(())
}
