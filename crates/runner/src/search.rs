//! The search for what trains best: candidates by name, each trained with several seeds and judged by one table.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, Result, ensure};
use sac_burn::Policy;
use serde::{Deserialize, Serialize};

use crate::checkpoint;
use crate::config::{ConfigSpec, read_ron, run_folder};
use crate::draw::Purpose;
use crate::evaluation::{self, Plan, Violations};
use crate::machine::Machine;
use crate::observation::Scaling;
use crate::progress::Display;
use crate::stage::Stage;
use crate::statistics;
use crate::training::{self, Request, Training};

/// What is searched if no other file is named.
pub const SPACE: &str = "assets/search/space.ron";

/// What is searched; every field is in the file but those of a [`Candidate`], which say what it changes.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Space {
    /// Version of the file's format.
    pub schema: u32,
    /// The configuration that the candidates change.
    pub base: PathBuf,
    /// Seeds with which each candidate is trained.
    pub seeds: Vec<u64>,
    /// Episodes of orange, without exploration, by which a trained policy is judged.
    pub episodes: u64,
    /// Added to a seed for the starts and targets of those episodes, so that no result quoted elsewhere was searched for.
    pub judge: u64,
    /// What is tried.
    pub candidates: Vec<Candidate>,
}

/// Changes to the base configuration.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Candidate {
    /// Name, part of the run's name.
    pub name: String,
    /// Units of the hidden layers.
    pub hidden: Option<Vec<usize>>,
    /// Transitions in one update.
    pub batch_size: Option<usize>,
    /// Discount per step.
    pub discount: Option<f64>,
    /// Step size of Adam.
    pub learning_rate: Option<f64>,
    /// Share that the target critics take over.
    pub polyak: Option<f64>,
    /// Share that the policy takes over of the actor.
    pub policy_share: Option<f64>,
    /// Updates per environment step.
    pub updates_per_step: Option<u32>,
    /// Entropy that the temperature is steered to \[nat\].
    pub target_entropy: Option<f64>,
    /// Steps of random actions, and transitions before the first update.
    pub random_steps: Option<u64>,
    /// Cost of effort.
    pub effort: Option<f64>,
    /// Cost of distance.
    pub distance: Option<f64>,
    /// Cost of speed.
    pub speed: Option<f64>,
    /// Reward of success.
    pub success: Option<f64>,
}

/// One training of the search.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// The candidate.
    pub candidate: String,
    /// Its seed.
    pub seed: u64,
    /// Environment steps of each stage.
    pub steps: [u64; 3],
    /// True for each stage that a confirmation ended.
    pub mastered: [bool; 3],
    /// Share of the judging episodes that reached the target.
    pub success_rate: f64,
    /// Mean time to reach the target \[s\].
    pub time_to_reach_s: Option<f64>,
    /// Limits that did not hold while judging.
    pub violations: Violations,
}

impl Candidate {
    /// The base configuration with this candidate's changes and a seed.
    ///
    /// # Errors
    /// A value is outside its range.
    pub fn apply(&self, base: &ConfigSpec, seed: u64) -> Result<ConfigSpec> {
        let mut config = base.clone();
        let mut learner = config.learner.spec().clone();
        set(&mut learner.hidden, self.hidden.as_ref());
        set(&mut learner.batch_size, self.batch_size.as_ref());
        set(&mut learner.discount, self.discount.as_ref());
        set(&mut learner.learning_rate, self.learning_rate.as_ref());
        set(&mut learner.polyak, self.polyak.as_ref());
        set(&mut learner.policy_share, self.policy_share.as_ref());
        set(&mut learner.updates_per_step, self.updates_per_step.as_ref());
        set(&mut learner.random_steps, self.random_steps.as_ref());
        if let Some(steps) = self.random_steps {
            learner.update_after = steps as usize;
        }
        if self.target_entropy.is_some() {
            learner.target_entropy = self.target_entropy;
        }
        set(&mut config.reward.effort, self.effort.as_ref());
        set(&mut config.reward.distance, self.distance.as_ref());
        set(&mut config.reward.speed, self.speed.as_ref());
        set(&mut config.reward.success, self.success.as_ref());
        config.learner = sac_burn::Config::try_from(learner)?;
        config.seed = seed;
        config.check()?;
        Ok(config)
    }
}

fn set<T: Clone>(field: &mut T, change: Option<&T>) {
    if let Some(value) = change {
        field.clone_from(value);
    }
}

/// Trains and judges every candidate, each from where an interrupted search left it.
///
/// # Errors
/// The file is wrong, or a training failed.
pub fn search(path: &Path, display: Display) -> Result<Vec<Row>> {
    let space: Space = read_ron(path)?;
    let in_file = || path.display().to_string();
    ensure!(space.schema == 1, "{}: schema is {}, this program reads schema 1", in_file(), space.schema);
    ensure!(space.episodes > 0, "{}: episodes must be at least 1, got 0", in_file());
    let base = ConfigSpec::read(&space.base)?;
    let mut rows = Vec::new();
    for candidate in &space.candidates {
        for &seed in &space.seeds {
            let config = candidate
                .apply(&base, seed)
                .with_context(|| format!("{}: candidate {}", in_file(), candidate.name))?;
            rows.push(judge(&candidate.name, &config, &space, display)?);
        }
    }
    Ok(rows)
}

