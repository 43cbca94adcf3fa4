//! Limits that change while the joint moves: a new zone takes over at the start of a period, from a state that may violate
//! the new limits. And starts from outside. The way back is defined and monotone.

use jbtg::strategies::planners;
use jbtg::{Direction, Interval, Limits, LimitsSpec, Planner, PlannerSpec, Shape};
use proptest::prelude::*;
use safezone::{RangeStatus, SafeZone, Side};

use crate::adversary::{Noise, safe_state};
use crate::telescope;
use crate::tolerance;

/// What a shape's own overshoot and rounding may add to a turning point on one side [rad or m].
fn slack(zone: &SafeZone<'_>, side: Side) -> f64 {
    let direction = if side == Side::Upper { Direction::Decreasing } else { Direction::Increasing };
    let authority = zone.planner().authority(direction);
    let overshoot = authority.reverse_travel * authority.velocity_change;
    // The guard is twice the overshoot and the rounding.
    zone.guard(side) - overshoot
}

/// The lesser of the velocity changes that one period can make upwards and downwards [rad/s or m/s].
fn least_change(planner: &Planner) -> f64 {
    let [up, down] =
        [Direction::Increasing, Direction::Decreasing].map(|d| planner.authority(d).velocity_change);
    up.min(down)
}

/// Whether double precision can hold the positions of a slow way back.
fn is_resolved(planner: &Planner, position: f64) -> bool {
    0.1 * least_change(planner) * planner.period() > 8.0 * f64::EPSILON * position.abs()
}

/// Everything that one step must satisfy wherever it starts: the velocity does not move away from its limits, the
/// position does not pass the furthest point that braking at once from `takeover` reaches.
struct Watch<'a> {
    zone: &'a SafeZone<'a>,
    furthest: Interval,
}

impl<'a> Watch<'a> {
    fn new(zone: &'a SafeZone<'a>, (position, velocity): (f64, f64)) -> Self {
        let limits = zone.planner().limits().position();
        let stop = position + velocity.signum() * zone.stopping_distance(velocity);
        let furthest = limits.including(stop).including(position);
        // Half an ulp for every period of the way, however much faster than the limits it starts.
        let periods = velocity.abs() / least_change(zone.planner());
        let rounding = (periods + 16.0) * f64::EPSILON * furthest.min.abs().max(furthest.max.abs());
        let furthest = Interval::new(
            furthest.min - slack(zone, Side::Lower) - rounding,
            furthest.max + slack(zone, Side::Upper) + rounding,
        );
        Self { zone, furthest }
    }

    /// One step; the state after it and the status before it.
    fn step(
        &self,
        (position, velocity): (f64, f64),
        action: f64,
    ) -> Result<((f64, f64), RangeStatus), TestCaseError> {
        let planner = self.zone.planner();
        let command = self.zone.command(position, velocity, action);
        let step = planner.ramp(position, velocity, command.velocity)?;
        let at = format!("from ({position:e}, {velocity:e}): {command:?}");
        let extrema = step.extrema();
        let (limits, bounds) = (planner.limits().position(), planner.velocity());
        for (found, limit, name) in [
            (extrema.acceleration, planner.limits().acceleration(), "acceleration"),
            (extrema.jerk, planner.limits().jerk(), "jerk"),
            (extrema.velocity, planner.limits().velocity().including(velocity), "velocity"),
            (extrema.position, self.furthest, "position"),
        ] {
            // Positions have their slack already; the sine's velocity passes even a start that is beyond its limit.
            let room = match name {
                "position" => 0.0,
                "velocity" if planner.spec().shape == Shape::SineQuintic && !bounds.contains(velocity) => {
                    3e-5 * limit.width()
                }
                _ => tolerance::LIMIT * limit.width(),
            };
            prop_assert!(
                limit.min - room <= found.min && found.max <= limit.max + room,
                "{name} {found:?} leaves {limit:?} {at}"
            );
        }
        let next = step.end();
        if !bounds.contains(velocity) {
            let (nearest, speed) = (planner.velocity().clamp(next.velocity), next.velocity.abs());
            prop_assert!(bounds.contains(next.velocity) || speed < velocity.abs(), "speeds up {at}");
            prop_assert!(nearest == next.velocity || command.range.min == command.range.max, "{at}");
        }
        // Once it does not move out any more it comes back, if double precision can tell.
        if !is_resolved(planner, position) {
            return Ok(((next.position, next.velocity), command.range.status));
        }
        if position > limits.max && velocity <= 0.0 && command.range.status == RangeStatus::PositionOutside {
            prop_assert!(next.position < position, "goes further out {at}");
            let overshoot = slack(self.zone, Side::Upper);
            prop_assert!(extrema.position.max <= position + overshoot, "{extrema:?} {at}");
        }
        if position < limits.min && velocity >= 0.0 && command.range.status == RangeStatus::PositionOutside {
            prop_assert!(next.position > position, "goes further out {at}");
            let overshoot = slack(self.zone, Side::Lower);
            prop_assert!(extrema.position.min >= position - overshoot, "{extrema:?} {at}");
        }
        Ok(((next.position, next.velocity), command.range.status))
    }

