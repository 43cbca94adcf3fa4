//! Real roots in (0, 1) of a polynomial whose derivative's roots are known.

use crate::math::sqrt;

/// Most roots of a quartic.
const CAPACITY: usize = 4;

/// Roots in the open interval (0, 1), in increasing order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Roots {
    values: [f64; CAPACITY],
    count: usize,
}

/// Change of the primitive that a root need not be refined for, in units of the polynomial's size: far below an ulp.
const NEGLIGIBLE: f64 = f64::EPSILON / 1024.0;

/// Whether c₀ + c₁u + … is of one sign on [0, 1] by its Bernstein coefficients, so that it has no root inside.
///
/// A sign that rounding of the coefficients' sum may have made counts as none: it moves the primitive by less than its own
/// rounding.
#[inline]
pub(crate) fn has_one_sign<const N: usize>(coefficients: [f64; N]) -> bool {
    let bernstein = bernstein(coefficients);
    let size: f64 = coefficients.iter().map(|c| c.abs()).sum();
    let tolerance = 4.0 * f64::EPSILON * size;
    bernstein.iter().all(|b| *b >= -tolerance) || bernstein.iter().all(|b| *b <= tolerance)
}

/// Bernstein coefficients on [0, 1]: c₀ + c₁u + … lies between the least and the greatest of them there.
#[inline]
fn bernstein<const N: usize>(coefficients: [f64; N]) -> [f64; N] {
    let mut scaled = coefficients;
    let mut binomial = 1.0;
    for (k, c) in scaled.iter_mut().enumerate() {
        *c /= binomial;
        binomial *= (N - 1 - k) as f64 / (k + 1) as f64;
    }
    for first in 1..N {
        for i in (first..N).rev() {
            scaled[i] += scaled[i - 1];
        }
    }
    scaled
}

impl Roots {
    pub(crate) const NONE: Self = Self { values: [0.0; CAPACITY], count: 0 };

    /// Roots of c₀ + c₁u + c₂u².
    #[inline]
    pub(crate) fn of_quadratic(coefficients: [f64; 3]) -> Self {
        let mut roots = Self::NONE;
        if has_one_sign(coefficients) {
            return roots;
        }
        let [c0, c1, c2] = coefficients;
        let discriminant = sqrt(c1 * c1 - 4.0 * c2 * c0); // NaN without a root
        let sum = -0.5 * (c1 + discriminant.copysign(c1)); // nothing cancels here
        let (a, b) = (sum / c2, c0 / sum);
        for root in if a < b { [a, b] } else { [b, a] } {
            if root > 0.0 && root < 1.0 {
                roots.push(root);
            }
        }
        roots
    }

    /// Roots of c₀ + c₁u + …, at most a quartic, given the roots of its derivative: between two of those it is
    /// monotone, so a change of sign brackets exactly one root.
    ///
    /// A root of even order that rounding hides is missed; the primitive has no extremum there.
    #[inline]
    pub(crate) fn between<const N: usize>(turns: &Self, coefficients: [f64; N]) -> Self {
        let mut roots = Self::NONE;
        let (mut left, mut value_left) = (0.0, coefficients[0]);
        for right in turns.iter().chain([1.0]) {
            let (value_right, _) = value_and_slope(&coefficients, right);
            if (value_left < 0.0 && value_right > 0.0) || (value_left > 0.0 && value_right < 0.0) {
                roots.push(bracketed(&coefficients, (left, right), (value_left, value_right)));
            } else if value_right == 0.0 && right < 1.0 {
                roots.push(right);
            }
            (left, value_left) = (right, value_right);
        }
        roots
    }

    pub(crate) const fn is_empty(&self) -> bool {
        self.count == 0
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = f64> + '_ {
        self.values.iter().copied().take(self.count)
    }

    fn push(&mut self, root: f64) {
        if self.count < CAPACITY {
            self.values[self.count] = root;
            self.count += 1;
        }
    }
}

