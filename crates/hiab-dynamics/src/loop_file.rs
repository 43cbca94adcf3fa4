//! The loop file (RON): what a URDF cannot say about a crane.

use serde::{Deserialize, Serialize};

/// The loop file as written down; not yet checked against a URDF.
///
/// `CraneModel::from_urdf` reads and checks it; reading it alone tells which URDF file it belongs to.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct LoopFile {
    /// Name of the URDF file, relative to the loop file. This crate opens no files; it is for those who do.
    pub urdf: String,
    /// The link whose origin is the tip.
    pub tip_link: String,
    /// Closed cylinder loops; may be empty.
    pub closed_loops: Vec<ClosedLoopSpec>,
    /// Actuators, in the order of every vector of positions, velocities and efforts.
    pub actuators: Vec<ActuatorSpec>,
}

impl LoopFile {
    /// Reads the file's text.
    ///
    /// # Errors
    /// Line, column and cause if it is not RON, lacks a field, or has one that is not known.
    pub fn from_ron(text: &str) -> Result<Self, ron::error::SpannedError> {
        ron::from_str(text)
    }
}

/// One loop: a cylinder between two bodies that a revolute joint connects.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct ClosedLoopSpec {
    /// Name, for messages.
    pub name: String,
    /// Link at one half of the pin; one half is on the rod, the other on the body that the cylinder turns.
    pub frame_a: String,
    /// Link at the other half.
    pub frame_b: String,
    /// What the pin holds together.
    pub kind: LoopKind,
    /// The cylinder's prismatic joint; must be an actuator.
    pub independent: String,
    /// The turned revolute joint and the barrel's revolute joint, in either order.
    pub dependent: Vec<String>,
    /// Which of the two triangles.
    pub branch: Branch,
}

/// What a loop's pin holds together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub enum LoopKind {
    /// The origins of both frames coincide. In a planar loop two of the three equations are independent, and the
    /// third, across the plane, must hold by construction.
    Point3d,
    /// Both frames coincide, orientation included. Refused: a cylinder between hinges closes no such loop.
    Frame6d,
}

/// Side of the line from the turned joint to the barrel's hinge on which the pin lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub enum Branch {
    /// The pin is reached from that line by a positive rotation about the turned joint's axis.
    Positive,
    /// By a negative one.
    Negative,
}

/// One actuator as written down; not yet checked.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct ActuatorSpec {
    /// The joint it moves.
    pub joint: String,
    /// Least position [rad or m].
    pub lower: f64,
    /// Greatest position [rad or m].
    pub upper: f64,
    /// Greatest effort, both signs [N·m or N].
    pub effort: f64,
    /// Greatest velocity, both signs [rad/s or m/s].
    pub velocity: f64,
    /// Greatest acceleration, both signs [rad/s² or m/s²].
    pub acceleration: f64,
    /// Greatest jerk, both signs [rad/s³ or m/s³].
    pub jerk: f64,
    /// Reflected inertia of motor and gear [kg·m² or kg], ≥ 0.
    pub armature: f64,
}
