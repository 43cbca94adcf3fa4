//! The subsystem-based adaptive controller of one joint.

mod hold;

use crate::law::{AdaptiveLaw, LawSpec};
use crate::stability::{LinearLaw, check_period};
use crate::{
    Command, EffortLimits, Gains, GainsSpec, HoldError, Input, JointController, JointSpec,
    MAX_DAMPING_PER_TICK, MIN_DAMPING_RATIO, Measurement, Reference, Saturation, StabilityError,
};

/// Adaptive controller of one joint, [P, Eqs. (304), (305), (307), (310), (311)].
///
/// With e₁ = χ₁ − x_r and e₂ = χ₂ − ẋ_r:
///
/// ```text
/// z₁ = e₁,  z₂ = e₂ − u_v                                   (304)
/// u_v = −½(k₁ + k₂φ̂₁)·z₁                                    (305)
/// dφ̂₁/dt = −k₃k₄·φ̂₁ + ½k₂k₃·|z₁|²                          (307)
/// u = −z₁ − ½(k₅ + k₆φ̂₂)·z₂                                 (310)
/// dφ̂₂/dt = −k₇k₈·φ̂₂ + ½k₆k₇·|z₂|²                          (311)
/// ```
///
/// The effort of a tick comes from the parameters at its beginning; both laws are then integrated
/// exactly over the tick with z held, so the parameters stay ≥ 0 whatever the gains.
///
/// Where it differs from the paper, which works in continuous time and with unlimited effort:
///
/// - Effort is cut to the actuator's limits and the [`Command`] says so; while it is cut neither
///   parameter moves, since an error that effort cannot reduce says nothing about the gain.
/// - φ̂₁ and φ̂₂ have ceilings (a projection), set at construction at what the sampled loop bears
///   over the whole range of inertia: ½(k₅ + k₆φ̂₂)·A_max·T_s ≤ [`MAX_DAMPING_PER_TICK`], and a damping
///   ratio of at least [`MIN_DAMPING_RATIO`] with ½(k₁ + k₂φ̂₁), whatever φ̂₂ is. [`adaptation`](Self::adaptation) says when one is reached.
/// - The reference may bring an effort that a model expects; it is added to u. Without it, or where the
///   model is wrong, a joint under constant load keeps an error of load / stiffness,
///   stiffness 1 + ¼(k₁ + k₂φ̂₁)(k₅ + k₆φ̂₂). [`start_holding`](JointController::start_holding) starts
///   there instead of dropping to it.
///
/// Slips of the paper, none of which changes the law: [P, Eq. (313)] should read φ̃₂, z₂ and φ₂*
/// throughout; φ₂* in the second [P, Eq. (eq40)] needs k₆ for k₄, and ψ₂ beside it the factor A on
/// k₅ and ψ₁ in the minimum; 1/A is differentiated as a constant; and what the proof shows is
/// convergence to a ball, not to zero. `docs/control.md` has the details.
#[derive(Clone, Debug, PartialEq)]
pub struct AdaptiveController {
    gains: GainsSpec,
    effort_limits: EffortLimits,
    position_law: AdaptiveLaw, // φ̂₁
    velocity_law: AdaptiveLaw, // φ̂₂
    last_effort: f64,
    adaptation: Adaptation,
}

/// The adaptive parameters, or bounds of them: ≥ 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters {
    /// φ̂₁ of [P, Eq. (307)].
    pub position: f64,
    /// φ̂₂ of [P, Eq. (311)].
    pub velocity: f64,
}

/// What the adaptive laws did in the last tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Adaptation {
    /// Both followed their law.
    Free,
    /// At least one was cut to its ceiling: the law asks for more gain than the sampled loop bears.
    AtCeiling,
    /// Neither moved: the effort was saturated or the input refused.
    Frozen,
}

impl AdaptiveController {
    /// A controller at rest, with both parameters 0.
    ///
    /// # Errors
    /// [`StabilityError`] if the sampled loop could not be stable with a margin over the whole
    /// range of inertia:
    /// - `DampingTooStrong` unless ½k₅·A_max·T_s ≤ [`MAX_DAMPING_PER_TICK`];
    /// - `Unstable` unless every eigenvalue of the sampled loop is inside the unit circle at A_min
    ///   and A_max;
    /// - `Underdamped` unless its damping ratio is at least [`MIN_DAMPING_RATIO`] there,
    ///   nearly ½k₁ ≤ ½k₅·A_min (a joint heavier than A_min stays stable and is less damped);
    /// - `Limits` unless the period is finite and > 0.
    pub fn new(gains: Gains, joint: JointSpec) -> Result<Self, StabilityError> {
        let JointSpec { period, inverse_inertia, effort_limits } = joint;
        check_period(period)?;
        let gains = gains.values();
        Self::linear(&gains, Parameters { position: 0.0, velocity: 0.0 }).check(&joint)?;

        let largest_damping = MAX_DAMPING_PER_TICK / (inverse_inertia.max() * period);
        let ceilings = Parameters {
            position: ceiling(2.0 * largest_rate(0.5 * gains.k5, &joint), gains.k1, gains.k2),
            velocity: ceiling(2.0 * largest_damping, gains.k5, gains.k6),
        };
        Ok(Self {
            gains,
            effort_limits,
            position_law: AdaptiveLaw::new(LawSpec {
                weight: gains.k2,
                speed: gains.k3,
                leakage: gains.k4,
                period,
                ceiling: ceilings.position,
            }),
            velocity_law: AdaptiveLaw::new(LawSpec {
                weight: gains.k6,
                speed: gains.k7,
                leakage: gains.k8,
                period,
                ceiling: ceilings.velocity,
            }),
            last_effort: effort_limits.saturate(0.0).0,
            adaptation: Adaptation::Free,
        })
    }

