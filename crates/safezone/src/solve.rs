//! The largest velocity whose step still leaves room to brake.

use jbtg::Interval;

use crate::curve::Curve;
use crate::math::{larger, smaller};
use crate::sampled::Sampled;
use crate::side::{Braking, Line};

/// Most Newton steps; each that leaves its bracket halves it, so that these suffice for the whole of double precision.
const ROUNDS: u32 = 100;

/// One limit, seen from one state; mirrored coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Approach<'a> {
    pub(crate) braking: &'a Braking,
    /// The table that braking distances are read from, if not their closed form.
    pub(crate) table: Option<&'a Curve<'a>>,
    /// Samples of the steps, if the range is taken from them.
    pub(crate) sampled: Option<&'a Sampled>,
    /// Position [rad or m].
    pub(crate) position: f64,
    /// Velocity [rad/s or m/s].
    pub(crate) velocity: f64,
    /// Velocities that one period can reach [rad/s or m/s].
    pub(crate) reachable: Interval,
    /// The braking velocity, one of them [rad/s or m/s].
    pub(crate) brake: f64,
}

impl Approach<'_> {
    /// Largest reachable velocity after which braking still stops before the limit, or the braking velocity if there
    /// is none [rad/s or m/s].
    ///
    /// The travel until rest, of the step and of braking after it, grows with the velocity, so the admissible velocities
    /// form an interval from below.
    #[inline]
    pub(crate) fn max_velocity(&self) -> f64 {
        let braking = self.braking;
        let highest = self.reachable.max;
        let way_in = self.rounding_of_the_way_in();
        if way_in == 0.0 && braking.is_far(self.position) && self.velocity <= braking.velocity {
            return highest;
        }
        let room = braking.limit - braking.guard - way_in - self.position;
        let velocity = match self.sampled {
            Some(sampled) => sampled.max_velocity(self.velocity, room),
            None if braking.stretched => self.solve_stretched(room),
            None => self.solve_fastest(room),
        };
        smaller(larger(velocity, self.brake), highest)
    }

    /// What rounding may add on the way from beyond the other limit to this one, since the guard counts the steps from that
    /// limit on; 0 within the limits, and no more than half of the way to that limit, so that it is never out of reach
    /// [rad or m].
    #[inline]
    fn rounding_of_the_way_in(&self) -> f64 {
        let braking = self.braking;
        let beyond = braking.limit - braking.width - self.position;
        if beyond > 0.0 {
            smaller(braking.rounding_over(braking.width + beyond, self.position.abs()), 0.5 * beyond)
        } else {
            0.0
        }
    }

    /// Stopping distance from `velocity` and its slope [rad or m, s].
    #[inline]
    fn distance_and_slope(&self, velocity: f64) -> (f64, f64) {
        match self.table {
            Some(curve) => curve.distance_and_slope(velocity),
            None => (self.braking.distance(velocity), self.braking.distance_slope(velocity)),
        }
    }

    /// The velocity at which the travel is `room`, in closed form.
    ///
    /// With [`Timing::Stretched`](jbtg::Timing) the step covers T·v′ − l·(v′ − v), one l for velocities above v and one for
    /// those below (the two agree at v, so that either tells on which side the solution lies), and the stopping
    /// distance is linear between braking steps. So the travel at braking steps lies on a parabola, which tells
    /// between which two the solution is. An index that rounding puts off by one costs nothing, since neighbouring
    /// lines meet there.
    #[inline]
    fn solve_stretched(&self, room: f64) -> f64 {
        let (downwards, upwards) = (&self.braking.downwards, &self.braking.upwards);
        let velocity = self.solve_linear(downwards, room);
        if velocity > self.velocity && upwards.lag != downwards.lag {
            self.solve_linear(upwards, room)
        } else {
            velocity
        }
    }

    /// The velocity at which the travel is `room`, if all steps were `line`'s.
    #[inline]
    fn solve_linear(&self, line: &Line, room: f64) -> f64 {
        let rest = room - line.lag * self.velocity;
        if rest <= 0.0 {
            return rest * line.per_gain;
        }
        let steps = self.braking.steps_within(line, rest);
        let Some(curve) = self.table else {
            let (velocity, sum, slope) =
                self.braking.knot(line, smaller(whole_steps(steps), self.braking.most_steps));
            return velocity + (rest - sum) / slope;
        };
        let (velocity, distance, slope) = curve.segment(steps as u32);
        let sum = line.gain * velocity + distance;
        // From beyond the other limit there is more room than the table knows distances for.
        smaller(velocity + (rest - sum) / (line.gain + slope), curve.last_velocity())
    }

    /// The velocity at which the travel is `room`, by Newton steps within a bracket, from the safe side.
    ///
    /// They start where the travel would be `room` if every step had the largest one's mean lag.
    #[inline(never)]
    fn solve_fastest(&self, room: f64) -> f64 {
        let travel = |velocity: f64| {
            let (distance, slope) = self.distance_and_slope(velocity);
            let step = self.braking.displacement(self.velocity, velocity);
            (step + distance - room, self.braking.displacement_slope(self.velocity, velocity) + slope)
        };
        let (mut low, mut high) = (self.brake, self.reachable.max);
        if travel(high).0 <= 0.0 {
            return high;
        }
        if travel(low).0 >= 0.0 {
            return low;
        }
        let tolerance = 0.125 * self.braking.rounding;
        let mut velocity = self.guess(room);
        for _ in 0..ROUNDS {
            if !(low < velocity && velocity < high) {
                velocity = 0.5 * (low + high);
                if velocity <= low || velocity >= high {
                    break;
                }
            }
            let (excess, slope) = travel(velocity);
            if excess.abs() <= tolerance {
                return velocity;
            }
            if excess < 0.0 {
                low = velocity;
            } else {
                high = velocity;
            }
            velocity -= excess / slope;
        }
        low
    }

    fn guess(self, room: f64) -> f64 {
        Approach { table: None, ..self }.solve_stretched(room)
    }
}

/// Rounds `steps` > −0.5 down, the quick way; an integer may come out as the one below.
#[inline]
fn whole_steps(steps: f64) -> f64 {
    const SHIFT: f64 = 1.5 / f64::EPSILON; // numbers of its size have no fraction
    steps - 0.5 + SHIFT - SHIFT
}
