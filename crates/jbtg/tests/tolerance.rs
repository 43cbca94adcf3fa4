//! Every tolerance of the integration tests, each with its reason.

/// Excess over a limit, relative to the width of its interval: the bar that the crate promises. The planner keeps 1e-14
/// away from acceleration and jerk limits, and a velocity rounds by some 1e-16 of its own magnitude.
pub(crate) const LIMIT: f64 = 1e-12;

/// Gap between the end of one quintic and the start of the next, in units of 2⁻⁵² times the largest magnitude that a
/// polynomial's term reaches in the step: some ten roundings on either side.
pub(crate) const JOINT_ULPS: f64 = 32.0;

/// Coefficients from an LU decomposition of [P, Eq. (eqmat)] in u = t/dt, relative to the largest of them: its condition
/// number is about 1e3.
pub(crate) const EQMAT: f64 = 1e-12;

/// A closed form of the paper evaluated here and by the planner: a dozen roundings each, and the 1e-14 that the planner
/// keeps from limits, squared where time enters squared.
pub(crate) const CLOSED_FORM: f64 = 1e-13;

/// A number that DESIGN or the paper prints with three significant digits: half a unit of the last.
pub(crate) const THREE_DIGITS: f64 = 5e-3;

/// Distance of a velocity vector from the straight line that it should move on, in units of 2⁻⁵² times its joints' speeds
/// and velocity changes: a dozen roundings of each velocity.
pub(crate) const LINE_ULPS: f64 = 16.0;

/// Jerk left where a ramp is within rounding of its end, relative to the jerk limits' width: 1 − (3u² − 2u³) = 2⁻⁵² at
/// 1 − u = 1e-8, where the jerk is 4e-8 of its largest.
pub(crate) const JERK_LEFT: f64 = 1e-7;

/// The largest displacement of a detour, of period·(largest speed): what a direct search with steps down to 1e-7 finds.
pub(crate) const OPTIMUM: f64 = 1e-9;
