//! Episodes of a trained policy, recorded as actions: references for `cargo xtask track`.

use std::path::Path;
use std::sync::Arc;

use anyhow::Result;
use sac_burn::Policy;

use crate::draw::{Purpose, Stream};
use crate::environment::Environment;
use crate::machine::Machine;
use crate::observation::Scaling;
use crate::stage::Stage;
use crate::store;
use crate::track::scenario::Recording;

/// Which episode is recorded.
#[derive(Clone, Copy, Debug)]
pub struct Take {
    /// The region.
    pub stage: Stage,
    /// Seed of start and target.
    pub seed: u64,
    /// Number of the episode, as in an evaluation with that seed.
    pub episode: u64,
}

/// Plays one episode of an evaluation without exploration and writes its actions to `path`.
///
/// # Errors
/// The region cannot be reached, the simulation left its range, or the file cannot be written.
pub fn record(
    policy: &Policy,
    scaling: &Scaling,
    machine: &Arc<Machine>,
    take: Take,
    origin: &str,
    path: &Path,
) -> Result<String> {
    let Take { stage, seed, episode } = take;
    let mut environment = Environment::new(Arc::clone(machine), false);
    let mut stream = Stream::of_episode(seed, Purpose::Evaluation, stage, episode);
    let drawn = environment.draw(machine.regions().of(stage), &mut stream)?;
    environment.start(&drawn)?;
    let mut input = vec![0.0; scaling.len()];
    let mut action = vec![0.0; policy.action_dim()];
    let mut actions = Vec::new();
    let ending = loop {
        environment.observe(scaling, &mut input);
        policy.act(&input, &mut action);
        actions.push(action.clone());
        if let Some(ending) = environment.step(&action)?.ending {
            break ending;
        }
    };
    let names: Vec<String> =
        machine.moving().iter().map(|&joint| machine.joints()[joint].name.clone()).collect();
    let start = machine.moving().iter().zip(&names).map(|(&joint, name)| (name.clone(), drawn.start[joint]));
    let steps = actions.len();
    let recording = Recording {
        schema: 1,
        source: format!("{origin}; episode {episode} of stage {stage}, seed {seed}: {ending:?}"),
        period: machine.rates().policy_period(),
        start: start.collect(),
        joints: names,
        actions,
    };
    let header = "// Actions of a trained policy, recorded by `cargo xtask record`; do not edit.\n";
    let pretty = ron::ser::PrettyConfig::new().struct_names(false).compact_arrays(true);
    let text = ron::ser::to_string_pretty(&recording, pretty)?;
    store::write_whole(path, (header.to_owned() + &text + "\n").as_bytes())?;
    Ok(format!("recorded {steps} steps, {ending:?}: {}\n", path.display()))
}
