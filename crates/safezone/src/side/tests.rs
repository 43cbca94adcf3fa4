use jbtg::Planner;
use jbtg::strategies::planners;
use proptest::prelude::*;

use super::{Braking, Side};

/// Largest error of a difference quotient over 2e-4 Δ, as a share of the period.
const QUOTIENT: f64 = 1e-3;

/// Everything of `planner`'s two limits.
fn both(planner: &Planner) -> [Braking; 2] {
    [Side::Upper, Side::Lower].map(|side| Braking::new(planner, side))
}

proptest! {
    #![proptest_config(ProptestConfig { max_global_rejects: u32::MAX, ..ProptestConfig::with_cases(500) })]

    #[test]
    fn slopes_are_what_distance_and_displacement_rise_by(
        planner in planners(),
        (velocity, change) in (0.0..=1.0, -1.0..=1.0),
    ) {
        for braking in both(&planner) {
            let h = 1e-4 * braking.step;
            let near = |a: f64, b: f64| (a - b).abs() <= 100.0 * h;
            // Where the difference is not lost in rounding.
            let velocity = velocity * braking.velocity.min(1e5 * braking.step);
            let rest = velocity % braking.step;
            let is_smooth = ![0.0, braking.brake.ramps_only, braking.step].iter().any(|kink| near(rest, *kink));
            if is_smooth {
                let rise = braking.distance(velocity + h) - braking.distance(velocity - h);
                let error = braking.distance_slope(velocity) - rise / (2.0 * h);
                prop_assert!(error.abs() <= QUOTIENT * rise / (2.0 * h), "{error:e}");
            }
            prop_assert_eq!(braking.distance_slope(-velocity), 0.0);
            let change = change * braking.step;
            let kink = if change > 0.0 { braking.climb.ramps_only } else { braking.brake.ramps_only };
            if !near(change, 0.0) && !near(change.abs(), kink) {
                let end = velocity + change;
                let rise = braking.displacement(velocity, end + h) - braking.displacement(velocity, end - h);
                let error = braking.displacement_slope(velocity, end) - rise / (2.0 * h);
                prop_assert!(error.abs() <= QUOTIENT * braking.period, "{error:e}");
            }
        }
    }

    #[test]
    fn the_steps_within_what_a_knot_needs_are_the_knot_s(planner in planners(), n in 1_u32..1000) {
        for braking in both(&planner) {
            for line in [&braking.upwards, &braking.downwards] {
                let (_, sum, _) = braking.knot(line, f64::from(n));
                let found = braking.steps_within(line, sum);
                prop_assert!((found - f64::from(n)).abs() <= 1e-9, "{found} for {n}");
            }
        }
    }

    /// Braking over a way that takes n periods may round n positions.
    #[test]
    fn rounding_counts_the_periods_of_the_way(planner in planners(), n in 1_u32..1000, far in 1.0..1e6) {
        for braking in both(&planner) {
            let velocity = f64::from(n) * braking.step;
            let largest = planner.limits().position().max.abs().max(planner.limits().position().min.abs());
            let size = far * largest.max(braking.width);
            let ulps = braking.rounding_over(braking.distance(velocity), size) / (f64::EPSILON * size);
            prop_assert!((ulps - 16.0 - f64::from(n)).abs() < 0.6, "{ulps} for {n} periods");
        }
    }

    /// Far is where a period at the largest velocity and a stop from it fit in front of what is kept free.
    #[test]
    fn far_is_where_any_step_and_a_stop_fit(planner in planners()) {
        for braking in both(&planner) {
            let way = braking.velocity * braking.period + braking.distance(braking.velocity);
            let kept = braking.limit - braking.guard;
            let margin = 1e-9 * way + 4.0 * f64::EPSILON * (kept.abs() + way);
            prop_assert!(braking.is_far(kept - way - margin) && !braking.is_far(kept - way + margin));
        }
    }

    /// The lift of a table's knots is what the distance bulges over a chord: with it the chord touches, at the kink.
    #[test]
    fn a_chord_lifted_by_the_kink_s_depth_touches_the_distance(planner in planners()) {
        for braking in both(&planner).into_iter().filter(|braking| !braking.stretched) {
            let spacing = braking.step / 16.0;
            let (kink, lift) = (braking.brake.ramps_only, braking.kink_depth(spacing));
            let low = (kink / spacing).floor() * spacing;
            let share = (kink - low) / spacing;
            let chord = (1.0 - share) * braking.distance(low) + share * braking.distance(low + spacing);
            let above = chord + lift - braking.distance(kink);
            let rounding = 8.0 * f64::EPSILON * braking.distance(braking.step);
            prop_assert!(above >= -rounding && (lift == 0.0 || above <= rounding), "{above:e}");
        }
    }
}
