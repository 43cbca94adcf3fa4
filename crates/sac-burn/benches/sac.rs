//! Speed of one agent on one thread: batch 128, 32 observations, 3 actions, as in `docs/sac.md`.
//!
//! Uses mimalloc, as a training binary should. `matmul_ceiling` is the same sequence of matrix products as one
//! update, and nothing else: no update can be faster on this backend.

use std::cell::LazyCell;
use std::hint::black_box;

use burn::tensor::{Device, Tensor, TensorData};
use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use sac_burn::{Agent, Batch, Config, ConfigSpec, Noise, Outcome, Replay, Transition};

#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const OBSERVATION: usize = 32;
const ACTION: usize = 3;
const BATCH: usize = 128;

/// An agent past its random phase, with `filled` transitions of pseudo-random content.
fn agent(hidden: usize, filled: usize) -> Agent {
    let spec = ConfigSpec {
        hidden: vec![hidden, hidden],
        random_steps: 0,
        update_after: BATCH,
        ..Config::table_1().spec().clone()
    };
    let config = Config::try_from(spec).expect("the configuration is valid");
    let mut agent = Agent::new(config, OBSERVATION, ACTION, 1).expect("there is memory for the replay");
    let mut observation = [0.1f32; OBSERVATION];
    let mut action = [0.0f32; ACTION];
    for step in 0..filled {
        let before = observation;
        for (i, x) in observation.iter_mut().enumerate() {
            *x = ((step * 31 + i * 17) as f32).sin();
        }
        action.fill_with(|| (step as f32 * 0.7).cos());
        let transition = Transition {
            observation: &before,
            action: &action,
            reward: -observation[0].abs(),
            next_observation: &observation,
            outcome: if step % 100 == 99 { Outcome::Terminal } else { Outcome::Continues },
        };
        agent.remember(&transition).expect("the transition is finite");
    }
    agent
}

fn update(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("update");
    group.throughput(Throughput::Elements(1));
    for hidden in [128, 256] {
        let mut agent = LazyCell::new(|| agent(hidden, 100_000));
        group.bench_function(format!("hidden_{hidden}"), |b| {
            let agent = LazyCell::force_mut(&mut agent);
            b.iter(|| black_box(agent.update()));
        });
    }
    group.finish();
}

fn act(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("act");
    let mut agent = agent(256, BATCH);
    let mut action = [0.0; ACTION];
    group.bench_function("stochastic", |b| b.iter(|| agent.act(black_box(&[0.3; OBSERVATION]), &mut action)));
    group.bench_function("deterministic", |b| {
        b.iter(|| agent.act_deterministic(black_box(&[0.3; OBSERVATION]), &mut action));
    });
    group.finish();
}

fn replay(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("replay");
    let mut replay = Replay::new(OBSERVATION, ACTION, 1_000_000).expect("there is memory for the replay");
    let transition = Transition {
        observation: &[0.1; OBSERVATION],
        action: &[0.2; ACTION],
        reward: 1.0,
        next_observation: &[0.3; OBSERVATION],
        outcome: Outcome::Continues,
    };
    for _ in 0..replay.capacity() {
        replay.push(&transition).expect("the transition is finite");
    }
    group.bench_function("push_when_full", |b| b.iter(|| replay.push(black_box(&transition))));
    let (mut noise, mut batch) = (Noise::new(1), Batch::default());
    group.bench_function("sample_128_of_a_million", |b| {
        b.iter(|| replay.sample(BATCH, &mut noise, &mut batch));
    });
    group.finish();
}

fn checkpoint(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("checkpoint");
    group.sample_size(10);
    let agent = agent(256, 100_000);
    let mut bytes = Vec::new();
    agent.save(&mut bytes).expect("memory can be written");
    group.throughput(Throughput::Bytes(bytes.len() as u64));
    group.bench_function("save", |b| {
        b.iter_batched_ref(
            || Vec::with_capacity(bytes.len()),
            |out| agent.save(out),
            BatchSize::PerIteration,
        );
    });
    group.bench_function("load", |b| b.iter(|| Agent::load(&mut black_box(bytes.as_slice()))));
    group.finish();
}

fn matmul_ceiling(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("matmul_ceiling");
    group.throughput(Throughput::Elements(1));
    for hidden in [128, 256] {
        let products = products_of_one_update(hidden);
        group.bench_function(format!("hidden_{hidden}"), |b| {
            b.iter(|| {
                for (lhs, rhs) in &products {
                    black_box(lhs.clone().matmul(rhs.clone()));
                }
            });
        });
    }
    group.finish();
}

/// Operands of every matrix product of one update, in the layouts that the update uses.
fn products_of_one_update(hidden: usize) -> Vec<(Tensor<3>, Tensor<3>)> {
    let device = Device::flex();
    let matrices = |members: usize, rows: usize, columns: usize| {
        let values: Vec<f32> = (0..members * rows * columns).map(|i| (i as f32).sin()).collect();
        Tensor::<3>::from_data(TensorData::new(values, [members, rows, columns]), &device)
    };
    let mut products = Vec::new();
    let mut forward = |members: usize, widths: &[usize]| {
        for (index, pair) in widths.windows(2).enumerate() {
            let shared = if index == 0 { 1 } else { members };
            products.push((matrices(shared, BATCH, pair[0]), matrices(members, pair[0], pair[1])));
        }
    };
    let (actor, critic) =
        ([OBSERVATION, hidden, hidden, 2 * ACTION], [OBSERVATION + ACTION, hidden, hidden, 1]);
    forward(1, &actor);
    forward(2, &critic);
    forward(2, &critic);
    forward(1, &actor);
    forward(2, &critic);
    for (members, widths, weights_too) in [(2, critic, true), (2, critic, false), (1, actor, true)] {
        for (index, pair) in widths.windows(2).enumerate() {
            if weights_too {
                let input = matrices(if index == 0 { 1 } else { members }, BATCH, pair[0]);
                products.push((input.swap_dims(1, 2), matrices(members, BATCH, pair[1])));
            }
            if index > 0 {
                let weights = matrices(members, pair[0], pair[1]);
                products.push((matrices(members, BATCH, pair[1]), weights.swap_dims(1, 2)));
            }
        }
    }
    let rows = matrices(2, ACTION, hidden);
    products.push((matrices(2, BATCH, hidden), rows.swap_dims(1, 2)));
    products
}

criterion_group!(benches, update, act, replay, checkpoint, matmul_ceiling);
criterion_main!(benches);
