//! Names of what is on disk, looked at before a program is built that would refuse them after minutes.

use crate::args::{UsageError, is_policy_name, unknown};
use crate::flags::Whose;
use std::path::Path;

/// Folder of the runs, in the workspace's root.
const RUNS: &str = "runs";

/// Folder of the policies that come with the project.
const POLICIES: &str = "assets/policies";

/// Folder of the scenarios.
const SCENARIOS: &str = "assets/scenarios";

/// Refuses a run that is not there, with the nearest that is.
///
/// # Errors
/// There is no folder of that name.
pub(crate) fn check_run(name: &str) -> Result<(), UsageError> {
    if Path::new(RUNS).join(name).is_dir() {
        return Ok(());
    }
    let known = listed(RUNS, |path| path.is_dir().then(|| path.file_name()?.to_str().map(str::to_owned))?);
    let message = if known.is_empty() {
        format!(
            "no run is called `{name}`, and there is none; first: cargo xtask train --stage purple --run {name}"
        )
    } else {
        unknown("run", name, &known) + "; see `cargo xtask runs`"
    };
    Err(UsageError::new(message))
}

/// Refuses a policy's name that there is none of, with the nearest that is; a path was looked at before.
///
/// # Errors
/// There is no file of that name.
pub(crate) fn check_policy(policy: &str) -> Result<(), UsageError> {
    if !is_policy_name(policy) {
        return Ok(());
    }
    let is_policy = |path: &Path| path.extension().is_some_and(|end| end == "policy");
    let known =
        listed(POLICIES, |path| is_policy(path).then(|| path.file_stem()?.to_str().map(str::to_owned))?);
    if known.iter().any(|known| known == policy) {
        Ok(())
    } else {
        Err(UsageError::new(unknown("policy", policy, &known) + "; or the path of a file"))
    }
}

/// Refuses a run or a policy that is not there.
///
/// # Errors
/// As [`check_run`] and [`check_policy`].
pub(crate) fn check_whose(whose: &Whose) -> Result<(), UsageError> {
    match whose {
        Whose::Run(run) => check_run(run),
        Whose::Policy(policy) => check_policy(policy),
    }
}

/// Refuses a scenario that is not there, with the nearest that is.
///
/// # Errors
/// There is no file of that name.
pub(crate) fn check_scenario(name: &str) -> Result<(), UsageError> {
    let is_ron = |path: &Path| path.extension().is_some_and(|end| end == "ron");
    let mut known =
        listed(SCENARIOS, |path| is_ron(path).then(|| path.file_stem()?.to_str().map(str::to_owned))?);
    known.push("all".to_owned());
    if known.iter().any(|known| known == name) {
        Ok(())
    } else {
        Err(UsageError::new(unknown("scenario", name, &known)))
    }
}

/// What `name_of` finds in a folder, sorted; nothing if there is no folder.
fn listed(folder: &str, name_of: impl Fn(&Path) -> Option<String>) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries.filter_map(|entry| name_of(&entry.path())).collect();
    names.sort();
    names
}
