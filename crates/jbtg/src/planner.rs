//! Plans one period: from one velocity to another with zero acceleration at both ends.

mod errors;
mod waypoint;

pub use errors::{PlannerError, RampError};

use crate::detour::DetourLimits;
use crate::pulse::{Bounds, Direction, Pulse, PulseLimits};
use crate::shape::ShapeConstants;
use crate::{Interval, Limits, Shape, Timing, Trajectory};

/// Smallest share of the acceleration limit that a period may leave; see [`Authority::share`].
pub const MIN_AUTHORITY_SHARE: f64 = 1e-4;

/// What a [`Planner`] is made of; not yet checked together.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct PlannerSpec {
    /// Limits of the joint.
    pub limits: Limits,
    /// Shape of the acceleration ramps.
    pub shape: Shape,
    /// How a step spends the period.
    pub timing: Timing,
    /// Duration of one step \[s\]: the policy's period.
    pub period: f64,
}

/// What one period can do to the velocity in one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Authority {
    /// Largest velocity change within one period, Δ [rad/s or m/s], > 0.
    pub velocity_change: f64,
    /// Δ/(A·period): what zero acceleration at both ends of every period leaves of the acceleration limit A, in
    /// (0, 1).
    pub share: f64,
    /// Velocity change of two full ramps without a cruise, dV_min of [P, Eq. (dvmin)] [rad/s or m/s], at most Δ.
    /// With [`Timing::Fastest`] smaller changes have smaller ramps (MAP), larger ones a cruise (MSAP).
    pub ramps_only: f64,
    /// Duration of the rising ramp of the largest step \[s\].
    pub ramp_up: f64,
    /// Duration of the falling ramp of the largest step \[s\].
    pub ramp_down: f64,
    /// Largest distance per velocity change by which a step first moves against its own direction, or has
    /// overshot before its end \[s\]. 0 for [`Shape::Smoothstep`].
    pub reverse_travel: f64,
}

/// Plans steps of one joint, each exactly one period long, within its velocity, acceleration and jerk limits.
///
/// Position limits are not its business: `safezone` sees to them.
///
/// A step starts and ends with zero acceleration (and zero jerk, with [`Shape::Smoothstep`]).
/// Source: [P, Alg. 1], [P, Alg. 2] and [P, Alg. 3], for both directions and for limits that differ between them.
/// [`Planner::ramp`] goes from one velocity to the other directly, [`Planner::waypoint`] through a peak velocity for
/// the greatest displacement.
///
/// # Examples
/// ```
/// use jbtg::{Interval, Limits, Planner, PlannerSpec, Shape, SymmetricLimits, Timing};
///
/// let limits = Limits::try_from(SymmetricLimits {
///     position: Interval::new(0.14, 0.50),
///     velocity: 0.15,
///     acceleration: 1.0,
///     jerk: 100.0,
/// })?;
/// let spec = PlannerSpec { limits, shape: Shape::default(), timing: Timing::default(), period: 0.05 };
/// let planner = Planner::try_from(spec)?;
/// let step = planner.ramp(0.3, 0.10, 0.12)?;
/// assert_eq!(step.end().velocity, 0.12);
/// assert!((step.end().position - (0.3 + 0.05 * 0.11)).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Planner {
    spec: PlannerSpec,
    /// Velocity bounds, tightened by what the shape's velocity overshoots.
    velocity: Interval,
    increasing: PulseLimits,
    decreasing: PulseLimits,
    shape: ShapeConstants,
    detours: DetourLimits,
}

impl TryFrom<PlannerSpec> for Planner {
    type Error = PlannerError;

