//! Random draws that depend on nothing but the seed, what they are for, and a number.
//!
//! Episode 17 of a stage has the same start and target whenever it is played, in whatever order, before or after a
//! resume. Training and evaluation draw from different streams, so no evaluated episode was ever trained on.

use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{RngCore, SeedableRng};

use crate::stage::Stage;

/// What a stream of draws is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Starts and targets of training episodes.
    Training,
    /// Starts and targets of the evaluation that confirms a stage while it trains.
    Confirmation,
    /// Starts and targets of `cargo xtask eval`.
    Evaluation,
}

/// A stream of draws.
#[derive(Clone, Debug)]
pub struct Stream(Xoshiro256PlusPlus);

impl Stream {
    /// The stream of one episode.
    #[must_use]
    pub fn of_episode(seed: u64, purpose: Purpose, stage: Stage, episode: u64) -> Self {
        let salt = [seed, purpose as u64, stage as u64, episode];
        Self(Xoshiro256PlusPlus::seed_from_u64(salt.into_iter().fold(0, |state, word| mix(state ^ word))))
    }

    /// Uniform in [`low`, `high`).
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        let unit = (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        low + unit * (high - low)
    }
}

/// Finaliser of SplitMix64 (Steele, Lea and Flood, 2014): every input bit reaches every output bit.
pub(crate) fn mix(word: u64) -> u64 {
    let word = word.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    word ^ (word >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn first(seed: u64, purpose: Purpose, stage: Stage, episode: u64) -> f64 {
        Stream::of_episode(seed, purpose, stage, episode).uniform(0.0, 1.0)
    }

    #[test]
    fn streams_differ_in_every_argument_and_repeat() {
        let base = first(0, Purpose::Training, Stage::Purple, 0);
        assert_eq!(base, first(0, Purpose::Training, Stage::Purple, 0));
        for other in [
            first(1, Purpose::Training, Stage::Purple, 0),
            first(0, Purpose::Evaluation, Stage::Purple, 0),
            first(0, Purpose::Confirmation, Stage::Purple, 0),
            first(0, Purpose::Training, Stage::Yellow, 0),
            first(0, Purpose::Training, Stage::Purple, 1),
        ] {
            assert_ne!(base, other);
        }
    }

    #[test]
    fn draws_fill_their_interval() {
        let mut stream = Stream::of_episode(7, Purpose::Training, Stage::Orange, 3);
        let draws: Vec<f64> = (0..4000).map(|_| stream.uniform(-1.0, 3.0)).collect();
        assert!(draws.iter().all(|d| (-1.0..3.0).contains(d)));
        let mean = draws.iter().sum::<f64>() / 4000.0;
        assert!((mean - 1.0).abs() < 0.1, "mean {mean}");
    }
}
