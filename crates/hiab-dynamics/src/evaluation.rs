//! Everything about one state at once, to be written out.

use serde::{Deserialize, Serialize};

use crate::data::Data;
use crate::dynamics::Wrench;
use crate::error::DynamicsError;
use crate::model::CraneModel;

/// A state to evaluate, and what else to answer about it. Reads from JSON like a reference file; other fields there
/// are passed over.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct StateQuery {
    /// Actuator positions [rad or m].
    #[serde(rename = "q")]
    pub position: Vec<f64>,
    /// Actuator velocities [rad/s or m/s].
    #[serde(rename = "v")]
    pub velocity: Vec<f64>,
    /// Actuator efforts [N·m or N].
    #[serde(rename = "tau")]
    pub effort: Vec<f64>,
    /// Force and moment at the tip, world axes, for [`Evaluation::qdd_with_wrench`].
    pub tip_wrench: Option<[f64; 6]>,
    /// Accelerations for [`Evaluation::tau_inverse`].
    #[serde(rename = "qdd_desired")]
    pub desired_acceleration: Option<Vec<f64>>,
}

/// Results at one state. Field names are those of the reference file; matrices are lists of rows.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Evaluation {
    /// Tip position in the world \[m\].
    pub tip_position: [f64; 3],
    /// Tip rotation in the world.
    pub tip_rotation: [[f64; 3]; 3],
    /// Tip Jacobian, 6 × n, world axes at the tip, linear rows first.
    pub jacobian: Vec<Vec<f64>>,
    /// J̇ẏ, linear part first.
    pub jacobian_dot_v: [f64; 6],
    /// Tip velocity, linear part first.
    pub tip_velocity: [f64; 6],
    /// Tip acceleration at `qdd`, linear part first.
    pub tip_acceleration: [f64; 6],
    /// M, n × n.
    pub mass_matrix: Vec<Vec<f64>>,
    /// Coriolis, centrifugal and gravity effort.
    pub bias: Vec<f64>,
    /// Gravity effort.
    pub gravity: Vec<f64>,
    /// Acceleration under the query's effort.
    pub qdd: Vec<f64>,
    /// The same with the query's tip wrench, if it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub qdd_with_wrench: Option<Vec<f64>>,
    /// Effort for the query's desired acceleration, if it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tau_inverse: Option<Vec<f64>>,
    /// Kinetic energy \[J\].
    pub kinetic_energy: f64,
    /// Potential energy \[J\].
    pub potential_energy: f64,
    /// Tree positions.
    pub tree_q: Vec<f64>,
    /// Tree velocities.
    pub tree_v: Vec<f64>,
    /// Tree accelerations at `qdd`.
    pub tree_a: Vec<f64>,
    /// G, tree joints × n.
    #[serde(rename = "G")]
    pub tree_jacobian: Vec<Vec<f64>>,
    /// ġ of q̈ = Gÿ + ġ.
    #[serde(rename = "g")]
    pub tree_drift: Vec<f64>,
}

impl CraneModel {
    /// Evaluates one state in full. Allocates its answer; not for control loops.
    ///
    /// # Errors
    /// Those of [`forward_dynamics`](Self::forward_dynamics) and [`inverse_dynamics`](Self::inverse_dynamics).
    pub fn evaluate(&self, data: &mut Data, query: &StateQuery) -> Result<Evaluation, DynamicsError> {
        let StateQuery { position, velocity, effort, tip_wrench, desired_acceleration } = query;
        let n = self.actuators.len();
        let qdd_with_wrench = tip_wrench.map(|[fx, fy, fz, mx, my, mz]| {
            let wrench = Wrench { force: [fx, fy, fz], moment: [mx, my, mz] };
            let mut qdd = vec![0.0; n];
            self.forward_dynamics(data, position, velocity, effort, Some(&wrench), &mut qdd).map(|()| qdd)
        });
        let tau_inverse = desired_acceleration.as_ref().map(|desired| {
            let mut tau = vec![0.0; n];
            self.inverse_dynamics(data, position, velocity, desired, None, &mut tau).map(|()| tau)
        });
        let (qdd_with_wrench, tau_inverse) = (qdd_with_wrench.transpose()?, tau_inverse.transpose()?);
        let mut qdd = vec![0.0; n];
        self.forward_dynamics(data, position, velocity, effort, None, &mut qdd)?;

        let mut jacobian = vec![0.0; 6 * n];
        self.tip_jacobian(data, &mut jacobian)?;
        let mut tree_a = vec![0.0; data.tree_position.len()];
        self.tree_acceleration(data, &qdd, &mut tree_a)?;
        let (pose, drift, velocity) = (self.tip_pose(data), self.tip_drift(data), self.tip_velocity(data));
        let jacobian_dot_v = stack(drift.linear, drift.angular);
        let mut tip_acceleration = jacobian_dot_v;
        for (value, row) in tip_acceleration.iter_mut().zip(jacobian.chunks(n)) {
            *value += row.iter().zip(&qdd).map(|(j, a)| j * a).sum::<f64>();
        }
        let tree_row = |(joint, slope): (usize, &f64)| {
            let mut row = vec![0.0; n];
            row[self.driven_by[joint]] = *slope;
            row
        };
        Ok(Evaluation {
            tip_position: pose.position,
            tip_rotation: pose.rotation,
            jacobian: rows(&jacobian, n),
            jacobian_dot_v,
            tip_velocity: stack(velocity.linear, velocity.angular),
            tip_acceleration,
            mass_matrix: rows(&data.mass_matrix, n),
            bias: data.bias.clone(),
            gravity: data.gravity_effort.clone(),
            qdd,
            qdd_with_wrench,
            tau_inverse,
            kinetic_energy: self.kinetic_energy(data),
            potential_energy: self.potential_energy(data),
            tree_q: data.tree_position.clone(),
            tree_v: data.tree_velocity.clone(),
            tree_a,
            tree_jacobian: data.slope.iter().enumerate().map(tree_row).collect(),
            tree_drift: data.tree_drift.clone(),
        })
    }
}

fn rows(flat: &[f64], columns: usize) -> Vec<Vec<f64>> {
    flat.chunks(columns).map(<[f64]>::to_vec).collect()
}

fn stack(linear: [f64; 3], angular: [f64; 3]) -> [f64; 6] {
    let ([a, b, c], [d, e, f]) = (linear, angular);
    [a, b, c, d, e, f]
}
