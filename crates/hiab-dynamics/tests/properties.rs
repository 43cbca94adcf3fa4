//! What holds at every state of the crane: one algorithm checks another, and derivatives check differences.
#![expect(clippy::unwrap_used, reason = "helpers of tests are tests too")]

mod support;

use hiab_dynamics::{CraneModel, PlantFile, Wrench};
use nalgebra::DMatrix;
use proptest::prelude::*;
use support::{PLANTS, crane, distance, max_abs, position_at, tolerance, velocity_at};

/// A crane, and a state of it.
#[derive(Clone, Debug)]
struct Case {
    plant: &'static str,
    payload: f64,
    position: [f64; 7],
    velocity: [f64; 7],
    acceleration: [f64; 7],
    force: [f64; 3],
    moment: [f64; 3],
}

/// States over the whole workspace, up to twice the velocity limits, under every plant and up to 500 kg.
fn cases() -> impl Strategy<Value = Case> {
    let shares = |low: f64, high: f64| proptest::array::uniform7(low..=high);
    let plant = prop_oneof![Just("rigid"), Just("electric"), Just("hydraulic")];
    let payload = prop_oneof![Just(0.0), 0.0..500.0];
    let wrench = (proptest::array::uniform3(-2e3..2e3), proptest::array::uniform3(-500.0..500.0));
    (plant, payload, shares(0.0, 1.0), shares(-2.0, 2.0), shares(-5.0, 5.0), wrench).prop_map(
        |(plant, payload, position, velocity, acceleration, (force, moment))| {
            let model = crane();
            let position = position_at(&model, &position).try_into().unwrap();
            let velocity = velocity_at(&model, &velocity).try_into().unwrap();
            Case { plant, payload, position, velocity, acceleration, force, moment }
        },
    )
}

impl Case {
    fn model(&self) -> CraneModel {
        let plants = PlantFile::from_ron(PLANTS).unwrap();
        crane().with_plant(plants.plant(self.plant).unwrap()).unwrap().with_payload(self.payload).unwrap()
    }

    fn wrench(&self) -> Wrench {
        Wrench { force: self.force, moment: self.moment }
    }
}

