//! Rotations between a body and the one that carries it, told apart by what they cost.
//!
//! Most joints of a machine turn about a coordinate axis of a frame that is parallel to its parent's, or slide. A
//! rotation is then no matrix but a sine and a cosine, or nothing.
#![expect(non_snake_case, reason = "monogram frames")]

use nalgebra::{Matrix3, Vector3};

use crate::spatial::{Force, Inertia, Symmetric, ZERO3};

/// A unit axis.
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

    /// The axis in the frame in which the axes of its own are `R`.
    #[inline]
    pub(crate) fn within(&self, R: &Matrix3<f64>) -> Vector3<f64> {
        match self {
            Self::Coordinate(0, sign) => R.column(0) * *sign,
            Self::Coordinate(1, sign) => R.column(1) * *sign,
            Self::Coordinate(_, sign) => R.column(2) * *sign,
            Self::Oblique(axis) => R * axis,
        }
    }

    /// Product of a symmetric matrix and the axis.
    #[inline]
    pub(crate) fn times(&self, inner: &Symmetric) -> Vector3<f64> {
        match self {
            Self::Coordinate(i, sign) => inner.column(*i) * *sign,
            Self::Oblique(axis) => inner.times(axis),
        }
    }
}

/// Rotation of a frame in an outer one.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Turn {
    /// None: the axes are parallel.
    Parallel,
    /// About a coordinate axis, by the angle with this sine and cosine.
    About(usize, f64, f64),
    /// Any other.
    General(Matrix3<f64>),
}

impl Turn {
    /// By `angle` \[rad\] about `axis`.
    #[inline]
    pub(crate) fn about(axis: &Axis, angle: f64) -> Self {
        let (s, c) = libm::sincos(angle);
        match axis {
            Axis::Coordinate(i, sign) => Self::About(*i, s * sign, c),
            Axis::Oblique(axis) => Self::General(rodrigues(axis, s, c)),
        }
    }

    /// The inner axes in the frame in which the outer ones are `outer`.
    #[inline(always)]
    pub(crate) fn within(&self, outer: &Matrix3<f64>) -> Matrix3<f64> {
        match *self {
            Self::Parallel => *outer,
            Self::About(i, s, c) => {
                let column = |i: usize| Vector3::new(outer[(0, i)], outer[(1, i)], outer[(2, i)]);
                let (x, y, z) = (column(0), column(1), column(2));
                match i {
                    0 => Matrix3::from_columns(&[x, y * c + z * s, z * c - y * s]),
                    1 => Matrix3::from_columns(&[x * c - z * s, y, z * c + x * s]),
                    _ => Matrix3::from_columns(&[x * c + y * s, y * c - x * s, z]),
                }
            }
            Self::General(R) => outer * R,
        }
    }

    /// Inner components of `v` from outer ones.
    #[inline]
    pub(crate) fn inward(&self, v: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Parallel => *v,
            Self::About(i, s, c) => turned(*i, -s, *c, v),
            Self::General(R) => R.tr_mul(v),
        }
    }

    /// Outer components of `v` from inner ones.
    #[inline]
    pub(crate) fn outward(&self, v: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Parallel => *v,
            Self::About(i, s, c) => turned(*i, *s, *c, v),
            Self::General(R) => R * v,
        }
    }

    /// Outer components of a symmetric matrix from inner ones.
    #[inline]
    fn symmetric_outward(&self, inner: &Symmetric) -> Symmetric {
        match self {
            Self::Parallel => *inner,
            Self::About(0, s, c) => symmetric_turned::<0>(*s, *c, inner),
            Self::About(1, s, c) => symmetric_turned::<1>(*s, *c, inner),
            Self::About(_, s, c) => symmetric_turned::<2>(*s, *c, inner),
            Self::General(R) => Symmetric::of(&(R * inner.full() * R.transpose())),
        }
    }
}

/// Where a frame is in an outer one: `Transform` with a rotation that may cost less than a matrix.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placement {
    pub(crate) turn: Turn,
    pub(crate) translation: Vector3<f64>,
}

impl Placement {
    /// The outer frame itself.
    pub(crate) const IDENTITY: Self = Self { turn: Turn::Parallel, translation: ZERO3 };

    /// The same wrench in the outer frame.
    #[inline]
    pub(crate) fn wrench(&self, inner: &Force) -> Force {
        let force = self.turn.outward(&inner.force);
        Force { moment: self.turn.outward(&inner.moment) + self.translation.cross(&force), force }
    }

