//! The search for what trains best: candidates by name, each trained with several seeds and judged by one table.

use std::cmp::Ordering;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, Result, ensure};
use serde::{Deserialize, Serialize};

use crate::checkpoint;
use crate::config::{ConfigSpec, read_ron, run_folder};
use crate::draw::Purpose;
use crate::evaluation::{self, Plan, Summary, Violations};
use crate::interrupt::Stop;
use crate::machine::Machine;
use crate::progress::Display;
use crate::stage::Stage;
use crate::training::{self, Request, Training};
use crate::{statistics, store};

/// What is searched if no other file is named.
pub const SPACE: &str = "assets/search/space.ron";

/// What is searched; every field is in the file but those of a [`Candidate`], which say what it changes.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Space {
    /// Version of the file's format.
    pub schema: u32,
    /// Beginning of the runs' names.
    pub name: String,
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
    /// Every n-th episode without exploration.
    pub noiseless_every: Option<u64>,
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
    /// Time of the training, its confirmations and closing evaluations included \[s\]; of the last start alone if it was
    /// interrupted.
    pub seconds: f64,
    /// Limits that did not hold in any stage's training and closing evaluation, and while judging.
    pub violations: Violations,
    /// What the judging episodes found.
    pub judged: Summary,
}

impl Row {
    /// Environment steps of all stages.
    fn all_steps(&self) -> u64 {
        self.steps.iter().sum()
    }
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
        set(&mut config.curriculum.noiseless_every, self.noiseless_every.as_ref());
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
    let run = format!("{}-{candidate}-{}", space.name, config.seed);
    let (mut steps, mut mastered, mut seconds) = ([0; 3], [false; 3], 0.0);
    let mut violations = Violations { reference: 0, actual: 0 };
    for (index, stage) in Stage::ALL.into_iter().enumerate() {
        let folder = run_folder(&run, stage);
        if !folder.join("timing.json").exists() {
            let stop = Stop::default();
            let request = Request { run: run.clone(), stage, episodes: None, display, stop };
            let training = if training::latest(&folder).exists() {
                Training::resume(&request, Some(config), None)?
            } else {
                Training::start(&request, config.clone())?
            };
            training.run(&request)?;
        }
        let (header, _) = checkpoint::read(&training::latest(&folder))?;
        (steps[index], mastered[index]) = (header.steps, header.mastery.mastered);
        let json = |name: &str| -> Result<serde_json::Value> {
            let path = folder.join(name);
            serde_json::from_str(&store::read_text(&path)?).with_context(|| path.display().to_string())
        };
        seconds += json("timing.json")?["total"].as_f64().unwrap_or(f64::NAN);
        let certificate = json("certificate.json")?;
        violations.reference += certificate["violations"]["reference"].as_u64().unwrap_or(0);
        violations.actual += certificate["violations"]["actual"].as_u64().unwrap_or(0);
    }
    let (header, agent) = checkpoint::read(&training::best(&run_folder(&run, Stage::Orange)))?;
    let machine = Arc::new(Machine::load(config)?);
    let (episodes, seed) = (space.episodes, config.seed + space.judge);
    let plan = Plan { stage: Stage::Orange, episodes, seed, purpose: Purpose::Evaluation };
    let judged = evaluation::evaluate(agent.policy(), &header.scaling, &machine, plan)?.summary;
    violations.reference += judged.violations.reference;
    violations.actual += judged.violations.actual;
    let candidate = candidate.to_owned();
    Ok(Row { candidate, seed: config.seed, steps, mastered, seconds, violations, judged })
}

/// The results as a Markdown table: each candidate with its seeds, the best first, by the worst seed and then by the
/// mean.
#[must_use]
pub fn table(rows: &[Row]) -> String {
    let mut groups: Vec<Vec<&Row>> = Vec::new();
    for row in rows {
        match groups.iter_mut().find(|group| group[0].candidate == row.candidate) {
            Some(group) => group.push(row),
            None => groups.push(vec![row]),
        }
    }
    groups.sort_by(|a, b| {
        let key = |group: &[&Row]| {
            let rates = rates(group);
            (rates.iter().copied().fold(1.0, f64::min), statistics::mean(&rates))
        };
        key(b).partial_cmp(&key(a)).unwrap_or(Ordering::Equal)
    });
    let mut text = String::from(
        "| candidate | seed | orange reached | time to reach | tip error, speed at success | steps (purple, yellow, \
         orange) | training | ranges narrowed | violations |\n|---|---|---|---|---|---|---|---|---|\n",
    );
    for row in groups.iter().flatten() {
        text += &line(row);
    }
    text.push('\n');
    for group in groups {
        let rates = rates(&group);
        let steps: Vec<f64> = group.iter().map(|row| row.all_steps() as f64).collect();
        let _ = writeln!(
            text,
            "- {}: worst seed {:.2} %, mean {:.2} %, interquartile mean {:.2} %, {:.0} steps on average",
            group[0].candidate,
            100.0 * rates.iter().copied().fold(1.0, f64::min),
            100.0 * statistics::mean(&rates).unwrap_or(f64::NAN),
            100.0 * statistics::interquartile_mean(&rates).unwrap_or(f64::NAN),
            statistics::mean(&steps).unwrap_or(f64::NAN),
        );
    }
    text
}

