//! What runs left on disk, as tables.

use std::path::Path;

use anyhow::{Context, Result};
use serde_json::Value;

use super::page::{Page, grouped};
use crate::config::run_folder;
use crate::evaluation::Summary;
use crate::machine::short;
use crate::stage::Stage;
use crate::trained::Trained;
use crate::{statistics, store};

/// The quantities of a certificate's margins, in the order of its tables.
const QUANTITIES: [&str; 4] = ["position", "velocity", "acceleration", "jerk"];

/// One finished stage of a run, or of the training that a policy's file is from.
#[derive(Clone, Debug)]
pub(super) struct StageResult {
    /// What the run or the policy is called.
    pub(super) name: String,
    pub(super) stage: Stage,
    pub(super) summary: Summary,
    pub(super) certificate: Value,
    /// The configuration, as RON.
    pub(super) config: String,
    /// The commands that train and evaluate it again.
    pub(super) again: [String; 2],
}

impl StageResult {
    /// Limits that did not hold, in training and evaluation, reference and actual together.
    pub(super) fn violations(&self) -> u64 {
        let of = |motion: &str| self.certificate["violations"][motion].as_u64().unwrap_or(u64::MAX / 4);
        of("reference") + of("actual")
    }

    /// Commands of the controllers, in training and evaluation.
    pub(super) fn commands(&self) -> u64 {
        ["training", "evaluation"].iter().filter_map(|part| self.certificate[part]["commands"].as_u64()).sum()
    }

    /// Episodes of the evaluation that reached their target.
    fn successes(&self) -> usize {
        (self.summary.success_rate * self.summary.episodes as f64).round() as usize
    }
}

/// Every finished stage of every run, stage by stage.
///
/// # Errors
/// A file is not of the form that a training writes.
pub(super) fn read(runs: &[String]) -> Result<Vec<StageResult>> {
    let mut results = Vec::new();
    for stage in Stage::ALL {
        for run in runs {
            let folder = run_folder(run, stage);
            if !folder.join("eval.json").exists() {
                continue;
            }
            let parse = |name: &str| -> Result<Value> {
                let path = folder.join(name);
                serde_json::from_str(&store::read_text(&path)?).with_context(|| path.display().to_string())
            };
            let summary: Summary = serde_json::from_value(parse("eval.json")?)
                .with_context(|| folder.join("eval.json").display().to_string())?;
            let certificate = parse("certificate.json")?;
            let config = store::read_text(&folder.join("config.ron"))?;
            let again = again(run, stage, &certificate, &summary);
            results.push(StageResult { name: run.clone(), stage, summary, certificate, config, again });
        }
    }
    Ok(results)
}

/// What the file of a policy says of the training that it is from.
///
/// # Errors
/// The file is that of a checkpoint, whose stage is not closed.
pub(super) fn of_policy(policy: &str, trained: &Trained) -> Result<StageResult> {
    let header = trained.header.as_ref().with_context(|| {
        format!("{policy} is a checkpoint, which holds no evaluation; give the policy's file or --run NAME")
    })?;
    let stem = Path::new(policy).file_stem().and_then(|stem| stem.to_str()).unwrap_or(policy);
    let (stage, episodes) = (header.stage, header.evaluation.episodes);
    Ok(StageResult {
        name: format!("policy {stem}"),
        stage,
        summary: header.evaluation.clone(),
        certificate: serde_json::to_value(&header.certificate)?,
        config: header.config.to_ron()?,
        again: [
            "cargo xtask train --all --run again --config config.ron  # the configuration above".to_owned(),
            format!("cargo xtask eval --policy {policy} --stage {stage} --episodes {episodes}"),
        ],
    })
}

/// The commands that train a stage of a run again, under another name, and evaluate the run's own policy.
fn again(run: &str, stage: Stage, certificate: &Value, summary: &Summary) -> [String; 2] {
    let config = run_folder(run, stage).join("config.ron");
    [
        format!(
            "cargo xtask train --stage {stage} --run again-{run} --seed {} --config {}",
            certificate["seed"],
            config.display()
        ),
        format!("cargo xtask eval --run {run} --stage {stage} --episodes {}", summary.episodes),
    ]
}

