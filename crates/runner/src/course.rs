//! One joint's reference over one policy period: how it gets from one velocity to the next.

use jbtg::{State, Trajectory};

/// How a velocity change is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Profile {
    /// Jerk-bounded: quintics, zero acceleration at both ends. What this system moves by.
    JerkBounded,
    /// At the period's beginning at once, as if actions were sent to the controller: infinite acceleration.
    Step,
    /// At the full acceleration of the reference's limits, then at the new velocity: infinite jerk.
    Trapezoid,
}

/// The reference of one joint over one period.
#[derive(Clone, Copy, Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "the large one is the one in use; a box would allocate every period"
)]
pub(crate) enum Course {
    JerkBounded(Trajectory),
    /// Constant `acceleration` for `ramp` \[s\] from the start, then at `velocity` to the `end`.
    Ramp {
        start: State,
        acceleration: f64,
        ramp: f64,
        velocity: f64,
        end: State,
    },
}

impl Course {
    /// From `position` at `v1` to `v2` over `period` \[s\]: at once, or at `acceleration` > 0.
    pub(crate) fn ramp(position: f64, v1: f64, v2: f64, period: f64, acceleration: Option<f64>) -> Self {
        let start = State { position, velocity: v1, acceleration: 0.0, jerk: 0.0 };
        let (acceleration, ramp) = match acceleration {
            Some(size) => ((v2 - v1).signum() * size, ((v2 - v1).abs() / size).min(period)),
            None => (0.0, 0.0),
        };
        let position = position + ramp * 0.5 * (v1 + v2) + (period - ramp) * v2;
        let end = State { position, velocity: v2, acceleration: 0.0, jerk: 0.0 };
        Self::Ramp { start, acceleration, ramp, velocity: v2, end }
    }

    /// State at `time` since the period's beginning \[s\].
    pub(crate) fn state_at(&self, time: f64) -> State {
        match self {
            Self::JerkBounded(trajectory) => trajectory.state_at(time),
            Self::Ramp { start, acceleration, ramp, .. } if time < *ramp => State {
                position: start.position + time * (start.velocity + 0.5 * time * acceleration),
                velocity: start.velocity + time * acceleration,
                acceleration: *acceleration,
                jerk: 0.0,
            },
            Self::Ramp { start, ramp, velocity, .. } => State {
                position: start.position
                    + 0.5 * ramp * (start.velocity + velocity)
                    + (time - ramp) * velocity,
                velocity: *velocity,
                acceleration: 0.0,
                jerk: 0.0,
            },
        }
    }

    /// State at the period's end.
    pub(crate) fn end(&self) -> State {
        match self {
            Self::JerkBounded(trajectory) => trajectory.end(),
            Self::Ramp { end, .. } => *end,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ramps_and_steps_end_where_their_states_lead() {
        for acceleration in [None, Some(0.65)] {
            let course = Course::ramp(0.3, 0.05, 0.03, 0.05, acceleration);
            let (last, end) = (course.state_at(0.05), course.end());
            assert!((last.position - end.position).abs() < 1e-15 && last.velocity == end.velocity);
            let mut position = 0.3;
            for n in 0..50_000 {
                position += course.state_at((f64::from(n) + 0.5) * 1e-6).velocity * 1e-6;
            }
            assert!((position - end.position).abs() < 1e-9, "{position} against {}", end.position);
        }
    }
}
