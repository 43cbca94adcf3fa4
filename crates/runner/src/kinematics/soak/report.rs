//! The result of a run, as JSON and as a table.

use std::fmt;

use anyhow::Result;
use serde::Serialize;

use super::tally::{Excess, Faults, Tally};
use super::{CASE_STEPS, SoakRequest};

/// What the JSON file holds. Everything but `threads` and `seconds` follows from `steps` and `seed`.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    steps: u64,
    seed: u64,
    violations: u64,
    /// Relative to the width of each interval, 0 if nothing was ever exceeded.
    worst_excess: Excess,
    empty_ranges: u64,
    /// The violations by kind.
    faults: Faults,
    /// Case with the largest excess.
    worst_case: Option<u64>,
    first_faulty_case: Option<u64>,
    steps_per_case: u64,
    joints: u64,
    joints_with_table: u64,
    joints_with_samples: u64,
    refused_draws: u64,
    limit_changes: u64,
    narrowed_steps: u64,
    recovering_steps: u64,
    threads: usize,
    seconds: f64,
}

impl Report {
    pub(super) fn new(request: &SoakRequest, threads: usize, seconds: f64, tally: &Tally) -> Self {
        // JSON has no infinity; an excess of NaN or more than any number is the largest number.
        let finite = |excess: f64| excess.min(f64::MAX);
        let Excess { position, velocity, acceleration, jerk } = tally.worst;
        Self {
            steps: tally.steps,
            seed: request.seed,
            violations: tally.faults.total(),
            worst_excess: Excess {
                position: finite(position),
                velocity: finite(velocity),
                acceleration: finite(acceleration),
                jerk: finite(jerk),
            },
            empty_ranges: tally.faults.empty_range,
            faults: tally.faults,
            worst_case: tally.worst_case.map(|(_, case)| case),
            first_faulty_case: tally.first_faulty_case,
            steps_per_case: CASE_STEPS,
            joints: tally.zones,
            joints_with_table: tally.zones_with_table,
            joints_with_samples: tally.zones_with_samples,
            refused_draws: tally.refused,
            limit_changes: tally.changes,
            narrowed_steps: tally.narrowed,
            recovering_steps: tally.recovering,
            threads,
            seconds,
        }
    }

    pub(super) fn to_json(&self) -> Result<String> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Excess { position, velocity, acceleration, jerk } = self.worst_excess;
        writeln!(f, "steps             {}", self.steps)?;
        writeln!(f, "violations        {}", self.violations)?;
        writeln!(f, "empty ranges      {}", self.empty_ranges)?;
        writeln!(
            f,
            "worst excess      position {position:.1e}, velocity {velocity:.1e}, \
             acceleration {acceleration:.1e}, jerk {jerk:.1e} of the interval's width"
        )?;
        let (table, samples) = (self.joints_with_table, self.joints_with_samples);
        writeln!(f, "joints            {} ({table} with a table, {samples} with samples)", self.joints)?;
        writeln!(f, "limit changes     {} while moving", self.limit_changes)?;
        writeln!(f, "steps narrowed    {}, on a way back {}", self.narrowed_steps, self.recovering_steps)?;
        let nanoseconds = 1e9 * self.seconds * self.threads as f64 / self.steps as f64;
        writeln!(
            f,
            "time              {:.1} s on {} threads, {nanoseconds:.0} ns per step and thread",
            self.seconds, self.threads
        )
    }
}
