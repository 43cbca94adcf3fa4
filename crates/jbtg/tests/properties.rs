//! What holds for every planner and every step.

use jbtg::strategies::{decades, planners};
use jbtg::{Direction, Extrema, Interval, Planner, PlannerSpec, Segment, Shape, State, Timing, Trajectory};
use proptest::prelude::*;

pub(crate) use crate::support::within;
use crate::tolerance;

/// Cases per property; `EXTENSIVE=n` multiplies them by n.
pub(crate) fn cases(plain: u32) -> ProptestConfig {
    let factor = std::env::var("EXTENSIVE").ok().and_then(|text| text.parse().ok()).unwrap_or(1);
    ProptestConfig { max_global_rejects: u32::MAX, ..ProptestConfig::with_cases(plain * factor) }
}

/// Where in an interval: often its very ends, or close to zero change.
pub(crate) fn shares() -> impl Strategy<Value = f64> {
    prop_oneof![1 => Just(0.0), 1 => Just(1.0), 1 => Just(0.5), 5 => 0.0..=1.0]
}

/// Shares that are often 0 or next to it.
fn slow() -> impl Strategy<Value = f64> {
    prop_oneof![1 => Just(0.0), 2 => decades(-15.0, 0.0), 2 => 0.0..=1.0]
}

/// A position inside the limits, a velocity inside its bounds and one that it can reach.
fn pick(planner: &Planner, (position, v1, v2): (f64, f64, f64)) -> (f64, f64, f64) {
    let v1 = within(planner.velocity(), v1);
    (within(planner.limits().position(), position), v1, within(planner.reachable(v1), v2))
}

#[track_caller]
pub(crate) fn check_within(name: &str, found: Interval, limit: Interval) -> Result<(), TestCaseError> {
    let excess = (found.max - limit.max).max(limit.min - found.min) / limit.width();
    prop_assert!(
        excess <= tolerance::LIMIT,
        "{name}: {found:?} exceeds {limit:?} by {excess:e} of its width"
    );
    Ok(())
}

/// The largest magnitude that a term of each derivative's polynomial takes within the segment.
fn magnitudes(segment: &Segment) -> [f64; 4] {
    let t = segment.duration();
    let terms = segment.coefficients().map(f64::abs);
    let mut magnitudes = [0.0; 4];
    for (order, magnitude) in magnitudes.iter_mut().enumerate() {
        for (power, term) in terms.iter().enumerate().skip(order) {
            let factor: f64 = (0..order).map(|i| (power - i) as f64).product();
            *magnitude = f64::max(*magnitude, term * factor * t.powi((power - order) as i32));
        }
    }
    magnitudes
}

fn quantities(state: State) -> [f64; 4] {
    [state.position, state.velocity, state.acceleration, state.jerk]
}

fn intervals(extrema: Extrema) -> [Interval; 4] {
    [extrema.position, extrema.velocity, extrema.acceleration, extrema.jerk]
}

/// Bounds on the second derivative of position, velocity, acceleration and jerk within a segment.
fn curvatures(segment: &Segment, extrema: &Extrema) -> [f64; 4] {
    let [.., b4, b5] = segment.coefficients();
    let size = |interval: Interval| interval.max.abs().max(interval.min.abs());
    let snap = f64::max((24.0 * b4).abs(), (24.0 * b4 + 120.0 * b5 * segment.duration()).abs());
    [size(extrema.acceleration), size(extrema.jerk), snap, (120.0 * b5).abs()]
}

/// Samples never exceed the exact extrema and come as close as the curvature between samples allows.
fn check_extrema(step: &Trajectory) -> Result<(), TestCaseError> {
    const SAMPLES: u32 = 64;
    let extrema = step.extrema();
    let mut sampled = Extrema::at(step.end());
    let (mut gap, mut rounding) = ([0.0_f64; 4], [0.0_f64; 4]);
    for segment in step.segments() {
        for i in 0..=SAMPLES {
            let time = segment.duration() * f64::from(i) / f64::from(SAMPLES);
            sampled = sampled.union(Extrema::at(segment.state_at(time)));
        }
        let spacing = segment.duration() / f64::from(SAMPLES);
        for (quantity, curvature) in curvatures(segment, &extrema).into_iter().enumerate() {
            gap[quantity] = gap[quantity].max(curvature * spacing * spacing / 8.0);
            rounding[quantity] =
                rounding[quantity].max(tolerance::JOINT_ULPS * f64::EPSILON * magnitudes(segment)[quantity]);
        }
    }
    for (quantity, (exact, sampled)) in intervals(extrema).into_iter().zip(intervals(sampled)).enumerate() {
        let (gap, rounding) = (gap[quantity], rounding[quantity]);
        for excess in [sampled.max - exact.max, exact.min - sampled.min] {
            prop_assert!(excess <= rounding, "quantity {quantity}: sampled {sampled:?} exceeds {exact:?}");
            prop_assert!(
                -excess <= gap + rounding,
                "quantity {quantity}: {exact:?} is too wide, sampled {sampled:?}"
            );
        }
    }
    Ok(())
}

