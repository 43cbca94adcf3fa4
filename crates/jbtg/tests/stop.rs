//! Stops from any instant of any trajectory.

use jbtg::strategies::planners;
use jbtg::{
    Direction, Interval, Limits, LimitsSpec, Planner, PlannerSpec, Quantity, Shape, State, StopError,
    StopStatus, Trajectory,
};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

use crate::properties::{cases, check_joints, check_within, shares, within};
use crate::tolerance;

/// A step of the planner, direct or through a peak: (position, v₁, v₂) as shares, and which.
fn steps() -> impl Strategy<Value = ((f64, f64, f64), u8)> {
    ((shares(), shares(), shares()), 0..3_u8)
}

fn step_of(planner: &Planner, ((position, v1, v2), kind): ((f64, f64, f64), u8)) -> Trajectory {
    let v1 = within(planner.velocity(), v1);
    let v2 = within(planner.reachable(v1), v2);
    let position = within(planner.limits().position(), position);
    let step = match kind {
        0 => planner.ramp(position, v1, v2),
        1 => planner.waypoint_towards(position, v1, v2, Direction::Increasing),
        _ => planner.farthest(position, v1, v2, Direction::Decreasing),
    };
    step.expect("a reachable velocity")
}

/// An instant of `step`: anywhere, or close to where a quintic begins.
fn instants() -> impl Strategy<Value = (f64, bool, f64)> {
    (shares(), any::<bool>(), (-17.0..0.0_f64).prop_map(|e| 10_f64.powf(e)))
}

fn instant(step: &Trajectory, (share, near, offset): (f64, bool, f64)) -> f64 {
    if !near {
        return share * step.duration();
    }
    let segments = step.segments();
    let segment = segments[(share * (segments.len() - 1) as f64) as usize];
    let passed = offset * segment.duration();
    segment.start() + if share > 0.5 { segment.duration() - passed } else { passed }
}

/// Finishes at the end of `step` and brakes there, step by step, by as much as one period allows: the time that takes
/// and where it leads. `None` if it takes very many steps.
fn stepwise(planner: &Planner, step: &Trajectory) -> Option<(f64, Interval)> {
    let (mut state, mut time) = (step.end(), 0.0);
    let mut positions = Interval::new(state.position, state.position);
    for _ in 0..200 {
        if state.velocity == 0.0 {
            return Some((time, positions));
        }
        let braking = planner.ramp_saturated(state.position, state.velocity, 0.0).expect("finite numbers");
        positions = positions.union(braking.extrema().position);
        state = braking.end();
        time += planner.period();
    }
    None
}

/// Positions from `now` on, sampled densely between exact control points: a lower bound of the true interval.
fn positions_from(step: &Trajectory, now: f64) -> Interval {
    let left = step.duration() - now;
    (0..=512).fold(Interval::new(f64::INFINITY, f64::NEG_INFINITY), |positions, i| {
        positions.including(step.state_at(now + left * f64::from(i) / 512.0).position)
    })
}

