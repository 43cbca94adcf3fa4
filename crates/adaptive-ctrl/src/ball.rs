//! The ball that the error of one sampled joint enters and stays in.

use crate::stability::check_period;
use crate::{Bounds, GainsSpec, InverseInertia, LimitsError, Parameters};

/// Where a joint and its adaptive law are while a bound is to hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OperatingRange {
    /// T_s, in seconds.
    pub period: f64,
    /// Range of A.
    pub inverse_inertia: InverseInertia,
    /// Range of ½(k₁ + k₂φ̂₁) [1/s].
    pub rate: Bounds,
    /// Range of ½(k₅ + k₆φ̂₂) [N·s/m or N·m·s/rad].
    pub damping: Bounds,
}

/// A quadratic function of the errors that falls whenever it is large: V = ρ², ρ² = s²·e₁² + (e₂ + a·e₁)².
///
/// The sampled loop is x⁺ = F·x + G·δ with x = (e₁, e₂), u held over the tick and δ everything that the law does not
/// know, as an effort. For every A, φ̂₁ and φ̂₂ of the operating range, also if they change from tick to tick,
/// ρ⁺ ≤ μ·ρ + g·|δ|; so from ρ₀ on ρ never exceeds max(ρ₀, ρ∞) and ends in ρ∞ = g·δ*/(1 − μ). F is linear in A, in the
/// rate and in the damping, each for itself, and a norm is convex; so μ, the largest norm of F in these coordinates, is
/// found at the corners of the range.
///
/// This is the paper's V with its weights set free and its u̇_v taken as what it is, a function of the state, for the loop as
/// it is sampled. `docs/control.md` says why the paper's own weights do not do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UltimateBound {
    rate: f64,        // a [1/s]
    weight: f64,      // s [1/s]
    contraction: f64, // μ
    gain: f64,        // g [m/s per N]
}

/// Steps of the search for the weights, each way.
const STEPS: i32 = 24;

impl UltimateBound {
    /// The weights with the least bound of position over the operating range; `None` if no weights show that the loop
    /// is stable there.
    ///
    /// # Errors
    /// [`LimitsError`] if the period is not finite and > 0.
    pub fn new(range: &OperatingRange) -> Result<Option<Self>, LimitsError> {
        check_period(range.period)?;
        let middle = libm::sqrt(range.rate.lower * range.rate.upper);
        let mut best: Option<Self> = None;
        for i in -STEPS..=STEPS {
            for j in -STEPS..=STEPS {
                // Half decades each way in sixteen steps a decade.
                let (a, s) = (middle * step(i), middle * step(i) * step(j));
                let found = Self::with_weights(range, a, s);
                let better = |best: &Self| found.position_per_effort() < best.position_per_effort();
                if found.contraction < 1.0 && best.as_ref().is_none_or(better) {
                    best = Some(found);
                }
            }
        }
        Ok(best)
    }

    /// For the adaptive law from rest at most `start` away (in e₁ and e₂) under disturbances of at most `disturbance`
    /// [N or N·m].
    ///
    /// How far φ̂₁ and φ̂₂ can rise depends on the errors and the errors' bound on them: found by iteration, and `None` if
    /// the two do not come to terms.
    ///
    /// # Errors
    /// As [`UltimateBound::new`].
    pub fn of_adaptive(
        gains: &GainsSpec,
        ceilings: Parameters,
        period: f64,
        inverse_inertia: InverseInertia,
        start: (f64, f64),
        disturbance: f64,
    ) -> Result<Option<(Self, OperatingRange)>, LimitsError> {
        let mut range =
            operating_range(gains, period, inverse_inertia, Parameters { position: 0.0, velocity: 0.0 });
        for _ in 0..20 {
            let Some(bound) = Self::new(&range)? else { return Ok(None) };
            let radius = bound.radius(disturbance).max(bound.distance(start.0, start.1));
            let e1 = bound.position(radius);
            let z2 = bound.velocity(radius) + range.rate.upper * e1;
            let reached = Parameters {
                position: (0.5 * gains.k2 * e1 * e1 / gains.k4).min(ceilings.position),
                velocity: (0.5 * gains.k6 * z2 * z2 / gains.k8).min(ceilings.velocity),
            };
            let needed = operating_range(gains, period, inverse_inertia, reached);
            if needed.rate.upper <= range.rate.upper && needed.damping.upper <= range.damping.upper {
                return Ok(Some((bound, range)));
            }
            // A little more than needed, so that the next round finds room.
            range.rate.upper = range.rate.upper.max(1.05 * needed.rate.upper);
            range.damping.upper = range.damping.upper.max(1.05 * needed.damping.upper);
        }
        Ok(None)
    }

    fn with_weights(range: &OperatingRange, a: f64, s: f64) -> Self {
        let OperatingRange { period, inverse_inertia, rate, damping } = *range;
        let mut contraction = 0.0_f64;
        for inverse in [inverse_inertia.min(), inverse_inertia.max()] {
            for r in [rate.lower, rate.upper] {
                for d in [damping.lower, damping.upper] {
                    contraction = contraction.max(norm(&transition(inverse, r, d, period, a, s)));
                }
            }
        }
        let (g1, g2) = (0.5 * period * period, period);
        let gain = inverse_inertia.max() * libm::hypot(s * g1, g2 + a * g1);
        Self { rate: a, weight: s, contraction, gain }
    }

