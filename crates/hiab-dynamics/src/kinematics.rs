//! Positions, velocities and bias accelerations of all bodies, and the tip.
#![expect(non_snake_case, reason = "monogram frames")]

use nalgebra::{Matrix3, Vector3};
use serde::Serialize;

use crate::data::Data;
use crate::error::DynamicsError;
use crate::joint::JointKind;
use crate::model::CraneModel;
use crate::spatial::{Motion, Transform, ZERO3};
use crate::turn::Placement;

/// Pose of a frame in the world.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Pose {
    /// Origin \[m\].
    pub position: [f64; 3],
    /// Rotation matrix, row by row; its columns are the frame's axes.
    pub rotation: [[f64; 3]; 3],
}

/// Linear and angular part of a velocity or an acceleration at a point, world axes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Twist {
    /// Linear part [m/s or m/s²].
    pub linear: [f64; 3],
    /// Angular part [rad/s or rad/s²].
    pub angular: [f64; 3],
}

impl CraneModel {
    /// Brings joints, bodies and tip in `data` to `position` and `velocity` of the actuators.
    ///
    /// # Errors
    /// [`DynamicsError::Length`], [`DynamicsError::NotFinite`], or [`DynamicsError::StrokeOutsideLoop`]. Positions
    /// outside the actuators' own limits are legal as long as every loop closes.
    pub fn update_kinematics(
        &self,
        data: &mut Data,
        position: &[f64],
        velocity: &[f64],
    ) -> Result<(), DynamicsError> {
        self.update_joints(data, position, velocity)?;
        self.move_bodies(data, None);
        self.pose_bodies(data);
        Ok(())
    }

    /// q = γ(y), q̇ = Gẏ, ġ = γ″ẏ².
    pub(crate) fn update_joints(
        &self,
        data: &mut Data,
        position: &[f64],
        velocity: &[f64],
    ) -> Result<(), DynamicsError> {
        let n = self.actuators.len();
        check("position", position, n)?;
        check("velocity", velocity, n)?;
        data.velocity.copy_from_slice(velocity);
        for actuator in &self.actuators {
            data.slope[actuator.tree_joint] = 1.0;
            data.curvature[actuator.tree_joint] = 0.0;
        }
        for (joint, k) in self.driven_by.iter().enumerate() {
            data.tree_position[joint] = position[*k];
        }
        for closed_loop in &self.loops {
            let triangle = &closed_loop.triangle;
            let stroke = position[closed_loop.actuator];
            if !triangle.is_solvable(stroke) {
                return Err(DynamicsError::StrokeOutsideLoop {
                    closed_loop: closed_loop.name.clone(),
                    stroke,
                    lower: triangle.min_stroke,
                    upper: triangle.max_stroke,
                });
            }
            let (main, barrel) = triangle.solve(stroke);
            for (joint, value) in [(closed_loop.main, main), (closed_loop.barrel, barrel)] {
                data.tree_position[joint] = value.position;
                data.slope[joint] = value.slope;
                data.curvature[joint] = value.curvature;
            }
        }
        for (joint, k) in self.driven_by.iter().enumerate() {
            let rate = velocity[*k];
            data.tree_velocity[joint] = data.slope[joint] * rate;
            data.tree_drift[joint] = data.curvature[joint] * rate * rate;
        }
        for ((joint, body), q) in self.tree.joints.iter().zip(&mut data.bodies).zip(&data.tree_position) {
            joint.place(*q, &mut body.placement);
        }
        Ok(())
    }

    /// Velocities and accelerations of all bodies in one pass from the ground outwards, at accelerations ġ of the tree
    /// joints, or Gÿ + ġ. In it w is ω and dw its derivative.
    pub(crate) fn move_bodies(&self, data: &mut Data, acceleration: Option<&[f64]>) {
        for (i, joint) in self.tree.joints.iter().enumerate() {
            let Placement { turn, translation: p } = &data.bodies[i].placement;
            let (w_P, dw_P, a_P) = match joint.parent {
                Some(parent) => {
                    let carrier = &data.bodies[parent];
                    (carrier.angular_velocity, carrier.angular_acceleration, carrier.acceleration)
                }
                // Gravity as an acceleration of the ground.
                None => (ZERO3, ZERO3, -self.gravity),
            };
            let a_J = a_P + dw_P.cross(p) + w_P.cross(&w_P.cross(p));
            let (w, dw, a) = (turn.inward(&w_P), turn.inward(&dw_P), turn.inward(&a_J));
            let rate = joint.axis * data.tree_velocity[i];
            let driven = acceleration.map_or(0.0, |values| data.slope[i] * values[self.driven_by[i]]);
            let second = joint.axis * (data.tree_drift[i] + driven);
            let body = &mut data.bodies[i];
            match joint.kind {
                JointKind::Revolute => {
                    body.angular_velocity = w + rate;
                    body.angular_acceleration = dw + second + w.cross(&rate);
                    body.acceleration = a;
                }
                JointKind::Prismatic => {
                    body.angular_velocity = w;
                    body.angular_acceleration = dw;
                    body.acceleration = a + second + w.cross(&rate) * 2.0;
                }
            }
        }
    }

