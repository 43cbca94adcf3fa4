//! The commands about motion alone print what they promise.
#![expect(clippy::unwrap_used, reason = "helpers of tests are tests too")]

mod support;

use serde_json::Value;
use support::{Project, check_refusal, check_success};

const PROFILE: &str = "profile --v1 0.1 --v2 -0.08 --dt 0.5 --vmax 0.15 --amax 1 --jmax 100";

#[test]
fn tables_are_built_where_they_are_missing_and_checked_where_they_are_not() {
    let project = Project::new();
    check_success(&project.kinematics("tables --check"));
    std::fs::remove_file(project.path("assets/tables/lift_joint.ron")).unwrap();
    check_refusal(&project.kinematics("tables --check"), &["lift_joint.ron", "cargo xtask tables"]);
    let report = check_success(&project.kinematics("tables"));
    assert!(report.contains("built assets/tables/lift_joint.ron"), "{report}");
    check_success(&project.kinematics("tables --check"));
}

#[test]
fn a_zone_narrows_towards_the_limit() {
    let project = Project::new();
    let range = |position: f64, velocity: f64| {
        let command = format!("zone --joint lift_joint --position {position} --velocity {velocity} --json");
        let range: Value = serde_json::from_str(&check_success(&project.kinematics(&command))).unwrap();
        (range["min"].as_f64().unwrap(), range["max"].as_f64().unwrap())
    };
    let (middle_min, middle_max) = range(0.32, 0.0);
    assert!(middle_max > 0.02 && (middle_min + middle_max).abs() < 1e-12, "{middle_min} {middle_max}");
    let (_, near_max) = range(0.4995, 0.0);
    assert!((0.0..0.5 * middle_max).contains(&near_max), "{near_max}");
    let (moving_min, moving_max) = range(0.49, 0.1);
    assert!(moving_min <= moving_max && moving_max < 0.1, "{moving_min} {moving_max}");
}

#[test]
fn a_profile_has_the_asked_ends_and_rate() {
    let project = Project::new();
    for variant in
        ["", "--shape sine-quintic", "--timing fastest", "--shape sine-quintic --timing fastest --hz 300"]
    {
        let csv = check_success(&project.kinematics(&format!("{PROFILE} {variant}")));
        let mut lines = csv.lines();
        assert_eq!(lines.next(), Some("t,position,velocity,acceleration,jerk"));
        let rows: Vec<Vec<f64>> =
            lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
        assert_eq!(rows.len(), if variant.contains("300") { 151 } else { 5001 }, "{variant}");
        let (first, last) = (&rows[0], &rows[rows.len() - 1]);
        assert_eq!((first[0], first[1], first[2]), (0.0, 0.0, 0.1), "{variant}");
        assert_eq!(last[0], 0.5, "{variant}");
        assert!((last[2] + 0.08).abs() < 1e-12 && last[3].abs() < 1e-9, "{variant}: {last:?}");
        for row in &rows {
            assert!(row[3].abs() <= 1.0 + 1e-12 && row[4].abs() <= 100.0 + 1e-9, "{variant}: {row:?}");
        }
    }
}

#[test]
fn a_profile_that_cannot_be_is_refused_with_what_can() {
    let project = Project::new();
    let too_far = "profile --v1 0 --v2 0.14 --dt 0.05 --vmax 0.15 --amax 1 --jmax 100";
    check_refusal(&project.kinematics(too_far), &["0.14", "reachable is"]);
    check_refusal(&project.kinematics(&PROFILE.replace("--amax 1", "--amax 0")), &["acceleration", "0"]);
    check_refusal(&project.kinematics(&PROFILE.replace("--jmax 100", "--jmax NaN")), &["jerk", "NaN"]);
    check_refusal(&project.kinematics(&PROFILE.replace("--dt 0.5", "--dt -1")), &["--dt", "-1"]);
    check_refusal(&project.kinematics(&PROFILE.replace("--v1 0.1", "--v1 x")), &["--v1", "x"]);
    check_refusal(&project.kinematics(&format!("{PROFILE} --hz 0")), &["--hz"]);
}

#[test]
fn dynamics_answer_every_state_with_every_key() {
    let project = Project::new();
    let golden = support::workspace_root().join("crates/hiab-dynamics/testdata/golden/states.json");
    let printed = check_success(&project.kinematics(&format!("dynamics --states {}", golden.display())));
    let ours: Vec<Value> = serde_json::from_str(&printed).unwrap();
    let golden: Value = serde_json::from_slice(&std::fs::read(golden).unwrap()).unwrap();
    let states = golden["states"].as_array().unwrap();
    assert_eq!(ours.len(), states.len());
    let keys = [
        "tip_position",
        "tip_rotation",
        "jacobian",
        "jacobian_dot_v",
        "mass_matrix",
        "bias",
        "gravity",
        "qdd",
        "qdd_with_wrench",
        "tau_inverse",
        "kinetic_energy",
    ];
    for (index, (ours, reference)) in ours.iter().zip(states).enumerate() {
        for key in keys {
            check_close(&ours[key], &reference[key], &format!("states[{index}].{key}"));
        }
    }
}

/// Equal shape, and every number within 1e-7 of the largest of its kind; `hiab-dynamics` has the sharp comparison.
#[track_caller]
fn check_close(ours: &Value, reference: &Value, path: &str) {
    let (ours, reference) = (numbers(ours), numbers(reference));
    assert!(!ours.is_empty() && ours.len() == reference.len(), "{path}: {} numbers", ours.len());
    let scale = reference.iter().fold(1.0, |scale: f64, x| scale.max(x.abs()));
    for (a, b) in ours.iter().zip(&reference) {
        assert!((a - b).abs() <= 1e-7 * scale, "{path}: {a} against {b}");
    }
}

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Number(number) => vec![number.as_f64().unwrap()],
        Value::Array(values) => values.iter().flat_map(numbers).collect(),
        _ => Vec::new(),
    }
}

#[test]
fn a_load_chart_of_either_machine_holds_payloads_that_fall_with_the_reach() {
    let project = Project::new();
    for (config, least) in [("default", 400), ("excavator", 200)] {
        let command = format!("load-chart --config assets/config/{config}.ron --json chart.json");
        let summary = check_success(&project.kinematics(&command));
        assert!(summary.contains("greatest payload: "), "{summary}");
        let text = std::fs::read_to_string(project.path("chart.json")).unwrap();
        let chart: Value = serde_json::from_str(&text).unwrap();
        let points = chart["points"].as_array().unwrap();
        let columns = chart["x"]["points"].as_u64().unwrap() as usize;
        assert_eq!(points.len(), columns * chart["z"]["points"].as_u64().unwrap() as usize, "{config}");
        assert!(points.iter().filter(|point| !point.is_null()).count() >= least, "{config}: {summary}");
        // Half way up, the farther half of the columns in reach carries less at its end than at its beginning.
        let row = &points[points.len() / columns / 2 * columns..][..columns];
        let payloads: Vec<f64> = row.iter().filter_map(|point| point["payload"].as_f64()).collect();
        assert!(
            payloads.len() > 5 && payloads[payloads.len() - 1] < payloads[payloads.len() / 2],
            "{payloads:?}"
        );
    }
}
