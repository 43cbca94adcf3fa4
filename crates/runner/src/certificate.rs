//! The evidence of a run as a file: `certificate.json`.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::evaluation::Violations;
use crate::evidence::{Evidence, JointEvidence};
use crate::stage::Stage;

/// What `certificate.json` says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Certificate {
    /// Version of the file's format.
    pub schema: u32,
    /// The stage.
    pub stage: Stage,
    /// The seed.
    pub seed: u64,
    /// Which plant was simulated.
    pub plant: String,
    /// Training episodes.
    pub episodes: u64,
    /// Training steps.
    pub steps: u64,
    /// Training and evaluation together: limits that did not hold.
    pub violations: Violations,
    /// Seen while training.
    pub training: Part,
    /// Seen in the evaluation that closed the stage.
    pub evaluation: Part,
}

/// Evidence about one part of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// By joint: worst margins relative to the actuator's limits, of the reference (exact extrema) and of the actual
    /// motion, and the largest tracking errors.
    pub joints: BTreeMap<String, JointEvidence>,
    /// Limits that did not hold.
    pub violations: Violations,
    /// Safe ranges computed.
    pub ranges: u64,
    /// Of these, narrowed by the position limits.
    pub narrowed_ranges: u64,
    /// Of these, empty.
    pub empty_ranges: u64,
    /// Share of ranges that the position limits narrowed.
    pub intervention_rate: f64,
    /// Actions outside [-1, 1] that counted as the nearer end.
    pub clamped_actions: u64,
    /// Controller commands.
    pub commands: u64,
    /// Of these, saturated.
    pub saturated_commands: u64,
    /// Commands that the fail-safe gave.
    pub failsafe_count: u64,
}

impl Part {
    /// The evidence, joint by joint under its name.
    #[must_use]
    pub fn new<'a>(names: impl IntoIterator<Item = &'a str>, evidence: &Evidence) -> Self {
        Self {
            joints: names.into_iter().map(str::to_owned).zip(evidence.joints.iter().copied()).collect(),
            violations: Violations {
                reference: evidence.reference_violations,
                actual: evidence.actual_violations,
            },
            ranges: evidence.ranges,
            narrowed_ranges: evidence.narrowed_ranges,
            empty_ranges: evidence.empty_ranges,
            intervention_rate: evidence.intervention_rate(),
            clamped_actions: evidence.clamped_actions,
            commands: evidence.commands,
            saturated_commands: evidence.saturated_commands,
            failsafe_count: evidence.failsafe_commands,
        }
    }
}
