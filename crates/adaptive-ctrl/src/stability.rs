//! The sampled loop: one joint as a double integrator under held effort.

use crate::{JointSpec, LimitsError};

/// Largest damping·A·period that a controller may be built with or adapt to.
///
/// The sampled velocity loop alone diverges at 2 and rings at more than 1. One half leaves a gain
/// margin of 4, for what the analysis of one joint does not see: the other joints
/// ([`coupled_damping_per_tick`](crate::coupled_damping_per_tick)), friction, and a delay of one tick.
pub const MAX_DAMPING_PER_TICK: f64 = 0.5;

/// Least damping ratio that every oscillation of the sampled loop must have over the stated range of inertia.
///
/// With one half an error overshoots by a sixth of itself at most. Without an integral and without sampling it is
/// P ≤ D²·A_min, for the adaptive law ½k₁ ≤ ½k₅·A_min; a period that is not short takes the share D·A·T_s/2 off that:
/// P ≤ D²·A_min / (1 + ½D·A_min·T_s), to 2e-4.
pub const MIN_DAMPING_RATIO: f64 = 0.5;

/// One joint under a linear control law, sampled with the effort held over each period.
///
/// The joint is ẍ = A·u with u = −P·e₁ − D·e₂ − I, I growing by K·e₁·T each tick. The transition over
/// a period is exact. With d = D·A·T, p = P·A·T², i = K·A·T³ the characteristic polynomial is
/// z² + (d + p/2 − 2)·z + (1 − d + p/2) without, and
/// z³ + (d + p/2 − 3)·z² + (3 − 2d + i/2)·z + (d − 1 − p/2 + i/2) with the integral.
/// Without it the loop is stable exactly if 0 < p < 2d and d < 2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscreteLoop {
    /// d = D·A·T: share of a velocity error that one tick takes away.
    pub damping_per_tick: f64,
    /// p = P·A·T².
    pub stiffness_per_tick: f64,
    /// i = K·A·T³; 0 without an integral.
    pub integral_per_tick: f64,
}

impl DiscreteLoop {
    /// True if every closed-loop eigenvalue is inside the unit circle (the Jury conditions).
    ///
    /// NaN is unstable.
    pub fn is_stable(&self) -> bool {
        let (d, p, i) = (self.damping_per_tick, self.stiffness_per_tick, self.integral_per_tick);
        if i == 0.0 {
            return 0.0 < p && p < 2.0 * d && d < 2.0;
        }
        let (a2, a1, a0) = (d + 0.5 * p - 3.0, 3.0 - 2.0 * d + 0.5 * i, d - 1.0 - 0.5 * p + 0.5 * i);
        let at_one = i; // the polynomial at z = 1, without its cancellation
        at_one > 0.0
            && 1.0 - a2 + a1 - a0 > 0.0
            && a0.abs() < 1.0
            && (1.0 - a0 * a0).abs() > (a1 - a0 * a2).abs()
    }

    /// Least damping ratio of the motions that the closed loop is made of, as they look between the ticks: 1 if none
    /// oscillates, 0 or less if one does not decay. It is that of s = ln(z)/T for an eigenvalue z.
    ///
    /// For a law and a joint, with A left open, it grows with A as long as d ≤ [`MAX_DAMPING_PER_TICK`]: without an
    /// integral it is least where the joint is heaviest. With one it is least at an end of the range.
    pub fn damping_ratio(&self) -> f64 {
        let (d, p, i) = (self.damping_per_tick, self.stiffness_per_tick, self.integral_per_tick);
        // In w = z − 1 the polynomials lose no digits: w² + (d + p/2)·w + p and w³ + (d + p/2)·w² + (p + i/2)·w + i.
        let (b, c) = (d + 0.5 * p, p + 0.5 * i);
        if i == 0.0 {
            return least_ratio(b, p);
        }
        if !self.is_stable() {
            return 0.0;
        }
        // A stable loop has a real root between z = −1 and 1; the other two are those of what it leaves.
        let (mut low, mut high) = (-2.0, 0.0);
        loop {
            let w = 0.5 * (low + high);
            if w <= low || w >= high {
                let (b, c) = (b + w, c + w * (b + w));
                return real_ratio(w).min(least_ratio(b, c));
            }
            if ((w + b) * w + c) * w + i < 0.0 {
                low = w;
            } else {
                high = w;
            }
        }
    }

    /// Largest modulus of the closed-loop eigenvalues, of the loop without its integral.
    pub fn spectral_radius(&self) -> f64 {
        let (d, p) = (self.damping_per_tick, self.stiffness_per_tick);
        let half_sum = 1.0 - 0.5 * d - 0.25 * p;
        let product = 1.0 - d + 0.5 * p;
        let discriminant = half_sum * half_sum - product;
        if discriminant < 0.0 { libm::sqrt(product) } else { half_sum.abs() + libm::sqrt(discriminant) }
    }
}

/// Damping ratio of the continuous motion that z = `size`·e^(±i·`angle`) samples: −Re s / |s| with s = ln z.
fn ratio(log_size: f64, angle: f64) -> f64 {
    -log_size / libm::hypot(log_size, angle)
}

/// The same for a real z = 1 + `w`: 1 if it decays without a change of sign.
fn real_ratio(w: f64) -> f64 {
    ratio(libm::log(libm::fabs(1.0 + w)), if w < -1.0 { core::f64::consts::PI } else { 0.0 })
}

