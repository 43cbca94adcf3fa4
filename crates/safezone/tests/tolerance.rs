//! Every tolerance of the integration tests, each with its reason.

/// Excess over a limit, relative to the width of its interval: the bar that the crate promises. Rounding stays well
/// below it (`docs/guarantee.md`, § Rounding).
pub(crate) const LIMIT: f64 = 1e-12;

/// A closed form evaluated here and by the crate, relative to the quantity's largest value: a few dozen roundings, and
/// the 1e-14 that the planner keeps from its limits.
pub(crate) const EXACT: f64 = 1e-12;

/// A number that the design prints with four digits: half a unit of the last, and the 0.05 % that the sine's quintic costs.
pub(crate) const PRINTED: f64 = 1.5e-3;
