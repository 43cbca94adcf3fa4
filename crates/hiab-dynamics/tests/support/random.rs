//! Random machines: trees with branches, and cylinder loops on any of their bodies, loops' own bodies included.

use std::fmt::Write;

use hiab_dynamics::CraneModel;
use proptest::prelude::*;

/// One thing that is attached to an earlier body.
#[derive(Clone, Debug)]
pub enum Part {
    /// A body behind a joint of any axis.
    Joint {
        /// Which body carries it, as a share of those that there are; the ground is the first.
        on: f64,
        prismatic: bool,
        xyz: [f64; 3],
        rpy: [f64; 3],
        axis: [f64; 3],
        mass: Mass,
    },
    /// A cylinder that turns a body, both hinged to an earlier one in any plane: three bodies.
    Hoist {
        on: f64,
        xyz: [f64; 3],
        rpy: [f64; 3],
        /// |OC|, |OP| and the cylinder's length at a right angle between them [m].
        below: f64,
        arm: f64,
        offset: f64,
        branch: bool,
        mass: Mass,
    },
}

/// Mass, centre and, through three squares of radii, inertia that a body can have.
#[derive(Clone, Debug)]
pub struct Mass {
    mass: f64,
    center: [f64; 3],
    rpy: [f64; 3],
    radii: [f64; 3],
}

fn vector(limit: f64) -> impl Strategy<Value = [f64; 3]> {
    proptest::array::uniform3(-limit..limit)
}

fn mass() -> impl Strategy<Value = Mass> {
    (1.0..20.0, vector(0.4), vector(3.0), proptest::array::uniform3(0.01..0.2))
        .prop_map(|(mass, center, rpy, radii)| Mass { mass, center, rpy, radii })
}

fn part() -> impl Strategy<Value = Part> {
    let joint = (0.0..1.0, any::<bool>(), vector(1.0), vector(3.0), vector(1.0), mass()).prop_filter_map(
        "an axis of length zero",
        |(on, prismatic, xyz, rpy, axis, mass)| {
            let long_enough = axis.iter().map(|x| x * x).sum::<f64>() > 0.01;
            long_enough.then_some(Part::Joint { on, prismatic, xyz, rpy, axis, mass })
        },
    );
    let hoist =
        ((0.0..1.0, vector(1.0), vector(3.0), mass()), (0.5..1.2, 0.3..0.6, -0.1..0.1, any::<bool>()))
            .prop_map(|((on, xyz, rpy, mass), (below, arm, offset, branch))| Part::Hoist {
                on,
                xyz,
                rpy,
                below,
                arm,
                offset,
                branch,
                mass,
            });
    prop_oneof![3 => joint, 2 => hoist]
}

/// The texts that make a machine.
#[derive(Clone, Debug)]
pub struct Machine {
    pub urdf: String,
    pub loops: String,
    /// Link of the URDF that is the world.
    pub root: &'static str,
}

impl Machine {
    pub fn model(&self) -> CraneModel {
        let Self { urdf, loops, .. } = self;
        CraneModel::from_urdf(urdf, loops).unwrap_or_else(|error| panic!("{error}\n{urdf}\n{loops}"))
    }

    /// The same machine with its base turned in the world.
    pub fn with_base_turned(&self, rpy: [f64; 3]) -> Self {
        let (root, rpy) = (self.root, triple(rpy));
        let below = format!(
            "<link name=\"world\"/><joint name=\"turned\" type=\"fixed\"><parent link=\"world\"/>\
             <child link=\"{root}\"/><origin rpy=\"{rpy}\"/></joint></robot>"
        );
        Self { urdf: self.urdf.replace("</robot>", &below), loops: self.loops.clone(), root: "world" }
    }
}

/// Machines of one to six parts.
pub fn machines() -> impl Strategy<Value = Machine> {
    proptest::collection::vec(part(), 1..=6).prop_map(|parts| machine(&parts))
}

/// A serial chain of `joints` joints, every third a slide, in no special position.
pub fn chain(joints: usize) -> CraneModel {
    let parts: Vec<Part> = (0..joints)
        .map(|i| {
            let t = i as f64;
            Part::Joint {
                on: 0.999,
                prismatic: i % 3 == 2,
                xyz: [0.5, 0.1 * t.sin(), 0.1 * t.cos()],
                rpy: [0.3 * t, 0.2, -0.1 * t],
                axis: [t.cos(), 1.0, t.sin()],
                mass: Mass {
                    mass: 5.0,
                    center: [0.2, 0.05, 0.0],
                    rpy: [0.1, 0.2, 0.3],
                    radii: [0.05, 0.1, 0.2],
                },
            }
        })
        .collect();
    machine(&parts).model()
}

/// Builds the machine; the tip is beside the last body.
pub fn machine(parts: &[Part]) -> Machine {
    let mut text = Text {
        links: vec!["ground".into()],
        urdf: "<robot name=\"random\"><link name=\"ground\"/>".into(),
        ..Text::default()
    };
    for (i, part) in parts.iter().enumerate() {
        text.add(i, part);
    }
    let last = text.links.last().unwrap().clone();
    text.fixed("tip", &last, [0.3, -0.2, 0.1], [0.0; 3]);
    let urdf = text.urdf + "</robot>";
    let loops = format!(
        "(urdf: \"\", tip_link: \"tip\", closed_loops: [{}], actuators: [{}])",
        text.closed_loops, text.actuators
    );
    Machine { urdf, loops, root: "ground" }
}