    /// Steps until the status is `Safe`; then it stays `Safe` for `after` steps.
    fn recover(
        &self,
        mut state: (f64, f64),
        mut action: impl FnMut() -> f64,
        (most, after): (usize, usize),
    ) -> Result<(f64, f64), TestCaseError> {
        let mut safe_since = None;
        for i in 0..most + after {
            let (next, status) = self.step(state, action())?;
            state = next;
            match (safe_since, status) {
                (None, RangeStatus::Safe) => safe_since = Some(i),
                (Some(_), RangeStatus::Safe) | (None, _) => {}
                (Some(since), _) => {
                    prop_assert!(false, "safe since step {since}, but {status:?} in step {i} at {state:?}");
                }
            }
            if safe_since.is_some_and(|since| i >= since + after) {
                return Ok(state);
            }
        }
        prop_assert!(safe_since.is_some(), "not back after {most} steps: {state:?}");
        Ok(state)
    }
}

/// `planner` with every limit made smaller by its share; the position interval shrinks towards `centre`, a share of it.
fn lowered(planner: &Planner, shares: [f64; 4], centre: f64) -> Option<Planner> {
    let limits = planner.limits();
    let scaled = |interval: Interval, share| Interval::new(interval.min * share, interval.max * share);
    let position = limits.position();
    let centre = position.min + centre * position.width();
    let spec = LimitsSpec {
        position: Interval::new(
            centre - shares[0] * (centre - position.min),
            centre + shares[0] * (position.max - centre),
        ),
        velocity: scaled(limits.velocity(), shares[1]),
        acceleration: scaled(limits.acceleration(), shares[2]),
        jerk: scaled(limits.jerk(), shares[3]),
    };
    let limits = Limits::try_from(spec).ok()?;
    Planner::try_from(PlannerSpec { limits, ..*planner.spec() }).ok()
}

fn actions() -> impl Strategy<Value = (u8, u64)> {
    (0..4_u8, any::<u64>())
}

/// Held ±1, bang-bang or random actions.
fn policy((kind, seed): (u8, u64)) -> impl FnMut() -> f64 {
    let mut noise = Noise(seed);
    move || match kind {
        0 => 1.0,
        1 => -1.0,
        2 => (noise.unit() - 0.5).signum(),
        _ => 2.0 * noise.unit() - 1.0,
    }
}

