//! Limits that the interior of a step crosses although both its ends keep them.

use crate::solve::Approach;

impl Approach<'_> {
    /// Least velocity whose step does not come nearer to the limit, anywhere inside it, than braking at once would
    /// or than the guard allows [rad/s or m/s]. At most the braking velocity.
    ///
    /// Two things can happen. A ramp that starts against its own direction
    /// ([`Shape::SineQuintic`](jbtg::Shape)) first moves towards the limit, by a distance proportional to the
    /// velocity change at most. And with [`Timing::Fastest`](jbtg::Timing) a step that changes the velocity's sign
    /// starts the more slowly the larger it is, so that it turns later than a step to zero; the
    /// peak first falls and then grows with the velocity change, so what is admissible is an interval that ends at
    /// zero.
    pub(crate) fn min_velocity(&self) -> f64 {
        let (braking, lowest) = (self.braking, self.reachable.min);
        if braking.interior_is_free || lowest >= self.brake {
            return lowest;
        }
        let kept = braking.limit - 0.5 * braking.guard;
        let farthest =
            self.position + self.velocity.max(0.0) * braking.period + braking.reverse * braking.step;
        if farthest <= kept {
            return lowest;
        }
        let stop = self.position + self.braking.distance(self.planner, self.velocity);
        // From outside the way back must not wait for the shape's overshoot to fit.
        let overshoot = if self.is_outside() { braking.reverse * braking.step } else { 0.0 };
        let allowed = kept.max(stop + overshoot.max(1e-13 * braking.width));
        if braking.stretched || self.velocity <= 0.0 {
            let anchor = self.brake.min(self.velocity);
            return lowest.max(anchor - (allowed - stop) / braking.reverse);
        }
        self.bisect_peak(lowest, allowed)
    }

    /// Bisects between braking, which is admissible, and `lowest`.
    fn bisect_peak(&self, lowest: f64, allowed: f64) -> f64 {
        if self.peak(lowest) <= allowed {
            return lowest;
        }
        let (mut good, mut bad) = (self.brake, lowest);
        for _ in 0..40 {
            let middle = 0.5 * (good + bad);
            if self.peak(middle) <= allowed {
                good = middle;
            } else {
                bad = middle;
            }
        }
        good
    }

    /// Greatest position within the step to `velocity`; infinite if there is no such step.
    fn peak(&self, velocity: f64) -> f64 {
        let sign = self.braking.sign;
        match self.planner.ramp(sign * self.position, sign * self.velocity, sign * velocity) {
            Ok(step) => self.braking.mirrored(step.extrema().position).max,
            Err(_) => f64::INFINITY,
        }
    }
}