/// Segments follow each other without a gap, from the start to the end state.
pub(crate) fn check_joints(step: &Trajectory, start: State, shape: Shape) -> Result<(), TestCaseError> {
    let segments = step.segments();
    let compared = if shape == Shape::Smoothstep { 4 } else { 3 };
    let scales = segments.iter().map(magnitudes).fold([0.0; 4], larger);
    let (mut time, mut state) = (0.0, start);
    for (i, segment) in segments.iter().enumerate() {
        let gap = (segment.start() - time).abs();
        prop_assert!(gap <= 4.0 * f64::EPSILON * step.duration(), "segment {i} starts {gap:e} s late");
        check_joint(i, compared, (state, segment.state_at(0.0)), scales)?;
        time = segment.start() + segment.duration();
        state = segment.state_at(segment.duration());
    }
    prop_assert!((time - step.duration()).abs() <= 4.0 * f64::EPSILON * step.duration());
    check_joint(segments.len(), compared, (state, step.end()), scales)
}

fn larger(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    std::array::from_fn(|i| a[i].max(b[i]))
}

fn check_joint(
    index: usize,
    compared: usize,
    (before, after): (State, State),
    scales: [f64; 4],
) -> Result<(), TestCaseError> {
    let pairs = quantities(before).into_iter().zip(quantities(after)).take(compared);
    for (quantity, (before, after)) in pairs.enumerate() {
        let scale = scales[quantity].max(before.abs()).max(after.abs());
        let gap = (before - after).abs();
        prop_assert!(
            gap <= tolerance::JOINT_ULPS * f64::EPSILON * scale,
            "joint {index}, quantity {quantity}: {before:e} then {after:e}"
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases(20_000))]

    #[test]
    fn a_step_s_duration_leads_to_its_end_bit_for_bit(planner in planners(), shares in (shares(), shares(), shares())) {
        let (position, v1, v2) = pick(&planner, shares);
        let step = planner.ramp(position, v1, v2)?;
        prop_assert_eq!(step.state_at(step.duration()), step.end());
    }

    #[test]
    fn no_step_exceeds_velocity_acceleration_or_jerk(planner in planners(), shares in (shares(), shares(), shares())) {
        let (position, v1, v2) = pick(&planner, shares);
        let extrema = planner.ramp(position, v1, v2)?.extrema();
        check_within("velocity", extrema.velocity, planner.limits().velocity())?;
        check_within("acceleration", extrema.acceleration, planner.limits().acceleration())?;
        check_within("jerk", extrema.jerk, planner.limits().jerk())?;
    }

    #[test]
    fn a_step_joins_its_start_to_its_end_without_gaps(planner in planners(), shares in (shares(), shares(), shares())) {
        let (position, v1, v2) = pick(&planner, shares);
        let step = planner.ramp(position, v1, v2)?;
        prop_assert_eq!(step.end().velocity, v2);
        prop_assert_eq!(step.end().position, position + planner.displacement(v1, v2));
        prop_assert_eq!(step.duration(), planner.period());
        let start = State { position, velocity: v1, ..State::default() };
        check_joints(&step, start, planner.spec().shape)?;
    }

    #[test]
    fn extrema_are_those_of_the_motion(planner in planners(), shares in (shares(), shares(), shares())) {
        let (position, v1, v2) = pick(&planner, shares);
        check_extrema(&planner.ramp(position, v1, v2)?)?;
    }

    #[test]
    fn both_ends_of_the_reachable_range_are_reached(planner in planners(), share in shares()) {
        let v1 = within(planner.velocity(), share);
        let reachable = planner.reachable(v1);
        prop_assert!(reachable.contains(v1));
        for v2 in [reachable.min, reachable.max] {
            prop_assert!(planner.velocity().contains(v2));
            prop_assert_eq!(planner.ramp(0.0, v1, v2)?.end().velocity, v2);
        }
        prop_assert!(planner.ramp(0.0, v1, reachable.max.next_up()).is_err());
        prop_assert!(planner.ramp(0.0, v1, reachable.min.next_down()).is_err());
    }

    /// Each direction has its own acceleration bound and each of its ramps its own jerk bound.
    #[test]
    fn the_largest_step_uses_every_bound_of_its_direction(planner in planners()) {
        let spec = PlannerSpec { shape: Shape::Smoothstep, ..*planner.spec() };
        let Ok(planner) = Planner::try_from(spec) else { return Ok(()) };
        let (limits, reachable) = (planner.limits(), planner.reachable(0.0));
        for (direction, v2) in [(Direction::Increasing, reachable.max), (Direction::Decreasing, reachable.min)] {
            let authority = planner.authority(direction);
            let ramps = authority.ramp_up.min(authority.ramp_down);
            if v2.abs() < authority.velocity_change * (1.0 - tolerance::LIMIT) || ramps < 1.1e-6 * planner.period() {
                continue; // the velocity limit came first, or the ramps are as short as they get
            }
            let extrema = planner.ramp(0.0, 0.0, v2)?.extrema();
            let share = |found: Interval, limit: Interval| match direction {
                Direction::Increasing => found.max / limit.max,
                Direction::Decreasing => found.min / limit.min,
            };
            let is_all_ramps = authority.ramp_up + authority.ramp_down >= planner.period() * (1.0 - tolerance::LIMIT);
            let used = share(extrema.acceleration, limits.acceleration());
            prop_assert!(is_all_ramps || used >= 1.0 - tolerance::LIMIT, "{used} of the acceleration bound");
            for used in [extrema.jerk.max / limits.jerk().max, extrema.jerk.min / limits.jerk().min] {
                prop_assert!(used >= 1.0 - tolerance::LIMIT, "{used} of a jerk bound");
            }
        }
    }

    #[test]
    fn extrema_of_a_turn_are_those_of_the_motion(planner in planners(), shares in (shares(), slow(), shares())) {
        let (position, _, _) = pick(&planner, (shares.0, 0.0, 0.0));
        let fast = f64::min(planner.reachable(0.0).max, -planner.reachable(0.0).min);
        let (v1, v2) = (0.5 * fast * shares.1, -0.5 * fast * shares.2);
        check_extrema(&planner.ramp(position, v1, planner.reachable(v1).clamp(v2))?)?;
        let (v1, v2) = (-v1, -v2);
        check_extrema(&planner.ramp(position, v1, planner.reachable(v1).clamp(v2))?)?;
    }

    /// What `safezone` leans on.
    #[test]
    fn the_displacement_grows_with_the_end_velocity(planner in planners(), share in shares(), ends in (shares(), shares())) {
        let (_, v1, a) = pick(&planner, (0.0, share, ends.0));
        let b = within(planner.reachable(v1), ends.1);
        let (low, high) = (a.min(b), a.max(b));
        let [less, more] = [low, high].map(|v2| planner.displacement(v1, v2));
        let scale = planner.period() * (v1.abs() + (high - v1).abs() + (low - v1).abs());
        prop_assert!(less <= more + 4.0 * f64::EPSILON * scale, "{less:e} to {low:e} but {more:e} to {high:e}");
    }

    /// What `safezone` leans on for the interior of steps.
    #[test]
    fn a_stretched_smoothstep_to_less_lies_below_one_to_more(
        planner in planners(),
        share in shares(),
        ends in (shares(), shares()),
    ) {
        let spec = PlannerSpec { shape: Shape::Smoothstep, timing: Timing::Stretched, ..*planner.spec() };
        let Ok(planner) = Planner::try_from(spec) else { return Ok(()) };
        let (_, v1, a) = pick(&planner, (0.0, share, ends.0));
        let b = within(planner.reachable(v1), ends.1);
        let (below, above) = (planner.ramp(0.0, v1, a.min(b))?, planner.ramp(0.0, v1, a.max(b))?);
        let scale = planner.period() * (v1.abs() + (a - v1).abs() + (b - v1).abs());
        for i in 0..=32 {
            let time = planner.period() * f64::from(i) / 32.0;
            let [low, high] = [below, above].map(|step| step.state_at(time).position);
            prop_assert!(low <= high + tolerance::JOINT_ULPS * f64::EPSILON * scale, "at {time} s: {low:e} > {high:e}");
        }
    }
}
