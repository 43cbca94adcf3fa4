//! Stops from the middle of braking: while its jerk is ending it, and while it is stronger than the limits allow.

use jbtg::strategies::{decades, planners};
use jbtg::{
    Direction, Interval, Limits, Planner, PlannerSpec, Segment, Shape, State, StopStatus, SymmetricLimits,
    Trajectory,
};
use proptest::prelude::*;

use crate::properties::{cases, check_joints, check_within};
use crate::support::{paper_planner, paper_spec};
use crate::tolerance;

/// Magnitudes of one direction's limits: of braking that lowers the velocity, or raises it.
#[derive(Clone, Copy, Debug)]
struct Frame {
    sign: f64,
    speed: f64,
    brake: f64,
    /// Jerk that builds braking up, and that ends it.
    builds_up: f64,
    ends: f64,
}

impl Frame {
    fn of(planner: &Planner, raises: bool) -> Self {
        let mirrored = |limit: Interval| if raises { limit.mirrored() } else { limit };
        let limits = planner.limits();
        let [velocity, acceleration, jerk] =
            [limits.velocity(), limits.acceleration(), limits.jerk()].map(mirrored);
        let sign = if raises { -1.0 } else { 1.0 };
        Self { sign, speed: velocity.max, brake: -acceleration.min, builds_up: -jerk.min, ends: jerk.max }
    }

    /// The state of a velocity, a deceleration and a jerk that ends it.
    fn state(&self, velocity: f64, deceleration: f64, jerk: f64) -> State {
        let Self { sign, .. } = *self;
        State {
            position: 0.0,
            velocity: sign * velocity,
            acceleration: -sign * deceleration,
            jerk: sign * jerk,
        }
    }

    /// Where on its last ramp, a smoothstep from `deceleration` to 0 and `slowness` times as long as the jerk limit asks
    /// for, braking that ends at the velocity `left` is when a share `rest` of the ramp's time remains.
    fn on_last_ramp(&self, (deceleration, slowness): (f64, f64), rest: f64, left: f64) -> State {
        let duration = slowness * 1.5 * deceleration / self.ends;
        let to_come = rest.powi(3) * (1.0 - 0.5 * rest) * deceleration * duration;
        let jerk = 6.0 * rest * (1.0 - rest) * deceleration / duration;
        self.state(left + to_come, rest * rest * (3.0 - 2.0 * rest) * deceleration, jerk)
    }
}

/// The largest jerk of the last ramp that is no matter of rounding.
fn jerk_at_last(stop: &Trajectory) -> f64 {
    let strongest = stop.extrema().acceleration;
    let rounding = 1e-4 * strongest.max.max(-strongest.min);
    let is_ramp = |segment: &&Segment| segment.state_at(0.0).acceleration.abs() > rounding;
    let last = stop.segments().iter().rev().find(is_ramp).expect("braking");
    let jerks = (0..=64).map(|i| last.state_at(last.duration() * f64::from(i) / 64.0).jerk.abs());
    jerks.fold(0.0, f64::max)
}

/// Velocities left at the end of a ramp, of what the whole ramp takes: none, next to none, less than it or more.
fn left() -> impl Strategy<Value = f64> {
    prop_oneof![1 => Just(0.0), 2 => decades(-6.0, 0.0), 2 => 0.0..1.0, 1 => 1.0..30.0]
}

