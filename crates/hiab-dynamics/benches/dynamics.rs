//! Cost of one evaluation, of one tick of the whole loop, and of a second of the crane's life.
//!
//! Targets on one core: `forward_dynamics/crane` 2.0 µs, γ, G and ġ included; `tick/seven_adaptive_controllers` 3 µs;
//! `second_of_life/*` 8 ms. `forward_dynamics/chain_*` shows how the cost grows with the number of joints.

use std::hint::black_box;

use adaptive_ctrl::{
    AdaptiveController, Bounds, EffortLimits, GainTable, InverseInertia, JointController, JointSpec,
    Measurement, Reference,
};
use criterion::{Criterion, criterion_group, criterion_main};
use hiab_dynamics::{CraneModel, Data, PlantFile, Wrench};

#[path = "../tests/support/mod.rs"]
mod support;

use support::{PLANTS, crane, excavator, position_at, random, velocity_at};

const GAINS: &str = include_str!("../../../assets/hiab/gains.ron");

/// Ticks per second of the crane's life.
const HZ: u32 = 2000;
const PERIOD: f64 = 1.0 / HZ as f64;

fn plant(name: &str) -> CraneModel {
    let plants = PlantFile::from_ron(PLANTS).expect("a test parses the file");
    crane().with_plant(plants.plant(name).expect("a test looks it up")).expect("it fits the crane")
}

fn evaluations(c: &mut Criterion) {
    let machines = [
        ("crane", crane()),
        ("excavator", excavator()),
        ("chain_7", random::chain(7)),
        ("chain_14", random::chain(14)),
        ("chain_28", random::chain(28)),
    ];
    type Evaluation = fn(&CraneModel, &mut Data, &[f64], &[f64], &mut [f64]);
    let evaluations: [(&str, Evaluation); 4] = [
        ("kinematics", |model, data, y, v, _| model.update_kinematics(data, y, v).expect("in range")),
        ("inverse_dynamics", |model, data, y, v, out| {
            model.inverse_dynamics(data, y, v, v, None, out).expect("in range");
        }),
        ("forward_dynamics", |model, data, y, v, out| {
            model.forward_dynamics(data, y, v, v, None, out).expect("in range");
        }),
        ("forward_dynamics_with_wrench", |model, data, y, v, out| {
            let wrench = Wrench { force: [100.0, -50.0, -900.0], moment: [10.0, 20.0, -5.0] };
            model.forward_dynamics(data, y, v, v, Some(&wrench), out).expect("in range");
        }),
    ];
    for (operation, evaluate) in evaluations {
        let mut group = c.benchmark_group(operation);
        for (case, model) in &machines {
            let n = model.actuators().len();
            let share: Vec<f64> = (0..n).map(|i| 0.3 + 0.05 * (i % 5) as f64).collect();
            let (position, velocity) = (position_at(model, &share), velocity_at(model, &share));
            let (mut data, mut out) = (model.new_data(), vec![0.0; n]);
            group.bench_function(*case, |b| {
                b.iter(|| evaluate(model, &mut data, black_box(&position), &velocity, &mut out));
            });
        }
        group.finish();
    }
}

fn steps(c: &mut Criterion) {
    let position = [0.3, 0.3, 0.33, 0.3, -0.5, 0.2, 0.4];
    let velocity = [0.1, 0.05, -0.05, 0.1, 0.2, -0.1, 0.3];
    let effort = [0.0, 17e3, 9e3, -700.0, 32.0, 16.0, 4.0];
    let mut group = c.benchmark_group("semi_implicit_euler");
    for name in ["rigid", "electric", "hydraulic"] {
        let model = plant(name);
        let mut data = model.new_data();
        group.bench_function(name, |b| {
            b.iter(|| {
                let (mut q, mut v) = (black_box(position), velocity);
                model.semi_implicit_euler(&mut data, &mut q, &mut v, &effort, None, PERIOD)
            });
        });
    }
    group.finish();
    let mut group = c.benchmark_group("rk4");
    let model = plant("electric");
    let mut data = model.new_data();
    group.bench_function("electric", |b| {
        b.iter(|| {
            let (mut q, mut v) = (black_box(position), velocity);
            model.rk4(&mut data, &mut q, &mut v, &effort, None, PERIOD)
        });
    });
    group.finish();
}

