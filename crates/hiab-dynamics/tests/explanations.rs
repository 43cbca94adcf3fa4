//! Refusals that say where and why: loops that do not close, misspelt parts, directions that are closed.

mod support;

use hiab_dynamics::{CraneModel, DynamicsError};
use support::{LOOPS, URDF, check_line, check_loops, check_urdf, crane, edited, position_at};

#[test]
fn says_why_and_at_which_stroke_a_loop_does_not_close() {
    let lift = r#"(joint: "lift_joint", lower: 0.14, upper: 0.5,"#;
    check_loops(
        lift,
        r#"(joint: "lift_joint", lower: 0.14, upper: 0.552,"#,
        "at stroke 0.552 the loop is near-singular: `boom_joint` and both pins of the cylinder are 0.0",
    );
    check_loops(
        lift,
        r#"(joint: "lift_joint", lower: 0.14, upper: 0.7,"#,
        "at stroke 0.7 the rod overshoots its pin by 0.14",
    );
    check_urdf(
        r#"<origin xyz="0.185 0 0.205""#,
        r#"<origin xyz="5 0 0.205""#,
        "at stroke 0.14 the rod ends 3.9",
    );
    let cylinder = r#"<child link="lift_rod"/><origin xyz="0.83 0 0" rpy="0 0 0"/><axis xyz="1 0 0"/>"#;
    check_urdf(
        cylinder,
        &cylinder.replace("0.83 0 0", "0.83 0 9"),
        "loop `lift` cannot be closed at any stroke of `lift_joint`: the rod overshoots its pin by",
    );
    check_urdf(
        cylinder,
        &cylinder.replace(r#"xyz="0.83 0 0""#, r#"xyz="-0.83 0 0""#),
        "at stroke 0.14 the pin of the rod would lie behind the hinge of its barrel",
    );
    check_urdf(
        cylinder,
        &cylinder.replace(r#"axis xyz="1 0 0""#, r#"axis xyz="1 0.1 0""#),
        "loop `lift` is not planar: the cylinder's slope to the hinges' plane is 9.95",
    );
    check_loops(
        "frame_b: \"lift_loop_b\", kind: Point3d",
        "frame_b: \"lift_loop_b\", kind: Frame6d",
        "loop `lift`: kind Frame6d welds two frames, which no cylinder between hinges does; cut the loop at a pin",
    );
}

#[test]
fn refuses_misspelt_parts_of_a_urdf_instead_of_passing_over_them() {
    let cases = [
        (
            r#"<child link="lift_barrel"/><origin xyz="0.185 0 0.205" rpy="0 0 0"/>"#,
            r#"<child link="lift_barrel"/><origin xyz="0.185 0 0.205" rpi="0 0 0"/>"#,
            "joint `lift_barrel_joint`: <origin> has no attribute `rpi`; it may have `xyz`, `rpy`",
        ),
        (
            r#"<child link="lift_barrel"/><origin xyz="0.185 0 0.205" rpy="0 0 0"/>"#,
            r#"<child link="lift_barrel"/><orgin xyz="0.185 0 0.205" rpy="0 0 0"/>"#,
            "joint `lift_barrel_joint`: <orgin> in <joint> means nothing; is it a misspelt <origin>?",
        ),
        (
            r#"<limit lower="-3.5" upper"#,
            r#"<limit lowe="-3.5" upper"#,
            "joint `slew_joint`: <limit> has no attribute `lowe`; it may have `lower`, `upper`, `effort`, `velocity`",
        ),
        (
            r#"<link name="tip"/>"#,
            r#"<link name="tip"><Inertial><mass value="1"/></Inertial></link>"#,
            "link `tip`: <Inertial> in <link> means nothing; is it a misspelt <inertial>?",
        ),
    ];
    for (from, to, expected) in cases {
        check_urdf(from, to, expected);
    }
    // What other programs add is theirs.
    let stranger = r#"<link name="tip"><contact><mu value="1"/></contact><sensor name="s"/></link>"#;
    CraneModel::from_urdf(&edited(URDF, r#"<link name="tip"/>"#, stranger), LOOPS).unwrap();
}

#[test]
fn refuses_a_tip_inertia_where_the_tip_cannot_go_and_a_direction_that_is_none() {
    let model = crane();
    let mut data = model.new_data();
    model.update_dynamics(&mut data, &position_at(&model, &[0.5; 7]), &[0.0; 7]).unwrap();
    let message = model.apparent_mass(&mut data, [0.0; 3]).unwrap_err().to_string();
    check_line("direction", &message, "direction has length zero");
    let message = model.apparent_mass(&mut data, [f64::NAN, 0.0, 0.0]).unwrap_err().to_string();
    check_line("direction", &message, "direction[0] must be finite, got NaN");

    // A lever moves its tip along one line only.
    let urdf = r#"<robot name="lever"><link name="ground"/><link name="arm"><inertial><origin xyz="0.5 0 0"/>
        <mass value="2"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>
        <link name="end"/><joint name="hinge" type="continuous"><parent link="ground"/><child link="arm"/>
        <axis xyz="0 -1 0"/></joint><joint name="end_fixed" type="fixed"><parent link="arm"/><child link="end"/>
        <origin xyz="1 0 0"/></joint></robot>"#;
    let loops = r#"(urdf: "", tip_link: "end", closed_loops: [], actuators: [(joint: "hinge", lower: -1.0, upper: 1.0,
        effort: 1.0, velocity: 1.0, acceleration: 1.0, jerk: 1.0, armature: 0.0)])"#;
    let model = CraneModel::from_urdf(urdf, loops).unwrap();
    let mut data = model.new_data();
    model.update_dynamics(&mut data, &[0.0], &[0.0]).unwrap();
    let error = model.tip_inertia(&mut data).unwrap_err();
    assert!(matches!(error, DynamicsError::TipNearSingular { .. }), "{error}");
    check_line("lever", &error.to_string(), "the posture is near-singular: the tip hardly gives way along [");
    // Inertia about the hinge is 0.1 + 2·0.5², felt at 1 m.
    let felt = model.apparent_mass(&mut data, [0.0, 0.0, -3.0]).unwrap();
    assert!((felt - 0.6).abs() < 1e-12, "{felt} kg");
    assert_eq!(model.apparent_mass(&mut data, [1.0, 0.0, 0.0]).unwrap(), f64::INFINITY);
}
