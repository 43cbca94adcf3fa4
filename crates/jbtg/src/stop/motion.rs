//! The quickest way to rest from any state, phase by phase.
//!
//! Every phase is a cubic in acceleration that ends without jerk: from (a₀, j₀) to (a₁, 0) in T, a quintic in
//! position. With d = a₁ − a₀ its jerk is (1 − u)·(j₀ + g·u), g = 6d/T − 3j₀, whose extremum (j₀ + g)²/(4g) gives the
//! least T for a jerk bound J along d: 3|d|/(J + j + √(J(J − j))), j the part of j₀ along d. For j₀ = 0 that is the
//! smoothstep's 1.5·|d|/J.

use crate::math::sqrt;
use crate::pulse::GUARD;
use crate::segment::{Segment, State};
use crate::{Limits, Trajectory};

/// Velocity left at the end of a ramp that counts as rounding, relative to what went into it.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Magnitudes of the bounds in the frame in which braking lowers the velocity.
#[derive(Clone, Copy, Debug)]
struct Frame {
    /// 1, or −1 where braking raises the velocity.
    sign: f64,
    /// Largest deceleration.
    brake: f64,
    /// Jerk that lowers the acceleration.
    down: f64,
    /// Jerk that raises it.
    up: f64,
    /// Time per deceleration of the ramp that ends braking.
    release: f64,
}

/// A stop under construction: the segments so far and the state after them.
pub(super) struct Motion {
    trajectory: Trajectory,
    state: State,
    time: f64,
    forward: Frame,
    backward: Frame,
    /// Shortest time that jerk is given to vanish in \[s\].
    shortest: f64,
}

impl Frame {
    fn new(sign: f64, limits: &Limits, steepest: f64) -> Self {
        let (acceleration, jerk) = (limits.acceleration(), limits.jerk());
        let (brake, down, up) = if sign > 0.0 {
            (-acceleration.min, -jerk.min, jerk.max)
        } else {
            (acceleration.max, jerk.max, -jerk.min)
        };
        let bound = |jerk: f64| (jerk * (1.0 - GUARD)).min(steepest);
        let (down, up) = (bound(down), bound(up));
        // As in `Timing::Fastest`: the last ramp takes at least a tenth of the first, or a stop could travel farther.
        let release = (1.5 / up).max(0.15 / down);
        Self { sign, brake: brake * (1.0 - GUARD), down, up, release }
    }
}

/// Least time per acceleration of a ramp along which the jerk starts at `jerk` (against it if < 0) and stays within
/// `bound`.
fn ramp_time(bound: f64, jerk: f64) -> f64 {
    let jerk = jerk.min(bound);
    3.0 / (bound + jerk + sqrt(bound * (bound - jerk)))
}

impl Motion {
    /// `steepest`: jerk beyond which ramps are too short for quintics; `shortest`: see the field.
    pub(super) fn new(state: State, limits: &Limits, (steepest, shortest): (f64, f64)) -> Self {
        let (forward, backward) = (Frame::new(1.0, limits, steepest), Frame::new(-1.0, limits, steepest));
        let jerk = state.jerk.clamp(-backward.up.max(forward.down), forward.up.max(backward.down));
        let state = State { jerk, ..state };
        let trajectory = Trajectory::unfilled(0.0, state);
        Self { trajectory, state, time: 0.0, forward, backward, shortest }
    }

    /// The whole way to rest.
    pub(super) fn into_stop(mut self) -> Trajectory {
        self.back_within_acceleration();
        self.settle();
        self.trajectory.finish(self.time, State { position: self.state.position, ..State::default() })
    }

    /// The frame in which the acceleration is braking, and velocity, acceleration ≤ 0 and jerk in it.
    fn frame(&self) -> (Frame, f64, f64, f64) {
        let State { velocity, acceleration, jerk, .. } = self.state;
        // What is 0 leaves the decision to the next one.
        let sign = [acceleration, -velocity, jerk].into_iter().find(|x| *x != 0.0).unwrap_or(0.0);
        let frame = if sign > 0.0 { self.backward } else { self.forward };
        (frame, frame.sign * velocity, frame.sign * acceleration, frame.sign * jerk)
    }

