//! What can go wrong when a model is built and when it is used.

/// A URDF and a loop file that do not make a crane.
#[derive(Debug, thiserror::Error)]
pub enum ModelError {
    /// The URDF is not XML; the message begins with line and column.
    #[error("urdf: {0}")]
    Xml(#[from] xml::reader::Error),
    /// A link or joint of the URDF lacks something, or is no number where it should be one.
    #[error("urdf: line {line}: {owner}: {fault}")]
    UrdfText {
        /// Line, from 1.
        line: u64,
        /// Link or joint.
        owner: String,
        /// What is wrong.
        fault: TextFault,
    },
    /// The URDF is XML, but no URDF.
    #[error("urdf: {0}")]
    Urdf(#[from] urdf_rs::UrdfError),
    /// The loop file could not be read; the message begins with line and column.
    #[error("loop file: {0}")]
    LoopFile(#[from] ron::error::SpannedError),
    /// A number of the URDF or the loop file is NaN or infinite.
    #[error("{owner}: {field} must be finite, got {value}")]
    NotFinite {
        /// Link, joint or actuator.
        owner: String,
        /// Which of its numbers.
        field: &'static str,
        /// The number.
        value: f64,
    },
    /// Two links, joints, loops or actuators have one name.
    #[error("two {kind}s are named `{name}`")]
    DuplicateName {
        /// `link`, `joint`, `loop` or `actuator`.
        kind: &'static str,
        /// The name.
        name: String,
    },
    /// A name that the URDF does not have.
    #[error("{owner}: {field} names the {kind} `{name}`, which the urdf does not have")]
    UnknownName {
        /// Who names it.
        owner: String,
        /// In which field.
        field: &'static str,
        /// `link` or `joint`.
        kind: &'static str,
        /// The name.
        name: String,
    },
    /// Links and joints do not form one tree.
    #[error("the urdf is not one tree: {fault}")]
    NotATree {
        /// What is wrong.
        fault: TreeFault,
    },
    /// A joint that this crate does not model.
    #[error("joint `{joint}`: type {found} is not supported; use revolute, continuous, prismatic or fixed")]
    UnsupportedJoint {
        /// The joint.
        joint: String,
        /// Its type, or `mimic`.
        found: String,
    },
    /// A joint axis of length zero.
    #[error("joint `{joint}`: axis has length zero")]
    ZeroAxis {
        /// The joint.
        joint: String,
    },
    /// Negative mass, or inertia without mass.
    #[error("link `{link}`: mass must be > 0 for a link with inertia and never negative, got {mass}")]
    BadMass {
        /// The link.
        link: String,
        /// Its mass \[kg\].
        mass: f64,
    },
    /// A moving body without mass, links fixed to it included.
    #[error("link `{link}` moves by joint `{joint}` but has no mass, nor has any link fixed to it")]
    MasslessBody {
        /// The link.
        link: String,
        /// The joint that moves it.
        joint: String,
    },
    /// An inertia matrix that no rigid body has.
    #[error("link `{link}`: inertia has principal moments {moments:?}; they must be {rule}")]
    BadInertia {
        /// The link, or the first link of a body of several.
        link: String,
        /// Principal moments \[kg·m²\], ascending.
        moments: [f64; 3],
        /// What they break.
        rule: &'static str,
    },
    /// The tip cannot move.
    #[error("tip_link `{link}` is fixed to the ground")]
    TipDoesNotMove {
        /// The tip's link.
        link: String,
    },
    /// There is no actuator.
    #[error("actuators is empty")]
    NoActuators,
    /// An actuator whose range is empty.
    #[error("actuator `{joint}`: lower must be below upper, got lower {lower}, upper {upper}")]
    EmptyRange {
        /// The actuator's joint.
        joint: String,
        /// Lower end.
        lower: f64,
        /// Upper end.
        upper: f64,
    },
    /// A limit of an actuator that is not positive.
    #[error("actuator `{joint}`: {field} must be > 0, got {value}")]
    NotPositive {
        /// The actuator's joint.
        joint: String,
        /// Which limit.
        field: &'static str,
        /// Its value.
        value: f64,
    },
    /// A number that must not be negative.
    #[error("{owner}: {field} must be >= 0, got {value}")]
    Negative {
        /// Whose number.
        owner: String,
        /// Which.
        field: &'static str,
        /// Its value.
        value: f64,
    },
    /// An actuator on a joint that cannot move.
    #[error("actuator `{joint}`: the joint is fixed")]
    ActuatorOnFixedJoint {
        /// The joint.
        joint: String,
    },
    /// A moving joint that neither an actuator nor a loop determines.
    #[error("joint `{joint}` moves, but is neither an actuator nor a dependent joint of a loop")]
    UndeterminedJoint {
        /// The joint.
        joint: String,
    },
    /// A joint that a loop determines is an actuator, too.
    #[error("joint `{joint}` is an actuator and a dependent joint of loop `{closed_loop}`")]
    DependentActuator {
        /// The joint.
        joint: String,
        /// The loop.
        closed_loop: String,
    },
    /// Two loops determine one joint, or are driven by one cylinder.
    #[error("joint `{joint}` is used by loop `{first}` and by loop `{second}`")]
    JointInTwoLoops {
        /// The joint.
        joint: String,
        /// One loop.
        first: String,
        /// The other.
        second: String,
    },
    /// The joints of a loop do not make a cylinder between two hinged bodies.
    #[error("loop `{closed_loop}`: {fault}")]
    LoopTopology {
        /// The loop.
        closed_loop: String,
        /// What is wrong.
        fault: LoopFault,
    },
    /// The pins of a loop do not move in one plane.
    #[error("loop `{closed_loop}` is not planar: {what} is {value:e}, more than {bound:e}")]
    NotPlanar {
        /// The loop.
        closed_loop: String,
        /// What leaves the plane.
        what: &'static str,
        /// By how much [1 or m].
        value: f64,
        /// The bound.
        bound: f64,
    },
    /// A loop that cannot be closed at every stroke of its actuator.
    #[error(
        "loop `{closed_loop}` cannot be closed over the range of `{joint}`: \
         strokes {lower} to {upper} wanted, {solvable_lower} to {solvable_upper} solvable"
    )]
    LoopCannotClose {
        /// The loop.
        closed_loop: String,
        /// The cylinder's joint.
        joint: String,
        /// Least stroke of the actuator \[m\].
        lower: f64,
        /// Greatest stroke of the actuator \[m\].
        upper: f64,
        /// Least solvable stroke \[m\]; greater than `solvable_upper` if there is none.
        solvable_lower: f64,
        /// Greatest solvable stroke \[m\].
        solvable_upper: f64,
    },
    /// The mass matrix is singular in the middle of the actuators' ranges.
    #[error(
        "the mass matrix is not positive definite in the middle of the range: actuator `{joint}` moves no inertia"
    )]
    SingularMassMatrix {
        /// The first actuator whose pivot is not positive.
        joint: String,
    },
}

