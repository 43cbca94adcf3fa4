//! `doctor`: what this machine lacks, what for, and how to get it.

mod probes;

use std::fmt::Write as _;
use std::process::ExitCode;

/// Something that commands need.
#[derive(Debug)]
struct Finding {
    /// What it is called.
    name: &'static str,
    /// What there is of it, or what is wrong.
    found: Result<String, String>,
    /// Which commands need it.
    needed_by: &'static str,
    /// True if the README's two commands do.
    essential: bool,
    /// How to get it.
    remedy: String,
}

/// Looks at everything and prints it.
///
/// # Errors
/// Standard output cannot be written. What is missing is no error here but the exit code, and only if the README's
/// two commands need it.
pub(crate) fn run() -> anyhow::Result<ExitCode> {
    let findings = probes::all();
    crate::print(&text(&findings))?;
    Ok(ExitCode::from(u8::from(findings.iter().any(|finding| finding.essential && finding.found.is_err()))))
}

fn text(findings: &[Finding]) -> String {
    let name_width = findings.iter().map(|finding| finding.name.len()).max().unwrap_or(0);
    let detail = |finding: &Finding| finding.found.clone().unwrap_or_else(|wrong| wrong);
    let detail_width = findings.iter().map(|finding| detail(finding).chars().count()).max().unwrap_or(0);
    let mut text = String::new();
    for finding in findings {
        let Finding { name, found, needed_by, essential, remedy } = finding;
        let word = match (found, essential) {
            (Ok(_), _) => "ok",
            (Err(_), true) => "MISSING",
            (Err(_), false) => "missing",
        };
        let detail = detail(finding);
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{word:7}  {name:name_width$}  {detail:detail_width$}  {needed_by}");
        if found.is_err() {
            let _ = writeln!(text, "{:7}  {:name_width$}  get it: {remedy}", "", "");
        }
    }
    let lacks = |essential: bool| {
        findings
            .iter()
            .filter(move |finding| finding.essential == essential && finding.found.is_err())
            .count()
    };
    text += &match (lacks(true), lacks(false)) {
        (0, 0) => "\nNothing is missing.\n".to_owned(),
        (0, _) => "\nThe README's two commands, `cargo xtask train --stage purple` and `cargo test`, have what they need.\n"
            .to_owned(),
        (count, _) => format!("\n{count} missing, without which the README's two commands do not run.\n"),
    };
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn finding(essential: bool, found: Result<&str, &str>) -> Finding {
        Finding {
            name: "thing",
            found: found.map(str::to_owned).map_err(str::to_owned),
            needed_by: "all",
            essential,
            remedy: "ask for it".to_owned(),
        }
    }

    #[test]
    fn what_is_missing_comes_with_its_remedy_and_what_is_there_without() {
        let text = text(&[finding(true, Ok("1.0")), finding(false, Err("not found"))]);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "ok       thing  1.0        all");
        assert_eq!(lines[1], "missing  thing  not found  all");
        assert_eq!(lines[2].trim(), "get it: ask for it");
        assert!(lines.last().unwrap().contains("have what they need"), "{text}");
    }

    #[test]
    fn only_what_is_essential_keeps_the_two_commands_from_running() {
        assert!(text(&[finding(true, Err("not found"))]).contains("1 missing, without which"));
        assert!(text(&[finding(true, Ok("1.0"))]).contains("Nothing is missing"));
    }
}
