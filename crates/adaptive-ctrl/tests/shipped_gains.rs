//! The gain files of the crane pass the gate that a user's files pass.
#![cfg(feature = "serde")]
#![expect(clippy::unwrap_used, reason = "helpers of tests are tests too")]

use adaptive_ctrl::{
    AdaptiveController, Bounds, EffortLimits, GainTable, InverseInertia, JointController, JointSpec,
    Measurement,
};

const JOINTS: [&str; 7] = [
    "slew_joint",
    "lift_joint",
    "tilt_joint",
    "telescope_joint",
    "wrist_pitch_joint",
    "wrist_yaw_joint",
    "wrist_roll_joint",
];

/// The crane's actuator efforts [N·m or N].
const EFFORT: [f64; 7] = [8000.0, 95_500.0, 95_500.0, 37_300.0, 4000.0, 3000.0, 2000.0];

/// Inertia per actuator over all postures, held joints turned too, with the other joints free [kg·m² or kg].
const ELECTRIC: [[f64; 2]; 7] = [
    [112.5, 1922.0],
    [3606.0, 22_960.0],
    [2472.0, 6263.0],
    [1055.0, 1114.0],
    [0.436, 1.556],
    [0.968, 1.266],
    [0.1194, 0.1612],
];
const HYDRAULIC: [[f64; 2]; 7] = [
    [112.5, 1914.0],
    [1247.0, 7545.0],
    [1034.0, 2976.0],
    [48.3, 91.3],
    [0.423, 1.282],
    [0.968, 1.239],
    [0.1181, 0.1607],
];

fn table(text: &str) -> Result<GainTable, String> {
    ron::from_str(text).map_err(|error| error.to_string())
}

fn joint(n: usize, inertia: [f64; 2]) -> JointSpec {
    let [lower, upper] = inertia;
    JointSpec {
        period: 0.0005,
        inverse_inertia: InverseInertia::of_inertia(Bounds { lower, upper }).unwrap(),
        effort_limits: EffortLimits::symmetric(EFFORT[n]).unwrap(),
    }
}

#[track_caller]
fn check_file(text: &str, inertia: &[[f64; 2]; 7]) {
    let gains = table(text).unwrap().in_order(&JOINTS).unwrap();
    for (n, gains) in gains.into_iter().enumerate() {
        let mut controller = AdaptiveController::new(gains, joint(n, inertia[n]))
            .unwrap_or_else(|error| panic!("{}: {error}", JOINTS[n]));
        // Room to adapt, and a third of the effort held within what the joint may be off by.
        assert!(controller.parameter_ceilings().velocity > 0.0, "{}", JOINTS[n]);
        let at = Measurement::default();
        let reference = controller.start_holding(at, EFFORT[n] / 3.0).unwrap();
        assert!(
            (controller.step(reference, at).effort / EFFORT[n] - 1.0 / 3.0).abs() < 1e-9,
            "{}",
            JOINTS[n]
        );
    }
}

#[test]
fn electric_gains_are_stable_over_the_workspace() {
    check_file(include_str!("../../../assets/hiab/gains.ron"), &ELECTRIC);
}

#[test]
fn hydraulic_gains_are_stable_over_the_workspace() {
    check_file(include_str!("../../../assets/hiab/gains-hydraulic.ron"), &HYDRAULIC);
}

#[test]
fn electric_gains_are_refused_without_reflected_inertia() {
    let gains = table(include_str!("../../../assets/hiab/gains.ron")).unwrap().in_order(&JOINTS).unwrap();
    for n in [1, 2, 3] {
        assert!(AdaptiveController::new(gains[n], joint(n, HYDRAULIC[n])).is_err(), "{}", JOINTS[n]);
    }
}

const ONE: &str = r#"(schema: 1, joints: {"a": (k1: 1, k2: 1, k3: 1, k4: 1, k5: 1, k6: 1, k7: 1, k8: 1)})"#;

#[test]
fn a_bad_gain_fails_with_its_place_and_name() {
    let error = table(&ONE.replace("k5: 1", "k5: 0")).unwrap_err();
    assert!(error.contains("gain k5 must be finite and > 0, got 0") && error.starts_with("1:"), "{error}");
    let error = table(&ONE.replace("k8: 1", "k8: 1, k9: 1")).unwrap_err();
    assert!(error.contains("k9"), "{error}");
    let error = table(&ONE.replace(", k8: 1", "")).unwrap_err();
    assert!(error.contains("k8"), "{error}");
    let error = table(&ONE.replace("schema: 1", "schema: 2")).unwrap_err();
    assert!(error.contains("schema of the gains is 2, must be 1"), "{error}");
}

#[test]
fn joint_names_must_match_the_machine() {
    let table = table(ONE).unwrap();
    assert_eq!(table.in_order(&["a"]).unwrap().len(), 1);
    assert_eq!(table.in_order(&["b"]).unwrap_err().to_string(), "no gains for joint b; there are some for a");
    assert!(table.in_order(&[]).unwrap_err().to_string().contains("gains for joint a"));
}

#[test]
fn gains_survive_a_round_trip() {
    let table = table(include_str!("../../../assets/hiab/gains.ron")).unwrap();
    let text = ron::to_string(&table).unwrap();
    assert_eq!(self::table(&text).unwrap(), table);
}
