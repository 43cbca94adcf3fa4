//! [P, Alg. 3] against an independent optimum: a direct search over everything that a detour may choose, in code that
//! shares nothing with the planner.

use jbtg::strategies::planners;
use jbtg::{Direction, Interval, Limits, LimitsSpec, Planner, PlannerSpec, Shape};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

use crate::properties::within;
use crate::tolerance;

/// Displacement of a smoothstep ramp, acceleration 0 to A in T from rest, per A·T².
const RISING: f64 = 0.15;
/// Duration of a smoothstep ramp per A/J.
const RAMP_TIME: f64 = 1.5;

/// One waypoint problem upwards: the largest displacement from v1 to v2 in `period`.
#[derive(Clone, Copy, Debug)]
struct Problem {
    v1: f64,
    v2: f64,
    highest: f64,
    period: f64,
    acceleration: Interval,
    jerk: Interval,
}

/// A pulse with ramps as short as the jerk bounds allow for its peak acceleration (a magnitude).
#[derive(Clone, Copy, Debug)]
struct Pulse {
    acceleration: f64,
    up: f64,
    cruise: f64,
    down: f64,
}

impl Pulse {
    /// The pulse for a velocity change `dv` at `share` of the largest peak acceleration that it can have.
    fn new(dv: f64, share: f64, limit: f64, (jerk_up, jerk_down): (f64, f64)) -> Self {
        let per_acceleration = RAMP_TIME / jerk_up + RAMP_TIME / jerk_down;
        let acceleration = share * limit.min((2.0 * dv / per_acceleration).sqrt());
        if acceleration <= 0.0 {
            return Self { acceleration: 0.0, up: 0.0, cruise: 0.0, down: 0.0 };
        }
        let (up, down) = (RAMP_TIME * acceleration / jerk_up, RAMP_TIME * acceleration / jerk_down);
        Self { acceleration, up, cruise: (dv / acceleration - 0.5 * (up + down)).max(0.0), down }
    }

    fn time(&self) -> f64 {
        self.up + self.cruise + self.down
    }

    /// Distance from velocity `v` on, quintic by quintic; `sign` is that of the acceleration.
    fn distance(&self, v: f64, sign: f64) -> f64 {
        let a = sign * self.acceleration;
        let rising = self.up * (v + RISING * a * self.up);
        let v = v + 0.5 * a * self.up;
        let cruise = self.cruise * (v + 0.5 * a * self.cruise);
        let v = v + a * self.cruise;
        rising + cruise + self.down * (v + (0.5 - RISING) * a * self.down)
    }
}

impl Problem {
    fn pulses(&self, peak: f64, shares: [f64; 2]) -> [Pulse; 2] {
        let Interval { min, max } = self.jerk;
        [
            Pulse::new(peak - self.v1, shares[0], self.acceleration.max, (max, -min)),
            Pulse::new(peak - self.v2, shares[1], -self.acceleration.min, (-min, max)),
        ]
    }

    /// The displacement by way of `peak` at these shares of the peak accelerations, if there is time for it.
    fn displacement(&self, peak: f64, shares: [f64; 2]) -> Option<f64> {
        let [rise, fall] = self.pulses(peak, shares);
        let cruise = self.period - rise.time() - fall.time();
        (cruise >= 0.0).then(|| rise.distance(self.v1, 1.0) + cruise * peak + fall.distance(peak, -1.0))
    }

