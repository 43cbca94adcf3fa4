//! What holds for every machine and state: both shipped machines, and random trees with random cylinder loops.

mod support;

use hiab_dynamics::LoopFile;
use nalgebra::{DMatrix, Rotation3, Vector3};
use proptest::prelude::*;
use support::state::{
    Case, built, cases, check_close, coriolis_matrix, difference, dot, jacobian, mass_matrix,
};
use support::{crane, distance, max_abs, position_at, shipped, tolerance};

proptest! {
    // One machine is built for each case, which takes most of the time: there are many properties of a few cases each.
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 128, ..ProptestConfig::default() })]

    #[test]
    fn forward_undoes_inverse_dynamics(case in cases()) {
        let Case { model, position, velocity, acceleration, wrench, .. } = &case;
        let n = position.len();
        let mut data = model.new_data();
        let (mut effort, mut found) = (vec![0.0; n], vec![0.0; n]);
        model.inverse_dynamics(&mut data, position, velocity, acceleration, Some(wrench), &mut effort).unwrap();
        model.forward_dynamics(&mut data, position, velocity, &effort, Some(wrench), &mut found).unwrap();
        check_close("acceleration", &found, acceleration, tolerance::IDENTITY);
    }

    #[test]
    fn mass_matrix_is_symmetric_and_positive_definite(case in cases()) {
        let m = mass_matrix(&case.model, &case.position);
        prop_assert_eq!(&m, &m.transpose());
        let least = m.symmetric_eigenvalues().min();
        prop_assert!(least > 0.0, "least eigenvalue {}", least);
    }

    #[test]
    fn kinetic_energy_is_half_the_velocity_in_the_mass_matrix(case in cases()) {
        let Case { model, position, velocity, .. } = &case;
        let mut data = model.new_data();
        model.update_dynamics(&mut data, position, velocity).unwrap();
        let v = DMatrix::from_column_slice(velocity.len(), 1, velocity);
        let expected = 0.5 * (v.transpose() * mass_matrix(model, position) * &v)[0];
        check_close("kinetic energy", &[model.kinetic_energy(&data)], &[expected], tolerance::ROUNDING);
    }

    #[test]
    fn inverse_effective_inertia_is_the_diagonal_of_the_inverse_mass_matrix(case in cases()) {
        let Case { model, position, velocity, .. } = &case;
        let mut data = model.new_data();
        model.update_dynamics(&mut data, position, velocity).unwrap();
        let mut found = vec![0.0; position.len()];
        model.inverse_effective_inertia(&mut data, &mut found).unwrap();
        let inverse = mass_matrix(model, position).try_inverse().unwrap();
        for (k, found) in found.into_iter().enumerate() {
            let error = (found / inverse[(k, k)] - 1.0).abs();
            prop_assert!(error < tolerance::ROUND_TRIP, "actuator {}: relative error {:e}", k, error);
        }
    }

    #[test]
    fn a_wrench_acts_like_its_effort_through_the_jacobian(case in cases()) {
        let Case { model, position, velocity, wrench, .. } = &case;
        let n = position.len();
        let mut data = model.new_data();
        let (still, mut with_wrench, mut with_effort) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        let w = DMatrix::from_column_slice(6, 1, &[wrench.force, wrench.moment].concat());
        let effort = jacobian(model, position).transpose() * w;
        model.forward_dynamics(&mut data, position, velocity, &still, Some(wrench), &mut with_wrench).unwrap();
        model.forward_dynamics(&mut data, position, velocity, effort.as_slice(), None, &mut with_effort).unwrap();
        check_close("acceleration", &with_wrench, &with_effort, tolerance::ROUND_TRIP);
    }

    #[test]
    fn a_payload_acts_like_a_point_mass_at_the_tip(case in cases()) {
        let Case { bare, model, position, velocity, .. } = &case;
        let (n, payload) = (position.len(), model.payload());
        let (mut data, mut data_bare) = (model.new_data(), bare.new_data());
        model.update_dynamics(&mut data, position, velocity).unwrap();
        bare.update_dynamics(&mut data_bare, position, velocity).unwrap();
        let j = jacobian(bare, position).rows(0, 3).into_owned();
        let m = mass_matrix(bare, position) + j.transpose() * &j * payload;
        check_close("mass matrix", data.mass_matrix(), m.as_slice(), tolerance::ROUNDING);
        let mut drift = DMatrix::from_column_slice(3, 1, &bare.tip_drift(&data_bare).linear);
        drift[2] += 9.81;
        let bias = DMatrix::from_column_slice(n, 1, data_bare.bias()) + j.transpose() * drift * payload;
        check_close("bias", data.bias(), bias.as_slice(), tolerance::ROUNDING);
    }

    #[test]
    fn efforts_less_friction_and_wrench_put_in_what_the_energy_gains(case in cases()) {
        let Case { model, position, velocity, acceleration, wrench, .. } = &case;
        let mut data = model.new_data();
        let mut effort = vec![0.0; position.len()];
        model.inverse_dynamics(&mut data, position, velocity, acceleration, Some(wrench), &mut effort).unwrap();
        model.update_kinematics(&mut data, position, velocity).unwrap();
        let tip = model.tip_velocity(&data);
        let mut friction = vec![0.0; position.len()];
        model.friction_effort(velocity, &mut friction).unwrap();
        let of_efforts = dot(&effort, velocity) - dot(&friction, velocity);
        let of_wrench = dot(&wrench.force, &tip.linear) + dot(&wrench.moment, &tip.angular);
        let energy = |t: &[f64]| {
            let mut data = model.new_data();
            let t = t[0];
            let v: Vec<f64> = velocity.iter().zip(acceleration).map(|(v, a)| v + a * t).collect();
            let rate = velocity.iter().zip(acceleration).map(|(v, a)| v * t + 0.5 * a * t * t);
            let y: Vec<f64> = position.iter().zip(rate).map(|(y, step)| y + step).collect();
            model.update_kinematics(&mut data, &y, &v).unwrap();
            vec![model.kinetic_energy(&data), model.potential_energy(&data)]
        };
        let gained = difference(&[0.0], &[1.0], energy);
        let scale = [of_efforts, of_wrench, gained[0], gained[1], 1.0];
        let error = (of_efforts + of_wrench - gained[0] - gained[1]).abs() / max_abs(&scale);
        prop_assert!(error < tolerance::POWER, "{} W + {} W, gained {:?} W", of_efforts, of_wrench, gained);
    }

    #[test]
    fn coriolis_matrix_times_velocity_is_the_coriolis_effort(case in cases()) {
        let Case { model, position, velocity, .. } = &case;
        let mut data = model.new_data();
        model.update_dynamics(&mut data, position, velocity).unwrap();
        let expected: Vec<f64> = data.bias().iter().zip(data.gravity_effort()).map(|(b, g)| b - g).collect();
        let v = DMatrix::from_column_slice(velocity.len(), 1, velocity);
        let found = coriolis_matrix(model, position, velocity) * v;
        // The difference of bias and gravity has lost what they have in common.
        let scale = max_abs(data.bias()).max(1.0) / max_abs(&expected).max(1.0);
        check_close("coriolis effort", found.as_slice(), &expected, tolerance::ROUNDING * scale.max(1.0));
    }

    #[test]
    fn coriolis_matrix_and_its_transpose_add_up_to_the_rate_of_the_mass_matrix(case in cases()) {
        let Case { model, position, velocity, .. } = &case;
        let c = coriolis_matrix(model, position, velocity);
        let rate = difference(position, velocity, |y| mass_matrix(model, y).as_slice().to_vec());
        check_close("Ṁ", (&c + c.transpose()).as_slice(), &rate, tolerance::DIFFERENCE);
    }

    #[test]
    fn coriolis_matrix_is_that_of_the_christoffel_symbols(case in cases(), other in proptest::collection::vec(-1.0..1.0, 18)) {
        let Case { model, position, velocity, .. } = &case;
        let other = &other[..velocity.len()];
        let column = |v: &[f64]| DMatrix::from_column_slice(v.len(), 1, v);
        let one = coriolis_matrix(model, position, velocity) * column(other);
        let two = coriolis_matrix(model, position, other) * column(velocity);
        check_close("C(v)w = C(w)v", one.as_slice(), two.as_slice(), tolerance::ROUNDING);
    }

    #[test]
    fn gravity_effort_is_the_gradient_of_potential_energy(case in cases()) {
        let Case { model, position, .. } = &case;
        let n = position.len();
        let mut data = model.new_data();
        model.update_dynamics(&mut data, position, &vec![0.0; n]).unwrap();
        let gradient: Vec<f64> = (0..n)
            .map(|k| {
                let unit: Vec<f64> = (0..n).map(|i| f64::from(i == k)).collect();
                difference(position, &unit, |y| {
                    let mut data = model.new_data();
                    model.update_kinematics(&mut data, y, &vec![0.0; n]).unwrap();
                    vec![model.potential_energy(&data)]
                })[0]
            })
            .collect();
        check_close("gravity effort", data.gravity_effort(), &gradient, tolerance::DIFFERENCE);
    }

    #[test]
    fn jacobian_is_the_derivative_of_the_tip_and_drift_that_of_its_velocity(case in cases()) {
        let Case { model, position, velocity, .. } = &case;
        let n = position.len();
        let (mut data, mut jacobian) = (model.new_data(), vec![0.0; 6 * n]);
        model.update_kinematics(&mut data, position, velocity).unwrap();
        model.tip_jacobian(&data, &mut jacobian).unwrap();
        let at = |y: &[f64]| {
            let mut data = model.new_data();
            model.update_kinematics(&mut data, y, velocity).unwrap();
            let (pose, twist) = (model.tip_pose(&data), model.tip_velocity(&data));
            [pose.position.to_vec(), pose.rotation.concat(), twist.linear.to_vec(), twist.angular.to_vec()].concat()
        };
        let rotation = DMatrix::from_row_slice(3, 3, &model.tip_pose(&data).rotation.concat());
        for k in 0..n {
            let unit: Vec<f64> = (0..n).map(|i| f64::from(i == k)).collect();
            let rate = difference(position, &unit, at);
            let spin = DMatrix::from_row_slice(3, 3, &rate[3..12]) * rotation.transpose(); // Ṙ Rᵀ = [ω]×
            let expected = [rate[0], rate[1], rate[2], spin[(2, 1)], spin[(0, 2)], spin[(1, 0)]];
            let column: Vec<f64> = (0..6).map(|row| jacobian[row * n + k]).collect();
            check_close("column of the jacobian", &column, &expected, tolerance::DIFFERENCE);
        }
        let v = DMatrix::from_column_slice(n, 1, velocity);
        let (twist, drift) = (model.tip_velocity(&data), model.tip_drift(&data));
        let expected = DMatrix::from_row_slice(6, n, &jacobian) * v;
        check_close("tip velocity", &[twist.linear, twist.angular].concat(), expected.as_slice(), tolerance::ROUNDING);
        let rate = difference(position, velocity, at);
        check_close("tip drift", &[drift.linear, drift.angular].concat(), &rate[12..], tolerance::DIFFERENCE);
    }

    #[test]
    fn tree_slopes_and_drifts_are_derivatives_of_the_tree_positions(case in cases()) {
        let Case { model, position, velocity, .. } = &case;
        let mut data = model.new_data();
        model.update_kinematics(&mut data, position, velocity).unwrap();
        let at = |y: &[f64], pick: fn(&hiab_dynamics::Data) -> &[f64]| {
            let mut data = model.new_data();
            model.update_kinematics(&mut data, y, velocity).unwrap();
            pick(&data).to_vec()
        };
        let rate = difference(position, velocity, |y| at(y, |data| data.tree_position()));
        check_close("tree velocity", data.tree_velocity(), &rate, tolerance::DIFFERENCE);
        let rate = difference(position, velocity, |y| at(y, |data| data.tree_velocity()));
        check_close("tree drift", data.tree_drift(), &rate, tolerance::DIFFERENCE);
    }

    #[test]
    fn turning_base_and_gravity_together_changes_nothing(case in cases(), rpy in proptest::array::uniform3(-3.0..3.0)) {
        let Case { machine, plant, model, position, velocity, .. } = &case;
        let turn = Rotation3::from_euler_angles(rpy[0], rpy[1], rpy[2]);
        let turned = built(&machine.with_base_turned(rpy), plant.as_ref()).with_payload(model.payload()).unwrap();
        let turned = turned.with_gravity((turn * Vector3::new(0.0, 0.0, -9.81)).into()).unwrap();
        let (mut data, mut data_turned) = (model.new_data(), turned.new_data());
        model.update_dynamics(&mut data, position, velocity).unwrap();
        turned.update_dynamics(&mut data_turned, position, velocity).unwrap();
        check_close("mass matrix", data_turned.mass_matrix(), data.mass_matrix(), tolerance::ROUNDING);
        check_close("bias", data_turned.bias(), data.bias(), tolerance::ROUNDING);
        check_close("gravity", data_turned.gravity_effort(), data.gravity_effort(), tolerance::ROUNDING);
        let (tip, tip_turned) = (model.tip_pose(&data).position, turned.tip_pose(&data_turned).position);
        let expected: [f64; 3] = (turn * Vector3::from(tip)).into();
        check_close("tip", &tip_turned, &expected, tolerance::ROUNDING);
    }

    #[test]
    fn slewing_about_the_vertical_changes_no_term(case in cases(), turn in -3.0..3.0) {
        let Case { machine, model, position, velocity, .. } = &case;
        prop_assume!(shipped().iter().any(|shipped| shipped.urdf == machine.urdf));
        let slew = model.actuator_index("slew_joint").unwrap();
        let mut turned = position.clone();
        turned[slew] += turn;
        let (mut data, mut data_turned) = (model.new_data(), model.new_data());
        model.update_dynamics(&mut data, position, velocity).unwrap();
        model.update_dynamics(&mut data_turned, &turned, velocity).unwrap();
        check_close("mass matrix", data_turned.mass_matrix(), data.mass_matrix(), tolerance::ROUNDING);
        check_close("bias", data_turned.bias(), data.bias(), tolerance::ROUNDING);
        check_close("gravity", data_turned.gravity_effort(), data.gravity_effort(), tolerance::ROUNDING);
    }

    #[test]
    fn both_halves_of_every_pin_coincide(case in cases()) {
        let Case { machine, model, position, velocity, .. } = &case;
        let mut data = model.new_data();
        model.update_kinematics(&mut data, position, velocity).unwrap();
        for closed_loop in LoopFile::from_ron(&machine.loops).unwrap().closed_loops {
            let [a, b] = [closed_loop.frame_a, closed_loop.frame_b]
                .map(|link| model.link_pose(&data, model.link_index(&link).unwrap()).position);
            prop_assert!(distance(a, b) < tolerance::ROUNDING, "{}: gap {:e}", closed_loop.name, distance(a, b));
        }
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

    #[test]
    fn tip_inertia_is_the_inverse_of_the_mobility(case in cases(), direction in proptest::array::uniform3(-1.0..1.0)) {
        let Case { model, position, velocity, .. } = &case;
        let n = position.len();
        let mut data = model.new_data();
        model.update_dynamics(&mut data, position, velocity).unwrap();
        let mobility = model.tip_mobility(&mut data).unwrap().concat();
        let mobility = DMatrix::from_row_slice(3, 3, &mobility);
        let mut jacobian = vec![0.0; 6 * n];
        model.tip_jacobian(&data, &mut jacobian).unwrap();
        let j = DMatrix::from_row_slice(6, n, &jacobian).rows(0, 3).into_owned();
        let expected = &j * mass_matrix(model, position).try_inverse().unwrap() * j.transpose();
        check_close("mobility", mobility.as_slice(), expected.as_slice(), tolerance::IDENTITY);

        let u = DMatrix::from_column_slice(3, 1, &direction);
        let length = u.norm();
        prop_assume!(length > 0.01);
        let along = (u.transpose() * &mobility * &u)[0] / (length * length);
        let felt = model.apparent_mass(&mut data, direction).unwrap();
        prop_assert!((felt * along - 1.0).abs() < tolerance::IDENTITY, "{} kg at mobility {}", felt, along);

        let eigen = mobility.symmetric_eigenvalues();
        match model.tip_inertia(&mut data) {
            Ok(inertia) => {
                let product = DMatrix::from_row_slice(3, 3, &inertia.concat()) * &mobility;
                let gap = (product - DMatrix::identity(3, 3)).abs().max();
                prop_assert!(gap < 1e-15 * 100.0 * eigen.max() / eigen.min(), "Λ times mobility is off by {:e}", gap);
            }
            Err(error) => prop_assert!(eigen.min() < 1.1e-8 * eigen.max(), "{error}"),
        }
    }
}
