//! Cost of one joint's safe range and of one table lookup. Targets: 40 ns for a range at worst, with the default timing or from
//! samples, 8 ns for a lookup. With `Fastest` timing the closed form and a table have it solved by iteration.
//!
//! A case with several states goes through them in turn, so that branches are as hard to foresee as in a control loop.

use std::hint::black_box;

use criterion::{Bencher, Criterion, criterion_group, criterion_main};
use jbtg::{Interval, Limits, LimitsSpec, Planner, PlannerSpec, Shape, Timing};
use safezone::{BrakingTable, Request, SafeZone, Samples, Side};

const LONG: Interval = Interval::new(0.14, 0.50);
/// Two braking steps wide, so that both limits are near wherever the joint is.
const SHORT: Interval = Interval::new(0.14, 0.1435);
/// States per case.
const STATES: usize = 1024;

/// As strong in both directions.
const EQUAL: Interval = Interval::symmetric(1.0);
/// Braking before the upper limit is weaker than speeding up towards it.
const UNEQUAL: Interval = Interval::new(-0.3, 1.0);

/// The paper's joint with another position interval.
fn planner(position: Interval, shape: Shape, timing: Timing) -> Planner {
    planner_with(position, EQUAL, shape, timing)
}

/// And with other accelerations.
fn planner_with(position: Interval, acceleration: Interval, shape: Shape, timing: Timing) -> Planner {
    let (velocity, jerk) = (Interval::symmetric(0.15), Interval::symmetric(100.0));
    let limits = LimitsSpec { position, velocity, acceleration, jerk };
    let limits = Limits::try_from(limits).expect("the paper's limits");
    Planner::try_from(PlannerSpec { limits, shape, timing, period: 0.05 }).expect("the paper's period")
}

fn closed_form(planner: Planner, _: &mut Samples) -> SafeZone<'_> {
    SafeZone::closed_form(planner).expect("room to move")
}

fn with_samples(planner: Planner, samples: &mut Samples) -> SafeZone<'_> {
    SafeZone::sampled(planner, samples).expect("room to move")
}

fn with_table(planner: Planner, _: &mut Samples) -> SafeZone<'_> {
    SafeZone::new(planner, BrakingTable::build(&planner).expect("few knots")).expect("its own table")
}

/// One way to make a zone.
type Zone = fn(Planner, &mut Samples) -> SafeZone<'_>;

