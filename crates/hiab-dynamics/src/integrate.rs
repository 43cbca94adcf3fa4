//! Time steps of fixed period with the effort held.

use crate::data::Data;
use crate::dynamics::Wrench;
use crate::error::DynamicsError;
use crate::kinematics::check_length;
use crate::model::CraneModel;

impl CraneModel {
    /// One step of semi-implicit Euler: the acceleration moves the velocity, the new velocity the position.
    ///
    /// First order; energy stays bounded. `position` and `velocity` are replaced by the state one `period` \[s\]
    /// later, `effort` and `tip_wrench` held. Afterwards `data` describes the state *before* the step.
    ///
    /// # Errors
    /// Those of [`forward_dynamics`](Self::forward_dynamics), [`DynamicsError::Period`], and
    /// [`DynamicsError::Diverged`]. The state is unchanged then.
    pub fn semi_implicit_euler(
        &self,
        data: &mut Data,
        position: &mut [f64],
        velocity: &mut [f64],
        effort: &[f64],
        tip_wrench: Option<&Wrench>,
        period: f64,
    ) -> Result<(), DynamicsError> {
        check_period(period)?;
        let mut stages = std::mem::take(&mut data.stages);
        let derivative =
            self.forward_dynamics(data, position, velocity, effort, tip_wrench, &mut stages.acceleration);
        let result = derivative.and_then(|()| {
            for k in 0..velocity.len() {
                stages.velocity[k] = velocity[k] + period * stages.acceleration[k];
                stages.position[k] = position[k] + period * stages.velocity[k];
            }
            accept(&stages.position, &stages.velocity, position, velocity)
        });
        data.stages = stages;
        result
    }

    /// One step of the classical fourth-order Runge-Kutta method.
    ///
    /// Arguments, errors and the state of `data` as for [`semi_implicit_euler`](Self::semi_implicit_euler), but
    /// `data` describes the last of the four stages afterwards.
    ///
    /// # Errors
    /// As there; also if one of the stages leaves a loop's solvable range.
    pub fn rk4(
        &self,
        data: &mut Data,
        position: &mut [f64],
        velocity: &mut [f64],
        effort: &[f64],
        tip_wrench: Option<&Wrench>,
        period: f64,
    ) -> Result<(), DynamicsError> {
        check_period(period)?;
        let n = self.actuators.len();
        check_length("position", position, n)?;
        check_length("velocity", velocity, n)?;
        let mut stages = std::mem::take(&mut data.stages);
        let result = (|| {
            stages.position.copy_from_slice(position);
            stages.velocity.copy_from_slice(velocity);
            stages.position_sum.fill(0.0);
            stages.velocity_sum.fill(0.0);
            // (share of the period up to the next stage, weight of this one)
            for (ahead, weight) in [(0.5, 1.0), (0.5, 2.0), (1.0, 2.0), (0.0, 1.0)] {
                self.forward_dynamics(
                    data,
                    &stages.position,
                    &stages.velocity,
                    effort,
                    tip_wrench,
                    &mut stages.acceleration,
                )?;
                for k in 0..n {
                    let (rate, acceleration) = (stages.velocity[k], stages.acceleration[k]);
                    stages.position_sum[k] += weight * rate;
                    stages.velocity_sum[k] += weight * acceleration;
                    stages.position[k] = position[k] + ahead * period * rate;
                    stages.velocity[k] = velocity[k] + ahead * period * acceleration;
                }
            }
            for k in 0..n {
                stages.position[k] = position[k] + period / 6.0 * stages.position_sum[k];
                stages.velocity[k] = velocity[k] + period / 6.0 * stages.velocity_sum[k];
            }
            accept(&stages.position, &stages.velocity, position, velocity)
        })();
        data.stages = stages;
        result
    }
}

fn check_period(period: f64) -> Result<(), DynamicsError> {
    if period.is_finite() && period > 0.0 {
        return Ok(());
    }
    Err(DynamicsError::Period { value: period })
}

/// Copies the new state out if it is finite.
fn accept(
    new_position: &[f64],
    new_velocity: &[f64],
    position: &mut [f64],
    velocity: &mut [f64],
) -> Result<(), DynamicsError> {
    for (what, values) in [("position", new_position), ("velocity", new_velocity)] {
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            return Err(DynamicsError::Diverged { what, index, value: values[index] });
        }
    }
    position.copy_from_slice(new_position);
    velocity.copy_from_slice(new_velocity);
    Ok(())
}
