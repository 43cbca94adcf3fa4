//! The effort that a model of the crane expects along the reference.

use anyhow::{Context, Result};
use hiab_dynamics::{CraneModel, Data};

use crate::interpolation::Interpolation;

/// Inverse dynamics along the reference, or nothing where the controllers know no model.
#[derive(Debug)]
pub(crate) struct Feedforward {
    data: Option<Data>,
    position: Vec<f64>,
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
    effort: Vec<f64>,
}

impl Feedforward {
    /// For a crane of `joints` joints whose controllers know `model`.
    pub(crate) fn new(model: Option<&CraneModel>, joints: usize) -> Self {
        Self {
            data: model.map(CraneModel::new_data),
            position: vec![0.0; joints],
            velocity: vec![0.0; joints],
            acceleration: vec![0.0; joints],
            effort: vec![0.0; joints],
        }
    }

    /// Effort of every joint [N·m or N]; zero without a model.
    pub(crate) fn effort(&self) -> &[f64] {
        &self.effort
    }

    /// Computes the effort for every joint's reference, `ahead` of its sample and held for `period` from then \[s\].
    ///
    /// The acceleration is that of the middle of the period: held, it gives the velocity at the period's end.
    ///
    /// # Errors
    /// A loop does not close at the reference.
    pub(crate) fn update(
        &mut self,
        model: Option<&CraneModel>,
        reference: &[Interpolation],
        ahead: f64,
        period: f64,
    ) -> Result<()> {
        let (Some(model), Some(data)) = (model, &mut self.data) else { return Ok(()) };
        for (joint, reference) in reference.iter().enumerate() {
            let now = reference.state_at(ahead);
            self.position[joint] = now.position;
            self.velocity[joint] = now.velocity;
            self.acceleration[joint] = reference.state_at(ahead + 0.5 * period).acceleration;
        }
        model
            .inverse_dynamics(
                data,
                &self.position,
                &self.velocity,
                &self.acceleration,
                None,
                &mut self.effort,
            )
            .context("the reference cannot be followed")
    }
}