    fn position_per_effort(&self) -> f64 {
        self.gain / ((1.0 - self.contraction) * self.weight)
    }

    /// μ: what a tick leaves of ρ at most.
    pub fn contraction(&self) -> f64 {
        self.contraction
    }

    /// ρ∞: where ρ ends under disturbances of at most `disturbance` [m/s or rad/s].
    pub fn radius(&self, disturbance: f64) -> f64 {
        self.gain * disturbance / (1.0 - self.contraction)
    }

    /// The same where position also slips by up to `slip` a tick against the velocities around it [m or rad]: what an
    /// integrator of low order adds.
    pub fn radius_with_slip(&self, disturbance: f64, slip: f64) -> f64 {
        self.radius(disturbance) + libm::hypot(self.weight, self.rate) * slip / (1.0 - self.contraction)
    }

    /// ρ for errors e₁ and e₂ [m/s or rad/s].
    pub fn distance(&self, e1: f64, e2: f64) -> f64 {
        libm::hypot(self.weight * e1, e2 + self.rate * e1)
    }

    /// Largest |e₁| within `radius` [m or rad].
    pub fn position(&self, radius: f64) -> f64 {
        radius / self.weight
    }

    /// Largest |e₂| within `radius` [m/s or rad/s].
    pub fn velocity(&self, radius: f64) -> f64 {
        radius * libm::hypot(1.0, self.rate / self.weight)
    }
}

/// Sixteen steps a decade.
fn step(number: i32) -> f64 {
    libm::pow(10.0, f64::from(number) / 16.0)
}

/// The range with φ̂₁ and φ̂₂ from 0 up to `reached`.
fn operating_range(
    gains: &GainsSpec,
    period: f64,
    inverse_inertia: InverseInertia,
    reached: Parameters,
) -> OperatingRange {
    OperatingRange {
        period,
        inverse_inertia,
        rate: Bounds { lower: 0.5 * gains.k1, upper: 0.5 * (gains.k1 + gains.k2 * reached.position) },
        damping: Bounds { lower: 0.5 * gains.k5, upper: 0.5 * (gains.k5 + gains.k6 * reached.velocity) },
    }
}

/// F in the coordinates (s·e₁, e₂ + a·e₁), for u = −(1 + r·d)·e₁ − d·e₂ held over a tick.
fn transition(inverse: f64, r: f64, d: f64, period: f64, a: f64, s: f64) -> [[f64; 2]; 2] {
    let (p, d) = (inverse * (1.0 + r * d), inverse * d);
    let half = 0.5 * period * period;
    let f = [[1.0 - half * p, period - half * d], [-period * p, 1.0 - period * d]];
    // L·F·L⁻¹ with L = [[s, 0], [a, 1]].
    let (top, bottom) = ([s * f[0][0], s * f[0][1]], [a * f[0][0] + f[1][0], a * f[0][1] + f[1][1]]);
    [top, bottom].map(|row| [(row[0] - a * row[1]) / s, row[1]])
}

/// Largest singular value.
fn norm(m: &[[f64; 2]; 2]) -> f64 {
    let [[a, b], [c, d]] = *m;
    let (sum, difference) = (libm::hypot(a + d, b - c), libm::hypot(a - d, b + c));
    0.5 * (sum + difference)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(lower: f64, upper: f64) -> OperatingRange {
        OperatingRange {
            period: 0.0005,
            inverse_inertia: InverseInertia::of_inertia(Bounds { lower, upper }).unwrap(),
            rate: Bounds { lower: 80.0, upper: 90.0 },
            damping: Bounds { lower: 7e5, upper: 7.7e5 },
        }
    }

    #[test]
    fn the_norm_is_the_largest_singular_value() {
        assert!((norm(&[[3.0, 0.0], [4.0, 5.0]]) - 45_f64.sqrt()).abs() < 1e-12);
        assert!((norm(&[[0.0, 2.0], [-1.0, 0.0]]) - 2.0).abs() < 1e-15);
    }

    #[test]
    fn a_wider_range_has_a_larger_ball() {
        let ball = |lower, upper| UltimateBound::new(&range(lower, upper)).unwrap().unwrap();
        let (narrow, wide) = (ball(1050.0, 1100.0), ball(1000.0, 1600.0));
        assert!(narrow.contraction() < 1.0 && narrow.position_per_effort() < wide.position_per_effort());
        // At rest a constant load displaces by load over stiffness, which no bound can be below.
        let least = 1.0 / (80.0 * 7e5);
        assert!(narrow.position(narrow.radius(1.0)) > least);
        assert!(narrow.position(narrow.radius(1.0)) < 4.0 * least, "{narrow:?}");
    }

    #[test]
    fn a_loop_that_diverges_has_no_ball() {
        let mut diverging = range(1050.0, 1100.0);
        diverging.damping = Bounds { lower: 5e6, upper: 5e6 };
        assert_eq!(UltimateBound::new(&diverging).unwrap(), None);
        diverging.period = 0.0;
        assert!(UltimateBound::new(&diverging).is_err());
    }
}
