//! Evidence that the limits held: worst margins and counts, accumulated while the crane moves.

use jbtg::{Extrema, Interval, Limits};
use serde::{Deserialize, Serialize};

/// One number for each of position, velocity, acceleration and jerk.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PerQuantity {
    /// Of the position.
    pub position: f64,
    /// Of the velocity.
    pub velocity: f64,
    /// Of the acceleration.
    pub acceleration: f64,
    /// Of the jerk.
    pub jerk: f64,
}

impl PerQuantity {
    /// The same number for all.
    #[must_use]
    pub fn all(value: f64) -> Self {
        Self { position: value, velocity: value, acceleration: value, jerk: value }
    }

    /// The smaller of each.
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        Self {
            position: self.position.min(other.position),
            velocity: self.velocity.min(other.velocity),
            acceleration: self.acceleration.min(other.acceleration),
            jerk: self.jerk.min(other.jerk),
        }
    }

    /// How many of the four are negative beyond rounding.
    #[must_use]
    fn count_violations(self) -> u64 {
        [self.position, self.velocity, self.acceleration, self.jerk]
            .into_iter()
            .filter(|m| !(*m >= -ROUNDING))
            .count() as u64
    }
}

/// What arithmetic may add to a limit, relative to its interval; anything more counts as a violation.
pub const ROUNDING: f64 = 1e-12;

/// Distance of `extrema` to the nearer limit, relative to the limit; negative beyond it.
///
/// Relative to the width of the interval for the position, to the limit on that side for the other three.
/// NaN if a quantity is NaN, which counts as a violation.
#[must_use]
pub fn margins(extrema: &Extrema, limits: &Limits) -> PerQuantity {
    let relative = |inner: Interval, outer: Interval| {
        let low = 1.0 - inner.min / outer.min;
        let high = 1.0 - inner.max / outer.max;
        if low.is_nan() || high.is_nan() { f64::NAN } else { low.min(high) }
    };
    let (inner, outer) = (extrema.position, limits.position());
    let low = (inner.min - outer.min) / (outer.max - outer.min);
    let high = (outer.max - inner.max) / (outer.max - outer.min);
    PerQuantity {
        position: if low.is_nan() || high.is_nan() { f64::NAN } else { low.min(high) },
        velocity: relative(extrema.velocity, limits.velocity()),
        acceleration: relative(extrema.acceleration, limits.acceleration()),
        jerk: relative(extrema.jerk, limits.jerk()),
    }
}

/// Evidence about one joint.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointEvidence {
    /// Worst margins of the reference to the actuator's limits, from exact extrema.
    pub reference: PerQuantity,
    /// Worst margins of the actual motion to the actuator's limits, over every tick of the integration.
    pub actual: PerQuantity,
    /// Largest position error [rad or m].
    pub position_error_max: f64,
    /// Largest velocity error [rad/s or m/s].
    pub velocity_error_max: f64,
}

/// Evidence about a run. Adding is associative and starts from [`Evidence::none`], so parts can be joined.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Evidence {
    /// By joint, in the order of the actuators.
    pub joints: Vec<JointEvidence>,
    /// Segments of the reference that left the reference's own limits, by quantity.
    pub reference_violations: u64,
    /// Ticks at which the actual motion was outside an actuator's limit, by joint and quantity.
    pub actual_violations: u64,
    /// Safe ranges asked for: one per policy step and moving joint.
    pub ranges: u64,
    /// Safe ranges that the position limits narrowed.
    pub narrowed_ranges: u64,
    /// Safe ranges that were empty; there is none.
    pub empty_ranges: u64,
    /// Commands that the fail-safe gave instead of the policy.
    pub failsafe_commands: u64,
    /// Actions outside [-1, 1] that counted as the nearer end.
    pub clamped_actions: u64,
    /// Controller commands, all joints together.
    pub commands: u64,
    /// Controller commands that saturated.
    pub saturated_commands: u64,
    /// Largest displacement of the tip by the errors of all held joints together \[m\].
    pub held_joint_tip_error: f64,
}

