//! A trained policy as one file, with everything that it needs to be used, judged and trained again.
//!
//! Layout: the frame of [`crate::frame`] with a [`Header`], then the actor's own bytes, which carry their own length and
//! checksum. `head -c 20000 FILE` shows the header; it is JSON.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, Result, ensure};
use sac_burn::Policy;
use serde::{Deserialize, Serialize};

use crate::certificate::Certificate;
use crate::checkpoint;
use crate::config::{ConfigSpec, run_folder};
use crate::evaluation::Summary;
use crate::frame::Kind;
use crate::machine::Machine;
use crate::observation::Scaling;
use crate::stage::Stage;
use crate::{store, training};

/// The file's kind. A version that changes the header adds its step here.
pub const KIND: Kind =
    Kind { magic: *b"JBTGPOL\0", name: "policy", steps: &[checkpoint::noiseless_episodes] };

/// Where the policies are that come with the project: `purple` is `purple.policy` there.
pub const FOLDER: &str = "assets/policies";

/// Ending of a policy's file.
const ENDING: &str = "policy";

/// Everything about a policy but its weights.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Header {
    /// What wrote the file.
    pub program: String,
    /// The stage that it was trained in.
    pub stage: Stage,
    /// Seed of its training; the configuration's.
    pub seed: u64,
    /// Training episodes in this stage.
    pub episodes: u64,
    /// Environment steps in this stage.
    pub steps: u64,
    /// Environment steps in this stage and those before it.
    pub total_steps: u64,
    /// The evaluation that closed the stage.
    pub evaluation: Summary,
    /// The evidence of training and evaluation, as in `certificate.json`.
    pub certificate: Certificate,
    /// What turns a state of the crane into the policy's input.
    pub scaling: Scaling,
    /// The resolved configuration of the training.
    pub config: ConfigSpec,
}

/// A policy that can be played: read from a policy's file or from a checkpoint.
#[derive(Clone, Debug)]
pub struct Trained {
    /// The actor.
    pub policy: Policy,
    /// What turns a state of the crane into its input.
    pub scaling: Scaling,
    /// The resolved configuration of its training.
    pub config: ConfigSpec,
    /// The stage that it was trained in.
    pub stage: Stage,
    /// What the file says beyond that; a checkpoint says nothing, since its stage is not closed.
    pub header: Option<Header>,
}

/// Where a policy is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// A name in [`FOLDER`], or a file.
    Named(String),
    /// A stage of a run.
    Run(String, Stage),
}

/// This program, as files name it.
#[must_use]
pub fn program() -> String {
    format!("{} {}", env!("CARGO_PKG_NAME"), env!("CARGO_PKG_VERSION"))
}

/// File of the policy that closed a stage of a run.
#[must_use]
pub fn file_of(run_folder: &Path, stage: Stage) -> PathBuf {
    run_folder.join(stage.name()).with_extension(ENDING)
}

/// Writes a policy whole or not at all.
///
/// # Errors
/// The disk is full or the folder cannot be written; the old file is then as it was.
pub fn write(path: &Path, header: &Header, policy: &Policy) -> Result<()> {
    store::write_whole_with(path, |mut file| {
        KIND.write(&mut file, header)?;
        Ok(file.write_all(&policy.to_bytes())?)
    })
}

impl Place {
    /// The file that is meant.
    ///
    /// For a stage of a run it is the policy that closed the stage, or its best checkpoint while it is not closed.
    ///
    /// # Errors
    /// There is no such file; the message names what there is, or what to run first.
    pub fn file(&self) -> Result<PathBuf> {
        match self {
            Self::Named(name) => {
                let shipped = Path::new(FOLDER).join(name).with_extension(ENDING);
                if is_name(name) && shipped.exists() {
                    return Ok(shipped);
                }
                let file = PathBuf::from(name);
                ensure!(file.exists() || !is_name(name), "no policy is called '{name}': {}", there_are());
                ensure!(file.exists(), "policy {name} does not exist");
                Ok(file)
            }
            Self::Run(run, stage) => {
                let folder = run_folder(run, *stage);
                let closed = file_of(&folder, *stage);
                let path = if closed.exists() { closed } else { training::best(&folder) };
                ensure!(
                    path.exists(),
                    "run '{run}' has no trained stage {stage}: {} is missing; first run: cargo xtask train --stage \
                     {stage} --run {run}",
                    path.display()
                );
                Ok(path)
            }
        }
    }

