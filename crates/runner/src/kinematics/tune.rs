//! Gains, tuned.

use anyhow::{Result, bail, ensure};

use crate::track::setup::Law;
use crate::tune::file::tune_to_file;
use crate::tune::{TRAINING, Tuning};

/// Rounds per law, unless said otherwise.
const DEFAULT_BUDGET: u32 = 25;

/// What `tune` is asked for.
#[derive(Clone, Debug)]
pub struct TuneRequest {
    /// The law, if not all of them.
    pub law: Option<Law>,
    /// Plants that the gains are for, if not all of them: `electric` or `light`.
    pub family: Option<String>,
    /// Rounds of the search per law.
    pub budget: Option<u32>,
    /// Seed of the search, 0 unless said otherwise.
    pub seed: Option<u64>,
}

/// Tunes gains and writes them to their files.
///
/// # Errors
/// The plants are not known, a training scenario is wrong, or a file cannot be written.
pub fn tune(request: &TuneRequest) -> Result<String> {
    ensure!(
        request.law != Some(Law::ComputedTorqueExact),
        "computed-torque-exact has the gains of computed-torque: tune that"
    );
    let all = [Law::Pd, Law::Pid, Law::ComputedTorque, Law::Adaptive];
    let laws = request.law.map_or(all.to_vec(), |law| vec![law]);
    let mut text = String::new();
    let mut known = false;
    for (family, _) in TRAINING {
        if request.family.as_deref().is_some_and(|wanted| wanted != family) {
            continue;
        }
        known = true;
        for &law in &laws {
            let (budget, seed) = (request.budget.unwrap_or(DEFAULT_BUDGET), request.seed.unwrap_or(0));
            text += &tune_to_file(Tuning { law, family, budget, seed })?;
        }
    }
    if !known {
        bail!("--plant {}: there are electric and light", request.family.as_deref().unwrap_or_default());
    }
    Ok(text)
}