    /// From an acceleration beyond its limit to the limit.
    fn back_within_acceleration(&mut self) {
        let (frame, _, a, j) = self.frame();
        if -a <= frame.brake * (1.0 + ROUNDING) {
            return;
        }
        if j < 0.0 {
            self.drop_jerk(&frame);
        }
        let (_, _, a, j) = self.frame();
        self.ramp(&frame, -frame.brake, (-a - frame.brake) * ramp_time(frame.up, j));
    }

    fn settle(&mut self) {
        let (frame, v, a, j) = self.frame();
        let left = v - 0.5 * frame.release * a * a; // velocity if the jerk could jump and braking ended now
        if j <= 0.0 {
            if left >= 0.0 {
                self.brake(&frame);
                return;
            }
            if j < 0.0 {
                self.drop_jerk(&frame);
            }
            self.release(&frame);
            self.brake_anew();
            return;
        }
        // The acceleration is on its way back to 0.
        let time = -a * ramp_time(frame.up, j);
        let change = time * (0.5 * a + time * j / 12.0);
        if v + change < ROUNDING * (v.abs() + change.abs()) {
            self.release(&frame);
            self.brake_anew();
        } else if left < 0.0 {
            self.release_in_part(&frame, left);
        } else {
            self.brake_after_turn(&frame, left);
        }
    }

    /// Brakes on: to a larger deceleration B, held if it is the limit, then to rest. Without jerk against it, and with
    /// velocity enough.
    fn brake(&mut self, frame: &Frame) {
        let (v, a) = (frame.sign * self.state.velocity, -frame.sign * self.state.acceleration);
        let jerk = -frame.sign * self.state.jerk;
        let time = ramp_time(frame.down, jerk);
        // The velocity that reaching B = a + d and ending takes is a parabola in d.
        let square = 0.5 * (time + frame.release) + time * time * jerk / 12.0;
        let linear = a * (time + frame.release);
        let left = (v - 0.5 * frame.release * a * a).max(0.0);
        let d = if left > 0.0 {
            2.0 * left / (linear + sqrt(linear * linear + 4.0 * square * left))
        } else {
            0.0
        };
        let is_capped = a + d > frame.brake;
        let peak = if is_capped { frame.brake.max(a) } else { a + d };
        self.ramp(frame, -peak, time * (peak - a));
        if is_capped {
            let v = frame.sign * self.state.velocity;
            self.hold(v / peak - 0.5 * frame.release * peak);
        }
        self.end(frame);
    }

    /// From an acceleration of 0 to rest, whichever way the velocity points.
    fn brake_anew(&mut self) {
        let frame = if self.state.velocity < 0.0 { self.backward } else { self.forward };
        self.brake(&frame);
    }

    /// Ends braking as fast as the jerk bound allows; the velocity may be left on either side of 0.
    fn release(&mut self, frame: &Frame) {
        let (v, a, j) = (
            frame.sign * self.state.velocity,
            frame.sign * self.state.acceleration,
            frame.sign * self.state.jerk,
        );
        let mut time = -a * ramp_time(frame.up, j);
        let change = time * (0.5 * a + time * j / 12.0);
        let left = v + change;
        let is_rest = left.abs() <= ROUNDING * (v.abs() + change.abs());
        let rate = 0.5 * a + time * j / 6.0;
        if is_rest && rate < 0.0 && left.abs() <= 4.0 * ROUNDING * time * -rate {
            time -= left / rate;
        }
        self.ramp(frame, 0.0, time);
        if is_rest {
            self.state.velocity = 0.0;
        }
    }

    /// Ends braking in two ramps, so that it takes exactly the velocity that there is: to a smaller deceleration, then
    /// to rest. The jerk already points there; `left` < 0 is what would be left if it could jump.
    fn release_in_part(&mut self, frame: &Frame, left: f64) {
        let (a, j) = (-frame.sign * self.state.acceleration, frame.sign * self.state.jerk);
        let time = ramp_time(frame.up, j);
        let square = 0.5 * (time - frame.release) + time * time * j / 12.0;
        let linear = a * (frame.release - time);
        let root = sqrt((linear * linear - 4.0 * square * left).max(0.0));
        let d = if linear + root > 0.0 { (-2.0 * left / (linear + root)).min(a) } else { a };
        self.ramp(frame, d - a, time * d);
        self.end(frame);
    }

