//! What the integration tests share.
#![allow(
    dead_code,
    unreachable_pub,
    clippy::unwrap_used,
    reason = "each test binary uses its own part; helpers of tests are tests too"
)]

pub mod tolerance;

use hiab_dynamics::CraneModel;

/// The URDF of the crane.
pub const URDF: &str = include_str!("../../../../assets/hiab/hiab.urdf");
/// Its loop file.
pub const LOOPS: &str = include_str!("../../../../assets/hiab/hiab.ron");
/// Its plants.
pub const PLANTS: &str = include_str!("../../../../assets/hiab/plants.ron");

/// The bare crane.
pub fn crane() -> CraneModel {
    CraneModel::from_urdf(URDF, LOOPS).unwrap()
}

/// A state inside the actuators' ranges, from numbers in [0, 1] per actuator.
pub fn position_at(model: &CraneModel, share: &[f64]) -> Vec<f64> {
    model.actuators().iter().zip(share).map(|(a, s)| a.lower() + s * (a.upper() - a.lower())).collect()
}

/// Velocities from numbers in [-1, 1] per actuator.
pub fn velocity_at(model: &CraneModel, share: &[f64]) -> Vec<f64> {
    model.actuators().iter().zip(share).map(|(a, s)| s * a.velocity_limit()).collect()
}

/// Largest absolute value.
pub fn max_abs(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |max, value| max.max(value.abs()))
}

/// Distance of two points.
pub fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}