    fn try_from(spec: PlannerSpec) -> Result<Self, PlannerError> {
        let PlannerSpec { limits, shape, timing, period } = spec;
        if !(period.is_finite() && period > 0.0) {
            return Err(PlannerError::Period { period });
        }
        let (velocity, acceleration, jerk) = (limits.velocity(), limits.acceleration(), limits.jerk());
        let farthest = period * velocity.width();
        if !farthest.is_finite() {
            return Err(PlannerError::OutOfScale { name: "distance at full speed", value: farthest });
        }
        let speed = velocity.max.min(-velocity.min);
        let up = Bounds {
            along: acceleration.max,
            against: -acceleration.min,
            jerk_up: jerk.max,
            jerk_down: -jerk.min,
            speed,
        };
        let down = Bounds {
            along: -acceleration.min,
            against: acceleration.max,
            jerk_up: -jerk.min,
            jerk_down: jerk.max,
            speed,
        };
        let increasing = PulseLimits::new(up, shape, timing, period);
        let decreasing = PulseLimits::new(down, shape, timing, period);
        for pulse in [&increasing, &decreasing] {
            check_authority(pulse, period, speed)?;
        }
        let detours = DetourLimits::new(up, down, velocity, shape, period);
        let velocity = tightened(velocity, (&increasing, &decreasing), shape)?;
        Ok(Self { spec, velocity, increasing, decreasing, shape: shape.constants(), detours })
    }
}

impl Planner {
    /// What this planner was made of.
    #[must_use]
    pub const fn spec(&self) -> &PlannerSpec {
        &self.spec
    }

    /// Limits of the joint.
    #[must_use]
    pub const fn limits(&self) -> &Limits {
        &self.spec.limits
    }

    /// Duration of every step \[s\].
    #[must_use]
    pub const fn period(&self) -> f64 {
        self.spec.period
    }

    /// The velocities that steps may end at [rad/s or m/s]: the velocity limits, tightened by up to 3e-5 of their
    /// width for [`Shape::SineQuintic`], whose velocity overshoots its ends.
    #[must_use]
    pub const fn velocity(&self) -> Interval {
        self.velocity
    }

    /// What one period can do to the velocity in `direction`.
    #[must_use]
    pub fn authority(&self, direction: Direction) -> Authority {
        let pulse = self.pulses(direction);
        Authority {
            velocity_change: pulse.velocity_change,
            share: pulse.share,
            ramps_only: pulse.ramps_only,
            ramp_up: pulse.ramp_up,
            ramp_down: pulse.ramp_down,
            reverse_travel: pulse.reverse_travel(self.spec.shape),
        }
    }

    /// Whether the period is below 3·A/J in a direction, so that it is too short for two full ramps and most of
    /// the acceleration limit is never used. A warning: every step remains valid.
    #[must_use]
    pub fn is_period_short(&self) -> bool {
        let jerk = self.spec.limits.jerk();
        let slowest = jerk.max.min(-jerk.min);
        let acceleration = self.spec.limits.acceleration();
        self.spec.period * slowest < 3.0 * acceleration.max.max(-acceleration.min)
    }

    /// Velocities that one period can reach from `velocity` [rad/s or m/s], within the velocity limits.
    ///
    /// Never empty. From a velocity beyond a limit it holds what leads back fastest: everything reachable inside
    /// the limits, or the one reachable velocity nearest to them. The limit on the other side keeps so much more
    /// distance as a change beyond the whole interval overshoots more. NaN gives NaN ends, an infinity itself.
    #[must_use]
    #[inline]
    pub fn reachable(&self, velocity: f64) -> Interval {
        let Interval { min, max } = self.velocity;
        let highest = highest_within(velocity, self.increasing.velocity_change);
        let lowest = -highest_within(-velocity, self.decreasing.velocity_change);
        if velocity > max {
            let opposite = smaller(min + self.further_overshoot(velocity - max), max);
            return Interval::new(larger(opposite, lowest), larger(max, lowest));
        }
        if velocity < min {
            let opposite = larger(max - self.further_overshoot(min - velocity), min);
            return Interval::new(smaller(min, highest), smaller(opposite, highest));
        }
        Interval::new(larger(min, lowest), smaller(max, highest))
    }

    /// By how much a change that exceeds the width of the velocity interval by `excess` may overshoot more than the
    /// interval's own margin allows for [rad/s or m/s]. 0 for [`Shape::Smoothstep`].
    fn further_overshoot(&self, excess: f64) -> f64 {
        let limits = self.spec.limits.velocity();
        let margin = larger(limits.max - self.velocity.max, self.velocity.min - limits.min);
        margin * (excess / self.velocity.width())
    }

