//! What the integration tests share.
#![allow(
    dead_code,
    unreachable_pub,
    clippy::unwrap_used,
    reason = "each test binary uses its own part; helpers of tests are tests too"
)]

pub mod random;
pub mod state;
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

/// The URDF of the excavator.
pub const EXCAVATOR_URDF: &str = include_str!("../../../../assets/excavator/excavator.urdf");
/// Its loop file.
pub const EXCAVATOR_LOOPS: &str = include_str!("../../../../assets/excavator/excavator.ron");
/// Its plants.
pub const EXCAVATOR_PLANTS: &str = include_str!("../../../../assets/excavator/plants.ron");

/// The bare excavator.
pub fn excavator() -> CraneModel {
    CraneModel::from_urdf(EXCAVATOR_URDF, EXCAVATOR_LOOPS).unwrap()
}

/// The machines that are shipped, as text.
pub fn shipped() -> [random::Machine; 2] {
    [(URDF, LOOPS), (EXCAVATOR_URDF, EXCAVATOR_LOOPS)].map(|(urdf, loops)| random::Machine {
        urdf: urdf.into(),
        loops: loops.into(),
        root: "base_link",
    })
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

/// `text` with its only `from` replaced by `to`.
#[track_caller]
pub fn edited(text: &str, from: &str, to: &str) -> String {
    assert_eq!(text.matches(from).count(), 1, "`{from}` must occur once, or the case tests nothing");
    text.replacen(from, to, 1)
}

#[track_caller]
pub fn check_line(case: &str, message: &str, expected: &str) {
    assert_eq!(message.lines().count(), 1, "{case}: more than one line: {message}");
    assert!(message.contains(expected), "{case}: `{message}` does not say `{expected}`");
}

/// Edits the URDF and checks what building the crane says.
#[track_caller]
pub fn check_urdf(from: &str, to: &str, expected: &str) {
    let message = CraneModel::from_urdf(&edited(URDF, from, to), LOOPS).unwrap_err().to_string();
    check_line(to, &message, expected);
}

/// Edits the loop file and checks what building the crane says.
#[track_caller]
pub fn check_loops(from: &str, to: &str, expected: &str) {
    let message = CraneModel::from_urdf(URDF, &edited(LOOPS, from, to)).unwrap_err().to_string();
    check_line(to, &message, expected);
}