/// The least of both roots z = 1 + w of w² + `b`·w + `c`.
fn least_ratio(b: f64, c: f64) -> f64 {
    let discriminant = 0.25 * b * b - c;
    if discriminant >= 0.0 {
        let root = libm::sqrt(discriminant);
        real_ratio(-0.5 * b - root).min(real_ratio(root - 0.5 * b))
    } else {
        ratio(0.5 * libm::log1p(c - b), libm::atan2(libm::sqrt(-discriminant), 1.0 - 0.5 * b))
    }
}

/// A controller would not be stable, or its joint's numbers make no sense.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum StabilityError {
    /// The period is not a positive number.
    #[error(transparent)]
    Limits(#[from] LimitsError),
    /// The damping acts too strongly within one tick, where the joint is lightest.
    #[error(
        "damping {damping} × inverse inertia {inverse_inertia} × period {period} = {damping_per_tick}, \
         must be at most {bound}: lower the gain or shorten the period"
    )]
    DampingTooStrong {
        /// ½k₅, or the derivative gain [N·s/m or N·m·s/rad].
        damping: f64,
        /// Largest A of the stated range [1/kg or 1/(kg·m²)].
        inverse_inertia: f64,
        /// T_s, in seconds.
        period: f64,
        /// Their product.
        damping_per_tick: f64,
        /// [`MAX_DAMPING_PER_TICK`].
        bound: f64,
    },
    /// The loop swings too long after an error.
    #[error(
        "sampled loop has a damping ratio of {damping_ratio} at inverse inertia {inverse_inertia}, must be at least \
         {bound}: lower the proportional and integral gains (k1) or raise the derivative gain (k5)"
    )]
    Underdamped {
        /// [`DiscreteLoop::damping_ratio`].
        damping_ratio: f64,
        /// [`MIN_DAMPING_RATIO`].
        bound: f64,
        /// A at which it is that, an end of the stated range [1/kg or 1/(kg·m²)].
        inverse_inertia: f64,
    },
    /// The sampled loop has an eigenvalue on or outside the unit circle.
    #[error(
        "sampled loop is unstable at inverse inertia {inverse_inertia}: damping {damping_per_tick}, \
         stiffness {stiffness_per_tick}, integral {integral_per_tick} per tick"
    )]
    Unstable {
        /// A at which it is [1/kg or 1/(kg·m²)].
        inverse_inertia: f64,
        /// d of [`DiscreteLoop`].
        damping_per_tick: f64,
        /// p of [`DiscreteLoop`].
        stiffness_per_tick: f64,
        /// i of [`DiscreteLoop`].
        integral_per_tick: f64,
    },
}

/// P, D and K of u = −P·e₁ − D·e₂ − K·∫e₁.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinearLaw {
    pub(crate) stiffness: f64,
    pub(crate) damping: f64,
    pub(crate) integral: f64,
}

impl LinearLaw {
    /// The loop that this law closes around a joint of inverse inertia A.
    pub(crate) fn sampled(&self, inverse_inertia: f64, period: f64) -> DiscreteLoop {
        let at = inverse_inertia * period;
        DiscreteLoop {
            damping_per_tick: self.damping * at,
            stiffness_per_tick: self.stiffness * at * period,
            integral_per_tick: self.integral * at * period * period,
        }
    }

    /// Refuses a law that is too strong at the lightest, or unstable or underdamped at either end of the range.
    ///
    /// Between the ends nothing new happens without an integral: p/d does not depend on A, so the
    /// stable set of A is an interval. With one, the loop loses stability towards small A (as in
    /// continuous time: K < P·D·A) and towards large A only beyond the damping bound.
    pub(crate) fn check(&self, joint: &JointSpec) -> Result<(), StabilityError> {
        let JointSpec { period, inverse_inertia, .. } = *joint;
        check_period(period)?;
        let worst = self.sampled(inverse_inertia.max(), period);
        // Written so that an overflow to infinity is refused too.
        if !matches!(worst.damping_per_tick, d if d <= MAX_DAMPING_PER_TICK) {
            return Err(StabilityError::DampingTooStrong {
                damping: self.damping,
                inverse_inertia: inverse_inertia.max(),
                period,
                damping_per_tick: worst.damping_per_tick,
                bound: MAX_DAMPING_PER_TICK,
            });
        }
        for a in [inverse_inertia.min(), inverse_inertia.max()] {
            let sampled = self.sampled(a, period);
            if !sampled.is_stable() {
                return Err(StabilityError::Unstable {
                    inverse_inertia: a,
                    damping_per_tick: sampled.damping_per_tick,
                    stiffness_per_tick: sampled.stiffness_per_tick,
                    integral_per_tick: sampled.integral_per_tick,
                });
            }
            let damping_ratio = sampled.damping_ratio();
            // Written so that NaN is refused too.
            if !matches!(damping_ratio, ratio if ratio >= MIN_DAMPING_RATIO) {
                return Err(StabilityError::Underdamped {
                    damping_ratio,
                    bound: MIN_DAMPING_RATIO,
                    inverse_inertia: a,
                });
            }
        }
        Ok(())
    }
}

pub(crate) fn check_period(period: f64) -> Result<(), LimitsError> {
    if period.is_finite() && period > 0.0 {
        Ok(())
    } else {
        Err(LimitsError::NotPositive { quantity: "period", value: period })
    }
}

#[cfg(test)]
mod tests;
