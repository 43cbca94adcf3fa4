//! The workspace: everything that changes from state to state, allocated once.
#![expect(non_snake_case, reason = "monogram frames")]

use nalgebra::Vector3;

use crate::spatial::{Force, Inertia, Motion, Transform, ZERO3};
use crate::turn::Placement;

/// Workspace of one [`CraneModel`](crate::CraneModel), made by its `new_data`.
///
/// Getters give the results of the last `update_*` or `forward_dynamics`; `inverse_dynamics` brings only the tree joints
/// to its state. Use it with the model that made it: another model of other size makes those calls panic.
#[derive(Clone, Debug)]
pub struct Data {
    // Actuator coordinates.
    pub(crate) velocity: Vec<f64>,
    pub(crate) mass_matrix: Vec<f64>,
    pub(crate) factor: Vec<f64>,
    pub(crate) bias: Vec<f64>,
    pub(crate) gravity_effort: Vec<f64>,
    pub(crate) column: Vec<f64>,
    /// L⁻¹Jᵀ of the tip, column by column.
    pub(crate) tip_columns: [Vec<f64>; 3],
    // Tree coordinates.
    pub(crate) tree_position: Vec<f64>,
    pub(crate) tree_velocity: Vec<f64>,
    pub(crate) tree_drift: Vec<f64>,
    pub(crate) slope: Vec<f64>,
    /// Second derivative of a tree position by its actuator's position.
    pub(crate) curvature: Vec<f64>,
    // Bodies.
    pub(crate) X_WB: Vec<Transform>,
    /// Twist in the world per velocity of the joint's actuator.
    pub(crate) columns: Vec<Motion>,
    pub(crate) bodies: Vec<Body>,
    // Integration.
    pub(crate) stages: Stages,
}

/// A body in motion, in its own frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Body {
    /// Where it is in its parent.
    pub(crate) placement: Placement,
    pub(crate) angular_velocity: Vector3<f64>,
    /// At ÿ = 0, as the next one; after `inverse_dynamics` both at the ÿ that it was given.
    pub(crate) angular_acceleration: Vector3<f64>,
    /// Of the body's origin, less gravity.
    pub(crate) acceleration: Vector3<f64>,
    /// Wrench that moves it and all that it carries.
    pub(crate) wrench: Force,
    /// Inertia of it and all that it carries.
    pub(crate) composite: Inertia,
}

impl Body {
    const AT_REST: Self = Self {
        placement: Placement::IDENTITY,
        angular_velocity: ZERO3,
        angular_acceleration: ZERO3,
        acceleration: ZERO3,
        wrench: Force::ZERO,
        composite: Inertia::ZERO,
    };
}

/// Intermediate states of one integration step. The empty default stands in while a step has them on loan.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stages {
    pub(crate) position: Vec<f64>,
    pub(crate) velocity: Vec<f64>,
    pub(crate) acceleration: Vec<f64>,
    pub(crate) position_sum: Vec<f64>,
    pub(crate) velocity_sum: Vec<f64>,
}

impl Data {
    pub(crate) fn new(actuators: usize, bodies: usize) -> Self {
        let n = || vec![0.0; actuators];
        let tree = || vec![0.0; bodies];
        Self {
            velocity: n(),
            mass_matrix: vec![0.0; actuators * actuators],
            factor: vec![0.0; actuators * actuators],
            bias: n(),
            gravity_effort: n(),
            column: n(),
            tip_columns: [n(), n(), n()],
            tree_position: tree(),
            tree_velocity: tree(),
            tree_drift: tree(),
            slope: vec![1.0; bodies],
            curvature: tree(),
            X_WB: vec![Transform::identity(); bodies],
            columns: vec![Motion::ZERO; bodies],
            bodies: vec![Body::AT_REST; bodies],
            stages: Stages {
                position: n(),
                velocity: n(),
                acceleration: n(),
                position_sum: n(),
                velocity_sum: n(),
            },
        }
    }

    /// Mass matrix M(y), armature included [kg·m², kg·m or kg]: n × n, row by row.
    ///
    /// As of the last `update_dynamics` or `forward_dynamics`.
    pub fn mass_matrix(&self) -> &[f64] {
        &self.mass_matrix
    }

    /// Coriolis, centrifugal and gravity effort [N·m or N], without friction: what holds the state at ÿ = 0.
    ///
    /// As of the last `update_dynamics` or `forward_dynamics`.
    pub fn bias(&self) -> &[f64] {
        &self.bias
    }

    /// Effort that balances gravity [N·m or N]. Valid as [`bias`](Self::bias) is.
    pub fn gravity_effort(&self) -> &[f64] {
        &self.gravity_effort
    }

    /// Positions q = γ(y) of all tree joints [rad or m].
    pub fn tree_position(&self) -> &[f64] {
        &self.tree_position
    }

    /// Velocities q̇ = Gẏ of all tree joints [rad/s or m/s].
    pub fn tree_velocity(&self) -> &[f64] {
        &self.tree_velocity
    }

    /// The part ġ of q̈ = Gÿ + ġ that ÿ does not cause [rad/s² or m/s²].
    pub fn tree_drift(&self) -> &[f64] {
        &self.tree_drift
    }

    /// The one non-zero entry of each row of G: tree velocity per velocity of the joint's actuator, which
    /// [`CraneModel::driving_actuator`](crate::CraneModel::driving_actuator) names.
    pub fn tree_slope(&self) -> &[f64] {
        &self.slope
    }
}
