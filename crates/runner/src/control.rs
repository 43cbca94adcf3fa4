//! The control laws of the whole machine: one controller per joint, or computed torque on a model.

use adaptive_ctrl::{
    AnyController, Command, DiscreteLoop, EffortLimits, Input, JointController, Measurement, Reference,
    Saturation,
};
use anyhow::{Context, Result, ensure};
use hiab_dynamics::{CraneModel, Data};
use serde::{Deserialize, Serialize};

use crate::machine::Machine;

/// What drives the actuators.
#[derive(Clone, Debug)]
pub enum Controllers {
    /// One law per joint, which sees that joint alone.
    Joints(Vec<AnyController>),
    /// One law that knows a model of the machine.
    ComputedTorque(Box<ComputedTorque>),
}

impl Controllers {
    /// The adaptive controllers that the machine was loaded with.
    #[must_use]
    pub fn adaptive(machine: &Machine) -> Self {
        Self::Joints(machine.joints().iter().map(|joint| joint.controller.clone().into()).collect())
    }

    /// One tick of every joint.
    ///
    /// # Errors
    /// A loop does not close where the crane is measured to be; only a law with a model looks.
    pub(crate) fn step(
        &mut self,
        references: &[Reference],
        measured: &[Measurement],
        commands: &mut [Command],
    ) -> Result<()> {
        match self {
            Self::Joints(joints) => {
                for (joint, controller) in joints.iter_mut().enumerate() {
                    commands[joint] = controller.step(references[joint], measured[joint]);
                }
                Ok(())
            }
            Self::ComputedTorque(law) => law.step(references, measured, commands),
        }
    }

    /// Takes over a crane at rest at `position` whose load is `unknown` beyond the feedforward, and writes where each
    /// reference must be for that: [`JointController::start_holding`].
    ///
    /// # Errors
    /// A load that an actuator cannot hold; the message names its joint.
    pub(crate) fn hold(
        &mut self,
        machine: &Machine,
        position: &[f64],
        unknown: &[f64],
        reference: &mut [f64],
    ) -> Result<()> {
        match self {
            Self::Joints(joints) => {
                for (joint, controller) in joints.iter_mut().enumerate() {
                    let measured = Measurement { position: position[joint], velocity: 0.0 };
                    controller.reset();
                    let start = controller.start_holding(measured, unknown[joint]).with_context(|| {
                        format!("{} cannot be held at {}", machine.joints()[joint].name, position[joint])
                    })?;
                    reference[joint] = start.position;
                }
                Ok(())
            }
            Self::ComputedTorque(law) => law.hold(machine, position, unknown, reference),
        }
    }
}

/// Gains of computed torque for one joint.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TorqueGains {
    /// Acceleration per position error [1/s²].
    pub stiffness: f64,
    /// Acceleration per velocity error [1/s].
    pub damping: f64,
}

impl TorqueGains {
    /// Largest damping·period. Where the model is exact each joint is a double integrator of inertia 1, so this is the
    /// bound of [`adaptive_ctrl::MAX_DAMPING_PER_TICK`], and [`adaptive_ctrl::MIN_DAMPING_RATIO`] is that of its ratio.
    fn check(self, joint: &str, period: f64) -> Result<()> {
        for (gain, value) in [("stiffness", self.stiffness), ("damping", self.damping)] {
            ensure!(value.is_finite() && value > 0.0, "{joint}: {gain} must be finite and > 0, got {value}");
        }
        let per_tick = self.damping * period;
        let bound = adaptive_ctrl::MAX_DAMPING_PER_TICK;
        ensure!(per_tick <= bound, "{joint}: damping per tick is {per_tick}, must be at most {bound}");
        let sampled = DiscreteLoop {
            damping_per_tick: per_tick,
            stiffness_per_tick: self.stiffness * period * period,
            integral_per_tick: 0.0,
        };
        let (ratio, least) = (sampled.damping_ratio(), adaptive_ctrl::MIN_DAMPING_RATIO);
        ensure!(
            ratio >= least,
            "{joint}: stiffness {} with damping {} has a damping ratio of {ratio}, must be at least {least}",
            self.stiffness,
            self.damping
        );
        Ok(())
    }
}