/// How an element of a URDF is incomplete or no number.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TextFault {
    /// An attribute is missing.
    #[error("<{element}> lacks the attribute `{attribute}`")]
    NoAttribute {
        /// The element.
        element: String,
        /// The attribute.
        attribute: &'static str,
    },
    /// An element is missing in another.
    #[error("<{element}> lacks <{child}>")]
    NoChild {
        /// The outer element.
        element: String,
        /// The one that it lacks.
        child: &'static str,
    },
    /// An attribute that is not one number.
    #[error("{attribute} of <{element}> must be a number, got `{text}`")]
    NoNumber {
        /// The element.
        element: String,
        /// The attribute.
        attribute: &'static str,
        /// Its text.
        text: String,
    },
    /// An attribute that is not three numbers.
    #[error("{attribute} of <{element}> must be three numbers, got `{text}`")]
    NoVector {
        /// The element.
        element: String,
        /// The attribute.
        attribute: &'static str,
        /// Its text.
        text: String,
    },
}

/// How links and joints fail to form a tree.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TreeFault {
    /// There is no link.
    #[error("it has no link")]
    Empty,
    /// Two joints have one child.
    #[error("link `{link}` is the child of joints `{first}` and `{second}`")]
    TwoParents {
        /// The child.
        link: String,
        /// One joint.
        first: String,
        /// The other.
        second: String,
    },
    /// More than one link has no parent.
    #[error("links `{first}` and `{second}` both have no parent")]
    TwoRoots {
        /// One link.
        first: String,
        /// Another.
        second: String,
    },
    /// Some joints form a cycle.
    #[error("joint `{joint}` is part of a cycle; close loops in the loop file instead")]
    Cycle {
        /// One joint that the root does not reach.
        joint: String,
    },
}

