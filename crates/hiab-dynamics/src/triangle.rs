//! One closed cylinder loop: a triangle whose third side is the cylinder.
//!
//! In the plane of the loop, seen along the main joint's axis: O is the main hinge, C the barrel's hinge, both on
//! one body; P is the pin where the rod meets the body behind the main joint. |OC| = a and |OP| = b are fixed,
//! |CP| = ℓ grows with the stroke s:
//!
//! ```text
//! u = λ + s        ℓ² = u² + η²        (η: the pin's offset from the barrel's axis, usually 0)
//! D = ½(a² + b² − ℓ²) = ab cos φ       φ: angle at O
//! E = ½(ℓ² + b² − a²) = bℓ cos ω       ω: angle at P
//! K² = D-discriminant = ¼((a+b)² − ℓ²)(ℓ² − (a−b)²),  K = ab sin φ = twice the triangle's area
//! ```
//!
//! Law of cosines for the angles, and their derivatives by s:
//!
//! ```text
//! φ′ = u/K                 φ″ = 1/K − u²D/K³
//! ψ′ = −uE/(ℓ²K)           ψ″ = −(E + u²)/(ℓ²K) + 2u²E/(ℓ⁴K) + u²ED/(ℓ²K³)      ψ: angle at C
//! ρ′ = −η/ℓ²               ρ″ = 2uη/ℓ⁴           ρ = atan2(η, u): direction of CP in the barrel's frame
//! ```

/// Smallest sin φ at which a loop counts as solvable.
///
/// At sin φ = 0 the three pins are in line: the loop toggles and the hinge's rate per stroke is infinite. At 0.15
/// (8.6°) a cylinder still turns its hinge with 15 % of its force times the arm, and every derivative above is
/// accurate to better than 1e-11 relative.
pub(crate) const MIN_SIN_AT_HINGE: f64 = 0.15;

/// Constants of one loop, made by `loops` from the pins of the URDF.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle {
    /// |OC| \[m\].
    pub(crate) a: f64,
    /// |OP| \[m\].
    pub(crate) b: f64,
    /// Length of CP along the barrel's axis at stroke 0, λ \[m\].
    pub(crate) lambda: f64,
    /// Offset of P from the barrel's axis, η \[m\].
    pub(crate) eta: f64,
    /// +1 if OP is turned from OC by +φ about the main joint's axis, −1 if by −φ.
    pub(crate) branch: f64,
    /// Main joint's position at φ = 0 \[rad\], turns included.
    pub(crate) main_zero: f64,
    /// Barrel joint's position at ψ = ρ = 0 \[rad\], turns included.
    pub(crate) barrel_zero: f64,
    /// +1 if the barrel's axis is the main joint's, −1 if its opposite.
    pub(crate) barrel_sign: f64,
    /// Least solvable stroke \[m\].
    pub(crate) min_stroke: f64,
    /// Greatest solvable stroke \[m\].
    pub(crate) max_stroke: f64,
}

/// Position of a dependent joint and its first two derivatives by the stroke.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dependent {
    pub(crate) position: f64,
    pub(crate) slope: f64,
    pub(crate) curvature: f64,
}

impl Triangle {
    /// Solvable strokes \[m\] by geometry alone, if there are any: sin φ ≥ [`MIN_SIN_AT_HINGE`] and u > 0.
    pub(crate) fn solvable_strokes(a: f64, b: f64, lambda: f64, eta: f64) -> Option<(f64, f64)> {
        let cos_limit = (1.0 - MIN_SIN_AT_HINGE * MIN_SIN_AT_HINGE).sqrt();
        let shortest = (a * a + b * b - 2.0 * a * b * cos_limit - eta * eta).max(0.0).sqrt();
        let longest = (a * a + b * b + 2.0 * a * b * cos_limit - eta * eta).max(0.0).sqrt();
        (longest > shortest).then_some((shortest - lambda, longest - lambda))
    }

    /// Whether `stroke` is inside the solvable range; NaN is not.
    #[inline]
    pub(crate) fn is_solvable(&self, stroke: f64) -> bool {
        self.min_stroke <= stroke && stroke <= self.max_stroke
    }

