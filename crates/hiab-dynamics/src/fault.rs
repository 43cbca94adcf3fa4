//! The particulars of a [`ModelError`](crate::ModelError): what is wrong with a text, a tree or a loop.

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
    /// An attribute that the element does not have, misspelt perhaps.
    #[error("<{element}> has no attribute `{attribute}`; it may have {known}")]
    UnknownAttribute {
        /// The element.
        element: String,
        /// The attribute.
        attribute: String,
        /// What it may have.
        known: String,
    },
    /// An element that is nearly called like one that counts.
    #[error("<{child}> in <{element}> means nothing; is it a misspelt <{near}>?")]
    UnknownElement {
        /// The outer element.
        element: String,
        /// The inner one.
        child: String,
        /// What it may have been meant to be.
        near: &'static str,
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
    /// A weld instead of a pin.
    #[error(
        "kind Frame6d welds two frames, which no cylinder between hinges does; \
         cut the loop at a pin and use kind Point3d"
    )]
    Weld,
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

/// Why a loop cannot be closed at a stroke.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CloseFault {
    /// The triangle does not exist: the rod ends short of its pin, however the bodies turn.
    #[error("the rod ends {gap} m short of its pin, wherever `{main}` is")]
    TooShort {
        /// The turned joint.
        main: String,
        /// How much is missing \[m\].
        gap: f64,
    },
    /// The triangle does not exist: the rod overshoots its pin.
    #[error("the rod overshoots its pin by {gap} m, wherever `{main}` is")]
    TooLong {
        /// The turned joint.
        main: String,
        /// How much is too much \[m\].
        gap: f64,
    },
    /// The pins are almost in line: the cylinder has no lever on the joint that it turns.
    #[error(
        "the loop is near-singular: `{main}` and both pins of the cylinder are {angle} rad from one line, \
         at least {bound} rad are needed"
    )]
    NearSingular {
        /// The turned joint.
        main: String,
        /// Angle at the turned joint between the lines to both pins, or what it lacks to a straight one \[rad\].
        angle: f64,
        /// Least angle \[rad\].
        bound: f64,
    },
    /// A rod so short that its pin would lie behind the hinge of its barrel.
    #[error("the pin of the rod would lie behind the hinge of its barrel")]
    BehindHinge,
}
