//! The largest velocity whose step still leaves room to brake.

use jbtg::{Interval, Planner};

use crate::side::Braking;
use crate::table::{Knot, interpolate};

/// Where braking distances come from, with the spacing of the velocities between which they are smooth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Distances<'a> {
    pub(crate) knots: Option<&'a [Knot]>,
    pub(crate) spacing: f64,
}

/// One limit, seen from one state; mirrored coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Approach<'a> {
    pub(crate) planner: &'a Planner,
    pub(crate) braking: &'a Braking,
    pub(crate) distances: Distances<'a>,
    /// Position [rad or m].
    pub(crate) position: f64,
    /// Velocity [rad/s or m/s].
    pub(crate) velocity: f64,
    /// Velocities that one period can reach [rad/s or m/s].
    pub(crate) reachable: Interval,
    /// The braking velocity, one of them [rad/s or m/s].
    pub(crate) brake: f64,
}

impl Approach<'_> {
    /// Stopping distance from `velocity` [rad or m].
    #[inline]
    pub(crate) fn distance(&self, velocity: f64) -> f64 {
        match self.distances.knots {
            Some(knots) => interpolate(knots, velocity),
            None if velocity > self.braking.velocity * (1.0 + 1e-9) => f64::INFINITY,
            None => self.braking.distance(self.planner, velocity),
        }
    }

    /// Travel until rest of a step to `velocity` followed by braking [rad or m]. Grows with `velocity`.
    #[inline]
    fn travel(&self, velocity: f64) -> f64 {
        self.braking.displacement(self.planner, self.velocity, velocity) + self.distance(velocity)
    }

    /// Largest reachable velocity after which braking still stops before the limit, or the braking velocity if there
    /// is none [rad/s or m/s].
    ///
    /// The travel is monotone in the velocity, so the admissible velocities form an interval from below.
    pub(crate) fn max_velocity(&self) -> f64 {
        let room = self.braking.limit - self.braking.guard - self.position;
        let high = (self.reachable.max, self.travel(self.reachable.max));
        if high.1 <= room {
            return high.0;
        }
        let low = (self.brake, self.travel(self.brake));
        if low.1 > room || low.0 >= high.0 {
            return low.0;
        }
        let (low, high) = self.smooth_bracket(low, high, room);
        self.refine(low, high, room)
    }

    /// Narrows (velocity, travel) brackets to a stretch on which the travel has no kink.
    fn smooth_bracket(
        &self,
        mut low: (f64, f64),
        mut high: (f64, f64),
        room: f64,
    ) -> ((f64, f64), (f64, f64)) {
        let mut split = |velocity: f64| {
            let travel = self.travel(velocity);
            if travel <= room {
                low = (velocity, travel)
            } else {
                high = (velocity, travel)
            }
            (low.0, high.0)
        };
        let (mut below, mut above) = (self.brake, self.reachable.max);
        for kink in [0.0, self.velocity] {
            if below < kink && kink < above {
                (below, above) = split(kink);
            }
        }
        let spacing = self.distances.spacing;
        if above > 0.0 {
            let (mut first, mut last) = ((below / spacing) as u64 + 1, (above / spacing) as u64);
            while first <= last {
                let middle = first + (last - first) / 2;
                let kink = middle as f64 * spacing;
                if kink <= below {
                    first = middle + 1;
                } else if kink >= above {
                    last = middle - 1;
                } else {
                    let was_above = above;
                    (below, above) = split(kink);
                    if above < was_above { last = middle - 1 } else { first = middle + 1 }
                }
            }
        }
        (low, high)
    }

    /// The root of travel = room by the Illinois method, from the safe side. One step where the travel is linear.
    fn refine(&self, mut low: (f64, f64), mut high: (f64, f64), room: f64) -> f64 {
        let tolerance = 0.125 * self.braking.rounding;
        let (mut low_excess, mut high_excess) = (low.1 - room, high.1 - room);
        for _ in 0..60 {
            let share = if high_excess.is_finite() { low_excess / (low_excess - high_excess) } else { 0.5 };
            let velocity = (low.0 + share * (high.0 - low.0)).clamp(low.0, high.0);
            let travel = self.travel(velocity);
            let excess = travel - room;
            if excess.abs() <= tolerance {
                return velocity;
            }
            if excess < 0.0 {
                low = (velocity, travel);
                low_excess = excess;
                high_excess *= 0.5;
            } else {
                high = (velocity, travel);
                high_excess = excess;
                low_excess *= 0.5;
            }
        }
        low.0
    }
}
