//! FNV-1a, 64 bit, over the canonical bits of a braking table.

use jbtg::{Interval, PlannerSpec, Shape, Timing};

use crate::table::{Knot, SCHEMA};

/// Running FNV-1a hash.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hash(u64);

impl Hash {
    const fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn word(mut self, word: u64) -> Self {
        for byte in word.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
        self
    }

    fn number(self, number: f64) -> Self {
        self.word(number.to_bits())
    }

    fn interval(self, interval: Interval) -> Self {
        self.number(interval.min).number(interval.max)
    }

    fn knots(self, knots: &[Knot]) -> Self {
        let start = self.word(knots.len() as u64);
        knots.iter().fold(start, |hash, knot| hash.number(knot.distance).number(knot.velocity))
    }
}

/// Hash of everything a table was built from and everything it holds.
pub(crate) fn table_hash(spec: &PlannerSpec, subdivisions: u32, upper: &[Knot], lower: &[Knot]) -> u64 {
    let shape = match spec.shape {
        Shape::Smoothstep => 0,
        Shape::SineQuintic => 1,
    };
    let timing = match spec.timing {
        Timing::Stretched => 0,
        Timing::Fastest => 1,
    };
    Hash::new()
        .word(u64::from(SCHEMA))
        .interval(spec.limits.position())
        .interval(spec.limits.velocity())
        .interval(spec.limits.acceleration())
        .interval(spec.limits.jerk())
        .word(shape)
        .word(timing)
        .number(spec.period)
        .word(u64::from(subdivisions))
        .knots(upper)
        .knots(lower)
        .0
}

#[cfg(test)]
mod tests {
    use super::Hash;

    #[test]
    fn eight_zero_bytes_hash_to_the_published_algorithm() {
        let mut expected: u64 = 0xcbf2_9ce4_8422_2325;
        for _ in 0..8 {
            expected = expected.wrapping_mul(0x0000_0100_0000_01b3);
        }
        assert_eq!(Hash::new().word(0).0, expected);
    }
}
