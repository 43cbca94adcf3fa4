//! Machines other than the crane, made here, with results that can be written down.
#![expect(clippy::unwrap_used, reason = "helpers of tests are tests too")]

mod support;

use hiab_dynamics::CraneModel;
use proptest::prelude::*;
use support::{distance, tolerance};

const GRAVITY: f64 = 9.81;

#[track_caller]
fn check_close(quantity: &str, found: f64, expected: f64, bound: f64) {
    let error = (found - expected).abs() / expected.abs().max(1.0);
    assert!(
        error <= bound,
        "{quantity} is {found}, not {expected}: relative error {error:e} exceeds {bound:e}"
    );
}

fn actuator(joint: &str, lower: f64, upper: f64) -> String {
    format!(
        "(joint: \"{joint}\", lower: {lower:?}, upper: {upper:?}, effort: 1.0, velocity: 1.0, \
         acceleration: 1.0, jerk: 1.0, armature: 0.0),"
    )
}

/// Two rods in the xz plane, with centres `c`, masses `m`, inertias `i` and the first one `l` long.
#[test]
fn a_double_pendulum_has_the_textbook_terms() {
    let (m, c, i, l) = ([3.0, 2.0], [0.4, 0.3], [0.5, 0.2], 0.9);
    let link = |k: usize| {
        format!(
            r#"<link name="rod{k}"><inertial><origin xyz="{0} 0 0"/><mass value="{1}"/>
            <inertia ixx="{2}" ixy="0" ixz="0" iyy="{2}" iyz="0" izz="{2}"/></inertial></link>"#,
            c[k], m[k], i[k]
        )
    };
    let joint = |k: usize, parent: &str, x: f64| {
        format!(
            r#"<joint name="hinge{k}" type="continuous"><parent link="{parent}"/><child link="rod{k}"/>
            <origin xyz="{x} 0 0"/><axis xyz="0 -3 0"/></joint>"#
        )
    };
    let urdf = format!(
        r#"<robot name="pendulum"><link name="ground"/>{}{}{}{}</robot>"#,
        link(0),
        link(1),
        joint(0, "ground", 0.0),
        joint(1, "rod0", l)
    );
    let loops = format!(
        "(urdf: \"\", tip_link: \"rod1\", closed_loops: [], actuators: [{}{}])",
        actuator("hinge0", -3.0, 3.0),
        actuator("hinge1", -3.0, 3.0)
    );
    let model = CraneModel::from_urdf(&urdf, &loops).unwrap();
    let mut data = model.new_data();
    for (q1, q2, v1, v2) in [(0.0, 0.0, 0.0, 0.0), (0.7, -1.1, 0.5, 2.0), (-2.5, 2.9, -1.5, 0.3)] {
        model.update_dynamics(&mut data, &[q1, q2], &[v1, v2]).unwrap();
        let coupling = m[1] * l * c[1];
        let m22 = i[1] + m[1] * c[1] * c[1];
        let m12 = m22 + coupling * q2.cos();
        let m11 = i[0] + m[0] * c[0] * c[0] + m[1] * l * l + m22 + 2.0 * coupling * q2.cos();
        for (k, expected) in [m11, m12, m12, m22].into_iter().enumerate() {
            check_close("mass matrix", data.mass_matrix()[k], expected, tolerance::ROUNDING);
        }
        let g2 = m[1] * GRAVITY * c[1] * (q1 + q2).cos();
        let g1 = (m[0] * c[0] + m[1] * l) * GRAVITY * q1.cos() + g2;
        let s = coupling * q2.sin();
        let c1 = -s * (2.0 * v1 * v2 + v2 * v2);
        let c2 = s * v1 * v1;
        for (k, (gravity, coriolis)) in [(g1, c1), (g2, c2)].into_iter().enumerate() {
            check_close("gravity", data.gravity_effort()[k], gravity, tolerance::ROUNDING);
            check_close("bias", data.bias()[k], gravity + coriolis, tolerance::ROUNDING);
        }
    }
}

/// A boom hinged at O, turned by a cylinder hinged at C below it; pin P on the boom.
///
/// `Positive` places P ahead of OC, seen along the hinge axis −y. `tilt` turns the barrel's zero direction and `offset`
/// moves the pin off the barrel's axis, so that neither is special.
#[derive(Clone, Debug)]
struct Hoist {
    below: f64,
    ahead: f64,
    arm: f64,
    length: f64,
    offset: f64,
    tilt: f64,
    opposite_axis: bool,
    branch: &'static str,
}