    /// Brakes on although the jerk is ending it: the jerk vanishes first, as late as the velocity allows.
    fn brake_after_turn(&mut self, frame: &Frame, left: f64) {
        let (a, j) = (-frame.sign * self.state.acceleration, frame.sign * self.state.jerk);
        let time = self.time_to_drop(frame, a, j);
        let d = time * j / 3.0;
        let after = left + a * d * (frame.release - 3.0 / j) + d * d * (2.25 / j - 0.5 * frame.release);
        if after >= 0.0 {
            self.drop_jerk(frame);
            let (frame, ..) = self.frame();
            if frame.sign * self.state.velocity >= 0.0 {
                self.brake(&frame);
            } else {
                self.release(&frame);
                self.brake_anew();
            }
            return;
        }
        let linear = a * (3.0 / j - frame.release);
        let square = 2.25 / j - 0.5 * frame.release;
        let root = sqrt((linear * linear - 4.0 * square * left).max(0.0));
        let d = (2.0 * left / (linear + root)).min(d);
        self.ramp(frame, d - a, 3.0 * d / j);
        self.end(frame);
    }

    /// Lets the jerk vanish along a parabola while the acceleration moves on a little.
    fn drop_jerk(&mut self, frame: &Frame) {
        let (a, j) = (self.state.acceleration, self.state.jerk);
        let time = self.time_to_drop(frame, a.abs(), j.abs());
        self.ramp(frame, frame.sign * (a + time * j / 3.0), time);
    }

    /// 3/8·j·a/J²: at most what is left of a ramp on which the state may lie, so that acceleration and velocity stay
    /// within what that ramp would have reached. J is the larger bound: the ramps of `Shape::SineQuintic` begin and
    /// end with jerk against them, so either bound may be behind it.
    fn time_to_drop(&self, frame: &Frame, a: f64, j: f64) -> f64 {
        let bound = frame.up.max(frame.down);
        (0.375 * (j / bound) * (a / bound)).max(self.shortest)
    }

    /// The last ramp, to rest. Takes up rounding.
    fn end(&mut self, frame: &Frame) {
        let (v, a) = (frame.sign * self.state.velocity, -frame.sign * self.state.acceleration);
        if a > 0.0 {
            let time = (2.0 * v / a).max(frame.release * a);
            self.state.velocity = frame.sign * 0.5 * a * time;
            self.ramp(frame, 0.0, time);
        }
        self.state.velocity = 0.0;
    }

    /// A ramp to `target` (an acceleration in `frame`) and no jerk in `time`; void if that is 0.
    fn ramp(&mut self, frame: &Frame, target: f64, time: f64) {
        let target = frame.sign * target;
        if time > 0.0 {
            let State { position, velocity, acceleration: a, jerk: j } = self.state;
            let (d, t) = (target - a, time);
            let coefficients = [
                position,
                velocity,
                0.5 * a,
                j / 6.0,
                (3.0 * d / t - 2.0 * j) / (12.0 * t),
                (j - 2.0 * d / t) / (20.0 * t * t),
            ];
            self.push(coefficients, t);
            self.state.position += t * (velocity + t * (0.35 * a + 0.15 * target + 0.05 * t * j));
            self.state.velocity += t * (0.5 * (a + target) + t * j / 12.0);
        }
        self.state = State { acceleration: target, jerk: 0.0, ..self.state };
    }

    /// The present acceleration, held.
    fn hold(&mut self, time: f64) {
        if time > 0.0 {
            let State { position, velocity, acceleration: a, .. } = self.state;
            self.push([position, velocity, 0.5 * a, 0.0, 0.0, 0.0], time);
            self.state.position += time * (velocity + 0.5 * a * time);
            self.state.velocity += a * time;
        }
    }

    fn push(&mut self, coefficients: [f64; 6], duration: f64) {
        self.trajectory.push(Segment { start: self.time, duration, coefficients });
        self.time += duration;
    }
}
