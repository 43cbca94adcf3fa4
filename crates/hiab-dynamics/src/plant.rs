//! Drives: what motors, gears and seals add to the bare rigid body.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::error::PlantError;

/// Named plants, as a plant file (RON) lists them.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct PlantFile {
    /// The plants by name.
    pub plants: BTreeMap<String, Plant>,
}

impl PlantFile {
    /// Reads the file's text and checks every plant in it.
    ///
    /// # Errors
    /// [`PlantError::Ron`] with line, column and cause, or [`PlantError::BadValue`].
    pub fn from_ron(text: &str) -> Result<Self, PlantError> {
        let file: Self = ron::from_str(text)?;
        file.plants.values().try_for_each(Plant::check)?;
        Ok(file)
    }

    /// The plant `name`.
    ///
    /// # Errors
    /// [`PlantError::UnknownPlant`] lists the names that there are.
    pub fn plant(&self, name: &str) -> Result<&Plant, PlantError> {
        self.plants.get(name).ok_or_else(|| PlantError::UnknownPlant {
            name: name.to_owned(),
            known: self.plants.keys().cloned().collect(),
        })
    }
}

/// Armature and friction of a crane's actuators; one that is not named has none.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Plant {
    /// Values by joint name.
    pub actuators: BTreeMap<String, ActuatorPlant>,
}

impl Plant {
    /// Refuses values out of range.
    pub(crate) fn check(&self) -> Result<(), PlantError> {
        for (joint, values) in &self.actuators {
            let not_negative =
                [("armature", values.armature), ("coulomb", values.coulomb), ("viscous", values.viscous)];
            for (field, value) in not_negative {
                if !(value.is_finite() && value >= 0.0) {
                    return Err(PlantError::BadValue { joint: joint.clone(), field, rule: ">= 0", value });
                }
            }
            let value = values.transition_velocity;
            if !(value.is_finite() && value > 0.0) {
                let (joint, field) = (joint.clone(), "transition_velocity");
                return Err(PlantError::BadValue { joint, field, rule: "> 0", value });
            }
        }
        Ok(())
    }
}

/// Armature and friction of one actuator.
///
/// Friction opposes the velocity v with F_c·tanh(v/v_s) + b·v. The true Coulomb law jumps at v = 0, where no
/// explicit integrator converges; here dry friction reaches 76 % at v_s, 96 % at 2 v_s, and a load below F_c creeps
/// at less than its share of v_s instead of sticking. At v = 0 the slope is F_c/v_s + b, which an explicit step of
/// period h follows without oscillation while h·(F_c/v_s + b)/m < 1, with m the effective inertia of the actuator
/// (more exactly: while no eigenvalue of h·M⁻¹·diag(F_c/v_s + b) exceeds 1).
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct ActuatorPlant {
    /// Reflected inertia of motor and gear [kg·m² or kg], ≥ 0.
    pub armature: f64,
    /// Coulomb friction F_c [N·m or N], ≥ 0.
    pub coulomb: f64,
    /// Viscous friction b [N·m·s/rad or N·s/m], ≥ 0.
    pub viscous: f64,
    /// Transition velocity v_s of the Coulomb friction [rad/s or m/s], > 0.
    pub transition_velocity: f64,
}

impl ActuatorPlant {
    pub(crate) fn friction(&self) -> Friction {
        Friction {
            coulomb: self.coulomb,
            viscous: self.viscous,
            inverse_transition: 1.0 / self.transition_velocity,
        }
    }
}

/// Friction law of one actuator.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Friction {
    coulomb: f64,
    viscous: f64,
    inverse_transition: f64,
}

impl Friction {
    pub(crate) const NONE: Self = Self { coulomb: 0.0, viscous: 0.0, inverse_transition: 1.0 };

    /// Effort that opposes `velocity`, with the sign of `velocity`.
    #[inline]
    pub(crate) fn effort(&self, velocity: f64) -> f64 {
        let viscous = self.viscous * velocity;
        if self.coulomb == 0.0 {
            return viscous;
        }
        viscous + self.coulomb * libm::tanh(velocity * self.inverse_transition)
    }
}
