//! Agreement with the reference results in `testdata/golden/states.json`.
#![expect(clippy::unwrap_used, reason = "helpers of tests are tests too")]

mod support;

use std::collections::BTreeMap;

use hiab_dynamics::{CraneModel, Data, StateQuery};
use serde::Deserialize;
use support::{crane, distance, max_abs, tolerance};

#[derive(Deserialize)]
struct Golden {
    gravity: [f64; 3],
    actuated: Vec<String>,
    tree: Vec<String>,
    loops: BTreeMap<String, Triangle>,
    states: Vec<State>,
    trajectory: Trajectory,
}

/// A loop's two fixed sides, and its third at stroke zero.
#[derive(Deserialize)]
struct Triangle {
    a: f64,
    b: f64,
    l0: f64,
}

#[derive(Deserialize)]
struct State {
    #[serde(flatten)]
    query: StateQuery,
    tree_q: Vec<f64>,
    tree_v: Vec<f64>,
    tree_a: Vec<f64>,
    #[serde(rename = "G")]
    slope: Vec<Vec<f64>>,
    #[serde(rename = "g")]
    drift: Vec<f64>,
    tip_position: Vec<f64>,
    tip_rotation: Vec<Vec<f64>>,
    tip_quaternion_xyzw: [f64; 4],
    jacobian: Vec<Vec<f64>>,
    jacobian_dot_v: Vec<f64>,
    tip_velocity: Vec<f64>,
    tip_acceleration: Vec<f64>,
    mass_matrix: Vec<Vec<f64>>,
    bias: Vec<f64>,
    gravity: Vec<f64>,
    qdd: Vec<f64>,
    qdd_with_wrench: Vec<f64>,
    tau_inverse: Vec<f64>,
    kinetic_energy: f64,
    potential_energy: f64,
    payload_300kg: Option<Payload>,
}

#[derive(Deserialize)]
struct Payload {
    mass_matrix: Vec<Vec<f64>>,
    bias: Vec<f64>,
    gravity: Vec<f64>,
    qdd: Vec<f64>,
}

#[derive(Deserialize)]
struct Trajectory {
    q0: Vec<f64>,
    v0: Vec<f64>,
    tau0: Vec<f64>,
    amplitude: Vec<f64>,
    frequency_hz: Vec<f64>,
    kp: Vec<f64>,
    kd: Vec<f64>,
    t: Vec<f64>,
    q: Vec<Vec<f64>>,
    v: Vec<Vec<f64>>,
    tip: Vec<Vec<f64>>,
}

fn golden() -> Golden {
    serde_json::from_str(include_str!("../testdata/golden/states.json")).unwrap()
}

/// Errors of one quantity over all states.
struct Errors {
    quantity: &'static str,
    relative: bool,
    bound: f64,
    values: Vec<f64>,
}

impl Errors {
    fn new(quantity: &'static str, relative: bool, bound: f64) -> Self {
        Self { quantity, relative, bound, values: Vec::new() }
    }

    #[track_caller]
    fn push(&mut self, found: &[f64], expected: &[f64]) {
        assert_eq!(found.len(), expected.len(), "{}: wrong number of values", self.quantity);
        let scale = if self.relative { max_abs(expected).max(1.0) } else { 1.0 };
        let difference: Vec<f64> = found.iter().zip(expected).map(|(f, e)| f - e).collect();
        assert!(difference.iter().all(|d| d.is_finite()), "{}: not finite", self.quantity);
        self.values.push(max_abs(&difference) / scale);
    }

    /// Prints median, 99th percentile and maximum, and bounds the maximum.
    #[track_caller]
    fn check(mut self) {
        self.values.sort_by(f64::total_cmp);
        let n = self.values.len();
        let (median, q99, max) =
            (self.values[n / 2], self.values[(n * 99).div_ceil(100) - 1], self.values[n - 1]);
        let kind = if self.relative { "relative" } else { "absolute" };
        let Self { quantity, bound, .. } = self;
        eprintln!(
            "{quantity:24} {kind}  median {median:.1e}  q99 {q99:.1e}  max {max:.1e}  bound {bound:.0e}"
        );
        assert!(max <= bound, "{quantity}: {kind} error {max:e} exceeds {bound:e}");
    }
}

fn flat(rows: &[Vec<f64>]) -> Vec<f64> {
    rows.iter().flatten().copied().collect()
}