/// Compares slices, relative to the largest expected value or 1.
#[track_caller]
fn check_close(quantity: &str, found: &[f64], expected: &[f64], bound: f64) {
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

/// Central difference of `f` along `direction`.
fn difference(point: &[f64], direction: &[f64], f: impl Fn(&[f64]) -> Vec<f64>) -> Vec<f64> {
    let h = tolerance::DIFFERENCE_STEP;
    let moved = |s: f64| -> Vec<f64> { point.iter().zip(direction).map(|(p, d)| p + s * d).collect() };
    let (after, before) = (f(&moved(h)), f(&moved(-h)));
    after.iter().zip(before).map(|(a, b)| (a - b) / (2.0 * h)).collect()
}

fn unit(k: usize) -> [f64; 7] {
    std::array::from_fn(|i| if i == k { 1.0 } else { 0.0 })
}

fn mass_matrix(model: &CraneModel, position: &[f64]) -> DMatrix<f64> {
    let mut data = model.new_data();
    model.update_dynamics(&mut data, position, &[0.0; 7]).unwrap();
    DMatrix::from_row_slice(7, 7, data.mass_matrix())
}

/// Coriolis and centrifugal effort.
fn coriolis(model: &CraneModel, position: &[f64], velocity: &[f64]) -> Vec<f64> {
    let mut data = model.new_data();
    model.update_dynamics(&mut data, position, velocity).unwrap();
    data.bias().iter().zip(data.gravity_effort()).map(|(b, g)| b - g).collect()
}

fn jacobian(model: &CraneModel, position: &[f64]) -> DMatrix<f64> {
    let mut data = model.new_data();
    model.update_kinematics(&mut data, position, &[0.0; 7]).unwrap();
    let mut jacobian = vec![0.0; 42];
    model.tip_jacobian(&data, &mut jacobian).unwrap();
    DMatrix::from_row_slice(6, 7, &jacobian)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn forward_undoes_inverse_dynamics(case in cases()) {
        let (model, wrench) = (case.model(), case.wrench());
        let mut data = model.new_data();
        let (mut effort, mut found) = ([0.0; 7], [0.0; 7]);
        let Case { position, velocity, acceleration, .. } = &case;
        model.inverse_dynamics(&mut data, position, velocity, acceleration, Some(&wrench), &mut effort).unwrap();
        model.forward_dynamics(&mut data, position, velocity, &effort, Some(&wrench), &mut found).unwrap();
        check_close("acceleration", &found, acceleration, tolerance::ROUND_TRIP);
    }

    #[test]
    fn mass_matrix_is_symmetric_and_positive_definite(case in cases()) {
        let m = mass_matrix(&case.model(), &case.position);
        prop_assert_eq!(&m, &m.transpose());
        let least = m.symmetric_eigenvalues().min();
        prop_assert!(least > 0.0, "least eigenvalue {}", least);
    }

    #[test]
    fn kinetic_energy_is_half_the_velocity_in_the_mass_matrix(case in cases()) {
        let model = case.model();
        let mut data = model.new_data();
        model.update_dynamics(&mut data, &case.position, &case.velocity).unwrap();
        let v = DMatrix::from_column_slice(7, 1, &case.velocity);
        let expected = 0.5 * (v.transpose() * mass_matrix(&model, &case.position) * &v)[0];
        check_close("kinetic energy", &[model.kinetic_energy(&data)], &[expected], tolerance::ROUNDING);
    }

    #[test]
    fn christoffel_matrix_and_its_transpose_add_up_to_the_rate_of_the_mass_matrix(case in cases()) {
        let model = case.model();
        // c(v) = Γ(v, v) with Γ symmetric, so column k of C(v) = Γ(v, ·) is ½(c(v + eₖ) − c(v) − c(eₖ)).
        let of = |v: &[f64]| coriolis(&model, &case.position, v);
        let mut c = DMatrix::zeros(7, 7);
        for k in 0..7 {
            let mut both = case.velocity;
            both[k] += 1.0;
            let (both, own, other) = (of(&both), of(&case.velocity), of(&unit(k)));
            for i in 0..7 {
                c[(i, k)] = 0.5 * (both[i] - own[i] - other[i]);
            }
        }
        let rate = difference(&case.position, &case.velocity, |y| mass_matrix(&model, y).as_slice().to_vec());
        check_close("Ṁ", &rate, (&c + c.transpose()).as_slice(), tolerance::DIFFERENCE);
    }

    #[test]
    fn gravity_effort_is_the_gradient_of_potential_energy(case in cases()) {
        let model = case.model();
        let mut data = model.new_data();
        model.update_dynamics(&mut data, &case.position, &case.velocity).unwrap();
        let energy = |y: &[f64]| {
            let mut data = model.new_data();
            model.update_kinematics(&mut data, y, &[0.0; 7]).unwrap();
            vec![model.potential_energy(&data)]
        };
        let gradient: Vec<f64> = (0..7).map(|k| difference(&case.position, &unit(k), energy)[0]).collect();
        check_close("gravity effort", data.gravity_effort(), &gradient, tolerance::DIFFERENCE);
    }

    #[test]
    fn jacobian_is_the_derivative_of_the_tip_pose(case in cases()) {
        let model = case.model();
        let pose = |y: &[f64]| {
            let mut data = model.new_data();
            model.update_kinematics(&mut data, y, &[0.0; 7]).unwrap();
            let pose = model.tip_pose(&data);
            [pose.position.to_vec(), pose.rotation.concat()].concat()
        };
        let rotation = DMatrix::from_row_slice(3, 3, &pose(&case.position)[3..]);
        let jacobian = jacobian(&model, &case.position);
        for k in 0..7 {
            let rate = difference(&case.position, &unit(k), pose);
            let spin = DMatrix::from_row_slice(3, 3, &rate[3..]) * rotation.transpose(); // Ṙ Rᵀ = [ω]×
            let expected = [rate[0], rate[1], rate[2], spin[(2, 1)], spin[(0, 2)], spin[(1, 0)]];
            check_close("column of the jacobian", jacobian.column(k).as_slice(), &expected, tolerance::DIFFERENCE);
        }
    }

    #[test]
    fn tip_velocity_and_drift_follow_from_the_jacobian(case in cases()) {
        let model = case.model();
        let mut data = model.new_data();
        model.update_kinematics(&mut data, &case.position, &case.velocity).unwrap();
        let v = DMatrix::from_column_slice(7, 1, &case.velocity);
        let (velocity, drift) = (model.tip_velocity(&data), model.tip_drift(&data));
        let expected = jacobian(&model, &case.position) * &v;
        let found = [velocity.linear, velocity.angular].concat();
        check_close("tip velocity", &found, expected.as_slice(), tolerance::ROUNDING);
        let rate = difference(&case.position, &case.velocity, |y| (jacobian(&model, y) * &v).as_slice().to_vec());
        check_close("tip drift", &[drift.linear, drift.angular].concat(), &rate, tolerance::DIFFERENCE);
    }

    #[test]
    fn tree_slopes_and_drifts_are_derivatives_of_the_tree_positions(case in cases()) {
        let model = case.model();
        let mut data = model.new_data();
        model.update_kinematics(&mut data, &case.position, &case.velocity).unwrap();
        let at = |y: &[f64], pick: fn(&hiab_dynamics::Data) -> &[f64]| {
            let mut data = model.new_data();
            model.update_kinematics(&mut data, y, &case.velocity).unwrap();
            pick(&data).to_vec()
        };
        let rate = difference(&case.position, &case.velocity, |y| at(y, |data| data.tree_position()));
        check_close("tree velocity", data.tree_velocity(), &rate, tolerance::DIFFERENCE);
        let rate = difference(&case.position, &case.velocity, |y| at(y, |data| data.tree_velocity()));
        check_close("tree drift", data.tree_drift(), &rate, tolerance::DIFFERENCE);
    }

    #[test]
    fn a_wrench_acts_like_its_effort_through_the_jacobian(case in cases()) {
        let (model, wrench) = (case.model(), case.wrench());
        let mut data = model.new_data();
        let (mut with_wrench, mut with_effort) = ([0.0; 7], [0.0; 7]);
        let w = DMatrix::from_column_slice(6, 1, &[case.force, case.moment].concat());
        let effort = jacobian(&model, &case.position).transpose() * w;
        let (y, v) = (&case.position, &case.velocity);
        model.forward_dynamics(&mut data, y, v, &[0.0; 7], Some(&wrench), &mut with_wrench).unwrap();
        model.forward_dynamics(&mut data, y, v, effort.as_slice(), None, &mut with_effort).unwrap();
        check_close("acceleration", &with_wrench, &with_effort, tolerance::ROUND_TRIP);
    }

    #[test]
    fn a_payload_acts_like_a_point_mass_at_the_tip(case in cases()) {
        let (bare, loaded) = (crane(), crane().with_payload(case.payload).unwrap());
        let (mut data, mut data_bare) = (loaded.new_data(), bare.new_data());
        loaded.update_dynamics(&mut data, &case.position, &case.velocity).unwrap();
        bare.update_dynamics(&mut data_bare, &case.position, &case.velocity).unwrap();
        let j = jacobian(&bare, &case.position).rows(0, 3).into_owned();
        let m = mass_matrix(&bare, &case.position) + j.transpose() * &j * case.payload;
        check_close("mass matrix", data.mass_matrix(), m.as_slice(), tolerance::ROUNDING);
        let mut drift = DMatrix::from_column_slice(3, 1, &bare.tip_drift(&data_bare).linear);
        drift[2] += 9.81;
        let bias = DMatrix::from_column_slice(7, 1, data_bare.bias()) + j.transpose() * drift * case.payload;
        check_close("bias", data.bias(), bias.as_slice(), tolerance::ROUNDING);
    }

    #[test]
    fn inverse_effective_inertia_is_the_diagonal_of_the_inverse_mass_matrix(case in cases()) {
        let model = case.model();
        let mut data = model.new_data();
        model.update_dynamics(&mut data, &case.position, &case.velocity).unwrap();
        let mut found = [0.0; 7];
        model.inverse_effective_inertia(&mut data, &mut found).unwrap();
        let inverse = mass_matrix(&model, &case.position).try_inverse().unwrap();
        for (k, found) in found.into_iter().enumerate() {
            let error = (found / inverse[(k, k)] - 1.0).abs();
            prop_assert!(error < tolerance::ROUND_TRIP, "actuator {}: relative error {:e}", k, error);
        }
    }

    #[test]
    fn slewing_about_the_vertical_changes_no_term(case in cases(), turn in -3.0..3.0) {
        let model = case.model();
        let mut turned = case.position;
        turned[0] += turn;
        let (mut data, mut data_turned) = (model.new_data(), model.new_data());
        model.update_dynamics(&mut data, &case.position, &case.velocity).unwrap();
        model.update_dynamics(&mut data_turned, &turned, &case.velocity).unwrap();
        check_close("mass matrix", data_turned.mass_matrix(), data.mass_matrix(), tolerance::ROUNDING);
        check_close("bias", data_turned.bias(), data.bias(), tolerance::ROUNDING);
        check_close("gravity", data_turned.gravity_effort(), data.gravity_effort(), tolerance::ROUNDING);
    }

    #[test]
    fn both_halves_of_a_pin_coincide_wherever_the_loop_closes(shares in proptest::array::uniform2(0.0..=1.0)) {
        let model = crane();
        let mut data = model.new_data();
        let mut position = position_at(&model, &[0.5; 7]);
        for (joint, share) in ["lift_joint", "tilt_joint"].into_iter().zip(shares) {
            let k = model.actuator_index(joint).unwrap();
            let (lower, upper) = model.solvable_range(k);
            position[k] = lower + share * (upper - lower);
        }
        model.update_kinematics(&mut data, &position, &[0.0; 7]).unwrap();
        for closed_loop in ["lift", "tilt"] {
            let [a, b] = ["a", "b"].map(|half| {
                let link = model.link_index(&format!("{closed_loop}_loop_{half}")).unwrap();
                model.link_pose(&data, link).position
            });
            prop_assert!(distance(a, b) < tolerance::ROUNDING, "{}: gap {:e}", closed_loop, distance(a, b));
        }
    }
}
