//! Rigid transforms, spatial (six-dimensional) vectors and inertias.
//!
//! Each is expressed in some frame: in its axes, and referred to its origin. In the recursions of `kinematics` and
//! `dynamics` that is the body's own frame, where its inertia does not change; what is asked for at the tip is put
//! together in the world.
#![expect(non_snake_case, reason = "monogram frames")]

use nalgebra::{Matrix3, Vector3};

use crate::turn::{Placement, Turn};

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

    /// The same wrench in the outer frame.
    #[inline]
    pub(crate) fn wrench(&self, inner: &Force) -> Force {
        let force = self.rotation * inner.force;
        Force { moment: self.rotation * inner.moment + self.translation.cross(&force), force }
    }
}

impl std::ops::Mul for Transform {
    type Output = Self;

    #[inline]
    fn mul(self, X_BC: Self) -> Self {
        Self { rotation: self.rotation * X_BC.rotation, translation: self.point(&X_BC.translation) }
    }
}

/// Twist: angular part, and linear part of the body point that is at the frame's origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion {
    pub(crate) angular: Vector3<f64>,
    pub(crate) linear: Vector3<f64>,
}

/// Wrench or momentum: moment about the frame's origin, and force.
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

    /// Linear part at `point` instead of at the origin.
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

    #[inline]
    pub(crate) fn scaled(&self, factor: f64) -> Self {
        Self { moment: self.moment * factor, force: self.force * factor }
    }
}

/// Inertia of a body, or of several, about the origin of the frame that it is expressed in.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inertia {
    /// Mass \[kg\].
    pub(crate) mass: f64,
    /// Mass times centre of mass \[kg·m\].
    pub(crate) first_moment: Vector3<f64>,
    /// Rotational inertia about that origin \[kg·m²\].
    pub(crate) about_origin: Symmetric,
}

/// A symmetric 3 × 3 matrix: six numbers instead of nine.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Symmetric {
    pub(crate) diagonal: Vector3<f64>,
    /// Entries (1, 2), (2, 0) and (0, 1): each has the index that it lacks.
    pub(crate) beside: Vector3<f64>,
}

impl Symmetric {
    /// The lower triangle of a full matrix.
    pub(crate) fn of(m: &Matrix3<f64>) -> Self {
        Self { diagonal: m.diagonal(), beside: Vector3::new(m[(2, 1)], m[(2, 0)], m[(1, 0)]) }
    }

    /// The full matrix.
    pub(crate) fn full(&self) -> Matrix3<f64> {
        let (d, b) = (&self.diagonal, &self.beside);
        Matrix3::new(d.x, b.z, b.y, b.z, d.y, b.x, b.y, b.x, d.z)
    }

    /// p·u 1 − ½(p uᵀ + u pᵀ), twice. With u = ½ m p the inertia of a point mass m at p about the origin.
    #[inline]
    pub(crate) fn of_pair(p: &Vector3<f64>, u: &Vector3<f64>) -> Self {
        let (x, y, z) = (2.0 * p.x * u.x, 2.0 * p.y * u.y, 2.0 * p.z * u.z);
        Self {
            diagonal: Vector3::new(y + z, z + x, x + y),
            beside: -Vector3::new(p.y * u.z + p.z * u.y, p.z * u.x + p.x * u.z, p.x * u.y + p.y * u.x),
        }
    }

    #[inline]
    pub(crate) fn column(&self, i: usize) -> Vector3<f64> {
        let (d, b) = (&self.diagonal, &self.beside);
        match i {
            0 => Vector3::new(d.x, b.z, b.y),
            1 => Vector3::new(b.z, d.y, b.x),
            _ => Vector3::new(b.y, b.x, d.z),
        }
    }

    #[inline]
    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self { diagonal: self.diagonal + other.diagonal, beside: self.beside + other.beside }
    }

    #[inline]
    pub(crate) fn times(&self, v: &Vector3<f64>) -> Vector3<f64> {
        let (d, b) = (&self.diagonal, &self.beside);
        Vector3::new(
            d.x * v.x + b.z * v.y + b.y * v.z,
            b.z * v.x + d.y * v.y + b.x * v.z,
            b.y * v.x + b.x * v.y + d.z * v.z,
        )
    }
}

impl Inertia {
    pub(crate) const ZERO: Self =
        Self { mass: 0.0, first_moment: ZERO3, about_origin: Symmetric { diagonal: ZERO3, beside: ZERO3 } };

    /// Wrench on a body that moves like this; its origin accelerates by `acceleration`.
    #[inline]
    pub(crate) fn wrench_at(
        &self,
        angular_velocity: &Vector3<f64>,
        angular_acceleration: &Vector3<f64>,
        acceleration: &Vector3<f64>,
    ) -> Force {
        let (w, h, I) = (angular_velocity, &self.first_moment, &self.about_origin);
        Force {
            moment: I.times(angular_acceleration) + w.cross(&I.times(w)) + h.cross(acceleration),
            force: acceleration * self.mass + angular_acceleration.cross(h) + w.cross(&w.cross(h)),
        }
    }

    /// The same about the world origin, of a body at pose `X_WB`.
    pub(crate) fn in_world(&self, X_WB: &Transform) -> Self {
        Placement { turn: Turn::General(X_WB.rotation), translation: X_WB.translation }.inertia(self)
    }

    #[inline]
    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self {
            mass: self.mass + other.mass,
            first_moment: self.first_moment + other.first_moment,
            about_origin: self.about_origin.plus(&other.about_origin),
        }
    }

    /// Momentum at twist `v`.
    #[inline]
    pub(crate) fn times(&self, v: &Motion) -> Force {
        Force {
            moment: self.about_origin.times(&v.angular) + self.first_moment.cross(&v.linear),
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

    /// Inertia about the origin of the frame.
    pub(crate) fn about_origin(&self) -> Inertia {
        Inertia {
            mass: self.mass,
            first_moment: self.center * self.mass,
            about_origin: Symmetric::of(&(self.about_center + steiner(self.mass, &self.center))),
        }
    }
}

/// Rotational inertia of a point mass at `r` about the origin, as a full matrix.
fn steiner(mass: f64, r: &Vector3<f64>) -> Matrix3<f64> {
    Symmetric::of_pair(r, &(r * (0.5 * mass))).full()
}

pub(crate) const ZERO3: Vector3<f64> = Vector3::new(0.0, 0.0, 0.0);
