//! Bad input ends in one clear line that names who, which field and why. The caller adds the name of the file.

mod support;

use hiab_dynamics::{CraneModel, DynamicsError, PlantFile, Wrench};
use support::{LOOPS, PLANTS, URDF, check_line, check_loops, check_urdf, crane, edited, position_at};

#[test]
fn refuses_a_urdf_that_is_not_one() {
    check_urdf("</robot>", "", "urdf: 74:1 Unexpected end of stream");
    check_urdf("<link name=\"tip\"/>", "<link name=\"tip\">", "urdf: 73:");
    let half = CraneModel::from_urdf(&URDF[..URDF.len() / 2], LOOPS).unwrap_err().to_string();
    check_line("half a file", &half, "urdf: ");
    for text in ["", "\u{0}", "<robot", "(urdf: 1)"] {
        let message = CraneModel::from_urdf(text, LOOPS).unwrap_err().to_string();
        check_line(text, &message, "urdf: 1:");
    }
    for text in ["<robot name=\"x\"></robot>", "<robot/>", "<html><body/></html>"] {
        let message = CraneModel::from_urdf(text, LOOPS).unwrap_err().to_string();
        check_line(text, &message, "urdf");
    }
}

#[test]
fn refuses_an_incomplete_urdf_with_line_and_owner() {
    let cases = [
        (
            r#"mass value="307.2960138""#,
            r#"mass value="heavy""#,
            "line 9: link `column`: value of <mass> must be a number, got `heavy`",
        ),
        (r#"mass value="307.2960138""#, "mass", "line 9: link `column`: <mass> lacks the attribute `value`"),
        (r#"<mass value="307.2960138"/>"#, "", "line 9: link `column`: <inertial> lacks <mass>"),
        (r#" izz="5.259171""#, "", "line 9: link `column`: <inertia> lacks the attribute `izz`"),
        (
            r#"xyz="0.185 0 0.205""#,
            r#"xyz="0.185 0""#,
            "joint `lift_barrel_joint`: xyz of <origin> must be three numbers, got `0.185 0`",
        ),
        (r#"<parent link="base_link"/>"#, "", "joint `slew_joint`: <joint> lacks <parent>"),
        (r#"<link name="tip"/>"#, "<link/>", "a link: <link> lacks the attribute `name`"),
    ];
    for (from, to, expected) in cases {
        check_urdf(from, to, expected);
    }
    let stranger = r#"<gazebo><joint/><mass value="none"/></gazebo></robot>"#;
    CraneModel::from_urdf(&edited(URDF, "</robot>", stranger), LOOPS).unwrap();
}

#[test]
fn refuses_names_that_do_not_match() {
    let missing = "actuator `lift_joint`: joint names the joint `lift_joint`, which the urdf does not have";
    check_urdf(r#"name="lift_joint""#, r#"name="lift""#, missing);
    check_urdf(
        r#"name="boom_joint""#,
        r#"name="boom""#,
        "loop `lift`: dependent names the moving joint `boom_joint`, which the urdf does not have",
    );
    check_urdf(
        r#"<parent link="boom"/><child link="stick"/>"#,
        r#"<parent link="bom"/><child link="stick"/>"#,
        "joint `stick_joint`: parent names the link `bom`, which the urdf does not have",
    );
    check_urdf(r#"<link name="boom">"#, r#"<link name="column">"#, "two links are named `column`");
    check_loops(
        r#"(joint: "slew_joint""#,
        r#"(joint: "tip_fixed""#,
        "actuator `tip_fixed`: the joint is fixed",
    );
    check_loops(r#"(joint: "slew_joint""#, r#"(joint: "lift_joint""#, "two actuators are named `lift_joint`");
    check_loops(r#"tip_link: "tip""#, r#"tip_link: "top""#, "loop file: tip_link names the link `top`");
    check_loops(
        r#"tip_link: "tip""#,
        r#"tip_link: "base_link""#,
        "tip_link `base_link` is fixed to the ground",
    );
    check_loops(
        r#"frame_a: "lift_loop_a""#,
        r#"frame_a: "pin""#,
        "loop `lift`: frame_a names the link `pin`",
    );
    check_loops(r#"name: "tilt""#, r#"name: "lift""#, "two loops are named `lift`");
}

#[test]
fn refuses_links_and_joints_that_are_no_tree() {
    check_urdf(r#"<parent link="base_link"/>"#, r#"<parent link="tip"/>"#, "the urdf is not one tree: ");
    check_urdf(
        r#"<parent link="stick"/><child link="telescope"/>"#,
        r#"<parent link="stick"/><child link="boom"/>"#,
        "link `boom` is the child of joints `boom_joint` and `telescope_joint`",
    );
    check_urdf(
        r#"<link name="tip"/>"#,
        r#"<link name="tip"/><link name="loose"/>"#,
        "`loose` both have no parent",
    );
    check_urdf(
        r#"name="wrist_roll_joint" type="revolute""#,
        r#"name="wrist_roll_joint" type="floating""#,
        "joint `wrist_roll_joint`: type floating is not supported",
    );
    check_urdf(
        r#"<axis xyz="0 0 1"/><limit lower="-3.5""#,
        r#"<axis xyz="0 0 0"/><limit lower="-3.5""#,
        "joint `slew_joint`: axis has length zero",
    );
    check_urdf(
        r#"<axis xyz="0 0 1"/><limit lower="-3.5""#,
        r#"<axis xyz="0 NaN 1"/><limit lower="-3.5""#,
        "joint `slew_joint`: axis must be finite, got NaN",
    );
}

#[test]
fn refuses_masses_and_inertias_that_no_body_has() {
    let mass = r#"<mass value="307.2960138"/>"#;
    check_urdf(
        mass,
        r#"<mass value="0"/>"#,
        "link `column`: mass must be > 0 for a link with inertia and never negative, got 0",
    );
    check_urdf(
        mass,
        r#"<mass value="-1"/>"#,
        "link `column`: mass must be > 0 for a link with inertia and never negative, got -1",
    );
    check_urdf(mass, r#"<mass value="NaN"/>"#, "link `column`: mass must be finite, got NaN");
    check_urdf(mass, r#"<mass value="inf"/>"#, "link `column`: mass must be finite, got inf");
    check_urdf(r#"ixx="29.30269609""#, r#"ixx="NaN""#, "link `column`: inertia must be finite, got NaN");
    check_urdf(r#"ixx="29.30269609""#, r#"ixx="-29.3""#, "link `column`: inertia has principal moments");
    check_urdf(
        r#"ixx="29.30269609""#,
        r#"ixx="99""#,
        "they must be such that the two smaller ones add up to at least the third",
    );
    check_urdf(
        r#"<mass value="35"/><inertia ixx="0.149333333" ixy="0.05" ixz="-0.03" iyy="0.337166667" iyz="0.01" izz="0.337166667"/>"#,
        r#"<mass value="35"/><inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/>"#,
        "link `tool`: inertia has principal moments [0.0, 0.0, 0.0]; they must be positive on a moving body",
    );
    check_urdf(
        r#"<mass value="35"/><inertia ixx="0.149333333" ixy="0.05" ixz="-0.03" iyy="0.337166667" iyz="0.01" izz="0.337166667"/>"#,
        r#"<mass value="0"/><inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/>"#,
        "link `tool` moves by joint `wrist_roll_joint` but has no mass",
    );
}

#[test]
fn refuses_a_loop_that_cannot_close() {
    let lift = r#"(joint: "lift_joint", lower: 0.14, upper: 0.5,"#;
    check_loops(
        lift,
        r#"(joint: "lift_joint", lower: 0.14, upper: 0.6,"#,
        "loop `lift` cannot be closed over the range of `lift_joint`: strokes 0.14 to 0.6 wanted, 0 to 0.55",
    );
    check_loops(
        lift,
        r#"(joint: "lift_joint", lower: -0.3, upper: 0.5,"#,
        "loop `lift` cannot be closed over the range of `lift_joint`: strokes -0.3 to 0.5 wanted",
    );
    check_urdf(
        r#"<origin xyz="0.185 0 0.205""#,
        r#"<origin xyz="5 0 0.205""#,
        "loop `lift` cannot be closed",
    );
    check_urdf(
        r#"<child link="lift_loop_b"/><origin xyz="0.369722821 0 -0.069""#,
        r#"<child link="lift_loop_b"/><origin xyz="0.369722821 0.1 -0.069""#,
        "loop `lift` is not planar: the gap between its pins along the hinge axis is 1e-1, more than 1e-6",
    );
    check_urdf(
        r#"<child link="lift_loop_b"/><origin xyz="0.369722821 0 -0.069""#,
        r#"<child link="lift_loop_b"/><origin xyz="0 0 0""#,
        "loop `lift`: the side between the turned joint and the pin has length zero",
    );
    check_urdf(
        r#"<child link="lift_barrel"/><origin xyz="0.185 0 0.205" rpy="0 0 0"/>"#,
        r#"<child link="lift_barrel"/><origin xyz="0.185 0 0.205" rpy="0.1 0 0"/>"#,
        "loop `lift` is not planar: the sine of the angle between its hinge axes",
    );
}

#[test]
fn refuses_a_loop_that_is_no_cylinder_between_two_hinges() {
    let dependent = r#"dependent: ["boom_joint", "lift_barrel_joint"]"#;
    check_loops(
        dependent,
        r#"dependent: ["boom_joint"]"#,
        "loop `lift`: dependent must name two joints, got 1",
    );
    check_loops(
        dependent,
        r#"dependent: ["boom_joint", "stick_joint"]"#,
        "loop `lift`: no dependent joint carries the barrel",
    );
    check_loops(
        dependent,
        r#"dependent: ["slew_joint", "lift_barrel_joint"]"#,
        "joint `slew_joint` is an actuator and a dependent joint of loop `lift`",
    );
    check_loops(
        r#"independent: "lift_joint""#,
        r#"independent: "slew_joint""#,
        "loop `lift`: independent `slew_joint` must be prismatic",
    );
    check_loops(
        r#"independent: "lift_joint""#,
        r#"independent: "telescope_joint""#,
        "loop `lift`: no dependent joint carries the barrel",
    );
    check_loops(
        r#"frame_a: "lift_loop_a""#,
        r#"frame_a: "tip""#,
        "loop `lift`: of frame_a and frame_b one must be on the rod moved by `lift_joint`",
    );
    check_loops(
        r#"frame_a: "lift_loop_a""#,
        r#"frame_a: "lift_loop_b""#,
        "loop `lift`: of frame_a and frame_b one must be on the rod",
    );
    check_loops(
        "branch: Positive),\n        (name: \"tilt\"",
        "branch: Up),\n        (name: \"tilt\"",
        "loop file: ",
    );
}

#[test]
fn refuses_a_joint_that_nothing_moves() {
    let slew = r#"(joint: "slew_joint", lower: -3.5, upper: 3.5, effort: 8000.0, velocity: 0.5, acceleration: 1.0, jerk: 100.0, armature: 0.0),"#;
    check_loops(
        slew,
        "",
        "joint `slew_joint` moves, but is neither an actuator nor a dependent joint of a loop",
    );
}

#[test]
fn refuses_actuator_limits_out_of_range() {
    let slew = "lower: -3.5, upper: 3.5, effort: 8000.0, velocity: 0.5, acceleration: 1.0, jerk: 100.0, armature: 0.0";
    for field in ["effort: 8000.0", "velocity: 0.5", "acceleration: 1.0", "jerk: 100.0"] {
        let name = field.split(':').next().unwrap();
        for (value, rule) in [
            ("0.0", "must be > 0, got 0"),
            ("-1.0", "must be > 0, got -1"),
            ("NaN", "must be finite, got NaN"),
            ("inf", "must be finite, got inf"),
        ] {
            let expected = format!("actuator `slew_joint`: {name} {rule}");
            check_loops(slew, &edited(slew, field, &format!("{name}: {value}")), &expected);
        }
    }
    let empty = "actuator `slew_joint`: lower must be below upper, got lower";
    check_loops(slew, &edited(slew, "lower: -3.5", "lower: 4.0"), empty);
    check_loops(slew, &edited(slew, "lower: -3.5", "lower: 3.5"), empty);
    check_loops(
        slew,
        &edited(slew, "lower: -3.5", "lower: NaN"),
        "actuator `slew_joint`: lower must be finite, got NaN",
    );
    check_loops(
        slew,
        &edited(slew, "armature: 0.0", "armature: -1.0"),
        "actuator `slew_joint`: armature must be >= 0, got -1",
    );
}

#[test]
fn refuses_a_loop_file_with_its_line() {
    check_loops("tip_link:", "tip_linc:", "loop file: 4:");
    check_loops(r#"tip_link: "tip","#, "", "tip_link");
    check_loops(
        r#"(joint: "lift_joint", lower: 0.14,"#,
        r#"(joint: "lift_joint", lowest: 0.1, lower: 0.14,"#,
        "lowest",
    );
    check_loops(
        r#"(joint: "lift_joint", lower: 0.14,"#,
        r#"(joint: "lift_joint", lower: zero,"#,
        "loop file: ",
    );
    check_line("empty", &CraneModel::from_urdf(URDF, "").unwrap_err().to_string(), "loop file: 1:1");
}

#[test]
fn refuses_payload_and_gravity_out_of_range() {
    for (payload, expected) in [
        (-1.0, "payload: mass must be >= 0, got -1"),
        (f64::NAN, "payload: mass must be finite, got NaN"),
        (f64::INFINITY, "payload: mass must be finite, got inf"),
    ] {
        check_line("payload", &crane().with_payload(payload).unwrap_err().to_string(), expected);
    }
    let message = crane().with_gravity([0.0, f64::NAN, 0.0]).unwrap_err().to_string();
    check_line("gravity", &message, "world: gravity must be finite, got NaN");
}

#[test]
fn refuses_plants_out_of_range() {
    let lift =
        r#""lift_joint":      (armature: 0.0, coulomb: 4000.0, viscous: 3000.0, transition_velocity: 0.01)"#;
    let cases = [
        (
            "armature: 0.0",
            "armature: -1.0",
            "actuator `lift_joint`: armature must be finite and >= 0, got -1",
        ),
        (
            "coulomb: 4000.0",
            "coulomb: NaN",
            "actuator `lift_joint`: coulomb must be finite and >= 0, got NaN",
        ),
        (
            "viscous: 3000.0",
            "viscous: inf",
            "actuator `lift_joint`: viscous must be finite and >= 0, got inf",
        ),
        (
            "transition_velocity: 0.01",
            "transition_velocity: 0.0",
            "actuator `lift_joint`: transition_velocity must be finite and > 0, got 0",
        ),
        ("viscous: 3000.0", "viscos: 3000.0", "plant file: 16:"),
    ];
    for (from, to, expected) in cases {
        let text = edited(PLANTS, lift, &edited(lift, from, to));
        check_line(to, &PlantFile::from_ron(&text).unwrap_err().to_string(), expected);
    }
    let plants = PlantFile::from_ron(PLANTS).unwrap();
    let message = plants.plant("pneumatic").unwrap_err().to_string();
    check_line(
        "plant",
        &message,
        r#"no plant is named `pneumatic`; there are ["electric", "hydraulic", "rigid"]"#,
    );
    let stranger = PlantFile::from_ron(&PLANTS.replace("lift_joint", "hoist_joint")).unwrap();
    let message = crane().with_plant(stranger.plant("electric").unwrap()).unwrap_err().to_string();
    check_line("plant", &message, "the plant names `hoist_joint`, which is not an actuator of the model");
}

#[test]
fn refuses_states_that_it_cannot_evaluate_and_leaves_them_as_they_are() {
    let model = crane();
    let mut data = model.new_data();
    let middle = position_at(&model, &[0.5; 7]);
    let still = [0.0; 7];
    let lift = model.actuator_index("lift_joint").unwrap();

    let short = model.update_dynamics(&mut data, &middle[..6], &still).unwrap_err();
    check_line("short", &short.to_string(), "position must have 7 values, got 6");
    let mut nan = still;
    nan[2] = f64::NAN;
    let message = model.update_dynamics(&mut data, &middle, &nan).unwrap_err().to_string();
    check_line("velocity", &message, "velocity[2] must be finite, got NaN");
    let mut out = [0.0; 7];
    let message =
        model.forward_dynamics(&mut data, &middle, &still, &nan, None, &mut out).unwrap_err().to_string();
    check_line("effort", &message, "effort[2] must be finite, got NaN");
    let wrench = Wrench { force: [0.0, f64::INFINITY, 0.0], moment: [0.0; 3] };
    let error =
        model.inverse_dynamics(&mut data, &middle, &still, &still, Some(&wrench), &mut out).unwrap_err();
    check_line("wrench", &error.to_string(), "tip_wrench.force[1] must be finite, got inf");
    let message = model.tip_jacobian(&data, &mut [0.0; 41]).unwrap_err().to_string();
    check_line("jacobian", &message, "jacobian must have 42 values, got 41");

    for stroke in [-0.01, 0.56, 1e9] {
        let (mut position, mut velocity) = (middle.clone(), still);
        position[lift] = stroke;
        let before = position.clone();
        let error = model
            .semi_implicit_euler(&mut data, &mut position, &mut velocity, &still, None, 1e-3)
            .unwrap_err();
        assert!(matches!(error, DynamicsError::StrokeOutsideLoop { .. }), "{error}");
        check_line("stroke", &error.to_string(), "loop `lift` has no usable solution at stroke");
        assert_eq!((position, velocity), (before, still), "stroke {stroke}: the state was touched");
    }
    for period in [0.0, -1e-3, f64::NAN, f64::INFINITY] {
        let (mut position, mut velocity) = (middle.clone(), still);
        for step in [CraneModel::semi_implicit_euler, CraneModel::rk4] {
            let error =
                step(&model, &mut data, &mut position, &mut velocity, &still, None, period).unwrap_err();
            check_line("period", &error.to_string(), "period must be finite and > 0, got");
        }
        assert_eq!((position, velocity), (middle.clone(), still), "period {period}: the state was touched");
    }
    let (mut position, mut velocity) = (middle.clone(), still);
    let error = model
        .semi_implicit_euler(&mut data, &mut position, &mut velocity, &[1e300; 7], None, 1e10)
        .unwrap_err();
    assert!(matches!(error, DynamicsError::Diverged { .. }), "{error}");
    assert_eq!((position, velocity), (middle, still), "a step that diverges leaves the state");
}
