//! When an interrupted step is left for a stop: as soon as the stop travels no farther than finishing the step would.

use jbtg::strategies::planners;
use jbtg::{
    Direction, Interval, Limits, Planner, PlannerSpec, Quantity, State, StopStatus, SymmetricLimits,
    Trajectory,
};
use proptest::prelude::*;

use crate::properties::{cases, shares, within};
use crate::support::{paper_planner, paper_spec};

/// What the step from `now` on and the stop at its end reach, sampled: no more than is allowed.
fn sampled(planner: &Planner, step: &Trajectory, now: f64) -> Interval {
    let at_end = planner.stop(step.end()).expect("a step's end").trajectory.extrema().position;
    let left = step.duration() - now;
    (0..=128)
        .fold(at_end, |found, i| found.including(step.state_at(now + left * f64::from(i) / 128.0).position))
}

proptest! {
    #![proptest_config(cases(800))]

    #[test]
    fn a_step_is_left_at_the_first_quintic_from_which_the_stop_stays_within_what_it_reaches(
        planner in planners(),
        ends in (shares(), shares()),
        towards in any::<bool>(),
        share in 0.0..1.0,
    ) {
        let v1 = within(planner.velocity(), ends.0);
        let v2 = within(planner.reachable(v1), ends.1);
        let direction = if towards { Direction::Increasing } else { Direction::Decreasing };
        let step = planner.waypoint_towards(0.0, v1, v2, direction)?;
        let now = share * step.duration();
        let begin = planner.interrupt(&step, now)?.begin;
        let reached = sampled(&planner, &step, now);
        let starts = step.segments().iter().map(|segment| segment.start()).filter(|start| *start > now);
        let candidates: Vec<f64> = [now].into_iter().chain(starts).chain([step.duration()]).collect();
        prop_assert!(candidates.contains(&begin), "{begin} s is none of {candidates:?}");
        for earlier in candidates.into_iter().take_while(|time| *time < begin) {
            let stop = planner.stop(step.state_at(earlier))?.trajectory.extrema().position;
            prop_assert!(
                stop.min < reached.min || stop.max > reached.max,
                "{stop:?} from {earlier} s on is within {reached:?}, left at {begin} s"
            );
        }
    }
}

/// It speeds up backwards for 15 ms and cruises; braking at once would lead less far back than the way there and forth.
#[test]
fn a_step_that_turns_back_is_left_where_a_quintic_begins() {
    let planner = paper_planner(0.5);
    let step = planner.waypoint_towards(0.3, 0.1, -0.02, Direction::Decreasing).unwrap();
    let turn = step.segments()[2].start();
    assert!(step.segments().len() > 4 && turn < 0.3);
    assert_eq!(planner.interrupt(&step, 0.0).unwrap().begin, turn);
    // On the way forth again only what is still to come counts.
    let step = planner.waypoint_towards(0.3, 0.1, 0.1, Direction::Decreasing).unwrap();
    let last = step.segments().last().unwrap().start();
    assert_eq!(planner.interrupt(&step, 0.31).unwrap().begin, last);
}

/// A millionth beyond the limits of a joint so slow that a billionth of a unit is much.
#[test]
fn a_slow_joint_s_limits_are_no_looser() {
    let limits = SymmetricLimits {
        position: Interval::symmetric(1e-3),
        velocity: 5e-6,
        acceleration: 1e-4,
        jerk: 1e-2,
    };
    let limits = Limits::try_from(limits).unwrap();
    let planner = Planner::try_from(PlannerSpec { limits, ..paper_spec(0.05) }).unwrap();
    let status = |velocity, acceleration| {
        planner.stop(State { velocity, acceleration, ..State::default() }).unwrap().status
    };
    assert_eq!(status(5e-6, 0.0), StopStatus::WithinLimits);
    assert_eq!(status(5e-6 * (1.0 + 1e-6), 0.0), StopStatus::Recovering(Quantity::Velocity));
    assert_eq!(status(3e-6, -1e-4), StopStatus::WithinLimits);
    assert_eq!(status(3e-6, -1e-4 * (1.0 + 1e-6)), StopStatus::Recovering(Quantity::Acceleration));
}
