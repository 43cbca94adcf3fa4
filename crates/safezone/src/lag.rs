//! How far a step stays behind motion at its end velocity.

use jbtg::{Direction, Planner, Timing};

use crate::math::{larger, sqrt};

/// Least duration of a ramp as a share of the largest step's, as `jbtg` keeps it.
const MIN_RAMP_SHARE: f64 = 1e-6;

/// Lag of the steps of one direction, as a function of the velocity change c ≥ 0: a step from v₁ to v₂ = v₁ ± c
/// covers T·v₂ ∓ lag(c).
///
/// With [`Timing::Stretched`] the lag is proportional to c. With [`Timing::Fastest`] it grows as c^1.5 up to the
/// largest step without a cruise ([P, Alg. 2]) and quadratically from there on ([P, Alg. 1]); the former is the
/// latter without a quadratic term and with ramps alone for no change but 0. An addition of its own, so that a range needs
/// neither a pulse nor a trajectory.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lag {
    /// Largest change without a cruise; 0 for a stretched step [rad/s or m/s].
    pub(crate) ramps_only: f64,
    per_ramps_only: f64,
    /// Lag per change at `ramps_only` \[s\].
    pub(crate) mean_of_ramps: f64,
    /// Lag at `ramps_only` [rad or m].
    base: f64,
    /// Slope of the lag right above `ramps_only` \[s\].
    slope: f64,
    /// Half the slope's growth from there on [s² per rad or m].
    half_growth: f64,
    /// Lag per change of the largest step, and of every stretched one \[s\].
    pub(crate) mean: f64,
}

impl Lag {
    pub(crate) fn new(planner: &Planner, direction: Direction) -> Self {
        let authority = planner.authority(direction);
        // A step that ends at rest covers its lag.
        let at = |change: f64| match direction {
            Direction::Increasing => -planner.displacement(-change, 0.0),
            Direction::Decreasing => planner.displacement(change, 0.0),
        };
        let mean = at(authority.velocity_change) / authority.velocity_change;
        match planner.spec().timing {
            Timing::Stretched => Self {
                ramps_only: 0.0,
                per_ramps_only: 0.0,
                mean_of_ramps: 0.0,
                base: 0.0,
                slope: mean,
                half_growth: 0.0,
                mean,
            },
            Timing::Fastest => {
                let (ramps_only, up, down) = (authority.ramps_only, authority.ramp_up, authority.ramp_down);
                let base = at(ramps_only);
                Self {
                    ramps_only,
                    per_ramps_only: 1.0 / ramps_only,
                    mean_of_ramps: base / ramps_only,
                    base,
                    slope: up + 0.5 * down,
                    half_growth: 0.25 * (up + down) / ramps_only, // 1/(2A)
                    mean,
                }
            }
        }
    }

    /// The lag [rad or m].
    #[inline]
    pub(crate) fn at(&self, change: f64) -> f64 {
        if change < self.ramps_only {
            change * self.mean_of_ramps * self.ramp_share(change)
        } else {
            let beyond = change - self.ramps_only;
            self.base + beyond * (self.slope + beyond * self.half_growth)
        }
    }

    /// Its derivative \[s\].
    #[inline]
    pub(crate) fn slope_at(&self, change: f64) -> f64 {
        if change < self.ramps_only {
            1.5 * self.mean_of_ramps * self.ramp_share(change)
        } else {
            self.slope + 2.0 * self.half_growth * (change - self.ramps_only)
        }
    }

    /// How far chords over changes `spacing` apart lie above the lag at most [rad or m].
    ///
    /// What two terms whose curvatures bound the lag's add: the power's, which is largest over the first chord, and the
    /// quadratic one's. Where the lag's slope falls its chord is lower.
    pub(crate) fn sag(&self, spacing: f64) -> f64 {
        let power = spacing * self.mean_of_ramps * sqrt(spacing * self.per_ramps_only);
        4.0 / 27.0 * power + 0.25 * self.half_growth * (spacing * spacing)
    }

    /// By how much the slope falls where steps begin to have a cruise \[s\].
    pub(crate) fn kink(&self) -> f64 {
        larger(1.5 * self.mean_of_ramps - self.slope, 0.0)
    }

    #[inline]
    fn ramp_share(&self, change: f64) -> f64 {
        larger(sqrt(change * self.per_ramps_only), MIN_RAMP_SHARE)
    }
}

#[cfg(test)]
mod tests {
    use jbtg::Direction;
    use jbtg::strategies::planners;
    use proptest::prelude::*;

    use super::Lag;

    proptest! {
        #![proptest_config(ProptestConfig { max_global_rejects: u32::MAX, ..ProptestConfig::with_cases(1000) })]

        #[test]
        fn the_lag_is_what_the_planners_displacement_lacks(planner in planners(), share in 1e-3..=1.0, exponent in -14.0..0.0) {
            for direction in [Direction::Increasing, Direction::Decreasing] {
                let lag = Lag::new(&planner, direction);
                prop_assert_eq!(lag.at(0.0), 0.0);
                let largest = planner.authority(direction).velocity_change;
                for change in [share * largest, largest * 10_f64.powf(exponent), lag.ramps_only, largest] {
                    let expected = match direction {
                        Direction::Increasing => -planner.displacement(-change, 0.0),
                        Direction::Decreasing => planner.displacement(change, 0.0),
                    };
                    let error = (lag.at(change) - expected).abs();
                    prop_assert!(error <= 1e-14 * expected, "{change:e}: {:e} for {expected:e}", lag.at(change));
                    let (near, far) = (lag.at(change * (1.0 - 1e-6)), lag.at(change * (1.0 + 1e-6)));
                    let slope = (far - near) / (2e-6 * change);
                    // Not where the slope jumps, nor where ramps no longer shrink.
                    if (change - lag.ramps_only).abs() > 1e-5 * change && change > 1e-11 * lag.ramps_only {
                        let error = (lag.slope_at(change) - slope).abs();
                        prop_assert!(error <= 1e-4 * slope.max(planner.period() * 1e-3), "{change:e}: {slope:e}");
                    }
                }
            }
        }
    }
}
