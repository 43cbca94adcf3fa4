//! One position limit, in coordinates in which it is the upper one.

use jbtg::{Direction, Interval, Planner, Shape, Timing};

use crate::math::sqrt;

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
    /// +1 for the upper limit, −1 for the lower one.
    pub(crate) sign: f64,
    /// The position limit, mirrored [rad or m].
    pub(crate) limit: f64,
    /// Velocity that one period takes away, Δ [rad/s or m/s].
    pub(crate) step: f64,
    /// The period \[s\].
    pub(crate) period: f64,
    /// Change at which a step's distance may have a concave kink, see [`Braking::kink_depth`] [rad/s or m/s].
    kink: f64,
    /// Displacement of the step from Δ to 0 [rad or m].
    last_step: f64,
    /// Excess of a step's interior over its ends, per velocity change \[s\]; 0 for the smoothstep.
    pub(crate) reverse: f64,
    /// Largest velocity that a step may end at [rad/s or m/s].
    pub(crate) velocity: f64,
    /// Width of the position interval [rad or m].
    pub(crate) width: f64,
    /// What rounding may add over a whole braking manoeuvre [rad or m].
    pub(crate) rounding: f64,
    /// Excess over the limit that counts as rounding [rad or m].
    pub(crate) tolerance: f64,
    /// Distance that a step by choice keeps from the limit [rad or m]; braking may use it up.
    pub(crate) guard: f64,
    /// Whether a larger velocity change lies pointwise beyond a smaller one, so that interiors need no check.
    pub(crate) interior_is_free: bool,
    /// Whether velocity follows one time course per direction ([`Timing::Stretched`]).
    pub(crate) stretched: bool,
}

impl Braking {
    pub(crate) fn new(planner: &Planner, side: Side) -> Self {
        let (sign, direction) = match side {
            Side::Upper => (1.0, Direction::Decreasing),
            Side::Lower => (-1.0, Direction::Increasing),
        };
        let position = planner.limits().position();
        let (limit, velocity) = match side {
            Side::Upper => (position.max, planner.velocity().max),
            Side::Lower => (-position.min, -planner.velocity().min),
        };
        let authority = planner.authority(direction);
        let (step, period) = (authority.velocity_change, planner.period());
        let width = position.width();
        let scale = position.min.abs().max(position.max.abs()).max(width);
        // Half an ulp per step of a braking manoeuvre, and the roundings of one range.
        let steps = (velocity / step).min(sqrt(2.0 * width / (step * period)));
        let rounding = f64::EPSILON * (steps + 16.0) * scale;
        let reverse = authority.reverse_travel;
        let smooth = planner.spec().shape == Shape::Smoothstep;
        let stretched = planner.spec().timing == Timing::Stretched;
        Self {
            sign,
            limit,
            step,
            period,
            kink: authority.ramps_only,
            last_step: sign * planner.displacement(sign * step, 0.0),
            reverse,
            velocity,
            width,
            rounding,
            tolerance: rounding.min(0.5e-12 * width),
            guard: rounding + 2.0 * reverse * step,
            interior_is_free: smooth && stretched,
            stretched,
        }
    }

    /// Distance of the stepwise braking policy from `velocity`, in closed form [rad or m]; 0 for a velocity away
    /// from the limit.
    ///
    /// With n = ⌊v/Δ⌋ full steps and the remainder r: D = Δ·T·n(n−1)/2 + n·d(Δ) + n·T·r + d(r), where d(r) is the
    /// displacement of the last step, from r to 0. For a shape whose interior exceeds its ends that excess is
    /// added.
    pub(crate) fn distance(&self, planner: &Planner, velocity: f64) -> f64 {
        if velocity <= 0.0 {
            return 0.0;
        }
        let n = (velocity / self.step) as u64 as f64;
        let r = (velocity - n * self.step).max(0.0);
        let last = self.sign * planner.displacement(self.sign * r, 0.0);
        n * (0.5 * (n - 1.0) * self.step * self.period + self.last_step + self.period * r)
            + last
            + self.reverse * velocity.min(self.step)
    }

    /// How far the distance rises above its linear interpolation between knots `spacing` apart [rad or m].
    ///
    /// Within a braking step it is convex but for [`Timing::Fastest`] with a rising ramp longer than the falling
    /// one: where ramps without a cruise (d ∝ v^1.5) pass into ramps with one, its slope falls.
    pub(crate) fn kink_depth(&self, planner: &Planner, spacing: f64) -> f64 {
        if self.stretched {
            return 0.0;
        }
        let low = (self.kink / spacing) as u64 as f64 * spacing;
        let [at_low, at_kink, at_high] = [low, self.kink, low + spacing].map(|v| self.distance(planner, v));
        let between = at_low + (self.kink - low) / spacing * (at_high - at_low);
        (at_kink - between).max(0.0)
    }

    /// Displacement of one step, mirrored [rad or m].
    #[inline]
    pub(crate) fn displacement(&self, planner: &Planner, v1: f64, v2: f64) -> f64 {
        self.sign * planner.displacement(self.sign * v1, self.sign * v2)
    }

    /// An interval of velocities or positions, mirrored.
    #[inline]
    pub(crate) fn mirrored(&self, interval: Interval) -> Interval {
        if self.sign > 0.0 { interval } else { interval.mirrored() }
    }
}
