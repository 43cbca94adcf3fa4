//! One position limit, in coordinates in which it is the upper one.

use jbtg::{Direction, Planner, Timing};

use crate::lag::Lag;
use crate::math::{larger, smaller, sqrt};
use crate::table::subdivisions;

/// A position limit of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The greatest position; positive velocities approach it.
    Upper,
    /// The least position; negative velocities approach it.
    Lower,
}

/// Braking towards one position limit. Everything is mirrored for [`Side::Lower`], so that positions grow towards
/// the limit and braking makes velocities smaller.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Braking {
    /// The position limit, mirrored [rad or m].
    pub(crate) limit: f64,
    /// Velocity that one period takes away, Δ [rad/s or m/s].
    pub(crate) step: f64,
    per_step: f64,
    /// The period \[s\].
    pub(crate) period: f64,
    /// Δ·T/2 [rad or m].
    half_square: f64,
    /// 2/(Δ·T) [1 per rad or m].
    growth: f64,
    /// Linear coefficient of the parabola through a period's displacement and the distance at braking steps \[s\].
    travel_slope: f64,
    /// Its quadratic one, T/(2Δ) [s² per rad or m].
    travel_curve: f64,
    /// Full braking steps from the largest velocity.
    pub(crate) most_steps: f64,
    /// Lag of steps away from the limit: braking.
    pub(crate) brake: Lag,
    /// Lag of steps towards the limit.
    pub(crate) climb: Lag,
    /// Velocity that one period adds at most [rad/s or m/s].
    pub(crate) largest_climb: f64,
    /// Lag of that step [rad or m].
    climb_lag: f64,
    /// Displacement of the step from Δ to 0 [rad or m].
    last_step: f64,
    /// Excess of a step's interior over its ends, per velocity change \[s\]; 0 for the smoothstep.
    pub(crate) reverse: f64,
    /// That excess for a change of Δ [rad or m].
    pub(crate) overshoot: f64,
    /// Steps downwards, to smaller velocities.
    pub(crate) downwards: Line,
    /// Steps upwards.
    pub(crate) upwards: Line,
    /// Width of the position interval [rad or m].
    pub(crate) width: f64,
    /// What rounding may add over a whole braking manoeuvre [rad or m].
    pub(crate) rounding: f64,
    /// Excess over the limit that counts as rounding [rad or m].
    pub(crate) tolerance: f64,
    /// Distance that a step by choice keeps from the limit [rad or m]; braking may use it up.
    pub(crate) guard: f64,
    /// The limit less the guard [rad or m].
    pub(crate) kept: f64,
    /// Whether velocity follows one time course per direction ([`Timing::Stretched`]).
    pub(crate) stretched: bool,
    /// Where a step that turns around within its period turns.
    pub(crate) turning: Turning,
    /// Up to here no step within the velocity limits needs to know the position [rad or m].
    pub(crate) far_until: f64,
    /// Up to here no step does that leaves room for its [`Braking::travel_bound`] [rad or m].
    pub(crate) free_until: f64,
}

/// Steps with a lag of `lag` per velocity change, upwards or downwards: a step to v′ covers `gain`·v′ and `lag`·v. Together
/// with the distance after it that is Δ·T/2·n² + `first`·n at v′ = nΔ, plus the overshoot from n = 1 on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    /// Lag per velocity change \[s\].
    pub(crate) lag: f64,
    /// T − lag \[s\].
    pub(crate) gain: f64,
    pub(crate) per_gain: f64,
    /// Linear coefficient of the sum at knots [rad or m].
    first: f64,
    /// Slope of the sum between 0 and Δ \[s\].
    slope: f64,
    /// `first` in multiples of Δ·T.
    vertex: f64,
    vertex_squared: f64,
}

/// Numbers of a step that turns around within its period: its shape and its two ramps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turning {
    /// Coefficients of the ramp, see [`Shape::coefficients`](jbtg::Shape::coefficients).
    pub(crate) shape: [f64; 3],
    /// Duration of the falling ramp per duration of the rising one.
    pub(crate) ratio: f64,
    /// Duration of the rising ramp per acceleration [s² per rad/s or m/s].
    pub(crate) rising_per_acceleration: f64,
}