impl Evidence {
    /// Nothing seen yet.
    #[must_use]
    pub fn none(joints: usize) -> Self {
        let joint = JointEvidence {
            reference: PerQuantity::all(1.0),
            actual: PerQuantity::all(1.0),
            position_error_max: 0.0,
            velocity_error_max: 0.0,
        };
        Self {
            joints: vec![joint; joints],
            reference_violations: 0,
            actual_violations: 0,
            ranges: 0,
            narrowed_ranges: 0,
            empty_ranges: 0,
            failsafe_commands: 0,
            clamped_actions: 0,
            commands: 0,
            saturated_commands: 0,
            held_joint_tip_error: 0.0,
        }
    }

    /// Adds a segment of a joint's reference: margins to the actuator's limits, violations of its own.
    pub fn add_reference(&mut self, joint: usize, extrema: &Extrema, actuator: &Limits, reference: &Limits) {
        let entry = &mut self.joints[joint];
        entry.reference = entry.reference.min(margins(extrema, actuator));
        self.reference_violations += margins(extrema, reference).count_violations();
    }

    /// Adds a tick of a joint's actual motion and its deviation from the reference.
    pub fn add_actual(
        &mut self,
        joint: usize,
        actual: &jbtg::State,
        reference: &jbtg::State,
        actuator: &Limits,
    ) {
        let point = |value| Interval { min: value, max: value };
        let extrema = Extrema {
            position: point(actual.position),
            velocity: point(actual.velocity),
            acceleration: point(actual.acceleration),
            jerk: point(actual.jerk),
        };
        let margins = margins(&extrema, actuator);
        let entry = &mut self.joints[joint];
        entry.actual = entry.actual.min(margins);
        entry.position_error_max = entry.position_error_max.max((actual.position - reference.position).abs());
        entry.velocity_error_max = entry.velocity_error_max.max((actual.velocity - reference.velocity).abs());
        self.actual_violations += margins.count_violations();
    }

    /// Adds what another part of the run saw.
    pub fn join(&mut self, other: &Self) {
        for (mine, theirs) in self.joints.iter_mut().zip(&other.joints) {
            mine.reference = mine.reference.min(theirs.reference);
            mine.actual = mine.actual.min(theirs.actual);
            mine.position_error_max = mine.position_error_max.max(theirs.position_error_max);
            mine.velocity_error_max = mine.velocity_error_max.max(theirs.velocity_error_max);
        }
        self.reference_violations += other.reference_violations;
        self.actual_violations += other.actual_violations;
        self.ranges += other.ranges;
        self.narrowed_ranges += other.narrowed_ranges;
        self.empty_ranges += other.empty_ranges;
        self.failsafe_commands += other.failsafe_commands;
        self.clamped_actions += other.clamped_actions;
        self.commands += other.commands;
        self.saturated_commands += other.saturated_commands;
        self.held_joint_tip_error = self.held_joint_tip_error.max(other.held_joint_tip_error);
    }

    /// Worst margin of the reference over all joints.
    #[must_use]
    pub fn worst_reference_margin(&self) -> PerQuantity {
        self.joints.iter().fold(PerQuantity::all(1.0), |worst, joint| worst.min(joint.reference))
    }

    /// The smallest margin of the actual motion, with its joint and quantity; none for a machine without joints.
    #[must_use]
    pub fn worst_actual(&self) -> Option<(f64, usize, &'static str)> {
        let margins = self.joints.iter().enumerate().flat_map(|(joint, seen)| {
            let PerQuantity { position, velocity, acceleration, jerk } = seen.actual;
            [
                (position, joint, "position"),
                (velocity, joint, "velocity"),
                (acceleration, joint, "acceleration"),
                (jerk, joint, "jerk"),
            ]
        });
        margins.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Share of safe ranges that the position limits narrowed.
    #[must_use]
    pub fn intervention_rate(&self) -> f64 {
        share(self.narrowed_ranges, self.ranges)
    }

    /// Share of controller commands that saturated.
    #[must_use]
    pub fn saturation_rate(&self) -> f64 {
        share(self.saturated_commands, self.commands)
    }
}

fn share(part: u64, whole: u64) -> f64 {
    if whole == 0 { 0.0 } else { part as f64 / whole as f64 }
}
