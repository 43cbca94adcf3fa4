//! The reference between two of its samples.

use jbtg::State;

/// The quintic through position, velocity and acceleration of two samples, [P, Eq. (eqmat)] over one sampling period.
///
/// A controller that is faster than the reference would otherwise see a staircase, and answer each stair with jerk. The
/// reference is itself made of quintics, so this is the reference, but for the few periods in which one quintic ends and
/// the next begins.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Interpolation {
    start: State,
    /// Of u³, u⁴ and u⁵, u = time over `period`.
    cubic: f64,
    quartic: f64,
    quintic: f64,
    period: f64,
}

impl Interpolation {
    /// A joint that stays where it is.
    pub(crate) fn at_rest(position: f64) -> Self {
        let start = State { position, velocity: 0.0, acceleration: 0.0, jerk: 0.0 };
        Self { start, cubic: 0.0, quartic: 0.0, quintic: 0.0, period: 1.0 }
    }

    /// Between two samples that are `period` apart \[s\].
    pub(crate) fn new(start: State, end: State, period: f64) -> Self {
        // What the parabola of the first sample misses at the second, in position, velocity and acceleration times the
        // powers of the period.
        let velocity = period * start.velocity;
        let acceleration = period * period * start.acceleration;
        let position_gap = end.position - start.position - velocity - 0.5 * acceleration;
        let velocity_gap = period * end.velocity - velocity - acceleration;
        let acceleration_gap = period * period * end.acceleration - acceleration;
        Self {
            start,
            cubic: 10.0 * position_gap - 4.0 * velocity_gap + 0.5 * acceleration_gap,
            quartic: -15.0 * position_gap + 7.0 * velocity_gap - acceleration_gap,
            quintic: 6.0 * position_gap - 3.0 * velocity_gap + 0.5 * acceleration_gap,
            period,
        }
    }

    /// State `time` after the first sample.
    pub(crate) fn state_at(&self, time: f64) -> State {
        let Self { start, cubic, quartic, quintic, period } = *self;
        let u = time / period;
        let position = u * u * u * (cubic + u * (quartic + u * quintic));
        let velocity = u * u * (3.0 * cubic + u * (4.0 * quartic + u * 5.0 * quintic));
        let acceleration = u * (6.0 * cubic + u * (12.0 * quartic + u * 20.0 * quintic));
        let jerk = 6.0 * cubic + u * (24.0 * quartic + u * 60.0 * quintic);
        State {
            position: start.position + time * (start.velocity + 0.5 * time * start.acceleration) + position,
            velocity: start.velocity + time * start.acceleration + velocity / period,
            acceleration: start.acceleration + acceleration / (period * period),
            jerk: jerk / (period * period * period),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quintic_is_its_own_interpolation() {
        let quintic = |t: f64| State {
            position: 1.0 + t * (2.0 + t * (3.0 + t * (-4.0 + t * (5.0 - 6.0 * t)))),
            velocity: 2.0 + t * (6.0 + t * (-12.0 + t * (20.0 - 30.0 * t))),
            acceleration: 6.0 + t * (-24.0 + t * (60.0 - 120.0 * t)),
            jerk: -24.0 + t * (120.0 - 360.0 * t),
        };
        let between = Interpolation::new(quintic(0.0), quintic(0.5), 0.5);
        for share in [0.0, 0.2, 0.5, 0.9, 1.0] {
            let (found, wanted) = (between.state_at(0.5 * share), quintic(0.5 * share));
            let errors = [
                found.position - wanted.position,
                found.velocity - wanted.velocity,
                found.acceleration - wanted.acceleration,
                found.jerk - wanted.jerk,
            ];
            assert!(errors.iter().all(|error| error.abs() < 1e-11), "{errors:?} at {share}");
        }
    }

    #[test]
    fn rest_stays_rest() {
        let State { position, velocity, acceleration, jerk } = Interpolation::at_rest(0.3).state_at(7.0);
        assert_eq!([position, velocity, acceleration, jerk], [0.3, 0.0, 0.0, 0.0]);
    }
}
