//! What the programs of this crate share: one command, its result on standard output, everything else on standard error.

use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;

use anyhow::Result;

/// Exit code of a program that was asked to stop: the shell's for Ctrl-C.
const INTERRUPTED: u8 = 130;

/// Not finished, because somebody asked to stop; says how to go on.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct Interrupted(pub String);

/// Runs `dispatch` with the command and the words after it, prints its result, and turns an error into one line.
pub fn run(dispatch: impl FnOnce(&str, Vec<String>) -> Result<String>) -> ExitCode {
    let is_terminal = io::stderr().is_terminal();
    tracing_subscriber::fmt()
        .with_writer(io::stderr)
        .with_ansi(is_terminal)
        .without_time()
        .with_target(false)
        .init();
    let mut words = std::env::args().skip(1);
    let command = words.next().unwrap_or_default();
    let printed = dispatch(&command, words.collect()).and_then(|result| print(&result));
    match printed {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if error.is::<Interrupted>() => {
            eprintln!("{error}");
            ExitCode::from(INTERRUPTED)
        }
        Err(error) => {
            eprintln!("error: {}", one_line(&error));
            ExitCode::FAILURE
        }
    }
}

fn print(result: &str) -> Result<()> {
    match io::stdout().lock().write_all(result.as_bytes()) {
        // A reader that has seen enough (`| head`) is no failure.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        written => Ok(written?),
    }
}

/// The error with its causes, on one line.
#[must_use]
pub fn one_line(error: &anyhow::Error) -> String {
    format!("{error:#}").split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_with_causes_is_one_line() {
        let error = anyhow::anyhow!("expected:\n  a number").context("in crane.urdf");
        assert_eq!(one_line(&error), "in crane.urdf: expected: a number");
    }
}
