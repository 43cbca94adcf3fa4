//! Cost of planning, sampling and judging one period of one joint. Targets: 70 ns to plan, 10 ns for a state, 250 ns for
//! exact extrema, a few for what the safe range asks; the worst case of each counts.

use std::hint::black_box;

use criterion::{BenchmarkGroup, Criterion, criterion_group, criterion_main, measurement::WallTime};
use jbtg::{
    Direction, Interval, Limits, LimitsSpec, MAX_SEGMENTS, Planner, PlannerSpec, Shape, Timing, Trajectory,
};

/// The paper's telescope, with limits that differ between the directions.
fn planner(shape: Shape, timing: Timing) -> Planner {
    let limits = Limits::try_from(LimitsSpec {
        position: Interval::new(0.14, 0.50),
        velocity: Interval::new(-0.12, 0.15),
        acceleration: Interval::new(-0.8, 1.0),
        jerk: Interval::new(-80.0, 100.0),
    })
    .expect("limits around zero");
    Planner::try_from(PlannerSpec { limits, shape, timing, period: 0.05 }).expect("a period of many ramps")
}

/// Steps to plan: velocities spread evenly over their limits, and from each the `shares` of what it can reach, so that no
/// two in a row take the same way through the code.
fn steps(planner: &Planner, shares: Interval) -> Vec<(f64, f64, f64)> {
    let fraction = |i: u32, ratio: f64| (f64::from(i) * ratio).fract();
    let step = |i| {
        let v1 = within(planner.velocity(), fraction(i, 0.618_033_988_749_895));
        let share = within(shares, fraction(i, 0.754_877_666_246_693));
        (0.3, v1, within(planner.reachable(v1), share))
    };
    (0..256).map(step).collect()
}

fn within(interval: Interval, share: f64) -> f64 {
    interval.clamp(interval.min + share * interval.width())
}

/// Runs `operation` over `inputs` in turn. Its result is looked at in place: a trajectory takes half a kilobyte, and moving
/// it would be measured too.
fn over<I, O>(
    group: &mut BenchmarkGroup<'_, WallTime>,
    case: &str,
    inputs: &[I],
    mut operation: impl FnMut(&I) -> O,
) {
    let mut index = 0;
    group.bench_function(case, |b| {
        b.iter(|| {
            index = if index + 1 < inputs.len() { index + 1 } else { 0 };
            let _ = black_box(&operation(black_box(&inputs[index])));
        });
    });
}

const WHOLE: Interval = Interval::new(0.0, 1.0);

/// Every combination, and what its steps look like.
fn cases() -> [(&'static str, Planner, Interval); 5] {
    [
        ("stretched", planner(Shape::Smoothstep, Timing::Stretched), WHOLE),
        ("fastest_msap", planner(Shape::Smoothstep, Timing::Fastest), Interval::new(0.95, 1.0)),
        ("fastest_map", planner(Shape::Smoothstep, Timing::Fastest), Interval::new(0.48, 0.52)),
        ("sine", planner(Shape::SineQuintic, Timing::Stretched), WHOLE),
        ("worst", planner(Shape::SineQuintic, Timing::Fastest), WHOLE),
    ]
}

fn planned(planner: &Planner, steps: &[(f64, f64, f64)]) -> Vec<Trajectory> {
    let ramp = |(p, v1, v2): &(f64, f64, f64)| planner.ramp(*p, *v1, *v2).expect("a reachable velocity");
    steps.iter().map(ramp).collect()
}

fn ramp(c: &mut Criterion) {
    let mut group = c.benchmark_group("ramp");
    for (case, planner, shares) in cases() {
        over(&mut group, case, &steps(&planner, shares), |(p, v1, v2)| planner.ramp(*p, *v1, *v2));
    }
}

/// Detours of ten periods of the telescope, whose jerk bounds differ: `farthest` iterates for the one direction alone.
fn detours(c: &mut Criterion) {
    let limits = *planner(Shape::Smoothstep, Timing::Stretched).limits();
    let spec = PlannerSpec { limits, shape: Shape::Smoothstep, timing: Timing::Stretched, period: 0.5 };
    let planner = Planner::try_from(spec).expect("a period of many ramps");
    let steps = steps(&planner, WHOLE);
    for (query, farthest) in [("waypoint", false), ("farthest", true)] {
        let mut group = c.benchmark_group(query);
        for (case, direction) in
            [("increasing", Direction::Increasing), ("decreasing", Direction::Decreasing)]
        {
            over(&mut group, case, &steps, |&(p, v1, v2)| {
                if farthest {
                    planner.farthest(p, v1, v2, direction)
                } else {
                    planner.waypoint_towards(p, v1, v2, direction)
                }
            });
        }
    }
}

fn state_at(c: &mut Criterion) {
    let mut group = c.benchmark_group("state_at");
    let planner = planner(Shape::Smoothstep, Timing::Fastest);
    let step = planner.ramp(0.3, 0.0, 0.03).expect("a reachable velocity");
    assert_eq!(step.segments().len(), 4, "a step of four phases");
    let (first, last) = (step.segments()[0], step.segments()[3]);
    let times =
        |from: f64, duration: f64| (0..64).map(|i| from + duration * f64::from(i) / 64.0).collect::<Vec<_>>();
    over(&mut group, "first_phase", &times(0.0, first.duration()), |time| step.state_at(*time));
    over(&mut group, "last_phase", &times(last.start(), last.duration()), |time| step.state_at(*time));
    // A detour has the most phases, and a search from the last one passes them all.
    let limits = *planner.limits();
    let spec = PlannerSpec { limits, shape: Shape::Smoothstep, timing: Timing::Stretched, period: 0.6 };
    let slow = Planner::try_from(spec).expect("a period of many ramps");
    let detour = slow.waypoint(0.3, 0.0, 0.0).expect("a reachable velocity");
    assert_eq!(detour.segments().len(), MAX_SEGMENTS, "a detour of seven phases");
    let first = times(0.0, detour.segments()[0].duration());
    over(&mut group, "first_of_seven", &first, |time| detour.state_at(*time));
    let mixed: Vec<f64> =
        (0..256).map(|i| 0.05 * (f64::from(i) * 0.618_033_988_749_895_f64).fract()).collect();
    over(&mut group, "any_phase", &mixed, |time| step.state_at(*time));
}

fn extrema(c: &mut Criterion) {
    let mut group = c.benchmark_group("extrema");
    for (case, planner, shares) in cases() {
        over(&mut group, case, &planned(&planner, &steps(&planner, shares)), Trajectory::extrema);
    }
    let turning = planner(Shape::SineQuintic, Timing::Fastest);
    let steps: Vec<_> = (1..64).map(|i| (0.3, 0.0002 * f64::from(i), -0.0002 * f64::from(i))).collect();
    over(&mut group, "sine_turning", &planned(&turning, &steps), Trajectory::extrema);
}

fn queries(c: &mut Criterion) {
    for query in ["reachable", "displacement"] {
        let mut group = c.benchmark_group(query);
        for (case, planner, shares) in cases() {
            let steps = steps(&planner, shares);
            match query {
                "reachable" => over(&mut group, case, &steps, |(_, v1, _)| planner.reachable(*v1)),
                _ => over(&mut group, case, &steps, |(_, v1, v2)| planner.displacement(*v1, *v2)),
            }
        }
    }
}

criterion_group!(benches, ramp, detours, state_at, extrema, queries);
criterion_main!(benches);