/// Periods that the way back may take: a stop, and the way at half of what a period can reach from rest.
fn most_steps(zone: &SafeZone<'_>, (position, velocity): (f64, f64)) -> f64 {
    let planner = zone.planner();
    let limits = planner.limits().position();
    let slowest = least_change(planner).min(planner.velocity().max).min(-planner.velocity().min);
    let stop = position + velocity.signum() * zone.stopping_distance(velocity);
    let out = (stop - limits.max).max(limits.min - stop).max(0.0);
    velocity.abs() / least_change(planner) + out / (0.5 * slowest * planner.period()) + 20.0
}

fn shares() -> impl Strategy<Value = [f64; 4]> {
    let share = || prop_oneof![1 => Just(1.0), 2 => 0.05..1.0];
    [share(), share(), share(), share()]
}

proptest! {
    #![proptest_config(ProptestConfig { max_global_rejects: u32::MAX, ..ProptestConfig::with_cases(1000) })]

    #[test]
    fn a_start_outside_comes_back_monotonically_and_stays(
        planner in planners(),
        upper in any::<bool>(),
        (excess, speed) in (prop_oneof![1e-9..1.0, Just(1e-11)], prop_oneof![Just(0.0), -1.0..1.0, -1e-3..1e-3]),
        action in actions(),
    ) {
        let Ok(zone) = SafeZone::closed_form(planner) else { return Ok(()) };
        let (limits, bounds) = (planner.limits().position(), planner.velocity());
        let position = if upper { limits.max + excess * limits.width() } else { limits.min - excess * limits.width() };
        let mut velocity = if speed > 0.0 { speed * bounds.max } else { -speed * bounds.min };
        // Not so fast that the opposite limit cannot be kept.
        while zone.stopping_distance(velocity) > 0.5 * limits.width() {
            velocity *= 0.5;
        }
        let most = most_steps(&zone, (position, velocity));
        prop_assume!(most < 3000.0 && is_resolved(&planner, position));
        prop_assert_ne!(zone.range(position, velocity).status, RangeStatus::Safe);
        let watch = Watch::new(&zone, (position, velocity));
        watch.recover((position, velocity), policy(action), (most as usize, 50))?;
    }

    #[test]
    fn limits_lowered_again_and_again_while_moving_are_kept_again(
        planner in planners(),
        start in (0.0..=1.0, 0.0..=1.0),
        changes in prop::collection::vec((shares(), 0.0..=1.0_f64, 0..40_usize), 1..4),
        action in actions(),
    ) {
        let Ok(zone) = SafeZone::closed_form(planner) else { return Ok(()) };
        let mut state = safe_state(&zone, start);
        let mut act = policy(action);
        let mut current = planner;
        let watch = Watch::new(&zone, state);
        for _ in 0..10 {
            state = watch.step(state, act())?.0;
        }
        let last = changes.len() - 1;
        for (i, (shares, centre, steps)) in changes.into_iter().enumerate() {
            let Some(next) = lowered(&current, shares, centre) else { return Ok(()) };
            let Ok(zone) = SafeZone::closed_form(next) else { return Ok(()) };
            current = next;
            let watch = Watch::new(&zone, state);
            let most = most_steps(&zone, state);
            if i == last && most < 3000.0 && is_resolved(&next, state.0) {
                state = watch.recover(state, &mut act, (2 * most as usize, 50))?;
            } else {
                for _ in 0..steps {
                    state = watch.step(state, act())?.0;
                }
            }
        }
    }
}

