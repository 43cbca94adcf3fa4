//! Acceleration pulses of one direction: [P, Alg. 1] (MSAP) and [P, Alg. 2] (MAP) in one formula.

use crate::math::sqrt;
use crate::shape::ShapeConstants;
use crate::{Shape, Timing};

/// Direction of a velocity change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Towards a larger velocity.
    Increasing,
    /// Towards a smaller velocity.
    Decreasing,
}

/// Shortest ramp as a share of the period. Shorter ones gain nothing and overflow the quintic's coefficients.
pub(crate) const MIN_RAMP_SHARE: f64 = 1e-6;

/// Relative distance kept from the acceleration and jerk bounds, so that rounding never crosses them.
pub(crate) const GUARD: f64 = 1e-14;

/// Magnitudes that bound the pulses of one direction, and what follows from them.
///
/// `acceleration`, `ramp_up` and `ramp_down` describe the largest pulse that fits into one period.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PulseLimits {
    /// Peak acceleration of the largest pulse, > 0.
    pub(crate) acceleration: f64,
    /// Duration of the rising ramp at that acceleration \[s\].
    pub(crate) ramp_up: f64,
    /// Duration of the falling ramp at that acceleration \[s\].
    pub(crate) ramp_down: f64,
    /// Velocity change of the largest pulse, > 0: the authority Δ of one period.
    pub(crate) velocity_change: f64,
    /// Share of what the acceleration limit alone would allow in one period.
    pub(crate) share: f64,
    /// The period \[s\].
    period: f64,
    /// Peak acceleration per velocity change of a stretched pulse [1/s].
    stretched_gain: f64,
    /// Lag per velocity change of a stretched pulse \[s\].
    stretched_lag: f64,
    /// Velocity change of two full ramps without a cruise, dV_min of [P, Eq. (dvmin)].
    pub(crate) ramps_only: f64,
    /// 1/`ramps_only`.
    per_ramps_only: f64,
    /// 1/`acceleration`.
    per_acceleration: f64,
    /// Lag of MAP per velocity change and [`scale`](Self::scale) \[s\].
    scaled_lag: f64,
    /// ∫∫ of the shape over its ramp, A = T = 1.
    displacement: f64,
    timing: Timing,
}

/// One acceleration pulse: ramp up, cruise, ramp down, then rest until the period ends. Times in s.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pulse {
    pub(crate) acceleration: f64,
    pub(crate) ramp_up: f64,
    pub(crate) cruise: f64,
    pub(crate) ramp_down: f64,
    pub(crate) rest: f64,
}

/// Magnitudes of the bounds on one direction's pulses, as the limits give them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    /// Acceleration along the direction.
    pub(crate) along: f64,
    /// Acceleration against it; only shapes that leave [0, A] come near.
    pub(crate) against: f64,
    /// Jerk of the rising ramp.
    pub(crate) jerk_up: f64,
    /// Jerk of the falling ramp.
    pub(crate) jerk_down: f64,
    /// Least distance from 0 of the two velocity bounds; only shapes whose velocity overshoots need it.
    pub(crate) speed: f64,
}

impl PulseLimits {
    /// The largest pulse within `bounds` and `period`.
    pub(crate) fn new(bounds: Bounds, shape: Shape, timing: Timing, period: f64) -> Self {
        let constants = shape.constants();
        let (up, down) = ramp_times_per_acceleration(bounds, timing, &constants);
        let limit = bounds.along.min(bounds.against / constants.reverse_acceleration) * (1.0 - GUARD)
            / (1.0 + constants.reverse_acceleration);
        let mut acceleration = limit;
        if (up + down) * acceleration > period {
            acceleration = period / (up + down); // a_peak of [P, Eq. (apeak)]
        }
        if constants.reverse_velocity > 0.0 {
            let overshoot_per_square = constants.reverse_velocity * up.max(down);
            acceleration = acceleration.min(sqrt(0.5 * bounds.speed / overshoot_per_square));
        }
        let shortest = MIN_RAMP_SHARE * period;
        let (mut ramp_up, mut ramp_down) =
            ((up * acceleration).max(shortest), (down * acceleration).max(shortest));
        let excess = (ramp_up + ramp_down) / period;
        if excess > 1.0 {
            (ramp_up, ramp_down) = (ramp_up / excess, ramp_down / excess);
        }
        let allowed = bounds.along * period;
        Self::from_ramps(acceleration, (ramp_up, ramp_down), allowed, constants.displacement, timing, period)
    }

