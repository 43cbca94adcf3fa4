//! A run as one page: results, certificate, figures, configuration, and the commands that give it again.
//!
//! The page is a single HTML file without script and without anything from elsewhere.

mod page;
mod results;

use anyhow::{Result, ensure};
use figures::SvgTheme;

use self::page::{Page, escape, grouped};
use self::results::StageResult;
use crate::gallery::{self, Source};
use crate::pictures::capitalised;
use crate::stage::Stage;
use crate::trained::Place;

/// Writes the page.
///
/// # Errors
/// A run was not trained, or a file of it is missing or damaged.
pub fn html(source: &Source) -> Result<String> {
    let mut results = results::read(&source.runs)?;
    if let Some(policy) = &source.policy {
        results.push(results::of_policy(policy, &Place::Named(policy.clone()).read()?)?);
    }
    ensure!(
        !results.is_empty(),
        "no stage of {} is finished: its eval.json is missing; first run: cargo xtask train --all --run {}",
        source.runs.join(", "),
        source.runs.first().map_or("NAME", String::as_str)
    );
    let figures = gallery::draw(source)?;
    let mut page = Page::new(&title(&source.runs, &results));
    verdict(&mut page, &results);
    page.section("Results");
    results::table(&mut page, &results);
    page.section("Certificate");
    results::certificate(&mut page, &results);
    page.section("Figures");
    for (name, figure) in &figures {
        page.figure(&figure.svg(SvgTheme::Reader), caption(name));
    }
    page.section("Configuration");
    configurations(&mut page, &results);
    page.section("Reproduce");
    commands(&mut page, source, &results);
    Ok(page.finish())
}

fn title(runs: &[String], results: &[StageResult]) -> String {
    match runs {
        [] => results.first().map_or_else(String::new, |result| capitalised(&result.name)),
        [only] => format!("Run {only}"),
        several => format!("Runs {}", several.join(", ")),
    }
}

/// What a reader wants to know first.
fn verdict(page: &mut Page, results: &[StageResult]) {
    let violations: u64 = results.iter().map(StageResult::violations).sum();
    let commands = grouped(results.iter().map(StageResult::commands).sum());
    let (class, word) = if violations == 0 { ("good", "No limit was") } else { ("bad", "Limits were not") };
    let kept = if violations == 0 {
        format!("{word} exceeded in {commands} commands of the controllers, in training and evaluation.")
    } else {
        format!("{word} kept: {violations} violations in {commands} commands of the controllers.")
    };
    for stage in Stage::ALL {
        if let Some(pooled) = results::pooled(results, stage) {
            page.html(&format!("<p class=\"verdict\">Stage {stage}: {pooled}</p>\n"));
        }
    }
    page.html(&format!("<p class=\"verdict {class}\">{kept}</p>\n"));
}

/// What a figure shows, for one who has not read the paper.
fn caption(name: &str) -> &'static str {
    match name {
        "architecture" => {
            "The policy never commands the crane: it chooses within a range that keeps every limit."
        }
        "workspace" => {
            "Each stage draws starts and targets from a larger region. The bold line is the episode that the next \
             figures show: the longest way to a target that was reached."
        }
        "posture" => "Shapes from the URDF, at the poses that the simulation had; cylinders in green.",
        "safe-zone" => {
            "Inside the region the joint can stop before its limit by braking step by step. The way through it is the \
             reference's; every ring is a policy step."
        }
        "velocity-profile" => {
            "At every policy step the velocity for the step's end is chosen within the range; the curve leads there \
             within the limits of acceleration and jerk."
        }
        "motion" => {
            "Shaded is what the actuator's limits forbid. The reference leaves a margin to the actual motion."
        }
        "tracking" => "Reference and actual motion of the moving joints.",
        "tracking-error" => "The same, as differences.",
        "margins" => {
            "Boxes hold the middle half of the episodes, lines reach to the smallest and largest. Zero would be the \
             limit."
        }
        _ => {
            "Over a rolling window of episodes, under exploration; deterministic evaluation is in the table above."
        }
    }
}

fn configurations(page: &mut Page, results: &[StageResult]) {
    for StageResult { name, stage, config, .. } in results {
        let summary = format!("{}, stage {stage}", escape(name));
        let text = escape(config);
        page.html(&format!("<details><summary>{summary}</summary><pre>{text}</pre></details>\n"));
    }
}

fn commands(page: &mut Page, source: &Source, results: &[StageResult]) {
    let [trainings, evaluations] = [0, 1].map(|which| results.iter().map(move |result| &result.again[which]));
    let mut lines: Vec<String> = trainings.chain(evaluations).cloned().collect();
    let runs = source.runs.iter().map(|run| format!("--run {run}"));
    let runs: Vec<String> =
        runs.chain(source.policy.iter().map(|policy| format!("--policy {policy}"))).collect();
    lines.push(format!("cargo xtask figures {}", runs.join(" ")));
    lines.push(format!("cargo xtask report {}", runs.join(" ")));
    page.html(&format!("<pre>{}</pre>\n", escape(&lines.join("\n"))));
}
