//! Runs a binary of the `runner` package through cargo.

use crate::flags::Whose;
use anyhow::Context as _;
use std::ffi::OsString;
use std::process::{Command, ExitCode};

/// Which binary, and what is built for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Binary {
    /// `kinematics`: trajectories, safe ranges, dynamics; without the learning half, so no `burn`.
    Kinematics,
    /// `kinematics` with pictures, still without `burn`.
    Pictures,
    /// `runner`: everything. Its first build takes minutes, so cargo's progress is shown.
    Runner,
}

/// A command for one of `runner`'s binaries, in canonical `--flag value` form.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Call {
    binary: Binary,
    arguments: Vec<OsString>,
}

impl Call {
    pub(crate) fn new(binary: Binary, command: &str) -> Self {
        Self { binary, arguments: vec![command.into()] }
    }

    /// Adds `--flag value`.
    pub(crate) fn value(mut self, flag: &str, value: impl Into<OsString>) -> Self {
        self.arguments.extend([format!("--{flag}").into(), value.into()]);
        self
    }

    /// Adds `--flag value` if there is one.
    pub(crate) fn option(self, flag: &str, value: Option<impl Into<OsString>>) -> Self {
        match value {
            Some(value) => self.value(flag, value),
            None => self,
        }
    }

    /// Adds whose policy is meant.
    pub(crate) fn whose(self, whose: &Whose) -> Self {
        match whose {
            Whose::Run(run) => self.value("run", run),
            Whose::Policy(policy) => self.value("policy", policy),
        }
    }

    /// Adds `--flag` if it is on.
    pub(crate) fn switch(mut self, flag: &str, on: bool) -> Self {
        if on {
            self.arguments.push(format!("--{flag}").into());
        }
        self
    }

    /// What cargo is given.
    pub(crate) fn cargo_arguments(&self) -> Vec<OsString> {
        let cargo: &[&str] = match self.binary {
            Binary::Kinematics => &[
                "run",
                "--quiet",
                "--release",
                "-p",
                "runner",
                "--no-default-features",
                "--bin",
                "kinematics",
                "--",
            ],
            Binary::Pictures => &[
                "run",
                "--quiet",
                "--release",
                "-p",
                "runner",
                "--no-default-features",
                "--features",
                "figures",
                "--bin",
                "kinematics",
                "--",
            ],
            Binary::Runner => &["run", "--release", "-p", "runner", "--bin", "runner", "--"],
        };
        cargo.iter().map(OsString::from).chain(self.arguments.iter().cloned()).collect()
    }

    /// Runs it. Standard input, output and error are the child's, and so are signals and the exit code.
    ///
    /// # Errors
    /// Cargo cannot be started.
    pub(crate) fn run(&self) -> anyhow::Result<ExitCode> {
        let cargo = cargo();
        let mut command = Command::new(&cargo);
        command.args(self.cargo_arguments());
        hand_over(command).with_context(|| format!("failed to start {}", cargo.display()))
    }
}

/// Becomes `command`, as `cargo run` in turn becomes the program it has built. So there is one process from
/// beginning to end: whoever interrupts or kills it reaches the program, and sees how the program ended.
#[cfg(unix)]
fn hand_over(mut command: Command) -> std::io::Result<ExitCode> {
    Err(std::os::unix::process::CommandExt::exec(&mut command))
}

/// Runs `command` to its end and passes its exit code on. Ctrl-C reaches every process of the console.
#[cfg(not(unix))]
fn hand_over(mut command: Command) -> std::io::Result<ExitCode> {
    let code = command.status()?.code().and_then(|code| u8::try_from(code).ok());
    Ok(ExitCode::from(code.unwrap_or(1)))
}

/// The cargo that runs this, or the one in the path.
pub(crate) fn cargo() -> OsString {
    std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}
