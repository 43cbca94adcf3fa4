use jbtg::Planner;
use jbtg::strategies::planners;
use proptest::prelude::*;

use super::{Braking, Side};
use crate::math::larger;

/// Largest error of a difference quotient over 2e-4 Δ, as a share of the period.
const QUOTIENT: f64 = 1e-3;

/// The largest velocities towards them.
fn highest(planner: &Planner) -> [f64; 2] {
    [planner.velocity().max, -planner.velocity().min]
}

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
        for (braking, highest) in both(&planner).into_iter().zip(highest(&planner)) {
            let h = 1e-4 * braking.step;
            let near = |a: f64, b: f64| (a - b).abs() <= 100.0 * h;
            // Where the difference is not lost in rounding.
            let velocity = velocity * highest.min(1e5 * braking.step);
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

    /// A limit is far where a period at the largest velocity and a stop from it fit in front of what is kept free, and is free
    /// of a start where its largest step up and a stop fit; nowhere else, and everywhere but for what the parabola gives away.
    #[test]
    fn far_and_free_is_where_any_step_and_a_stop_fit(planner in planners(), velocity in -1.5..=1.0) {
        for (braking, highest) in both(&planner).into_iter().zip(highest(&planner)) {
            let given_away = braking.overshoot + braking.chord_depth(braking.step / 16.0)
                + 0.125 * braking.step * braking.period
                + if braking.stretched { 0.0 } else { 0.25 * braking.brake.at(braking.step) };
            let velocity = velocity * highest;
            let end = velocity + braking.largest_climb;
            let far = highest * braking.period + braking.distance(highest);
            let free = larger(braking.displacement(velocity, end) + braking.distance(end), 0.0).min(far);
            let margin = 1e-9 * far + 4.0 * f64::EPSILON * (braking.kept.abs() + far);
            for (way, is_clear) in [
                (far, &(|position| braking.is_far(position)) as &dyn Fn(f64) -> bool),
                (free, &|position| braking.is_free(position, velocity)),
            ] {
                prop_assert!(!is_clear(braking.kept - way + margin));
                prop_assert!(is_clear(braking.kept - way - given_away - margin));
            }
        }
    }

    /// Of the chords of the distance's chords, wherever they begin, lifted by the depth of a chord.
    #[test]
    fn a_chord_of_chords_lifted_by_a_chord_s_depth_is_above_the_distance(
        planner in planners(),
        (steps, share) in (0_u32..4, prop_oneof![Just(0.0), Just(1.0), 0.0..=1.0]),
        anywhere in 0.0..=1.0,
    ) {
        for braking in both(&planner).into_iter().filter(|braking| !braking.stretched) {
            let spacing = braking.step / 16.0;
            let lift = braking.chord_depth(spacing);
            let knot = |index: f64| if index > 0.0 { braking.distance(index * spacing) + lift } else { 0.0 };
            let between = |velocity: f64| {
                let (low, share) = ((velocity / spacing).floor(), (velocity / spacing).rem_euclid(1.0));
                (1.0 - share) * knot(low) + share * knot(low + 1.0)
            };
            for within in [0.0, braking.brake.ramps_only, anywhere * braking.step] {
                let velocity = f64::from(steps) * braking.step + within;
                let low = velocity - share * spacing;
                let chord = (1.0 - share) * between(low) + share * between(low + spacing);
                let rounding = 16.0 * f64::EPSILON * (braking.distance(velocity) + spacing * braking.period);
                let above = chord - braking.distance(velocity);
                prop_assert!(above >= -rounding, "{above:e} at {velocity:e}");
            }
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
