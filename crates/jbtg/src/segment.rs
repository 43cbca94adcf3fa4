//! One quintic segment, [P, Eq. (polynomial)].

use crate::shape::ShapeConstants;

/// Motion of one joint at one instant. Any values are legal.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct State {
    /// Position [rad or m].
    pub position: f64,
    /// Velocity [rad/s or m/s].
    pub velocity: f64,
    /// Acceleration [rad/s² or m/s²].
    pub acceleration: f64,
    /// Jerk [rad/s³ or m/s³].
    pub jerk: f64,
}

/// One quintic b₅t⁵ + b₄t⁴ + b₃t³ + b₂t² + b₁t + b₀ in the time since its own start.
///
/// Source: [P, Eq. (polynomial)]; the coefficients are closed forms of the ramp shape and solve
/// [P, Eq. (eqmat)].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    pub(crate) start: f64,
    pub(crate) duration: f64,
    pub(crate) coefficients: [f64; 6],
}

/// What the acceleration does within a segment.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Ramp {
    Rising,
    Constant,
    Falling,
}

impl Segment {
    pub(crate) const EMPTY: Self = Self { start: 0.0, duration: 0.0, coefficients: [0.0; 6] };

    /// A segment of the given `duration` > 0 with peak `acceleration`, signed.
    #[inline]
    pub(crate) fn new(
        start: f64,
        duration: f64,
        (position, velocity): (f64, f64),
        (ramp, acceleration): (Ramp, f64),
        shape: &ShapeConstants,
    ) -> Self {
        let [c3, c4, c5] = shape.position;
        let (half, a3, a4, a5) = match ramp {
            Ramp::Rising => (0.0, acceleration, acceleration, acceleration),
            Ramp::Constant => (0.5 * acceleration, 0.0, 0.0, 0.0),
            Ramp::Falling => (0.5 * acceleration, -acceleration, -acceleration, -acceleration),
        };
        let per_time = 1.0 / duration;
        let per_square = per_time * per_time;
        let coefficients = [
            position,
            velocity,
            half,
            c3 * a3 * per_time,
            c4 * a4 * per_square,
            c5 * a5 * per_square * per_time,
        ];
        Self { start, duration, coefficients }
    }

    /// Time at which the segment starts, since the start of its trajectory \[s\].
    #[must_use]
    pub const fn start(&self) -> f64 {
        self.start
    }

    /// Duration \[s\], > 0; 0 only where a stop starts at rest.
    #[must_use]
    pub const fn duration(&self) -> f64 {
        self.duration
    }

    /// Coefficients [b₀, b₁, b₂, b₃, b₄, b₅] in SI units, in the time since [`Segment::start`].
    #[must_use]
    pub const fn coefficients(&self) -> [f64; 6] {
        self.coefficients
    }

    /// What is left of the segment after `time`, 0 < `time` < duration.
    pub(crate) fn from(&self, time: f64) -> Self {
        let State { position, velocity, acceleration, jerk } = self.state_at(time);
        let [.., b4, b5] = self.coefficients;
        Self {
            start: self.start + time,
            duration: self.duration - time,
            coefficients: [position, velocity, 0.5 * acceleration, jerk / 6.0, b4 + 5.0 * time * b5, b5],
        }
    }

    /// State `time` after the segment's own start \[s\]; the polynomial as it is, also outside the segment.
    #[must_use]
    #[inline]
    pub fn state_at(&self, time: f64) -> State {
        let [b0, b1, b2, b3, b4, b5] = self.coefficients;
        let t = time;
        State {
            position: b0 + t * (b1 + t * (b2 + t * (b3 + t * (b4 + t * b5)))),
            velocity: b1 + t * (2.0 * b2 + t * (3.0 * b3 + t * (4.0 * b4 + t * (5.0 * b5)))),
            acceleration: 2.0 * b2 + t * (6.0 * b3 + t * (12.0 * b4 + t * (20.0 * b5))),
            jerk: 6.0 * b3 + t * (24.0 * b4 + t * (60.0 * b5)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rest_of_a_segment_is_the_segment_later_on() {
        let whole = Segment { start: 2.0, duration: 0.5, coefficients: [0.3, -0.2, 0.5, 1.1, -0.7, 0.4] };
        let rest = whole.from(0.2);
        assert_eq!((rest.start, rest.duration), (2.2, 0.3));
        for time in [0.0, 0.1, 0.3, 2.0] {
            let (later, state) = (whole.state_at(0.2 + time), rest.state_at(time));
            let pairs = [
                (later.position, state.position),
                (later.velocity, state.velocity),
                (later.acceleration, state.acceleration),
                (later.jerk, state.jerk),
            ];
            for (a, b) in pairs {
                assert!((a - b).abs() <= 1e-14 * a.abs().max(1.0), "{later:?}, {state:?} after {time}");
            }
        }
    }
}
