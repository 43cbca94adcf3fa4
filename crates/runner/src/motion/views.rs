//! What can be seen of a crane in motion.

use adaptive_ctrl::{Command, Measurement, Reference};
use hiab_dynamics::Data;
use jbtg::State;

use super::Motion;
use crate::control::Controllers;
use crate::governor::Overload;
use crate::machine::Machine;

impl Motion {
    /// The machine that moves.
    #[must_use]
    pub fn machine(&self) -> &Machine {
        &self.machine
    }

    /// Position of every joint [rad or m].
    #[must_use]
    pub fn position(&self) -> &[f64] {
        &self.position
    }

    /// Velocity of every joint [rad/s or m/s].
    #[must_use]
    pub fn velocity(&self) -> &[f64] {
        &self.velocity
    }

    /// Acceleration of every joint over the last tick [rad/s² or m/s²].
    #[must_use]
    pub fn acceleration(&self) -> &[f64] {
        &self.acceleration
    }

    /// Where every joint should be now.
    #[must_use]
    pub fn wanted(&self) -> &[State] {
        &self.wanted
    }

    /// What every controller was given and what it commanded last.
    #[must_use]
    pub fn commands(&self) -> (&[Reference], &[Measurement], &[Command]) {
        (&self.references, &self.measured, &self.commands)
    }

    /// The controllers.
    #[must_use]
    pub fn controllers(&self) -> &Controllers {
        &self.controllers
    }

    /// Policy periods in which the reference was held to gentle accelerations, for load that the feedforward does not
    /// know.
    #[must_use]
    pub fn gentle_periods(&self) -> u64 {
        self.governor.gentle_periods
    }

    /// An actuator that does not hold what it carries: whoever moves the crane sets its brakes now.
    #[must_use]
    pub fn overload(&self) -> Option<Overload> {
        let (joint, error) = self.governor.overloaded()?;
        let name = self.machine.joints()[joint].name.clone();
        Some(Overload { joint: name, time: self.time, effort: self.effort[joint], error })
    }

    /// Effort that every actuator exerts [N·m or N].
    #[must_use]
    pub fn exerted(&self) -> &[f64] {
        &self.exerted
    }

    /// Time since the start \[s\].
    #[must_use]
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Terms of the dynamics before the last tick.
    #[must_use]
    pub fn dynamics(&self) -> &Data {
        &self.data
    }

    /// Effort of every actuator as commanded [N·m or N].
    #[must_use]
    pub fn effort(&self) -> &[f64] {
        &self.effort
    }

    /// State of every joint's reference at the end of the last policy period.
    #[must_use]
    pub fn reference(&self) -> &[State] {
        &self.reference
    }
}
