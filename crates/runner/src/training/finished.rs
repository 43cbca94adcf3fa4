//! What a training says of itself when it has ended.

use std::fmt;
use std::path::PathBuf;

use crate::digest::Digest;
use crate::evaluation::{Evaluation, Violations};
use crate::stage::Stage;

/// How a training ended.
#[derive(Debug)]
pub struct Finished {
    /// The evaluation that closed the stage, of the best checkpoint.
    pub evaluation: Evaluation,
    /// Training episodes.
    pub episodes: u64,
    /// Training steps.
    pub steps: u64,
    /// True if a confirmation passed.
    pub mastered: bool,
    /// Limits that did not hold, in training and evaluation together.
    pub violations: Violations,
    /// The stage.
    pub stage: Stage,
    /// Share of successes over the last episodes of the training.
    pub window_success_rate: f64,
    /// Digest of `metrics.jsonl`: equal for equal trainings.
    pub digest: Digest,
    /// Folder of the results.
    pub folder: PathBuf,
}

impl fmt::Display for Finished {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { stage, episodes, steps, evaluation, .. } = self;
        let summary = &evaluation.summary;
        let word = if self.mastered { "mastered" } else { "not mastered" };
        writeln!(f, "{stage}: {word} after {episodes} episodes, {steps} steps")?;
        writeln!(f, "  last episodes of training  {:.1} % reached", 100.0 * self.window_success_rate)?;
        let [low, high] = summary.success_ci95.map(|bound| 100.0 * bound);
        writeln!(
            f,
            "  {} fresh episodes         {:.1} % reached (95 % interval {low:.1} to {high:.1} %)",
            summary.episodes,
            100.0 * summary.success_rate
        )?;
        let Violations { reference, actual } = self.violations;
        writeln!(
            f,
            "  limits                     {reference} violations of the reference, {actual} of the actual motion"
        )?;
        writeln!(f, "  metrics digest             {}", self.digest)?;
        writeln!(
            f,
            "  in {}: {stage}.policy, eval.json, certificate.json, metrics.jsonl, timing.json, checkpoints",
            self.folder.display()
        )
    }
}
