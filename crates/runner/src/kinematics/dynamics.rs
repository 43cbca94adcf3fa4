//! The dynamics of given states, for comparison with other programs.

use std::path::Path;

use anyhow::{Context, Result, anyhow, ensure};
use hiab_dynamics::{Actuator, CraneModel, Evaluation, StateQuery};
use serde::Deserialize;

use crate::config::ConfigSpec;
use crate::store;

/// A file of states; what else is in it is passed over.
#[derive(Deserialize)]
struct StateFile {
    /// Names of the actuators in the order of the states' vectors.
    actuated: Option<Vec<String>>,
    states: Vec<StateQuery>,
}

/// Evaluates every state of a file with the configured crane as a bare rigid body: no payload, armature or friction.
///
/// Gives a JSON list with one object for each state, in the order of the file.
///
/// # Errors
/// A file is missing or wrong, or a state is outside the range in which the loops close; the message says which.
pub fn dynamics(config: &ConfigSpec, states: &Path) -> Result<String> {
    let crane = &config.crane;
    let urdf = store::read_text(&crane.urdf)?;
    let loops = store::read_text(&crane.loops)?;
    let model = CraneModel::from_urdf(&urdf, &loops)
        .with_context(|| format!("{} with {}", crane.urdf.display(), crane.loops.display()))?;
    let text = store::read_text(states)?;
    let file: StateFile =
        serde_json::from_str(&text).map_err(|error| anyhow!("{}: {error}", states.display()))?;
    if let Some(named) = &file.actuated {
        let ours: Vec<&str> = model.actuators().iter().map(Actuator::name).collect();
        ensure!(*named == ours, "{}: `actuated` is {named:?}, the crane has {ours:?}", states.display());
    }
    let mut data = model.new_data();
    let results = file
        .states
        .iter()
        .enumerate()
        .map(|(index, state)| {
            model.evaluate(&mut data, state).with_context(|| format!("{}: states[{index}]", states.display()))
        })
        .collect::<Result<Vec<Evaluation>>>()?;
    Ok(serde_json::to_string(&results)? + "\n")
}
