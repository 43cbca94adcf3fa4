//! A training's whole state as one file: what resuming bit for bit needs.
//!
//! Layout: the frame of [`crate::frame`] with a [`Header`], then the agent's own bytes, which carry their own length and
//! checksum. The file is written whole or not at all, and a part of one is refused.

use std::io::Read;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use sac_burn::Agent;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::config::ConfigSpec;
use crate::curriculum::Mastery;
use crate::evidence::Evidence;
use crate::frame::Kind;
use crate::observation::Scaling;
use crate::stage::Stage;
use crate::store;

/// The file's kind. A version that changes the header adds its step here, and a run of the version before to
/// `tests/formats`.
pub const KIND: Kind = Kind {
    magic: *b"JBTGRUN\0",
    name: "checkpoint of a run",
    steps: &[goals_by_stage_and_averaged_policy, noiseless_episodes],
};

/// Version 1 had one goal for all stages, without a limit of steps, and its policy was the actor.
fn goals_by_stage_and_averaged_policy(header: &mut Value) -> Result<()> {
    let config = header.get_mut("config").and_then(Value::as_object_mut).context("config is missing")?;
    let mut goal = config.remove("curriculum").context("config.curriculum is missing")?;
    let goal = goal.as_object_mut().context("config.curriculum is no record")?;
    let checkpoint_every = goal.remove("checkpoint_every").context("checkpoint_every is missing")?;
    goal.insert("max_steps".into(), u64::MAX.into());
    let mut curriculum = Map::from_iter([("checkpoint_every".to_owned(), checkpoint_every)]);
    curriculum.extend(Stage::ALL.map(|stage| (stage.name().to_owned(), goal.clone().into())));
    config.insert("curriculum".into(), curriculum.into());
    let learner = config.get_mut("learner").and_then(Value::as_object_mut);
    learner.context("config.learner is missing")?.insert("policy_share".into(), 1.0.into());
    Ok(())
}

/// Version 2 explored in every episode.
pub fn noiseless_episodes(header: &mut Value) -> Result<()> {
    let config = header.get_mut("config").and_then(Value::as_object_mut).context("config is missing")?;
    let curriculum = config.get_mut("curriculum").and_then(Value::as_object_mut);
    curriculum.context("config.curriculum is missing")?.insert("noiseless_every".into(), 0.into());
    Ok(())
}

/// Everything of a training but the agent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Header {
    /// The resolved configuration.
    pub config: ConfigSpec,
    /// The stage that is trained.
    pub stage: Stage,
    /// State of the curriculum.
    pub mastery: Mastery,
    /// Environment steps in this stage.
    pub steps: u64,
    /// Evidence over this stage's training so far.
    pub evidence: Evidence,
    /// Bytes of `metrics.jsonl` that belong to this state.
    pub metrics_length: u64,
    /// Bytes of the TensorBoard event file that belong to this state.
    pub events_length: u64,
    /// What turns a state of the crane into the policy's input.
    pub scaling: Scaling,
}

/// Writes a checkpoint whole or not at all.
///
/// # Errors
/// The disk is full or the folder cannot be written; the old checkpoint is then as it was.
pub fn write(path: &Path, header: &Header, agent: &Agent) -> Result<()> {
    store::write_whole_with(path, |mut file| {
        KIND.write(&mut file, header)?;
        agent.save(&mut file)?;
        Ok(())
    })
}

/// Reads a checkpoint.
///
/// # Errors
/// The file is missing, is no checkpoint, is of another version, or is cut or damaged: the cause is named.
pub fn read(path: &Path) -> Result<(Header, Agent)> {
    let in_file = || format!("checkpoint {}", path.display());
    let file = std::fs::File::open(path).with_context(in_file)?;
    let mut file = std::io::BufReader::with_capacity(1 << 20, file);
    let header = KIND.read(&mut file).with_context(in_file)?;
    let agent = Agent::load(&mut file).with_context(in_file)?;
    let mut rest = [0];
    ensure!(file.read(&mut rest)? == 0, "{}: bytes behind its end; it is damaged", in_file());
    Ok((header, agent))
}
