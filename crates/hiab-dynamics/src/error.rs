//! What can go wrong when a model is built and when it is used.

use crate::fault::{CloseFault, LoopFault, TextFault, TreeFault};

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
    /// A loop that cannot be closed, or hardly, at every stroke of its actuator.
    #[error(
        "loop `{closed_loop}` cannot be closed over the range of `{joint}`: \
         strokes {lower} to {upper} wanted, {solvable_lower} to {solvable_upper} solvable; \
         at stroke {stroke} {fault}"
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
        /// Least solvable stroke \[m\].
        solvable_lower: f64,
        /// Greatest solvable stroke \[m\].
        solvable_upper: f64,
        /// The end of the range where it fails \[m\].
        stroke: f64,
        /// What is wrong there.
        fault: Box<CloseFault>,
    },
    /// A loop that has no usable solution at any stroke.
    #[error("loop `{closed_loop}` cannot be closed at any stroke of `{joint}`: {fault}")]
    LoopNeverCloses {
        /// The loop.
        closed_loop: String,
        /// The cylinder's joint.
        joint: String,
        /// What is wrong.
        fault: Box<CloseFault>,
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
    /// A posture in which some direction is closed to the tip.
    #[error(
        "the posture is near-singular: the tip hardly gives way along {direction:?}, \
         {ratio:e} of what it does along the easiest direction"
    )]
    TipNearSingular {
        /// Unit vector, world axes.
        direction: [f64; 3],
        /// Mobility along it, relative to the greatest.
        ratio: f64,
    },
    /// A direction of length zero.
    #[error("direction has length zero")]
    ZeroDirection,
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
