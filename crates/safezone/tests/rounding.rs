//! The rounding analysis of `docs/guarantee.md`, § Rounding, against what the code does.

use jbtg::strategies::planners;
use jbtg::{Planner, Shape};
use proptest::prelude::*;
use safezone::{SafeZone, Side};

use crate::adversary::{Noise, safe_state};

/// Roundings of one range that the guard has room for, in ulps of the position range; N more are for a manoeuvre.
const ULPS_OF_ONE_RANGE: f64 = 16.0;

/// The largest position in question, and the most periods that braking within the interval takes.
fn scale_and_periods(planner: &Planner) -> (f64, f64) {
    let limits = planner.limits().position();
    let scale = limits.min.abs().max(limits.max.abs()).max(limits.width());
    let step = planner.authority(jbtg::Direction::Decreasing).velocity_change;
    let periods =
        (planner.velocity().max / step).min((2.0 * limits.width() / (step * planner.period())).sqrt());
    (scale, periods)
}

proptest! {
    #![proptest_config(ProptestConfig { max_global_rejects: u32::MAX, ..ProptestConfig::with_cases(500) })]

    #[test]
    fn the_guard_is_n_and_sixteen_ulps_and_twice_the_overshoot(planner in planners()) {
        let Ok(zone) = SafeZone::closed_form(planner) else { return Ok(()) };
        let (scale, periods) = scale_and_periods(&planner);
        let authority = planner.authority(jbtg::Direction::Decreasing);
        let overshoot = 2.0 * authority.reverse_travel * authority.velocity_change;
        let expected = (periods + ULPS_OF_ONE_RANGE) * f64::EPSILON * scale + overshoot;
        prop_assert!((zone.guard(Side::Upper) - expected).abs() <= 1e-14 * expected);
        prop_assert_eq!(planner.spec().shape == Shape::Smoothstep, overshoot == 0.0);
    }

    /// From a start that keeps the guard, pushing for ever uses up no more than the guard: no limit is exceeded at all.
    #[test]
    fn a_run_uses_up_no_more_than_its_guard(planner in planners(), velocity in 0.5..=1.0, seed in any::<u64>()) {
        let Ok(zone) = SafeZone::closed_form(planner) else { return Ok(()) };
        let limits = planner.limits().position();
        let (mut position, mut velocity) = safe_state(&zone, (velocity, 0.9));
        position = (position - zone.guard(Side::Upper)).max(limits.min + zone.guard(Side::Lower));
        let mut noise = Noise(seed);
        for _ in 0..200 {
            let action = if noise.unit() < 0.1 { -1.0 } else { 1.0 };
            let command = zone.command(position, velocity, action);
            let step = planner.ramp(position, velocity, command.velocity)?;
            let found = step.extrema().position;
            prop_assert!(found.max <= limits.max, "{:e} m beyond", found.max - limits.max);
            (position, velocity) = (step.end().position, step.end().velocity);
        }
    }

    /// One range: its upper end leaves the guard but for a few ulps, as the planner's own displacement has it.
    #[test]
    fn one_range_contributes_a_few_ulps(planner in planners(), start in (0.5..=1.0, 0.5..=1.0)) {
        let Ok(zone) = SafeZone::closed_form(planner) else { return Ok(()) };
        let (position, velocity) = safe_state(&zone, start);
        let range = zone.range(position, velocity);
        prop_assume!(range.max > range.brake);
        let travel = planner.displacement(velocity, range.max) + zone.stopping_distance(range.max.max(0.0));
        let excess = travel - (planner.limits().position().max - zone.guard(Side::Upper) - position);
        let (scale, periods) = scale_and_periods(&planner);
        // Fourteen roundings, and the eighth of the guard within which a solution by iteration stops.
        let allowed = 7.0 + 0.125 * (periods + ULPS_OF_ONE_RANGE);
        prop_assert!(excess <= allowed * f64::EPSILON * scale, "{} ulps", excess / (f64::EPSILON * scale));
    }
}
