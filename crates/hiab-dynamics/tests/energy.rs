//! Energy along motions: kept without friction, lost with it, and the order of both integrators.
#![expect(clippy::unwrap_used, reason = "helpers of tests are tests too")]

mod support;

use hiab_dynamics::{CraneModel, Data, DynamicsError, PlantFile, Wrench};
use support::{PLANTS, crane, excavator, max_abs, position_at, tolerance, velocity_at};

type Step = fn(
    &CraneModel,
    &mut Data,
    &mut [f64],
    &mut [f64],
    &[f64],
    Option<&Wrench>,
    f64,
) -> Result<(), DynamicsError>;

const INTEGRATORS: [(&str, Step, f64); 2] =
    [("semi_implicit_euler", CraneModel::semi_implicit_euler, 1.0), ("rk4", CraneModel::rk4, 4.0)];

/// Duration of every motion here [s].
const DURATION: f64 = 0.4;

/// Every joint in the middle of its range and at a third of its velocity limit.
fn start(model: &CraneModel) -> (Vec<f64>, Vec<f64>) {
    let share = [1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0].map(|sign| sign / 3.0);
    (position_at(model, &[0.5; 7]), velocity_at(model, &share))
}

/// The crane with reflected inertia on every cylinder but without friction.
fn with_armature() -> CraneModel {
    let mut plant = PlantFile::from_ron(PLANTS).unwrap().plant("electric").unwrap().clone();
    for values in plant.actuators.values_mut() {
        (values.coulomb, values.viscous) = (0.0, 0.0);
    }
    crane().with_plant(&plant).unwrap()
}

/// Effort that holds the start against gravity, so that the motion stays within every loop's range.
fn holding(model: &CraneModel) -> Vec<f64> {
    let (position, velocity) = start(model);
    let mut data = model.new_data();
    model.update_dynamics(&mut data, &position, &velocity).unwrap();
    data.gravity_effort().to_vec()
}

fn run(model: &CraneModel, step: Step, effort: &[f64], steps: u32) -> (Vec<f64>, Vec<f64>) {
    let (mut position, mut velocity) = start(model);
    let mut data = model.new_data();
    for _ in 0..steps {
        let period = DURATION / f64::from(steps);
        step(model, &mut data, &mut position, &mut velocity, effort, None, period).unwrap();
    }
    (position, velocity)
}

/// Kinetic and potential energy, less the work of a constant `effort` up to `position`.
fn conserved(model: &CraneModel, effort: &[f64], position: &[f64], velocity: &[f64]) -> f64 {
    let mut data = model.new_data();
    model.update_kinematics(&mut data, position, velocity).unwrap();
    let work: f64 = effort.iter().zip(position).map(|(e, y)| e * y).sum();
    model.kinetic_energy(&data) + model.potential_energy(&data) - work
}

fn drift(model: &CraneModel, step: Step, effort: &[f64], steps: u32) -> f64 {
    let (position, velocity) = start(model);
    let before = conserved(model, effort, &position, &velocity);
    let (position, velocity) = run(model, step, effort, steps);
    (conserved(model, effort, &position, &velocity) - before).abs()
}