/// Trains a candidate through all stages, as far as that was not done before, and judges the last policy.
fn judge(candidate: &str, config: &ConfigSpec, space: &Space, display: Display) -> Result<Row> {
    let run = format!("search-{candidate}-{}", config.seed);
    let (mut steps, mut mastered) = ([0; 3], [false; 3]);
    for (index, stage) in Stage::ALL.into_iter().enumerate() {
        let folder = run_folder(&run, stage);
        if !folder.join("eval.json").exists() {
            let request = Request { run: run.clone(), stage, episodes: None, display };
            let training = if training::latest(&folder).exists() {
                Training::resume(&request, Some(config), None)?
            } else {
                Training::start(&request, config.clone())?
            };
            training.run(&request)?;
        }
        let (header, _) = checkpoint::read(&training::latest(&folder))?;
        (steps[index], mastered[index]) = (header.steps, header.mastery.mastered);
    }
    let (header, agent) = checkpoint::read(&training::best(&run_folder(&run, Stage::Orange)))?;
    let (success_rate, time_to_reach_s, violations) =
        success(agent.policy(), &header.scaling, config, space)?;
    let candidate = candidate.to_owned();
    Ok(Row { candidate, seed: config.seed, steps, mastered, success_rate, time_to_reach_s, violations })
}

fn success(
    policy: &Policy,
    scaling: &Scaling,
    config: &ConfigSpec,
    space: &Space,
) -> Result<(f64, Option<f64>, Violations)> {
    let machine = Arc::new(Machine::load(config)?);
    let seed = config.seed + space.judge;
    let plan = Plan { stage: Stage::Orange, episodes: space.episodes, seed, purpose: Purpose::Evaluation };
    let summary = evaluation::evaluate(policy, scaling, &machine, plan)?.summary;
    Ok((summary.success_rate, summary.time_to_reach_s.mean, summary.violations))
}

/// The results as a Markdown table, a line for each candidate, the best first: by the worst seed, then by the mean.
#[must_use]
pub fn table(rows: &[Row]) -> String {
    let mut groups: Vec<Vec<&Row>> = Vec::new();
    for row in rows {
        match groups.iter_mut().find(|group| group[0].candidate == row.candidate) {
            Some(group) => group.push(row),
            None => groups.push(vec![row]),
        }
    }
    let worst = |group: &[&Row]| group.iter().map(|row| row.success_rate).fold(1.0, f64::min);
    let mean = |group: &[&Row], of: fn(&Row) -> f64| {
        statistics::mean(&group.iter().map(|row| of(row)).collect::<Vec<_>>()).unwrap_or(f64::NAN)
    };
    groups.sort_by(|a, b| {
        let key = |group: &[&Row]| (worst(group), mean(group, |row| row.success_rate));
        key(b).partial_cmp(&key(a)).unwrap_or(std::cmp::Ordering::Equal)
    });
    let mut text = String::from(
        "| candidate | seeds | orange, worst seed | mean | time to reach | steps purple + yellow + orange | violations |\n\
         |---|---|---|---|---|---|---|\n",
    );
    for group in &groups {
        let steps: Vec<String> = (0..3)
            .map(|stage| {
                let sum: u64 = group.iter().map(|row| row.steps[stage]).sum();
                (sum / group.len() as u64).to_string()
            })
            .collect();
        let violations: u64 = group.iter().map(|row| row.violations.reference + row.violations.actual).sum();
        let _ = writeln!(
            text,
            "| {} | {} | {:.2} % | {:.2} % | {:.2} s | {} | {violations} |",
            group[0].candidate,
            group.len(),
            100.0 * worst(group),
            100.0 * mean(group, |row| row.success_rate),
            mean(group, |row| row.time_to_reach_s.unwrap_or(f64::NAN)),
            steps.join(" + "),
        );
    }
    text
}

/// The table with what it is of, for `docs/`.
#[must_use]
pub fn page(space: &Path, table: &str) -> String {
    format!(
        "# Search for the default configuration\n\n\
         Candidates of `{}`, which says what each changes; each was trained through all stages with every seed and \
         judged without exploration on fresh episodes of orange. Written by `cargo xtask search --out docs/search.md`.\n\n\
         {table}",
        space.display()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(candidate: &str, seed: u64, success_rate: f64) -> Row {
        Row {
            candidate: candidate.into(),
            seed,
            steps: [10, 20, 30 + seed],
            mastered: [true; 3],
            success_rate,
            time_to_reach_s: Some(1.5),
            violations: Violations { reference: 0, actual: 0 },
        }
    }

    #[test]
    fn candidates_are_ranked_by_their_worst_seed() {
        let table =
            table(&[row("even", 0, 0.98), row("even", 2, 0.98), row("odd", 0, 1.0), row("odd", 2, 0.97)]);
        let lines: Vec<&str> = table.lines().skip(2).collect();
        assert_eq!(lines[0], "| even | 2 | 98.00 % | 98.00 % | 1.50 s | 10 + 20 + 31 | 0 |");
        assert_eq!(lines[1], "| odd | 2 | 97.00 % | 98.50 % | 1.50 s | 10 + 20 + 31 | 0 |");
    }

    #[test]
    fn a_candidate_changes_what_it_names_and_nothing_else() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let base = ConfigSpec::read(&root.join(crate::config::DEFAULT)).unwrap();
        let candidate: Candidate =
            ron::from_str("(name: \"x\", hidden: Some([8]), success: Some(3.0))").unwrap();
        let changed = candidate.apply(&base, 9).unwrap();
        assert_eq!((changed.learner.spec().hidden.as_slice(), changed.reward.success), ([8].as_slice(), 3.0));
        let mut back = changed.clone();
        (back.learner, back.reward.success, back.seed) =
            (base.learner.clone(), base.reward.success, base.seed);
        assert_eq!(back, base);
        let wrong = Candidate { polyak: Some(2.0), ..candidate };
        assert!(wrong.apply(&base, 0).unwrap_err().to_string().contains("polyak must be in (0, 1]"));
    }
}
