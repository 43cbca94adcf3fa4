//! Braking tables: pairs of braking distance and velocity, built offline.

use jbtg::PlannerSpec;
#[cfg(feature = "build")]
use std::borrow::Cow;

use crate::hash::table_hash;
use crate::math::sqrt;
use crate::side::Side;

/// Version of the table's layout and meaning; part of its hash.
pub const SCHEMA: u32 = 1;

/// One pair of the table: the velocity from which the stepwise braking policy needs exactly this distance.
///
/// Source: the pairs of braking distance and maximum allowable velocity of [P, § Safety Calculations]. The
/// distance here is that of braking in *steps* of one period, which is what a policy with zero acceleration at
/// every period's end can do; one continuous ramp to zero would promise too much.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "build", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Knot {
    /// Distance to the limit [rad or m].
    pub distance: f64,
    /// Speed towards the limit [rad/s or m/s].
    pub velocity: f64,
}

/// The parts of a table as stored; not yet checked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableParts<'a> {
    /// What it was built from.
    pub built_from: PlannerSpec,
    /// Knots per braking step.
    pub subdivisions: u32,
    /// Knots towards the upper position limit, equally spaced in velocity, from (0, 0) on.
    pub upper: &'a [Knot],
    /// Knots towards the lower position limit, equally spaced in velocity, from (0, 0) on.
    pub lower: &'a [Knot],
    /// FNV-1a hash of all of the above, see [`BrakingTable::hash`].
    pub hash: u64,
}

#[cfg(feature = "build")]
type Knots<'a> = Cow<'a, [Knot]>;
#[cfg(not(feature = "build"))]
type Knots<'a> = &'a [Knot];

/// Braking distances of one joint, both directions, checked against their hash.
///
/// Linear interpolation between knots is exact for [`Timing::Stretched`](jbtg::Timing) and on the safe side for
/// [`Timing::Fastest`](jbtg::Timing). Borrows its knots (from a `static`, say, on a target without allocation)
/// or, with the feature `build`, owns them.
#[derive(Clone, Debug, PartialEq)]
pub struct BrakingTable<'a> {
    built_from: PlannerSpec,
    subdivisions: u32,
    upper: Knots<'a>,
    lower: Knots<'a>,
    hash: u64,
}

impl<'a> TryFrom<TableParts<'a>> for BrakingTable<'a> {
    type Error = TableError;

    fn try_from(parts: TableParts<'a>) -> Result<Self, TableError> {
        let TableParts { built_from, subdivisions, upper, lower, hash } = parts;
        check_hash(&parts)?;
        check_knots(Side::Upper, upper, subdivisions)?;
        check_knots(Side::Lower, lower, subdivisions)?;
        #[cfg(feature = "build")]
        let (upper, lower) = (Cow::Borrowed(upper), Cow::Borrowed(lower));
        Ok(Self { built_from, subdivisions, upper, lower, hash })
    }
}

