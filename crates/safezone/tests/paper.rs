//! [P, § Safety Calculations]: what a naive reading of it does, and what this crate does instead.

use std::f64::consts::PI;

use jbtg::{Interval, Planner, Shape, Timing};
use safezone::{BrakingTable, RangeStatus, SafeRange, SafeZone, Samples, Side};

use crate::telescope::{ALL, POSITION, planner};
use crate::tolerance;

/// Where a naive reading takes its largest speed towards the limit from.
type MaxSpeed<'a> = &'a dyn Fn(f64) -> f64;

/// Braking distance of one continuous ramp to zero with the paper's numbers: [P, Alg. 1] or, from low speed,
/// [P, Alg. 2]. Both are symmetric in time, so the mean velocity is half the first.
fn continuous_distance(speed: f64) -> f64 {
    let (acceleration, jerk) = (1.0, 100.0);
    let dt_max = PI * acceleration / (2.0 * jerk);
    let duration = if speed > acceleration * dt_max {
        speed / acceleration + dt_max
    } else {
        2.0 * (PI * speed / (2.0 * jerk)).sqrt()
    };
    0.5 * speed * duration
}

fn continuous_max_speed(distance: f64) -> f64 {
    let (mut low, mut high) = (0.0, 10.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if continuous_distance(middle) <= distance { low = middle } else { high = middle }
    }
    low
}

/// [P, Eq. (3)] as it stands: the zone at the positions that the ends of the reachable range lead to.
fn naive_range(planner: &Planner, (position, velocity): (f64, f64), max_speed: MaxSpeed<'_>) -> (f64, f64) {
    let reachable = planner.reachable(velocity);
    let highest = position + planner.displacement(velocity, reachable.max);
    let lowest = position + planner.displacement(velocity, reachable.min);
    let max = reachable.max.min(max_speed(POSITION.max - highest));
    let min = reachable.min.max(-max_speed(lowest - POSITION.min));
    (min, max)
}

/// An agent that always pushes towards the upper limit, through naive ranges. Returns how far it gets beyond the limit
/// and how many ranges were empty.
fn push_naively(planner: &Planner, start: f64, max_speed: MaxSpeed<'_>) -> (f64, u32) {
    let (mut position, mut velocity, mut overrun, mut empty) = (start, 0.0, 0.0_f64, 0);
    for _ in 0..100 {
        let (min, max) = naive_range(planner, (position, velocity), max_speed);
        empty += u32::from(min > max);
        let step = planner
            .ramp(position, velocity, planner.reachable(velocity).clamp(max))
            .expect("a velocity clamped to what is reachable");
        overrun = overrun.max(step.extrema().position.max - POSITION.max);
        (position, velocity) = (step.end().position, step.end().velocity);
    }
    (overrun, empty)
}

/// The same agent through this crate's ranges: the largest overrun.
fn push_safely(zone: &SafeZone<'_>, start: f64) -> f64 {
    let (mut position, mut velocity, mut overrun) = (start, 0.0, f64::NEG_INFINITY);
    for _ in 0..100 {
        let range = zone.range(position, velocity);
        assert!(range.min <= range.max && range.status == RangeStatus::Safe, "{range:?}");
        let step = zone.planner().ramp(position, velocity, range.max).expect("a velocity of the range");
        overrun = overrun.max(step.extrema().position.max - POSITION.max);
        (position, velocity) = (step.end().position, step.end().velocity);
    }
    overrun
}

/// Start positions that end the approach at all phases of a period.
fn starts() -> impl Iterator<Item = f64> {
    (0..200).map(|i| 0.3 + f64::from(i) * 1e-4)
}

#[track_caller]
fn check_close(name: &str, found: f64, expected: f64, tolerance: f64) {
    let error = (found - expected).abs();
    assert!(error <= tolerance * expected.abs(), "{name}: found {found:e}, expected {expected:e}");
}

#[test]
fn one_continuous_ramp_promises_a_shorter_stop_than_steps_take() {
    let zone = SafeZone::closed_form(planner(Shape::SineQuintic, Timing::Fastest)).unwrap();
    check_close("continuous", continuous_distance(0.15), 0.01243, tolerance::PRINTED);
    check_close("stepwise", zone.stopping_distance(0.15), 0.01647, tolerance::PRINTED);
}

#[test]
fn a_table_of_continuous_ramps_overruns_the_limit_by_two_millimetres_and_empties_the_range() {
    let planner = planner(Shape::SineQuintic, Timing::Fastest);
    let (overrun, empty) = push_naively(&planner, 0.32, &continuous_max_speed);
    assert!((0.0019..0.0021).contains(&overrun), "overrun of {overrun} m");
    assert!(empty > 0, "no range was empty");
    // Other starts meet the limit at other phases of a period: at worst by all that the promise is too short.
    let worst =
        starts().map(|start| push_naively(&planner, start, &continuous_max_speed).0).fold(0.0, f64::max);
    check_close("worst overrun", worst, 0.01647 - 0.01243, 0.02);
}