    /// The gains that it was built with.
    pub fn gains(&self) -> &GainsSpec {
        &self.gains
    }

    /// φ̂₁ and φ̂₂ as they are now.
    pub fn parameters(&self) -> Parameters {
        Parameters { position: self.position_law.estimate(), velocity: self.velocity_law.estimate() }
    }

    /// The largest φ̂₁ and φ̂₂ that the sampled loop bears.
    pub fn parameter_ceilings(&self) -> Parameters {
        Parameters { position: self.position_law.ceiling(), velocity: self.velocity_law.ceiling() }
    }

    /// What the adaptive laws did in the last tick; `Free` before the first.
    pub fn adaptation(&self) -> Adaptation {
        self.adaptation
    }

    /// Proportional gain that the law amounts to now, 1 + ¼(k₁ + k₂φ̂₁)(k₅ + k₆φ̂₂) [N/m or N·m/rad].
    pub fn stiffness(&self) -> f64 {
        Self::linear(&self.gains, self.parameters()).stiffness
    }

    /// Derivative gain that the law amounts to now, ½(k₅ + k₆φ̂₂) [N·s/m or N·m·s/rad].
    pub fn damping(&self) -> f64 {
        Self::linear(&self.gains, self.parameters()).damping
    }

    /// The law with its parameters held is linear: u = −(1 + ¼K₁K₅)·e₁ − ½K₅·e₂,
    /// K₁ = k₁ + k₂φ̂₁, K₅ = k₅ + k₆φ̂₂.
    fn linear(gains: &GainsSpec, parameters: Parameters) -> LinearLaw {
        let virtual_rate = 0.5 * (gains.k1 + gains.k2 * parameters.position);
        let damping = 0.5 * (gains.k5 + gains.k6 * parameters.velocity);
        LinearLaw { stiffness: 1.0 + damping * virtual_rate, damping, integral: 0.0 }
    }

    /// z₁, z₂ of Eq. (304) and u of Eq. (310), for errors e₁ and e₂.
    fn law(&self, e1: f64, e2: f64) -> (f64, f64, f64) {
        let GainsSpec { k1, k2, k5, k6, .. } = self.gains;
        let z1 = e1;
        let u_v = -0.5 * (k1 + k2 * self.position_law.estimate()) * z1;
        let z2 = e2 - u_v;
        let u = -z1 - 0.5 * (k5 + k6 * self.velocity_law.estimate()) * z2;
        (z1, z2, u)
    }
}

impl JointController for AdaptiveController {
    fn step(&mut self, reference: Reference, measurement: Measurement) -> Command {
        let e1 = measurement.position - reference.position;
        let e2 = measurement.velocity - reference.velocity;
        let (z1, z2, u) = self.law(e1, e2);
        let u = reference.effort + u;
        // Infinite inputs end up in e₁ or e₂; finite ones that overflow do in u.
        if !(e1.is_finite() && e2.is_finite() && reference.effort.is_finite() && !u.is_nan()) {
            self.adaptation = Adaptation::Frozen;
            return Command { effort: self.last_effort, saturation: Saturation::None, input: Input::Refused };
        }
        let (effort, saturation) = self.effort_limits.saturate(u);
        self.last_effort = effort;
        self.adaptation = if saturation != Saturation::None {
            Adaptation::Frozen
        } else {
            let position_cut = self.position_law.advance(z1);
            let velocity_cut = self.velocity_law.advance(z2);
            if position_cut || velocity_cut { Adaptation::AtCeiling } else { Adaptation::Free }
        };
        Command { effort, saturation, input: Input::Used }
    }

    fn reset(&mut self) {
        self.position_law.set(0.0);
        self.velocity_law.set(0.0);
        self.last_effort = self.effort_limits.saturate(0.0).0;
        self.adaptation = Adaptation::Free;
    }

    /// Brings both parameters to rest where the holding error keeps them: neither drifts while the
    /// joint is held, so the held joint is an equilibrium and not only for the first tick.
    fn start_holding(&mut self, measurement: Measurement, effort: f64) -> Result<Reference, HoldError> {
        self.rest_at(measurement, effort)
    }
}

/// Largest rate of the virtual control with which the sampled loop keeps [`MIN_DAMPING_RATIO`] where the joint is
/// heaviest [1/s]. More damping than `damping` or less inertia only help.
fn largest_rate(damping: f64, joint: &JointSpec) -> f64 {
    let inverse = joint.inverse_inertia.min();
    let ratio = |rate: f64| {
        let law = LinearLaw { stiffness: 1.0 + damping * rate, damping, integral: 0.0 };
        law.sampled(inverse, joint.period).damping_ratio()
    };
    // Without sampling, and without the 1, it would be the upper end.
    let (mut low, mut high) = (0.0, damping * inverse);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return low;
        }
        if ratio(middle) >= MIN_DAMPING_RATIO {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/// φ̂ for which `base + weight·φ̂` reaches `bound`; 0 if `base` is there already.
fn ceiling(bound: f64, base: f64, weight: f64) -> f64 {
    ((bound - base) / weight).clamp(0.0, f64::MAX)
}

#[cfg(test)]
mod tests;
