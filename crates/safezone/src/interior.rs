//! Limits that the interior of a step crosses although both its ends keep them.

use crate::math::{larger, smaller, sqrt};
use crate::side::{Braking, Turning};
use crate::turns::Turns;

/// Bound of the share of a ramp, and so of a period, in which the sine's quintic moves against its own direction.
const REVERSAL_SHARE: f64 = 0.06;

/// Most Newton steps; each that leaves its bracket halves it.
const ROUNDS: u32 = 60;

impl Braking {
    /// Least velocity whose step does not come nearer to the limit, anywhere inside it, than braking at once would
    /// or than the guard allows [rad/s or m/s]. At least `lowest`, at most the `brake` velocity.
    ///
    /// Two things can happen. A ramp that starts against its own direction
    /// ([`Shape::SineQuintic`](jbtg::Shape)) first moves towards the limit. And with
    /// [`Timing::Fastest`](jbtg::Timing) a step that changes the velocity's sign starts the more slowly the larger it
    /// is, so that it turns later than a step to zero.
    #[inline]
    pub(crate) fn min_velocity(
        &self,
        turns: Option<&Turns>,
        (position, velocity): (f64, f64),
        (lowest, brake): (f64, f64),
    ) -> f64 {
        let turns_late = velocity > 0.0 && !self.stretched;
        if !turns_late && self.reverse == 0.0 || lowest >= brake {
            return lowest;
        }
        // A turning point is no farther than at that mean velocity: for the largest change without a cruise its way per velocity
        // grows with the velocity, up to that change, and then is the lag of braking.
        let lasting = if turns_late { self.brake.mean_of_ramps } else { self.period };
        let kept = self.limit - 0.5 * self.guard;
        if position + larger(velocity, 0.0) * lasting + self.overshoot <= kept {
            return lowest;
        }
        let change = if turns_late {
            self.largest_turning(turns, velocity, kept - position)
        } else {
            self.largest_reversing(position, velocity, kept)
        };
        smaller(larger(velocity - change, lowest), brake)
    }

    /// Largest change of a step whose start, against its own direction, stays within `kept` or, from rest near the limit
    /// or beyond it, within what the shape cannot do without.
    ///
    /// The reversal is over within a twentieth of the ramp and goes at most `reverse` per velocity change beyond motion
    /// at the first velocity. After it a larger change lies pointwise below a smaller one.
    #[inline(never)]
    fn largest_reversing(&self, position: f64, velocity: f64, kept: f64) -> f64 {
        let needed = match (self.is_outside(position), velocity > 0.0) {
            (true, true) => 0.0,
            // The way back must not wait for the overshoot to fit.
            (true, false) => self.overshoot,
            (false, _) => 1e-13 * self.width,
        };
        let room = larger(kept - position, self.distance(velocity) + needed);
        let reached = REVERSAL_SHARE * self.period * larger(velocity, 0.0);
        (room - reached) / self.reverse
    }

    /// Largest change of a step that turns within `travel`, or no later than braking at once, where `velocity` > 0 and the
    /// timing is [`Timing::Fastest`](jbtg::Timing).
    ///
    /// As the change grows from `velocity` on, the turning point first recedes and then advances, until the step has a
    /// cruise; from there on the way to the turning point is the same for all. So the admissible changes are those up to the
    /// one at which the turning point, as it advances, meets what is allowed. If braking itself has a cruise no
    /// turning point advances.
    #[inline]
    fn largest_turning(&self, turns: Option<&Turns>, velocity: f64, travel: f64) -> f64 {
        let change = match turns {
            Some(turns) => turns.change(velocity, travel),
            None => self.change_turning_within(velocity, travel),
        };
        if change < self.brake.ramps_only { change } else { f64::INFINITY }
    }

    /// The largest change of a step without a cruise that turns within `travel`, in closed form.
    #[inline(never)]
    fn change_turning_within(&self, velocity: f64, travel: f64) -> f64 {
        if velocity >= self.brake.ramps_only {
            return velocity;
        }
        let travel = larger(travel, self.distance(velocity));
        let turning = &self.turning;
        // A·T²-like scale: every turning point is a multiple of it that depends on where in the pulse it lies.
        let scale = velocity * sqrt(velocity * turning.rising_per_acceleration);
        velocity * turning.change(travel / scale)
    }
}

impl Turning {
    /// The largest velocity change of a step without a cruise that turns within `travel`, as a multiple of the velocity
    /// at its start.
    ///
    /// `travel` is in multiples of v·√(v·T/A) with v that velocity and T/A the rising ramp's duration per acceleration, and at
    /// least what braking to zero covers.
    pub(crate) fn change(&self, travel: f64) -> f64 {
        let ramp = Ramp::at(self.shape, 1.0);
        if travel >= ramp.advance / (ramp.gain * sqrt(ramp.gain)) {
            self.change_turning_while_rising(travel)
        } else {
            self.change_turning_while_falling(travel)
        }
    }

