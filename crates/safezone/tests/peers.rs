//! What other velocity generators with position limits are reported to break on: here it is held, step after step, the
//! interior of every step included.

use jbtg::{Interval, Limits, LimitsSpec, Planner, PlannerSpec, Shape, Timing};
use safezone::{RangeStatus, Request, SafeZone, Side};

use crate::adversary::{Noise, worst_excess};
use crate::telescope::{ALL, POSITION, planner};
use crate::tolerance;

const ALL_TIMINGS: [Timing; 2] = [Timing::Stretched, Timing::Fastest];

/// A joint that keeps its state and checks every step it takes.
struct Joint {
    zone: SafeZone<'static>,
    position: f64,
    velocity: f64,
    worst: f64,
}

impl Joint {
    fn new(planner: Planner, position: f64, velocity: f64) -> Self {
        let zone = SafeZone::closed_form(planner).expect("room to move");
        Self { zone, position, velocity, worst: f64::NEG_INFINITY }
    }

    #[track_caller]
    fn step(&mut self, request: impl Into<Request>) {
        let command = self.zone.command(self.position, self.velocity, request);
        let at = (self.position, self.velocity);
        assert_eq!(command.range.status, RangeStatus::Safe, "at {at:?}");
        let step = self.zone.planner().ramp(self.position, self.velocity, command.velocity);
        let step = step.unwrap_or_else(|error| panic!("at {at:?}: {error}"));
        let excess = worst_excess(&step.extrema(), self.zone.planner().limits());
        assert!(excess <= tolerance::LIMIT, "at {at:?}: {excess:e} beyond, {command:?}");
        self.worst = self.worst.max(excess);
        (self.position, self.velocity) = (step.end().position, step.end().velocity);
    }
}

fn with_period(period: f64, shape: Shape, timing: Timing) -> Planner {
    let spec = PlannerSpec { period, ..*planner(shape, timing).spec() };
    Planner::try_from(spec).expect("a period long enough")
}

#[test]
fn a_velocity_command_held_for_200_000_steps_ends_at_rest_at_the_limit_and_stays() {
    for (shape, timing) in ALL {
        for action in [1.0, -1.0] {
            let mut joint = Joint::new(planner(shape, timing), 0.32, 0.0);
            for _ in 0..100_000 {
                joint.step(action);
            }
            let rest = (joint.position, joint.velocity);
            for _ in 0..100_000 {
                joint.step(action);
            }
            assert_eq!((joint.position, joint.velocity), rest, "{shape:?} {timing:?}: drift");
            let side = if action > 0.0 { Side::Upper } else { Side::Lower };
            let limit = if action > 0.0 { POSITION.max } else { POSITION.min };
            let distance = (limit - joint.position).abs();
            assert_eq!(joint.velocity, 0.0);
            assert!(distance <= 1.5 * joint.zone.guard(side), "{shape:?} {timing:?}: {distance:e} m short");
        }
    }
}

#[test]
fn replanned_every_period_with_any_commands_the_joint_stays_inside_every_step() {
    for period in [0.02, 0.05] {
        for (shape, timing) in ALL {
            for adversary in 0..3 {
                let mut joint = Joint::new(with_period(period, shape, timing), 0.32, 0.0);
                let (mut noise, mut action) = (Noise(adversary), 1.0);
                for i in 0..4000 {
                    action = match adversary {
                        0 => 2.0 * noise.unit() - 1.0,
                        1 if i % 97 == 0 => 2.0 * noise.unit() - 1.0,
                        2 if noise.unit() < 0.03 => -action,
                        _ => action,
                    };
                    joint.step(action);
                }
                assert!(
                    joint.worst <= tolerance::LIMIT,
                    "{period} s {shape:?} {timing:?}: {:e}",
                    joint.worst
                );
            }
        }
    }
}

