//! Mass matrix, bias, forward and inverse dynamics, energies.
#![expect(non_snake_case, reason = "monogram frames")]

use nalgebra::Vector3;

use crate::cholesky;
use crate::data::Data;
use crate::error::DynamicsError;
use crate::kinematics::{check, check_length};
use crate::model::CraneModel;
use crate::spatial::Force;

/// A force and a moment that the surroundings exert at the tip, world axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrench {
    /// Force \[N\].
    pub force: [f64; 3],
    /// Moment about the tip [N·m].
    pub moment: [f64; 3],
}

impl CraneModel {
    /// Kinematics, mass matrix, bias and gravity effort at a state.
    ///
    /// M = GᵀHG and bias = Gᵀ(h + Hġ), with H and h of the tree; H by composite bodies, h + Hġ by one
    /// Newton-Euler pass whose joint accelerations are ġ.
    ///
    /// # Errors
    /// Those of [`update_kinematics`](Self::update_kinematics).
    pub fn update_dynamics(
        &self,
        data: &mut Data,
        position: &[f64],
        velocity: &[f64],
    ) -> Result<(), DynamicsError> {
        self.update_kinematics(data, position, velocity)?;
        let mut bias = std::mem::take(&mut data.bias);
        self.sum_wrenches(data, &mut bias);
        data.bias = bias;
        self.sum_inertias(data);
        Ok(())
    }

    /// Writes the effort Gᵀτ of all actuators to `effort`, with τ what moves the bodies as they move: one pass from the
    /// tips inwards.
    fn sum_wrenches(&self, data: &mut Data, effort: &mut [f64]) {
        for (body, inertia) in data.bodies.iter_mut().zip(&self.inertias) {
            body.wrench =
                inertia.wrench_at(&body.angular_velocity, &body.angular_acceleration, &body.acceleration);
        }
        effort.fill(0.0);
        for (i, joint) in self.tree.joints.iter().enumerate().rev() {
            let body = &data.bodies[i];
            effort[self.driven_by[i]] += data.slope[i] * joint.effort(&body.wrench);
            if let Some(p) = joint.parent {
                let carried = body.placement.wrench(&body.wrench);
                data.bodies[p].wrench = data.bodies[p].wrench.plus(&carried);
            }
        }
    }

    /// Mass matrix and gravity effort: inertias from the tips inwards, and then the momentum of every joint.
    fn sum_inertias(&self, data: &mut Data) {
        let n = self.actuators.len();
        data.mass_matrix.fill(0.0);
        data.gravity_effort.fill(0.0);
        for (body, inertia) in data.bodies.iter_mut().zip(&self.inertias) {
            body.composite = *inertia;
        }
        for (i, joint) in self.tree.joints.iter().enumerate().rev() {
            if let Some(p) = joint.parent {
                let body = &data.bodies[i];
                let carried = body.placement.inertia(&body.composite);
                data.bodies[p].composite = data.bodies[p].composite.plus(&carried);
            }
        }
        for (i, joint) in self.tree.joints.iter().enumerate() {
            let (k_i, slope_i) = (self.driven_by[i], data.slope[i]);
            // Momentum of all that joint i carries, per velocity of its actuator.
            let momentum = joint.momentum(&data.bodies[i].composite).scaled(slope_i);
            let momentum_W = data.X_WB[i].wrench(&momentum);
            data.gravity_effort[k_i] -= momentum_W.force.dot(&self.gravity);

            // Column i of H up to the ground, folded into M at once.
            data.mass_matrix[k_i * n + k_i] += slope_i * joint.effort(&momentum);
            let mut ancestor = joint.parent;
            while let Some(j) = ancestor {
                let k_j = self.driven_by[j];
                let value = data.columns[j].dot(&momentum_W);
                data.mass_matrix[k_i * n + k_j] += value;
                data.mass_matrix[k_j * n + k_i] += value;
                ancestor = self.tree.joints[j].parent;
            }
        }
        for (k, armature) in self.armature.iter().enumerate() {
            data.mass_matrix[k * n + k] += armature;
        }
    }

    /// Acceleration ÿ that `effort` causes, written to `acceleration` [rad/s² or m/s²]: M ÿ = effort + Jᵀw − bias
    /// − friction.
    ///
    /// `tip_wrench` acts on the tip from outside. `data` then holds all terms at this state.
    ///
    /// # Errors
    /// Those of [`update_kinematics`](Self::update_kinematics); [`DynamicsError::SingularMassMatrix`] only where
    /// numbers near overflow meet.
    pub fn forward_dynamics(
        &self,
        data: &mut Data,
        position: &[f64],
        velocity: &[f64],
        effort: &[f64],
        tip_wrench: Option<&Wrench>,
        acceleration: &mut [f64],
    ) -> Result<(), DynamicsError> {
        let n = self.actuators.len();
        check("effort", effort, n)?;
        check_length("acceleration", acceleration, n)?;
        check_wrench(tip_wrench)?;
        self.update_dynamics(data, position, velocity)?;
        for k in 0..n {
            acceleration[k] = effort[k] - data.bias[k] - self.friction[k].effort(velocity[k]);
        }
        if let Some(wrench) = tip_wrench {
            self.add_tip_effort(data, wrench, 1.0, acceleration);
        }
        cholesky::factorize(n, &data.mass_matrix, &mut data.factor).map_err(singular)?;
        cholesky::solve(n, &data.factor, acceleration);
        Ok(())
    }