const HOIST: Hoist = Hoist {
    below: 0.8,
    ahead: 0.1,
    arm: 0.5,
    length: 0.7,
    offset: 0.0,
    tilt: 0.0,
    opposite_axis: false,
    branch: "Positive",
};
const BOOM: (f64, f64, f64) = (40.0, 0.9, 12.0); // mass, centre, inertia about it
const BARREL: (f64, f64, f64) = (6.0, 0.25, 0.3);
const ROD: (f64, f64, f64) = (4.0, -0.2, 0.25);

impl Hoist {
    fn model(&self, lower: f64, upper: f64) -> CraneModel {
        let link = |name: &str, (mass, center, inertia): (f64, f64, f64)| {
            format!(
                r#"<link name="{name}"><inertial><origin xyz="{center} 0 0"/><mass value="{mass}"/>
                <inertia ixx="0.1" ixy="0" ixz="0" iyy="{inertia}" iyz="0" izz="{inertia}"/></inertial></link>"#
            )
        };
        let axis = if self.opposite_axis { "0 1 0" } else { "0 -1 0" };
        let Self { below, ahead, arm, length, offset, tilt, .. } = self;
        let urdf = format!(
            r#"<robot name="hoist"><link name="ground"/>{}{}{}<link name="half_a"/><link name="half_b"/>
            <joint name="hinge" type="continuous"><parent link="ground"/><child link="boom"/>
              <axis xyz="0 -1 0"/></joint>
            <joint name="barrel_hinge" type="continuous"><parent link="ground"/><child link="barrel"/>
              <origin xyz="{ahead} 0 -{below}" rpy="0 {tilt} 0"/><axis xyz="{axis}"/></joint>
            <joint name="cylinder" type="prismatic"><parent link="barrel"/><child link="rod"/>
              <origin xyz="{length} 0 0"/><axis xyz="1 0 0"/><limit lower="0" upper="1" effort="1" velocity="1"/></joint>
            <joint name="a" type="fixed"><parent link="rod"/><child link="half_a"/><origin xyz="0 0 {offset}"/></joint>
            <joint name="b" type="fixed"><parent link="boom"/><child link="half_b"/><origin xyz="{arm} 0 0"/></joint>
            </robot>"#,
            link("boom", BOOM),
            link("barrel", BARREL),
            link("rod", ROD),
        );
        let loops = format!(
            "(urdf: \"\", tip_link: \"half_b\", closed_loops: [(name: \"hoist\", frame_a: \"half_b\", \
             frame_b: \"half_a\", kind: Point3d, independent: \"cylinder\", \
             dependent: [\"barrel_hinge\", \"hinge\"], branch: {})], actuators: [{}])",
            self.branch,
            actuator("cylinder", lower, upper),
        );
        CraneModel::from_urdf(&urdf, &loops).unwrap()
    }

    /// Boom angle and cylinder angle, both from the horizontal, by the law of cosines.
    fn angles(&self, stroke: f64) -> (f64, f64) {
        let (a, b, l) = (self.below.hypot(self.ahead), self.arm, self.length + stroke);
        let towards_c = (-self.below).atan2(self.ahead);
        let at_o = ((a * a + b * b - l * l) / (2.0 * a * b)).acos();
        let boom = towards_c + at_o;
        let (px, pz) = (b * boom.cos() - self.ahead, b * boom.sin() + self.below);
        (boom, pz.atan2(px))
    }

    /// Rates of both angles per stroke: the pin moves across OP, and along the cylinder at unit rate.
    fn rates(&self, stroke: f64) -> (f64, f64) {
        let (boom, cylinder) = self.angles(stroke);
        let boom_rate = 1.0 / (self.arm * (cylinder - boom).sin());
        let across = self.arm * boom_rate * (cylinder - boom).cos();
        (boom_rate, across / (self.length + stroke))
    }

    fn inertia(&self, stroke: f64) -> f64 {
        let (boom, cylinder) = self.rates(stroke);
        let rod_center = self.length + stroke + ROD.1;
        (BOOM.2 + BOOM.0 * BOOM.1 * BOOM.1) * boom * boom
            + (BARREL.2 + BARREL.0 * BARREL.1 * BARREL.1 + ROD.2 + ROD.0 * rod_center * rod_center)
                * cylinder
                * cylinder
            + ROD.0
    }

