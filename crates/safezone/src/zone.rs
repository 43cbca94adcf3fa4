//! The safe zone of one joint.

use jbtg::{Interval, Planner};

use crate::math::{larger, smaller};
use crate::range::{RangeStatus, SafeRange};
use crate::sampled::{Sampled, Samples};
use crate::side::{Braking, Side};
use crate::table::{BrakingTable, subdivisions};

/// Relative difference that counts as rounding between a knot and what braking takes.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Safe velocity ranges of one joint.
///
/// # Guarantee
/// From a state whose range is [`RangeStatus::Safe`], whatever sequence of velocities is chosen from the ranges,
/// every step keeps position, velocity, acceleration and jerk within their limits to 1e-12 of the interval's width,
/// its interior included, and the range is never empty. Braking, towards zero by as much as each period allows, is in
/// every range, so a fail-safe may act at any time.
///
/// With N the periods that braking within the position interval takes at most, rounding costs N + 16 ulps of the
/// largest position: the [guard](SafeZone::guard) that a chosen step keeps from the limit. From a start that keeps
/// it no limit is exceeded at all; 1e-12 holds from any safe start as long as (N + 16)·s/W < 4500 for a largest
/// position s and an interval W wide.
///
/// From any other state the range leads back, monotonically, and no further out than braking at once;
/// [`SafeRange::status`] says which of the promises hold. To change limits while the joint moves, make a new zone and
/// ask it from the next period on: nothing is carried over but the state.
///
/// `docs/guarantee.md` has the proof, for both timings and for limits that differ between the directions.
///
/// Source: [P, § Safety Calculations], with three departures, without which the guarantee does not hold: the
/// braking distance is that of braking in steps of one period; the zone is taken at the position that the very
/// velocity in question leads to, not at the one that the largest reachable velocity would lead to; and
/// the interior of a step counts.
#[derive(Clone, Debug)]
pub struct SafeZone<'a> {
    planner: Planner,
    table: Option<BrakingTable<'a>>,
    upper: Braking,
    lower: Braking,
    samples: [Option<&'a Sampled>; 2],
}

impl SafeZone<'static> {
    /// A zone that computes braking distances from their closed form instead of a table.
    ///
    /// The same ranges as with a table for [`Timing::Stretched`](jbtg::Timing), slightly wider ones for
    /// [`Timing::Fastest`](jbtg::Timing).
    ///
    /// # Errors
    /// [`ZoneError::Narrow`], as for [`SafeZone::new`].
    pub fn closed_form(planner: Planner) -> Result<Self, ZoneError> {
        Self::assemble(planner, None)
    }
}

impl<'a> SafeZone<'a> {
    /// The zone of `planner`'s joint with braking distances from `table`.
    ///
    /// # Errors
    /// [`ZoneError::Stale`] if the table was built for other limits, another shape, timing or period,
    /// [`ZoneError::Spacing`] or [`ZoneError::Distance`] if a knot is not where braking ends, [`ZoneError::Narrow`] if the position
    /// interval is so narrow that rounding (or the overshoot of the ramp's shape) leaves no room to move.
    pub fn new(planner: Planner, table: BrakingTable<'a>) -> Result<Self, ZoneError> {
        if table.built_from() != planner.spec() {
            return Err(ZoneError::Stale { hash: table.hash() });
        }
        for side in [Side::Upper, Side::Lower] {
            check_promises(&planner, &table, side)?;
        }
        Self::assemble(planner, Some(table))
    }

    /// A zone whose ranges take constant time with [`Timing::Fastest`](jbtg::Timing) too: from samples of steps and braking, on
    /// the safe side, in memory of the caller's.
    ///
    /// The ranges lie within those of [`SafeZone::closed_form`], the same with [`Timing::Stretched`](jbtg::Timing).
    /// `docs/guarantee.md` says how much narrower they are.
    ///
    /// # Errors
    /// [`ZoneError::Narrow`], as for [`SafeZone::new`].
    pub fn sampled(planner: Planner, samples: &'a mut Samples) -> Result<Self, ZoneError> {
        let zone = Self::assemble(planner, None)?;
        samples.fill(&planner, &zone.upper, &zone.lower);
        Ok(Self { samples: samples.sides(), ..zone })
    }

    fn assemble(planner: Planner, table: Option<BrakingTable<'a>>) -> Result<Self, ZoneError> {
        let (upper, lower) = (Braking::new(&planner, Side::Upper), Braking::new(&planner, Side::Lower));
        let guard = upper.guard + lower.guard;
        if guard >= 0.5 * upper.width {
            return Err(ZoneError::Narrow { width: upper.width, guard });
        }
        Ok(Self { planner, table, upper, lower, samples: [None; 2] })
    }

    /// The planner whose steps the ranges are made for.
    #[must_use]
    pub const fn planner(&self) -> &Planner {
        &self.planner
    }

