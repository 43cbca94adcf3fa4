//! Judges one step: what its range promised against what the step does, by exact extrema.

use jbtg::{Direction, Extrema, Interval, RampError};
use safezone::{RangeStatus, SafeRange, SafeZone, Side};

use super::MOST_EXCESS;
use super::tally::Excess;

/// A promise that was broken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Fault {
    /// A limit is exceeded by more than [`MOST_EXCESS`] of its interval's width, or by NaN.
    Limit(Excess),
    /// The range holds no velocity.
    EmptyRange,
    /// The range does not hold braking, or the velocity that it commands.
    NoBraking,
    /// A velocity of the range cannot be planned.
    Refused(RampError),
    /// The range promises more, or less, than the state allows.
    Status,
}

/// What holds for the steps of a motion that started where nothing could be promised, or all but rounding: it goes no
/// further out than braking at once would have gone, its guard on top, and no faster.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Recovery {
    position: Interval,
    velocity: Interval,
}

/// What is known about a motion between two steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Trust {
    /// Nothing yet: the motion has just started, or new limits have just taken over.
    New,
    /// It was promised that every limit is kept for ever.
    Promised,
    /// It is on a way back.
    Recovering(Recovery),
}

impl Trust {
    /// What is known once the range at `(position, velocity)` has been seen.
    #[inline]
    pub(super) fn after(
        self,
        zone: &SafeZone<'_>,
        (position, velocity): (f64, f64),
        range: &SafeRange,
    ) -> Result<Self, Fault> {
        match (self, range.status) {
            (Self::Promised, RangeStatus::Safe) => Ok(self),
            // From a start within the guard, far from 0, rounding may come to light on the way; the limit stays.
            (Self::Promised, RangeStatus::CannotStop) if is_rounding(zone, (position, velocity)) => Ok(self),
            (Self::Promised, _) => Err(Fault::Status),
            (Self::New | Self::Recovering(_), RangeStatus::Safe) => {
                check_status(zone, (position, velocity), range.status)?;
                if keeps_guard(zone, (position, velocity)) || is_exact(zone) {
                    Ok(Self::Promised)
                } else {
                    Ok(Self::Recovering(Recovery::from(zone, (position, velocity), range.status)))
                }
            }
            (Self::New, status) => {
                check_status(zone, (position, velocity), status)?;
                Ok(Self::Recovering(Recovery::from(zone, (position, velocity), status)))
            }
            (Self::Recovering(_), status) => {
                check_status(zone, (position, velocity), status)?;
                Ok(self)
            }
        }
    }
}

impl Recovery {
    fn from(zone: &SafeZone<'_>, (position, velocity): (f64, f64), status: RangeStatus) -> Self {
        let limits = zone.planner().limits();
        let stop = position + velocity.signum() * zone.stopping_distance(velocity);
        let mut hull = limits.position().including(position).including(stop);
        if status != RangeStatus::VelocityOutside {
            // Outside, rounding and the overshoot of the ramp's shape come on top.
            hull = Interval::new(hull.min - zone.guard(Side::Lower), hull.max + zone.guard(Side::Upper));
        }
        let (bounds, ends) = (limits.velocity(), zone.planner().velocity());
        let mut fastest = bounds;
        if !ends.contains(velocity) {
            // A change of the whole interval overshoots by the margin that the planner keeps.
            let margin = (bounds.max - ends.max) / ends.width() * ends.including(velocity).width();
            fastest = bounds.including(velocity + velocity.signum() * margin);
        }
        Self { position: hull, velocity: fastest }
    }
}

/// Whether braking at once stops with the zone's guard between the joint and its limits.
fn keeps_guard(zone: &SafeZone<'_>, (position, velocity): (f64, f64)) -> bool {
    let limits = zone.planner().limits().position();
    let stop = position + velocity.signum() * zone.stopping_distance(velocity);
    stop <= limits.max - zone.guard(Side::Upper) && stop >= limits.min + zone.guard(Side::Lower)
}

