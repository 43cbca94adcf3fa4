//! The samples of [`Timing::Fastest`] against the closed form: inside it, and nearly as wide.

use jbtg::strategies::{decades, planners};
use jbtg::{Direction, Interval, Limits, LimitsSpec, Planner, PlannerSpec, Shape, Timing};
use proptest::prelude::*;
use safezone::{RangeStatus, SafeZone, Samples, Side};

use crate::adversary::{Noise, safe_state, worst_excess};
use crate::telescope;
use crate::tolerance;

/// Checks that the sampled range lies in the closed form's and returns the larger share of Δ that an end lacks.
fn share_given_away(
    (closed, sampled): (&SafeZone<'_>, &SafeZone<'_>),
    (position, velocity): (f64, f64),
) -> Result<f64, TestCaseError> {
    let planner = closed.planner();
    let (exact, found) = (closed.range(position, velocity), sampled.range(position, velocity));
    let at = format!("from ({position:e}, {velocity:e}): {found:?} for {exact:?}");
    prop_assert!(found.min <= found.max && found.contains(found.brake), "{at}");
    prop_assert!(found.contains(exact.brake) && found.brake == exact.brake, "{at}");
    prop_assert_eq!(found.status, exact.status, "{}", at);
    // Where a turning point just fits before one limit, the end on the other side jumps: there the exact one counts that is a
    // fiftieth of a braking step's way nearer to that limit.
    let aside = 0.02 * planner.period() * planner.authority(Direction::Decreasing).velocity_change;
    let [nearer_below, nearer_above] =
        [position - aside, position + aside].map(|position| closed.range(position, velocity));
    let mut worst = 0.0_f64;
    for (lacking, jump, side, direction) in [
        (exact.max - found.max, exact.max - nearer_below.max, Side::Upper, Direction::Decreasing),
        (found.min - exact.min, nearer_above.min - exact.min, Side::Lower, Direction::Increasing),
    ] {
        let authority = planner.authority(direction);
        let step = authority.velocity_change;
        // What the closed form's own residual makes of a velocity.
        let overshoot = authority.reverse_travel * step;
        let rounding = (closed.guard(side) - 2.0 * overshoot).max(0.0) / planner.period();
        prop_assert!(lacking >= -200.0 * rounding - 1e-12 * step, "{side:?} {at}: {lacking:e} beyond");
        worst = worst.max((lacking - jump.max(0.0) - 200.0 * rounding) / step);
    }
    Ok(worst)
}

fn shares() -> impl Strategy<Value = f64> {
    prop_oneof![2 => Just(0.0), 2 => Just(1.0), 2 => 0.0..=1.0, 1 => decades(-9.0, 0.0), 1 => decades(-9.0, 0.0).prop_map(|share| 1.0 - share)]
}

proptest! {
    #![proptest_config(ProptestConfig { max_global_rejects: u32::MAX, ..ProptestConfig::with_cases(1000) })]

    #[test]
    fn a_sampled_range_lies_in_the_closed_form_s_and_is_nearly_as_wide(
        planner in planners(),
        starts in prop::collection::vec((shares(), shares()), 20),
    ) {
        let mut samples = Samples::default();
        let Ok(closed) = SafeZone::closed_form(planner) else { return Ok(()) };
        let sampled = SafeZone::sampled(planner, &mut samples).expect("as much room");
        for start in starts {
            let share = share_given_away((&closed, &sampled), safe_state(&closed, start))?;
            prop_assert!(share <= tolerance::SAMPLES, "{share} of a braking step from {start:?}");
        }
    }
}

/// The largest share of Δ that an end lacks, over states up to all of the speed that stops in time.
fn most_given_away(planner: Planner) -> f64 {
    let mut samples = Samples::default();
    let closed = SafeZone::closed_form(planner).expect("a joint with room to move");
    let sampled = SafeZone::sampled(planner, &mut samples).expect("a joint with room to move");
    let mut worst = 0.0_f64;
    for i in 0..=500 {
        for j in 0..=300 {
            let start = (f64::from(i) / 500.0, 1.0 - 0.3 * f64::from(j) / 300.0);
            let share = share_given_away((&closed, &sampled), safe_state(&closed, start))
                .expect("a range within the closed form's");
            worst = worst.max(share);
        }
    }
    worst
}

#[test]
fn samples_of_equal_ramps_give_away_little_and_stretched_steps_have_none() {
    for (shape, timing) in telescope::ALL {
        let worst = most_given_away(telescope::planner(shape, timing));
        let expected = match timing {
            Timing::Stretched => 0.0..=0.0,
            Timing::Fastest => 1e-4..=tolerance::SAMPLES_OF_EQUAL_RAMPS,
        };
        assert!(expected.contains(&worst), "{shape:?}: {worst} of a braking step");
    }
}