    /// Effort that causes `acceleration`, written to `effort` [N·m or N]: M ÿ + bias + friction − Jᵀw.
    ///
    /// One Newton-Euler pass whose joint accelerations are Gÿ + ġ; M itself is not needed. Of the getters of `data`
    /// only those of tree joints are of this state then; poses, tip and matrices want an update of their own.
    ///
    /// # Errors
    /// Those of [`update_kinematics`](Self::update_kinematics).
    pub fn inverse_dynamics(
        &self,
        data: &mut Data,
        position: &[f64],
        velocity: &[f64],
        acceleration: &[f64],
        tip_wrench: Option<&Wrench>,
        effort: &mut [f64],
    ) -> Result<(), DynamicsError> {
        let n = self.actuators.len();
        check("acceleration", acceleration, n)?;
        check_length("effort", effort, n)?;
        check_wrench(tip_wrench)?;
        self.update_joints(data, position, velocity)?;
        self.move_bodies(data, Some(acceleration));
        self.sum_wrenches(data, effort);
        for k in 0..n {
            effort[k] += self.armature[k] * acceleration[k] + self.friction[k].effort(velocity[k]);
        }
        if let Some(wrench) = tip_wrench {
            self.pose_bodies(data);
            self.add_tip_effort(data, wrench, -1.0, effort);
        }
        Ok(())
    }

    /// Adds `factor`·Jᵀw to `effort`.
    fn add_tip_effort(&self, data: &Data, wrench: &Wrench, factor: f64, effort: &mut [f64]) {
        let force = Vector3::from(wrench.force);
        let moment = Vector3::from(wrench.moment) + self.tip_point(data).cross(&force);
        let F_W = Force { moment, force };
        for &i in &self.tip_path {
            effort[self.driven_by[i]] += factor * data.columns[i].dot(&F_W);
        }
    }

    /// Writes the effort that friction opposes to `velocity` to `effort` [N·m or N]: zero without a plant.
    ///
    /// # Errors
    /// [`DynamicsError::Length`] or [`DynamicsError::NotFinite`].
    pub fn friction_effort(&self, velocity: &[f64], effort: &mut [f64]) -> Result<(), DynamicsError> {
        check("velocity", velocity, self.actuators.len())?;
        check_length("effort", effort, self.actuators.len())?;
        for ((value, friction), rate) in effort.iter_mut().zip(&self.friction).zip(velocity) {
            *value = friction.effort(*rate);
        }
        Ok(())
    }

    /// Writes the diagonal of M⁻¹ to `diagonal` [1/(kg·m²) or 1/kg]: acceleration of each actuator per its own
    /// effort while the others are free. As of the last `update_dynamics` or `forward_dynamics`.
    ///
    /// # Errors
    /// [`DynamicsError::Length`] or [`DynamicsError::SingularMassMatrix`].
    pub fn inverse_effective_inertia(
        &self,
        data: &mut Data,
        diagonal: &mut [f64],
    ) -> Result<(), DynamicsError> {
        let n = self.actuators.len();
        check_length("diagonal", diagonal, n)?;
        cholesky::factorize(n, &data.mass_matrix, &mut data.factor).map_err(singular)?;
        for (k, value) in diagonal.iter_mut().enumerate() {
            // (M⁻¹)ₖₖ = |L⁻¹eₖ|²
            data.column.fill(0.0);
            data.column[k] = 1.0;
            cholesky::forward(n, &data.factor, &mut data.column);
            *value = data.column.iter().map(|x| x * x).sum();
        }
        Ok(())
    }

    /// Kinetic energy \[J\], armature included, as of the last update.
    pub fn kinetic_energy(&self, data: &Data) -> f64 {
        let bodies = self.inertias.iter().enumerate().map(|(i, inertia)| {
            let V_WB = self.twist(data, i);
            V_WB.dot(&inertia.in_world(&data.X_WB[i]).times(&V_WB))
        });
        let motors = self.armature.iter().zip(&data.velocity).map(|(armature, v)| armature * v * v);
        0.5 * (bodies.sum::<f64>() + motors.sum::<f64>())
    }

    /// Potential energy of all moving bodies and the payload \[J\], zero at the world origin, as of the last update.
    pub fn potential_energy(&self, data: &Data) -> f64 {
        let bodies = self.inertias.iter().zip(&data.X_WB);
        -bodies.map(|(inertia, X_WB)| self.gravity.dot(&inertia.in_world(X_WB).first_moment)).sum::<f64>()
    }
}

pub(crate) fn singular((pivot, value): (usize, f64)) -> DynamicsError {
    DynamicsError::SingularMassMatrix { pivot, value }
}

fn check_wrench(wrench: Option<&Wrench>) -> Result<(), DynamicsError> {
    let Some(wrench) = wrench else { return Ok(()) };
    check("tip_wrench.force", &wrench.force, 3)?;
    check("tip_wrench.moment", &wrench.moment, 3)
}