    /// The largest pulse with ramps of the given durations, which fit into the period and are no shorter than those
    /// of `self`, unless that is because they do not fit.
    pub(crate) fn with_ramps(&self, ramp_up: f64, ramp_down: f64) -> Self {
        let (up, down) = (ramp_up / self.ramp_up, ramp_down / self.ramp_down);
        let acceleration = self.acceleration * up.min(down).min(1.0); // shorter ramps, less jerk's worth
        let allowed = self.velocity_change / self.share;
        let ramps = (ramp_up, ramp_down);
        Self::from_ramps(acceleration, ramps, allowed, self.displacement, self.timing, self.period)
    }

    /// `allowed` is the velocity change that the acceleration limit alone would allow in one period.
    fn from_ramps(
        acceleration: f64,
        (ramp_up, ramp_down): (f64, f64),
        allowed: f64,
        displacement: f64,
        timing: Timing,
        period: f64,
    ) -> Self {
        let width = period - 0.5 * (ramp_up + ramp_down);
        let cruise = (period - ramp_up - ramp_down).max(0.0);
        let largest = Pulse { acceleration: 1.0, ramp_up, cruise, ramp_down, rest: 0.0 };
        let ramps = Pulse { cruise: 0.0, ..largest };
        let ramps_only = 0.5 * acceleration * (ramp_up + ramp_down);
        Self {
            acceleration,
            ramp_up,
            ramp_down,
            velocity_change: acceleration * width,
            share: acceleration * width / allowed,
            period,
            stretched_gain: 1.0 / width,
            stretched_lag: largest.moment(displacement) / width,
            ramps_only,
            per_ramps_only: 1.0 / ramps_only,
            per_acceleration: 1.0 / acceleration,
            scaled_lag: 2.0 * ramps.moment(displacement) / (ramp_up + ramp_down),
            displacement,
            timing,
        }
    }

    /// The pulse that changes the velocity by `change`, 0 < change ≤ `velocity_change`, in one period.
    #[inline]
    pub(crate) fn pulse(&self, change: f64) -> Pulse {
        match self.timing {
            Timing::Stretched => Pulse {
                acceleration: change * self.stretched_gain,
                ramp_up: self.ramp_up,
                cruise: (self.period - self.ramp_up - self.ramp_down).max(0.0),
                ramp_down: self.ramp_down,
                rest: 0.0,
            },
            Timing::Fastest if change >= self.ramps_only => {
                // [P, Alg. 1], MSAP.
                let (cruise, room) = self.cruise(change);
                Pulse {
                    acceleration: (change / (cruise + 0.5 * (self.ramp_up + self.ramp_down)))
                        .min(self.acceleration),
                    ramp_up: self.ramp_up,
                    cruise,
                    ramp_down: self.ramp_down,
                    rest: room - cruise,
                }
            }
            Timing::Fastest => {
                // [P, Alg. 2], MAP: dV is proportional to a_peak², [P, Eq. (apeak time)].
                let scale = self.scale(change);
                let (ramp_up, ramp_down) = (self.ramp_up * scale, self.ramp_down * scale);
                Pulse {
                    acceleration: (2.0 * change / (ramp_up + ramp_down)).min(self.acceleration),
                    ramp_up,
                    cruise: 0.0,
                    ramp_down,
                    rest: (self.period - (ramp_up + ramp_down)).max(0.0),
                }
            }
        }
    }

