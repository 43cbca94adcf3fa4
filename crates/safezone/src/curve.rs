//! One direction's knots with what a lookup in constant time needs.

#[cfg(feature = "build")]
use std::borrow::Cow;

use crate::math::sqrt;
use crate::table::Knot;

#[cfg(feature = "build")]
pub(crate) type Knots<'a> = Cow<'a, [Knot]>;
#[cfg(not(feature = "build"))]
pub(crate) type Knots<'a> = &'a [Knot];

/// Knots towards one position limit.
///
/// Invariant, checked by [`Curve::new`]: at least two knots, the first (0, 0), equally spaced in velocity, increasing in
/// distance, and at braking steps on a parabola but for less than half a step.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Curve<'a> {
    knots: Knots<'a>,
    /// Velocity from knot to knot [rad/s or m/s].
    spacing: f64,
    per_spacing: f64,
    /// Knots per braking step.
    subdivisions: usize,
    /// The last knot that lies on a braking step, in steps.
    steps: usize,
    parabola: Parabola,
}

/// The braking steps that fit into a distance: with D₁ for one step and D₁ + s for two, n steps need
/// D₁ + (n−1)·s + (n−1)(n−2)/2·Δ·T.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Parabola {
    first: f64,
    vertex: f64,
    vertex_squared: f64,
    growth: f64,
}

impl Parabola {
    /// Steps within `distance` ≥ `first` beyond the first one, a real number that never falls as the distance grows.
    #[inline]
    fn steps_beyond_the_first(&self, distance: f64) -> f64 {
        sqrt(self.vertex_squared + (distance - self.first) * self.growth) - self.vertex
    }
}

impl<'a> Curve<'a> {
    /// Checks the knots of braking steps that last one `period` each.
    ///
    /// # Errors
    /// The index of the first knot that breaks the invariant.
    pub(crate) fn new(knots: Knots<'a>, subdivisions: u32, period: f64) -> Result<Self, usize> {
        if subdivisions == 0 || knots.len() < 2 || knots[0] != (Knot { distance: 0.0, velocity: 0.0 }) {
            return Err(0);
        }
        let spacing = knots[1].velocity;
        let per_spacing = 1.0 / spacing;
        for (index, pair) in knots.windows(2).enumerate() {
            let expected = (index + 1) as f64 * spacing;
            let rise = pair[1].distance - pair[0].distance;
            let numbers_hold = expected.is_normal() && (rise * per_spacing).is_normal();
            if !(pair[1].velocity == expected && expected > 0.0 && rise > 0.0 && numbers_hold) {
                return Err(index + 1);
            }
        }
        let subdivisions = subdivisions as usize;
        let steps = (knots.len() - 1) / subdivisions;
        let at = |step: usize| knots[step * subdivisions].distance;
        let growth_per_step = spacing * subdivisions as f64 * period;
        let first = if steps > 0 { at(1) } else { f64::INFINITY };
        let second = if steps > 1 { at(2) - first } else { growth_per_step };
        let vertex = second / growth_per_step - 0.5;
        let parabola =
            Parabola { first, vertex, vertex_squared: vertex * vertex, growth: 2.0 / growth_per_step };
        for step in 2..=steps {
            let error = parabola.steps_beyond_the_first(at(step)) - (step - 1) as f64;
            if !(-0.5..=0.5).contains(&error) {
                return Err(step * subdivisions);
            }
        }
        Ok(Self { spacing, per_spacing, subdivisions, steps, parabola, knots })
    }

    pub(crate) fn knots(&self) -> &[Knot] {
        // Owned with the feature `build`, a slice without it.
        let knots: &Knots<'a> = &self.knots;
        knots
    }

    /// The last knot's velocity [rad/s or m/s].
    #[inline]
    pub(crate) fn last_velocity(&self) -> f64 {
        self.knots.last().map_or(0.0, |knot| knot.velocity)
    }

    /// The knot at `index`; infinitely far beyond the last one, so that no index can panic.
    #[inline]
    fn knot(&self, index: usize) -> Knot {
        const BEYOND: Knot = Knot { distance: f64::INFINITY, velocity: f64::INFINITY };
        self.knots.get(index).copied().unwrap_or(BEYOND)
    }

    /// Index of the knot below `speed` > 0, so that there is one above.
    #[inline]
    fn index(&self, speed: f64) -> usize {
        ((speed * self.per_spacing) as u32 as usize).min(self.knots.len() - 2)
    }

    /// Distance and slope \[s\] at knot `index`, the last but one at most.
    #[inline]
    pub(crate) fn segment(&self, index: usize) -> (f64, f64, f64) {
        let index = index.min(self.knots.len() - 2);
        let (low, high) = (self.knot(index), self.knot(index + 1));
        (low.velocity, low.distance, (high.distance - low.distance) * self.per_spacing)
    }

    /// Distance and its slope at `speed` by linear interpolation; infinite beyond the last knot and for NaN, 0 for a speed
    /// ≤ 0.
    #[inline]
    pub(crate) fn distance_and_slope(&self, speed: f64) -> (f64, f64) {
        if speed <= 0.0 {
            return (0.0, 0.0);
        }
        if speed <= self.last_velocity() {
            let (velocity, distance, slope) = self.segment(self.index(speed));
            (distance + slope * (speed - velocity), slope)
        } else {
            (f64::INFINITY, f64::INFINITY)
        }
    }

    /// Largest speed within `distance`: 0 where it is not positive, the last knot's beyond the last knot.
    ///
    /// The parabola is off by at most half a step at each knot of a braking step and never falls, so its guess is the
    /// right step or a neighbour of it. Within a step the knots are halved ⌈log₂ subdivisions⌉ times.
    #[inline]
    pub(crate) fn max_speed(&self, distance: f64) -> f64 {
        let last = self.knot(self.knots.len() - 1);
        if !(distance > 0.0) {
            return 0.0;
        }
        if distance >= last.distance {
            return last.velocity;
        }
        let (mut low, mut high) = self.step_around(distance);
        while high - low > 1 {
            let middle = low + (high - low) / 2;
            let is_below = self.knot(middle).distance <= distance;
            low = if is_below { middle } else { low };
            high = if is_below { high } else { middle };
        }
        let (below, above) = (self.knot(low), self.knot(high));
        let share = (distance - below.distance) / (above.distance - below.distance);
        ((low as f64 + share) * self.spacing).min(above.velocity)
    }

    /// The knots that bound the braking step in which `distance` lies, less than the last knot's.
    #[inline]
    fn step_around(&self, distance: f64) -> (usize, usize) {
        let last = self.knots.len() - 1;
        let mut step = 0;
        if distance >= self.parabola.first {
            step = 1 + (self.parabola.steps_beyond_the_first(distance) as u32 as usize).min(self.steps - 1);
            if self.knot(step * self.subdivisions).distance > distance {
                step -= 1;
            } else if step < self.steps && self.knot((step + 1) * self.subdivisions).distance <= distance {
                step += 1;
            }
        }
        let low = step * self.subdivisions;
        (low, if step < self.steps { low + self.subdivisions } else { last })
    }
}
