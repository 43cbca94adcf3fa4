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

/// A unit axis, told apart by what a rotation about it costs.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Axis {
    /// Coordinate axis 0, 1 or 2, and the sign of its direction.
    Coordinate(usize, f64),
    /// Any other unit vector.
    Oblique(Vector3<f64>),
}

impl Axis {
    /// Of a unit vector.
    pub(crate) fn along(axis: &Vector3<f64>) -> Self {
        match (0..3).find(|&i| axis[i].abs() == 1.0) {
            Some(i) => Self::Coordinate(i, axis[i]),
            None => Self::Oblique(*axis),
        }
    }

    /// The axis in the outer frame of `rotation`.
    #[inline]
    pub(crate) fn seen_from_outside(&self, rotation: &Matrix3<f64>) -> Vector3<f64> {
        match self {
            Self::Coordinate(i, sign) => rotation.column(*i) * *sign,
            Self::Oblique(axis) => rotation * axis,
        }
    }

    /// `rotation`, followed inside by a rotation by `angle` \[rad\] about the axis.
    #[inline]
    pub(crate) fn turned(&self, rotation: &Matrix3<f64>, angle: f64) -> Matrix3<f64> {
        let (s, c) = libm::sincos(angle);
        match self {
            Self::Coordinate(i, sign) => {
                let s = s * sign;
                let column = |i: usize| Vector3::new(rotation[(0, i)], rotation[(1, i)], rotation[(2, i)]);
                let (x, y, z) = (column(0), column(1), column(2));
                match i {
                    0 => Matrix3::from_columns(&[x, y * c + z * s, z * c - y * s]),
                    1 => Matrix3::from_columns(&[x * c - z * s, y, z * c + x * s]),
                    _ => Matrix3::from_columns(&[x * c + y * s, y * c - x * s, z]),
                }
            }
            Self::Oblique(axis) => rotation * rodrigues(axis, s, c),
        }
    }
}

/// Rotation about the unit vector `axis` by the angle with sine `s` and cosine `c` (Rodrigues).
fn rodrigues(axis: &Vector3<f64>, s: f64, c: f64) -> Matrix3<f64> {
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

    pub(crate) fn scaled(&self, factor: f64) -> Self {
        Self { moment: self.moment * factor, force: self.force * factor }
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
    pub(crate) about_origin: Symmetric,
}

/// A symmetric 3 × 3 matrix: six numbers instead of nine.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Symmetric {
    diagonal: Vector3<f64>,
    /// Entries (1, 2), (2, 0) and (0, 1).
    beside: Vector3<f64>,
}

impl Symmetric {
    const ZERO: Self = Self { diagonal: ZERO3, beside: ZERO3 };

    /// R·`inner`·Rᵀ of a symmetric `inner`.
    #[inline]
    fn rotated(R: &Matrix3<f64>, inner: &Matrix3<f64>) -> Self {
        let half = R * inner;
        let row = |m: &Matrix3<f64>, i: usize| Vector3::new(m[(i, 0)], m[(i, 1)], m[(i, 2)]);
        let entry = |i: usize, j: usize| row(&half, i).dot(&row(R, j));
        Self {
            diagonal: Vector3::new(entry(0, 0), entry(1, 1), entry(2, 2)),
            beside: Vector3::new(entry(1, 2), entry(2, 0), entry(0, 1)),
        }
    }

    /// Of a point mass at `r` about the origin: m (|r|² 1 − r rᵀ).
    #[inline]
    fn of_point(mass: f64, r: &Vector3<f64>) -> Self {
        let (x, y, z) = (r.x, r.y, r.z);
        let (xx, yy, zz) = (mass * x * x, mass * y * y, mass * z * z);
        Self {
            diagonal: Vector3::new(yy + zz, zz + xx, xx + yy),
            beside: Vector3::new(-mass * y * z, -mass * z * x, -mass * x * y),
        }
    }

    #[inline]
    fn plus(&self, other: &Self) -> Self {
        Self { diagonal: self.diagonal + other.diagonal, beside: self.beside + other.beside }
    }

    #[inline]
    fn times(&self, v: &Vector3<f64>) -> Vector3<f64> {
        let (d, b) = (&self.diagonal, &self.beside);
        Vector3::new(
            d.x * v.x + b.z * v.y + b.y * v.z,
            b.z * v.x + d.y * v.y + b.x * v.z,
            b.y * v.x + b.x * v.y + d.z * v.z,
        )
    }
}

impl Inertia {
    pub(crate) const ZERO: Self = Self { mass: 0.0, first_moment: ZERO3, about_origin: Symmetric::ZERO };

    #[inline]
    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self {
            mass: self.mass + other.mass,
            first_moment: self.first_moment + other.first_moment,
            about_origin: self.about_origin.plus(&other.about_origin),
        }
    }

    /// Momentum at twist `v`, or the inertial part of the wrench at acceleration `v`.
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

    /// Inertia about the world origin at pose `X_WB`.
    #[inline]
    pub(crate) fn in_world(&self, X_WB: &Transform) -> Inertia {
        let center = X_WB.point(&self.center);
        let rotated = Symmetric::rotated(&X_WB.rotation, &self.about_center);
        Inertia {
            mass: self.mass,
            first_moment: center * self.mass,
            about_origin: rotated.plus(&Symmetric::of_point(self.mass, &center)),
        }
    }
}

/// Rotational inertia of a point mass at `r` about the origin, as a full matrix.
fn steiner(mass: f64, r: &Vector3<f64>) -> Matrix3<f64> {
    let Symmetric { diagonal: d, beside: b } = Symmetric::of_point(mass, r);
    Matrix3::new(d.x, b.z, b.y, b.z, d.y, b.x, b.y, b.x, d.z)
}

const ZERO3: Vector3<f64> = Vector3::new(0.0, 0.0, 0.0);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coordinate_axis_turns_as_any_other_does() {
        let rotation = rodrigues(&Vector3::new(0.48, -0.6, 0.64), 0.28, 0.96);
        for axis in [Vector3::x(), -Vector3::x(), Vector3::y(), -Vector3::y(), Vector3::z(), -Vector3::z()] {
            let quick = Axis::along(&axis);
            assert!(matches!(quick, Axis::Coordinate(..)), "{axis}");
            let general = Axis::Oblique(axis);
            for angle in [-2.9, -0.3, 0.0, 1.2] {
                let gap = quick.turned(&rotation, angle) - general.turned(&rotation, angle);
                assert!(gap.abs().max() < 1e-15, "about {axis} by {angle}: {gap}");
            }
            let gap = quick.seen_from_outside(&rotation) - general.seen_from_outside(&rotation);
            assert!(gap.abs().max() < 1e-15, "{axis}: {gap}");
        }
    }
}