    /// The turning point lies at u in the rising ramp: there, v is what the ramp has taken away, so its size follows from
    /// u, and the travel is a/b^1.5 with the two polynomials of [`Ramp`]. It grows as u falls.
    fn change_turning_while_rising(&self, travel: f64) -> f64 {
        let value = |u: f64| {
            let ramp = Ramp::at(self.shape, u);
            if ramp.gain <= 0.0 {
                return (f64::INFINITY, 1.0, ramp);
            }
            let excess = ramp.advance - travel * ramp.gain * sqrt(ramp.gain);
            (excess, ramp.advance_slope - 1.5 * ramp.advance * ramp.gain_slope / ramp.gain, ramp)
        };
        // Where the smoothstep's travel would be 0.75/√u, as it is for small u.
        let start = (0.5625 / (travel * travel)).min(1.0);
        let u = newton(start, true, |u| {
            let (excess, slope, _) = value(u);
            (excess, slope)
        });
        let gain = Ramp::at(self.shape, u).gain;
        0.5 * (1.0 + self.ratio) / (u * u * gain)
    }

    /// The turning point lies at u before the end of the falling ramp, in shares of its duration.
    fn change_turning_while_falling(&self, travel: f64) -> f64 {
        let u = newton(1.0, false, |u| {
            let (taken, advance, slope) = self.while_falling(u);
            (advance - travel * taken * sqrt(taken), slope)
        });
        0.5 * (1.0 + self.ratio) / self.while_falling(u).0
    }

    /// With the turning point at u before the end of the falling ramp: m and N of Lemma 4 in `docs/guarantee.md`, and the
    /// derivative of N/m^1.5 times m^1.5.
    fn while_falling(&self, u: f64) -> (f64, f64, f64) {
        let [c3, c4, c5] = self.shape;
        let displacement = c3 + c4 + c5;
        let (r, whole) = (self.ratio, 1.0 + self.ratio);
        let left = u * u * Ramp::at(self.shape, u).gain; // r times this of the change comes after the turning point
        let left_slope = u * (6.0 * c3 + u * (12.0 * c4 + u * (20.0 * c5)));
        let gone = u * u * u * (c3 + u * (c4 + u * c5));
        let taken = 0.5 * whole - r * left;
        let lag = whole * ((0.5 - displacement) + displacement * r);
        let advance = lag - r * left * (whole - r * u) - r * r * gone;
        (taken, advance, r * left_slope * (1.5 * advance / taken - (whole - r * u)))
    }
}

/// The ramp's polynomials at u: with v(u) the velocity that it has taken away and p(u) the position, `gain` is v/u² and
/// `advance` (u·v − p)/u³; with their derivatives.
#[derive(Clone, Copy, Debug)]
struct Ramp {
    gain: f64,
    gain_slope: f64,
    advance: f64,
    advance_slope: f64,
}

impl Ramp {
    #[inline]
    fn at([c3, c4, c5]: [f64; 3], u: f64) -> Self {
        Self {
            gain: 3.0 * c3 + u * (4.0 * c4 + u * (5.0 * c5)),
            gain_slope: 4.0 * c4 + u * (10.0 * c5),
            advance: 2.0 * c3 + u * (3.0 * c4 + u * (4.0 * c5)),
            advance_slope: 3.0 * c4 + u * (8.0 * c5),
        }
    }
}

