//! Rigid transforms and spatial (six-dimensional) vectors, referred to the world origin.
//!
//! Twists, wrenches and inertias of all bodies share one reference point, the world origin W, so that adding
//! two of them is a plain sum and the recursions of `kinematics` and `dynamics` need no shift between bodies.
//! The price is a cancellation of the order (distance from W)² · ε, 1e-14 relative for a machine some metres
//! across: place the URDF's root near the machine.
#![expect(non_snake_case, reason = "monogram frames")]

use nalgebra::{Matrix3, Vector3};

/// Pose of one frame in another; `X_AC = X_AB * X_BC`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Transform {
    pub(crate) rotation: Matrix3<f64>,
    pub(crate) translation: Vector3<f64>,
}

impl Transform {
    pub(crate) fn identity() -> Self {
        Self { rotation: Matrix3::identity(), translation: Vector3::zeros() }
    }

    /// Maps a point, given in the inner frame, to the outer one.
    #[inline]
    pub(crate) fn point(&self, p: &Vector3<f64>) -> Vector3<f64> {
        self.rotation * p + self.translation
    }
}

impl std::ops::Mul for Transform {
    type Output = Self;

    #[inline]
    fn mul(self, X_BC: Self) -> Self {
        Self { rotation: self.rotation * X_BC.rotation, translation: self.point(&X_BC.translation) }
    }
}

/// Rotation by `angle` \[rad\] about the unit vector `axis` (Rodrigues).
#[inline]
pub(crate) fn rotation_about(axis: &Vector3<f64>, angle: f64) -> Matrix3<f64> {
    let (s, c) = angle.sin_cos();
    let (x, y, z) = (axis.x, axis.y, axis.z);
    let t = 1.0 - c;
    Matrix3::new(
        c + t * x * x,
        t * x * y - s * z,
        t * x * z + s * y,
        t * x * y + s * z,
        c + t * y * y,
        t * y * z - s * x,
        t * x * z - s * y,
        t * y * z + s * x,
        c + t * z * z,
    )
}

/// Twist or its derivative: angular part, and linear part of the body point that is at the world origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion {
    pub(crate) angular: Vector3<f64>,
    pub(crate) linear: Vector3<f64>,
}

/// Wrench or momentum: moment about the world origin, and force.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Force {
    pub(crate) moment: Vector3<f64>,
    pub(crate) force: Vector3<f64>,
}

impl Motion {
    pub(crate) const ZERO: Self = Self { angular: ZERO3, linear: ZERO3 };

    #[inline]
    pub(crate) fn scaled(&self, factor: f64) -> Self {
        Self { angular: self.angular * factor, linear: self.linear * factor }
    }

    #[inline]
    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self { angular: self.angular + other.angular, linear: self.linear + other.linear }
    }

    /// Rate of `other` when `other` is carried along by a body that moves with `self`.
    #[inline]
    pub(crate) fn cross_motion(&self, other: &Self) -> Self {
        Self {
            angular: self.angular.cross(&other.angular),
            linear: self.angular.cross(&other.linear) + self.linear.cross(&other.angular),
        }
    }

    /// Rate of `other` when `other` is carried along by a body that moves with `self`.
    #[inline]
    pub(crate) fn cross_force(&self, other: &Force) -> Force {
        Force {
            moment: self.angular.cross(&other.moment) + self.linear.cross(&other.force),
            force: self.angular.cross(&other.force),
        }
    }

    /// Power of `wrench` on this twist \[W\].
    #[inline]
    pub(crate) fn dot(&self, wrench: &Force) -> f64 {
        self.angular.dot(&wrench.moment) + self.linear.dot(&wrench.force)
    }

    /// Linear part at `point` (world) instead of at the world origin.
    #[inline]
    pub(crate) fn linear_at(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.linear + self.angular.cross(point)
    }
}

impl Force {
    pub(crate) const ZERO: Self = Self { moment: ZERO3, force: ZERO3 };

    #[inline]
    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self { moment: self.moment + other.moment, force: self.force + other.force }
    }
}

/// Inertia of a body, or of several, about the world origin in world axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inertia {
    /// Mass \[kg\].
    pub(crate) mass: f64,
    /// Mass times centre of mass \[kg·m\].
    pub(crate) first_moment: Vector3<f64>,
    /// Rotational inertia about the world origin \[kg·m²\].
    pub(crate) about_origin: Matrix3<f64>,
}

impl Inertia {
    pub(crate) const ZERO: Self = Self {
        mass: 0.0,
        first_moment: ZERO3,
        about_origin: Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    };

    #[inline]
    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self {
            mass: self.mass + other.mass,
            first_moment: self.first_moment + other.first_moment,
            about_origin: self.about_origin + other.about_origin,
        }
    }

    /// Momentum at twist `v`, or the inertial part of the wrench at acceleration `v`.
    #[inline]
    pub(crate) fn times(&self, v: &Motion) -> Force {
        Force {
            moment: self.about_origin * v.angular + self.first_moment.cross(&v.linear),
            force: v.linear * self.mass + v.angular.cross(&self.first_moment),
        }
    }
}

/// Mass, centre of mass and rotational inertia about that centre, in some fixed frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MassProperties {
    pub(crate) mass: f64,
    pub(crate) center: Vector3<f64>,
    pub(crate) about_center: Matrix3<f64>,
}

impl MassProperties {
    pub(crate) const ZERO: Self = Self {
        mass: 0.0,
        center: ZERO3,
        about_center: Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    };

    /// A point of `mass` \[kg\] at `center`.
    pub(crate) fn point(mass: f64, center: Vector3<f64>) -> Self {
        Self { mass, center, ..Self::ZERO }
    }

    /// The same body, expressed in the frame A that B is posed in by `X_AB`.
    pub(crate) fn expressed_in(&self, X_AB: &Transform) -> Self {
        Self {
            mass: self.mass,
            center: X_AB.point(&self.center),
            about_center: X_AB.rotation * self.about_center * X_AB.rotation.transpose(),
        }
    }

    /// Both bodies as one; `other` must be expressed in the same frame.
    pub(crate) fn joined(&self, other: &Self) -> Self {
        let mass = self.mass + other.mass;
        if mass == 0.0 {
            return Self::ZERO;
        }
        let center = (self.center * self.mass + other.center * other.mass) / mass;
        let about_center = self.about_center
            + other.about_center
            + steiner(self.mass, &(self.center - center))
            + steiner(other.mass, &(other.center - center));
        Self { mass, center, about_center }
    }

    /// Inertia about the world origin at pose `X_WB`.
    #[inline]
    pub(crate) fn in_world(&self, X_WB: &Transform) -> Inertia {
        let center = X_WB.point(&self.center);
        let rotated = X_WB.rotation * self.about_center * X_WB.rotation.transpose();
        Inertia {
            mass: self.mass,
            first_moment: center * self.mass,
            about_origin: rotated + steiner(self.mass, &center),
        }
    }
}

/// Rotational inertia of a point mass at `r` about the origin: m (|r|² 1 − r rᵀ).
#[inline]
fn steiner(mass: f64, r: &Vector3<f64>) -> Matrix3<f64> {
    let (x, y, z) = (r.x, r.y, r.z);
    let (xy, yz, zx) = (-mass * x * y, -mass * y * z, -mass * z * x);
    let (xx, yy, zz) = (mass * x * x, mass * y * y, mass * z * z);
    Matrix3::new(yy + zz, xy, zx, xy, zz + xx, yz, zx, yz, xx + yy)
}

const ZERO3: Vector3<f64> = Vector3::new(0.0, 0.0, 0.0);