    /// The braking table, if there is one.
    #[must_use]
    pub const fn table(&self) -> Option<&BrakingTable<'a>> {
        self.table.as_ref()
    }

    /// Distance that a chosen velocity keeps from the limit at `side` when it is braked from [rad or m]: what rounding
    /// may add on the way, and the overshoot of the ramp's shape.
    ///
    /// From a start that stops nearer to the limit than this the limit is kept but for that rounding;
    /// [`SafeRange::status`] tells once that reaches half of 1e-12 of the interval's width.
    #[must_use]
    pub const fn guard(&self, side: Side) -> f64 {
        match side {
            Side::Upper => self.upper.guard,
            Side::Lower => self.lower.guard,
        }
    }

    /// Distance that the stepwise braking policy travels from `velocity` [rad or m], ≥ 0, in closed form.
    ///
    /// Each period takes as much speed away as one period can. The direction is that of the velocity. Infinite for a
    /// velocity that is not finite.
    ///
    /// Source: [P, § Safety Calculations] brakes in one continuous ramp; see [`SafeZone`].
    #[must_use]
    pub fn stopping_distance(&self, velocity: f64) -> f64 {
        if !velocity.is_finite() {
            f64::INFINITY
        } else if velocity >= 0.0 {
            self.upper.distance(velocity)
        } else {
            self.lower.distance(-velocity)
        }
    }

    /// The velocities that are safe to command as the end of the next step from `position` [rad or m] and
    /// `velocity` [rad/s or m/s], both taken at the start of the step, where the acceleration is zero.
    ///
    /// Total: never empty, whatever the state; [`SafeRange::status`] says what it can promise. In constant time with
    /// [`Timing::Stretched`](jbtg::Timing) or [samples](SafeZone::sampled).
    #[must_use]
    #[inline]
    pub fn range(&self, position: f64, velocity: f64) -> SafeRange {
        let reachable = self.planner.reachable(velocity);
        let brake = towards_zero(reachable);
        if self.planner.velocity().contains(velocity) {
            if self.upper.is_far(position) && self.lower.is_far(-position) {
                return SafeRange::free(reachable, brake);
            }
            if self.planner.limits().position().contains(position) {
                return self.range_inside(position, velocity, reachable, brake);
            }
        }
        self.range_outside(position, velocity, reachable, brake)
    }

    /// The range of a joint within its limits, one of which at least is not far.
    fn range_inside(&self, position: f64, velocity: f64, reachable: Interval, brake: f64) -> SafeRange {
        let is_free_above = self.upper.is_free(position, velocity);
        let is_free_below = self.lower.is_free(-position, -velocity);
        match (is_free_above, is_free_below) {
            (true, true) => SafeRange::free(reachable, brake),
            (false, true) => self.range_before(Side::Upper, position, velocity, reachable, brake),
            (true, false) => self.range_before(Side::Lower, position, velocity, reachable, brake),
            (false, false) => self.range_between(position, velocity, reachable, brake),
        }
    }

    /// What both limits leave of the velocities that are reachable.
    #[inline(never)]
    fn range_between(&self, position: f64, velocity: f64, reachable: Interval, brake: f64) -> SafeRange {
        let [upper, lower] = [Side::Upper, Side::Lower]
            .map(|side| self.range_before(side, position, velocity, reachable, brake));
        SafeRange {
            min: larger(upper.min, lower.min),
            max: smaller(upper.max, lower.max),
            brake,
            narrowed: upper.narrowed || lower.narrowed,
            status: if upper.status == RangeStatus::Safe { lower.status } else { upper.status },
        }
    }

    /// What the limit at `side` leaves of them.
    #[inline(never)]
    fn range_before(
        &self,
        side: Side,
        position: f64,
        velocity: f64,
        reachable: Interval,
        brake: f64,
    ) -> SafeRange {
        let [upper_samples, lower_samples] = self.samples;
        let (braking, sampled, sign, Interval { min: lowest, max: highest }) = match side {
            Side::Upper => (&self.upper, upper_samples, 1.0, reachable),
            Side::Lower => (&self.lower, lower_samples, -1.0, reachable.mirrored()),
        };
        let (position, velocity, stop) = (sign * position, sign * velocity, sign * brake);
        let room = braking.kept - braking.rounding_of_the_way_in(position) - position;
        let fitting = if let Some(sampled) = sampled {
            sampled.max_velocity(velocity, room)
        } else {
            let table = self.table.as_ref().map(|table| table.curve(side));
            if braking.stretched {
                braking.solve_stretched(table, velocity, room)
            } else {
                braking.solve_fastest(table, velocity, (stop, highest), room)
            }
        };
        let max = smaller(larger(fitting, stop), highest);
        let turns = sampled.map(|sampled| &sampled.turns);
        let min = braking.min_velocity(turns, (position, velocity), (lowest, stop));
        let status = if velocity > 0.0 && max <= stop && braking.cannot_stop(position, velocity) {
            RangeStatus::CannotStop
        } else {
            RangeStatus::Safe
        };
        let narrowed = min > lowest || max < highest;
        let (min, max) = if side == Side::Upper { (min, max) } else { (-max, -min) };
        SafeRange { min, max, brake, narrowed, status }
    }

    /// The range of a joint outside its limits.
    #[cold]
    fn range_outside(&self, position: f64, velocity: f64, reachable: Interval, brake: f64) -> SafeRange {
        if !(position.is_finite() && velocity.is_finite()) {
            return self.blind_range(velocity);
        }
        let SafeRange { mut min, mut max, mut status, .. } =
            self.range_between(position, velocity, reachable, brake);
        if status == RangeStatus::Safe && !self.planner.velocity().contains(velocity) {
            status = RangeStatus::VelocityOutside;
        }
        if self.upper.is_outside(position) {
            status = RangeStatus::PositionOutside;
            max = larger(smaller(max, self.upper.way_back(velocity, reachable, brake)), min);
        } else if self.lower.is_outside(-position) {
            status = RangeStatus::PositionOutside;
            min = smaller(larger(min, -self.lower.way_back(-velocity, reachable.mirrored(), -brake)), max);
        }
        let narrowed = min > reachable.min || max < reachable.max;
        SafeRange { min, max, brake: smaller(larger(brake, min), max), narrowed, status }
    }

    /// The range of a state that is not finite: braking as far as the velocity is known.
    fn blind_range(&self, velocity: f64) -> SafeRange {
        let brake = if velocity.is_finite() { towards_zero(self.planner.reachable(velocity)) } else { 0.0 };
        SafeRange { min: brake, max: brake, brake, narrowed: true, status: RangeStatus::Unknown }
    }
}