    /// Poses of all bodies in the world, of their places in their parents, and what each joint does there.
    pub(crate) fn pose_bodies(&self, data: &mut Data) {
        for (i, joint) in self.tree.joints.iter().enumerate() {
            let Placement { turn, translation } = &data.bodies[i].placement;
            let X_WP = joint.parent.map_or(Transform::identity(), |p| data.X_WB[p]);
            let X_WB =
                Transform { rotation: turn.within(&X_WP.rotation), translation: X_WP.point(translation) };
            data.X_WB[i] = X_WB;
        }
        // Not in the loop above: nothing here waits for a parent, so the processor overlaps the bodies.
        for ((column, joint), (X_WB, slope)) in
            data.columns.iter_mut().zip(&self.tree.joints).zip(data.X_WB.iter().zip(&data.slope))
        {
            *column = joint.subspace(X_WB).scaled(*slope);
        }
    }

    /// Twist of a body in the world, as of the last update.
    pub(crate) fn twist(&self, data: &Data, body: usize) -> Motion {
        self.ancestors(body).fold(Motion::ZERO, |sum, joint| {
            sum.plus(&data.columns[joint].scaled(data.velocity[self.driven_by[joint]]))
        })
    }

    /// Pose of the tip, as of the last update.
    pub fn tip_pose(&self, data: &Data) -> Pose {
        pose_from(&(data.X_WB[self.tip_body] * self.X_BT))
    }

    /// Pose of link `link`, an index of [`link_names`](Self::link_names), as of the last update.
    ///
    /// # Panics
    /// If there is no such link.
    pub fn link_pose(&self, data: &Data, link: usize) -> Pose {
        let link = &self.tree.links[link];
        match link.body {
            Some(body) => pose_from(&(data.X_WB[body] * link.X_BL)),
            None => pose_from(&link.X_BL),
        }
    }

    /// Velocity of the tip, as of the last update.
    pub fn tip_velocity(&self, data: &Data) -> Twist {
        let V_WB = self.twist(data, self.tip_body);
        Twist { linear: V_WB.linear_at(&self.tip_point(data)).into(), angular: V_WB.angular.into() }
    }

    /// J̇ẏ: acceleration of the tip at ÿ = 0, as of the last update.
    pub fn tip_drift(&self, data: &Data) -> Twist {
        let (tip, p) = (&data.bodies[self.tip_body], &self.X_BT.translation);
        let (w, dw) = (&tip.angular_velocity, &tip.angular_acceleration);
        let R_WB = &data.X_WB[self.tip_body].rotation;
        let linear = R_WB * (tip.acceleration + dw.cross(p) + w.cross(&w.cross(p))) + self.gravity;
        Twist { linear: linear.into(), angular: (R_WB * dw).into() }
    }

    /// Writes the tip's Jacobian to `jacobian`: 6 × n, row by row, the three linear rows first, at the tip and in
    /// world axes, as of the last update.
    ///
    /// # Errors
    /// [`DynamicsError::Length`] unless `jacobian` has 6n values.
    pub fn tip_jacobian(&self, data: &Data, jacobian: &mut [f64]) -> Result<(), DynamicsError> {
        let n = self.actuators.len();
        check_length("jacobian", jacobian, 6 * n)?;
        jacobian.fill(0.0);
        let p_WT = self.tip_point(data);
        for &i in &self.tip_path {
            let (column, k) = (&data.columns[i], self.driven_by[i]);
            let linear = column.linear_at(&p_WT);
            for row in 0..3 {
                jacobian[row * n + k] += linear[row];
                jacobian[(row + 3) * n + k] += column.angular[row];
            }
        }
        Ok(())
    }

    /// Writes the tree accelerations q̈ = Gÿ + ġ to `tree_acceleration`, as of the last update.
    ///
    /// # Errors
    /// [`DynamicsError::Length`].
    pub fn tree_acceleration(
        &self,
        data: &Data,
        acceleration: &[f64],
        tree_acceleration: &mut [f64],
    ) -> Result<(), DynamicsError> {
        check_length("acceleration", acceleration, self.actuators.len())?;
        check_length("tree_acceleration", tree_acceleration, self.tree.joints.len())?;
        for (joint, value) in tree_acceleration.iter_mut().enumerate() {
            *value = data.slope[joint] * acceleration[self.driven_by[joint]] + data.tree_drift[joint];
        }
        Ok(())
    }

    pub(crate) fn tip_point(&self, data: &Data) -> Vector3<f64> {
        data.X_WB[self.tip_body].point(&self.X_BT.translation)
    }
}

fn pose_from(X_WF: &Transform) -> Pose {
    Pose { position: X_WF.translation.into(), rotation: rows(&X_WF.rotation) }
}

fn rows(m: &Matrix3<f64>) -> [[f64; 3]; 3] {
    m.transpose().into()
}

/// Refuses slices of the wrong length, NaN and infinity.
#[inline]
pub(crate) fn check(what: &'static str, values: &[f64], expected: usize) -> Result<(), DynamicsError> {
    check_length(what, values, expected)?;
    match values.iter().position(|value| !value.is_finite()) {
        Some(index) => Err(DynamicsError::NotFinite { what, index, value: values[index] }),
        None => Ok(()),
    }
}

#[inline]
pub(crate) fn check_length(what: &'static str, values: &[f64], expected: usize) -> Result<(), DynamicsError> {
    if values.len() == expected {
        return Ok(());
    }
    Err(DynamicsError::Length { what, expected, found: values.len() })
}