/// Computed torque: u = M(q)·(ẍ_r − D·e₂ − P·e₁) + bias(q, q̇) + friction(ẋ_r), with the model's M, bias and friction.
///
/// Friction is that of the reference's velocity: fed back from the measured one, its steep middle would act as negative
/// damping.
#[derive(Clone, Debug)]
pub struct ComputedTorque {
    model: CraneModel,
    data: Data,
    gains: Vec<TorqueGains>,
    effort_limits: Vec<EffortLimits>,
    position: Vec<f64>,
    velocity: Vec<f64>,
    wanted: Vec<f64>,
    effort: Vec<f64>,
    friction: Vec<f64>,
}

impl ComputedTorque {
    /// The law with `model`, one pair of gains and of effort limits for each joint.
    ///
    /// # Errors
    /// A gain is not positive, or the sampled loop would not be stable; the message names the joint.
    pub fn new(
        model: CraneModel,
        gains: Vec<TorqueGains>,
        effort_limits: Vec<EffortLimits>,
        period: f64,
    ) -> Result<Self> {
        for (gains, actuator) in gains.iter().zip(model.actuators()) {
            gains.check(actuator.name(), period)?;
        }
        let zeros = vec![0.0; gains.len()];
        Ok(Self {
            data: model.new_data(),
            model,
            gains,
            effort_limits,
            position: zeros.clone(),
            velocity: zeros.clone(),
            wanted: zeros.clone(),
            effort: zeros.clone(),
            friction: zeros,
        })
    }

    fn step(
        &mut self,
        references: &[Reference],
        measured: &[Measurement],
        commands: &mut [Command],
    ) -> Result<()> {
        for (joint, (reference, at)) in references.iter().zip(measured).enumerate() {
            let TorqueGains { stiffness, damping } = self.gains[joint];
            let (e1, e2) = (at.position - reference.position, at.velocity - reference.velocity);
            self.position[joint] = at.position;
            self.velocity[joint] = at.velocity;
            self.wanted[joint] = reference.acceleration - damping * e2 - stiffness * e1;
        }
        let Self { model, data, position, velocity, wanted, effort, friction, .. } = self;
        model.inverse_dynamics(data, position, velocity, wanted, None, effort).context("computed torque")?;
        model.friction_effort(velocity, friction)?;
        for joint in 0..effort.len() {
            effort[joint] -= friction[joint];
            velocity[joint] = references[joint].velocity;
        }
        model.friction_effort(velocity, friction)?;
        for (joint, command) in commands.iter_mut().enumerate() {
            let (asked, limits) = (effort[joint] + friction[joint], self.effort_limits[joint]);
            let saturation = if asked > limits.upper() {
                Saturation::AtUpper
            } else if asked < limits.lower() {
                Saturation::AtLower
            } else {
                Saturation::None
            };
            let effort = asked.clamp(limits.lower(), limits.upper());
            *command = Command { effort, saturation, input: Input::Used };
        }
        Ok(())
    }

    /// At rest M·(−P·e₁) is what the model's bias leaves of the load.
    fn hold(
        &mut self,
        machine: &Machine,
        position: &[f64],
        load: &[f64],
        reference: &mut [f64],
    ) -> Result<()> {
        self.velocity.fill(0.0);
        // `load` as effort: the model's own bias is taken off it by the forward dynamics.
        self.model.forward_dynamics(
            &mut self.data,
            position,
            &self.velocity,
            load,
            None,
            &mut self.wanted,
        )?;
        for (joint, limits) in self.effort_limits.iter().enumerate() {
            ensure!(
                (limits.lower()..=limits.upper()).contains(&load[joint]),
                "{} cannot be held at {}: holding effort {} is outside the actuator's limits [{}, {}]",
                machine.joints()[joint].name,
                position[joint],
                load[joint],
                limits.lower(),
                limits.upper()
            );
            let error = -self.wanted[joint] / self.gains[joint].stiffness;
            reference[joint] = position[joint] - error;
        }
        Ok(())
    }
}
