//! Joints: random limits, periods, shapes and timings, what they change into, and where their motion starts.

use std::slice::IterMut;

use jbtg::{Direction, Interval, Limits, LimitsSpec, Planner, PlannerSpec, Shape, Timing};
use safezone::{BrakingTable, SafeZone, Samples, Side};

use super::random::Random;
use super::tally::Tally;

/// Most knots of a table that is worth building for one case; others use the closed form.
const MOST_KNOTS: f64 = 1024.0;

/// A joint of any kind: its limits over six decades, its period 1 ms to 1 s. What the planner or the zone refuses is
/// counted and drawn again. A zone that samples takes its memory from `store`.
pub(super) fn zone<'a>(
    random: &mut Random,
    tally: &mut Tally,
    store: &mut IterMut<'a, Samples>,
) -> SafeZone<'a> {
    loop {
        let (limits, period) = if random.below(4) == 0 { independent(random) } else { proportionate(random) };
        let shape = if random.below(2) == 0 { Shape::Smoothstep } else { Shape::SineQuintic };
        let timing = if random.below(2) == 0 { Timing::Stretched } else { Timing::Fastest };
        match assemble(random, tally, store, (limits, shape, timing, period)) {
            Some(zone) => return zone,
            None => tally.refused += 1,
        }
    }
}

/// The same joint with other limits, which take over at the start of a period; none if they were refused.
pub(super) fn changed<'a>(
    zone: &SafeZone<'_>,
    random: &mut Random,
    tally: &mut Tally,
    store: &mut IterMut<'a, Samples>,
) -> Option<SafeZone<'a>> {
    let PlannerSpec { limits, shape, timing, period } = *zone.planner().spec();
    let mut spec = LimitsSpec::from(limits);
    let narrower = random.below(2) == 0;
    for interval in [&mut spec.velocity, &mut spec.acceleration, &mut spec.jerk] {
        for end in [&mut interval.min, &mut interval.max] {
            if random.below(2) == 0 {
                *end *= random.decades(-0.5, if narrower { 0.0 } else { 0.5 });
            }
        }
    }
    let width = spec.position.width();
    for end in [&mut spec.position.min, &mut spec.position.max] {
        if random.below(2) == 0 {
            *end += random.uniform(-0.5, 0.5) * width;
        }
    }
    let zone = assemble(random, tally, store, (spec, shape, timing, period));
    tally.refused += u64::from(zone.is_none());
    zone
}

/// A zone of any kind: half of them with a table, a quarter of the fastest ones from samples.
fn assemble<'a>(
    random: &mut Random,
    tally: &mut Tally,
    store: &mut IterMut<'a, Samples>,
    (limits, shape, timing, period): (LimitsSpec, Shape, Timing, f64),
) -> Option<SafeZone<'a>> {
    let limits = Limits::try_from(limits).ok()?;
    let planner = Planner::try_from(PlannerSpec { limits, shape, timing, period }).ok()?;
    let kind = random.below(4);
    let mut samples = if kind == 2 && timing == Timing::Fastest { store.next() } else { None };
    let zone = if kind < 2 && knots(&planner) <= MOST_KNOTS {
        let zone = SafeZone::new(planner, BrakingTable::build(&planner).ok()?).ok()?;
        tally.zones_with_table += 1;
        zone
    } else if let Some(samples) = samples.take() {
        let zone = SafeZone::sampled(planner, samples).ok()?;
        tally.zones_with_samples += 1;
        zone
    } else {
        SafeZone::closed_form(planner).ok()?
    };
    tally.zones += 1;
    Some(zone)
}

/// About how many knots the joint's braking table has.
fn knots(planner: &Planner) -> f64 {
    let per_step = if planner.spec().timing == Timing::Stretched { 1.0 } else { 16.0 };
    let (width, velocity) = (planner.limits().position().width(), planner.velocity());
    let steps = |direction, speed: f64| {
        let change = planner.authority(direction).velocity_change;
        (speed / change).min((2.0 * width / (change * planner.period())).sqrt())
    };
    per_step * (steps(Direction::Decreasing, velocity.max) + steps(Direction::Increasing, -velocity.min))
}

