//! An adversarial run of any length through the safe ranges, with every limit judged by exact extrema.
//!
//! Steps come in cases. Case k draws its limits, period, shape, timing, starts and adversaries from a stream of its own,
//! named by the seed and k, so a case can be replayed alone and the result does not depend on the number of threads.

mod adversary;
mod case;
mod judge;
mod random;
mod report;
mod setting;
mod tally;
mod witness;
mod workers;

use std::fmt::Write as _;
use std::path::PathBuf;

use anyhow::{Result, bail, ensure};
use safezone::{Command, Request, SafeZone};

use crate::store;
use report::Report;

pub use tally::{Excess, Faults, Tally};

/// Steps of one case; the last case of a run may be shorter.
pub const CASE_STEPS: u64 = 8192;

/// Excess over a limit, relative to the width of its interval, from which a step counts as a violation.
pub const MOST_EXCESS: f64 = 1e-12;

/// What to run.
#[derive(Clone, Debug, PartialEq)]
pub struct SoakRequest {
    /// Number of steps, exactly.
    pub steps: u64,
    /// Seed of everything random.
    pub seed: u64,
    /// Number of threads; all there are if not given.
    pub threads: Option<usize>,
    /// Where the result is written as JSON.
    pub json: Option<PathBuf>,
    /// Replays this case alone and prints what happens in it.
    pub case: Option<u64>,
}

/// What a joint is told in one step: [`SafeZone::command`] in every real run, something broken on purpose in a test.
pub trait Act: Sync {
    /// The command for the next step from `position` [rad or m] and `velocity` [rad/s or m/s].
    fn act(&self, zone: &SafeZone<'_>, position: f64, velocity: f64, request: Request) -> Command;
}

/// The zone as it is.
#[derive(Clone, Copy, Debug)]
pub struct Zone;

impl Act for Zone {
    #[inline]
    fn act(&self, zone: &SafeZone<'_>, position: f64, velocity: f64, request: Request) -> Command {
        zone.command(position, velocity, request)
    }
}

/// Runs `request` and returns the table that its command prints. The JSON file is written even if limits were violated.
///
/// # Errors
/// There was a violation (the message says how to replay it), the case does not exist or the file cannot be written.
pub fn soak(request: &SoakRequest) -> Result<String> {
    ensure!(request.steps > 0, "--steps must be at least 1");
    if let Some(case) = request.case {
        return replay(request, case);
    }
    let threads = request.threads.unwrap_or_else(workers::available).max(1);
    let (tally, seconds) = workers::timed(request.steps, request.seed, threads, &Zone);
    let report = Report::new(request, threads, seconds, &tally);
    if let Some(path) = &request.json {
        store::write_whole(path, report.to_json()?.as_bytes())?;
    }
    if let Some(case) = tally.first_faulty_case {
        bail!(
            "{} violations in {} steps, the first in case {case}; replay it with: \
             cargo xtask soak --steps {} --seed {} --case {case}",
            tally.faults.total(),
            tally.steps,
            request.steps,
            request.seed,
        );
    }
    Ok(report.to_string())
}

/// Runs all cases of `steps` steps on `threads` threads.
#[must_use]
pub fn tally(steps: u64, seed: u64, threads: usize, act: &impl Act) -> Tally {
    workers::timed(steps, seed, threads, act).0
}

/// One case in words: its zones and every violation.
fn replay(request: &SoakRequest, case: u64) -> Result<String> {
    let cases = request.steps.div_ceil(CASE_STEPS);
    ensure!(case < cases, "--case {case}: {} steps have the cases 0 to {}", request.steps, cases - 1);
    let mut text = witness::Words::default();
    let tally = case::run(request.seed, case, workers::steps_of(case, request.steps), &Zone, &mut text);
    let mut words = text.into_text();
    writeln!(words, "case {case}: {} steps, {} violations", tally.steps, tally.faults.total())?;
    Ok(words)
}

#[cfg(test)]
mod tests;
