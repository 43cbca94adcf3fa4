//! Every tolerance of the integration tests, each with its reason.

/// Positions, rotations, velocities and Jacobians against the reference, absolute. What the reference's README says
/// that an exact implementation meets; both sides round to about 1e-14.
pub const KINEMATICS: f64 = 1e-9;

/// Mass matrix, bias and gravity against the reference, relative to the largest entry. Same source.
pub const TERMS: f64 = 1e-9;

/// Accelerations against the reference, relative to the largest entry: TERMS times a mass matrix of condition up to
/// 1e5, less what the published 1e-7 leaves. Same source.
pub const ACCELERATION: f64 = 1e-7;

/// The reference trajectory after 1 s, absolute. Same source: fourth order.
pub const TRAJECTORY: f64 = 1e-6;

/// Forward after inverse dynamics, relative: condition 1e5 times rounding 1e-15, with a hundredfold reserve.
pub const ROUND_TRIP: f64 = 1e-8;

/// Identities that differ in the order of sums alone, relative.
pub const ROUNDING: f64 = 1e-11;

/// Step of central differences, in units of the coordinate.
pub const DIFFERENCE_STEP: f64 = 1e-5;

/// Central differences, relative to the largest value: truncation of those of second order 1e-10/6 times third
/// derivatives of up to 5e3, of those of fourth order 1e-20/480 times fifth ones, rounding 1e-15 / 1e-5.
pub const DIFFERENCE: f64 = 1e-7;

/// Energy after 800 steps of the fourth-order method, relative to the kinetic energy at the start: (0.5 ms)⁴ times
/// fifth derivatives of up to 1e3, far below; rounding of potential energy 1e4 times larger, 1e-12.
pub const ENERGY: f64 = 1e-9;

/// Dissipated energy by the trapezoidal rule at 50 µs, relative: (period / 0.35 ms)² / 12 = 2e-3 of what is lost in
/// the last moments before the lightest cylinder, 142 kg on 4000 N within 0.01 m/s, is at rest; less than a
/// twentieth of the whole.
pub const TRAPEZOID: f64 = 1e-4;

/// Forward after inverse dynamics on any machine, relative to the largest acceleration: the bar of this crate.
pub const IDENTITY: f64 = 1e-9;

/// Power of the efforts against the change of energy by central differences, relative to the largest of the powers.
pub const POWER: f64 = 1e-6;

/// Energy after 10 s of free motion with the fourth-order method at 2 kHz, relative to the greatest kinetic energy:
/// the bar of this crate.
pub const LONG_ENERGY: f64 = 1e-6;