/// SplitMix64, uniform in [0, 1).
fn noise(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

/// States that an adversary leads to: full speed one way or the other for a random time, and a random action in every
/// fourth step.
fn adversarial(zone: &SafeZone<'_>) -> Vec<(f64, f64)> {
    let (mut seed, mut action) = (7, 1.0);
    let limits = zone.planner().limits().position();
    let (mut position, mut velocity) = (0.5 * (limits.min + limits.max), 0.0);
    let states = (0..STATES).map(|_| {
        if noise(&mut seed) < 0.05 {
            action = -action;
        }
        let random = 2.0 * noise(&mut seed) - 1.0;
        let chosen = if noise(&mut seed) < 0.25 { random } else { action };
        let command = zone.command(position, velocity, chosen);
        let step = zone.planner().ramp(position, velocity, command.velocity).expect("a safe velocity");
        let state = (position, velocity);
        (position, velocity) = (step.end().position, step.end().velocity);
        state
    });
    states.collect()
}

/// States on the upper end's very boundary: braking at once stops there.
fn braking(zone: &SafeZone<'_>) -> Vec<(f64, f64)> {
    let end = zone.planner().limits().position().max - zone.guard(Side::Upper);
    let state = |i| {
        let velocity = 0.15 * f64::from(i) / STATES as f64;
        (end - zone.stopping_distance(velocity), velocity)
    };
    (0..STATES as u32).map(state).collect()
}

fn time_ranges(b: &mut Bencher<'_>, zone: &SafeZone<'_>, states: &[(f64, f64)]) {
    let mut states = states.iter().cycle();
    b.iter(|| {
        let (position, velocity) = states.next().expect("a cycle");
        zone.range(black_box(*position), black_box(*velocity))
    });
}

fn range(c: &mut Criterion) {
    use Shape::{SineQuintic, Smoothstep};
    use Timing::{Fastest, Stretched};
    let mut group = c.benchmark_group("range");
    let long = SafeZone::closed_form(planner(LONG, Smoothstep, Stretched)).expect("room to move");
    group.bench_function("far", |b| time_ranges(b, &long, &[(0.3, 0.1)]));
    group.bench_function("near_upper", |b| time_ranges(b, &long, &[(0.497, 0.05)]));
    let cases: [(_, Zone); 3] =
        [("closed_form", closed_form), ("table", with_table), ("samples", with_samples)];
    for (distances, zone) in cases {
        let [mut samples, mut more] = [Samples::default(), Samples::default()];
        let short = zone(planner(SHORT, Smoothstep, Stretched), &mut samples);
        let states = adversarial(&short);
        group.bench_function(format!("worst/both_limits/{distances}"), |b| time_ranges(b, &short, &states));
        let long = zone(planner(LONG, Smoothstep, Stretched), &mut more);
        let states = braking(&long);
        group.bench_function(format!("worst/braking/{distances}"), |b| time_ranges(b, &long, &states));
        for (name, acceleration, shape, timing) in [
            ("fastest", EQUAL, Smoothstep, Fastest),
            ("fastest_unequal", UNEQUAL, Smoothstep, Fastest),
            ("sine", EQUAL, SineQuintic, Stretched),
            ("sine_fastest", EQUAL, SineQuintic, Fastest),
        ] {
            let long = zone(planner_with(LONG, acceleration, shape, timing), &mut samples);
            let short = zone(planner_with(SHORT, acceleration, shape, timing), &mut more);
            let states = adversarial(&long);
            group.bench_function(format!("{name}/{distances}"), |b| time_ranges(b, &long, &states));
            let states = adversarial(&short);
            group.bench_function(format!("{name}/{distances}/both_limits"), |b| {
                time_ranges(b, &short, &states);
            });
        }
    }
    group.finish();
}

fn command(c: &mut Criterion) {
    let mut samples = Samples::default();
    let zone = with_table(planner(LONG, Shape::Smoothstep, Timing::Stretched), &mut samples);
    let states = adversarial(&zone);
    let mut group = c.benchmark_group("command");
    for (name, request) in [("action", Request::Action(0.7)), ("missing", Request::Missing)] {
        let mut states = states.iter().cycle();
        group.bench_function(name, |b| {
            b.iter(|| {
                let (position, velocity) = states.next().expect("a cycle");
                zone.command(black_box(*position), black_box(*velocity), black_box(request))
            });
        });
    }
    group.finish();
}

fn table(c: &mut Criterion) {
    let mut group = c.benchmark_group("table");
    for (name, timing) in [("", Timing::Stretched), ("/fastest", Timing::Fastest)] {
        let table =
            BrakingTable::build(&planner(LONG, Shape::Smoothstep, timing)).expect("a table of a few knots");
        let mut seed = 3;
        let speeds: Vec<f64> = (0..STATES).map(|_| 0.15 * noise(&mut seed)).collect();
        let mut next = speeds.iter().cycle();
        group.bench_function(format!("distance{name}"), |b| {
            b.iter(|| table.distance(Side::Upper, black_box(*next.next().expect("a cycle"))));
        });
        let distances: Vec<f64> = speeds.iter().map(|v| table.distance(Side::Upper, *v)).collect();
        let mut next = distances.iter().cycle();
        group.bench_function(format!("max_velocity{name}"), |b| {
            b.iter(|| table.max_velocity(Side::Upper, black_box(*next.next().expect("a cycle"))));
        });
    }
    group.finish();
}

criterion_group!(benches, range, command, table);
criterion_main!(benches);