impl BrakingTable<'_> {
    /// What the table was built from.
    #[must_use]
    pub const fn built_from(&self) -> &PlannerSpec {
        &self.built_from
    }

    /// Knots per braking step.
    #[must_use]
    pub const fn subdivisions(&self) -> u32 {
        self.subdivisions
    }

    /// FNV-1a hash, 64 bit, over the bits of the limits, shape, timing, period and knots.
    #[must_use]
    pub const fn hash(&self) -> u64 {
        self.hash
    }

    /// Knots towards one limit, in increasing order.
    #[must_use]
    pub fn knots(&self, side: Side) -> &[Knot] {
        let knots: &Knots<'_> = match side {
            Side::Upper => &self.upper,
            Side::Lower => &self.lower,
        };
        knots
    }

    /// Distance that stepwise braking needs from `speed` towards `side` [rad or m], in constant time.
    ///
    /// 0 for a speed ≤ 0 (away from the limit), infinite beyond the last knot, which is the velocity limit or a
    /// speed from which the whole position interval does not suffice.
    #[must_use]
    pub fn distance(&self, side: Side, speed: f64) -> f64 {
        interpolate(self.knots(side), speed)
    }

    /// Largest speed towards `side` from which stepwise braking stops within `distance` [rad/s or m/s].
    ///
    /// 0 where the distance is not positive, the last knot's speed where it is beyond the last knot. Constant
    /// time: the knot is found from the parabola that they lie on, but for a step or two.
    #[must_use]
    pub fn max_velocity(&self, side: Side, distance: f64) -> f64 {
        let knots = self.knots(side);
        let last = knots.len() - 1;
        if distance.is_nan() || distance <= 0.0 {
            return 0.0;
        }
        if distance >= knots[last].distance {
            return knots[last].velocity;
        }
        let per_step = knots[1].velocity * f64::from(self.subdivisions);
        let steps = sqrt(2.0 * distance / (per_step * self.built_from.period));
        let mut k = ((steps * f64::from(self.subdivisions)) as usize).min(last - 1);
        while knots[k].distance > distance {
            k -= 1;
        }
        while knots[k + 1].distance <= distance {
            k += 1;
        }
        let (low, high) = (knots[k], knots[k + 1]);
        let share = (distance - low.distance) / (high.distance - low.distance);
        (low.velocity + share * (high.velocity - low.velocity)).min(high.velocity)
    }
}

#[cfg(feature = "build")]
impl BrakingTable<'static> {
    /// A table that owns its knots and computes its hash.
    pub(crate) fn owned(
        built_from: PlannerSpec,
        subdivisions: u32,
        upper: Vec<Knot>,
        lower: Vec<Knot>,
    ) -> Self {
        let hash = table_hash(&built_from, subdivisions, &upper, &lower);
        Self { built_from, subdivisions, upper: Cow::Owned(upper), lower: Cow::Owned(lower), hash }
    }
}

/// Distance at `speed` by linear interpolation between equally spaced knots; infinite beyond the last one and for
/// NaN.
#[inline]
pub(crate) fn interpolate(knots: &[Knot], speed: f64) -> f64 {
    if speed <= 0.0 {
        return 0.0;
    }
    let last = knots.len() - 1;
    if speed.is_nan() || speed > knots[last].velocity {
        return f64::INFINITY;
    }
    let k = ((speed / knots[1].velocity) as usize).min(last - 1);
    let (low, high) = (knots[k], knots[k + 1]);
    let share = (speed - low.velocity) / (high.velocity - low.velocity);
    low.distance + share * (high.distance - low.distance)
}

fn check_hash(parts: &TableParts<'_>) -> Result<(), TableError> {
    let found = table_hash(&parts.built_from, parts.subdivisions, parts.upper, parts.lower);
    if found == parts.hash { Ok(()) } else { Err(TableError::Corrupted { stated: parts.hash, found }) }
}

fn check_knots(side: Side, knots: &[Knot], subdivisions: u32) -> Result<(), TableError> {
    let malformed = |index| Err(TableError::Malformed { side, index });
    if subdivisions == 0 || knots.len() < 2 || knots[0] != (Knot { distance: 0.0, velocity: 0.0 }) {
        return malformed(0);
    }
    let spacing = knots[1].velocity;
    for (index, pair) in knots.windows(2).enumerate() {
        let expected = (index + 1) as f64 * spacing;
        let in_order = pair[1].velocity == expected && pair[1].distance > pair[0].distance;
        if !(in_order && expected > 0.0 && expected.is_finite() && pair[1].distance.is_finite()) {
            return malformed(index + 1);
        }
    }
    Ok(())
}

/// Why a braking table was refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TableError {
    /// Its content is not what its hash was computed over: it was edited or damaged.
    #[error("braking table is corrupted: it states hash {stated:016x}, its content has {found:016x}")]
    Corrupted {
        /// The hash it states.
        stated: u64,
        /// The hash of what it holds.
        found: u64,
    },
    /// Its knots do not start at (0, 0), are not equally spaced in velocity or do not increase in distance.
    #[error("knot {index} of the braking table ({side:?}) is out of order")]
    Malformed {
        /// The limit whose knots are wrong.
        side: Side,
        /// The first wrong knot.
        index: usize,
    },
}
