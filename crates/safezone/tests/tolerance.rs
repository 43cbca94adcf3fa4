//! Every tolerance of the integration tests, each with its reason.

/// Excess over a limit, relative to the width of its interval: the bar that the crate promises. Rounding stays well
/// below it (`docs/guarantee.md`, § Rounding).
pub(crate) const LIMIT: f64 = 1e-12;

/// A closed form evaluated here and by the crate, relative to the quantity's largest value: a few dozen roundings, and
/// the 1e-14 that the planner keeps from its limits.
pub(crate) const EXACT: f64 = 1e-12;

/// A number that the design prints with four digits: half a unit of the last, and the 0.05 % that the sine's quintic costs.
pub(crate) const PRINTED: f64 = 1.5e-3;

/// What samples may give away of each end of a range, as a share of what one period can change. Where the ramps of a step are of
/// very unequal length the travel until rest hardly grows with the velocity, so that little travel is much velocity: 0.047 in
/// 12 000 random planners, 20 states of each.
pub(crate) const SAMPLES: f64 = 0.1;

/// The same where both ramps are as long: 0.0092 from every velocity. A step up by a sixteenth of a braking step counts as if it
/// had no lag, a 128th of the largest step's way.
pub(crate) const SAMPLES_OF_EQUAL_RAMPS: f64 = 0.01;

/// The same where one direction is 3.3 times as strong as the other: 0.0123 from every velocity.
pub(crate) const SAMPLES_SOME_KNOTS_APART: f64 = 0.015;
