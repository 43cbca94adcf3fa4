//! Rigid-body dynamics of crane-like manipulators with closed cylinder loops.
//!
//! A [`CraneModel`] is built from a URDF (the tree of bodies) and a loop file (which joints a cylinder closes, and
//! which are actuators). Its coordinates are the actuators' positions: rotations of hinges [rad] and strokes of
//! cylinders [m]. Loops are eliminated in closed form, so cylinder masses count, constraints hold to rounding, and
//! there is no drift to stabilise. Everything that changes from state to state lives in a [`Data`]; after
//! [`CraneModel::new_data`] nothing allocates but [`CraneModel::evaluate`] and an error.
//!
//! - Kinematics: [`CraneModel::update_kinematics`], then `tip_pose`, `tip_velocity`, `tip_jacobian`, `tip_drift`,
//!   `link_pose`, and the tree joints in [`Data`].
//! - Dynamics: [`CraneModel::update_dynamics`], `forward_dynamics`, `inverse_dynamics`, energies.
//! - Time: [`CraneModel::semi_implicit_euler`], [`CraneModel::rk4`].
//! - Drives: a [`Plant`] adds reflected inertia and friction ([`CraneModel::with_plant`]), `with_payload` a mass at
//!   the tip.
//!
//! Units are SI, world axes have z up unless [`CraneModel::with_gravity`] says otherwise. This crate opens no files
//! and knows no controllers or rewards.
#![forbid(unsafe_code)]

mod actuator;
mod cholesky;
mod data;
mod dynamics;
mod error;
mod evaluation;
mod integrate;
mod kinematics;
mod loop_file;
mod loops;
mod model;
mod plant;
mod spatial;
mod tree;
mod triangle;
mod urdf_text;

pub use actuator::Actuator;
pub use data::Data;
pub use dynamics::Wrench;
pub use error::{DynamicsError, LoopFault, ModelError, PlantError, TextFault, TreeFault};
pub use evaluation::{Evaluation, StateQuery};
pub use kinematics::{Pose, Twist};
pub use loop_file::{ActuatorSpec, Branch, ClosedLoopSpec, LoopFile, LoopKind};
pub use model::CraneModel;
pub use plant::{ActuatorPlant, Plant, PlantFile};