impl Braking {
    pub(crate) fn new(planner: &Planner, side: Side) -> Self {
        let (away, towards) = match side {
            Side::Upper => (Direction::Decreasing, Direction::Increasing),
            Side::Lower => (Direction::Increasing, Direction::Decreasing),
        };
        let position = planner.limits().position();
        let (limit, velocity) = match side {
            Side::Upper => (position.max, planner.velocity().max),
            Side::Lower => (-position.min, -planner.velocity().min),
        };
        let authority = planner.authority(away);
        let (step, period) = (authority.velocity_change, planner.period());
        let width = position.width();
        let scale = position.min.abs().max(position.max.abs()).max(width);
        let rounding = rounding(velocity / step, width / (step * period), scale);
        let reverse = authority.reverse_travel;
        let shape = planner.spec().shape;
        let stretched = planner.spec().timing == Timing::Stretched;
        let (brake, climb) = (Lag::new(planner, away), Lag::new(planner, towards));
        let line = |lag: f64| {
            let (gain, half_square) = (period - lag, 0.5 * step * period);
            let first = gain * step + brake.mean * step - half_square;
            let vertex = first / (step * period);
            Line {
                lag,
                gain,
                per_gain: 1.0 / gain,
                first,
                slope: gain + brake.mean,
                vertex,
                vertex_squared: vertex * vertex,
            }
        };
        let (up, down) = (authority.ramp_up, authority.ramp_down);
        let turning = Turning {
            shape: shape.coefficients(),
            ratio: down / up,
            rising_per_acceleration: 0.5 * up * (up + down) / authority.ramps_only,
        };
        let guard = rounding + 2.0 * reverse * step;
        let largest_climb = planner.authority(towards).velocity_change;
        let mut braking = Self {
            limit,
            step,
            per_step: 1.0 / step,
            period,
            half_square: 0.5 * step * period,
            growth: 2.0 / (step * period),
            travel_slope: 0.5 * period + brake.mean,
            travel_curve: 0.5 * period / step,
            most_steps: (velocity / step) as i64 as f64,
            largest_climb,
            climb_lag: climb.at(largest_climb),
            last_step: brake.at(step),
            brake,
            climb,
            reverse,
            overshoot: reverse * step,
            downwards: line(brake.mean),
            upwards: line(climb.mean),
            width,
            rounding,
            tolerance: rounding.min(0.5e-12 * width),
            guard,
            kept: limit - guard,
            stretched,
            turning,
            far_until: f64::NEG_INFINITY,
            free_until: f64::NEG_INFINITY,
        };
        // What tables and samples lift the distance by, and the height of its chords over the parabola.
        let lift = braking.chord_depth(step / f64::from(subdivisions(Timing::Fastest)));
        braking.free_until = braking.kept - (braking.overshoot + lift + 0.25 * braking.half_square);
        braking.far_until = braking.free_until - braking.travel_bound(velocity);
        braking
    }

    /// What rounding may add to a braking manoeuvre of that `length` from a position of that `size` [rad or m].
    pub(crate) fn rounding_over(&self, length: f64, size: f64) -> f64 {
        let scale = larger(size, larger(self.width, self.limit.abs()));
        rounding(f64::INFINITY, length / (self.step * self.period), scale)
    }

    /// Distance of the stepwise braking policy from `velocity`, in closed form [rad or m]; 0 for a velocity away
    /// from the limit.
    ///
    /// With n = ⌊v/Δ⌋ full steps and the remainder r: D = Δ·T·n(n−1)/2 + n·d(Δ) + n·T·r + d(r), where d(r) is the
    /// displacement of the last step, from r to 0. For a shape whose interior exceeds its ends that excess is
    /// added.
    #[inline]
    pub(crate) fn distance(&self, velocity: f64) -> f64 {
        if velocity <= 0.0 {
            return 0.0;
        }
        let n = self.full_steps(velocity);
        let r = larger(velocity - n * self.step, 0.0);
        n * (0.5 * (n - 1.0) * self.step * self.period + self.last_step + self.period * r)
            + self.brake.at(r)
            + self.reverse * smaller(velocity, self.step)
    }

    /// Derivative of [`Braking::distance`] \[s\].
    #[inline]
    pub(crate) fn distance_slope(&self, velocity: f64) -> f64 {
        if velocity <= 0.0 {
            return 0.0;
        }
        let n = self.full_steps(velocity);
        n * self.period + self.brake.slope_at(larger(velocity - n * self.step, 0.0))
    }

    /// Braking steps that take Δ in full, from `velocity` ≥ 0 on.
    #[inline]
    pub(crate) fn full_steps(&self, velocity: f64) -> f64 {
        (velocity * self.per_step) as i64 as f64
    }