    /// The highest peak that there is time for at these shares, by halving. `None` if not even the direct ramp fits.
    fn highest_peak(&self, shares: [f64; 2]) -> Option<f64> {
        let fits = |peak: f64| self.displacement(peak, shares).is_some();
        let (mut low, mut high) = (self.v1.max(self.v2), self.highest);
        if fits(high) {
            return Some(high);
        }
        if !fits(low) {
            return None;
        }
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if fits(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(low)
    }

    /// The displacement at (share of the rise's and of the fall's peak acceleration, share of the way to v_peak), all
    /// in [0, 1].
    fn value(&self, [rise, fall, way]: [f64; 3]) -> f64 {
        let shares = [rise, fall];
        let lowest = self.v1.max(self.v2);
        let Some(highest) = self.highest_peak(shares) else { return f64::NEG_INFINITY };
        self.displacement(lowest + way * (highest - lowest), shares).unwrap_or(f64::NEG_INFINITY)
    }

    /// The largest displacement that a direct search finds from several starts.
    fn optimum(&self) -> f64 {
        let starts = [[1.0, 1.0, 1.0], [0.7, 0.7, 1.0], [0.9, 0.9, 0.5], [1.0, 0.6, 0.8], [0.6, 1.0, 0.8]];
        starts.into_iter().map(|start| self.climb(start)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Hooke and Jeeves: moves along each axis, then along the direction of success, with halving steps.
    fn climb(&self, start: [f64; 3]) -> f64 {
        let (mut point, mut best, mut step) = (start, self.value(start), 0.25);
        while step > 1e-7 {
            let (from, before) = (point, best);
            for axis in 0..3 {
                for sign in [1.0, -1.0] {
                    let mut moved = point;
                    moved[axis] = (moved[axis] + sign * step).clamp(1e-3, 1.0);
                    let value = self.value(moved);
                    if value > best {
                        (point, best) = (moved, value);
                    }
                }
            }
            let further = std::array::from_fn(|i| (2.0 * point[i] - from[i]).clamp(1e-3, 1.0));
            let value = self.value(further);
            if value > best {
                (point, best) = (further, value);
            }
            if best <= before {
                step *= 0.5;
            }
        }
        best
    }

    fn scale(&self) -> f64 {
        self.period * self.highest.max(-self.v1).max(-self.v2)
    }
}

fn equal_jerk(planner: &Planner) -> Option<Planner> {
    let limits = planner.limits();
    let spec = LimitsSpec {
        position: limits.position(),
        velocity: limits.velocity(),
        acceleration: limits.acceleration(),
        jerk: Interval::symmetric(limits.jerk().max),
    };
    let limits = Limits::try_from(spec).ok()?;
    Planner::try_from(PlannerSpec { limits, ..*planner.spec() }).ok()
}

/// Relative gain of the direct search over the planner, for `count` random problems in both directions; the planner's
/// own choice is checked to be feasible and to be what the trajectory does.
fn gains(count: usize, way: Way, change: impl Fn(&Planner) -> Option<Planner>) -> Vec<f64> {
    let mut runner = TestRunner::deterministic();
    let share = || prop_oneof![1 => Just(0.0), 1 => Just(1.0), 6 => 0.0..=1.0];
    let strategy = (planners(), share(), share());
    let mut gains = Vec::with_capacity(count);
    while gains.len() < count {
        let (planner, v1, v2) = strategy.new_tree(&mut runner).expect("a problem").current();
        let spec = PlannerSpec { shape: Shape::Smoothstep, ..*planner.spec() };
        let Some(planner) = Planner::try_from(spec).ok().and_then(|planner| change(&planner)) else {
            continue;
        };
        let v1 = within(planner.velocity(), v1);
        let v2 = within(planner.reachable(v1), v2);
        for direction in [Direction::Increasing, Direction::Decreasing] {
            gains.extend(gain(&planner, (v1, v2), direction, way));
        }
    }
    gains
}

/// Whether the planner's way is the one of the largest v_peak, or the one of the largest displacement.
#[derive(Clone, Copy, PartialEq)]
enum Way {
    Peak,
    Farthest,
}

fn gain(planner: &Planner, (v1, v2): (f64, f64), direction: Direction, way: Way) -> Option<f64> {
    let limits = planner.limits();
    let sign = if direction == Direction::Increasing { 1.0 } else { -1.0 };
    let upwards =
        |interval: Interval| if sign > 0.0 { interval } else { Interval::new(-interval.max, -interval.min) };
    let problem = Problem {
        v1: sign * v1,
        v2: sign * v2,
        highest: upwards(limits.velocity()).max,
        period: planner.period(),
        acceleration: upwards(limits.acceleration()),
        jerk: upwards(limits.jerk()),
    };
    let step = match way {
        Way::Peak => planner.waypoint_towards(0.0, v1, v2, direction),
        Way::Farthest => planner.farthest(0.0, v1, v2, direction),
    };
    let ours = sign * step.expect("a reachable velocity").end().position;
    if way == Way::Peak {
        let detour = planner.detour(v1, v2, direction).expect("a reachable velocity");
        check_peak(&problem, sign * detour.peak, ours);
    }
    // A stretched step near the edge of what is reachable may be no member of the family: nothing to compare.
    let optimum = problem.optimum();
    optimum.is_finite().then(|| (optimum - ours) / problem.scale())
}

/// Checks that there is time to go through `peak` and that `ours` is the displacement on the way.
fn check_peak(problem: &Problem, peak: f64, ours: f64) {
    let [rise, fall] = problem.pulses(peak, [1.0; 2]);
    let time = rise.time() + fall.time();
    assert!(time <= problem.period * (1.0 + 1e-12), "{time:e} s of {problem:?} through {peak}");
    let cruise = problem.period - time;
    let expected = rise.distance(problem.v1, 1.0) + cruise * peak + fall.distance(peak, -1.0);
    let error = (ours - expected).abs() / problem.scale();
    assert!(error <= 1e-12, "{ours:e} instead of {expected:e} for {problem:?} through {peak}");
}

fn largest(gains: &[f64]) -> f64 {
    gains.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn no_motion_of_the_family_leads_farther() {
    let largest = largest(&gains(4000, Way::Farthest, |planner| Some(*planner)));
    assert!(largest <= tolerance::OPTIMUM, "a direct search gains {largest:e}");
}

#[test]
fn with_equal_jerk_bounds_the_largest_peak_velocity_leads_farthest() {
    let largest = largest(&gains(4000, Way::Peak, equal_jerk));
    assert!(largest <= tolerance::OPTIMUM, "a direct search gains {largest:e}");
}

#[test]
fn with_unequal_jerk_bounds_a_smaller_peak_acceleration_gains_little_on_the_largest_peak_velocity() {
    let gains = gains(4000, Way::Peak, |planner| Some(*planner));
    let largest = largest(&gains);
    let mean = gains.iter().map(|gain| gain.max(0.0)).sum::<f64>() / gains.len() as f64;
    assert!(largest <= 2e-2 && mean <= 1e-4, "a direct search gains {largest:e}, {mean:e} on average");
    assert!(
        largest > tolerance::OPTIMUM,
        "the largest peak velocity leads farthest: say so in `Planner::farthest`"
    );
}