fn frictionless_cases() -> [(&'static str, CraneModel, Vec<f64>); 4] {
    let weightless = crane().with_gravity([0.0; 3]).unwrap();
    let loaded = crane().with_payload(200.0).unwrap();
    let armature = with_armature();
    let (of_loaded, of_armature) = (holding(&loaded), holding(&armature));
    [
        ("no gravity, no effort", weightless, vec![0.0; 7]),
        ("free fall, no effort", crane(), vec![0.0; 7]),
        ("200 kg, constant effort", loaded, of_loaded),
        ("armature, constant effort", armature, of_armature),
    ]
}

#[test]
fn a_fourth_order_step_keeps_energy_without_effort_and_friction() {
    for (case, model, effort) in frictionless_cases() {
        let (position, velocity) = start(&model);
        let mut data = model.new_data();
        model.update_kinematics(&mut data, &position, &velocity).unwrap();
        let scale = model.kinetic_energy(&data);
        let drift = drift(&model, CraneModel::rk4, &effort, 800) / scale;
        assert!(drift < tolerance::ENERGY, "{case}: relative energy drift {drift:e}");
    }
}

#[test]
fn energy_drift_falls_with_the_order_of_the_integrator() {
    for (case, model, effort) in frictionless_cases() {
        for (name, step, order) in INTEGRATORS {
            let (coarse, fine) = (drift(&model, step, &effort, 20), drift(&model, step, &effort, 40));
            let found = (coarse / fine).log2();
            assert!(found > order - 0.5, "{case}, {name}: order {found}, drifts {coarse:e} and {fine:e}");
        }
    }
}

#[test]
fn states_converge_with_the_order_of_the_integrator() {
    for (case, model, effort) in frictionless_cases() {
        let (exact, _) = run(&model, CraneModel::rk4, &effort, 1600);
        for (name, step, order) in INTEGRATORS {
            let error = |steps| {
                let (position, _) = run(&model, step, &effort, steps);
                let difference: Vec<f64> = position.iter().zip(&exact).map(|(p, e)| p - e).collect();
                max_abs(&difference)
            };
            let (coarse, fine) = (error(20), error(40));
            let found = (coarse / fine).log2();
            assert!(
                (found - order).abs() < 0.5,
                "{case}, {name}: order {found}, errors {coarse:e} and {fine:e}"
            );
        }
    }
}

#[test]
fn friction_takes_exactly_the_energy_that_it_dissipates() {
    let plants = PlantFile::from_ron(PLANTS).unwrap();
    for name in ["electric", "hydraulic"] {
        let model = crane().with_plant(plants.plant(name).unwrap()).unwrap();
        let effort = holding(&model);
        let (mut position, mut velocity) = start(&model);
        let (mut data, mut friction) = (model.new_data(), vec![0.0; 7]);
        let mut power = |velocity: &[f64]| -> f64 {
            model.friction_effort(velocity, &mut friction).unwrap();
            friction.iter().zip(velocity).map(|(f, v)| f * v).sum()
        };
        let before = conserved(&model, &effort, &position, &velocity);
        let (mut lost, period) = (0.0, 5e-5);
        for _ in 0..4000 {
            let at_start = power(&velocity);
            assert!(at_start >= 0.0, "{name}: friction drives the crane with {at_start} W");
            model.rk4(&mut data, &mut position, &mut velocity, &effort, None, period).unwrap();
            lost += 0.5 * period * (at_start + power(&velocity));
        }
        let taken = before - conserved(&model, &effort, &position, &velocity);
        let error = (taken / lost - 1.0).abs();
        assert!(error < tolerance::TRAPEZOID, "{name}: lost {lost} J, missing {taken} J");
    }
}

/// Ten seconds of free motion at 2 kHz; gives the greatest drift of energy, relative to the greatest kinetic energy.
fn long_drift(machine: &str, model: &CraneModel, position: &[f64], velocity: &[f64]) -> f64 {
    let n = position.len();
    let (mut position, mut velocity) = (position.to_vec(), velocity.to_vec());
    let (mut data, effort) = (model.new_data(), vec![0.0; n]);
    let (mut start, mut drift, mut greatest, mut travel) =
        (None, 0.0_f64, 0.0_f64, vec![(f64::MAX, f64::MIN); n]);
    for tick in 0..20_000 {
        if let Err(error) = model.rk4(&mut data, &mut position, &mut velocity, &effort, None, 5e-4) {
            panic!("{machine}: after {tick} ticks: {error}");
        }
        if tick % 10 == 0 {
            let energy = conserved(model, &effort, &position, &velocity);
            model.update_kinematics(&mut data, &position, &velocity).unwrap();
            greatest = greatest.max(model.kinetic_energy(&data));
            drift = drift.max((energy - *start.get_or_insert(energy)).abs());
            for ((low, high), y) in travel.iter_mut().zip(&position) {
                (*low, *high) = (low.min(*y), high.max(*y));
            }
        }
    }
    for (actuator, (low, high)) in model.actuators().iter().zip(travel) {
        assert!(high - low > 1e-3, "{machine}: {} hardly moved, {low} to {high}", actuator.name());
    }
    drift / greatest
}

/// Free motion that stays where the loops close for 10 s: without gravity the cylinders creep through their range while
/// the hinges turn freely. With it a hoist hangs below its hinge and swings.
#[test]
fn ten_seconds_of_free_motion_keep_the_energy() {
    let weightless = |model: CraneModel| model.with_gravity([0.0; 3]).unwrap();
    let (crane, excavator) = (weightless(crane()), weightless(excavator()));
    let hoist = hoist().with_gravity([9.81, 0.0, 0.0]).unwrap();
    let cases = [
        (
            "crane",
            crane,
            vec![0.0, 0.3, 0.3, 0.3, 0.1, 0.2, 0.3],
            vec![0.02, 0.01, -0.01, -0.01, 0.5, 0.4, 0.8],
        ),
        ("excavator", excavator, vec![0.0, 0.2, 0.25, -1.0], vec![0.02, 0.01, -0.01, 0.1]),
        ("hanging hoist", hoist, vec![0.22, 0.0], vec![0.1, 0.3]),
    ];
    for (name, model, position, velocity) in cases {
        let drift = long_drift(name, &model, &position, &velocity);
        assert!(drift < tolerance::LONG_ENERGY, "{name}: relative energy drift {drift:e}");
        eprintln!("{name}: relative energy drift {drift:.1e} over 10 s");
    }
}

/// A boom that points ahead in the middle of its cylinder's range, with a free hinge at its end.
fn hoist() -> CraneModel {
    let body = |name: &str, mass: f64, x: f64| {
        format!(
            r#"<link name="{name}"><inertial><origin xyz="{x} 0 0"/><mass value="{mass}"/>
            <inertia ixx="0.5" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>"#
        )
    };
    let urdf = format!(
        r#"<robot name="hoist"><link name="ground"/>{}{}{}{}<link name="half_a"/><link name="half_b"/>
        <joint name="boom_joint" type="continuous"><parent link="ground"/><child link="boom"/><axis xyz="0 -1 0"/></joint>
        <joint name="barrel_joint" type="continuous"><parent link="ground"/><child link="barrel"/>
          <origin xyz="0 0 -0.8"/><axis xyz="0 -1 0"/></joint>
        <joint name="cylinder_joint" type="prismatic"><parent link="barrel"/><child link="rod"/>
          <origin xyz="0.7 0 0"/><axis xyz="1 0 0"/></joint>
        <joint name="end_joint" type="continuous"><parent link="boom"/><child link="end"/>
          <origin xyz="1 0 0"/><axis xyz="0 -1 0"/></joint>
        <joint name="a" type="fixed"><parent link="rod"/><child link="half_a"/></joint>
        <joint name="b" type="fixed"><parent link="boom"/><child link="half_b"/><origin xyz="0.5 0 0"/></joint></robot>"#,
        body("boom", 40.0, 0.5),
        body("barrel", 6.0, 0.3),
        body("rod", 4.0, -0.2),
        body("end", 10.0, 0.3),
    );
    let actuator = |joint: &str| {
        format!(
            "(joint: \"{joint}\", lower: 0.0, upper: 0.4, effort: 1.0, velocity: 1.0, acceleration: 1.0, jerk: 1.0, \
             armature: 0.0),"
        )
    };
    let loops = format!(
        r#"(urdf: "", tip_link: "end", closed_loops: [(name: "hoist", frame_a: "half_a", frame_b: "half_b",
        kind: Point3d, independent: "cylinder_joint", dependent: ["boom_joint", "barrel_joint"], branch: Positive)],
        actuators: [{}{}])"#,
        actuator("cylinder_joint"),
        actuator("end_joint"),
    );
    CraneModel::from_urdf(&urdf, &loops).unwrap()
}
