//! What there is under `runs/`: stage, seed, result, age, and the command that goes on with each.

use std::path::Path;
use std::time::{Duration, SystemTime};

use anyhow::{Context, Result};
use serde::Serialize;
use serde_json::Value;

use crate::config::{ConfigSpec, Goal, run_folder};
use crate::stage::Stage;
use crate::store;

/// How the list is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunsFormat {
    /// A table for a person.
    Text,
    /// A list of objects.
    Json,
}

/// How far a stage of a run is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
enum State {
    /// Mastered, confirmed and evaluated.
    Mastered,
    /// Its episodes are used up, and its best policy is evaluated.
    Ended,
    /// Neither; either it trains at this moment, or it was stopped.
    Open,
    /// A file of it cannot be read.
    Damaged,
}

/// A stage of a run. Its fields are the keys of the JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Entry {
    run: String,
    stage: Stage,
    state: State,
    seed: Option<u64>,
    episodes: u64,
    steps: u64,
    /// Share of successes over the last episodes of the training.
    success_rate: f64,
    /// Of the evaluation that closed it: episodes and share of successes.
    evaluation: Option<Evaluated>,
    /// What was wrong, if something was.
    problem: Option<String>,
    /// Since the last episode or result was written \[s\].
    age: f64,
    /// What goes on with it; none after the last stage.
    next: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
struct Evaluated {
    episodes: u64,
    success_rate: f64,
}

/// Lists every stage of every run, the run that changed last first.
///
/// # Errors
/// The folder of runs is there and cannot be read.
pub fn runs(format: RunsFormat) -> Result<String> {
    let entries = list(SystemTime::now())?;
    match format {
        RunsFormat::Json => Ok(serde_json::to_string_pretty(&entries)? + "\n"),
        RunsFormat::Text if entries.is_empty() => {
            Ok("There is no run yet; the first: cargo xtask train --stage purple\n".to_owned())
        }
        RunsFormat::Text => Ok(table(&entries)),
    }
}

fn list(now: SystemTime) -> Result<Vec<Entry>> {
    let folder = Path::new("runs");
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let names = std::fs::read_dir(folder).with_context(|| folder.display().to_string())?;
    let names = names.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let mut runs: Vec<Vec<Entry>> = names
        .map(|run| Stage::ALL.into_iter().filter_map(|stage| entry(&run, stage, now)).collect())
        .filter(|stages: &Vec<Entry>| !stages.is_empty())
        .collect();
    let age = |run: &[Entry]| run.iter().map(|entry| entry.age).fold(f64::INFINITY, f64::min);
    runs.sort_by(|a, b| age(a).total_cmp(&age(b)).then_with(|| a[0].run.cmp(&b[0].run)));
    Ok(runs.concat())
}

/// A stage of a run; none if it was never begun.
fn entry(run: &str, stage: Stage, now: SystemTime) -> Option<Entry> {
    let folder = run_folder(run, stage);
    if !folder.is_dir() {
        return None;
    }
    let changed = ["config.ron", "metrics.jsonl", "eval.json"].iter().filter_map(|name| {
        let modified = std::fs::metadata(folder.join(name)).ok()?.modified().ok()?;
        now.duration_since(modified).ok()
    });
    let blank = Entry {
        run: run.to_owned(),
        stage,
        state: State::Damaged,
        seed: None,
        episodes: 0,
        steps: 0,
        success_rate: 0.0,
        evaluation: None,
        problem: None,
        age: changed.min().unwrap_or(Duration::ZERO).as_secs_f64(),
        next: None,
    };
    Some(match found(&folder, &blank) {
        Ok(entry) => entry,
        Err(error) => Entry { problem: Some(crate::command::one_line(&error)), ..blank },
    })
}

fn found(folder: &Path, blank: &Entry) -> Result<Entry> {
    let config = ConfigSpec::read(&folder.join("config.ron"))?;
    let last = last_record(&folder.join("metrics.jsonl"))?;
    let count = |key: &str| last[key].as_u64().unwrap_or(0);
    let episodes = count("episode");
    // A training that went on after its evaluation is open again.
    let closed_at =
        json(&folder.join("certificate.json"))?.map(|certificate| certificate["episodes"].as_u64());
    let is_closed = closed_at == Some(Some(episodes));
    let evaluation = json(&folder.join("eval.json"))?.filter(|_| is_closed).map(|summary| Evaluated {
        episodes: summary["episodes"].as_u64().unwrap_or(0),
        success_rate: summary["success_rate"].as_f64().unwrap_or(0.0),
    });
    let goal = config.curriculum.of(blank.stage);
    let confirmed = last["confirmed"].as_f64().is_some_and(|rate| rate >= goal.confirmed_at);
    let state = match (is_closed, confirmed) {
        (true, true) => State::Mastered,
        (true, false) => State::Ended,
        (false, _) => State::Open,
    };
    Ok(Entry {
        state,
        seed: Some(config.seed),
        episodes,
        steps: count("step"),
        success_rate: last["success_rate"].as_f64().unwrap_or(0.0),
        evaluation,
        next: next(&blank.run, blank.stage, state, (episodes, count("step")), goal),
        ..blank.clone()
    })
}

