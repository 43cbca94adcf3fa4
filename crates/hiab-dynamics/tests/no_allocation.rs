//! After `new_data` nothing on the way of a control loop allocates.

mod support;

use adaptive_ctrl::{
    AdaptiveController, Bounds, EffortLimits, GainTable, InverseInertia, JointController, JointSpec,
    Measurement, Reference,
};
use allocation_counter::measure;
use hiab_dynamics::{CraneModel, PlantFile, Wrench};
use support::{PLANTS, crane, position_at, velocity_at};

#[track_caller]
fn check_no_allocation(operation: &str, run: impl FnOnce()) {
    let count = measure(run).count_total;
    assert_eq!(count, 0, "{operation} allocates");
}

#[test]
fn the_counter_sees_an_allocation() {
    let model = crane();
    assert!(measure(|| drop(model.new_data())).count_total > 0);
}

#[test]
fn no_step_and_no_query_allocates() {
    let plants = PlantFile::from_ron(PLANTS).unwrap();
    let model = crane().with_plant(plants.plant("hydraulic").unwrap()).unwrap().with_payload(100.0).unwrap();
    let mut data = model.new_data();
    let (mut position, mut velocity) = (position_at(&model, &[0.4; 7]), velocity_at(&model, &[0.2; 7]));
    let (effort, mut result, mut jacobian) = (vec![100.0; 7], vec![0.0; 7], vec![0.0; 42]);
    let mut tree = vec![0.0; model.tree_joint_names().len()];
    let wrench = Wrench { force: [10.0, 20.0, -500.0], moment: [1.0, 2.0, 3.0] };
    let wrench = Some(&wrench);

    type Step = fn(
        &CraneModel,
        &mut hiab_dynamics::Data,
        &mut [f64],
        &mut [f64],
        &[f64],
        Option<&Wrench>,
        f64,
    ) -> Result<(), hiab_dynamics::DynamicsError>;
    let steps: [(&str, Step); 2] =
        [("semi_implicit_euler", CraneModel::semi_implicit_euler), ("rk4", CraneModel::rk4)];
    for (name, step) in steps {
        check_no_allocation(name, || {
            for _ in 0..100 {
                step(&model, &mut data, &mut position, &mut velocity, &effort, wrench, 5e-4).unwrap();
            }
        });
    }
    check_no_allocation("forward_dynamics", || {
        model.forward_dynamics(&mut data, &position, &velocity, &effort, wrench, &mut result).unwrap();
    });
    check_no_allocation("inverse_dynamics", || {
        model.inverse_dynamics(&mut data, &position, &velocity, &effort, wrench, &mut result).unwrap();
    });
    check_no_allocation("queries", || {
        model.tip_jacobian(&data, &mut jacobian).unwrap();
        model.tree_acceleration(&data, &effort, &mut tree).unwrap();
        model.friction_effort(&velocity, &mut result).unwrap();
        model.inverse_effective_inertia(&mut data, &mut result).unwrap();
        let poses = [model.tip_pose(&data), model.link_pose(&data, 3)];
        let twists = [model.tip_velocity(&data), model.tip_drift(&data)];
        let mass = model.apparent_mass(&mut data, [0.0, 0.0, 1.0]).unwrap();
        assert!(mass > 0.0 && model.tip_mobility(&mut data).unwrap()[0][0] > 0.0);
        let energy = model.kinetic_energy(&data) + model.potential_energy(&data);
        assert!(poses[0] != poses[1] && twists[0] != twists[1] && energy.is_finite());
    });
}

#[test]
fn no_tick_of_the_whole_loop_allocates() {
    let plants = PlantFile::from_ron(PLANTS).unwrap();
    let model = crane().with_plant(plants.plant("electric").unwrap()).unwrap();
    let gains: GainTable = ron::from_str(include_str!("../../../assets/hiab/gains.ron")).unwrap();
    let names: Vec<&str> = model.actuators().iter().map(hiab_dynamics::Actuator::name).collect();
    let (mut data, mut inverse) = (model.new_data(), vec![0.0; 7]);
    let (mut position, mut velocity) = (position_at(&model, &[0.5; 7]), vec![0.0; 7]);
    let wanted = position.clone();
    model.update_dynamics(&mut data, &position, &velocity).unwrap();
    model.inverse_effective_inertia(&mut data, &mut inverse).unwrap();
    let mut controllers: Vec<AdaptiveController> = Vec::new();
    for ((gains, a), actuator) in
        gains.in_order(&names).unwrap().into_iter().zip(&inverse).zip(model.actuators())
    {
        let spec = JointSpec {
            period: 5e-4,
            inverse_inertia: InverseInertia::try_from(Bounds { lower: *a, upper: *a }).unwrap(),
            effort_limits: EffortLimits::symmetric(actuator.effort_limit()).unwrap(),
        };
        controllers.push(AdaptiveController::new(gains, spec).unwrap());
    }
    let mut effort = vec![0.0; 7];
    check_no_allocation("a tick of the whole loop", || {
        for _ in 0..2000 {
            for (k, controller) in controllers.iter_mut().enumerate() {
                let reference = Reference { position: wanted[k], ..Reference::default() };
                let measured = Measurement { position: position[k], velocity: velocity[k] };
                effort[k] = controller.step(reference, measured).effort;
            }
            model.semi_implicit_euler(&mut data, &mut position, &mut velocity, &effort, None, 5e-4).unwrap();
        }
    });
    // It was the loop that ran: the crane has sagged a little and is held.
    let sag = (position[1] - wanted[1]).abs();
    assert!(sag > 1e-6 && sag < 0.01, "lift is {sag} m off");
}
