//! The one source of randomness of a case.

use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{RngCore, SeedableRng};

use crate::draw::mix;

/// Draws of one case.
#[derive(Clone, Debug)]
pub(super) struct Random(Xoshiro256PlusPlus);

impl Random {
    /// The draws of case `index`; they depend on nothing else.
    pub(super) fn of_case(seed: u64, index: u64) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(mix(mix(seed) ^ index)))
    }

    #[inline]
    pub(super) fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// Uniform in [0, 1).
    #[inline]
    pub(super) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
    }

    /// Uniform in [`low`, `high`).
    #[inline]
    pub(super) fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + self.unit() * (high - low)
    }

    /// Uniform among 0 to `count` − 1, for small counts.
    #[inline]
    pub(super) fn below(&mut self, count: u64) -> u64 {
        ((self.bits() >> 32) * count) >> 32
    }

    /// −1 or 1.
    #[inline]
    pub(super) fn sign(&mut self) -> f64 {
        if self.bits() >> 63 == 0 { 1.0 } else { -1.0 }
    }

    /// 10 to a power between `low` and `high`.
    pub(super) fn decades(&mut self, low: f64, high: f64) -> f64 {
        10_f64.powf(self.uniform(low, high))
    }

    /// Uniform in [0, 1], each end with a probability of one in eight.
    pub(super) fn share(&mut self) -> f64 {
        match self.below(8) {
            0 => 0.0,
            1 => 1.0,
            _ => self.unit(),
        }
    }
}