impl Braking {
    /// Whether braking at once, from inside, overruns the limit by more than rounding.
    #[inline]
    fn cannot_stop(&self, position: f64, velocity: f64) -> bool {
        position + self.distance(velocity) > self.limit + self.tolerance
    }

    /// Greatest velocity from beyond the limit that still leads back: braking while it moves out, then half of what
    /// one period can reach from rest.
    fn way_back(&self, velocity: f64, reachable: Interval, brake: f64) -> f64 {
        if velocity > 0.0 {
            brake
        } else {
            let slowest_return = 0.5 * self.step;
            smaller(larger(-slowest_return, reachable.min), reachable.max)
        }
    }
}

/// The velocity nearest to zero that the braking policy steps to.
#[inline]
fn towards_zero(reachable: Interval) -> f64 {
    smaller(larger(reachable.min, 0.0), reachable.max)
}

/// Checks that the knots lie where braking steps ask for, at the distances that braking takes.
fn check_promises(planner: &Planner, table: &BrakingTable<'_>, side: Side) -> Result<(), ZoneError> {
    let braking = Braking::new(planner, side);
    let spacing = braking.step / f64::from(subdivisions(planner.spec().timing));
    // The braking policy keeps the interpolated distance only if knots lie on braking steps.
    let found = table.knots(side)[1].velocity;
    if (found - spacing).abs() > ROUNDING * spacing {
        return Err(ZoneError::Spacing { side, expected: spacing, found });
    }
    let lift = braking.kink_depth(spacing);
    for knot in &table.knots(side)[1..] {
        let needed = braking.distance(knot.velocity) + lift;
        if (knot.distance - needed).abs() > ROUNDING * needed {
            return Err(ZoneError::Distance {
                side,
                velocity: knot.velocity,
                distance: knot.distance,
                needed,
            });
        }
    }
    Ok(())
}

/// Why a zone was refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ZoneError {
    /// The table was built for something else than this planner.
    #[error(
        "braking table {hash:016x} is stale: it was built for other limits, shape, timing or period; run `cargo xtask tables`"
    )]
    Stale {
        /// The table's hash.
        hash: u64,
    },
    /// A knot promises another distance than braking takes.
    #[error(
        "braking table is wrong ({side:?}): it claims {distance} from velocity {velocity}, braking takes {needed}"
    )]
    Distance {
        /// The limit concerned.
        side: Side,
        /// The knot's velocity [rad/s or m/s].
        velocity: f64,
        /// The knot's distance [rad or m].
        distance: f64,
        /// The distance that braking takes [rad or m].
        needed: f64,
    },
    /// The knots do not lie on braking steps.
    #[error(
        "braking table's knots ({side:?}) are {found} apart in velocity, braking steps ask for {expected}"
    )]
    Spacing {
        /// The limit concerned.
        side: Side,
        /// The spacing that braking steps ask for [rad/s or m/s].
        expected: f64,
        /// The table's spacing [rad/s or m/s].
        found: f64,
    },
    /// The position interval leaves no room to move.
    #[error("position interval of width {width} is too narrow: {guard} of it is needed as a guard")]
    Narrow {
        /// Width of the position interval [rad or m].
        width: f64,
        /// What both ends must keep free [rad or m].
        guard: f64,
    },
}

#[cfg(test)]
mod tests;
