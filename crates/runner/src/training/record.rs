//! What a training writes as it goes: `metrics.jsonl` and a TensorBoard event file.

use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

use anyhow::{Result, ensure};
use sac_burn::Losses;
use serde::Serialize;

use crate::store::AppendFile;
use crate::tensorboard::EventFile;

/// Name of the file of metrics.
pub(super) const METRICS: &str = "metrics.jsonl";
const EVENTS: &str = "events.out.tfevents";

/// One line of `metrics.jsonl`. Nothing in it depends on the clock: one seed, one file.
#[derive(Clone, Debug, Serialize)]
pub(super) struct EpisodeRecord {
    /// Number of the episode, from 1.
    pub(super) episode: u64,
    /// Environment steps at its end.
    pub(super) step: u64,
    /// True if the target was reached.
    pub(super) reached: bool,
    /// Sum of the rewards.
    #[serde(rename = "return")]
    pub(super) return_: f64,
    /// Steps of the episode.
    pub(super) length: u32,
    /// Distance of tip and target at its end \[m\].
    pub(super) tip_error: f64,
    /// Share of successes over the rolling window.
    pub(super) success_rate: f64,
    /// Mean return over the rolling window.
    pub(super) mean_return: f64,
    /// Share of safe ranges that the position limits narrowed.
    pub(super) intervention_rate: f64,
    /// Limits that did not hold, reference and actual together.
    pub(super) violations: u64,
    /// Success rate of the deterministic evaluation after this episode, if there was one.
    pub(super) confirmed: Option<f64>,
    /// Means over the episode's updates, if there were any.
    pub(super) losses: Option<Means>,
}

/// Means over updates.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub(super) struct Means {
    pub(super) critic: f64,
    pub(super) actor: f64,
    pub(super) entropy_temperature: f64,
    mean_q: f64,
    entropy: f64,
}

/// Sums over updates.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LossMeans {
    sums: Means,
    count: u32,
}

impl LossMeans {
    /// Adds an update.
    ///
    /// # Errors
    /// A loss is not finite: the learning diverged.
    pub(super) fn add(&mut self, losses: &Losses) -> Result<()> {
        let named = [("critic loss", losses.critic), ("actor loss", losses.actor), ("mean Q", losses.mean_q)];
        for (name, value) in named {
            ensure!(value.is_finite(), "the {name} is {value}");
        }
        self.sums.critic += losses.critic;
        self.sums.actor += losses.actor;
        self.sums.entropy_temperature += losses.entropy_temperature;
        self.sums.mean_q += losses.mean_q;
        self.sums.entropy += losses.entropy;
        self.count += 1;
        Ok(())
    }

    /// The means, if there was an update.
    pub(super) fn means(&self) -> Option<Means> {
        let n = f64::from(self.count);
        (self.count > 0).then(|| Means {
            critic: self.sums.critic / n,
            actor: self.sums.actor / n,
            entropy_temperature: self.sums.entropy_temperature / n,
            mean_q: self.sums.mean_q / n,
            entropy: self.sums.entropy / n,
        })
    }
}

/// Writes the records.
#[derive(Debug)]
pub(super) struct Recorder {
    metrics: AppendFile,
    events: EventFile,
}

impl Recorder {
    /// Starts both files.
    ///
    /// # Errors
    /// They cannot be written.
    pub(super) fn create(folder: &Path) -> Result<Self> {
        Ok(Self {
            metrics: AppendFile::create(&folder.join(METRICS))?,
            events: EventFile::create(&folder.join(EVENTS), wall_time())?,
        })
    }

    /// Continues both files from where a checkpoint was made.
    ///
    /// # Errors
    /// They are missing or shorter.
    pub(super) fn reopen(folder: &Path, metrics_length: u64, events_length: u64) -> Result<Self> {
        Ok(Self {
            metrics: AppendFile::reopen(&folder.join(METRICS), metrics_length)?,
            events: EventFile::reopen(&folder.join(EVENTS), events_length)?,
        })
    }

    /// Adds an episode to both.
    ///
    /// # Errors
    /// The disk is full.
    pub(super) fn add(&mut self, record: &EpisodeRecord) -> Result<()> {
        let mut line = serde_json::to_vec(record)?;
        line.push(b'\n');
        self.metrics.append(&line)?;
        let mut scalars = vec![
            ("episode/return", record.return_),
            ("episode/length", f64::from(record.length)),
            ("episode/tip_error", record.tip_error),
            ("episode/intervention_rate", record.intervention_rate),
            ("window/success_rate", record.success_rate),
            ("window/mean_return", record.mean_return),
            ("limits/violations", record.violations as f64),
        ];
        if let Some(rate) = record.confirmed {
            scalars.push(("evaluation/success_rate", rate));
        }
        if let Some(losses) = &record.losses {
            scalars.extend([
                ("learner/critic_loss", losses.critic),
                ("learner/actor_loss", losses.actor),
                ("learner/entropy_temperature", losses.entropy_temperature),
                ("learner/mean_q", losses.mean_q),
                ("learner/entropy", losses.entropy),
            ]);
        }
        self.events.scalars(wall_time(), record.step, scalars)
    }

    /// Lengths of both files, on disk once this returns.
    ///
    /// # Errors
    /// The disk refuses.
    pub(super) fn sync(&mut self) -> Result<(u64, u64)> {
        Ok((self.metrics.sync()?, self.events.sync()?))
    }
}

/// Seconds since 1970, for TensorBoard's time axis alone.
fn wall_time() -> f64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0.0, |elapsed| elapsed.as_secs_f64())
}
