//! Every tolerance of the integration tests, each with its reason.

/// Excess over a limit, relative to the width of its interval: the bar that the crate promises. Rounding stays well
/// below it (`docs/guarantee.md`, § Rounding).
pub(crate) const LIMIT: f64 = 1e-12;