    /// Displacement of the step from `v1` to `v2` over one period [rad or m]: exactly what [`Planner::ramp`] adds
    /// to the position.
    ///
    /// A formula, so it also answers for velocities that [`Planner::ramp`] would refuse.
    #[must_use]
    #[inline]
    pub fn displacement(&self, v1: f64, v2: f64) -> f64 {
        let (pulses, sign, change) = self.towards(v2 - v1);
        v2 * self.spec.period - sign * pulses.lag(change)
    }

    /// The step from `position` and `v1` to `v2` in exactly one period.
    ///
    /// # Errors
    /// [`RampError::Unreachable`] with the reachable velocities if `v2` is not one of them,
    /// [`RampError::NotFinite`] for a NaN or an infinity, given or as the final position.
    #[inline]
    pub fn ramp(&self, position: f64, v1: f64, v2: f64) -> Result<Trajectory, RampError> {
        check_finite(position, v1, v2)?;
        let reachable = self.reachable(v1);
        if !reachable.contains(v2) {
            return Err(RampError::Unreachable { from: v1, to: v2, reachable });
        }
        check_end(position + self.displacement(v1, v2))?;
        Ok(self.step(position, v1, v2))
    }

    /// The step from `position` and `v1` to the reachable velocity nearest to `v2`: "reduce v₂", step 3 of
    /// [P, Alg. 1].
    ///
    /// The velocity taken is the trajectory's [`end`](Trajectory::end).
    ///
    /// # Errors
    /// [`RampError::NotFinite`] for a NaN or an infinity.
    pub fn ramp_saturated(&self, position: f64, v1: f64, v2: f64) -> Result<Trajectory, RampError> {
        check_finite(position, v1, v2)?;
        let v2 = self.reachable(v1).clamp(v2);
        check_end(position + self.displacement(v1, v2))?;
        Ok(self.step(position, v1, v2))
    }

    /// The same planner with both directions' rising and falling ramps of the given durations; see
    /// [`PulseLimits::with_ramps`].
    pub(crate) fn with_ramps(&self, ramp_up: f64, ramp_down: f64) -> Result<Self, PlannerError> {
        let PlannerSpec { limits, shape, period, .. } = self.spec;
        let [increasing, decreasing] =
            [&self.increasing, &self.decreasing].map(|pulses| pulses.with_ramps(ramp_up, ramp_down));
        let velocity = limits.velocity();
        for pulse in [&increasing, &decreasing] {
            check_authority(pulse, period, velocity.max.min(-velocity.min))?;
        }
        let velocity = tightened(velocity, (&increasing, &decreasing), shape)?;
        Ok(Self { velocity, increasing, decreasing, ..*self })
    }

    /// The step of the stepwise braking policy: towards zero by as much as one period allows.
    pub(crate) fn brake(&self, position: f64, velocity: f64) -> Trajectory {
        self.step(position, velocity, self.reachable(velocity).clamp(0.0))
    }

    /// The step from `position` and `v1` to the reachable velocity `v2`.
    #[inline]
    pub(crate) fn step(&self, position: f64, v1: f64, v2: f64) -> Trajectory {
        let pulse = self.signed_pulse(v2 - v1);
        let end = (position + self.displacement(v1, v2), v2);
        Trajectory::from_pulse(position, v1, (pulse, self.spec.period), end, &self.shape)
    }

    /// The pulse of a step that changes the velocity by `change`; it rests if that is 0.
    #[inline]
    fn signed_pulse(&self, change: f64) -> Pulse {
        let (pulses, sign, change) = self.towards(change);
        if change > 0.0 {
            let pulse = pulses.pulse(change);
            Pulse { acceleration: sign * pulse.acceleration, ..pulse }
        } else {
            let rest = self.spec.period; // Case 3 of [P, Alg. 3].
            Pulse { acceleration: 0.0, ramp_up: 0.0, cruise: 0.0, ramp_down: 0.0, rest }
        }
    }

    /// The pulses in the direction of a velocity change, its sign and its magnitude.
    #[inline]
    const fn towards(&self, change: f64) -> (&PulseLimits, f64, f64) {
        if change < 0.0 { (&self.decreasing, -1.0, -change) } else { (&self.increasing, 1.0, change) }
    }

