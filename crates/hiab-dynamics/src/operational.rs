//! Dynamics as felt at the tip.

use nalgebra::{Matrix3, Vector3};

use crate::cholesky;
use crate::data::Data;
use crate::dynamics::singular;
use crate::error::DynamicsError;
use crate::kinematics::check;
use crate::model::CraneModel;

/// Least mobility of the tip along its stiffest direction, relative to the easiest, for the tip to have an inertia.
///
/// Below it the inertia has lost half of its sixteen digits, and what it says, a mass a hundred million times that
/// along the easiest direction, is a wall.
const MIN_MOBILITY_RATIO: f64 = 1e-8;

impl CraneModel {
    /// The tip's mobility J M⁻¹ Jᵀ \[1/kg\], world axes: acceleration of the tip per force on it, all joints free.
    ///
    /// Of the linear part of J; symmetric, and singular where some direction is closed to the tip. As of the last
    /// `update_dynamics` or `forward_dynamics`; armature counts, friction does not.
    ///
    /// # Errors
    /// [`DynamicsError::SingularMassMatrix`] as for [`forward_dynamics`](Self::forward_dynamics).
    pub fn tip_mobility(&self, data: &mut Data) -> Result<[[f64; 3]; 3], DynamicsError> {
        let mobility = self.mobility(data)?;
        Ok(std::array::from_fn(|i| std::array::from_fn(|j| mobility[(i, j)])))
    }

    /// Apparent mass matrix of the tip Λ = (J M⁻¹ Jᵀ)⁻¹ \[kg\], world axes: force per acceleration of the tip that
    /// goes just where it is asked to.
    ///
    /// Source: O. Khatib, *IEEE J. Robotics and Automation* 3 (1987) 43, for the linear part of J. Valid as
    /// [`tip_mobility`](Self::tip_mobility) is.
    ///
    /// # Errors
    /// [`DynamicsError::TipNearSingular`] where some direction is closed to the tip; those of
    /// [`tip_mobility`](Self::tip_mobility).
    pub fn tip_inertia(&self, data: &mut Data) -> Result<[[f64; 3]; 3], DynamicsError> {
        let eigen = self.mobility(data)?.symmetric_eigen();
        let (stiffest, least) = eigen.eigenvalues.argmin();
        let ratio = least / eigen.eigenvalues.max();
        if !(ratio >= MIN_MOBILITY_RATIO) {
            let direction = eigen.eigenvectors.column(stiffest).into_owned();
            return Err(DynamicsError::TipNearSingular { direction: direction.into(), ratio });
        }
        let inverse = Matrix3::from_diagonal(&eigen.eigenvalues.map(|value| 1.0 / value));
        let inertia = eigen.eigenvectors * inverse * eigen.eigenvectors.transpose();
        Ok(std::array::from_fn(|i| std::array::from_fn(|j| inertia[(i, j)])))
    }

    /// Mass \[kg\] that a push on the tip along `direction` (world axes, any length) feels: force by acceleration along
    /// it, with the tip free to leave the line. Infinite where the direction is closed to the tip.
    ///
    /// Never greater than the entry of Λ along `direction`, which is that of a tip kept on the line. Valid as
    /// [`tip_mobility`](Self::tip_mobility) is.
    ///
    /// # Errors
    /// [`DynamicsError::NotFinite`], [`DynamicsError::ZeroDirection`]; those of [`tip_mobility`](Self::tip_mobility).
    pub fn apparent_mass(&self, data: &mut Data, direction: [f64; 3]) -> Result<f64, DynamicsError> {
        check("direction", &direction, 3)?;
        let Some(unit) = Vector3::from(direction).try_normalize(0.0) else {
            return Err(DynamicsError::ZeroDirection);
        };
        let mobility = self.mobility(data)?;
        Ok(1.0 / unit.dot(&(mobility * unit)))
    }

    /// (L⁻¹ Jᵀ)ᵀ(L⁻¹ Jᵀ) with M = L Lᵀ.
    fn mobility(&self, data: &mut Data) -> Result<Matrix3<f64>, DynamicsError> {
        let n = self.actuators.len();
        cholesky::factorize(n, &data.mass_matrix, &mut data.factor).map_err(singular)?;
        let p_wt = self.tip_point(data);
        let mut mobility = Matrix3::zeros();
        let mut columns = std::mem::take(&mut data.tip_columns);
        for (row, column) in columns.iter_mut().enumerate() {
            column.fill(0.0);
            for &i in &self.tip_path {
                column[self.driven_by[i]] += data.columns[i].linear_at(&p_wt)[row];
            }
            cholesky::forward(n, &data.factor, column);
        }
        for i in 0..3 {
            for j in 0..3 {
                mobility[(i, j)] = columns[i].iter().zip(&columns[j]).map(|(a, b)| a * b).sum();
            }
        }
        data.tip_columns = columns;
        Ok(mobility)
    }
}
