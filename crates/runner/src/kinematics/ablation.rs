//! What raw actions do: the same velocities, reached in four ways.

use std::path::{Path, PathBuf};

use anyhow::Result;

use crate::store;
use crate::track::ablation::{Run, run, table};
#[cfg(feature = "figures")]
use crate::track::ablation_figure;

/// What `ablation` is asked for.
#[derive(Clone, Debug)]
pub struct AblationRequest {
    /// Where the numbers go as JSON.
    pub json: Option<PathBuf>,
    /// Folder for the pictures, SVG and PNG.
    pub out: Option<PathBuf>,
}

/// Plays the recorded actions with every profile, and gives the table that is printed.
///
/// # Errors
/// A file is missing or wrong, or a result cannot be written.
pub fn ablation(request: &AblationRequest) -> Result<String> {
    let runs = run()?;
    if let Some(path) = &request.json {
        let numbers: Vec<_> = runs.iter().map(|run| &run.result).collect();
        store::write_whole(path, (serde_json::to_string_pretty(&numbers)? + "\n").as_bytes())?;
    }
    let mut text = table(&runs);
    if let Some(folder) = &request.out {
        text += &draw(&runs, folder)?;
    }
    Ok(text)
}

#[cfg(feature = "figures")]
fn draw(runs: &[Run], folder: &Path) -> Result<String> {
    ablation_figure::draw(runs, folder)
}

#[cfg(not(feature = "figures"))]
fn draw(_: &[Run], _: &Path) -> Result<String> {
    anyhow::bail!("--out: this program was built without the feature figures")
}