proptest! {
    #![proptest_config(cases(20_000))]

    #[test]
    fn a_stop_keeps_every_limit_and_ends_at_rest(planner in planners(), step in steps(), at in instants()) {
        let step = step_of(&planner, step);
        let state = step.state_at(instant(&step, at));
        let stop = planner.stop(state)?;
        prop_assert_eq!(stop.status, StopStatus::WithinLimits);
        let trajectory = stop.trajectory;
        let end = trajectory.end();
        prop_assert_eq!((end.velocity, end.acceleration, end.jerk), (0.0, 0.0, 0.0));
        let extrema = trajectory.extrema();
        check_within("velocity", extrema.velocity, planner.limits().velocity())?;
        check_within("acceleration", extrema.acceleration, planner.limits().acceleration())?;
        check_within("jerk", extrema.jerk, planner.limits().jerk())?;
        prop_assert_eq!(trajectory.state_at(2.0 * trajectory.duration()), end);
    }

    /// Jerk included: the stop takes up the state's own.
    #[test]
    fn a_stop_continues_the_state_without_gaps(planner in planners(), step in steps(), at in instants()) {
        let step = step_of(&planner, step);
        let mut state = step.state_at(instant(&step, at));
        let trajectory = planner.stop(state)?.trajectory;
        if trajectory.duration() > 0.0 {
            // Within rounding of the acceleration limit there is no time for the rest of the jerk to vanish in.
            let jerk = trajectory.segments()[0].state_at(0.0).jerk;
            if (jerk - state.jerk).abs() <= tolerance::JERK_LEFT * planner.limits().jerk().width() {
                state.jerk = jerk;
            }
            check_joints(&trajectory, state, Shape::Smoothstep)?;
        }
    }

    #[test]
    fn velocity_changes_its_sign_at_most_once_and_only_if_braking_cannot_end_in_time(
        planner in planners(),
        step in steps(),
        at in instants(),
    ) {
        let step = step_of(&planner, step);
        let state = step.state_at(instant(&step, at));
        let State { velocity: v, acceleration: a, .. } = state;
        let trajectory = planner.stop(state)?.trajectory;
        let velocity = trajectory.extrema().velocity;
        let jerk = planner.limits().jerk();
        // What ending the present acceleration changes the velocity by, from zero jerk.
        let release = if a < 0.0 { -0.75 * a * a / jerk.max } else { -0.75 * a * a / jerk.min };
        let slack = 1e-12 * (v.abs() + release.abs()) + 1e-15 * planner.velocity().width();
        if v * release >= 0.0 || release.abs() <= v.abs() - slack {
            let side = if v != 0.0 { v } else { release };
            let beyond = if side > 0.0 { -velocity.min } else { velocity.max };
            // A jerk that still builds up braking may need more velocity than there is by then.
            let builds_up = v * a < 0.0 && state.jerk * a > 0.0;
            prop_assert!(builds_up || beyond <= slack, "{velocity:?} from {v:e}, {a:e}");
        }
    }

    /// What makes a stop safe wherever the step was.
    #[test]
    fn an_interrupted_step_travels_no_farther_than_finishing_it_and_braking_stepwise(
        planner in planners(),
        step in steps(),
        at in instants(),
    ) {
        let step = step_of(&planner, step);
        let now = instant(&step, at);
        let Some((time, braking)) = stepwise(&planner, &step) else { return Ok(()) };
        let allowed = positions_from(&step, now).union(braking);
        let stop = planner.interrupt(&step, now)?;
        let found = stop.trajectory.extrema().position;
        let scale = step.extrema().position;
        let speed = planner.limits().velocity();
        let slack = 64.0 * f64::EPSILON * scale.max.abs().max(scale.min.abs())
            + 1e-12 * planner.period() * speed.width()
            // Between samples of the remaining step.
            + planner.limits().acceleration().width() * (step.duration() / 512.0).powi(2) / 8.0;
        prop_assert!(
            found.min >= allowed.min - slack && found.max <= allowed.max + slack,
            "{found:?} leaves {allowed:?}, from {now} s, taking over at {} s", stop.begin
        );
        prop_assert!((now.min(step.duration())..=step.duration()).contains(&stop.begin));
        let (ours, theirs) = (stop.begin - now + stop.trajectory.duration(), step.duration() - now + time);
        prop_assert!(ours <= theirs * (1.0 + 1e-6) + 1e-6 * planner.period(), "{ours} s to stop, {theirs} s stepwise");
    }

    #[test]
    fn a_stop_right_away_is_no_slower_than_finishing_the_step_and_braking(
        planner in planners(),
        step in steps(),
        at in instants(),
    ) {
        let step = step_of(&planner, step);
        let now = instant(&step, at).min(step.duration());
        let Some((time, _)) = stepwise(&planner, &step) else { return Ok(()) };
        let ours = planner.stop(step.state_at(now))?.trajectory.duration();
        let theirs = step.duration() - now + time;
        prop_assert!(ours <= theirs * (1.0 + 1e-6) + 1e-6 * planner.period(), "{ours} s to stop, {theirs} s stepwise");
    }

    #[test]
    fn a_stop_from_a_step_s_end_travels_no_farther_than_braking_stepwise(planner in planners(), step in steps()) {
        let step = step_of(&planner, step);
        let Some((_, braking)) = stepwise(&planner, &step) else { return Ok(()) };
        let found = planner.stop(step.end())?.trajectory.extrema().position;
        let travelled = braking.width();
        let slack = 64.0 * f64::EPSILON * braking.max.abs().max(braking.min.abs()) + 1e-12 * travelled;
        prop_assert!(found.min >= braking.min - slack && found.max <= braking.max + slack, "{found:?} leaves {braking:?}");
    }

    #[test]
    fn the_mirrored_state_stops_in_the_mirror_image(planner in planners(), step in steps(), at in instants()) {
        let limits = planner.limits();
        let mirror = LimitsSpec {
            position: limits.position().mirrored(),
            velocity: limits.velocity().mirrored(),
            acceleration: limits.acceleration().mirrored(),
            jerk: limits.jerk().mirrored(),
        };
        let mirror = Planner::try_from(PlannerSpec { limits: Limits::try_from(mirror)?, ..*planner.spec() })?;
        let step = step_of(&planner, step);
        let State { position, velocity, acceleration, jerk } = step.state_at(instant(&step, at));
        let state = State { position, velocity, acceleration, jerk };
        let image = State { position: -position, velocity: -velocity, acceleration: -acceleration, jerk: -jerk };
        let (stop, image) = (planner.stop(state)?.trajectory, mirror.stop(image)?.trajectory);
        prop_assert_eq!(stop.duration(), image.duration());
        prop_assert_eq!(stop.end().position, -image.end().position);
    }

    #[test]
    fn a_state_beyond_its_limits_is_recovered_from_and_the_status_says_so(
        planner in planners(),
        factors in (-3.0..3.0, -3.0..3.0, -3.0..3.0),
    ) {
        let limits = planner.limits();
        let state = State {
            position: 0.0,
            velocity: factors.0 * limits.velocity().max,
            acceleration: factors.1 * limits.acceleration().max,
            jerk: factors.2 * limits.jerk().max,
        };
        let stop = planner.stop(state)?;
        let extrema = stop.trajectory.extrema();
        let checks = [
            (Quantity::Velocity, check_within("", extrema.velocity, limits.velocity())),
            (Quantity::Acceleration, check_within("", extrema.acceleration, limits.acceleration())),
            (Quantity::Jerk, check_within("", Interval::new(state.jerk, state.jerk), limits.jerk())),
        ];
        let expected = checks.into_iter().find(|(_, check)| check.is_err());
        let expected = expected.map_or(StopStatus::WithinLimits, |(quantity, _)| StopStatus::Recovering(quantity));
        prop_assert_eq!(stop.status, expected);
        // No detour: velocity passes its limit no farther than ending the acceleration takes it.
        let (v, a) = (state.velocity, state.acceleration.abs());
        let slowest = limits.jerk().max.min(-limits.jerk().min);
        let carried = v.abs() + 3.0 * (a + state.jerk.abs() * a / slowest) * (a / slowest);
        prop_assert!(extrema.velocity.max.max(-extrema.velocity.min) <= carried + 1e-12 * limits.velocity().width());
        prop_assert_eq!(stop.trajectory.end().velocity, 0.0);
        check_within("jerk", stop.trajectory.extrema().jerk, limits.jerk())?;
    }

    #[test]
    fn any_state_at_all_is_stopped_or_refused(
        planner in planners(),
        state in [prop::num::f64::ANY, prop::num::f64::ANY, prop::num::f64::ANY, prop::num::f64::ANY],
    ) {
        let [position, velocity, acceleration, jerk] = state;
        let state = State { position, velocity, acceleration, jerk };
        match planner.stop(state) {
            Ok(stop) => prop_assert!(stop.trajectory.end().position.is_finite()),
            Err(StopError::OutOfScale) => {}
            Err(StopError::NotFinite { .. }) => {
                prop_assert!([position, velocity, acceleration, jerk].iter().any(|x| !x.is_finite()));
            }
        }
    }
}

