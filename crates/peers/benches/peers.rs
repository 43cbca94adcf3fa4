//! Planning, sampling and safe ranges, ours and the peers' in one run: `cargo bench -p peers`.
//!
//! Cases: from rest, a reversal, close to a limit; a step's first and last segment; a table's first and last knots. The first
//! plan and the last segment, `turning` and `last_knots` are the slow ones.
#![forbid(unsafe_code)]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use jbtg::Timing;
use peers::{RsRuckig, Ruckig, TELESCOPE, zone};
use safezone::{BrakingTable, Samples, Side};

const PERIOD: f64 = 0.05;

/// From rest, a change of sign, and close to a limit.
const CASES: [(&str, [f64; 3], f64); 3] = [
    ("rest", [0.30, 0.0, 0.0], 0.01),
    ("reversal", [0.30, 0.015, 0.0], -0.015),
    ("at_limit", [0.4999, 0.001, 0.0], 0.0),
];

fn plan_one_joint(c: &mut Criterion) {
    let mut group = c.benchmark_group("plan_one_joint");
    for (case, state, target) in CASES {
        for (name, timing) in [("jbtg_ramp", Timing::Stretched), ("jbtg_ramp_fastest", Timing::Fastest)] {
            let zone = zone(TELESCOPE, timing, PERIOD);
            group.bench_function(format!("{name}/{case}"), |b| {
                b.iter(|| {
                    let [position, velocity, _] = black_box(state);
                    // Looked at in place: the peers' plans stay where they are, too.
                    let _ = black_box(&zone.planner().ramp(position, velocity, black_box(target)));
                });
            });
        }
        let mut peer = RsRuckig::new(TELESCOPE, PERIOD);
        group.bench_function(format!("rsruckig_velocity/{case}"), |b| {
            b.iter(|| peer.plan(black_box(state), black_box(target)));
        });
        let mut peer = RsRuckig::new(TELESCOPE, PERIOD);
        (peer.input.min_position, peer.input.max_position) = (None, None);
        group.bench_function(format!("rsruckig_velocity_without_limits/{case}"), |b| {
            b.iter(|| peer.plan(black_box(state), black_box(target)));
        });
        let mut peer = Ruckig::new(TELESCOPE, PERIOD);
        group.bench_function(format!("ruckig_velocity/{case}"), |b| {
            b.iter(|| peer.plan(black_box(state), black_box(target)));
        });
    }
    group.finish();
}

fn state_at(c: &mut Criterion) {
    let mut group = c.benchmark_group("state_at");
    let zone = zone(TELESCOPE, Timing::Fastest, PERIOD);
    let step = zone.planner().ramp(0.30, 0.02, -0.01).expect("one period suffices");
    let mut rs = RsRuckig::new(TELESCOPE, PERIOD);
    let mut cpp = Ruckig::new(TELESCOPE, PERIOD);
    assert!(rs.plan([0.30, 0.02, 0.0], -0.01) && cpp.plan([0.30, 0.02, 0.0], -0.01));
    for (case, time) in [("first_segment", 0.001), ("last_segment", 0.045)] {
        group.bench_function(format!("jbtg_with_jerk/{case}"), |b| b.iter(|| step.state_at(black_box(time))));
        group.bench_function(format!("rsruckig/{case}"), |b| b.iter(|| rs.at(black_box(time))));
        group.bench_function(format!("ruckig/{case}"), |b| b.iter(|| cpp.at(black_box(time))));
    }
    group.finish();
}

fn safe_range(c: &mut Criterion) {
    let mut group = c.benchmark_group("safe_range");
    for (name, timing) in [("stretched", Timing::Stretched), ("fastest", Timing::Fastest)] {
        let closed = zone(TELESCOPE, timing, PERIOD);
        let table = BrakingTable::build(closed.planner()).expect("few knots");
        let tabled = safezone::SafeZone::new(*closed.planner(), table).expect("the table is of this planner");
        let mut samples = Samples::default();
        let sampled = safezone::SafeZone::sampled(*closed.planner(), &mut samples).expect("room to move");
        for (case, position, velocity) in
            [("free", 0.30, 0.05), ("near_limit", 0.492, 0.10), ("turning", 0.499_985, 0.002)]
        {
            for (source, zone) in [("closed_form", &closed), ("table", &tabled), ("samples", &sampled)] {
                group.bench_function(format!("{name}_{source}/{case}"), |b| {
                    b.iter(|| zone.range(black_box(position), black_box(velocity)));
                });
            }
        }
    }
    group.finish();
}

fn table_lookup(c: &mut Criterion) {
    let planner = *zone(TELESCOPE, Timing::Stretched, 0.02).planner();
    let table = BrakingTable::build(&planner).expect("few knots");
    let mut group = c.benchmark_group("table_lookup");
    for (case, distance, speed) in [("first_knots", 1e-5, 1e-3), ("last_knots", 0.015, 0.149)] {
        group.bench_function(format!("max_velocity/{case}"), |b| {
            b.iter(|| table.max_velocity(Side::Upper, black_box(distance)));
        });
        group.bench_function(format!("distance/{case}"), |b| {
            b.iter(|| table.distance(Side::Upper, black_box(speed)));
        });
    }
    group.finish();
}

criterion_group!(benches, plan_one_joint, state_at, safe_range, table_lookup);
criterion_main!(benches);
