//! `tidy`: the layering of the workspace, and the rules of the sources that no compiler checks.

mod allowed;
mod arithmetic;
mod layering;
mod metadata;
mod sources;

use crate::runner::cargo;
use anyhow::{Context as _, ensure};
use metadata::Workspace;
use std::fmt;
use std::process::{Command, ExitCode};

/// A rule that does not hold: where, and what to do about it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Problem {
    /// A crate, or a file relative to the workspace root.
    place: String,
    message: String,
}

impl Problem {
    fn new(place: impl fmt::Display, message: impl Into<String>) -> Self {
        Self { place: place.to_string(), message: message.into() }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.message)
    }
}

/// Checks the workspace in the current folder. Problems go to standard error, one line each.
///
/// # Errors
/// The workspace cannot be read, or a rule does not hold.
pub(crate) fn run() -> anyhow::Result<ExitCode> {
    let workspace = Workspace::read(&ask_cargo()?)?;
    let mut problems = layering::check(&workspace.packages, allowed::ALLOWED);
    let files = sources::check(&workspace, &mut problems)?;
    for problem in &problems {
        crate::complain(problem);
    }
    ensure!(problems.is_empty(), "tidy: {} of the workspace's rules broken", problems.len());
    crate::print(&format!("tidy: {} crates, {files} source files\n", workspace.packages.len()))
}

/// What `cargo metadata` says about the members; it needs neither a network nor a lock file.
fn ask_cargo() -> anyhow::Result<String> {
    let output = Command::new(cargo())
        .args(["metadata", "--no-deps", "--format-version", "1"])
        .output()
        .context("failed to start cargo metadata")?;
    ensure!(output.status.success(), "cargo metadata: {}", String::from_utf8_lossy(&output.stderr).trim());
    String::from_utf8(output.stdout).context("cargo metadata: output is not UTF-8")
}
