//! [P, Alg. 3] for every planner: what holds for every detour, and that every case of it occurs.

use std::collections::BTreeMap;

use jbtg::strategies::planners;
use jbtg::{
    Detour, DetourCase, Direction, Interval, Limits, LimitsSpec, Planner, PlannerSpec, PulseKind, RampError,
    Shape, State, Trajectory,
};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

use crate::properties::{cases, check_joints, check_within, shares, within};
use crate::support::paper_spec;
use crate::tolerance;

const DIRECTIONS: [Direction; 2] = [Direction::Increasing, Direction::Decreasing];

type Way = fn(&Planner, f64, f64, f64, Direction) -> Result<Trajectory, RampError>;

/// Both kinds of detour in both directions.
fn ways() -> impl Iterator<Item = (Direction, Way)> {
    let ways: [Way; 2] = [Planner::waypoint_towards, Planner::farthest];
    DIRECTIONS.into_iter().flat_map(move |direction| ways.map(|way| (direction, way)))
}

/// A waypoint problem as shares of what the planner allows: position, v₁ and v₂, the last often equal to v₁, at a
/// velocity limit or barely reachable.
fn problems() -> impl Strategy<Value = (f64, f64, f64, bool)> {
    (shares(), shares(), shares(), prop::bool::weighted(0.2))
}

fn pick(planner: &Planner, (position, v1, v2, equal): (f64, f64, f64, bool)) -> (f64, f64, f64) {
    let v1 = within(planner.velocity(), v1);
    let v2 = if equal { v1 } else { within(planner.reachable(v1), v2) };
    (within(planner.limits().position(), position), v1, v2)
}

fn mirrored(planner: &Planner) -> Planner {
    let limits = planner.limits();
    let limits = Limits::try_from(LimitsSpec {
        position: limits.position().mirrored(),
        velocity: limits.velocity().mirrored(),
        acceleration: limits.acceleration().mirrored(),
        jerk: limits.jerk().mirrored(),
    });
    Planner::try_from(PlannerSpec { limits: limits.expect("limits, mirrored"), ..*planner.spec() })
        .expect("a planner, mirrored")
}

fn opposite(direction: Direction) -> Direction {
    match direction {
        Direction::Increasing => Direction::Decreasing,
        Direction::Decreasing => Direction::Increasing,
    }
}

/// Least time for a velocity change `dv` from acceleration 0 to 0: no ramp shorter than its jerk bound allows.
fn least_time(planner: &Planner, dv: f64) -> f64 {
    let (acceleration, jerk) = (planner.limits().acceleration(), planner.limits().jerk());
    let limit = if dv > 0.0 { acceleration.max } else { -acceleration.min };
    let per_acceleration = 1.5 * (1.0 / jerk.max - 1.0 / jerk.min);
    let peak = f64::min(limit, (2.0 * dv.abs() / per_acceleration).sqrt());
    if peak > 0.0 { dv.abs() / peak + 0.5 * per_acceleration * peak } else { 0.0 }
}

#[track_caller]
fn check_limits(planner: &Planner, step: &Trajectory) -> Result<(), TestCaseError> {
    let extrema = step.extrema();
    check_within("velocity", extrema.velocity, planner.limits().velocity())?;
    check_within("acceleration", extrema.acceleration, planner.limits().acceleration())?;
    check_within("jerk", extrema.jerk, planner.limits().jerk())
}