/// How a loop's joints fail to make a cylinder between two hinged bodies.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LoopFault {
    /// Not two dependent joints.
    #[error("dependent must name two joints, got {found}")]
    DependentCount {
        /// How many it names.
        found: usize,
    },
    /// The cylinder has no actuator.
    #[error("independent `{joint}` is not an actuator")]
    IndependentNotActuated {
        /// The cylinder's joint.
        joint: String,
    },
    /// The cylinder is not prismatic.
    #[error("independent `{joint}` must be prismatic")]
    IndependentNotPrismatic {
        /// The joint.
        joint: String,
    },
    /// A dependent joint is not revolute.
    #[error("dependent `{joint}` must be revolute or continuous")]
    DependentNotRevolute {
        /// The joint.
        joint: String,
    },
    /// No dependent joint carries the cylinder's barrel.
    #[error(
        "no dependent joint carries the barrel: `{joint}` does not start on a body that one of them moves"
    )]
    NoBarrel {
        /// The cylinder's joint.
        joint: String,
    },
    /// Barrel and turned body are not hinged to one body.
    #[error("`{barrel}` and `{main}` must start on one body")]
    HingesOnDifferentBodies {
        /// The barrel's joint.
        barrel: String,
        /// The turned joint.
        main: String,
    },
    /// The pin's halves are not on the rod and on the turned body.
    #[error(
        "of frame_a and frame_b one must be on the rod moved by `{rod}`, the other on the body moved by `{main}`"
    )]
    PinElsewhere {
        /// The cylinder's joint.
        rod: String,
        /// The turned joint.
        main: String,
    },
    /// A hinge and a pin in one place: no triangle.
    #[error("{side} has length zero")]
    ZeroSide {
        /// Which side of the triangle.
        side: &'static str,
    },
}

/// A state that the model cannot evaluate.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DynamicsError {
    /// A slice of the wrong length.
    #[error("{what} must have {expected} values, got {found}")]
    Length {
        /// Which slice.
        what: &'static str,
        /// Number wanted.
        expected: usize,
        /// Number given.
        found: usize,
    },
    /// A number that is NaN or infinite.
    #[error("{what}[{index}] must be finite, got {value}")]
    NotFinite {
        /// Which slice.
        what: &'static str,
        /// Where in it.
        index: usize,
        /// The number.
        value: f64,
    },
    /// A stroke at which a loop has no usable solution.
    #[error(
        "loop `{closed_loop}` has no usable solution at stroke {stroke} m; solvable are {lower} to {upper}"
    )]
    StrokeOutsideLoop {
        /// The loop.
        closed_loop: String,
        /// The stroke \[m\].
        stroke: f64,
        /// Least solvable stroke \[m\].
        lower: f64,
        /// Greatest solvable stroke \[m\].
        upper: f64,
    },
    /// The mass matrix lost positive definiteness; only numbers near overflow do that.
    #[error("the mass matrix is not positive definite: pivot {pivot} is {value}")]
    SingularMassMatrix {
        /// Actuator index.
        pivot: usize,
        /// Value of the pivot.
        value: f64,
    },
    /// A step whose period is not a positive number.
    #[error("period must be finite and > 0, got {value}")]
    Period {
        /// The period \[s\].
        value: f64,
    },
    /// A step that led to numbers beyond the range of `f64`.
    #[error("the step diverged: {what}[{index}] became {value}")]
    Diverged {
        /// Position or velocity.
        what: &'static str,
        /// Actuator index.
        index: usize,
        /// The value.
        value: f64,
    },
}

/// A plant file, or a plant that does not fit a model.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlantError {
    /// The plant file could not be read; the message begins with line and column.
    #[error("plant file: {0}")]
    Ron(#[from] ron::error::SpannedError),
    /// No plant has this name.
    #[error("no plant is named `{name}`; there are {known:?}")]
    UnknownPlant {
        /// The name asked for.
        name: String,
        /// The names in the file.
        known: Vec<String>,
    },
    /// A plant names a joint that is no actuator of the model.
    #[error("the plant names `{joint}`, which is not an actuator of the model")]
    UnknownActuator {
        /// The joint.
        joint: String,
    },
    /// A value out of range.
    #[error("actuator `{joint}`: {field} must be finite and {rule}, got {value}")]
    BadValue {
        /// The actuator's joint.
        joint: String,
        /// Which value.
        field: &'static str,
        /// Its range.
        rule: &'static str,
        /// What was given.
        value: f64,
    },
}
