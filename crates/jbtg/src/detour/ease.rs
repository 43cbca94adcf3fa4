//! The motion of the largest displacement where it is not the one of the largest peak velocity: unequal jerk bounds.
//!
//! A pulse that leads to the peak velocity over a change Δ with the peak acceleration A, its ramps u·A and (next to
//! the peak) d·A long, takes T = Δ/A + s·A, s = (u + d)/2, and stays L = Δ²/(2A) + u·Δ·A/2 + (κ − ⅛)(d² − u²)·A³ behind
//! the peak, κ the displacement of the shape. One that leads away is the same with its time reversed. If u > d, L has
//! its minimum at a smaller A than T. Wanted are v_peak and both A with the largest v_peak·dt − ΣL within ΣT ≤ dt.
//!
//! Let λ [rad/s or m/s] be what time is worth. For a given Δ, L + λ·T is least at A² = y·Δ/s, y the root in (0, 1] of
//! k·y² − (x/2 + λ/Δ)·y + ½ + λ/Δ = 0 with x = u/s, k = 12·(κ − ⅛)·(x − 1). That leaves λ for a given v_peak, and v_peak:
//! a bracketed root each. Neither need be exact: at the optimum their errors count with their squares, and
//! [`Side::peak`] settles the time.

use super::Side;
use super::family::Family;
use crate::math::sqrt;

/// Most evaluations for a root.
const ROUNDS: u32 = 48;

/// Width of a bracket of v_peak that is narrow enough, as a share of the first one.
const NARROW_PEAK: f64 = 1e-7;

/// The same for what time is worth: while v_peak is sought, and for the choice, where time that is left over counts.
const NARROW_TRIAL: f64 = 1e-9;
const NARROW_CHOICE: f64 = 1e-13;

/// A pulse to or from the peak velocity whose peak acceleration is to be chosen.
#[derive(Clone, Copy)]
struct Part {
    /// Δ > 0 or = 0 [rad/s or m/s].
    change: f64,
    /// Largest A.
    limit: f64,
    /// s and d [s³/rad or s³/m].
    slowness: f64,
    inner: f64,
    /// x and k.
    x: f64,
    k: f64,
}

/// The best pulses for one v_peak.
#[derive(Clone, Copy)]
struct Choice {
    /// y of both.
    shares: [f64; 2],
    /// How the displacement grows with v_peak \[s\].
    slope: f64,
}

impl Side {
    /// This side with the peak accelerations that lead farthest from v₁ to v₂. `None` if those of least time do.
    pub(super) fn eased(&self, ends: (f64, f64), highest: f64, period: f64) -> Option<Self> {
        let rise = Part::new(&self.rise, self.rise.ramp_up, self.rise.ramp_down);
        let fall = Part::new(&self.fall, self.fall.ramp_down, self.fall.ramp_up);
        if rise.x <= 1.0 && fall.x <= 1.0 {
            return None;
        }
        let top = self.peak(ends, highest, period)?;
        let at = |peak: f64, narrow: f64| {
            let (rise, fall) =
                (Part { change: peak - ends.0, ..rise }, Part { change: peak - ends.1, ..fall });
            choice([rise, fall], period, narrow)
        };
        let slope = |peak: f64| at(peak, NARROW_TRIAL).slope;
        let peak = falling_root(slope, ends.0.max(ends.1), top, NARROW_PEAK);
        let [rise, fall] = at(peak, NARROW_CHOICE).shares;
        Some(Self { rise: self.rise.eased(rise), fall: self.fall.eased(fall) })
    }
}

/// The shares of the largest displacement for given changes. What time is worth is `worth`/(1 − `worth`) of the larger
/// change.
fn choice(parts: [Part; 2], period: f64, narrow: f64) -> Choice {
    let unit = parts[0].change.max(parts[1].change);
    let excess = |worth: f64| parts.iter().map(|part| part.time(worth, unit)).sum::<f64>() - period;
    let worth = falling_root(excess, 0.0, 1.0, narrow);
    let accelerations = parts.map(|part| part.acceleration(worth, unit));
    let held = |(part, a): (&Part, f64)| 0.5 * part.inner * a;
    let mut slope = parts.iter().zip(accelerations).map(held).sum::<f64>() - excess(worth).min(0.0);
    if worth > 0.0 {
        let per_acceleration: f64 = accelerations.iter().map(|a| 1.0 / a).sum();
        slope -= unit * (worth / (1.0 - worth)) * per_acceleration;
    }
    Choice { shares: parts.map(|part| part.share(worth, unit)), slope }
}

impl Part {
    fn new(family: &Family, outer_ramp: f64, inner_ramp: f64) -> Self {
        let x = 2.0 * outer_ramp / (outer_ramp + inner_ramp);
        Self {
            change: 0.0,
            limit: family.acceleration,
            slowness: family.slowness,
            inner: inner_ramp / family.acceleration,
            x,
            k: 12.0 * (family.displacement - 0.125) * (x - 1.0),
        }
    }

    /// y, which grows with what time is worth.
    fn share(&self, worth: f64, unit: f64) -> f64 {
        let (change, time) = (self.change * (1.0 - worth), unit * worth);
        let (change, time) = (change / (change + time), time / (change + time));
        let b = 0.5 * self.x * change + time;
        let c = 0.5 * change + time;
        if self.x > 1.0 && c > 0.0 {
            (2.0 * c / (b + sqrt((b * b - 4.0 * self.k * change * c).max(0.0)))).min(1.0)
        } else {
            1.0
        }
    }

    fn acceleration(&self, worth: f64, unit: f64) -> f64 {
        sqrt(self.share(worth, unit) * self.change / self.slowness).min(self.limit)
    }

    /// T \[s\].
    fn time(&self, worth: f64, unit: f64) -> f64 {
        let a = self.acceleration(worth, unit);
        if a > 0.0 { self.change / a + self.slowness * a } else { 0.0 }
    }
}

/// Where a function that falls from `low` to `high` becomes negative: the upper end of a narrow bracket, or the end of
/// the interval that is nearest. Regula falsi with halved weights, every third step a halving.
fn falling_root(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64, narrow: f64) -> f64 {
    let narrow = narrow * (high - low);
    let (mut above, mut below) = (f(low), f(high));
    if !(above > 0.0) {
        return low;
    }
    if !(below < 0.0) {
        return high;
    }
    for round in 0..ROUNDS {
        if high - low <= narrow {
            break;
        }
        let secant = low + (high - low) * (above / (above - below));
        let is_inside = round % 3 != 2 && secant > low && secant < high;
        let middle = if is_inside { secant } else { 0.5 * (low + high) };
        let value = f(middle);
        if value > 0.0 {
            (low, above, below) = (middle, value, 0.5 * below);
        } else {
            (high, below, above) = (middle, value, 0.5 * above);
        }
    }
    high
}