/// The last whole line; a killed training leaves half a one behind it. Null before the first episode.
fn last_record(path: &Path) -> Result<Value> {
    if !path.exists() {
        return Ok(Value::Null);
    }
    let text = store::read_text(path)?;
    Ok(text.lines().rev().find_map(|line| serde_json::from_str(line).ok()).unwrap_or(Value::Null))
}

fn json(path: &Path) -> Result<Option<Value>> {
    if !path.exists() {
        return Ok(None);
    }
    serde_json::from_str(&store::read_text(path)?).map(Some).with_context(|| path.display().to_string())
}

/// The command that goes on with a stage.
fn next(run: &str, stage: Stage, state: State, (episodes, steps): (u64, u64), goal: &Goal) -> Option<String> {
    let train = |stage: Stage| format!("cargo xtask train --stage {stage} --run {run}");
    let has_checkpoint = || run_folder(run, stage).join("checkpoints").join("latest").exists();
    match state {
        State::Damaged => None,
        State::Mastered => {
            let after = Stage::ALL.into_iter().find(|later| later.before() == Some(stage))?;
            (!run_folder(run, after).exists()).then(|| train(after))
        }
        State::Ended if episodes >= goal.max_episodes || steps >= goal.max_steps => {
            Some(format!("{} --resume --episodes {}", train(stage), 2 * episodes))
        }
        State::Open if !has_checkpoint() => {
            let config = run_folder(run, stage).join("config.ron");
            let after_nothing = stage.before().is_none();
            // A later stage takes the configuration of the one before.
            let config =
                if after_nothing { format!(" --config {}", config.display()) } else { String::new() };
            Some(train(stage) + &config)
        }
        State::Ended | State::Open => Some(train(stage) + " --resume"),
    }
}

fn table(entries: &[Entry]) -> String {
    let heads = ["run", "stage", "seed", "result", "age", "go on with"].map(str::to_owned);
    let rows: Vec<[String; 6]> = entries.iter().map(row).collect();
    let all: Vec<&[String; 6]> = std::iter::once(&heads).chain(&rows).collect();
    let widths: [usize; 6] =
        std::array::from_fn(|k| all.iter().map(|row| row[k].chars().count()).max().unwrap_or(0));
    let line = |row: &[String; 6]| {
        let cells: Vec<String> =
            row.iter().zip(widths).map(|(cell, width)| format!("{cell:width$}")).collect();
        cells.join("  ").trim_end().to_owned() + "\n"
    };
    all.into_iter().map(line).collect()
}

fn row(entry: &Entry) -> [String; 6] {
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let episodes = |count: u64| format!("{count} {}", if count == 1 { "episode" } else { "episodes" });
    let so_far = format!("{}, {} steps", episodes(entry.episodes), entry.steps);
    let result = match (entry.state, &entry.evaluation, &entry.problem) {
        (State::Damaged, _, problem) => problem.clone().unwrap_or_default(),
        (State::Open, ..) => format!("open after {so_far}, {} reached", percent(entry.success_rate)),
        (state, evaluation, _) => {
            let word = if state == State::Mastered { "mastered" } else { "not mastered" };
            let evaluated = evaluation.map_or_else(String::new, |Evaluated { episodes, success_rate }| {
                format!(", then {} of {episodes} reached", percent(success_rate))
            });
            format!("{word} after {so_far}{evaluated}")
        }
    };
    [
        entry.run.clone(),
        entry.stage.to_string(),
        entry.seed.map_or_else(|| "?".to_owned(), |seed| seed.to_string()),
        result,
        age(entry.age),
        entry.next.clone().unwrap_or_else(|| "–".to_owned()),
    ]
}

/// An age \[s\] in its largest unit.
fn age(seconds: f64) -> String {
    let whole = |unit: f64| (seconds / unit).floor();
    match seconds {
        s if s < 60.0 => format!("{:.0} s", whole(1.0)),
        s if s < 3600.0 => format!("{:.0} min", whole(60.0)),
        s if s < 86_400.0 => format!("{:.0} h", whole(3600.0)),
        _ => format!("{:.0} d", whole(86_400.0)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_age_has_one_unit() {
        for (seconds, text) in [(0.4, "0 s"), (59.9, "59 s"), (61.0, "1 min"), (7300.0, "2 h"), (1e6, "11 d")]
        {
            assert_eq!(age(seconds), text);
        }
    }

    #[test]
    fn half_a_line_behind_the_last_record_is_passed_over() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("metrics.jsonl");
        assert_eq!(last_record(&path).unwrap(), Value::Null);
        std::fs::write(&path, "{\"episode\":1}\n{\"episode\":2}\n{\"epis").unwrap();
        assert_eq!(last_record(&path).unwrap()["episode"], 2);
    }
}
