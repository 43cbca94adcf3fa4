//! The program that a command runs takes the place of `xtask`: its output, its signals, its exit code.
//!
//! A shell stands in for cargo. It is called as `sh run …`, so a planted workspace root with a script of the
//! name `run` is all it takes.
#![cfg(unix)]

use std::os::unix::process::ExitStatusExt as _;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

/// Runs `xtask` with `script` in the place of cargo; gives its process id, its output and the planted root.
#[expect(clippy::unwrap_used, reason = "a helper of tests: a broken fixture must fail them")]
fn run(name: &str, script: &str, words: &[&str]) -> (u32, Output, PathBuf) {
    let root = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&root).unwrap();
    std::fs::write(root.join("run"), script).unwrap();
    let child = Command::new(env!("CARGO_BIN_EXE_xtask"))
        .args(words)
        .env("CARGO", "sh")
        .env("CARGO_MANIFEST_DIR", root.join("xtask"))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let id = child.id();
    (id, child.wait_with_output().unwrap(), root.canonicalize().unwrap())
}

#[test]
fn the_program_runs_in_the_root_in_the_same_process() {
    let script = "echo \"$$\"; pwd -P; echo \"$*\"";
    let (id, output, root) = run("same_process", script, &["tables", "--check"]);
    let arguments = "--quiet --release -p runner --no-default-features --bin kinematics -- tables --check";
    let expected = format!("{id}\n{}\n{arguments}\n", root.display());
    assert_eq!(String::from_utf8(output.stdout).unwrap(), expected);
    assert!(output.status.success() && output.stderr.is_empty());
}

#[test]
fn the_exit_code_is_the_program_s() {
    let (_, output, _) = run("exit_code", "exit 7", &["train", "--all"]);
    assert_eq!(output.status.code(), Some(7));
}

#[test]
fn a_signal_ends_it_as_it_ends_the_program() {
    // Not SIGINT, which whoever starts the tests in the background has it ignore.
    let (_, output, _) = run("signal", "kill -TERM $$; sleep 60", &["train", "--all"]);
    assert_eq!((output.status.code(), output.status.signal()), (None, Some(15)));
}

#[test]
fn a_mistake_runs_nothing_and_ends_with_two() {
    let (_, output, _) = run("mistake", "echo started", &["train", "--stage", "purpel"]);
    assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
    let lines = String::from_utf8(output.stderr).unwrap();
    assert!(lines.starts_with("error: train: unknown") && lines.lines().count() == 1, "{lines}");
}

#[test]
fn no_command_at_all_prints_the_help() {
    let (_, output, _) = run("help", "exit 7", &[]);
    assert!(output.status.success() && output.stderr.is_empty());
    assert!(String::from_utf8(output.stdout).unwrap().contains("train"));
}