proptest! {
    #![proptest_config(cases(20_000))]

    #[test]
    fn a_detour_keeps_every_limit_and_meets_its_end_in_exactly_one_period(planner in planners(), problem in problems()) {
        let (position, v1, v2) = pick(&planner, problem);
        for (direction, way) in ways() {
            let step = way(&planner, position, v1, v2, direction)?;
            check_limits(&planner, &step)?;
            prop_assert_eq!(step.end().velocity.to_bits(), (v2 + 0.0).to_bits());
            prop_assert_eq!((step.end().acceleration, step.end().jerk), (0.0, 0.0));
            prop_assert_eq!(step.duration(), planner.period());
            let start = State { position, velocity: v1, ..State::default() };
            check_joints(&step, start, planner.spec().shape)?;
        }
    }

    #[test]
    fn what_a_detour_says_is_what_it_does(planner in planners(), problem in problems()) {
        let (position, v1, v2) = pick(&planner, problem);
        for direction in DIRECTIONS {
            let detour = planner.detour(v1, v2, direction)?;
            let step = planner.waypoint_towards(position, v1, v2, direction)?;
            let pulse = |kind| match kind {
                None => 0,
                Some(PulseKind::Map) => 2,
                Some(PulseKind::Msap) => 3,
            };
            let cruise = usize::from(detour.cruise > 0.0);
            prop_assert_eq!(step.segments().len(), pulse(detour.rise) + cruise + pulse(detour.fall), "{:?}", detour);
            let velocities = step.extrema().velocity;
            let farthest = if direction == Direction::Increasing { velocities.max } else { velocities.min };
            let slack = tolerance::LIMIT * planner.limits().velocity().width();
            let slack = slack + planner.velocity().min - planner.limits().velocity().min; // what a sine's quintic overshoots
            prop_assert!((farthest - detour.peak).abs() <= slack + 3e-5 * (detour.peak - v1).abs().max((detour.peak - v2).abs()),
                "{:?}: {farthest:e}", detour);
        }
    }

    #[test]
    fn the_opposite_direction_is_the_mirror_image_bit_for_bit(planner in planners(), problem in problems()) {
        let (position, v1, v2) = pick(&planner, problem);
        let mirror = mirrored(&planner);
        for (direction, way) in ways() {
            let step = way(&planner, position, v1, v2, direction)?;
            let image = way(&mirror, -position, -v1, -v2, opposite(direction))?;
            prop_assert_eq!(step.segments().len(), image.segments().len());
            for (a, b) in step.segments().iter().zip(image.segments()) {
                prop_assert_eq!(a.coefficients(), b.coefficients().map(|c| -c));
                prop_assert_eq!((a.start(), a.duration()), (b.start(), b.duration()));
            }
            prop_assert_eq!(step.end().position, -image.end().position);
        }
    }

    #[test]
    fn no_higher_peak_leaves_time_for_the_end(planner in planners(), problem in problems(), excess in 1e-9..0.1) {
        prop_assume!(planner.spec().shape == jbtg::Shape::Smoothstep);
        let (_, v1, v2) = pick(&planner, problem);
        for direction in DIRECTIONS {
            let Detour { peak, cruise, .. } = planner.detour(v1, v2, direction)?;
            let sign = if direction == Direction::Increasing { 1.0 } else { -1.0 };
            let limits = planner.limits().velocity();
            let is_limit = peak == if sign > 0.0 { limits.max } else { limits.min };
            let beyond = peak + sign * excess * limits.width();
            let time = least_time(&planner, beyond - v1) + least_time(&planner, v2 - beyond);
            prop_assert!(is_limit || time > planner.period(), "{beyond:e} beyond {peak:e} takes {time:e} s");
            // The peak is rounded to what its magnitude allows, and the smallest changes take longest for what they are.
            let rounding = least_time(&planner, 8.0 * f64::EPSILON * peak.abs());
            prop_assert!(is_limit || cruise <= 1e-3 * planner.period() + rounding, "{cruise:e} s at {peak:e}");
        }
    }

    #[test]
    fn the_footnote_chooses_the_direction(planner in planners(), problem in problems()) {
        let (position, v1, v2) = pick(&planner, problem);
        let direction = if v2 >= 0.0 { Direction::Increasing } else { Direction::Decreasing };
        prop_assert_eq!(planner.waypoint(position, v1, v2)?, planner.waypoint_towards(position, v1, v2, direction)?);
    }

    #[test]
    fn the_farthest_detour_leads_at_least_as_far_as_the_direct_step_and_the_largest_peak(planner in planners(), problem in problems()) {
        let (_, v1, v2) = pick(&planner, problem);
        let direct = planner.displacement(v1, v2);
        let slack = 16.0 * f64::EPSILON * planner.period() * planner.limits().velocity().width();
        // A stretched step's own ramps may be up to ten times closer in length than a detour's.
        let slack = slack + if planner.spec().shape == jbtg::Shape::Smoothstep { 0.0 } else { 1e-5 * direct.abs() };
        let up = planner.farthest(0.0, v1, v2, Direction::Increasing)?.end().position;
        let down = planner.farthest(0.0, v1, v2, Direction::Decreasing)?.end().position;
        prop_assert!(down <= direct + slack && direct <= up + slack, "{down:e} {direct:e} {up:e}");
        let highest = planner.waypoint_towards(0.0, v1, v2, Direction::Increasing)?.end().position;
        let lowest = planner.waypoint_towards(0.0, v1, v2, Direction::Decreasing)?.end().position;
        prop_assert!(down <= lowest && highest <= up, "{down:e} {lowest:e} {highest:e} {up:e}");
        let jerk = planner.limits().jerk();
        prop_assert!((lowest == down || -jerk.min < jerk.max) && (highest == up || jerk.max < -jerk.min));
    }

    #[test]
    fn the_displacement_grows_with_the_velocity_limit(planner in planners(), problem in problems(), share in 0.3..1.0) {
        prop_assume!(planner.spec().shape == jbtg::Shape::Smoothstep);
        let limits = planner.limits();
        let less = LimitsSpec {
            position: limits.position(),
            velocity: Interval::new(limits.velocity().min, share * limits.velocity().max),
            acceleration: limits.acceleration(),
            jerk: limits.jerk(),
        };
        let narrow = Planner::try_from(PlannerSpec { limits: Limits::try_from(less)?, ..*planner.spec() })?;
        let (_, v1, v2) = pick(&narrow, problem);
        let near = narrow.farthest(0.0, v1, v2, Direction::Increasing)?.end().position;
        let far = planner.farthest(0.0, v1, v2, Direction::Increasing)?.end().position;
        let slack = tolerance::OPTIMUM * planner.period() * limits.velocity().width();
        prop_assert!(near <= far + slack, "{near:e} with {share} of the velocity, {far:e} with all of it");
    }

    #[test]
    fn a_velocity_out_of_reach_is_refused_with_what_is_in_reach(planner in planners(), share in shares()) {
        let v1 = within(planner.velocity(), share);
        let reachable = planner.reachable(v1);
        for (v2, taken) in [(reachable.max.next_up(), reachable.max), (reachable.min.next_down(), reachable.min)] {
            let refused = Err(RampError::Unreachable { from: v1, to: v2, reachable });
            prop_assert_eq!(planner.waypoint(0.0, v1, v2), refused);
            prop_assert_eq!(planner.waypoint_saturated(0.0, v1, v2)?, planner.waypoint(0.0, v1, taken)?);
        }
    }
}

