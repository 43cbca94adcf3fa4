//! One direction's knots with what a lookup in constant time needs.

#[cfg(feature = "build")]
use std::borrow::Cow;

use crate::math::{smaller, sqrt};
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
    last: Knot,
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
        // A real table's second step is the longer by more than a half; a period that is none gives anything.
        if !(growth_per_step.is_normal() && growth_per_step > 0.0) {
            return Err(0);
        }
        if !(vertex >= 0.0) {
            return Err(2 * subdivisions);
        }
        let parabola =
            Parabola { first, vertex, vertex_squared: vertex * vertex, growth: 2.0 / growth_per_step };
        for step in 2..=steps {
            let error = parabola.steps_beyond_the_first(at(step)) - (step - 1) as f64;
            if !(-0.5..=0.5).contains(&error) {
                return Err(step * subdivisions);
            }
        }
        let last = knots[knots.len() - 1];
        Ok(Self { last, spacing, per_spacing, subdivisions, steps, parabola, knots })
    }

    #[inline]
    pub(crate) fn knots(&self) -> &[Knot] {
        // Owned with the feature `build`, a slice without it.
        let knots: &Knots<'a> = &self.knots;
        knots
    }

    /// The last knot's velocity [rad/s or m/s].
    #[inline]
    pub(crate) fn last_velocity(&self) -> f64 {
        self.last.velocity
    }

    /// Knot `index` and the next one; at most the last two.
    #[inline]
    fn pair(&self, index: usize) -> (Knot, Knot) {
        let knots = self.knots();
        match knots.get(index..index.wrapping_add(2)) {
            Some(&[low, high]) => (low, high),
            // There are two at least, so that no index can panic.
            _ => knots.last_chunk().map_or((self.last, self.last), |&[low, high]| (low, high)),
        }
    }

    /// Velocity and distance at knot `index`, the last but one at most, and the slope from there on \[s\].
    #[inline]
    pub(crate) fn segment(&self, index: u32) -> (f64, f64, f64) {
        let (low, high) = self.pair(index as usize);
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
            let (velocity, distance, slope) = self.segment((speed * self.per_spacing) as u32);
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
        if !(distance > 0.0) {
            return 0.0;
        }
        if distance >= self.last.distance {
            return self.last.velocity;
        }
        let guess = self.guess_of_step(distance);
        if self.subdivisions > 1 {
            let index = self.knot_below(self.step_below(guess, distance) * self.subdivisions, distance);
            return self.speed_between(index, self.pair(index), distance);
        }
        let guess = guess.min(self.steps - 1); // `distance` is less than the last knot's
        let (below, above) = self.pair(guess);
        if below.distance > distance {
            self.speed_between(guess - 1, self.pair(guess - 1), distance)
        } else if above.distance <= distance {
            self.speed_between(guess + 1, self.pair(guess + 1), distance)
        } else {
            self.speed_between(guess, (below, above), distance)
        }
    }

    /// Speed by interpolation between knot `index` and the next one.
    #[inline]
    fn speed_between(&self, index: usize, (below, above): (Knot, Knot), distance: f64) -> f64 {
        let share = (distance - below.distance) / (above.distance - below.distance);
        smaller((f64::from(index as u32) + share) * self.spacing, above.velocity)
    }

    /// The last braking step at no more than `distance`, or a neighbour of it; 0 only if it is that step.
    #[inline]
    fn guess_of_step(&self, distance: f64) -> usize {
        if distance < self.parabola.first {
            return 0;
        }
        (self.parabola.steps_beyond_the_first(distance) as u32 as usize).min(self.steps - 1) + 1
    }

    /// The last braking step at no more than `distance`, which is less than the last knot's, from a guess of it.
    #[inline]
    fn step_below(&self, guess: usize, distance: f64) -> usize {
        let knots = self.knots();
        let is_within =
            |step: usize| knots.get(step * self.subdivisions).is_some_and(|k| k.distance <= distance);
        if !is_within(guess) {
            guess - 1
        } else if is_within(guess + 1) {
            guess + 1
        } else {
            guess
        }
    }

    /// The last knot at no more than `distance`, less than the last knot's, within the braking step from knot `low` on.
    #[inline]
    fn knot_below(&self, mut low: usize, distance: f64) -> usize {
        let knots = self.knots();
        let mut high = low + self.subdivisions;
        while high - low > 1 {
            let middle = low + (high - low) / 2;
            let is_below = knots.get(middle).is_some_and(|k| k.distance <= distance);
            low = if is_below { middle } else { low };
            high = if is_below { high } else { middle };
        }
        low
    }
}

#[cfg(test)]
mod tests {
    use super::Curve;
    use crate::table::Knot;

    /// Knots towards a limit with Δ = T = 1: n whole steps need n²/2, plus what `error(n)` makes of n. Half a step ends
    /// them where a step has parts.
    fn bent(subdivisions: u32, steps: u32, error: impl Fn(u32) -> f64) -> Vec<Knot> {
        let distance = |step: u32| 0.5 * (f64::from(step) + error(step)).powi(2);
        let last = steps * subdivisions + subdivisions / 2;
        (0..=last)
            .map(|index| {
                let (step, share) =
                    (index / subdivisions, f64::from(index % subdivisions) / f64::from(subdivisions));
                let distance = (1.0 - share) * distance(step) + share * distance(step + 1);
                Knot { distance, velocity: f64::from(index) / f64::from(subdivisions) }
            })
            .collect()
    }

    /// Wherever its knots lie that [`Curve::new`] takes, up to half a step off the parabola, the lookup by distance undoes
    /// the one by speed.
    #[test]
    fn a_lookup_by_distance_undoes_the_one_by_speed() {
        for subdivisions in [1, 16] {
            for bend in 0..81 {
                let error = |step: u32| match step {
                    3..=6 => 0.49 * (f64::from(bend / 3_u32.pow(step - 3) % 3) - 1.0),
                    7 => 20.0, // nothing is asked of the last step in part
                    _ => 0.0,
                };
                let knots = bent(subdivisions, 6, error);
                let curve =
                    Curve::new(knots.as_slice().into(), subdivisions, 1.0).expect("within half a step");
                let ends = 1e-12;
                for pair in knots.windows(2) {
                    for share in [0.0, ends, 0.2, 0.5, 0.8, 1.0 - ends] {
                        let speed = pair[0].velocity + share * (pair[1].velocity - pair[0].velocity);
                        let found = curve.max_speed(curve.distance_and_slope(speed).0);
                        assert!(
                            (found - speed).abs() <= 1e-14 * 6.0,
                            "{found} for {speed}, {subdivisions}, {bend}"
                        );
                    }
                }
            }
        }
    }
}