/// Whether the rounding of a whole braking manoeuvre is below half of [`MOST_EXCESS`]. It is not where braking takes
/// thousands of periods or the interval lies thousands of its widths away from 0, so that an ulp of the position alone
/// may exceed the bar: there a start within the guard is promised the limit but for that rounding.
fn is_exact(zone: &SafeZone<'_>) -> bool {
    let rounding = |side, direction| {
        let authority = zone.planner().authority(direction);
        zone.guard(side) - 2.0 * authority.reverse_travel * authority.velocity_change
    };
    let most = rounding(Side::Upper, Direction::Decreasing).max(rounding(Side::Lower, Direction::Increasing));
    most <= 0.5 * MOST_EXCESS * zone.planner().limits().position().width()
}

/// Whether braking at once stops no further out than what counts as rounding.
fn is_rounding(zone: &SafeZone<'_>, (position, velocity): (f64, f64)) -> bool {
    let limits = zone.planner().limits().position();
    let stop = position + velocity.signum() * zone.stopping_distance(velocity);
    limits.max.max(stop) - limits.min.min(stop) <= (1.0 + MOST_EXCESS) * limits.width()
}

/// Whether the status says what is so, give or take the rounding that a zone allows for.
fn check_status(
    zone: &SafeZone<'_>,
    (position, velocity): (f64, f64),
    status: RangeStatus,
) -> Result<(), Fault> {
    let interval = zone.planner().limits().position();
    let rounding = MOST_EXCESS * interval.width();
    let stop = position + velocity.signum() * zone.stopping_distance(velocity);
    let beyond = |p: f64, slack: f64| p > interval.max + slack || p < interval.min - slack;
    let guard = zone.guard(Side::Upper).max(zone.guard(Side::Lower));
    let is_faithful = match status {
        RangeStatus::Safe => !beyond(position, rounding) && !beyond(stop, rounding),
        RangeStatus::VelocityOutside => !beyond(position, rounding),
        RangeStatus::CannotStop => beyond(stop, 0.0) && !beyond(position, rounding),
        RangeStatus::PositionOutside => beyond(position, 0.0),
        RangeStatus::Unknown => false,
    };
    let is_too_fast = !zone.planner().velocity().contains(velocity);
    let is_plainly_safe = !beyond(position, -guard) && !beyond(stop, -guard) && !is_too_fast;
    let has_missed_speed = is_too_fast && status == RangeStatus::Safe;
    let has_cried_wolf = is_plainly_safe && status != RangeStatus::Safe;
    if is_faithful && !has_missed_speed && !has_cried_wolf { Ok(()) } else { Err(Fault::Status) }
}

/// Checks that `range` holds something, braking, and the velocity that was commanded from it.
#[inline]
pub(super) fn check_range(
    zone: &SafeZone<'_>,
    velocity: f64,
    range: &SafeRange,
    commanded: f64,
) -> Result<(), Fault> {
    if !(range.min <= range.max) {
        return Err(Fault::EmptyRange);
    }
    if !(range.contains(range.brake) && range.contains(commanded)) {
        return Err(Fault::NoBraking);
    }
    if range.status == RangeStatus::PositionOutside {
        // Braking while it moves out; after that every velocity leads back.
        return Ok(());
    }
    let reachable = zone.planner().reachable(velocity);
    let brake = if velocity > 0.0 { reachable.min.max(0.0) } else { reachable.max.min(0.0) };
    if range.contains(if velocity == 0.0 { 0.0 } else { brake }) { Ok(()) } else { Err(Fault::NoBraking) }
}

/// Largest excess of a step over what it was to keep, relative to the widths.
#[inline]
pub(super) fn excess(zone: &SafeZone<'_>, extrema: &Extrema, trust: &Trust) -> Excess {
    let limits = zone.planner().limits();
    let (position, velocity) = match trust {
        Trust::Recovering(recovery) => (recovery.position, recovery.velocity),
        Trust::New | Trust::Promised => (limits.position(), limits.velocity()),
    };
    Excess {
        position: beyond(extrema.position, position),
        velocity: beyond(extrema.velocity, velocity),
        acceleration: beyond(extrema.acceleration, limits.acceleration()),
        jerk: beyond(extrema.jerk, limits.jerk()),
    }
}

/// How far `found` reaches beyond `allowed`, relative to the width of `allowed`; 0 if it does not, NaN for NaN.
#[inline]
fn beyond(found: Interval, allowed: Interval) -> f64 {
    let (above, below) = (found.max - allowed.max, allowed.min - found.min);
    if above <= 0.0 && below <= 0.0 {
        return 0.0;
    }
    let most = if above > below { above } else { below };
    if above.is_nan() { above } else { most / allowed.width() }
}
