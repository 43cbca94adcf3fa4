//! Builds braking tables. Offline: allocates.

use jbtg::{Interval, Planner};

use crate::side::{Braking, Side};
use crate::table::{BrakingTable, Knot, TableError, subdivisions};

/// Most knots per direction. A joint that needs more uses
/// [`SafeZone::closed_form`](crate::SafeZone::closed_form).
pub const MAX_KNOTS: usize = 1 << 16;

impl BrakingTable<'static> {
    /// The braking table of `planner`'s joint.
    ///
    /// One knot per braking step with [`Timing::Stretched`](jbtg::Timing), where the distance is linear in between; sixteen with
    /// [`Timing::Fastest`](jbtg::Timing), where it is convex but for one kink in every step, by which all knots are lifted. So
    /// interpolation errs on the safe side, and by the same amount in every step, so that the braking policy keeps
    /// the interpolated distance as well. Knots reach to the velocity limit or to the first speed that the whole
    /// position interval cannot stop.
    ///
    /// # Errors
    /// [`BuildError::TooManyKnots`] if a direction needs more than [`MAX_KNOTS`], [`BuildError::Table`] if the numbers are
    /// so far apart that knots coincide.
    pub fn build(planner: &Planner) -> Result<Self, BuildError> {
        let subdivisions = subdivisions(planner.spec().timing);
        let Interval { min, max } = planner.velocity();
        let upper = knots(planner, Side::Upper, max, subdivisions)?;
        let lower = knots(planner, Side::Lower, -min, subdivisions)?;
        Ok(Self::owned(*planner.spec(), subdivisions, upper, lower)?)
    }
}

/// Knots from rest to `highest`, or to what braking within the interval needs.
fn knots(planner: &Planner, side: Side, highest: f64, subdivisions: u32) -> Result<Vec<Knot>, BuildError> {
    let braking = Braking::new(planner, side);
    let spacing = braking.step / f64::from(subdivisions);
    let lift = braking.kink_depth(spacing);
    let mut knots = vec![Knot { distance: 0.0, velocity: 0.0 }];
    loop {
        let Knot { distance, velocity } = knots[knots.len() - 1];
        if velocity >= highest || distance > braking.width {
            return Ok(knots);
        }
        if knots.len() == MAX_KNOTS {
            return Err(BuildError::TooManyKnots { side, limit: MAX_KNOTS });
        }
        let velocity = knots.len() as f64 * spacing;
        knots.push(Knot { distance: braking.distance(velocity) + lift, velocity });
    }
}

/// Why a table could not be built.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum BuildError {
    /// Braking within the position interval takes too many periods for a table.
    #[error("braking towards the {side:?} limit takes more than {limit} knots")]
    TooManyKnots {
        /// The limit concerned.
        side: Side,
        /// The most knots that a table holds per direction.
        limit: usize,
    },
    /// The numbers are so far apart that rounding puts knots out of order.
    #[error(transparent)]
    Table(#[from] TableError),
}