    fn weight(&self, stroke: f64) -> f64 {
        let ((boom, cylinder), (boom_rate, cylinder_rate)) = (self.angles(stroke), self.rates(stroke));
        let rod_center = self.length + stroke + ROD.1;
        GRAVITY
            * (BOOM.0 * BOOM.1 * boom.cos() * boom_rate
                + (BARREL.0 * BARREL.1 + ROD.0 * rod_center) * cylinder.cos() * cylinder_rate
                + ROD.0 * cylinder.sin())
    }
}

#[test]
fn a_hoist_on_one_cylinder_has_the_terms_of_its_lagrangian() {
    let model = HOIST.model(0.0, 0.4);
    let mut data = model.new_data();
    for stroke in [0.0, 0.05, 0.13, 0.2, 0.31, 0.4] {
        for velocity in [0.0, 0.3, -1.2] {
            model.update_dynamics(&mut data, &[stroke], &[velocity]).unwrap();
            check_close("inertia", data.mass_matrix()[0], HOIST.inertia(stroke), tolerance::ROUNDING);
            check_close("weight", data.gravity_effort()[0], HOIST.weight(stroke), tolerance::ROUNDING);
            // d/dt (∂T/∂ẏ) − ∂T/∂y at ÿ = 0 is ½ M′ ẏ².
            let h = tolerance::DIFFERENCE_STEP;
            let slope = (HOIST.inertia(stroke + h) - HOIST.inertia(stroke - h)) / (2.0 * h);
            let bias = HOIST.weight(stroke) + 0.5 * slope * velocity * velocity;
            check_close("bias", data.bias()[0], bias, tolerance::DIFFERENCE);
        }
    }
}

#[test]
fn the_branch_chooses_the_side_of_the_pin() {
    for (branch, side) in [("Positive", 1.0), ("Negative", -1.0)] {
        let model = Hoist { branch, ..HOIST }.model(0.0, 0.4);
        let mut data = model.new_data();
        for stroke in [0.0, 0.2, 0.4] {
            model.update_kinematics(&mut data, &[stroke], &[0.0]).unwrap();
            let [x, _, z] = model.tip_pose(&data).position;
            // OC × OP about −y, positive where the pin is ahead of the hinge line.
            let turn = HOIST.ahead * z + HOIST.below * x;
            assert!(side * turn > 0.0, "{branch}: the pin is at ({x}, {z}) for stroke {stroke}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_hoist_closes_and_keeps_its_energy_balance(
        (below, ahead, arm, length) in (0.6..1.2, -0.3..0.3, 0.3..0.55, 0.55..0.7),
        (offset, tilt) in (-0.15..0.15, -3.0..3.0),
        opposite_axis: bool,
        branch in prop_oneof![Just("Positive"), Just("Negative")],
        (share, velocity) in (0.05..0.95, -1.0..1.0),
    ) {
        let hoist = Hoist { below, ahead, arm, length, offset, tilt, opposite_axis, branch };
        // A range that surely closes: around a right angle at the hinge.
        let a = f64::hypot(below, ahead);
        let third_side = |cos: f64| (a * a + arm * arm - 2.0 * a * arm * cos - offset * offset).sqrt();
        let (lower, upper) = (third_side(0.1) - length, third_side(-0.1) - length);
        let stroke = lower + share * (upper - lower);
        let model = hoist.model(lower, upper);
        let mut data = model.new_data();
        model.update_dynamics(&mut data, &[stroke], &[velocity]).unwrap();

        let [pin_a, pin_b] = ["half_a", "half_b"]
            .map(|name| model.link_pose(&data, model.link_index(name).unwrap()).position);
        prop_assert!(distance(pin_a, pin_b) < tolerance::ROUNDING, "gap {:e}", distance(pin_a, pin_b));

        // Ė = 0 at the acceleration of no effort, by differences along the motion.
        let mut acceleration = [0.0];
        model.forward_dynamics(&mut data, &[stroke], &[velocity], &[0.0], None, &mut acceleration).unwrap();
        let mut energy = |t: f64| {
            let y = stroke + velocity * t + 0.5 * acceleration[0] * t * t;
            model.update_kinematics(&mut data, &[y], &[velocity + acceleration[0] * t]).unwrap();
            [model.kinetic_energy(&data), model.potential_energy(&data)]
        };
        let h = tolerance::DIFFERENCE_STEP;
        let (after, before) = (energy(h), energy(-h));
        let rates = [0, 1].map(|k| (after[k] - before[k]) / (2.0 * h));
        check_close("power of gravity", rates[0], -rates[1], tolerance::DIFFERENCE);
    }
}