/// The worked example: half the speed, while the policy keeps pushing.
#[test]
fn a_lowered_velocity_limit_is_reached_without_a_dip() {
    for (shape, timing) in telescope::ALL {
        let zone = SafeZone::closed_form(telescope::planner(shape, timing)).unwrap();
        let mut state = (0.2, 0.0);
        for _ in 0..10 {
            let velocity = zone.command(state.0, state.1, 1.0).velocity;
            let end = zone.planner().ramp(state.0, state.1, velocity).unwrap().end();
            state = (end.position, end.velocity);
        }
        let planner = lowered(zone.planner(), [1.0, 0.5, 1.0, 1.0], 0.5).unwrap();
        let slow = SafeZone::closed_form(planner).unwrap();
        let (top, mut statuses) = (planner.velocity().max, vec![]);
        for _ in 0..8 {
            let command = slow.command(state.0, state.1, 1.0);
            statuses.push(command.range.status);
            assert!(
                command.velocity <= state.1 && command.velocity >= top,
                "{shape:?} {timing:?} {command:?}"
            );
            let step = planner.ramp(state.0, state.1, command.velocity).unwrap();
            state = (step.end().position, step.end().velocity);
        }
        assert_eq!(state.1, top);
        let change = planner.authority(Direction::Decreasing).velocity_change;
        let periods = ((0.15 - top) / change).ceil() as usize;
        assert!(
            statuses[..periods].iter().all(|status| *status == RangeStatus::VelocityOutside),
            "{statuses:?}"
        );
        assert!(statuses[periods..].iter().all(|status| *status == RangeStatus::Safe), "{statuses:?}");
    }
}

/// A limit is put 5 mm in front of a joint that needs 16 mm to stop.
#[test]
fn a_limit_lowered_in_front_of_the_joint_goes_through_every_status_in_order() {
    for (shape, timing) in telescope::ALL {
        let fast = telescope::planner(shape, timing);
        let (position, velocity) = (0.3, fast.velocity().max);
        let limits = LimitsSpec {
            position: Interval::new(0.14, position + 0.005),
            velocity: Interval::symmetric(0.12),
            ..(*fast.limits()).into()
        };
        let limits = Limits::try_from(limits).unwrap();
        let zone = SafeZone::closed_form(Planner::try_from(PlannerSpec { limits, ..*fast.spec() }).unwrap())
            .unwrap();
        let watch = Watch::new(&zone, (position, velocity));
        let (mut state, mut seen) = ((position, velocity), vec![]);
        for _ in 0..40 {
            let (next, status) = watch.step(state, 1.0).unwrap();
            if seen.last() != Some(&status) {
                seen.push(status);
            }
            state = next;
        }
        let expected = [RangeStatus::CannotStop, RangeStatus::PositionOutside, RangeStatus::Safe];
        assert_eq!(seen, expected, "{shape:?} {timing:?}");
        let left = position + 0.005 - state.0;
        assert!(left >= 0.0 && state.1 == 0.0, "{shape:?} {timing:?}: {left:e} m left");
        // Too fast, but with room enough.
        let range = zone.range(0.2, velocity);
        assert_eq!(range.status, RangeStatus::VelocityOutside);
        assert_eq!(zone.range(f64::NAN, velocity).status, RangeStatus::Unknown);
        assert!(range.max < velocity && range.max >= 0.11, "{range:?}");
    }
}

/// A turning step from outside: otherwise its turning point could lie beyond where braking at once stops, by a fastest step's
/// slower start or, from next to rest, by the sine's reversal.
#[test]
fn a_turning_step_from_outside_turns_no_later_than_braking() {
    for (shape, timing) in telescope::ALL {
        let planner = telescope::planner(shape, timing);
        let zone = SafeZone::closed_form(planner).unwrap();
        let slow = (1..=40).map(|i| 0.034 * 0.6_f64.powi(i));
        for velocity in (1..=300).map(|i| 0.034 * f64::from(i) / 300.0).chain(slow) {
            let position = 0.501;
            let range = zone.range(position, velocity);
            assert_eq!((range.max, range.status), (0.0, RangeStatus::PositionOutside));
            let peak = planner.ramp(position, velocity, range.min).unwrap().extrema().position.max;
            let excess = peak - (position + zone.stopping_distance(velocity));
            assert!(
                excess <= 4.0 * f64::EPSILON,
                "{shape:?} {timing:?} {velocity} m/s to {}: {excess:e} m",
                range.min
            );
            assert!(range.min < 0.0, "{shape:?} {timing:?} {velocity} m/s: braking is the only choice");
        }
    }
}