/// Rotation matrix of a unit quaternion, row by row.
fn rotation_of([x, y, z, w]: [f64; 4]) -> [f64; 9] {
    [
        1.0 - 2.0 * (y * y + z * z),
        2.0 * (x * y - z * w),
        2.0 * (x * z + y * w),
        2.0 * (x * y + z * w),
        1.0 - 2.0 * (x * x + z * z),
        2.0 * (y * z - x * w),
        2.0 * (x * z - y * w),
        2.0 * (y * z + x * w),
        1.0 - 2.0 * (x * x + y * y),
    ]
}

#[test]
fn joints_and_gravity_are_those_of_the_reference() {
    let (model, golden) = (crane(), golden());
    assert!(model.tree_joint_names().eq(golden.tree.iter().map(String::as_str)));
    assert!(model.actuators().iter().map(|a| a.name()).eq(golden.actuated.iter().map(String::as_str)));
    assert_eq!(model.gravity(), golden.gravity);
    assert_eq!(golden.states.len(), 100);
}

#[test]
fn pins_of_each_loop_span_the_triangle_of_the_reference() {
    let (model, golden) = (crane(), golden());
    let mut data = model.new_data();
    // Hinge of the turned joint, hinge of the barrel, pin; the child link's origin is its hinge.
    let pins = [
        ("lift", "lift_joint", ["boom", "lift_barrel", "lift_loop_a"]),
        ("tilt", "tilt_joint", ["stick", "tilt_barrel", "tilt_loop_b"]),
    ];
    let mut errors = Errors::new("sides of loops", false, tolerance::KINEMATICS);
    for state in &golden.states {
        model.update_kinematics(&mut data, &state.query.position, &state.query.velocity).unwrap();
        for (name, cylinder, links) in &pins {
            let [o, c, p] = links.map(|l| model.link_pose(&data, model.link_index(l).unwrap()).position);
            let stroke = state.query.position[model.actuator_index(cylinder).unwrap()];
            let Triangle { a, b, l0 } = golden.loops[*name];
            errors.push(&[distance(o, c), distance(o, p), distance(c, p)], &[a, b, l0 + stroke]);
        }
    }
    assert_eq!(golden.loops.len(), pins.len(), "loops of the reference");
    errors.check();
}

#[test]
fn every_state_agrees_with_the_reference() {
    let model = crane();
    let mut data = model.new_data();
    let mut errors = [
        Errors::new("tree_q", false, tolerance::KINEMATICS),
        Errors::new("tree_v", false, tolerance::KINEMATICS),
        Errors::new("G", false, tolerance::KINEMATICS),
        Errors::new("g", true, tolerance::KINEMATICS),
        Errors::new("tip_position", false, tolerance::KINEMATICS),
        Errors::new("tip_rotation", false, tolerance::KINEMATICS),
        Errors::new("tip_quaternion", false, tolerance::KINEMATICS),
        Errors::new("jacobian", false, tolerance::KINEMATICS),
        Errors::new("jacobian_dot_v", true, tolerance::KINEMATICS),
        Errors::new("tip_velocity", false, tolerance::KINEMATICS),
        Errors::new("mass_matrix", true, tolerance::TERMS),
        Errors::new("bias", true, tolerance::TERMS),
        Errors::new("gravity", true, tolerance::TERMS),
        Errors::new("tau_inverse", true, tolerance::TERMS),
        Errors::new("kinetic_energy", true, tolerance::TERMS),
        Errors::new("potential_energy", true, tolerance::TERMS),
        Errors::new("qdd", true, tolerance::ACCELERATION),
        Errors::new("qdd_with_wrench", true, tolerance::ACCELERATION),
        Errors::new("tree_a", true, tolerance::ACCELERATION),
        Errors::new("tip_acceleration", true, tolerance::ACCELERATION),
    ];
    for state in &golden().states {
        let found = model.evaluate(&mut data, &state.query).unwrap();
        let rotation: Vec<Vec<f64>> = found.tip_rotation.iter().map(|row| row.to_vec()).collect();
        let pairs = [
            (found.tree_q, state.tree_q.clone()),
            (found.tree_v, state.tree_v.clone()),
            (flat(&found.tree_jacobian), flat(&state.slope)),
            (found.tree_drift, state.drift.clone()),
            (found.tip_position.to_vec(), state.tip_position.clone()),
            (flat(&rotation), flat(&state.tip_rotation)),
            (flat(&rotation), rotation_of(state.tip_quaternion_xyzw).to_vec()),
            (flat(&found.jacobian), flat(&state.jacobian)),
            (found.jacobian_dot_v.to_vec(), state.jacobian_dot_v.clone()),
            (found.tip_velocity.to_vec(), state.tip_velocity.clone()),
            (flat(&found.mass_matrix), flat(&state.mass_matrix)),
            (found.bias, state.bias.clone()),
            (found.gravity, state.gravity.clone()),
            (found.tau_inverse.unwrap(), state.tau_inverse.clone()),
            (vec![found.kinetic_energy], vec![state.kinetic_energy]),
            (vec![found.potential_energy], vec![state.potential_energy]),
            (found.qdd, state.qdd.clone()),
            (found.qdd_with_wrench.unwrap(), state.qdd_with_wrench.clone()),
            (found.tree_a, state.tree_a.clone()),
            (found.tip_acceleration.to_vec(), state.tip_acceleration.clone()),
        ];
        assert_eq!(errors.len(), pairs.len(), "every quantity has its error");
        for (errors, (found, expected)) in errors.iter_mut().zip(pairs) {
            errors.push(&found, &expected);
        }
    }
    errors.into_iter().for_each(Errors::check);
}

