//! Rigid-body dynamics of crane-like manipulators with closed cylinder loops.
//!
//! A [`CraneModel`] is built from a URDF (the tree of bodies) and a loop file (which joints a cylinder closes, and
//! which are actuators). Its coordinates are the actuators' positions: rotations of hinges \[rad\] and strokes of
//! cylinders \[m\]. Loops are eliminated in closed form, so cylinder masses count, constraints hold to rounding, and
//! there is no drift to stabilise. Everything that changes from state to state lives in a [`Data`]; after
//! [`CraneModel::new_data`] nothing allocates but [`CraneModel::evaluate`], the statics and an error.
//!
//! - Kinematics: [`CraneModel::update_kinematics`], then `tip_pose`, `tip_velocity`, `tip_jacobian`, `tip_drift`,
//!   `link_pose`, and the tree joints in [`Data`].
//! - Dynamics: [`CraneModel::update_dynamics`], `forward_dynamics`, `inverse_dynamics`, energies, `coriolis_matrix`.
//! - At the tip: [`CraneModel::tip_inertia`], `tip_mobility`, `apparent_mass`.
//! - Statics: [`CraneModel::largest_payload`], [`CraneModel::load_chart`].
//! - Time: [`CraneModel::semi_implicit_euler`], [`CraneModel::rk4`].
//! - Drives: a [`Plant`] adds reflected inertia and friction ([`CraneModel::with_plant`]), `with_payload` a mass at
//!   the tip.
//!
//! This crate opens no files, reads no clock and knows no controllers or rewards.
//!
//! # Picture
//!
//! ```text
//!   O ●━━━━━ b ━━━━━● P ━━━━ boom
//!     ┃ φ         ╱             a = |OC|, b = |OP|: fixed by the URDF
//!   a ┃         ╱  rod          ℓ = |CP| = λ + s: retracted length and stroke
//!     ┃       ╱
//!     ┃     ╱                   main joint at O, barrel joint at C,
//!     ┃   ╱  barrel             rod sliding in the barrel, pin at P
//!     ┃ ╱
//!   C ●
//! ```
//!
//! The URDF is a tree: it has the turned body behind O, the barrel behind C and the rod behind the barrel, but not
//! the pin that joins rod and body. The loop file says which two links the pin holds together, on which side of OC
//! it lies, and that the stroke is the actuator. What the URDF holds fast is lumped, so massless frames cost
//! nothing.
//!
//! # Loops
//!
//! Two sides of the triangle are fixed, the third is the cylinder, so the law of cosines gives both dependent
//! angles from the stroke alone: cos φ = (a² + b² − ℓ²)/2ab, and the angle at C likewise. With y the actuators and
//! q the tree joints, q = γ(y), q̇ = G(y)ẏ and q̈ = Gÿ + ġ(y, ẏ): G has the first derivatives of these angles, ġ the
//! second ones times ẏ². Of the tree's mass matrix H and its effort h at q̈ = 0,
//!
//! ```text
//! M(y) = GᵀHG        M ÿ + Gᵀ(h + Hġ) = effort − friction + Jᵀ·wrench
//! ```
//!
//! H by composite bodies, h + Hġ by one Newton-Euler pass, M factorised by Cholesky. Inverse dynamics is that pass
//! alone, with Gÿ + ġ in place of ġ. Both run in the bodies' own frames, where inertias do not change. φ′ = ℓ/(ab sin φ) has a pole
//! where the pins are in line; a stroke at which sin φ < 0.15 is an error. So is a negative
//! one if the actuator's range has none, since no rod goes below the cylinder's retracted length.
//!
//! Source: R. Featherstone, *Rigid Body Dynamics Algorithms*, Springer 2008, explicit loop closure (chapters 3 and
//! 8), Newton-Euler (5), composite bodies (6). The triangle of a loader crane: G. Petrović, J. Mattila, *Mechanism
//! and Machine Theory* 170 (2022) 104680. Unlike there, the masses of barrels and rods enter by the general
//! projection above, not by formulas for one crane.
//!
//! # Units and frames
//!
//! SI throughout; an actuator is revolute [rad, N·m] or prismatic [m, N]. The world W is the URDF's root link, z up
//! unless [`CraneModel::with_gravity`] says otherwise. Poses, velocities, Jacobians and wrenches of the tip are in
//! world axes at the tip, linear part first. Inside, `X_AB` is the pose of frame B in A, and all spatial vectors
//! are taken at the origin of W.
//!
//! Accuracy: agreement with an independent engine on the crane at 100 states to 1e-9 for kinematics and terms,
//! 1e-7 for accelerations (`tests/golden.rs`).
//!
//! # Examples
//!
//! A hoist: one boom, turned by one cylinder. Its effort at rest is the boom's weight times the ratio of rates.
//! ```
//! use hiab_dynamics::CraneModel;
//!
//! let body = |name: &str, mass: f64, x: f64| {
//!     format!(
//!         r#"<link name="{name}"><inertial><origin xyz="{x} 0 0"/><mass value="{mass}"/>
//!            <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>"#
//!     )
//! };
//! let urdf = format!(
//!     r#"<robot name="hoist"><link name="ground"/>{}{}{}<link name="pin_rod"/><link name="pin_boom"/>
//!     <joint name="boom_joint" type="continuous"><parent link="ground"/><child link="boom"/>
//!       <axis xyz="0 -1 0"/></joint>
//!     <joint name="barrel_joint" type="continuous"><parent link="ground"/><child link="barrel"/>
//!       <origin xyz="0 0 -0.8"/><axis xyz="0 -1 0"/></joint>
//!     <joint name="lift_joint" type="prismatic"><parent link="barrel"/><child link="rod"/>
//!       <origin xyz="0.7 0 0"/><axis xyz="1 0 0"/>
//!       <limit lower="0" upper="0.4" effort="9000" velocity="0.1"/></joint>
//!     <joint name="rod_end" type="fixed"><parent link="rod"/><child link="pin_rod"/></joint>
//!     <joint name="boom_eye" type="fixed"><parent link="boom"/><child link="pin_boom"/>
//!       <origin xyz="0.5 0 0"/></joint></robot>"#,
//!     body("boom", 40.0, 0.9),
//!     body("barrel", 1e-6, 0.3),
//!     body("rod", 1e-6, -0.2),
//! );
//! let loops = r#"(urdf: "hoist.urdf", tip_link: "pin_boom", closed_loops: [
//!     (name: "lift", frame_a: "pin_rod", frame_b: "pin_boom", kind: Point3d, independent: "lift_joint",
//!      dependent: ["boom_joint", "barrel_joint"], branch: Positive)],
//!   actuators: [(joint: "lift_joint", lower: 0.0, upper: 0.4, effort: 9000.0, velocity: 0.1,
//!     acceleration: 1.0, jerk: 100.0, armature: 0.0)])"#;
//! let model = CraneModel::from_urdf(&urdf, loops)?;
//! let mut data = model.new_data();
//!
//! // A horizontal boom makes a right angle with OC: ℓ² = 0.8² + 0.5².
//! let length = 0.89_f64.sqrt();
//! model.update_dynamics(&mut data, &[length - 0.7], &[0.0])?;
//! let boom_rate = length / (0.8 * 0.5); // φ′ = ℓ/(ab sin φ)
//! assert!((data.gravity_effort()[0] - 40.0 * 9.81 * 0.9 * boom_rate).abs() < 1e-3);
//!
//! // The same effort keeps it there for a second.
//! let effort = [data.gravity_effort()[0]];
//! let (mut position, mut velocity) = ([length - 0.7], [0.0]);
//! for _ in 0..2000 {
//!     model.semi_implicit_euler(&mut data, &mut position, &mut velocity, &effort, None, 5e-4)?;
//! }
//! assert!((position[0] - (length - 0.7)).abs() < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

mod actuator;
mod cholesky;
mod coriolis;
mod data;
mod dynamics;
mod error;
mod evaluation;
mod fault;
mod integrate;
mod joint;
mod kinematics;
mod load_chart;
mod loop_file;
mod loops;
mod model;
mod operational;
mod plant;
mod spatial;
mod tree;
mod triangle;
mod turn;
mod urdf_text;

pub use actuator::Actuator;
pub use data::Data;
pub use dynamics::Wrench;
pub use error::{DynamicsError, ModelError, PlantError};
pub use evaluation::{Evaluation, StateQuery};
pub use fault::{CloseFault, LoopFault, TextFault, TreeFault};
pub use kinematics::{Pose, Twist};
pub use load_chart::{Axis, LoadChart, LoadChartSpec, LoadPoint};
pub use loop_file::{ActuatorSpec, Branch, ClosedLoopSpec, LoopFile, LoopKind};
pub use model::CraneModel;
pub use plant::{ActuatorPlant, Plant, PlantFile};
