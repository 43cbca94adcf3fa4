//! Pulses that take the least time for their velocity change, whatever the planner's timing.

use crate::math::sqrt;
use crate::pulse::{Bounds, MIN_RAMP_SHARE, Pulse, PulseLimits};
use crate::{Shape, Timing};

/// The quickest acceleration pulses of one direction: [P, Alg. 1] (MSAP) and [P, Alg. 2] (MAP), each ramp as short as
/// the jerk bounds allow.
///
/// A pulse for a velocity change Δv has the peak acceleration min(A, √(Δv/s)), with A the limit and s half the sum of
/// both ramps' durations per acceleration. It takes Δv/A + s·A from s·A² on, and 2·√(s·Δv) below: of all peak
/// accelerations this one takes the least time.
///
/// An [eased](Family::eased) family has the peak acceleration min(A, √(y·Δv/s)) instead, y ≤ 1 its share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Family {
    /// Peak acceleration A, > 0; at most what fits into a period.
    pub(crate) acceleration: f64,
    /// Duration of the rising ramp at A \[s\].
    pub(crate) ramp_up: f64,
    /// Duration of the falling ramp at A \[s\].
    pub(crate) ramp_down: f64,
    /// Velocity change of two full ramps without a cruise, s·A²: dV_min of [P, Eq. (dvmin)].
    ramps_only: f64,
    /// Least velocity change whose peak acceleration is A, s·A²/y.
    pub(crate) full_from: f64,
    /// (time of a pulse below A)²/(4·Δv) [s³/rad or s³/m]: s, and more if eased.
    pub(crate) slowness: f64,
    /// Duration of a pulse below A per duration of its ramps: (1 + 1/y)/2.
    lengthening: f64,
    /// ∫∫ of the shape over its ramp, A = T = 1.
    pub(crate) displacement: f64,
    /// Velocity beyond the ends of the shape's ramp, A = T = 1.
    reverse_velocity: f64,
}

impl Family {
    /// The pulses that lead to the peak velocity.
    pub(crate) fn towards_peak(bounds: Bounds, shape: Shape, period: f64) -> Self {
        // `Fastest` would lengthen a ramp far shorter than the other one.
        Self::from_pulses(&PulseLimits::new(bounds, shape, Timing::Stretched, period), shape)
    }

    /// The pulses that lead away from the peak velocity: those of the mirrored time, reversed.
    pub(crate) fn from_peak(bounds: Bounds, shape: Shape, period: f64) -> Self {
        let Bounds { jerk_up, jerk_down, .. } = bounds;
        let mirrored = Bounds { jerk_up: jerk_down, jerk_down: jerk_up, ..bounds };
        let family = Self::towards_peak(mirrored, shape, period);
        Self { ramp_up: family.ramp_down, ramp_down: family.ramp_up, ..family }
    }

    fn from_pulses(pulses: &PulseLimits, shape: Shape) -> Self {
        let PulseLimits { acceleration, ramp_up, ramp_down, .. } = *pulses;
        let constants = shape.constants();
        let ramps_only = 0.5 * acceleration * (ramp_up + ramp_down);
        Self {
            acceleration,
            ramp_up,
            ramp_down,
            ramps_only,
            full_from: ramps_only,
            slowness: 0.5 * (ramp_up + ramp_down) / acceleration,
            lengthening: 1.0,
            displacement: constants.displacement,
            reverse_velocity: constants.reverse_velocity,
        }
    }

    /// The same pulses with the `share` y of the square of the peak acceleration, 0 < y ≤ 1, where that is below A.
    pub(crate) fn eased(&self, share: f64) -> Self {
        let lengthening = 0.5 + 0.5 / share;
        Self {
            full_from: self.ramps_only / share,
            slowness: self.slowness * (share * lengthening * lengthening),
            lengthening,
            ..*self
        }
    }

    /// Duration of the pulse for a velocity change ≥ 0 \[s\].
    #[inline]
    pub(crate) fn time(&self, change: f64) -> f64 {
        let ramps = self.ramp_up + self.ramp_down;
        if change >= self.full_from {
            ramps + (change - self.ramps_only) / self.acceleration
        } else if change > 0.0 {
            ramps * self.scale(change) * self.lengthening
        } else {
            0.0
        }
    }

    /// The pulse for a velocity change > 0, all its durations `stretch` times as long as they need be.
    #[inline]
    pub(crate) fn pulse(&self, change: f64, stretch: f64) -> Pulse {
        let (scale, cruise) = if change >= self.full_from {
            (1.0, (change - self.ramps_only) / self.acceleration)
        } else {
            let scale = self.scale(change);
            (scale, scale * (self.ramp_up + self.ramp_down) * (self.lengthening - 1.0))
        };
        let (ramp_up, ramp_down) = (self.ramp_up * scale * stretch, self.ramp_down * scale * stretch);
        let cruise = cruise * stretch;
        let acceleration = change / (cruise + 0.5 * (ramp_up + ramp_down));
        Pulse { acceleration, ramp_up, cruise, ramp_down, rest: 0.0 }
    }

    /// ∫(end velocity − velocity)dt over `pulse`, signed along its direction [rad or m].
    #[inline]
    pub(crate) fn lag(&self, pulse: &Pulse) -> f64 {
        pulse.acceleration * pulse.moment(self.displacement)
    }

    /// ∫(velocity − start velocity)dt over `pulse`, signed along its direction [rad or m].
    #[inline]
    pub(crate) fn lead(&self, pulse: &Pulse) -> f64 {
        let reversed = Pulse { ramp_up: pulse.ramp_down, ramp_down: pulse.ramp_up, ..*pulse };
        pulse.acceleration * reversed.moment(self.displacement)
    }

    /// Largest velocity beyond the ends of a pulse that changes the velocity by at most `change` [rad/s or m/s].
    pub(crate) fn overshoot(&self, change: f64) -> f64 {
        let share = (change / self.ramps_only).min(1.0);
        self.reverse_velocity * self.acceleration * share * self.ramp_up.max(self.ramp_down)
    }

    /// Ramp durations of a pulse below A as a share of the full ones, a_peak/A of [P, Eq. (apeak time)].
    #[inline]
    fn scale(&self, change: f64) -> f64 {
        sqrt(change / self.full_from).max(MIN_RAMP_SHARE)
    }
}
