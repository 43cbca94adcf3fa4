//! One adaptive law: a parameter that grows with an error and leaks away.

/// φ̂ with φ̂' = −r·φ̂ + g·z², integrated exactly over a tick during which z is held.
///
/// [P, Eq. (307)] is r = k₃k₄, g = ½k₂k₃ with z₁, and [P, Eq. (311)] is r = k₇k₈, g = ½k₆k₇ with z₂.
/// With z held the solution over a tick is φ̂·e^(−rT) + (g/r)·z²·(1 − e^(−rT)): a convex combination
/// of the old parameter and its stationary value. No gain and no period can make it diverge or go
/// negative, as a forward Euler step does for r·T > 2 or r·T > 1.
///
/// Invariant: 0 ≤ `estimate` ≤ `ceiling`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AdaptiveLaw {
    estimate: f64,
    ceiling: f64,
    decay: f64,      // e^(−rT)
    stationary: f64, // g/r: stationary φ̂ per z²
    growth: f64,     // (g/r)·(1 − e^(−rT))
}

/// The constants of one adaptive law, all > 0 (the ceiling ≥ 0).
pub(crate) struct LawSpec {
    pub(crate) weight: f64,  // k₂ or k₆
    pub(crate) speed: f64,   // k₃ or k₇
    pub(crate) leakage: f64, // k₄ or k₈
    pub(crate) period: f64,
    pub(crate) ceiling: f64,
}

impl AdaptiveLaw {
    pub(crate) fn new(spec: LawSpec) -> Self {
        let exponent = -(spec.speed * spec.leakage) * spec.period;
        let stationary = 0.5 * spec.weight / spec.leakage;
        Self {
            estimate: 0.0,
            ceiling: spec.ceiling,
            decay: libm::exp(exponent),
            stationary,
            growth: stationary * -libm::expm1(exponent),
        }
    }

    /// φ̂.
    pub(crate) fn estimate(&self) -> f64 {
        self.estimate
    }

    /// Largest φ̂ that the sampled loop bears.
    pub(crate) fn ceiling(&self) -> f64 {
        self.ceiling
    }

    /// Where φ̂ comes to rest when z stays as it is.
    pub(crate) fn resting_estimate(&self, z: f64) -> f64 {
        (self.stationary * z * z).min(self.ceiling)
    }

    /// Sets φ̂, which must be within 0 and the ceiling.
    pub(crate) fn set(&mut self, estimate: f64) {
        self.estimate = estimate;
    }

    /// One tick with z held. True if the ceiling cut φ̂.
    pub(crate) fn advance(&mut self, z: f64) -> bool {
        let next = self.estimate * self.decay + self.growth * (z * z);
        let cut = next > self.ceiling;
        self.estimate = if cut { self.ceiling } else { next };
        cut
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law(speed: f64, leakage: f64, period: f64) -> AdaptiveLaw {
        AdaptiveLaw::new(LawSpec { weight: 3.0, speed, leakage, period, ceiling: f64::MAX })
    }

    /// φ̂ after one tick in `steps` forward Euler steps: first order, so extrapolated once.
    fn fine_euler(start: f64, z: f64, steps: u32) -> f64 {
        let run = |n: u32| {
            let h = 0.01 / f64::from(n);
            (0..n).fold(start, |phi, _| phi + h * (-20.0 * 0.7 * phi + 0.5 * 3.0 * 20.0 * z * z))
        };
        2.0 * run(2 * steps) - run(steps)
    }

    #[test]
    fn one_tick_equals_the_fine_integration() {
        for (start, z) in [(0.0, 0.4), (2.0, 0.0), (1.3, -0.8)] {
            let mut law = law(20.0, 0.7, 0.01);
            law.set(start);
            law.advance(z);
            let fine = fine_euler(start, z, 100_000);
            let error = (law.estimate() - fine).abs();
            assert!(error < 1e-9, "from {start} with z {z}: {} against {fine}", law.estimate());
        }
    }

    #[test]
    fn two_half_ticks_equal_a_whole_one() {
        let (mut whole, mut half) = (law(20.0, 0.7, 0.01), law(20.0, 0.7, 0.005));
        whole.set(1.3);
        half.set(1.3);
        whole.advance(0.9);
        half.advance(0.9);
        half.advance(0.9);
        assert!((whole.estimate() - half.estimate()).abs() < 1e-14);
    }

    #[test]
    fn gains_that_break_an_euler_step_neither_diverge_nor_go_negative() {
        let mut law = law(1e9, 1e3, 1.0); // r·T = 1e12
        law.set(7.0);
        for z in [0.0, 3.0, 0.0, -3.0] {
            law.advance(z);
            let rest = law.resting_estimate(z);
            assert!((law.estimate() - rest).abs() <= 1e-15 * rest, "{} against {rest}", law.estimate());
        }
    }

    #[test]
    fn slow_leakage_is_not_lost_in_rounding() {
        let mut law = law(1e-12, 1e-6, 1e-3); // r·T = 1e-21: 1 − e^(−rT) rounds to 0
        law.advance(1.0);
        let exact = 0.5 * 3.0 * 1e-12 * 1e-3;
        assert!((law.estimate() / exact - 1.0).abs() < 1e-12, "{}", law.estimate());
    }

    #[test]
    fn the_ceiling_holds_and_says_so() {
        let mut law =
            AdaptiveLaw::new(LawSpec { weight: 1.0, speed: 1.0, leakage: 1.0, period: 0.1, ceiling: 0.2 });
        assert!(!law.advance(1.0));
        assert!((0..100).any(|_| law.advance(1e200)));
        assert_eq!(law.estimate(), 0.2);
    }
}