#[inline]
fn value_and_slope<const N: usize>(coefficients: &[f64; N], u: f64) -> (f64, f64) {
    let (mut value, mut slope) = (0.0, 0.0);
    for c in coefficients.iter().rev() {
        slope = slope * u + value;
        value = value * u + c;
    }
    (value, slope)
}

/// The root in [left, right], by Newton steps that fall back to halving where they would leave the bracket.
///
/// Precise to what the primitive can tell: its value at the root is that at the exact root, rounded.
fn bracketed<const N: usize>(
    coefficients: &[f64; N],
    (mut left, mut right): (f64, f64),
    (value_left, value_right): (f64, f64),
) -> f64 {
    let negligible = NEGLIGIBLE * (value_left.abs() + value_right.abs());
    let mut u = 0.5 * (left + right);
    for _ in 0..100 {
        let (value, slope) = value_and_slope(coefficients, u);
        if value == 0.0 {
            return u;
        }
        if (value < 0.0) == (value_left < 0.0) {
            left = u;
        } else {
            right = u;
        }
        let newton = u - value / slope;
        let next = if newton > left && newton < right { newton } else { 0.5 * (left + right) };
        if (value * (next - u)).abs() <= negligible || right - left <= f64::EPSILON * u {
            return next;
        }
        u = next;
    }
    u
}

#[cfg(test)]
mod tests {
    use super::Roots;

    /// Plants four roots and expects them back through the chain of derivatives.
    #[track_caller]
    fn check_planted(planted: [f64; 4]) {
        let mut c = [1.0, 0.0, 0.0, 0.0, 0.0];
        for root in planted {
            for i in (0..5).rev() {
                c[i] = if i > 0 { c[i - 1] } else { 0.0 } - root * c[i];
            }
        }
        let first = Roots::of_quadratic([2.0 * c[2], 6.0 * c[3], 12.0 * c[4]]);
        let turns = Roots::between(&first, [c[1], 2.0 * c[2], 3.0 * c[3], 4.0 * c[4]]);
        let found: Vec<f64> = Roots::between(&turns, c).iter().collect();
        let expected: Vec<f64> = planted.into_iter().filter(|u| *u > 0.0 && *u < 1.0).collect();
        assert_eq!(found.len(), expected.len(), "planted {planted:?}, found {found:?}");
        for (u, v) in found.iter().zip(&expected) {
            assert!((u - v).abs() < 1e-9, "planted {planted:?}, found {found:?}");
        }
    }

    #[test]
    fn planted_roots_come_back() {
        check_planted([0.1, 0.2, 0.6, 0.9]);
        check_planted([0.001, 0.002, 0.5, 0.999]);
        check_planted([-1.0, 0.3, 0.4, 2.0]);
        check_planted([-3.0, -2.0, 1.5, 2.0]);
    }

    #[test]
    fn a_constant_has_no_roots() {
        assert_eq!(Roots::between(&Roots::NONE, [1.0, 0.0, 0.0, 0.0, 0.0]).iter().count(), 0);
        assert!(Roots::of_quadratic([1.0, 0.0, 0.0]).is_empty());
        assert!(Roots::of_quadratic([0.0, 0.0, 0.0]).is_empty());
    }

    #[test]
    fn a_quadratic_that_is_a_line_has_its_root() {
        let roots: Vec<f64> = Roots::of_quadratic([-1.0, 4.0, 0.0]).iter().collect();
        assert_eq!(roots, [0.25]);
    }

    #[test]
    fn bernstein_coefficients_enclose_and_end_at_the_ends() {
        assert_eq!(super::bernstein([0.0, 0.0, 3.0, -2.0]), [0.0, 0.0, 1.0, 1.0]);
        assert_eq!(super::bernstein([1.0, -4.0, 6.0, -4.0, 1.0]), [1.0, 0.0, 0.0, 0.0, 0.0]);
    }
}