#[test]
fn payload_states_agree_with_the_reference() {
    let model = crane().with_payload(300.0).unwrap();
    let mut data = model.new_data();
    let mut errors = [
        Errors::new("300 kg: mass_matrix", true, tolerance::TERMS),
        Errors::new("300 kg: bias", true, tolerance::TERMS),
        Errors::new("300 kg: gravity", true, tolerance::TERMS),
        Errors::new("300 kg: qdd", true, tolerance::ACCELERATION),
    ];
    let mut count = 0;
    for state in &golden().states {
        let Some(payload) = &state.payload_300kg else { continue };
        count += 1;
        let found = model.evaluate(&mut data, &state.query).unwrap();
        errors[0].push(&flat(&found.mass_matrix), &flat(&payload.mass_matrix));
        errors[1].push(&found.bias, &payload.bias);
        errors[2].push(&found.gravity, &payload.gravity);
        errors[3].push(&found.qdd, &payload.qdd);
    }
    assert_eq!(count, 20, "states with a payload");
    errors.into_iter().for_each(Errors::check);
}

/// The reference's closed loop needs its effort inside each stage, so the fourth-order step is written out here;
/// `rk4` itself holds the effort.
fn closed_loop_step(model: &CraneModel, data: &mut Data, law: &Trajectory, t: f64, h: f64, y: &mut [f64]) {
    let n = y.len() / 2;
    let mut rate = |t: f64, y: &[f64]| {
        let (q, v) = y.split_at(n);
        let effort: Vec<f64> = (0..n)
            .map(|i| {
                law.tau0[i] + law.amplitude[i] * (std::f64::consts::TAU * law.frequency_hz[i] * t).sin()
                    - law.kp[i] * (q[i] - law.q0[i])
                    - law.kd[i] * v[i]
            })
            .collect();
        let mut rate = [v, &vec![0.0; n]].concat();
        model.forward_dynamics(data, q, v, &effort, None, &mut rate[n..]).unwrap();
        rate
    };
    let ahead =
        |y: &[f64], k: &[f64], h: f64| -> Vec<f64> { y.iter().zip(k).map(|(y, k)| y + h * k).collect() };
    let k1 = rate(t, y);
    let k2 = rate(t + h / 2.0, &ahead(y, &k1, h / 2.0));
    let k3 = rate(t + h / 2.0, &ahead(y, &k2, h / 2.0));
    let k4 = rate(t + h, &ahead(y, &k3, h));
    for i in 0..2 * n {
        y[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
    }
}

#[test]
fn the_closed_loop_trajectory_agrees_with_the_reference() {
    let model = crane();
    let mut data = model.new_data();
    let law = golden().trajectory;
    let steps = 1000; // per sample of 0.05 s
    let mut y = [law.q0.clone(), law.v0.clone()].concat();
    let n = law.q0.len();
    let mut errors = [
        Errors::new("trajectory: q", false, tolerance::TRAJECTORY),
        Errors::new("trajectory: v", false, tolerance::TRAJECTORY),
        Errors::new("trajectory: tip", false, tolerance::TRAJECTORY),
    ];
    for sample in 0..law.t.len() {
        if sample > 0 {
            let h = (law.t[sample] - law.t[sample - 1]) / f64::from(steps);
            for step in 0..steps {
                let t = law.t[sample - 1] + f64::from(step) * h;
                closed_loop_step(&model, &mut data, &law, t, h, &mut y);
            }
        }
        model.update_kinematics(&mut data, &y[..n], &y[n..]).unwrap();
        errors[0].push(&y[..n], &law.q[sample]);
        errors[1].push(&y[n..], &law.v[sample]);
        errors[2].push(&model.tip_pose(&data).position, &law.tip[sample]);
    }
    errors.into_iter().for_each(Errors::check);
}
