//! Braking tables: pairs of braking distance and velocity, built offline.

use jbtg::{PlannerSpec, Timing};
#[cfg(feature = "build")]
use std::borrow::Cow;

use crate::curve::Curve;
use crate::hash::table_hash;
use crate::side::Side;

/// Version of the table's layout and meaning; part of its hash.
pub const SCHEMA: u32 = 1;

/// One pair of the table: the velocity from which the stepwise braking policy needs exactly this distance.
///
/// Source: the pairs of braking distance and maximum allowable velocity of [P, § Safety Calculations]. The
/// distance here is that of braking in *steps* of one period, which is what a policy with zero acceleration at
/// every period's end can do; one continuous ramp to zero would promise too much.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "build", derive(serde::Deserialize), serde(deny_unknown_fields))]
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

/// Braking distances of one joint, both directions, checked against their hash.
///
/// Linear interpolation between knots is exact for [`Timing::Stretched`](jbtg::Timing) and on the safe side for
/// [`Timing::Fastest`](jbtg::Timing). Borrows its knots (from a `static`, say, on a target without allocation)
/// or, with the feature `build`, owns them.
#[derive(Clone, Debug, PartialEq)]
pub struct BrakingTable<'a> {
    built_from: PlannerSpec,
    subdivisions: u32,
    upper: Curve<'a>,
    lower: Curve<'a>,
    hash: u64,
}

impl<'a> TryFrom<TableParts<'a>> for BrakingTable<'a> {
    type Error = TableError;

    fn try_from(parts: TableParts<'a>) -> Result<Self, TableError> {
        let TableParts { built_from, subdivisions, upper, lower, hash } = parts;
        check_hash(&parts)?;
        #[cfg(feature = "build")]
        let (upper, lower) = (Cow::Borrowed(upper), Cow::Borrowed(lower));
        let malformed = |side| move |index| TableError::Malformed { side, index };
        let upper = Curve::new(upper, subdivisions, built_from.period).map_err(malformed(Side::Upper))?;
        let lower = Curve::new(lower, subdivisions, built_from.period).map_err(malformed(Side::Lower))?;
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
        self.curve(side).knots()
    }

    /// Distance that stepwise braking needs from `speed` towards `side` [rad or m], in constant time.
    ///
    /// 0 for a speed ≤ 0 (away from the limit), infinite beyond the last knot, which is the velocity limit or a
    /// speed from which the whole position interval does not suffice, and for NaN.
    #[must_use]
    #[inline]
    pub fn distance(&self, side: Side, speed: f64) -> f64 {
        self.curve(side).distance_and_slope(speed).0
    }

    /// Largest speed towards `side` from which stepwise braking stops within `distance` [rad/s or m/s], in constant
    /// time.
    ///
    /// 0 where the distance is not positive or NaN, the last knot's speed where it is beyond the last knot. The
    /// braking step is found from the parabola that the knots of whole steps lie on, or is a neighbour of the one
    /// found; within a step, ⌈log₂ subdivisions⌉ halvings find the knot.
    #[must_use]
    #[inline]
    pub fn max_velocity(&self, side: Side, distance: f64) -> f64 {
        self.curve(side).max_speed(distance)
    }
}

impl<'a> BrakingTable<'a> {
    #[inline]
    pub(crate) const fn curve(&self, side: Side) -> &Curve<'a> {
        match side {
            Side::Upper => &self.upper,
            Side::Lower => &self.lower,
        }
    }
}

#[cfg(feature = "build")]
impl BrakingTable<'static> {
    /// A table that owns its knots and computes its hash.
    ///
    /// # Errors
    /// [`TableError::Malformed`], as for knots from elsewhere.
    pub(crate) fn owned(
        built_from: PlannerSpec,
        subdivisions: u32,
        upper: Vec<Knot>,
        lower: Vec<Knot>,
    ) -> Result<Self, TableError> {
        let hash = table_hash(&built_from, subdivisions, &upper, &lower);
        let curve = |side, knots| {
            Curve::new(Cow::Owned(knots), subdivisions, built_from.period)
                .map_err(|index| TableError::Malformed { side, index })
        };
        let (upper, lower) = (curve(Side::Upper, upper)?, curve(Side::Lower, lower)?);
        Ok(Self { built_from, subdivisions, upper, lower, hash })
    }
}

/// Knots per braking step: one where the distance is linear in between, sixteen where it is not.
pub(crate) const fn subdivisions(timing: Timing) -> u32 {
    match timing {
        Timing::Stretched => 1,
        Timing::Fastest => 16,
    }
}

/// Compares a table's hash with that of its content.
pub(crate) fn check_hash(parts: &TableParts<'_>) -> Result<(), TableError> {
    let found = table_hash(&parts.built_from, parts.subdivisions, parts.upper, parts.lower);
    if found == parts.hash { Ok(()) } else { Err(TableError::Corrupted { stated: parts.hash, found }) }
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
    /// Its knots do not start at (0, 0), are not equally spaced in velocity, do not increase in distance, or those of
    /// whole braking steps do not lie on the parabola that braking steps lie on.
    #[error("knot {index} of the braking table ({side:?}) is out of order")]
    Malformed {
        /// The limit whose knots are wrong.
        side: Side,
        /// The first wrong knot.
        index: usize,
    },
}
