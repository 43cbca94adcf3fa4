//! The braking tables of every joint, as files.

use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use safezone::BrakingTable;

use crate::config::ConfigSpec;
use crate::{machine, store};

/// What to do about the tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tables {
    /// Write those that are missing or differ.
    Build,
    /// Write nothing; complain of those that are missing or differ.
    Check,
}

/// Builds the braking table of every joint of the configured crane, or checks that the files hold just these.
///
/// # Errors
/// A limit leaves no motion, a file cannot be written, or, when checking, a table is stale; the message then names the
/// command that repairs it.
pub fn tables(config: &ConfigSpec, what: Tables) -> Result<String> {
    let mut report = String::new();
    let mut stale = Vec::new();
    for (path, wanted) in build(config)? {
        let is_current = path.exists() && store::read_text(&path)? == wanted;
        match what {
            Tables::Check if !is_current => stale.push(path.display().to_string()),
            Tables::Build if !is_current => {
                store::write_whole(&path, wanted.as_bytes())?;
                report += &format!("built {}\n", path.display());
            }
            Tables::Build | Tables::Check => report += &format!("up to date: {}\n", path.display()),
        }
    }
    if !stale.is_empty() {
        bail!("missing or stale: {}; rebuild with: cargo xtask tables [--config FILE]", stale.join(", "));
    }
    Ok(report)
}

/// Every table that the configuration asks for, with the file that it belongs into.
fn build(config: &ConfigSpec) -> Result<Vec<(PathBuf, String)>> {
    let model = machine::load_model(config)?;
    model
        .actuators()
        .iter()
        .map(|actuator| {
            let planner = machine::planner(actuator, config)?;
            let table = BrakingTable::build(&planner).with_context(|| actuator.name().to_owned())?;
            Ok((machine::table_path(config, actuator.name()), table.to_ron()))
        })
        .collect()
}