/// Time optimum with jerk steps of size J at will, equal bounds both ways: no motion is quicker.
///
/// It ignores the state's own jerk, which a stop takes up: where that builds up braking which should have ended by now,
/// the stop passes 0 and comes back, and takes much longer than this.
fn least_time(state: State, acceleration: f64, jerk: f64) -> f64 {
    let State { velocity, acceleration: a, .. } = state;
    let sign = if velocity + 0.5 * a * a.abs() / jerk >= 0.0 { 1.0 } else { -1.0 };
    let (v, a) = (sign * velocity, sign * a);
    let peak = (jerk * v + 0.5 * a * a).max(0.0).sqrt();
    if peak <= acceleration {
        (a + 2.0 * peak) / jerk
    } else {
        let hold = (v + 0.5 * a * a / jerk) / acceleration - acceleration / jerk;
        (a + 2.0 * acceleration) / jerk + hold
    }
}

#[test]
fn a_stop_takes_at_most_four_times_the_time_optimum_with_jerk_steps() {
    let mut runner = TestRunner::deterministic();
    let (mut largest, mut sum, mut count) = (0.0_f64, 0.0, 0);
    let mut worst = String::new();
    while count < 20_000 {
        let (planner, step, at) =
            (planners(), steps(), instants()).new_tree(&mut runner).expect("a problem").current();
        let limits = planner.limits();
        let (acceleration, jerk) = (limits.acceleration().max, limits.jerk().max);
        let spec = LimitsSpec {
            position: limits.position(),
            velocity: limits.velocity(),
            acceleration: Interval::symmetric(acceleration),
            jerk: Interval::symmetric(jerk),
        };
        let spec = PlannerSpec { limits: Limits::try_from(spec).expect("limits"), ..*planner.spec() };
        let Ok(planner) = Planner::try_from(spec) else { continue };
        let step = step_of(&planner, step);
        let state = step.state_at(instant(&step, at));
        let ours = planner.stop(state).expect("a state of a step").trajectory.duration();
        let least = least_time(state, acceleration, jerk);
        count += 1;
        if least > 1e-3 * planner.period() && jerk * planner.period() < 1e5 * acceleration {
            assert!(ours >= least * (1.0 - 1e-9), "{ours} s beats the optimum of {least} s from {state:?}");
            if ours > largest * least {
                (largest, worst) = (ours / least, format!("{state:?} with {planner:?}"));
            }
            sum += ours / least;
        }
    }
    let mean = sum / f64::from(count);
    assert!(largest <= 4.0 && mean <= 1.2, "{largest} times the optimum at most, {mean} on average: {worst}");
}