/// One direction three to four times as strong as the other, so that the samples of its steps are as many knots apart.
#[test]
fn samples_some_knots_apart_give_away_little_too() {
    for (shape, acceleration) in [Shape::Smoothstep, Shape::SineQuintic]
        .into_iter()
        .flat_map(|shape| [(-1.0, 0.3), (-0.3, 1.0)].map(|(min, max)| (shape, Interval::new(min, max))))
    {
        let spec = *telescope::planner(shape, Timing::Fastest).spec();
        let limits = LimitsSpec { acceleration, ..spec.limits.into() };
        let limits = Limits::try_from(limits).unwrap();
        let worst = most_given_away(Planner::try_from(PlannerSpec { limits, ..spec }).unwrap());
        assert!(worst <= tolerance::SAMPLES_SOME_KNOTS_APART, "{shape:?}: {worst} of a braking step");
    }
}

/// From every velocity on knots and between them, moving away faster than one period can undo and ten braking steps fast, at
/// distances from the limit from a millionth of the interval on: nearly what the closed form leaves, and the more the farther.
#[test]
fn samples_near_a_limit_give_away_little_from_every_velocity() {
    for (shape, acceleration, most) in [Shape::Smoothstep, Shape::SineQuintic].into_iter().flat_map(|shape| {
        [
            ((-1.0, 1.0), tolerance::SAMPLES_OF_EQUAL_RAMPS),
            ((-1.0, 0.3), tolerance::SAMPLES_SOME_KNOTS_APART),
            ((-0.3, 1.0), tolerance::SAMPLES_SOME_KNOTS_APART),
            ((-0.1, 1.0), tolerance::SAMPLES),
        ]
        .map(|((min, max), most)| (shape, Interval::new(min, max), most))
    }) {
        let spec = *telescope::planner(shape, Timing::Fastest).spec();
        let limits = LimitsSpec { acceleration, ..spec.limits.into() };
        let limits = Limits::try_from(limits).unwrap();
        let planner = Planner::try_from(PlannerSpec { limits, ..spec }).unwrap();
        let mut samples = Samples::default();
        let closed = SafeZone::closed_form(planner).unwrap();
        let sampled = SafeZone::sampled(planner, &mut samples).unwrap();
        let step = planner.authority(Direction::Decreasing).velocity_change;
        let position = planner.limits().position();
        for velocity in
            (-80..=180).flat_map(|knot| [0.0, 0.4].map(|share| (f64::from(knot) + share) / 16.0 * step))
        {
            if !planner.velocity().contains(velocity) {
                continue;
            }
            let end = position.max - closed.guard(Side::Upper) - closed.stopping_distance(velocity.max(0.0));
            let mut narrower = f64::NEG_INFINITY;
            for tenths in (0..=50).rev() {
                let start = (end - position.width() * 10_f64.powf(-1.0 - 0.1 * f64::from(tenths)), velocity);
                let share = share_given_away((&closed, &sampled), start).unwrap();
                assert!(share <= most, "{share} of a braking step from {start:?}");
                let range = sampled.range(start.0, start.1);
                assert!(range.max >= narrower - 1e-9 * step, "{range:?} from {start:?} after {narrower}");
                narrower = range.max;
            }
        }
    }
}

/// Intervals of a tenth to a hundred-millionth of what a braking step covers, where a velocity's rounding is much of the room.
#[test]
fn samples_keep_the_limits_of_tiny_intervals() {
    let unit = telescope::planner(Shape::Smoothstep, Timing::Fastest);
    let way = unit.period() * unit.authority(Direction::Decreasing).velocity_change;
    for exponent in 1..=8 {
        let position = Interval::new(0.0, way * 10_f64.powi(-exponent));
        let limits = Limits::try_from(LimitsSpec { position, ..unit.spec().limits.into() }).unwrap();
        let planner = Planner::try_from(PlannerSpec { limits, ..*unit.spec() }).unwrap();
        let mut samples = Samples::default();
        let zone = SafeZone::sampled(planner, &mut samples).unwrap();
        let (mut noise, mut action) = (Noise(7), 1.0);
        let (mut position, mut velocity) = (0.5 * position.max, 0.0);
        for _ in 0..2000 {
            if noise.unit() < 0.1 {
                action = -action;
            }
            let command = zone.command(position, velocity, action);
            assert_eq!(command.range.status, RangeStatus::Safe, "{exponent}: {position:e}, {velocity:e}");
            let step = planner.ramp(position, velocity, command.velocity).unwrap();
            let excess = worst_excess(&step.extrema(), &limits);
            assert!(excess <= tolerance::LIMIT, "{exponent}: {excess:e} from {position:e}, {velocity:e}");
            (position, velocity) = (step.end().position, step.end().velocity);
        }
    }
}
