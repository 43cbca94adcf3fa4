//! A training's whole state as one file: what resuming bit for bit needs, and what evaluation needs.
//!
//! Layout: magic, version, length and checksum of the header, the header as JSON, then the agent's own bytes, which
//! carry their own length and checksum. The file is written whole or not at all, and a part of one is refused.

use std::io::Read;
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail, ensure};
use sac_burn::Agent;
use serde::{Deserialize, Serialize};

use crate::config::ConfigSpec;
use crate::curriculum::Mastery;
use crate::evidence::Evidence;
use crate::observation::Scaling;
use crate::stage::Stage;
use crate::store;

const MAGIC: &[u8; 8] = b"JBTGRUN\0";
const VERSION: u32 = 1;
/// A header is a few kilobytes; a length beyond this is a corrupted one.
const MAX_HEADER: u64 = 1 << 26;

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
    let json = serde_json::to_vec(header)?;
    store::write_whole_with(path, |mut file| {
        file.write_all(MAGIC)?;
        file.write_all(&VERSION.to_le_bytes())?;
        file.write_all(&(json.len() as u64).to_le_bytes())?;
        file.write_all(&crc32c::crc32c(&json).to_le_bytes())?;
        file.write_all(&json)?;
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
    let header = read_header(&mut file).with_context(in_file)?;
    let agent = Agent::load(&mut file).with_context(in_file)?;
    let mut rest = [0];
    ensure!(file.read(&mut rest)? == 0, "{}: bytes behind its end; it is damaged", in_file());
    Ok((header, agent))
}

fn read_header(file: &mut impl Read) -> Result<Header> {
    const CUT: &str = "the file ends within its header; it is cut";
    let mut magic = [0; 8];
    file.read_exact(&mut magic).context(CUT)?;
    ensure!(&magic == MAGIC, "this is no checkpoint of a run");
    let version = u32::from_le_bytes(take(file).context(CUT)?);
    ensure!(version == VERSION, "version {version}, this program reads version {VERSION}");
    let length = u64::from_le_bytes(take(file).context(CUT)?);
    ensure!(length <= MAX_HEADER, "header of {length} bytes; the file is damaged");
    let checksum = u32::from_le_bytes(take(file).context(CUT)?);
    let mut json = vec![0; length as usize];
    file.read_exact(&mut json).context(CUT)?;
    if crc32c::crc32c(&json) != checksum {
        bail!("checksum of the header does not match; the file is damaged");
    }
    serde_json::from_slice(&json).map_err(|error| anyhow!("header: {error}"))
}

fn take<const N: usize>(file: &mut impl Read) -> std::io::Result<[u8; N]> {
    let mut bytes = [0; N];
    file.read_exact(&mut bytes)?;
    Ok(bytes)
}
