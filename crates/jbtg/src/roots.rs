//! Real roots in (0, 1) of a polynomial whose derivative's roots are known.

/// Most roots of a quartic.
const CAPACITY: usize = 4;

/// Roots in the open interval (0, 1), in increasing order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Roots {
    values: [f64; CAPACITY],
    count: usize,
}

impl Roots {
    const NONE: Self = Self { values: [0.0; CAPACITY], count: 0 };

    /// Root of c₀ + c₁u.
    pub(crate) fn of_linear(c0: f64, c1: f64) -> Self {
        let mut roots = Self::NONE;
        let root = -c0 / c1;
        if root > 0.0 && root < 1.0 {
            roots.push(root);
        }
        roots
    }

    /// Roots of c₀ + c₁u + … + c₄u⁴, given the roots of its derivative: between two of those it is monotone, so a
    /// change of sign brackets exactly one root.
    ///
    /// A root of even order that rounding hides is missed; the primitive has no extremum there.
    pub(crate) fn between(turns: &Self, coefficients: [f64; 5]) -> Self {
        let mut roots = Self::NONE;
        let value = |u: f64| coefficients.iter().rev().fold(0.0, |sum, c| sum * u + c);
        let (mut left, mut value_left) = (0.0, value(0.0));
        for right in turns.iter().chain([1.0]) {
            let value_right = value(right);
            if (value_left < 0.0 && value_right > 0.0) || (value_left > 0.0 && value_right < 0.0) {
                roots.push(bracketed(&coefficients, left, right, value_left < 0.0));
            } else if value_right == 0.0 && right < 1.0 {
                roots.push(right);
            }
            (left, value_left) = (right, value_right);
        }
        roots
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = f64> + '_ {
        self.values[..self.count].iter().copied()
    }

    fn push(&mut self, root: f64) {
        if self.count < CAPACITY {
            self.values[self.count] = root;
            self.count += 1;
        }
    }
}

/// The root in [left, right], by Newton steps that fall back to halving where they would leave the bracket.
fn bracketed(coefficients: &[f64; 5], mut left: f64, mut right: f64, rising: bool) -> f64 {
    let mut u = 0.5 * (left + right);
    for _ in 0..100 {
        let (mut value, mut slope) = (0.0, 0.0);
        for c in coefficients.iter().rev() {
            slope = slope * u + value;
            value = value * u + c;
        }
        if value == 0.0 {
            return u;
        }
        if (value < 0.0) == rising {
            left = u;
        } else {
            right = u;
        }
        let newton = u - value / slope;
        let next = if newton > left && newton < right { newton } else { 0.5 * (left + right) };
        if next == u || right - left <= f64::EPSILON * u {
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
        let second = Roots::of_linear(6.0 * c[3], 24.0 * c[4]);
        let first = Roots::between(&second, [2.0 * c[2], 6.0 * c[3], 12.0 * c[4], 0.0, 0.0]);
        let turns = Roots::between(&first, [c[1], 2.0 * c[2], 3.0 * c[3], 4.0 * c[4], 0.0]);
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
        assert_eq!(Roots::of_linear(1.0, 0.0).iter().count(), 0);
        assert_eq!(Roots::of_linear(0.0, 0.0).iter().count(), 0);
    }
}