    /// The larger peak acceleration of both directions' largest pulses, and the shortest of their ramps \[s\].
    pub(crate) fn largest_pulse(&self) -> (f64, f64) {
        let (up, down) = (&self.increasing, &self.decreasing);
        let ramp = up.ramp_up.min(up.ramp_down).min(down.ramp_up).min(down.ramp_down);
        (up.acceleration.max(down.acceleration), ramp)
    }

    const fn pulses(&self, direction: Direction) -> &PulseLimits {
        match direction {
            Direction::Increasing => &self.increasing,
            Direction::Decreasing => &self.decreasing,
        }
    }
}

/// The velocity limits less what the shape's velocity overshoots.
fn tightened(
    limits: Interval,
    (increasing, decreasing): (&PulseLimits, &PulseLimits),
    shape: Shape,
) -> Result<Interval, PlannerError> {
    let width = limits.width();
    let margin = increasing.reverse_velocity(shape, width).max(decreasing.reverse_velocity(shape, width));
    let velocity = Interval::new(limits.min + margin, limits.max - margin);
    if velocity.min < 0.0 && 0.0 < velocity.max {
        Ok(velocity)
    } else {
        Err(PlannerError::OutOfScale { name: "velocity margin", value: margin })
    }
}

/// The largest velocity that is at most `change` above `velocity`: their sum, an ulp less where rounding took it further.
#[inline]
fn highest_within(velocity: f64, change: f64) -> f64 {
    let target = velocity + change;
    // `f64::next_down`, but without a branch, as it is a matter of chance whether it is due. It never is for 0.
    let ulp = u64::from(target - velocity > change);
    let down = if target < 0.0 { ulp } else { ulp.wrapping_neg() };
    f64::from_bits(target.to_bits().wrapping_add(down))
}

/// `f64::min` in one instruction; a NaN `b` stays.
#[inline]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// `f64::max` in one instruction; a NaN `b` stays.
#[inline]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[inline]
fn check_finite(position: f64, v1: f64, v2: f64) -> Result<(), RampError> {
    let (name, value) = if !position.is_finite() {
        ("position", position)
    } else if !v1.is_finite() {
        ("initial velocity", v1)
    } else if !v2.is_finite() {
        ("final velocity", v2)
    } else {
        return Ok(());
    };
    Err(RampError::NotFinite { name, value })
}

#[inline]
fn check_end(position: f64) -> Result<(), RampError> {
    if position.is_finite() {
        Ok(())
    } else {
        Err(RampError::NotFinite { name: "final position", value: position })
    }
}

/// Refuses periods that leave next to nothing, and limits whose quintics would overflow or underflow.
fn check_authority(pulse: &PulseLimits, period: f64, speed: f64) -> Result<(), PlannerError> {
    let (shortest, a) = (pulse.ramp_up.min(pulse.ramp_down), pulse.acceleration);
    let longest = pulse.ramp_up.max(pulse.ramp_down);
    let smallest_change = f64::EPSILON * speed.min(pulse.velocity_change); // smaller ones may vanish
    let numbers = [
        ("acceleration", a),
        ("inverse acceleration", 1.0 / a),
        ("velocity change", pulse.velocity_change),
        ("velocity change squared", pulse.velocity_change * pulse.velocity_change),
        ("velocity change without a cruise", pulse.ramps_only),
        ("inverse velocity change without a cruise", 1.0 / pulse.ramps_only),
        ("ramp duration", shortest),
        ("shortest ramp cubed", (1e-6 * shortest) * (1e-6 * shortest) * (1e-6 * shortest)),
        ("derivative of a quintic", 1e13 * (a / (shortest * shortest * shortest))), // MAP's ramps shrink by 1e-6
        ("quintic coefficient of a small step", smallest_change / (longest * longest) / (longest * longest)),
        ("displacement", period * pulse.velocity_change),
        ("braking distance scale", period / pulse.velocity_change),
    ];
    for (name, value) in numbers {
        if !value.is_normal() {
            return Err(PlannerError::OutOfScale { name, value });
        }
    }
    if pulse.share < MIN_AUTHORITY_SHARE {
        return Err(PlannerError::PeriodTooShort { period, share: pulse.share });
    }
    Ok(())
}
