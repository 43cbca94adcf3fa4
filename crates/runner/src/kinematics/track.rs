//! Scenarios, tracked.

use std::path::PathBuf;

use anyhow::{Context, Result, ensure};

use crate::motion::Motion;
use crate::store;
use crate::track::play::play;
use crate::track::report::{Csv, Report, report, table};
use crate::track::scenario::{Scenario, names};
use crate::track::setup::{Knowledge, Law, Setup, Stage};

/// What `track` is asked for.
#[derive(Clone, Debug)]
pub struct TrackRequest {
    /// A scenario's name, or `all`.
    pub scenario: String,
    /// The law.
    pub law: Law,
    /// What its feedforward knows, if not what the law has by default.
    pub knowledge: Option<Knowledge>,
    /// Where the results go as JSON: one object, or a list of them for `all`.
    pub json: Option<PathBuf>,
    /// Where the motion of the one scenario goes as CSV.
    pub csv: Option<PathBuf>,
}

/// Tracks one scenario or all of them, and gives the table that is printed.
///
/// # Errors
/// The scenario is not known, one of its files is wrong, or a result cannot be written.
pub fn track(request: &TrackRequest) -> Result<String> {
    let all = request.scenario == "all";
    ensure!(!(all && request.csv.is_some()), "--csv takes the motion of one scenario, not of all");
    let wanted = if all { names()? } else { vec![request.scenario.clone()] };
    let mut setup = Setup::of(request.law);
    setup.knowledge = request.knowledge.unwrap_or(setup.knowledge);
    let mut reports = Vec::new();
    for name in &wanted {
        let scenario = Scenario::read(name)?;
        let in_scenario = || format!("scenario {name}");
        let stage = Stage::load(&scenario, setup).with_context(in_scenario)?;
        let gains = stage.gains(&scenario).with_context(in_scenario)?;
        let mut csv = request.csv.as_ref().map(|_| Csv::new(&stage));
        let mut see = |motion: &Motion, time: f64| {
            if let Some(csv) = &mut csv {
                csv.see(motion, time);
            }
        };
        let played = play(&scenario, &stage, &gains, &mut see).with_context(in_scenario)?;
        if let (Some(path), Some(csv)) = (&request.csv, csv) {
            store::write_whole(path, csv.finish().as_bytes())?;
        }
        let machine = &stage.machine;
        let moving = machine.moving().iter().map(|&joint| machine.joints()[joint].name.clone()).collect();
        reports.push((report(name, setup, &stage, &played), moving));
    }
    if let Some(path) = &request.json {
        let plain: Vec<&Report> = reports.iter().map(|(report, _)| report).collect();
        let text = match plain.as_slice() {
            [one] if !all => serde_json::to_string_pretty(one)?,
            many => serde_json::to_string_pretty(many)?,
        };
        store::write_whole(path, (text + "\n").as_bytes())?;
    }
    Ok(table(&reports))
}
