//! Cost of one evaluation and of one step of the crane. Target: at most 4 µs per step of semi-implicit Euler, since
//! a policy step takes 100 of them.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use hiab_dynamics::{CraneModel, PlantFile, Wrench};

const URDF: &str = include_str!("../../../assets/hiab/hiab.urdf");
const LOOPS: &str = include_str!("../../../assets/hiab/hiab.ron");
const PLANTS: &str = include_str!("../../../assets/hiab/plants.ron");

fn plant(name: &str) -> CraneModel {
    let plants = PlantFile::from_ron(PLANTS).expect("a test parses the file");
    let model = CraneModel::from_urdf(URDF, LOOPS).expect("a test parses the files");
    model.with_plant(plants.plant(name).expect("a test looks it up")).expect("it fits the crane")
}

fn dynamics(c: &mut Criterion) {
    let position = [0.3, 0.3, 0.33, 0.3, -0.5, 0.2, 0.4];
    let velocity = [0.1, 0.05, -0.05, 0.1, 0.2, -0.1, 0.3];
    let effort = [0.0, 17e3, 9e3, -700.0, 32.0, 16.0, 4.0];
    let wrench = Wrench { force: [100.0, -50.0, -900.0], moment: [10.0, 20.0, -5.0] };
    let mut acceleration = [0.0; 7];

    let model = plant("rigid");
    let mut data = model.new_data();
    let mut group = c.benchmark_group("evaluate");
    group.bench_function("kinematics", |b| {
        b.iter(|| model.update_kinematics(&mut data, black_box(&position), &velocity));
    });
    group.bench_function("inverse_dynamics", |b| {
        b.iter(|| {
            model.inverse_dynamics(
                &mut data,
                black_box(&position),
                &velocity,
                &velocity,
                None,
                &mut acceleration,
            )
        });
    });
    group.bench_function("forward_dynamics", |b| {
        b.iter(|| {
            model.forward_dynamics(
                &mut data,
                black_box(&position),
                &velocity,
                &effort,
                None,
                &mut acceleration,
            )
        });
    });
    group.bench_function("forward_dynamics_with_wrench", |b| {
        let wrench = Some(&wrench);
        b.iter(|| {
            model.forward_dynamics(
                &mut data,
                black_box(&position),
                &velocity,
                &effort,
                wrench,
                &mut acceleration,
            )
        });
    });
    group.finish();

    let mut group = c.benchmark_group("step");
    for name in ["rigid", "electric", "hydraulic"] {
        let model = plant(name);
        group.bench_function(format!("semi_implicit_euler/{name}"), |b| {
            b.iter(|| {
                let (mut q, mut v) = (black_box(position), velocity);
                model.semi_implicit_euler(&mut data, &mut q, &mut v, &effort, None, 5e-4)
            });
        });
    }
    group.bench_function("rk4/electric", |b| {
        let model = plant("electric");
        b.iter(|| {
            let (mut q, mut v) = (black_box(position), velocity);
            model.rk4(&mut data, &mut q, &mut v, &effort, None, 5e-4)
        });
    });
    group.finish();
}

criterion_group!(benches, dynamics);
criterion_main!(benches);