/// The root in (0, 1] of `function`, which gives excess and slope, by Newton steps from `start` within a bracket; the excess
/// is positive below the root if `falls`, else above it.
#[inline]
fn newton(start: f64, falls: bool, function: impl Fn(f64) -> (f64, f64)) -> f64 {
    let (mut low, mut high, mut u) = (0.0, 1.0, start);
    for _ in 0..ROUNDS {
        let (excess, slope) = function(u);
        if (excess > 0.0) == falls {
            low = u
        } else {
            high = u
        }
        let next = u - excess / slope;
        let inside = low < next && next < high;
        let next = if inside { next } else { 0.5 * (low + high) };
        if (next - u).abs() <= 2.0 * f64::EPSILON * u {
            return next;
        }
        u = next;
    }
    u
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use jbtg::{Direction, Interval, Limits, LimitsSpec, Planner, PlannerSpec, Shape, Timing};

    use super::{REVERSAL_SHARE, Ramp, Turning, newton};
    use crate::side::{Braking, Side};

    fn position([c3, c4, c5]: [f64; 3], u: f64) -> f64 {
        u * u * u * (c3 + u * (c4 + u * c5))
    }

    #[test]
    fn the_reversal_is_over_within_its_share() {
        let shape = Shape::SineQuintic.coefficients();
        assert!(position(shape, 0.8 * REVERSAL_SHARE) < 0.0 && position(shape, REVERSAL_SHARE) > 0.0);
    }

    /// Lemma 4 of `docs/guarantee.md`: as the change grows, the turning point first recedes, then advances.
    #[test]
    fn a_turning_point_recedes_once_and_then_advances_as_the_change_grows() {
        for shape in [Shape::Smoothstep, Shape::SineQuintic].map(Shape::coefficients) {
            for ratio in [0.1, 0.2, 0.5, 0.77, 1.0, 1.5, 4.0, 10.0] {
                let turning = Turning { shape, ratio, rising_per_acceleration: 1.0 };
                // But for the sine's reversal, which braking has as well.
                let falling = (60..=1000).map(|i| turning.while_falling(f64::from(i) / 1000.0));
                let heights: Vec<f64> =
                    falling.map(|(taken, advance, _)| advance / taken.powf(1.5)).collect();
                let rises: Vec<bool> = heights.windows(2).map(|pair| pair[1] > pair[0]).collect();
                let turns = rises.windows(2).filter(|pair| pair[0] != pair[1]).count();
                assert!(rises[rises.len() - 1] && turns <= 1, "{shape:?} {ratio}: {turns} turns");
                let rising = (1..=1000).rev().map(|i| Ramp::at(shape, f64::from(i) / 1000.0));
                let heights: Vec<f64> = rising
                    .take_while(|ramp| ramp.gain > 0.0)
                    .map(|ramp| ramp.advance / ramp.gain.powf(1.5))
                    .collect();
                assert!(heights.windows(2).all(|pair| pair[1] > pair[0]), "{shape:?}");
            }
        }
    }

    /// Checks a derivative at the middle of a small interval.
    #[track_caller]
    fn check_slope(slope: f64, function: impl Fn(f64) -> f64, u: f64) {
        let h = 1e-5;
        let expected = (function(u + h) - function(u - h)) / (2.0 * h);
        assert!((slope - expected).abs() <= 1e-8 * (1.0 + expected.abs()), "{slope} for {expected} at {u}");
    }

    #[test]
    fn a_ramp_has_the_slopes_of_its_polynomials() {
        for shape in [Shape::Smoothstep, Shape::SineQuintic].map(Shape::coefficients) {
            for u in (1..100).map(|i| 0.01 * f64::from(i)) {
                let ramp = Ramp::at(shape, u);
                check_slope(u * u * ramp.gain, |u| position(shape, u), u);
                check_slope(ramp.gain_slope, |u| Ramp::at(shape, u).gain, u);
                check_slope(ramp.advance_slope, |u| Ramp::at(shape, u).advance, u);
                for ratio in [0.1, 0.5, 1.0, 3.0] {
                    let turning = Turning { shape, ratio, rising_per_acceleration: 1.0 };
                    let (taken, _, slope) = turning.while_falling(u);
                    let height = |u| {
                        let (at_u, advance, _) = turning.while_falling(u);
                        advance * (taken / at_u).powf(1.5)
                    };
                    check_slope(slope, height, u);
                }
            }
        }
    }

    /// Steps of the planner that turn later than braking, in either ramp, against the change found from where they turn.
    #[test]
    fn a_step_that_turns_where_it_may_has_the_largest_change() {
        let mut falling = 0;
        for (shape, jerk) in [Shape::Smoothstep, Shape::SineQuintic].into_iter().flat_map(|shape| {
            [(-100.0, 100.0), (-100.0, 11.0), (-20.0, 100.0), (-30.0, 100.0), (-11.0, 100.0)]
                .map(|jerk| (shape, jerk))
        }) {
            let limits = Limits::try_from(LimitsSpec {
                position: Interval::symmetric(1.0),
                velocity: Interval::symmetric(0.5),
                acceleration: Interval::symmetric(1.0),
                jerk: Interval::new(jerk.0, jerk.1),
            })
            .expect("limits");
            let planner =
                Planner::try_from(PlannerSpec { limits, shape, timing: Timing::Fastest, period: 0.3 })
                    .expect("a period");
            let turning = Braking::new(&planner, Side::Upper).turning;
            let velocity = 0.3 * planner.authority(Direction::Decreasing).ramps_only;
            let scale = velocity * (velocity * turning.rising_per_acceleration).sqrt();
            for change in (101..=330).map(|i| 0.01 * f64::from(i) * velocity) {
                let step = planner.ramp(0.0, velocity, velocity - change).expect("a step without a cruise");
                let travel = step.extrema().position.max;
                if travel > planner.displacement(velocity, 0.0) * (1.0 + 1e-5) {
                    let found = velocity * turning.change(travel / scale);
                    assert!(
                        (found - change).abs() <= 1e-8 * change,
                        "{found} for {change}, {shape:?}, {jerk:?}"
                    );
                    let taken = 0.5 * (1.0 + turning.ratio) * velocity / change;
                    falling += usize::from(taken > 0.5);
                }
            }
        }
        assert!(falling > 10, "{falling} turn in the falling ramp");
    }

    /// Halving alone would take more than fifty.
    #[test]
    fn newton_takes_few_evaluations() {
        for (start, falls) in [(1.0, false), (0.1, false), (1.0, true), (0.1, true)] {
            let evaluations = Cell::new(0);
            let sign = if falls { -1.0 } else { 1.0 };
            let root = newton(start, falls, |u| {
                evaluations.set(evaluations.get() + 1);
                (sign * (u * u - 0.3), sign * 2.0 * u)
            });
            assert!((root - 0.3_f64.sqrt()).abs() <= 4.0 * f64::EPSILON, "{root}");
            assert!(evaluations.get() <= 35, "{}", evaluations.get());
        }
    }
}
