//! A controller chosen at run time.

use crate::{
    AdaptiveController, Command, HoldError, JointController, Measurement, PdController, PidController,
    Reference,
};

/// One of the three controllers, for a choice that is made in configuration.
#[derive(Clone, Debug, PartialEq)]
pub enum AnyController {
    /// The paper's law.
    Adaptive(AdaptiveController),
    /// Baseline without an integral.
    Pd(PdController),
    /// Baseline with one.
    Pid(PidController),
}

impl From<AdaptiveController> for AnyController {
    fn from(controller: AdaptiveController) -> Self {
        Self::Adaptive(controller)
    }
}

impl From<PdController> for AnyController {
    fn from(controller: PdController) -> Self {
        Self::Pd(controller)
    }
}

impl From<PidController> for AnyController {
    fn from(controller: PidController) -> Self {
        Self::Pid(controller)
    }
}

impl JointController for AnyController {
    fn step(&mut self, reference: Reference, measurement: Measurement) -> Command {
        match self {
            Self::Adaptive(controller) => controller.step(reference, measurement),
            Self::Pd(controller) => controller.step(reference, measurement),
            Self::Pid(controller) => controller.step(reference, measurement),
        }
    }

    fn reset(&mut self) {
        match self {
            Self::Adaptive(controller) => controller.reset(),
            Self::Pd(controller) => controller.reset(),
            Self::Pid(controller) => controller.reset(),
        }
    }

    fn start_holding(&mut self, measurement: Measurement, effort: f64) -> Result<Reference, HoldError> {
        match self {
            Self::Adaptive(controller) => controller.start_holding(measurement, effort),
            Self::Pd(controller) => controller.start_holding(measurement, effort),
            Self::Pid(controller) => controller.start_holding(measurement, effort),
        }
    }
}
