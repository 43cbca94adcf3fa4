//! Exact extrema of quintic segments.

use crate::Interval;
use crate::roots::{self, Roots};
use crate::segment::{Segment, State};

/// Least and greatest value of each quantity over a trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Extrema {
    /// Position [rad or m].
    pub position: Interval,
    /// Velocity [rad/s or m/s].
    pub velocity: Interval,
    /// Acceleration [rad/s² or m/s²].
    pub acceleration: Interval,
    /// Jerk [rad/s³ or m/s³].
    pub jerk: Interval,
}

impl Extrema {
    /// The extrema of a single state.
    #[must_use]
    pub const fn at(state: State) -> Self {
        Self {
            position: Interval::new(state.position, state.position),
            velocity: Interval::new(state.velocity, state.velocity),
            acceleration: Interval::new(state.acceleration, state.acceleration),
            jerk: Interval::new(state.jerk, state.jerk),
        }
    }

    /// The extrema of both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            position: self.position.union(other.position),
            velocity: self.velocity.union(other.velocity),
            acceleration: self.acceleration.union(other.acceleration),
            jerk: self.jerk.union(other.jerk),
        }
    }

    fn widen(&mut self, state: State) {
        widen(&mut self.position, state.position);
        widen(&mut self.velocity, state.velocity);
        widen(&mut self.acceleration, state.acceleration);
        widen(&mut self.jerk, state.jerk);
    }
}

/// `Interval::including` for an interval that holds no NaN: one instruction per end.
#[inline]
fn widen(interval: &mut Interval, value: f64) {
    interval.min = if value < interval.min { value } else { interval.min };
    interval.max = if value > interval.max { value } else { interval.max };
}

/// Widens `extrema` by everything that happens within `segment`, its ends included.
///
/// Judges the coefficients alone and assumes no ramp behind them. From jerk down to velocity, the roots of one
/// polynomial part the segment into pieces on which the next is monotone. Where the Bernstein coefficients of a
/// polynomial have one sign it has no roots, so that most segments need none computed.
#[inline]
pub(crate) fn include_segment(extrema: &mut Extrema, segment: &Segment) {
    let [b0, b1, b2, b3, b4, b5] = segment.coefficients;
    let duration = segment.duration;
    let end = segment.state_at(duration);
    extrema.widen(State { position: b0, velocity: b1, acceleration: 2.0 * b2, jerk: 6.0 * b3 });
    extrema.widen(end);
    let at = |u: f64| segment.state_at(u * duration);

    // The derivatives in u = t/T, each with coefficients in its primitive's unit over T.
    let (d2, d3) = (duration * duration, duration * duration * duration);
    let (b2, b3, b4, b5) = (b2 * duration, b3 * d2, b4 * d3, b5 * d3 * duration);
    let mut turns = Roots::NONE; // of the velocity
    if b3 != 0.0 || b4 != 0.0 || b5 != 0.0 {
        let vertex = -b4 / (5.0 * b5);
        if vertex > 0.0 && vertex < 1.0 {
            widen(&mut extrema.jerk, at(vertex).jerk);
        }
        let jerk = Roots::of_quadratic([6.0 * b3, 24.0 * b4, 60.0 * b5]);
        for u in jerk.iter() {
            widen(&mut extrema.acceleration, at(u).acceleration);
        }
        let acceleration = [2.0 * b2, 6.0 * b3, 12.0 * b4, 20.0 * b5];
        if !roots::has_one_sign(acceleration) {
            turns = Roots::of_cubic(&jerk, acceleration);
            for u in turns.iter() {
                widen(&mut extrema.velocity, at(u).velocity);
            }
        }
    } else if (b2 > 0.0 && b1 < 0.0 && end.velocity > 0.0) || (b2 < 0.0 && b1 > 0.0 && end.velocity < 0.0) {
        widen(&mut extrema.position, at(-b1 / (2.0 * b2)).position);
        return;
    } else {
        return; // constant acceleration without a turn
    }
    let velocity = [b1, 2.0 * b2, 3.0 * b3, 4.0 * b4, 5.0 * b5];
    let one_way = if turns.is_empty() {
        !(b1 < 0.0 && end.velocity > 0.0 || b1 > 0.0 && end.velocity < 0.0)
    } else {
        roots::has_one_sign(velocity)
    };
    if !one_way {
        for u in Roots::between(&turns, velocity).iter() {
            widen(&mut extrema.position, at(u).position);
        }
    }
}
