//! Ranges against an oracle that knows nothing of closed forms: it judges one velocity at a time, by the planner's own
//! steps and their exact extrema, and halves.

use jbtg::strategies::planners;
use jbtg::{Interval, Planner, Shape, Timing};
use proptest::prelude::*;
use safezone::{BrakingTable, RangeStatus, SafeZone, Side};

use crate::adversary::safe_state;
use crate::telescope;

/// One limit in coordinates in which it is the upper one.
struct Judge<'a> {
    zone: &'a SafeZone<'a>,
    side: Side,
    sign: f64,
    /// State at the start of the step, mirrored.
    state: (f64, f64),
    /// Largest difference that rounding makes.
    rounding: f64,
}

impl<'a> Judge<'a> {
    fn new(zone: &'a SafeZone<'a>, side: Side, (position, velocity): (f64, f64)) -> Self {
        let sign = if side == Side::Upper { 1.0 } else { -1.0 };
        let limits = zone.planner().limits().position();
        let scale = limits.min.abs().max(limits.max.abs()).max(limits.width());
        let shape_guard = match zone.planner().spec().shape {
            Shape::Smoothstep => 0.0,
            Shape::SineQuintic => 2.0 * overshoot(zone.planner(), side),
        };
        // The guard holds half an ulp per braking step and sixteen for one range.
        let rounding = (zone.guard(side) - shape_guard).max(16.0 * f64::EPSILON * scale);
        Self { zone, side, sign, state: (sign * position, sign * velocity), rounding }
    }

    fn limit(&self) -> f64 {
        let limits = self.zone.planner().limits().position();
        if self.side == Side::Upper { limits.max } else { -limits.min }
    }

    fn distance(&self, velocity: f64) -> f64 {
        match self.zone.table() {
            Some(table) => table.distance(self.side, velocity),
            None => self.zone.stopping_distance(self.sign * velocity.max(0.0)),
        }
    }

    /// Room that is left, or negative what is lacking, once the joint has stopped after a step to `velocity`.
    fn room_after(&self, velocity: f64) -> f64 {
        let step = self.zone.planner().displacement(self.sign * self.state.1, self.sign * velocity);
        let room = self.limit() - self.zone.guard(self.side) - self.state.0;
        room - self.sign * step - self.distance(velocity)
    }

    /// Room within a step that is given away: where the shape's overshoot is what matters it is bounded, not solved
    /// for.
    fn margin(&self) -> f64 {
        let spec = self.zone.planner().spec();
        let is_solved = spec.timing == Timing::Fastest && self.state.1 > 0.0;
        let bounded = if is_solved { 0.0 } else { 2.0 * overshoot(self.zone.planner(), self.side) };
        bounded + self.rounding + 2e-13 * spec.limits.position().width()
    }

    /// Room between what is allowed and the furthest point of the step to `velocity`, its interior included.
    fn room_within(&self, velocity: f64) -> f64 {
        let (position, v1) = self.state;
        let Ok(step) = self.zone.planner().ramp(self.sign * position, self.sign * v1, self.sign * velocity)
        else {
            return f64::NEG_INFINITY;
        };
        let extrema = step.extrema().position;
        let peak = if self.side == Side::Upper { extrema.max } else { -extrema.min };
        let stop = position + self.zone.stopping_distance(self.sign * v1.max(0.0));
        let kept = self.limit() - 0.5 * self.zone.guard(self.side);
        kept.max(stop + 1e-13 * self.zone.planner().limits().position().width()) - peak
    }
}

fn overshoot(planner: &Planner, side: Side) -> f64 {
    let direction =
        if side == Side::Upper { jbtg::Direction::Decreasing } else { jbtg::Direction::Increasing };
    let authority = planner.authority(direction);
    authority.reverse_travel * authority.velocity_change
}