/// The crane under its seven controllers, lift, tilt and telescope on a slow swing.
struct Loop {
    model: CraneModel,
    data: Data,
    of_reference: Data,
    controllers: Vec<AdaptiveController>,
    middle: Vec<f64>,
    position: Vec<f64>,
    velocity: Vec<f64>,
    effort: Vec<f64>,
    expected: [Vec<f64>; 4],
    tick: u64,
}

impl Loop {
    fn new() -> Self {
        let model = plant("electric");
        let gains: GainTable = ron::from_str(GAINS).expect("a test parses the file");
        let names: Vec<&str> = model.actuators().iter().map(hiab_dynamics::Actuator::name).collect();
        let gains = gains.in_order(&names).expect("a test looks them up");
        let middle = position_at(&model, &[0.5; 7]);
        let (mut data, mut inverse) = (model.new_data(), vec![0.0; 7]);
        model.update_dynamics(&mut data, &middle, &[0.0; 7]).expect("in range");
        model.inverse_effective_inertia(&mut data, &mut inverse).expect("regular");
        let controllers =
            gains.into_iter().zip(&inverse).zip(model.actuators()).map(|((gains, a), actuator)| {
                let bounds = Bounds { lower: *a, upper: *a };
                let spec = JointSpec {
                    period: PERIOD,
                    inverse_inertia: InverseInertia::try_from(bounds).expect("positive"),
                    effort_limits: EffortLimits::symmetric(actuator.effort_limit()).expect("positive"),
                };
                AdaptiveController::new(gains, spec).expect("stable in the middle of the range")
            });
        Self {
            controllers: controllers.collect(),
            of_reference: model.new_data(),
            data,
            position: middle.clone(),
            velocity: vec![0.0; 7],
            effort: vec![0.0; 7],
            expected: std::array::from_fn(|_| vec![0.0; 7]),
            middle,
            tick: 0,
            model,
        }
    }

    /// One tick: seven controllers, dynamics, semi-implicit Euler; and the inverse dynamics of the reference, if the
    /// controllers are told what a model expects.
    fn tick(&mut self, feedforward: bool) {
        let time = self.tick as f64 * PERIOD;
        let [wanted, rate, second, effort] = &mut self.expected;
        wanted.copy_from_slice(&self.middle);
        let (s, c) = (0.5 * time).sin_cos();
        for k in 1..4 {
            (wanted[k], rate[k], second[k]) = (self.middle[k] + 0.1 * s, 0.05 * c, -0.025 * s);
        }
        if feedforward {
            let (model, data) = (&self.model, &mut self.of_reference);
            model.inverse_dynamics(data, wanted, rate, second, None, effort).expect("in range");
        }
        for (k, controller) in self.controllers.iter_mut().enumerate() {
            let reference = Reference {
                position: wanted[k],
                velocity: rate[k],
                acceleration: second[k],
                effort: effort[k],
            };
            let measured = Measurement { position: self.position[k], velocity: self.velocity[k] };
            self.effort[k] = controller.step(reference, measured).effort;
        }
        let (position, velocity) = (&mut self.position, &mut self.velocity);
        self.model
            .semi_implicit_euler(&mut self.data, position, velocity, &self.effort, None, PERIOD)
            .expect("the controllers keep the crane in range");
        self.tick += 1;
    }
}

const LAWS: [(&str, bool); 2] = [("seven_adaptive_controllers", false), ("with_feedforward", true)];

fn whole_loop(c: &mut Criterion) {
    let mut group = c.benchmark_group("tick");
    for (name, feedforward) in LAWS {
        let mut life = Loop::new();
        group.bench_function(name, |b| b.iter(|| life.tick(feedforward)));
    }
    group.finish();
    let mut group = c.benchmark_group("second_of_life");
    group.sample_size(20);
    for (name, feedforward) in LAWS {
        let mut life = Loop::new();
        group.bench_function(name, |b| {
            b.iter(|| (0..HZ).for_each(|_| life.tick(feedforward)));
        });
    }
    group.finish();
}

criterion_group!(benches, evaluations, steps, whole_loop);
criterion_main!(benches);