    /// The same inertia in the outer frame.
    #[inline]
    pub(crate) fn inertia(&self, inner: &Inertia) -> Inertia {
        let (mass, p) = (inner.mass, &self.translation);
        let turned = self.turn.outward(&inner.first_moment);
        let shift = p * mass;
        Inertia {
            mass,
            first_moment: turned + shift,
            // Parallel axes: from the origin to the centre of mass, and on to the outer origin.
            about_origin: self
                .turn
                .symmetric_outward(&inner.about_origin)
                .plus(&Symmetric::of_pair(p, &(turned + shift * 0.5))),
        }
    }
}

/// `v`, turned about coordinate axis `i` by the angle with sine `s` and cosine `c`.
#[inline]
fn turned(i: usize, s: f64, c: f64, v: &Vector3<f64>) -> Vector3<f64> {
    match i {
        0 => Vector3::new(v.x, c * v.y - s * v.z, s * v.y + c * v.z),
        1 => Vector3::new(c * v.x + s * v.z, v.y, c * v.z - s * v.x),
        _ => Vector3::new(c * v.x - s * v.y, s * v.x + c * v.y, v.z),
    }
}

/// R·`inner`·Rᵀ with R about coordinate axis `K`, by the angle with sine `s` and cosine `c`.
///
/// In the plane across the axis the trace stays; beside it a row turns like a vector.
#[inline]
fn symmetric_turned<const K: usize>(s: f64, c: f64, inner: &Symmetric) -> Symmetric {
    let (i, j) = ((K + 1) % 3, (K + 2) % 3);
    let (d, b) = (&inner.diagonal, &inner.beside);
    let mut outer = *inner;
    let gap = d[j] - d[i];
    let moved = s * (s * gap - 2.0 * c * b[K]);
    outer.diagonal[i] = d[i] + moved;
    outer.diagonal[j] = d[j] - moved;
    outer.beside[K] = (c * c - s * s) * b[K] - c * s * gap;
    outer.beside[i] = s * b[j] + c * b[i];
    outer.beside[j] = c * b[j] - s * b[i];
    outer
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spatial::MassProperties;

    #[track_caller]
    fn check_small(what: &str, gap: Matrix3<f64>) {
        assert!(gap.abs().max() < 1e-14, "{what}: {gap}");
    }

    #[test]
    fn a_coordinate_axis_turns_as_any_other_does() {
        let outer = rodrigues(&Vector3::new(0.48, -0.6, 0.64), 0.28, 0.96);
        let v = Vector3::new(0.3, -0.7, 0.2);
        let inner =
            Symmetric { diagonal: Vector3::new(0.9, 0.5, 0.7), beside: Vector3::new(0.1, -0.2, 0.15) };
        for axis in [Vector3::x(), -Vector3::x(), Vector3::y(), -Vector3::y(), Vector3::z(), -Vector3::z()] {
            assert!(matches!(Axis::along(&axis), Axis::Coordinate(..)), "{axis}");
            for angle in [-2.9, -0.3, 0.0, 1.2] {
                let quick = Turn::about(&Axis::along(&axis), angle);
                let general = Turn::about(&Axis::Oblique(axis), angle);
                let R = general.within(&Matrix3::identity());
                check_small("axes", quick.within(&outer) - general.within(&outer));
                check_small("outward", Matrix3::from_diagonal(&(quick.outward(&v) - R * v)));
                check_small("inward", Matrix3::from_diagonal(&(quick.inward(&v) - R.transpose() * v)));
                let expected = R * inner.full() * R.transpose();
                check_small("symmetric", quick.symmetric_outward(&inner).full() - expected);
                check_small("symmetric", general.symmetric_outward(&inner).full() - expected);
            }
        }
    }

    #[test]
    fn inertia_moves_as_the_mass_does() {
        let about_center = Matrix3::new(0.9, 0.1, 0.2, 0.1, 0.7, -0.3, 0.2, -0.3, 0.8);
        let body = MassProperties { mass: 2.5, center: Vector3::new(0.4, -0.2, 0.3), about_center };
        let turn = Turn::about(&Axis::Coordinate(1, -1.0), 0.7);
        let placement = Placement { turn, translation: Vector3::new(-0.5, 1.1, 0.6) };
        let rotation = turn.within(&Matrix3::identity());
        let X_AB = crate::spatial::Transform { rotation, translation: placement.translation };
        let (moved, expected) =
            (placement.inertia(&body.about_origin()), body.expressed_in(&X_AB).about_origin());
        check_small("rotational", moved.about_origin.full() - expected.about_origin.full());
        check_small("first", Matrix3::from_diagonal(&(moved.first_moment - expected.first_moment)));
        assert_eq!(moved.mass, expected.mass);
    }
}