/// Limits in proportion to each other and to the period, so that all of them come into play.
fn proportionate(random: &mut Random) -> (LimitsSpec, f64) {
    let period = random.decades(-3.0, 0.0);
    let acceleration = random.decades(-3.0, 3.0);
    let jerk = random.decades(-2.5, 3.5) * acceleration / period;
    let velocity = random.decades(-2.0, 4.0) * acceleration * period;
    let width = random.decades(-3.0, 3.0) * velocity * (velocity / acceleration + period);
    (limits(random, [width, velocity, acceleration, jerk]), period)
}

/// Limits that have nothing to do with each other.
fn independent(random: &mut Random) -> (LimitsSpec, f64) {
    let scales = [(); 4].map(|()| random.decades(-3.0, 3.0));
    (limits(random, scales), random.decades(-3.0, 0.0))
}

/// Intervals of these sizes, unequal in their directions by up to a factor of ten; the position interval up to a
/// thousand times its width away from 0.
fn limits(random: &mut Random, [width, velocity, acceleration, jerk]: [f64; 4]) -> LimitsSpec {
    let offset = match random.below(4) {
        0 => 0.0,
        1 => -0.5,
        2 => -random.unit(),
        _ => random.sign() * random.decades(-1.0, 3.0),
    };
    let position = Interval::new(offset * width, offset * width + width);
    let mut interval = |scale: f64| {
        let share = if random.below(2) == 0 { 1.0 } else { random.decades(-1.0, 0.0) };
        let interval = Interval::new(-scale * share, scale);
        if random.below(2) == 0 { interval } else { interval.mirrored() }
    };
    let (velocity, acceleration, jerk) = (interval(velocity), interval(acceleration), interval(jerk));
    LimitsSpec { position, velocity, acceleration, jerk }
}

/// Where a motion starts: mostly where braking stops inside the limits, the ends included; now and then one ulp from
/// such an end, next to rest on a limit, or outside.
pub(super) fn start(zone: &SafeZone<'_>, random: &mut Random) -> (f64, f64) {
    let limits = zone.planner().limits();
    let position = limits.position();
    match random.below(16) {
        0 => {
            // Next to rest on a limit.
            let limit = if random.below(2) == 0 { position.min } else { position.max };
            let step = zone.planner().authority(Direction::Increasing).velocity_change;
            (limit, random.sign() * step * random.decades(-16.0, -3.0))
        }
        1 => {
            let out = random.uniform(-1.0, 2.0) * position.width();
            (position.min + out, limits.velocity().max * random.uniform(-2.0, 2.0))
        }
        2 | 3 => {
            let (p, v) = safe_start(zone, random);
            (if random.below(2) == 0 { p.next_up() } else { p.next_down() }, v)
        }
        _ => safe_start(zone, random),
    }
}

fn safe_start(zone: &SafeZone<'_>, random: &mut Random) -> (f64, f64) {
    let (bounds, limits) = (zone.planner().velocity(), zone.planner().limits().position());
    let (mut velocity, share) = (bounds.clamp(bounds.min + random.share() * bounds.width()), random.share());
    loop {
        let distance = zone.stopping_distance(velocity);
        let inside = if velocity > 0.0 {
            Interval::new(limits.min, limits.max - distance)
        } else {
            Interval::new(limits.min + distance, limits.max)
        };
        if inside.min <= inside.max {
            // A start where the zone's guard is kept promises the most; without it, rounding alone decides.
            let guard = if random.below(2) == 0 { 1.0 } else { 0.0 };
            let inside = Interval::new(
                inside.min + guard * zone.guard(Side::Lower),
                inside.max - guard * zone.guard(Side::Upper),
            );
            return (inside.clamp(inside.min + share * inside.width()), velocity);
        }
        velocity *= 0.5;
    }
}