proptest! {
    #![proptest_config(cases(3_000))]

    #[test]
    fn braking_that_is_ending_goes_on_to_rest_without_a_break(
        planner in planners(),
        raises in any::<bool>(),
        ramp in (0.01..1.0, prop_oneof![Just(1.0), 1.0..4.0]),
        rest in 0.05..0.999,
        left in left(),
    ) {
        let frame = Frame::of(&planner, raises);
        let (deceleration, slowness) = (ramp.0 * frame.brake, ramp.1);
        let left = left * deceleration * deceleration / frame.ends;
        let state = frame.on_last_ramp((deceleration, slowness), rest, left);
        prop_assume!(state.velocity.abs() <= frame.speed);
        let stop = planner.stop(state)?;
        prop_assert_eq!(stop.status, StopStatus::WithinLimits);
        let stop = stop.trajectory;
        check_joints(&stop, state, Shape::Smoothstep)?;
        // Braking that goes on as it does ends above 0: no reason to turn back. Next to the largest jerk the time that
        // ending it takes goes with the root of what is missing, and so of rounding.
        let rounding = 1e-7 * state.velocity.abs();
        let velocity = stop.extrema().velocity;
        let lowest = if raises { -velocity.max } else { velocity.min };
        prop_assert!(lowest >= -rounding, "{velocity:?} from {state:?}");
        for point in stop.control_points().filter(|point| point.state.velocity.abs() > rounding) {
            prop_assert!(point.state.acceleration * state.acceleration > 0.0, "no braking at {} s", point.time);
        }
        // Ramps shorter than a millionth of the period are longer than their jerk limit asks for.
        if frame.ends * planner.period() <= 1e5 * frame.brake {
            let found = jerk_at_last(&stop);
            prop_assert!(found >= 0.999 * frame.ends, "{found:e} of {:e} at last", frame.ends);
        }
    }

    #[test]
    fn too_strong_an_acceleration_comes_back_to_its_limit_at_once_and_stays_there(
        planner in planners(),
        raises in any::<bool>(),
        excess in 0.01..2.0,
        jerk in prop_oneof![1 => Just(0.0), 5 => -1.0..1.0],
    ) {
        let frame = Frame::of(&planner, raises);
        let deceleration = (1.0 + excess) * frame.brake;
        let slowest = frame.ends.min(frame.builds_up);
        let jerk = jerk * if jerk > 0.0 { frame.ends } else { frame.builds_up };
        // Enough to brake at the limit for a while.
        let velocity = 9.0 * deceleration * deceleration / slowest;
        let state = frame.state(velocity, deceleration, jerk);
        let stop = planner.stop(state)?.trajectory;
        check_joints(&stop, state, Shape::Smoothstep)?;
        check_within("jerk", stop.extrema().jerk, planner.limits().jerk())?;
        let back = usize::from(jerk < 0.0); // once the jerk is gone that builds it up
        let [before, after] = [back, back + 1].map(|i| stop.control_points().nth(i).expect("several ramps"));
        let found = after.state.acceleration.abs() / frame.brake;
        prop_assert!((found - 1.0).abs() <= tolerance::LIMIT, "{found} of the limit after the way back");
        prop_assert_eq!(stop.segments()[back + 1].state_at(0.0).acceleration, after.state.acceleration);
        let least = 1.5 * (before.state.acceleration.abs() - frame.brake) / frame.ends;
        prop_assert!(frame.ends * planner.period() > 1e5 * frame.brake || after.time - before.time <= least * (1.0 + 1e-9));
    }
}

/// Jerk without a limit to speak of: ramps last a millionth of the period, as a step's do.
fn abrupt() -> Planner {
    let limits =
        SymmetricLimits { position: Interval::symmetric(1.0), velocity: 0.4, acceleration: 2.0, jerk: 1e12 };
    let limits = Limits::try_from(limits).expect("limits around zero");
    Planner::try_from(PlannerSpec { limits, ..paper_spec(0.05) }).expect("a period of many ramps")
}

#[test]
fn a_stop_s_ramps_are_as_short_as_a_step_s() {
    let planner = abrupt();
    let shortest = planner.authority(Direction::Increasing).ramp_up;
    let stop = planner.stop(State { velocity: 0.3, ..State::default() }).unwrap().trajectory;
    let durations: Vec<f64> = stop.segments().iter().map(|segment| segment.duration()).collect();
    let [first, held, last] = durations[..] else { panic!("{durations:?}") };
    assert!((first / shortest - 1.0).abs() < 1e-9 && (last / shortest - 1.0).abs() < 1e-9, "{durations:?}");
    assert!((held - (0.15 - shortest)).abs() < 1e-12, "{durations:?}");
}

/// A trace of jerk that builds up braking is dropped in no time.
#[test]
fn a_trace_of_jerk_costs_no_time() {
    let planner = abrupt();
    let stop = |jerk| {
        let state = State { velocity: 1e-12, acceleration: -1.0, jerk, ..State::default() };
        planner.stop(state).unwrap().trajectory.duration()
    };
    assert!((stop(-1e-3) / stop(0.0) - 1.0).abs() < 1e-9, "{:e} s, {:e} s", stop(-1e-3), stop(0.0));
}

/// What brakes to rest as fast as the jerk limit allows, and has the largest jerk ahead of it, goes on doing so in one
/// quintic, however its state was rounded.
#[test]
fn braking_to_rest_goes_on_in_one_quintic() {
    let frame = Frame::of(&paper_planner(0.05), false);
    for deceleration in (1..60).map(|i| f64::from(i) / 60.0) {
        for rest in [0.55, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99] {
            let state = frame.on_last_ramp((deceleration, 1.0), rest, 0.0);
            let stop = paper_planner(0.05).stop(state).unwrap().trajectory;
            let left = rest * 1.5 * deceleration / 100.0;
            assert_eq!(stop.segments().len(), 1, "{state:?}");
            assert!(
                (stop.duration() - left).abs() <= 1e-12 * left,
                "{} s instead of {left} s",
                stop.duration()
            );
            check_joints(&stop, state, Shape::Smoothstep).unwrap();
        }
    }
}

/// From a deceleration that takes more velocity to end than there is: to no acceleration, and there and back.
#[test]
fn a_stop_that_turns_back_has_no_quintic_to_spare() {
    let state = State { velocity: 1e-4, acceleration: -0.5, ..State::default() };
    let stop = paper_planner(0.05).stop(state).unwrap().trajectory;
    assert_eq!(stop.segments().len(), 3);
    assert!(stop.extrema().velocity.min < 0.0);
}