fn rates(group: &[&Row]) -> Vec<f64> {
    group.iter().map(|row| row.judged.success_rate).collect()
}

fn line(row: &Row) -> String {
    let Row { candidate, seed, judged, violations, .. } = row;
    let number = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let steps: Vec<String> = row
        .steps
        .iter()
        .zip(row.mastered)
        .map(|(steps, mastered)| if mastered { steps.to_string() } else { format!("{steps}, not mastered") })
        .collect();
    format!(
        "| {candidate} | {seed} | {:.2} % | {:.2} s | {:.1} mm, {:.0} mm/s | {} ({}) | {:.0} s | {:.1} % | {} + {} |\n",
        100.0 * judged.success_rate,
        number(judged.time_to_reach_s.mean),
        1e3 * number(judged.at_success.tip_error_m.mean),
        1e3 * number(judged.at_success.tip_speed_m_s.mean),
        row.all_steps(),
        steps.join(", "),
        row.seconds,
        100.0 * judged.intervention_rate,
        violations.reference,
        violations.actual,
    )
}

/// The table with what it is of, for `docs/`.
#[must_use]
pub fn page(path: &Path, out: &Path, table: &str) -> String {
    let (path, out) = (path.display(), out.display());
    format!(
        "# What trains best\n\nThe candidates of `{path}`, which says what each changes. Each was trained through all \
         stages with every seed and judged without exploration on fresh episodes of orange. Training times are of the \
         machine that this was written on, whatever else it did, and of the last part of a stage that was stopped in \
         between; violations are of the reference and of the actual \
         motion, in training and evaluation.\n\n`cargo xtask search --space {path} --out {out}` writes this page.\n\n{table}",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(candidate: &str, seed: u64, success_rate: f64) -> Row {
        let judged = serde_json::json!({
            "episodes": 100, "success_rate": success_rate, "success_ci95": [0.9, 1.0],
            "time_to_reach_s": {"mean": 1.5, "median": 1.4, "p95": 2.0},
            "tip_error_m": {"mean": 0.05, "max": 0.1},
            "at_success": {
                "tip_error_m": {"mean": 0.04, "max": 0.05}, "tip_speed_m_s": {"mean": 0.08, "max": 0.1},
            },
            "violations": {"reference": 0, "actual": 0},
            "worst_margin": {"position": 0.1, "velocity": 0.1, "acceleration": 0.1, "jerk": 0.1},
            "tracking_error": {}, "held_joint_tip_error_m": {"max": 0.0},
            "intervention_rate": 0.25, "saturation_rate": 0.0, "failsafe_count": 0,
        });
        Row {
            candidate: candidate.into(),
            seed,
            steps: [10, 20, 30 + seed],
            mastered: [true, true, seed == 0],
            seconds: 90.4,
            violations: Violations { reference: 0, actual: 1 },
            judged: serde_json::from_value(judged).unwrap(),
        }
    }

    #[test]
    fn candidates_are_ranked_by_their_worst_seed() {
        let rows = [row("odd", 0, 1.0), row("odd", 2, 0.97), row("even", 0, 0.98), row("even", 2, 0.98)];
        let table = table(&rows);
        let lines: Vec<&str> = table.lines().skip(2).collect();
        let reached = "1.50 s | 40.0 mm, 80 mm/s";
        let rest = "90 s | 25.0 % | 0 + 1 |";
        assert_eq!(lines[0], format!("| even | 0 | 98.00 % | {reached} | 60 (10, 20, 30) | {rest}"));
        assert_eq!(
            lines[3],
            format!("| odd | 2 | 97.00 % | {reached} | 62 (10, 20, 32, not mastered) | {rest}")
        );
        assert_eq!(
            lines[5],
            "- even: worst seed 98.00 %, mean 98.00 %, interquartile mean 98.00 %, 61 steps on average"
        );
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
