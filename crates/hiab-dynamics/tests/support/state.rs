//! Machines in states, and what the properties of them are compared with.

use hiab_dynamics::{CraneModel, Plant, PlantFile, Wrench};
use nalgebra::DMatrix;
use proptest::prelude::*;

use super::random::{Machine, machines};
use super::{EXCAVATOR_PLANTS, PLANTS, max_abs, position_at, shipped, tolerance, velocity_at};

/// How many machines are shipped.
const SHIPPED: usize = 2;

/// Plants that both of them have.
const PLANT_NAMES: [&str; 2] = ["rigid", "electric"];

/// A machine in a state.
#[derive(Clone, Debug)]
pub struct Case {
    pub machine: Machine,
    pub plant: Option<Plant>,
    /// Without payload.
    pub bare: CraneModel,
    pub model: CraneModel,
    pub position: Vec<f64>,
    pub velocity: Vec<f64>,
    pub acceleration: Vec<f64>,
    pub wrench: Wrench,
}

/// Random machines half of the time, otherwise the shipped ones with every plant: states over the whole workspace but for
/// the room that a difference's step takes, up to twice the velocity limits, and payloads of up to 500 kg.
pub fn cases() -> impl Strategy<Value = Case> {
    let machines = prop_oneof![
        1 => machines().prop_map(|machine| (machine, None)),
        1 => (0..SHIPPED, proptest::option::of(0..PLANT_NAMES.len()))
            .prop_map(|(which, plant)| (shipped()[which].clone(), plant.map(|plant| (which, plant)))),
    ];
    let shares = |low: f64, high: f64| proptest::collection::vec(low..=high, 18);
    let wrench = (proptest::array::uniform3(-2e3..2e3), proptest::array::uniform3(-500.0..500.0));
    let payload = prop_oneof![Just(0.0), 0.0..500.0];
    (machines, payload, shares(1e-3, 1.0 - 1e-3), shares(-2.0, 2.0), shares(-5.0, 5.0), wrench).prop_map(
        |((machine, plant), payload, position, velocity, acceleration, (force, moment))| {
            let plant = plant.map(|(which, plant)| {
                let plants = PlantFile::from_ron([PLANTS, EXCAVATOR_PLANTS][which]).unwrap();
                plants.plant(PLANT_NAMES[plant]).unwrap().clone()
            });
            let bare = built(&machine, plant.as_ref());
            let model = bare.clone().with_payload(payload).unwrap();
            let n = model.actuators().len();
            let (position, velocity) = (position_at(&model, &position), velocity_at(&model, &velocity));
            let acceleration = acceleration[..n].to_vec();
            let wrench = Wrench { force, moment };
            Case { machine, plant, bare, model, position, velocity, acceleration, wrench }
        },
    )
}

/// The machine with what its drives add, if that is to be there.
pub fn built(machine: &Machine, plant: Option<&Plant>) -> CraneModel {
    let bare = machine.model();
    plant.map_or_else(|| bare.clone(), |plant| bare.clone().with_plant(plant).unwrap())
}

/// Compares slices, relative to the largest expected value or 1.
#[track_caller]
pub fn check_close(quantity: &str, found: &[f64], expected: &[f64], bound: f64) {
    assert_eq!(found.len(), expected.len(), "{quantity}: wrong number of values");
    let scale = max_abs(expected).max(1.0);
    for (i, (f, e)) in found.iter().zip(expected).enumerate() {
        let error = (f - e).abs() / scale;
        assert!(
            error <= bound,
            "{quantity}[{i}] is {f}, not {e}: relative error {error:e} exceeds {bound:e}"
        );
    }
}

/// Central difference of fourth order of `f` along `direction`.
pub fn difference(point: &[f64], direction: &[f64], f: impl Fn(&[f64]) -> Vec<f64>) -> Vec<f64> {
    let h = tolerance::DIFFERENCE_STEP;
    let moved = |s: f64| -> Vec<f64> { point.iter().zip(direction).map(|(p, d)| p + s * d).collect() };
    let [before, near_before, near_after, after] = [-1.0, -0.5, 0.5, 1.0].map(|share| f(&moved(share * h)));
    let slope = |i: usize| (8.0 * (near_after[i] - near_before[i]) - (after[i] - before[i])) / (6.0 * h);
    (0..after.len()).map(slope).collect()
}

pub fn mass_matrix(model: &CraneModel, position: &[f64]) -> DMatrix<f64> {
    let mut data = model.new_data();
    model.update_dynamics(&mut data, position, &vec![0.0; position.len()]).unwrap();
    DMatrix::from_row_slice(position.len(), position.len(), data.mass_matrix())
}

pub fn coriolis_matrix(model: &CraneModel, position: &[f64], velocity: &[f64]) -> DMatrix<f64> {
    let n = position.len();
    let (mut data, mut matrix) = (model.new_data(), vec![0.0; n * n]);
    model.update_dynamics(&mut data, position, velocity).unwrap();
    model.coriolis_matrix(&data, &mut matrix).unwrap();
    DMatrix::from_row_slice(n, n, &matrix)
}

pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Rows are those of the tip's spatial velocity, linear first.
pub fn jacobian(model: &CraneModel, position: &[f64]) -> DMatrix<f64> {
    let n = position.len();
    let (mut data, mut jacobian) = (model.new_data(), vec![0.0; 6 * n]);
    model.update_kinematics(&mut data, position, &vec![0.0; n]).unwrap();
    model.tip_jacobian(&data, &mut jacobian).unwrap();
    DMatrix::from_row_slice(6, n, &jacobian)
}