    /// Main and barrel joint at `stroke`, which must be solvable.
    #[inline]
    pub(crate) fn solve(&self, stroke: f64) -> (Dependent, Dependent) {
        let (a, b, eta) = (self.a, self.b, self.eta);
        let u = self.lambda + stroke;
        let l2 = u * u + eta * eta; // ℓ²
        let d = 0.5 * (a * a + b * b - l2); // D
        let e = 0.5 * (l2 + b * b - a * a); // E
        let k = 0.5 * (((a + b) * (a + b) - l2) * (l2 - (a - b) * (a - b))).sqrt(); // K
        let inv_k = 1.0 / k;
        let inv_l2 = 1.0 / l2;

        let phi = libm::atan2(k, d);
        let phi_1 = u * inv_k;
        let phi_2 = inv_k * (1.0 - u * u * d * inv_k * inv_k);

        let psi = libm::atan2(k, 0.5 * (a * a + l2 - b * b));
        let psi_1 = -u * e * inv_l2 * inv_k;
        let psi_2 = inv_l2 * inv_k * (2.0 * u * u * e * inv_l2 + u * u * e * d * inv_k * inv_k - e - u * u);

        let rho = if eta == 0.0 { 0.0 } else { libm::atan2(eta, u) };
        let rho_1 = -eta * inv_l2;
        let rho_2 = 2.0 * u * eta * inv_l2 * inv_l2;

        let (branch, sign) = (self.branch, self.barrel_sign);
        (
            Dependent {
                position: self.main_zero + branch * phi,
                slope: branch * phi_1,
                curvature: branch * phi_2,
            },
            Dependent {
                position: self.barrel_zero - sign * (branch * psi + rho),
                slope: -sign * (branch * psi_1 + rho_1),
                curvature: -sign * (branch * psi_2 + rho_2),
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(eta: f64, branch: f64, sign: f64) -> Triangle {
        Triangle {
            a: 1.1,
            b: 0.4,
            lambda: 0.8,
            eta,
            branch,
            main_zero: 0.3,
            barrel_zero: -0.2,
            barrel_sign: sign,
            min_stroke: 0.0,
            max_stroke: 0.6,
        }
    }

    #[test]
    fn slopes_and_curvatures_are_the_derivatives() {
        let h = 1e-5;
        for (eta, branch, sign) in [(0.0, 1.0, 1.0), (0.05, 1.0, -1.0), (-0.1, -1.0, 1.0)] {
            let triangle = triangle(eta, branch, sign);
            for step in 1..12 {
                let stroke = 0.05 * f64::from(step);
                let pick = |s: f64, main: bool| {
                    let (m, c) = triangle.solve(s);
                    if main { m } else { c }
                };
                for main in [true, false] {
                    let (low, mid, high) =
                        (pick(stroke - h, main), pick(stroke, main), pick(stroke + h, main));
                    let slope = (high.position - low.position) / (2.0 * h);
                    let curvature = (high.slope - low.slope) / (2.0 * h);
                    assert!((slope - mid.slope).abs() < 1e-7, "slope {} is not {slope}", mid.slope);
                    assert!(
                        (curvature - mid.curvature).abs() < 1e-5,
                        "curvature {} is not {curvature}",
                        mid.curvature
                    );
                }
            }
        }
    }

    #[test]
    fn ends_of_the_solvable_range_have_the_least_sine() {
        let (low, high) = Triangle::solvable_strokes(1.1, 0.4, 0.8, 0.05).unwrap();
        for stroke in [low, high] {
            let l2 = (0.8 + stroke) * (0.8 + stroke) + 0.05 * 0.05;
            let cos = (1.1 * 1.1 + 0.4 * 0.4 - l2) / (2.0 * 1.1 * 0.4);
            assert!(((1.0 - cos * cos).sqrt() - MIN_SIN_AT_HINGE).abs() < 1e-12);
        }
    }

    #[test]
    fn a_barrel_with_too_large_an_offset_has_no_solvable_stroke() {
        assert_eq!(Triangle::solvable_strokes(1.0, 0.2, 0.8, 2.0), None);
    }
}
