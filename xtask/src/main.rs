//! The project's command line: `cargo xtask help`.
//!
//! Reads the command line, changes to the workspace root and dispatches. It links neither `runner` nor
//! `burn`: commands that compute run one of `runner`'s binaries, so this builds in seconds. Standard
//! output holds a command's result and nothing else.
#![forbid(unsafe_code)]

mod args;
mod doctor;
mod dynamics;
mod eval;
mod figures;
mod flags;
mod footprint;
mod help;
mod load_chart;
mod names;
mod play;
mod profile;
mod record;
mod runner;
mod runs;
mod search;
mod soak;
mod suggest;
mod tables;
mod tidy;
mod track;
mod train;
mod zone;

use args::UsageError;
use flags::Invocation;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Exit code for a command line that cannot be understood.
const USAGE: u8 = 2;

fn main() -> ExitCode {
    let words: Result<Vec<String>, _> = std::env::args_os().skip(1).map(|word| word.into_string()).collect();
    let words = words.map_err(|word| format!("argument {} is not UTF-8", word.display()));
    match words.and_then(|words| Invocation::parse(words).map_err(|error| error.to_string())) {
        Ok(invocation) => dispatch(invocation).unwrap_or_else(|error| {
            complain(format_args!("{error:#}"));
            if error.is::<UsageError>() { ExitCode::from(USAGE) } else { ExitCode::FAILURE }
        }),
        Err(error) => {
            complain(error);
            ExitCode::from(USAGE)
        }
    }
}

fn dispatch(invocation: Invocation) -> anyhow::Result<ExitCode> {
    // Paths in the invocation are absolute by now.
    std::env::set_current_dir(root())?;
    match invocation {
        Invocation::Help(command) => print(&help::text(command)),
        Invocation::Tables(flags) => flags.run(),
        Invocation::Train(flags) => flags.run(),
        Invocation::Eval(flags) => flags.run(),
        Invocation::Play(flags) => flags.run(),
        Invocation::Figures(flags) => flags.run(),
        Invocation::Report(flags) => flags.run(),
        Invocation::Runs(flags) => flags.run(),
        Invocation::Doctor => doctor::run(),
        Invocation::Profile(flags) => flags.run(),
        Invocation::Zone(flags) => flags.run(),
        Invocation::Soak(flags) => flags.run(),
        Invocation::Dynamics(flags) => flags.run(),
        Invocation::LoadChart(flags) => flags.run(),
        Invocation::Footprint => footprint::run(),
        Invocation::Track(flags) => flags.run(),
        Invocation::Tune(flags) => flags.run(),
        Invocation::Ablation(flags) => flags.run(),
        Invocation::Record(flags) => flags.run(),
        Invocation::Search(flags) => flags.run(),
        Invocation::Tidy => tidy::run(),
    }
}

/// The workspace's root: the parent of this package, wherever cargo says it is now.
fn root() -> PathBuf {
    let package = std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into());
    let package = PathBuf::from(package);
    package.parent().map(Path::to_owned).unwrap_or(package)
}

/// Writes a result to standard output.
fn print(text: &str) -> anyhow::Result<ExitCode> {
    match std::io::stdout().write_all(text.as_bytes()) {
        // A reader that has seen enough (`| head`) is no failure.
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(ExitCode::SUCCESS),
    }
}

/// Writes one line about what is wrong to standard error.
fn complain(message: impl std::fmt::Display) {
    // If standard error is closed there is nobody left to tell.
    let _ = writeln!(std::io::stderr(), "error: {message}");
}