#[test]
fn most_steps_can_be_stopped_right_away() {
    let mut runner = TestRunner::deterministic();
    let (mut right_away, mut later) = (0, 0);
    for _ in 0..20_000 {
        let (planner, step, at) =
            (planners(), steps(), instants()).new_tree(&mut runner).expect("a problem").current();
        let step = step_of(&planner, step);
        let now = instant(&step, at);
        let stop = planner.interrupt(&step, now).expect("a step of the planner");
        if stop.begin <= now { right_away += 1 } else { later += 1 }
    }
    assert!(later > 0 && right_away > 9 * later, "{right_away} right away, {later} later");
}

fn crane() -> Planner {
    let limits = LimitsSpec {
        position: Interval::new(0.14, 0.50),
        velocity: Interval::symmetric(0.15),
        acceleration: Interval::symmetric(1.0),
        jerk: Interval::symmetric(100.0),
    };
    let limits = Limits::try_from(limits).expect("limits around zero");
    Planner::try_from(PlannerSpec {
        limits,
        shape: Shape::Smoothstep,
        timing: jbtg::Timing::Stretched,
        period: 0.05,
    })
    .expect("a period of many ramps")
}

#[test]
fn a_stop_from_rest_takes_no_time() {
    let rest = State { position: 0.3, ..State::default() };
    let stop = crane().stop(rest).unwrap();
    assert_eq!((stop.trajectory.duration(), stop.trajectory.end()), (0.0, rest));
    assert_eq!(stop.trajectory.state_at(0.01), rest);
    assert_eq!(stop.trajectory.standstill().unwrap().state, rest);
}

/// 0.15 m/s at 1 m/s² and 100 m/s³: 0.15 s of braking and one ramp of 15 ms.
#[test]
fn a_stop_from_a_cruise_takes_the_braking_time_and_one_ramp() {
    let state = State { position: 0.3, velocity: 0.15, ..State::default() };
    let stop = crane().stop(state).unwrap().trajectory;
    assert!((stop.duration() - 0.165).abs() <= 1e-14);
    assert!((stop.end().position - 0.3 - 0.15 * 0.5 * 0.165).abs() <= 1e-14);
}

#[test]
fn numbers_that_are_no_state_or_time_are_refused() {
    let planner = crane();
    let step = planner.ramp(0.3, 0.0, 0.01).unwrap();
    assert_eq!(
        planner.stop(State { jerk: f64::INFINITY, ..State::default() }),
        Err(StopError::NotFinite { name: "jerk", value: f64::INFINITY })
    );
    assert!(matches!(planner.interrupt(&step, f64::NAN), Err(StopError::NotFinite { name: "time", .. })));
    assert_eq!(planner.interrupt(&step, f64::INFINITY).unwrap().begin, 0.05);
}