/// One sentence about all runs of a stage.
pub(super) fn pooled(results: &[StageResult], stage: Stage) -> Option<String> {
    let of_stage: Vec<&StageResult> = results.iter().filter(|result| result.stage == stage).collect();
    let episodes: usize = of_stage.iter().map(|result| result.summary.episodes as usize).sum();
    let successes: usize = of_stage.iter().map(|result| result.successes()).sum();
    let [low, high] = statistics::wilson_95(successes, episodes).map(|bound| 100.0 * bound);
    let runs = if of_stage.len() == 1 { "one run".to_owned() } else { format!("{} runs", of_stage.len()) };
    (episodes > 0).then(|| {
        format!(
            "{successes} of {episodes} fresh episodes reached their target ({:.1} %, 95 % interval {low:.1} to \
             {high:.1} %, {runs}).",
            100.0 * successes as f64 / episodes as f64
        )
    })
}

/// A row for each run and stage, and one for all runs of a stage where there are several.
pub(super) fn table(page: &mut Page, results: &[StageResult]) {
    let heads = [
        "Stage, run",
        "Training episodes",
        "Steps",
        "Reached",
        "95 % interval",
        "Median time",
        "95 % of times",
        "Largest tip error",
        "Narrowed ranges",
    ];
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let interval = |[low, high]: [f64; 2]| format!("{:.1} to {:.1} %", 100.0 * low, 100.0 * high);
    let optional = |value: Option<f64>, unit: &str, decimals: usize| match value {
        Some(value) => format!("{value:.decimals$} {unit}"),
        None => "–".to_owned(),
    };
    let rows: Vec<Vec<String>> = results
        .iter()
        .map(|result| {
            let StageResult { name, stage, summary, certificate, .. } = result;
            let count = |key: &str| certificate[key].as_u64().map_or_else(|| "–".to_owned(), grouped);
            vec![
                format!("{stage}, {name}"),
                count("episodes"),
                count("steps"),
                percent(summary.success_rate),
                interval(summary.success_ci95),
                optional(summary.time_to_reach_s.median, "s", 2),
                optional(summary.time_to_reach_s.p95, "s", 2),
                optional(summary.tip_error_m.max, "m", 3),
                percent(summary.intervention_rate),
            ]
        })
        .collect();
    page.table(&heads, &rows);
    page.html(
        "<p class=\"muted\">Intervals are Wilson's. Times are of the episodes that reached their target; tip errors of \
         all.</p>\n",
    );
}

/// Worst margins by joint, over all runs and stages, training and evaluation.
pub(super) fn certificate(page: &mut Page, results: &[StageResult]) {
    let parts =
        || results.iter().flat_map(|result| ["training", "evaluation"].map(|part| &result.certificate[part]));
    let count = |key: &str| grouped(parts().filter_map(|part| part[key].as_u64()).sum());
    let violations = |motion: &str| {
        let found = results.iter().filter_map(|result| result.certificate["violations"][motion].as_u64());
        grouped(found.sum())
    };
    let rows = [
        ("Limits exceeded by the reference", violations("reference")),
        ("Limits exceeded by the actual motion", violations("actual")),
        ("Safe ranges computed", count("ranges")),
        ("of these empty", count("empty_ranges")),
        ("of these narrowed by a position limit", count("narrowed_ranges")),
        ("Commands of the controllers", count("commands")),
        ("of these saturated", count("saturated_commands")),
        ("Commands of the fail-safe", count("failsafe_count")),
    ];
    let rows: Vec<Vec<String>> = rows.into_iter().map(|(name, value)| vec![name.to_owned(), value]).collect();
    page.table(&["Counted in training and evaluation", ""], &rows);

    let mut names: Vec<&String> = Vec::new();
    for name in parts().filter_map(|part| part["joints"].as_object()).flat_map(|joints| joints.keys()) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let rows: Vec<Vec<String>> = names
        .into_iter()
        .map(|name| {
            let mut row = vec![short(name).replace('_', " ")];
            for motion in ["reference", "actual"] {
                row.extend(QUANTITIES.map(|quantity| {
                    let margins = parts().filter_map(|part| part["joints"][name][motion][quantity].as_f64());
                    format!("{:.2} %", 100.0 * margins.fold(f64::INFINITY, f64::min))
                }));
            }
            row
        })
        .collect();
    let heads = [
        "Worst margin",
        "Reference position",
        "Reference velocity",
        "Reference acceleration",
        "Reference jerk",
        "Actual position",
        "Actual velocity",
        "Actual acceleration",
        "Actual jerk",
    ];
    page.html(
        "<p>Worst margins to the actuators' limits, as shares of them: first of the reference, exact, then of the actual \
         motion at every tick.</p>\n",
    );
    page.table(&heads, &rows);
}
