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
const NEGLIGIBLE: f64 = f64::EPSILON / 16.0;

/// Whether c₀ + c₁u + … is of one sign on [0, 1] by its Bernstein coefficients, so that it has no root inside.
///
/// A sign that rounding of the coefficients' sum may have made counts as none: it moves the primitive by less than its own
/// rounding.
#[inline]
pub(crate) fn has_one_sign<const N: usize>(coefficients: [f64; N]) -> bool {
    let bernstein = bernstein(coefficients);
    let tolerance = rounding(coefficients);
    bernstein.iter().all(|b| *b >= -tolerance) || bernstein.iter().all(|b| *b <= tolerance)
}

/// Bound on what rounding makes of the value of c₀ + c₁u + … on [0, 1].
#[inline]
fn rounding<const N: usize>(coefficients: [f64; N]) -> f64 {
    let size: f64 = coefficients.iter().map(|c| c.abs()).sum();
    4.0 * f64::EPSILON * size
}

/// Bernstein coefficients on [0, 1]: c₀ + c₁u + … lies between the least and the greatest of them there.
#[inline]
fn bernstein<const N: usize>(coefficients: [f64; N]) -> [f64; N] {
    let mut scaled = coefficients;
    let mut binomial = 1.0;
    for (k, c) in scaled.iter_mut().enumerate() {
        *c *= 1.0 / binomial;
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

    /// Roots of c₀ + c₁u + c₂u² + c₃u³, given the roots of its derivative.
    ///
    /// One that is 0 at an end, but for rounding, has closed forms: acceleration is, at the outer end of a ramp.
    #[inline]
    pub(crate) fn of_cubic(turns: &Self, coefficients: [f64; 4]) -> Self {
        let [c0, c1, c2, c3] = coefficients;
        let tolerance = rounding(coefficients);
        if c0.abs() <= tolerance {
            Self::of_quadratic([c1, c2, c3])
        } else if (c0 + c1 + c2 + c3).abs() <= tolerance {
            let from_end = Self::of_quadratic([-(c1 + 2.0 * c2 + 3.0 * c3), c2 + 3.0 * c3, -c3]);
            let mut roots = Self::NONE;
            for root in from_end.iter().rev() {
                roots.push(1.0 - root);
            }
            roots
        } else {
            Self::between(turns, coefficients)
        }
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

    pub(crate) fn iter(&self) -> impl DoubleEndedIterator<Item = f64> + '_ {
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
    let guess = if value_left.abs() < value_right.abs() {
        left + distance_to_root(coefficients, left, value_left, -value_left)
    } else {
        right + distance_to_root(coefficients, right, value_right, value_right)
    };
    let mut u = if guess > left && guess < right { guess } else { 0.5 * (left + right) };
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
        let step = value / slope;
        if (value * step).abs() <= negligible {
            return (u - step).max(left).min(right);
        }
        let newton = u - step;
        u = if newton > left && newton < right { newton } else { 0.5 * (left + right) };
        if right - left <= f64::EPSILON * u {
            break;
        }
    }
    u
}

/// From `u` to the root of the parabola that touches the polynomial there. `sign` has the sign of the slope between the two.
///
/// A bracket begins where the slope is 0, where a line would lead nowhere.
#[inline]
fn distance_to_root<const N: usize>(coefficients: &[f64; N], u: f64, value: f64, sign: f64) -> f64 {
    let (_, slope) = value_and_slope(coefficients, u);
    let mut curvature = 0.0;
    for k in (2..N).rev() {
        curvature = curvature * u + (k * (k - 1)) as f64 * coefficients[k];
    }
    let root = sqrt(slope * slope - 2.0 * value * curvature);
    -2.0 * value / (slope + root.copysign(sign)) // NaN if the parabola has no root
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
    fn a_cubic_that_is_zero_at_an_end_has_its_other_roots_inside() {
        for (at_end, others) in [(0.0, [0.2, 0.9]), (1.0, [0.01, 0.4]), (1.0, [0.5, 3.0]), (0.0, [-1.0, 0.3])]
        {
            let [a, b] = others;
            // (u − e)(u − a)(u − b), 3·(…) so that the sum at 1 rounds
            let cubic = [-at_end * a * b, at_end * (a + b) + a * b, -(at_end + a + b), 1.0].map(|c| 3.0 * c);
            let [_, c1, c2, c3] = cubic;
            let turns = Roots::of_quadratic([c1, 2.0 * c2, 3.0 * c3]);
            let found: Vec<f64> = Roots::of_cubic(&turns, cubic).iter().collect();
            let expected: Vec<f64> = others.into_iter().filter(|u| *u > 0.0 && *u < 1.0).collect();
            assert_eq!(found.len(), expected.len(), "planted {at_end} and {others:?}, found {found:?}");
            for (u, v) in found.iter().zip(&expected) {
                assert!((u - v).abs() < 1e-14, "planted {at_end} and {others:?}, found {found:?}");
            }
        }
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