    /// Distance by which a step stays behind motion at its end velocity for the whole period, `change` ≥ 0
    /// [rad or m]. It grows with the change.
    #[inline]
    pub(crate) fn lag(&self, change: f64) -> f64 {
        match self.timing {
            Timing::Stretched => change * self.stretched_lag,
            Timing::Fastest if change >= self.ramps_only => {
                let Self { acceleration, ramp_up, ramp_down, .. } = *self;
                let (cruise, _) = self.cruise(change);
                let pulse = Pulse { acceleration, ramp_up, cruise, ramp_down, rest: 0.0 };
                acceleration * pulse.moment(self.displacement)
            }
            Timing::Fastest => change * self.scale(change) * self.scaled_lag,
        }
    }

    /// Duration of MSAP's cruise, [P, Eq. (cruise time)], and what the ramps leave for it \[s\].
    #[inline]
    fn cruise(&self, change: f64) -> (f64, f64) {
        let room = (self.period - self.ramp_up - self.ramp_down).max(0.0);
        (((change - self.ramps_only) * self.per_acceleration).min(room), room)
    }

    /// Durations of MAP's ramps as a share of the full ones, a_peak/A of [P, Eq. (apeak time)].
    #[inline]
    fn scale(&self, change: f64) -> f64 {
        sqrt(change * self.per_ramps_only).max(MIN_RAMP_SHARE)
    }

    /// Largest distance per velocity change that a pulse first moves against its direction (or, seen from its end,
    /// has overshot by) \[s\].
    pub(crate) fn reverse_travel(&self, shape: Shape) -> f64 {
        let ramp = self.ramp_up.max(self.ramp_down);
        let travel = shape.constants().reverse_travel * ramp * ramp;
        match self.timing {
            Timing::Stretched => travel * self.stretched_gain,
            // A·T²/Δv grows with Δv up to the full pulse without cruise and falls from there on.
            Timing::Fastest => travel * self.acceleration / self.ramps_only,
        }
    }

    /// Largest velocity beyond the interval between the ends, for changes up to `change` [rad/s or m/s].
    pub(crate) fn reverse_velocity(&self, shape: Shape, change: f64) -> f64 {
        let ramp = self.ramp_up.max(self.ramp_down);
        let per_acceleration = shape.constants().reverse_velocity * ramp;
        let change = change.min(self.velocity_change);
        let acceleration = match self.timing {
            Timing::Stretched => change * self.stretched_gain,
            Timing::Fastest => self.acceleration * (change / self.ramps_only).min(1.0),
        };
        acceleration * per_acceleration
    }
}

impl Pulse {
    /// First moment of the pulse about its start, per acceleration [s²].
    #[inline]
    pub(crate) fn moment(&self, displacement: f64) -> f64 {
        let Self { ramp_up, cruise, ramp_down, .. } = *self;
        (0.5 - displacement) * ramp_up * ramp_up
            + cruise * (ramp_up + 0.5 * cruise)
            + ramp_down * (0.5 * (ramp_up + cruise) + displacement * ramp_down)
    }
}

/// Ramp durations per acceleration [s per rad/s² or m/s²] that keep both jerk bounds.
///
/// With `Fastest` timing the falling ramp takes at least a tenth of the rising one: otherwise a larger velocity
/// change could yield a *smaller* displacement, and displacement must grow with the end velocity.
fn ramp_times_per_acceleration(bounds: Bounds, timing: Timing, constants: &ShapeConstants) -> (f64, f64) {
    let Bounds { jerk_up, jerk_down, .. } = bounds;
    let (jerk_up, jerk_down) = (jerk_up * (1.0 - GUARD), jerk_down * (1.0 - GUARD));
    let up = (constants.ramp_time / jerk_up).max(constants.reverse_jerk / jerk_down);
    let down = (constants.ramp_time / jerk_down).max(constants.reverse_jerk / jerk_up);
    match timing {
        Timing::Stretched => (up, down),
        Timing::Fastest => (up, down.max(0.1 * up)),
    }
}
