//! Where steps of [`Timing::Fastest`](jbtg::Timing) that change their direction turn, from samples.

use crate::math::{floor, larger, smaller, sqrt};
use crate::side::Braking;

/// Parts that the samples divide their interval into.
const PARTS: usize = 32;

/// Of steps without a cruise from a velocity v > 0, the largest that turns within a given travel.
///
/// With c its change and w the square of what braking to zero covers per that travel, v/c depends on w alone (Lemma 4 in
/// `docs/guarantee.md`) and is close to a multiple of w³. So its cube root is sampled, from above.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turns {
    /// Cube roots of v/c where w is a multiple of 1/32, the last one twice.
    roots: [f64; PARTS + 2],
    /// Lag per change of the largest step without a cruise \[s\].
    mean_lag: f64,
    /// 32 per that change [1 per rad/s or m/s].
    parts_per_change: f64,
}

impl Turns {
    /// The samples for steps away from `braking`'s limit.
    pub(crate) fn new(braking: &Braking) -> Self {
        let change = braking.brake.ramps_only;
        let mean_lag = braking.brake.at(change) / change;
        let turning = &braking.turning;
        // What braking covers, in the unit of `Turning::change`.
        let braked = mean_lag / sqrt(change * turning.rising_per_acceleration);
        let root = |part: f64| cube_root(1.0 / turning.change(braked * sqrt(PARTS as f64 / part)));
        let mut exact = [0.0; PARTS + 2];
        for (part, exact) in exact[..=PARTS].iter_mut().enumerate().skip(1) {
            *exact = root(part as f64);
        }
        // Where the roots are concave, as those of the sine's reversal are, both ends of a chord are lifted above them.
        exact[PARTS + 1] = exact[PARTS];
        let mut roots = exact;
        for part in 1..PARTS {
            let chord = 0.5 * (exact[part] + exact[part + 1]);
            let rise = larger(1.25 * (root(part as f64 + 0.5) - chord), 0.0);
            roots[part] = larger(roots[part], exact[part] + rise);
            roots[part + 1] = exact[part + 1] + rise;
        }
        if root(0.5) > 0.5 * exact[1] {
            roots[0] = roots[1];
        }
        Self {
            roots: roots.map(|root| smaller(root, 1.0)),
            mean_lag,
            parts_per_change: PARTS as f64 / change,
        }
    }

    /// Its change, at least `velocity` > 0, if it turns within `travel` or no later than braking.
    #[inline]
    pub(crate) fn change(&self, velocity: f64, travel: f64) -> f64 {
        let share = velocity * self.mean_lag / larger(travel, 0.0);
        let parts = smaller(share * share * (velocity * self.parts_per_change), PARTS as f64);
        let (whole, index) = floor(parts);
        let Some(&[low, high]) = self.roots.get(index as usize..).and_then(|roots| roots.first_chunk())
        else {
            return velocity; // Parts are not less than none.
        };
        let root = low + (parts - whole) * (high - low);
        velocity / (root * root * root)
    }
}

/// The cube root of a number in (0, 1], by Newton steps.
fn cube_root(number: f64) -> f64 {
    let mut root = 1.0;
    for _ in 0..60 {
        root -= (root - number / (root * root)) / 3.0;
    }
    root
}

#[cfg(test)]
mod tests {
    use jbtg::Timing;
    use jbtg::strategies::planners;
    use proptest::prelude::*;

    use super::Turns;
    use crate::side::{Braking, Side};

    proptest! {
        #![proptest_config(ProptestConfig { max_global_rejects: u32::MAX, ..ProptestConfig::with_cases(1000) })]

        #[test]
        fn a_sampled_change_is_at_most_the_exact_one_and_little_less(planner in planners(), exponent in -6.0..0.0) {
            if planner.spec().timing == Timing::Stretched {
                return Ok(());
            }
            let braking = Braking::new(&planner, Side::Upper);
            let turns = Turns::new(&braking);
            let velocity = 10_f64.powf(exponent) * braking.brake.ramps_only;
            let scale = velocity * (velocity * braking.turning.rising_per_acceleration).sqrt();
            let braked = braking.brake.at(velocity);
            prop_assert!(turns.change(velocity, 0.0) >= velocity);
            for part in 1..=2000 {
                let travel = braked / (f64::from(part) / 2000.0).sqrt();
                let exact = velocity * braking.turning.change(travel / scale);
                let found = turns.change(velocity, travel);
                prop_assert!(found >= velocity && found <= exact * (1.0 + 1e-12), "{part}: {found:e} for {exact:e}");
                if part >= 64 {
                    prop_assert!(found >= 0.95 * exact, "{part}: {found:e} for {exact:e}");
                }
            }
        }
    }
}