    /// Reads the policy.
    ///
    /// # Errors
    /// As [`Place::file`] and [`Trained::read`].
    pub fn read(&self) -> Result<Trained> {
        Trained::read(&self.file()?)
    }
}

/// A word without folder and ending; anything else is a file.
fn is_name(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '-' | '_'))
}

/// What there is in [`FOLDER`], in words.
fn there_are() -> String {
    let entries = std::fs::read_dir(FOLDER).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries
        .map(|entry| entry.path())
        .filter(|file| file.extension().is_some_and(|ending| ending == ENDING))
        .filter_map(|file| Some(file.file_stem()?.to_str()?.to_owned()))
        .collect();
    names.sort();
    format!("{FOLDER} holds {}", if names.is_empty() { "none".into() } else { names.join(", ") })
}

impl Trained {
    /// Reads a policy's file, or the policy out of a checkpoint.
    ///
    /// # Errors
    /// The file is missing, is neither, is of another version, or is cut or damaged: the cause is named.
    pub fn read(path: &Path) -> Result<Self> {
        let in_file = || format!("policy {}", path.display());
        let bytes = store::read_start(path, KIND.magic.len())?;
        if bytes == checkpoint::KIND.magic {
            let (header, agent) = checkpoint::read(path)?;
            let checkpoint::Header { scaling, config, stage, .. } = header;
            return Self::checked(agent.policy().clone(), scaling, config, stage, None).with_context(in_file);
        }
        let bytes = store::read_bytes(path)?;
        let mut input = bytes.as_slice();
        let header: Header = KIND.read(&mut input).with_context(in_file)?;
        let mut weights = Vec::new();
        input.read_to_end(&mut weights).with_context(in_file)?;
        let policy = Policy::from_bytes(&weights).with_context(in_file)?;
        let (scaling, config, stage) = (header.scaling.clone(), header.config.clone(), header.stage);
        Self::checked(policy, scaling, config, stage, Some(header)).with_context(in_file)
    }

    /// Refuses parts that do not belong together.
    fn checked(
        policy: Policy,
        scaling: Scaling,
        config: ConfigSpec,
        stage: Stage,
        header: Option<Header>,
    ) -> Result<Self> {
        ensure!(
            policy.observation_dim() == scaling.len() && policy.action_dim() == config.task.moving.len(),
            "{} inputs and {} outputs, where {} and {} are wanted",
            policy.observation_dim(),
            policy.action_dim(),
            scaling.len(),
            config.task.moving.len()
        );
        Ok(Self { policy, scaling, config, stage, header })
    }

    /// The crane that it was trained on.
    ///
    /// # Errors
    /// A file of the crane is missing or wrong, or the crane has other joints than the policy knows.
    pub fn machine(&self) -> Result<Arc<Machine>> {
        let machine = Machine::load(&self.config)?;
        let (wanted, found) = (self.scaling.len(), machine.scaling().len());
        ensure!(wanted == found, "the policy sees {wanted} numbers, and the crane has {found} to show");
        Ok(Arc::new(machine))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_is_a_name_and_anything_else_is_a_file() {
        for name in ["purple", "orange-2", "my_policy"] {
            assert!(is_name(name), "{name}");
        }
        for file in ["", "purple.policy", "./purple", "runs/a/purple/purple.policy", ".."] {
            assert!(!is_name(file), "{file}");
        }
    }

    #[test]
    fn a_stage_that_is_not_there_names_the_command_to_run_first() {
        let missing = Place::Run("nobody-trained-this".into(), Stage::Yellow);
        let message = missing.file().unwrap_err().to_string();
        assert!(message.contains("cargo xtask train --stage yellow --run nobody-trained-this"), "{message}");
    }
}