    /// Braking steps, the last one in part, up to which `line`'s displacement and the distance together are within `rest` > 0,
    /// but for rounding. Exact with [`Timing::Stretched`].
    #[inline]
    pub(crate) fn steps_within(&self, line: &Line, rest: f64) -> f64 {
        let beyond = larger(rest - self.overshoot, 0.0) * self.growth;
        sqrt(line.vertex_squared + beyond) - line.vertex
    }

    /// Knot `n` of `line`'s displacement and the distance together: its velocity, their sum, and its slope from there on
    /// \[s\]. Exact with [`Timing::Stretched`].
    #[inline]
    pub(crate) fn knot(&self, line: &Line, n: f64) -> (f64, f64, f64) {
        let (overshoot, overshoot_slope) = if n > 0.0 { (self.overshoot, 0.0) } else { (0.0, self.reverse) };
        let sum = n * (n * self.half_square + line.first) + overshoot;
        (n * self.step, sum, line.slope + n * self.period + overshoot_slope)
    }

    /// Whether no step within the velocity limits comes so near to the limit that it leaves no room to brake.
    #[inline]
    pub(crate) fn is_far(&self, position: f64) -> bool {
        position <= self.far_until
    }

    /// Whether no step from `velocity` on, within the velocity limits, does.
    #[inline]
    pub(crate) fn is_free(&self, position: f64, velocity: f64) -> bool {
        if self.is_far(position) {
            return true; // The usual case of one limit of two, for less.
        }
        let farthest = self.travel_bound(velocity + self.largest_climb) - self.climb_lag;
        position <= self.free_until && position + farthest <= self.free_until
    }

    /// What a period at that velocity and braking from it take at most, less what `free_until` keeps for it [rad or m].
    #[inline]
    fn travel_bound(&self, velocity: f64) -> f64 {
        let velocity = larger(velocity, 0.0);
        velocity * (self.travel_slope + velocity * self.travel_curve)
    }

    /// Whether `position` is beyond the limit by more than rounding.
    #[inline]
    pub(crate) fn is_outside(&self, position: f64) -> bool {
        position > self.limit + self.tolerance
    }

    /// How far the distance rises above its linear interpolation between knots `spacing` apart [rad or m].
    ///
    /// Within a braking step it is convex but for [`Timing::Fastest`] with a rising ramp longer than the falling
    /// one: where ramps without a cruise (d ∝ v^1.5) pass into ramps with one, its slope falls.
    pub(crate) fn kink_depth(&self, spacing: f64) -> f64 {
        if self.stretched {
            return 0.0;
        }
        let kink = self.brake.ramps_only;
        let low = (kink / spacing) as u64 as f64 * spacing;
        let [at_low, at_kink, at_high] = [low, kink, low + spacing].map(|v| self.distance(v));
        let between = at_low + (kink - low) / spacing * (at_high - at_low);
        (at_kink - between).max(0.0)
    }

    /// Twice what a chord over velocities `spacing` apart, wherever they begin, lies below the distance at most [rad or m].
    ///
    /// But for where its slope falls, the distance is convex.
    pub(crate) fn chord_depth(&self, spacing: f64) -> f64 {
        0.5 * spacing * (self.brake.kink() + self.reverse)
    }

    /// Displacement of one step, mirrored [rad or m].
    #[inline]
    pub(crate) fn displacement(&self, v1: f64, v2: f64) -> f64 {
        let lag = if v2 >= v1 { self.climb.at(v2 - v1) } else { -self.brake.at(v1 - v2) };
        v2 * self.period - lag
    }

    /// Derivative of [`Braking::displacement`] by its end velocity \[s\].
    #[inline]
    pub(crate) fn displacement_slope(&self, v1: f64, v2: f64) -> f64 {
        let lag = if v2 >= v1 { self.climb.slope_at(v2 - v1) } else { self.brake.slope_at(v1 - v2) };
        self.period - lag
    }
}

/// Half an ulp of `scale` per step of a braking manoeuvre, and the roundings of one range: at most `steps`, and no more than
/// make a distance of `length` times Δ·T.
fn rounding(steps: f64, length: f64, scale: f64) -> f64 {
    f64::EPSILON * (smaller(steps, sqrt(2.0 * length)) + 16.0) * scale
}

#[cfg(test)]
mod tests;
