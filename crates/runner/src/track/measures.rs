//! What is measured of a joint while it follows.

use adaptive_ctrl::Saturation;
use jbtg::Limits;
use serde::{Deserialize, Serialize};

/// Errors beyond this keep a joint from counting as settled [m or rad].
pub const SETTLED: f64 = 1e-4;

/// Root mean square and maximum.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Root mean square.
    pub rms: f64,
    /// Largest size.
    pub max: f64,
}

/// Ticks beyond an actuator's limits, by quantity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Violations {
    /// Of position.
    pub position: u64,
    /// Of velocity.
    pub velocity: u64,
    /// Of acceleration.
    pub acceleration: u64,
    /// Of jerk.
    pub jerk: u64,
}

/// The result for one joint.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct JointMeasures {
    /// Of position [m or rad].
    pub position_error: Spread,
    /// Of velocity [m/s or rad/s].
    pub velocity_error: Spread,
    /// Largest effort exerted [N or N·m].
    pub effort_peak: f64,
    /// Root mean square of the effort exerted [N or N·m].
    pub effort_rms: f64,
    /// Root mean square of the actual jerk, from tick to tick [m/s³ or rad/s³].
    pub jerk_rms: f64,
    /// Share of commands that an effort limit cut.
    pub saturation_rate: f64,
    /// From when every reference has come to rest and the last force or fault has set in or ended, until the error stays
    /// within 0.1 mm or 0.1 mrad \[s\]; none if it never does.
    pub settling_time_s: Option<f64>,
    /// Largest displacement of the tip by this joint's error alone \[m\], to first order; none for a joint that moves.
    pub held_joint_tip_error_m: Option<f64>,
    /// Ticks beyond the actuator's limits.
    pub violations: Violations,
    /// Work that the actuator did on the crane \[J\], what it took back not counted.
    pub work: f64,
}

/// Measures of one joint, being taken.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Meter {
    ticks: u64,
    position: Sum,
    velocity: Sum,
    effort: Sum,
    jerk: Sum,
    saturated: u64,
    violations: Violations,
    last_acceleration: f64,
    work: f64,
    /// Of a held joint, by its error alone.
    tip_error: Option<f64>,
    /// When the error was last too large to be settled.
    unsettled: f64,
}

#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    squares: f64,
    max: f64,
}

impl Sum {
    fn add(&mut self, value: f64) {
        self.squares += value * value;
        // Written so that NaN stays.
        self.max = if value.abs() <= self.max { self.max } else { value.abs() };
    }

    fn spread(self, ticks: u64) -> Spread {
        Spread { rms: (self.squares / ticks.max(1) as f64).sqrt(), max: self.max }
    }
}

/// One tick of one joint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    pub(crate) time: f64,
    pub(crate) period: f64,
    pub(crate) position: f64,
    pub(crate) velocity: f64,
    pub(crate) acceleration: f64,
    pub(crate) wanted: jbtg::State,
    pub(crate) exerted: f64,
    pub(crate) saturation: Saturation,
}

impl Meter {
    pub(crate) fn add(&mut self, sample: &Sample, limits: &Limits) {
        let Sample { time, period, position, velocity, acceleration, wanted, exerted, saturation } = *sample;
        let jerk = (acceleration - self.last_acceleration) / period;
        self.last_acceleration = acceleration;
        self.ticks += 1;
        self.position.add(position - wanted.position);
        self.velocity.add(velocity - wanted.velocity);
        self.effort.add(exerted);
        self.jerk.add(jerk);
        self.work += (exerted * velocity * period).max(0.0);
        self.saturated += u64::from(saturation != Saturation::None);
        if !((position - wanted.position).abs() <= SETTLED) {
            self.unsettled = time;
        }
        let counts = [
            (&mut self.violations.position, position, limits.position()),
            (&mut self.violations.velocity, velocity, limits.velocity()),
            (&mut self.violations.acceleration, acceleration, limits.acceleration()),
            (&mut self.violations.jerk, jerk, limits.jerk()),
        ];
        for (count, value, limit) in counts {
            *count += u64::from(!(limit.min <= value && value <= limit.max));
        }
    }

    /// Notes that the error of this held joint displaces the tip by `displacement` \[m\].
    pub(crate) fn add_tip_error(&mut self, displacement: f64) {
        self.tip_error = Some(displacement.max(self.tip_error.unwrap_or(0.0)));
    }

    /// The result, if the last thing to settle from was at `calm` and the run ended at `end` \[s\].
    pub(crate) fn result(&self, calm: f64, end: f64, period: f64) -> JointMeasures {
        let ticks = self.ticks;
        let is_settled = self.unsettled + 1.5 * period < end;
        JointMeasures {
            position_error: self.position.spread(ticks),
            velocity_error: self.velocity.spread(ticks),
            effort_peak: self.effort.max,
            effort_rms: self.effort.spread(ticks).rms,
            jerk_rms: self.jerk.spread(ticks).rms,
            saturation_rate: self.saturated as f64 / ticks.max(1) as f64,
            settling_time_s: is_settled.then_some((self.unsettled - calm).max(0.0)),
            held_joint_tip_error_m: self.tip_error,
            violations: self.violations,
            work: self.work,
        }
    }
}