#[test]
fn even_the_right_table_empties_the_range_when_read_at_the_position_of_the_largest_velocity() {
    for (shape, timing) in ALL {
        let planner = planner(shape, timing);
        let table = BrakingTable::build(&planner).unwrap();
        let max_speed = |distance| table.max_velocity(Side::Upper, distance);
        let empty: u32 = starts().map(|start| push_naively(&planner, start, &max_speed).1).sum();
        assert!(empty > 0, "{shape:?} {timing:?}");
    }
}

#[test]
fn ours_stops_at_the_limit_and_never_beyond() {
    for (shape, timing) in ALL {
        let planner = planner(shape, timing);
        let table = BrakingTable::build(&planner).unwrap();
        let mut samples = Samples::default();
        let closed_form = SafeZone::closed_form(planner).unwrap();
        let sampled = SafeZone::sampled(planner, &mut samples).unwrap();
        for zone in [closed_form, SafeZone::new(planner, table).unwrap(), sampled] {
            for start in starts() {
                let overrun = push_safely(&zone, start);
                let room = if shape == Shape::Smoothstep { 1e-12 } else { 1e-7 }; // its guard
                assert!(
                    overrun <= 0.0 && overrun > -room,
                    "{shape:?} {timing:?} from {start}: {overrun:e} m"
                );
            }
        }
    }
}

#[test]
fn a_fastest_step_that_changes_sign_turns_later_than_one_to_zero() {
    let planner = planner(Shape::SineQuintic, Timing::Fastest);
    let peak = |v1, v2| planner.ramp(0.0, v1, v2).expect("a reachable velocity").extrema().position.max;
    let mut worst = 0.0_f64;
    for i in 1..=200 {
        let v1 = 0.034 * f64::from(i) / 200.0;
        let reachable = planner.reachable(v1);
        for j in 1..=100 {
            let v2 = reachable.clamp(reachable.min * f64::from(j) / 100.0);
            worst = worst.max(peak(v1, v2) - peak(v1, 0.0));
        }
    }
    check_close("overshoot", worst, 2.2e-6, 0.03);
    // The ends alone look safe: no step below ends further out than one to zero.
    assert!(planner.displacement(0.02, -0.01) < planner.displacement(0.02, 0.0));
}

#[test]
fn an_action_maps_linearly_onto_the_range() {
    let range = SafeRange { min: -0.03, max: 0.05, brake: 0.0, narrowed: false, status: RangeStatus::Safe };
    for (action, velocity) in [(-1.0, -0.03), (-0.5, -0.01), (0.0, 0.01), (0.5, 0.03), (1.0, 0.05)] {
        assert!((range.map_action(action) - velocity).abs() <= 1e-16, "{action}"); // [P, Eq. (mapping)]
    }
    assert_eq!((range.map_action(-1.0), range.map_action(1.0)), (range.min, range.max));
    assert_eq!((range.map_action(-7.0), range.map_action(f64::INFINITY)), (range.min, range.max));
    assert_eq!(range.map_action(f64::NAN), range.brake);
}

#[test]
fn with_stretched_timing_the_table_is_the_closed_form() {
    let planner = planner(Shape::Smoothstep, Timing::Stretched);
    let table = BrakingTable::build(&planner).unwrap();
    let zone = SafeZone::closed_form(planner).unwrap();
    let delta = 0.035; // 1 m/s² times 50 ms less a ramp of 15 ms
    assert_eq!(table.knots(Side::Upper).len(), 6, "one knot per braking step, and zero");
    for i in 0..=1500 {
        let v = f64::from(i) * 1e-4;
        let n = (v / delta - 1e-9).ceil();
        let expected = 0.05 * ((n - 0.5) * v - delta * n * (n - 1.0) / 2.0).max(0.0);
        for (side, velocity) in [(Side::Upper, v), (Side::Lower, -v)] {
            for found in [table.distance(side, v), zone.stopping_distance(velocity)] {
                let error = (found - expected).abs();
                assert!(error <= tolerance::EXACT * 0.01, "{v} m/s: {found:e} for {expected:e}");
            }
            let inverse = table.max_velocity(side, table.distance(side, v));
            assert!((inverse - v).abs() <= tolerance::EXACT * 0.15, "{v} m/s: {inverse}");
        }
    }
}

#[test]
fn with_fastest_timing_the_table_errs_on_the_safe_side_only() {
    for shape in [Shape::Smoothstep, Shape::SineQuintic] {
        let planner = planner(shape, Timing::Fastest);
        let table = BrakingTable::build(&planner).unwrap();
        let zone = SafeZone::closed_form(planner).unwrap();
        for i in 0..=15_000 {
            let v = f64::from(i) * 1e-5;
            let excess = table.distance(Side::Upper, v) - zone.stopping_distance(v);
            assert!(excess >= -tolerance::EXACT * 0.01, "{v} m/s: too short by {excess:e} m");
            assert!(excess <= 2e-6, "{v} m/s: too long by {excess:e} m");
        }
    }
}

#[test]
fn a_range_is_what_one_period_can_reach_wherever_there_is_room() {
    for (shape, timing) in ALL {
        let planner = planner(shape, timing);
        let zone = SafeZone::closed_form(planner).unwrap();
        let (range, reachable) = (zone.range(0.32, 0.05), planner.reachable(0.05));
        assert_eq!(Interval::new(range.min, range.max), reachable);
        assert!(!range.narrowed);
        assert!(zone.range(0.499, 0.0).narrowed);
    }
}
