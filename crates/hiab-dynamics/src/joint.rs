//! A moving joint of the tree, and what it does to the body behind it.
#![expect(non_snake_case, reason = "monogram frames")]

use nalgebra::{Matrix3, Vector3};

use crate::spatial::{Force, Inertia, MassProperties, Motion, Transform, ZERO3};
use crate::turn::{Axis, Placement, Turn};

/// A moving joint and the body behind it.
#[derive(Clone, Debug)]
pub(crate) struct TreeJoint {
    pub(crate) name: String,
    pub(crate) kind: JointKind,
    /// Body that it starts on; `None` is the ground.
    pub(crate) parent: Option<usize>,
    /// Pose of the joint's frame J in the parent body P.
    pub(crate) X_PJ: Transform,
    /// Whether J is parallel to P, as it mostly is; that saves a product of rotations.
    is_parallel: bool,
    /// Unit axis in J, and so in the body's own frame as well.
    pub(crate) axis: Vector3<f64>,
    /// The same axis, for turning about it.
    turning: Axis,
    /// The same axis in P, for sliding along it.
    sliding: Vector3<f64>,
    /// Middle of the URDF's position limits, if it has any [rad or m].
    pub(crate) middle: Option<f64>,
    /// Mass of the body, links fixed to it included, in its own frame.
    pub(crate) mass: MassProperties,
}

impl TreeJoint {
    pub(crate) fn new(
        name: String,
        kind: JointKind,
        parent: Option<usize>,
        X_PJ: Transform,
        axis: Vector3<f64>,
        middle: Option<f64>,
        mass: MassProperties,
    ) -> Self {
        let is_parallel = X_PJ.rotation == Matrix3::identity();
        let (turning, sliding) = (Axis::along(&axis), X_PJ.rotation * axis);
        Self { name, kind, parent, X_PJ, is_parallel, axis, turning, sliding, middle, mass }
    }

    /// Momentum per velocity of the joint of all that moves with its body, in the body's frame.
    #[inline]
    pub(crate) fn momentum(&self, inertia: &Inertia) -> Force {
        let (axis, h) = (&self.axis, &inertia.first_moment);
        match self.kind {
            JointKind::Revolute => {
                Force { moment: self.turning.times(&inertia.about_origin), force: axis.cross(h) }
            }
            JointKind::Prismatic => Force { moment: h.cross(axis), force: axis * inertia.mass },
        }
    }

    /// Effort that the joint has of a wrench on its body, in the body's frame [N·m or N].
    #[inline]
    pub(crate) fn effort(&self, wrench: &Force) -> f64 {
        match self.kind {
            JointKind::Revolute => self.axis.dot(&wrench.moment),
            JointKind::Prismatic => self.axis.dot(&wrench.force),
        }
    }

    /// Puts the joint's body where it is in its parent at position `q` [rad or m].
    #[inline]
    pub(crate) fn place(&self, q: f64, placement: &mut Placement) {
        let X_PJ = &self.X_PJ;
        match (self.kind, self.is_parallel) {
            (JointKind::Revolute, true) => placement.turn = Turn::about(&self.turning, q),
            (JointKind::Revolute, false) => {
                placement.turn = Turn::General(Turn::about(&self.turning, q).within(&X_PJ.rotation));
            }
            (JointKind::Prismatic, true) => placement.turn = Turn::Parallel,
            (JointKind::Prismatic, false) => placement.turn = Turn::General(X_PJ.rotation),
        }
        placement.translation = match self.kind {
            JointKind::Revolute => X_PJ.translation,
            JointKind::Prismatic => X_PJ.translation + self.sliding * q,
        };
    }

    /// Twist per velocity of the joint, in the world, of its body at `X_WB`.
    #[inline]
    pub(crate) fn subspace(&self, X_WB: &Transform) -> Motion {
        let axis_W = self.turning.within(&X_WB.rotation);
        match self.kind {
            JointKind::Revolute => Motion { angular: axis_W, linear: X_WB.translation.cross(&axis_W) },
            JointKind::Prismatic => Motion { angular: ZERO3, linear: axis_W },
        }
    }
}

/// What a joint does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum JointKind {
    /// Turns about its axis.
    Revolute,
    /// Slides along its axis.
    Prismatic,
}