type Kinds = (DetourCase, Option<PulseKind>, Option<PulseKind>, bool);

/// How often each case of the algorithm occurs among random problems.
#[test]
fn every_case_of_algorithm_3_occurs() {
    let mut runner = TestRunner::deterministic();
    let mut counts: BTreeMap<String, u32> = BTreeMap::new();
    for _ in 0..40_000 {
        let (planner, problem) =
            (planners(), problems()).new_tree(&mut runner).expect("a planner and a problem").current();
        let (_, v1, v2) = pick(&planner, problem);
        for direction in DIRECTIONS {
            let detour = planner.detour(v1, v2, direction).unwrap();
            let kinds: Kinds = (detour.case, detour.rise, detour.fall, detour.cruise > 0.0);
            *counts.entry(format!("{kinds:?}")).or_default() += 1;
        }
    }
    let (msap, map) = (Some(PulseKind::Msap), Some(PulseKind::Map));
    let mut expected: Vec<Kinds> = vec![(DetourCase::Three, None, None, true)];
    for kind in [msap, map] {
        for cruise in [true, false] {
            expected.extend([(DetourCase::One, kind, None, cruise), (DetourCase::One, None, kind, cruise)]);
        }
    }
    for (rise, fall) in [(msap, msap), (msap, map), (map, msap), (map, map)] {
        for cruise in [true, false] {
            expected.extend([(DetourCase::Two, rise, fall, cruise), (DetourCase::Four, rise, fall, cruise)]);
        }
    }
    for kinds in expected {
        let count = counts.get(&format!("{kinds:?}")).copied().unwrap_or(0);
        // Ramps up and down from one velocity have one kind each only if the limits of both directions differ.
        assert!(count >= 10, "{kinds:?} occurred {count} times among {counts:#?}");
    }
}

/// In a long period a stretched sine overshoots less than the quickest ramps of a detour would, and may end nearer to the
/// velocity limits than they: what does is the direct step, described as one.
#[test]
fn a_detour_that_is_out_of_the_question_is_described_as_the_direct_step() {
    let spec = PlannerSpec { shape: Shape::SineQuintic, ..paper_spec(0.8) };
    let planner = Planner::try_from(spec).unwrap();
    let Interval { min: bottom, max: top } = planner.velocity();
    let direct = Detour { case: DetourCase::One, peak: top, rise: None, cruise: 0.0, fall: None };
    let msap = Some(PulseKind::Msap);
    let falling = planner.detour(top, 0.1, Direction::Increasing);
    assert_eq!(falling, Ok(Detour { fall: msap, ..direct }));
    let rising = planner.detour(0.1, top, Direction::Increasing);
    assert_eq!(rising, Ok(Detour { rise: msap, ..direct }));
    let mirrored = planner.detour(bottom, -0.1, Direction::Decreasing);
    assert_eq!(mirrored, Ok(Detour { peak: bottom, fall: msap, ..direct }));
    let holding = planner.detour(top, top, Direction::Increasing);
    assert_eq!(holding, Ok(Detour { case: DetourCase::Three, cruise: 0.8, ..direct }));
}