/// Checks both ends of the range from a safe state: what is in it is safe, and what is beyond it by a little is not or
/// cannot be reached.
fn check_range(zone: &SafeZone<'_>, (position, velocity): (f64, f64)) -> Result<(), TestCaseError> {
    let range = zone.range(position, velocity);
    prop_assert_eq!(range.status, RangeStatus::Safe);
    let reachable = zone.planner().reachable(velocity);
    let ends = [
        (range.max, range.min, Side::Upper, Interval::new(reachable.min, reachable.max)),
        (-range.min, -range.max, Side::Lower, reachable.mirrored()),
    ];
    for (max, min, side, reachable) in ends {
        let sign = if side == Side::Upper { 1.0 } else { -1.0 };
        let judge = Judge::new(zone, side, (position, velocity));
        let other_side = if side == Side::Upper { Side::Lower } else { Side::Upper };
        let other = Judge::new(zone, other_side, (position, velocity));
        let brake = sign * range.brake;
        prop_assert!(reachable.contains(max) && reachable.contains(min));
        let at = format!("{side:?} from ({position:e}, {velocity:e}): {range:?} of {reachable:?}");
        if max > brake {
            let room = judge.room_after(max);
            // `rounding.rs` allows one range 7 ulps and a sixteenth of the guard's N + 16: no more than half of these.
            prop_assert!(room >= -0.5 * judge.rounding, "{at}: {room:e} m lacking");
        }
        if min < brake {
            let room = judge.room_within(min);
            prop_assert!(room >= -0.5 * judge.rounding, "{at}: {room:e} m lacking within");
        }
        let change = reachable.width();
        let beyond = max + 1e-6 * change + 100.0 * judge.rounding / zone.planner().period();
        if beyond < reachable.max {
            let refused =
                judge.room_after(beyond) < judge.rounding || other.room_within(-beyond) < other.margin();
            prop_assert!(
                refused,
                "{at}: {beyond:e} is safe, too: {:e} m left at the end, {:e} m within",
                judge.room_after(beyond),
                other.room_within(-beyond)
            );
        }
    }
    Ok(())
}

fn shares() -> impl Strategy<Value = f64> {
    prop_oneof![1 => Just(0.0), 1 => Just(1.0), 5 => 0.0..=1.0]
}

proptest! {
    #![proptest_config(ProptestConfig { max_global_rejects: u32::MAX, ..ProptestConfig::with_cases(1000) })]

    #[test]
    fn a_range_is_as_wide_as_is_safe(planner in planners(), start in (shares(), shares())) {
        let Ok(zone) = SafeZone::closed_form(planner) else { return Ok(()) };
        check_range(&zone, safe_state(&zone, start))?;
    }

    #[test]
    fn a_range_is_as_wide_as_its_table_allows(planner in planners(), start in (shares(), shares())) {
        let Ok(table) = BrakingTable::build(&planner) else { return Ok(()) };
        let Ok(zone) = SafeZone::new(planner, table) else { return Ok(()) };
        check_range(&zone, safe_state(&zone, start))?;
    }

    /// Low speeds near the limit, where a step that turns around within its period turns too late.
    #[test]
    fn a_turning_step_turns_as_late_as_is_safe(
        (shape, timing) in prop::sample::select(telescope::ALL.to_vec()),
        start in (0.4..=0.6, 0.9..=1.0),
    ) {
        let zone = SafeZone::closed_form(telescope::planner(shape, timing)).unwrap();
        check_range(&zone, safe_state(&zone, start))?;
    }
}

#[test]
fn with_stretched_timing_a_table_gives_the_closed_forms_ranges() {
    for shape in [Shape::Smoothstep, Shape::SineQuintic] {
        let planner = telescope::planner(shape, Timing::Stretched);
        let closed = SafeZone::closed_form(planner).unwrap();
        let table = SafeZone::new(planner, BrakingTable::build(&planner).unwrap()).unwrap();
        for i in 0..=400 {
            for j in -30..=30 {
                let state = safe_state(&closed, (0.5 + f64::from(j) / 60.0, f64::from(i) / 400.0));
                let (a, b) = (closed.range(state.0, state.1), table.range(state.0, state.1));
                for (x, y) in [(a.min, b.min), (a.max, b.max), (a.brake, b.brake)] {
                    assert!((x - y).abs() <= 1e-13, "{shape:?} {state:?}: {a:?}, {b:?}");
                }
                assert_eq!(a.status, b.status);
            }
        }
    }
}
