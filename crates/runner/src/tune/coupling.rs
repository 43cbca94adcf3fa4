//! All joints together: whether the velocity errors of the whole crane decay within a tick.

use adaptive_ctrl::coupled_damping_per_tick;
use anyhow::{Result, ensure};
use hiab_dynamics::CraneModel;

use crate::machine::corner_postures;

/// Joints of a crane that is tuned.
const JOINTS: usize = 7;

type Matrix = [[f64; JOINTS]; JOINTS];

/// The inverse mass matrices of a crane over all postures.
#[derive(Clone, Debug)]
pub struct Coupling {
    inverses: Vec<Matrix>,
    period: f64,
}

impl Coupling {
    /// For `model` under controllers that act every `period` \[s\].
    ///
    /// # Errors
    /// The crane has not seven joints.
    pub fn new(model: &CraneModel, period: f64) -> Result<Self> {
        ensure!(model.actuators().len() == JOINTS, "a crane of {JOINTS} joints");
        let mut data = model.new_data();
        let mut inverses = Vec::new();
        for posture in corner_postures(model) {
            let still = [0.0; JOINTS];
            let (mut inverse, mut bias, mut acceleration) = ([[0.0; JOINTS]; JOINTS], still, still);
            model.forward_dynamics(&mut data, &posture, &still, &still, None, &mut bias)?;
            for (joint, row) in inverse.iter_mut().enumerate() {
                let mut effort = still;
                effort[joint] = 1.0;
                model.forward_dynamics(&mut data, &posture, &still, &effort, None, &mut acceleration)?;
                *row = std::array::from_fn(|n| acceleration[n] - bias[n]);
            }
            inverses.push(inverse);
        }
        Ok(Self { inverses, period })
    }

    /// Largest [`coupled_damping_per_tick`] with these dampings, one for each joint in its own units.
    #[must_use]
    pub fn damping_per_tick(&self, damping: &[f64; JOINTS]) -> f64 {
        let per_tick = |inverse| coupled_damping_per_tick(inverse, damping, self.period);
        self.inverses.iter().map(per_tick).fold(0.0, |most, next| if next <= most { most } else { next })
    }
}
