//! Exact extrema of quintic segments.

use crate::Interval;
use crate::roots::Roots;
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
}

/// `extrema` widened by everything that happens within `segment`, its ends included.
pub(crate) fn including_segment(mut extrema: Extrema, segment: &Segment) -> Extrema {
    let duration = segment.duration;
    let at = |u: f64| segment.state_at(u * duration);
    for state in [segment.state_at(0.0), segment.state_at(duration)] {
        extrema = extrema.union(Extrema::at(state));
    }
    // In u = t/T, so that all coefficients of one polynomial have one magnitude.
    let [_, b1, b2, b3, b4, b5] = segment.coefficients;
    let (d2, d3) = (duration * duration, duration * duration * duration);
    let (b2, b3, b4, b5) = (b2 * duration, b3 * d2, b4 * d3, b5 * d3 * duration);
    let snap = Roots::of_linear(24.0 * b4, 120.0 * b5);
    for u in snap.iter() {
        extrema.jerk = extrema.jerk.including(at(u).jerk);
    }
    let jerk = Roots::between(&snap, [6.0 * b3, 24.0 * b4, 60.0 * b5, 0.0, 0.0]);
    for u in jerk.iter() {
        extrema.acceleration = extrema.acceleration.including(at(u).acceleration);
    }
    let acceleration = Roots::between(&jerk, [2.0 * b2, 6.0 * b3, 12.0 * b4, 20.0 * b5, 0.0]);
    for u in acceleration.iter() {
        extrema.velocity = extrema.velocity.including(at(u).velocity);
    }
    let velocity = Roots::between(&acceleration, [b1, 2.0 * b2, 3.0 * b3, 4.0 * b4, 5.0 * b5]);
    for u in velocity.iter() {
        extrema.position = extrema.position.including(at(u).position);
    }
    extrema
}
