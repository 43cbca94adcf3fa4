//! The Coriolis matrix, of which the bias has only the product with the velocity.
#![expect(non_snake_case, reason = "monogram frames")]

use crate::data::Data;
use crate::error::DynamicsError;
use crate::kinematics::check_length;
use crate::model::CraneModel;

impl CraneModel {
    /// Writes the Coriolis matrix C(y, ẏ) to `matrix` [N·m·s/rad, N·s/m and mixed]: n × n, row by row, as of the last
    /// `update_dynamics` or `forward_dynamics`.
    ///
    /// Of all matrices with C·ẏ = bias − gravity effort it is the one of the Christoffel symbols, so Ṁ = C + Cᵀ and
    /// C(y, u)·w = C(y, w)·u. Costs about n times what the bias does; not for control loops.
    ///
    /// Source: S. Echeandia, P. Wensing, *ASME J. Computational and Nonlinear Dynamics* 16 (2021) 091004: a body
    /// contributes Jᵀ(I·J̇ + B·J) with B·s = ½(v×*(I s) + s×*(I v) − I(v × s)). Here the columns of J are those of
    /// the joints times the slopes of G, and J̇ has their curvatures.
    ///
    /// # Errors
    /// [`DynamicsError::Length`] unless `matrix` has n² values.
    pub fn coriolis_matrix(&self, data: &Data, matrix: &mut [f64]) -> Result<(), DynamicsError> {
        let n = self.actuators.len();
        check_length("matrix", matrix, n * n)?;
        matrix.fill(0.0);
        for (body, inertia) in self.inertias.iter().enumerate() {
            let I_W = inertia.in_world(&data.X_WB[body]);
            let V_WB = &self.twist(data, body);
            let momentum = I_W.times(V_WB);
            for j in self.ancestors(body) {
                let s = &data.columns[j];
                let k_j = self.driven_by[j];
                // The column of J̇: the axis is carried along by its body, and the slope changes.
                let slope_rate = data.curvature[j] * data.velocity[k_j];
                let bare = self.tree.joints[j].subspace(&data.X_WB[j]);
                let s_dot = self.twist(data, j).cross_motion(s).plus(&bare.scaled(slope_rate));
                let force = I_W
                    .times(&s_dot)
                    .plus(&V_WB.cross_force(&I_W.times(s)).scaled(0.5))
                    .plus(&s.cross_force(&momentum).scaled(0.5))
                    .plus(&I_W.times(&V_WB.cross_motion(s)).scaled(-0.5));
                for i in self.ancestors(body) {
                    matrix[self.driven_by[i] * n + k_j] += data.columns[i].dot(&force);
                }
            }
        }
        Ok(())
    }

    /// `body` and all that carry it, down to the ground.
    pub(crate) fn ancestors(&self, body: usize) -> impl Iterator<Item = usize> {
        std::iter::successors(Some(body), |body| self.tree.joints[*body].parent)
    }
}