/// A joint at rest on its limit but for what rounding left of its velocity; a peer's position then runs away or its
/// planner fails.
#[test]
fn a_joint_exactly_on_its_limit_with_a_residual_velocity_accepts_held_actions() {
    for (shape, timing) in ALL {
        for residual in [-1.5e-14, 0.0] {
            for action in [-1.0, -0.3, 0.0, 0.3, 1.0] {
                for (limit, sign) in [(POSITION.max, 1.0), (POSITION.min, -1.0)] {
                    let mut joint = Joint::new(with_period(0.1, shape, timing), limit, sign * residual);
                    for _ in 0..40 {
                        joint.step(sign * action);
                        assert!(joint.velocity.is_finite());
                    }
                    let away = sign * (limit - joint.position);
                    if action < 0.0 {
                        assert!(
                            away > 1e-3,
                            "{shape:?} {timing:?} {action}: stuck {away:e} m from the limit"
                        );
                    }
                }
            }
        }
    }
}

/// Positions and velocities at a boundary, one ulp either side of it.
#[test]
fn an_ulp_at_a_boundary_changes_nothing_but_an_ulp() {
    let beside = |x: f64| [x.next_down(), x, x.next_up()];
    for (shape, timing) in ALL {
        let planner = planner(shape, timing);
        let zone = SafeZone::closed_form(planner).unwrap();
        let bounds = planner.velocity();
        let delta = planner.authority(jbtg::Direction::Decreasing).velocity_change;
        for velocity in [0.0, bounds.max, bounds.min, delta, -delta, 2.0 * delta].into_iter().flat_map(beside)
        {
            let stop = velocity.signum() * zone.stopping_distance(velocity);
            let ends = [
                POSITION.max - stop.max(0.0),
                POSITION.min - stop.min(0.0),
                POSITION.max - zone.guard(Side::Upper) - stop.max(0.0),
                POSITION.min + zone.guard(Side::Lower) - stop.min(0.0),
            ];
            for position in ends.into_iter().flat_map(beside) {
                for action in [-1.0, 0.0, 1.0] {
                    let (mut position, mut velocity) = (position, velocity);
                    for _ in 0..12 {
                        let command = zone.command(position, velocity, action);
                        let step = planner.ramp(position, velocity, command.velocity).unwrap();
                        let found = step.extrema().position;
                        let excess = (found.max - POSITION.max).max(POSITION.min - found.min);
                        assert!(
                            excess <= tolerance::LIMIT * POSITION.width(),
                            "{shape:?} {timing:?} at ({position:e}, {velocity:e}): {excess:e}"
                        );
                        (position, velocity) = (step.end().position, step.end().velocity);
                    }
                }
            }
        }
    }
}

/// Targets far beyond reach that change sign in every period, limits orders of magnitude apart and unequal, velocities of an
/// ulp or less.
#[test]
fn targets_beyond_reach_and_limits_orders_apart_are_ordinary() {
    let cases = [
        // (position, velocity, acceleration, jerk, period)
        ([-1.0, 1.0], [-2.0, 2.0], [-5.0, 5.0], [-50.0, 50.0], 0.2),
        ([-3.0, 3.0], [-0.1, 1.5], [-0.2, 4.0], [-4.0, 30.0], 0.3),
        ([0.0, 1e-3], [-1e3, 1e3], [-1e4, 1e4], [-1e7, 1e7], 0.004),
        ([-1e3, 1e3], [-1e-3, 1e-3], [-1e-2, 1e-2], [-1.0, 1.0], 0.05),
    ];
    let interval = |[min, max]: [f64; 2]| Interval::new(min, max);
    for (position, velocity, acceleration, jerk, period) in cases {
        let limits = LimitsSpec {
            position: interval(position),
            velocity: interval(velocity),
            acceleration: interval(acceleration),
            jerk: interval(jerk),
        };
        let limits = Limits::try_from(limits).unwrap();
        for shape in [Shape::Smoothstep, Shape::SineQuintic] {
            for timing in ALL_TIMINGS {
                let planner = Planner::try_from(PlannerSpec { limits, shape, timing, period }).unwrap();
                let middle = 0.5 * (position[0] + position[1]);
                for velocity in [0.0, 1e-16, -1e-16, 5e-324] {
                    let mut joint = Joint::new(planner, middle, velocity);
                    for i in 0..400 {
                        joint.step(if i % 2 == 0 { 1e300 } else { -1e300 });
                    }
                    for _ in 0..400 {
                        joint.step(1e300);
                    }
                }
            }
        }
    }
}
