//! Bad files are refused with one line that names the file, the field and the cause.

mod support;

use support::{Project, check_refusal};

const URDF: &str = "assets/hiab/hiab.urdf";
const LOOPS: &str = "assets/hiab/hiab.ron";
const CONFIG: &str = "assets/config/default.ron";
const ZONE: &str = "zone --joint lift_joint --position 0.3 --velocity 0";

/// A zone of the crane must be refused after one replacement in a file.
#[track_caller]
fn check_edit(file: &str, old: &str, new: &str, parts: &[&str]) {
    let project = Project::new();
    project.edit(file, old, new);
    check_refusal(&project.kinematics(ZONE), &[&[file], parts].concat());
}

#[test]
fn a_missing_file_is_named() {
    for file in [URDF, LOOPS, CONFIG, "assets/hiab/plants.ron", "assets/tables/lift_joint.ron"] {
        let project = Project::new();
        std::fs::remove_file(project.path(file)).expect("the file is there");
        check_refusal(&project.kinematics(ZONE), &[file, "No such file"]);
    }
}

#[test]
fn a_urdf_without_a_joint_of_the_loops_is_refused() {
    check_edit(URDF, "name=\"boom_joint\"", "name=\"bom_joint\"", &["boom_joint"]);
}

#[test]
fn a_mass_that_is_not_positive_is_refused() {
    let project = Project::new();
    let urdf = project.text(URDF);
    let mass =
        urdf.split("<mass value=\"").nth(2).and_then(|rest| rest.split('"').next()).expect("there is a mass");
    for bad in ["0", "-3", "NaN"] {
        check_edit(
            URDF,
            &format!("<mass value=\"{mass}\""),
            &format!("<mass value=\"{bad}\""),
            &["mass", bad],
        );
    }
}

#[test]
fn a_urdf_that_is_no_xml_is_refused() {
    let project = Project::new();
    let half = project.text(URDF);
    project.write(URDF, &half[..half.len() / 2]);
    check_refusal(&project.kinematics(ZONE), &[URDF]);
}

#[test]
fn a_loop_that_cannot_close_is_refused() {
    // Beyond stroke 0.553 m the lift triangle has no solution.
    check_edit(
        LOOPS,
        "\"lift_joint\", lower: 0.14, upper: 0.5",
        "\"lift_joint\", lower: 0.14, upper: 2.5",
        &["lift"],
    );
}

#[test]
fn an_unknown_key_is_named_with_its_line() {
    check_edit(CONFIG, "seed: 0,", "sed: 0,", &["sed", ":5:"]);
    check_edit(LOOPS, "tip_link:", "tip:", &["tip"]);
    check_edit("assets/hiab/plants.ron", "armature: 1000.0", "armatur: 1000.0", &["armatur"]);
    check_edit(
        "assets/tables/lift_joint.ron",
        "subdivisions:",
        "subdivision:",
        &["subdivision", "cargo xtask tables"],
    );
}

#[test]
fn a_limit_of_zero_or_nan_is_refused() {
    for (quantity, good) in [("velocity", "0.15"), ("acceleration", "1.0"), ("jerk", "100.0")] {
        for bad in ["0.0", "-1.0", "NaN"] {
            let project = Project::new();
            let loops = project.text(LOOPS);
            let line =
                loops.lines().find(|line| line.contains("\"lift_joint\", lower")).expect("lift has limits");
            let changed = line.replace(&format!("{quantity}: {good}"), &format!("{quantity}: {bad}"));
            assert_ne!(line, changed);
            check_edit(LOOPS, line, &changed, &["lift_joint", quantity]);
        }
    }
}

#[test]
fn a_stale_table_is_refused_with_the_command_that_rebuilds_it() {
    let project = Project::new();
    project.edit(LOOPS, "\"lift_joint\", lower: 0.14", "\"lift_joint\", lower: 0.15");
    check_refusal(&project.kinematics(ZONE), &["assets/tables/lift_joint.ron", "cargo xtask tables"]);
    support::check_success(&project.kinematics("tables"));
    support::check_success(&project.kinematics(ZONE));
}

#[test]
fn a_table_that_was_edited_is_refused() {
    let project = Project::new();
    let table = project.text("assets/tables/lift_joint.ron");
    let knot =
        table.split("velocity: ").nth(5).and_then(|rest| rest.split(',').next()).expect("there are knots");
    check_edit(
        "assets/tables/lift_joint.ron",
        &format!("velocity: {knot}"),
        "velocity: 0.09",
        &["cargo xtask tables"],
    );
}

#[test]
fn rates_that_do_not_fit_are_refused() {
    check_edit(CONFIG, "policy_divider: 100", "policy_divider: 99", &["rates.policy_divider", "99"]);
    check_edit(CONFIG, "reference_divider: 2", "reference_divider: 0", &["rates.reference_divider", "0"]);
}

#[test]
fn an_unknown_joint_is_answered_with_the_known_ones() {
    let refused = Project::new().kinematics("zone --joint lift --position 0.3 --velocity 0");
    check_refusal(&refused, &["'lift'", "lift_joint"]);
}

#[test]
fn a_number_that_is_none_is_refused() {
    let project = Project::new();
    check_refusal(
        &project.kinematics("zone --joint lift_joint --position NaN --velocity 0"),
        &["--position", "NaN"],
    );
    check_refusal(&project.kinematics("zone --joint lift_joint --position 0.3"), &["--velocity is missing"]);
}