#[derive(Default)]
struct Text {
    links: Vec<String>,
    urdf: String,
    closed_loops: String,
    actuators: String,
}

fn triple([a, b, c]: [f64; 3]) -> String {
    format!("{a} {b} {c}")
}

impl Text {
    fn body(&mut self, name: &str, mass: &Mass) {
        let Mass { mass, center, rpy, radii: [a, b, c] } = mass;
        // Moments of three pairs of points on the axes: any two add up to more than the third.
        let (ixx, iyy, izz) = (mass * (b + c), mass * (c + a), mass * (a + b));
        let (center, rpy) = (triple(*center), triple(*rpy));
        write!(
            self.urdf,
            "<link name=\"{name}\"><inertial><origin xyz=\"{center}\" rpy=\"{rpy}\"/><mass value=\"{mass}\"/>\
             <inertia ixx=\"{ixx}\" ixy=\"0\" ixz=\"0\" iyy=\"{iyy}\" iyz=\"0\" izz=\"{izz}\"/></inertial></link>"
        )
        .unwrap();
        self.links.push(name.to_owned());
    }

    fn joint(
        &mut self,
        name: &str,
        kind: &str,
        ends: [&str; 2],
        xyz: [f64; 3],
        rpy: [f64; 3],
        axis: [f64; 3],
    ) {
        let [parent, child] = ends;
        let (xyz, rpy, axis) = (triple(xyz), triple(rpy), triple(axis));
        write!(
            self.urdf,
            "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>\
             <origin xyz=\"{xyz}\" rpy=\"{rpy}\"/><axis xyz=\"{axis}\"/>\
             <limit lower=\"0\" upper=\"0\" effort=\"1\" velocity=\"1\"/></joint>"
        )
        .unwrap();
    }

    fn fixed(&mut self, name: &str, parent: &str, xyz: [f64; 3], rpy: [f64; 3]) {
        write!(self.urdf, "<link name=\"{name}\"/>").unwrap();
        self.joint(&format!("{name}_fixed"), "fixed", [parent, name], xyz, rpy, [1.0, 0.0, 0.0]);
    }

    fn actuator(&mut self, joint: &str, lower: f64, upper: f64) {
        write!(
            self.actuators,
            "(joint: \"{joint}\", lower: {lower:?}, upper: {upper:?}, effort: 500.0, velocity: 1.0, \
             acceleration: 1.0, jerk: 10.0, armature: 0.0),"
        )
        .unwrap();
    }

    fn carrier(&self, on: f64) -> String {
        self.links[(on * self.links.len() as f64) as usize].clone()
    }

    fn add(&mut self, i: usize, part: &Part) {
        match part {
            Part::Joint { on, prismatic, xyz, rpy, axis, mass } => {
                let (parent, child, joint) = (self.carrier(*on), format!("body{i}"), format!("joint{i}"));
                self.body(&child, mass);
                let kind = if *prismatic { "prismatic" } else { "continuous" };
                self.joint(&joint, kind, [&parent, &child], *xyz, *rpy, *axis);
                let range = if *prismatic { 0.5 } else { 3.0 };
                self.actuator(&joint, -range, range);
            }
            Part::Hoist { on, xyz, rpy, below, arm, offset, branch, mass } => {
                let parent = self.carrier(*on);
                let [mount, boom, barrel, rod, pin_a, pin_b] =
                    ["mount", "boom", "barrel", "rod", "pin_a", "pin_b"].map(|name| format!("{name}{i}"));
                self.fixed(&mount, &parent, *xyz, *rpy);
                for name in [&boom, &barrel, &rod] {
                    self.body(name, mass);
                }
                // At stroke 0 the hinge angle is 1.1 rad; the range goes to 2.0.
                let length = |angle: f64| {
                    (below * below + arm * arm - 2.0 * below * arm * angle.cos() - offset * offset).sqrt()
                };
                let retracted = length(1.1);
                let (hinge, barrel_hinge) = (format!("hinge{i}"), format!("barrel_hinge{i}"));
                let cylinder = format!("cylinder{i}");
                let (none, axis) = ([0.0; 3], [0.0, -1.0, 0.0]);
                self.joint(&hinge, "continuous", [&mount, &boom], none, none, axis);
                self.joint(&barrel_hinge, "continuous", [&mount, &barrel], [0.0, 0.0, -below], none, axis);
                let start = [retracted, 0.0, 0.0];
                self.joint(&cylinder, "prismatic", [&barrel, &rod], start, none, [1.0, 0.0, 0.0]);
                self.fixed(&pin_a, &rod, [0.0, 0.0, *offset], none);
                self.fixed(&pin_b, &boom, [*arm, 0.0, 0.0], none);
                let branch = if *branch { "Positive" } else { "Negative" };
                write!(
                    self.closed_loops,
                    "(name: \"hoist{i}\", frame_a: \"{pin_a}\", frame_b: \"{pin_b}\", kind: Point3d, \
                     independent: \"{cylinder}\", dependent: [\"{hinge}\", \"{barrel_hinge}\"], branch: {branch}),"
                )
                .unwrap();
                self.actuator(&cylinder, 0.0, length(2.0) - retracted);
            }
        }
    }
}
