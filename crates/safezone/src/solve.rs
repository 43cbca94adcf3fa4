//! The largest velocity whose step still leaves room to brake.

use crate::curve::Curve;
use crate::math::{floor, smaller};
use crate::side::{Braking, Line};

/// Most Newton steps; each that leaves its bracket halves it, so that these suffice for the whole of double precision.
const ROUNDS: u32 = 100;

impl Braking {
    /// What rounding may add on the way from beyond the other limit to this one, since the guard counts the steps from that
    /// limit on; 0 within the limits, and no more than half of the way to that limit, so that it is never out of reach
    /// [rad or m].
    #[inline]
    pub(crate) fn rounding_of_the_way_in(&self, position: f64) -> f64 {
        let beyond = self.limit - self.width - position;
        if beyond > 0.0 {
            smaller(self.rounding_over(self.width + beyond, position.abs()), 0.5 * beyond)
        } else {
            0.0
        }
    }

    /// Stopping distance from `velocity` and its slope, from `table` if there is one [rad or m, s].
    #[inline]
    fn distance_and_slope(&self, table: Option<&Curve<'_>>, velocity: f64) -> (f64, f64) {
        match table {
            Some(curve) => curve.distance_and_slope(velocity),
            None => (self.distance(velocity), self.distance_slope(velocity)),
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
    pub(crate) fn solve_stretched(&self, table: Option<&Curve<'_>>, start: f64, room: f64) -> f64 {
        let velocity = self.solve_linear(&self.downwards, table, start, room);
        if velocity > start && self.upwards.lag != self.downwards.lag {
            self.solve_linear(&self.upwards, table, start, room)
        } else {
            velocity
        }
    }

    /// The velocity at which the travel is `room`, if all steps were `line`'s.
    #[inline]
    fn solve_linear(&self, line: &Line, table: Option<&Curve<'_>>, start: f64, room: f64) -> f64 {
        let rest = room - line.lag * start;
        if rest <= 0.0 {
            return rest * line.per_gain;
        }
        let steps = self.steps_within(line, rest);
        let Some(curve) = table else {
            let (velocity, sum, slope) = self.knot(line, smaller(floor(steps).0, self.most_steps));
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
    pub(crate) fn solve_fastest(
        &self,
        table: Option<&Curve<'_>>,
        start: f64,
        (mut low, mut high): (f64, f64),
        room: f64,
    ) -> f64 {
        let travel = |velocity: f64| {
            let (distance, slope) = self.distance_and_slope(table, velocity);
            let step = self.displacement(start, velocity);
            (step + distance - room, self.displacement_slope(start, velocity) + slope)
        };
        if travel(high).0 <= 0.0 {
            return high;
        }
        if travel(low).0 >= 0.0 {
            return low;
        }
        let tolerance = 0.125 * self.rounding;
        let mut velocity = self.solve_stretched(None, start, room);
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
}
