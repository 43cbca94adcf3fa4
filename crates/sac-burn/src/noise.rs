//! All randomness of an agent: one generator, drawn from on the host.

use std::f32::consts::TAU;

use rand_core::{RngCore, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize};

/// The one source of randomness: xoshiro256++, whose state a checkpoint holds.
///
/// Equal states give equal numbers on every machine.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Noise {
    generator: Xoshiro256PlusPlus,
}

impl Noise {
    /// The generator that `seed` stands for.
    pub fn new(seed: u64) -> Self {
        Self { generator: Xoshiro256PlusPlus::seed_from_u64(seed) }
    }

    /// Uniform index below `count` by multiply-and-shift; its bias, count/2⁶⁴, is below anything that counts here.
    pub(crate) fn index(&mut self, count: usize) -> usize {
        ((u128::from(self.generator.next_u64()) * count as u128) >> 64) as usize
    }

    /// Uniform number in [−bound, bound), 24 random bits.
    pub(crate) fn uniform(&mut self, bound: f32) -> f32 {
        let unit = (self.generator.next_u64() >> 40) as f32 * (1.0 / (1u32 << 24) as f32);
        (2.0 * unit - 1.0) * bound
    }

    /// Independent standard normal numbers (Box–Muller; at most 6.7 in magnitude).
    ///
    /// Draws in pairs and drops the odd one at the end, so the state afterwards depends on the length alone.
    pub(crate) fn fill_normal(&mut self, values: &mut [f32]) {
        for pair in values.chunks_mut(2) {
            let bits = self.generator.next_u64();
            let scale = 1.0 / 4_294_967_296.0;
            let radius = (-2.0 * libm::logf(((bits >> 32) as f32 + 1.0) * scale)).max(0.0).sqrt();
            let (sine, cosine) = libm::sincosf(TAU * ((bits as u32) as f32 * scale));
            pair[0] = radius * cosine;
            if let Some(second) = pair.get_mut(1) {
                *second = radius * sine;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_numbers_have_the_moments_of_the_standard_normal() {
        let mut values = vec![0.0; 200_001];
        Noise::new(3).fill_normal(&mut values);
        let n = values.len() as f64;
        let moment = |power: i32| values.iter().map(|&x| f64::from(x).powi(power)).sum::<f64>() / n;
        // Four standard deviations of each estimate: √(1/n), √(2/n), √(15/n), √(96/n).
        for (power, expected, variance) in [(1, 0.0, 1.0), (2, 1.0, 2.0), (3, 0.0, 15.0), (4, 3.0, 96.0)] {
            let bound = 4.0 * f64::sqrt(variance / n);
            let error = (moment(power) - expected).abs();
            assert!(error < bound, "moment {power} is off by {error}, allowed {bound}");
        }
    }

    #[test]
    fn indices_cover_the_range_evenly() {
        let mut noise = Noise::new(5);
        let mut counts = [0u32; 7];
        for _ in 0..70_000 {
            counts[noise.index(7)] += 1;
        }
        for count in counts {
            assert!((f64::from(count) - 10_000.0).abs() < 5.0 * 100.0, "an index was drawn {count} times");
        }
    }

    #[test]
    fn uniform_numbers_stay_inside_their_bound() {
        let mut noise = Noise::new(6);
        let values: Vec<f32> = (0..10_000).map(|_| noise.uniform(0.5)).collect();
        assert!(values.iter().all(|x| (-0.5..0.5).contains(x)));
        let mean = values.iter().sum::<f32>() / 10_000.0;
        assert!(mean.abs() < 4.0 * 0.5 / f32::sqrt(3.0 * 10_000.0), "mean {mean}");
    }
}
