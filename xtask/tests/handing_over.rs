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

/// Plants a root with the folders `runs/first` and `runs/second` and a scenario, and gives what is said there.
#[expect(clippy::unwrap_used, reason = "a helper of tests: a broken fixture must fail them")]
fn refused_in_a_root_with_runs(name: &str, words: &[&str]) -> String {
    let root = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    for folder in ["runs/first", "runs/second", "assets/scenarios"] {
        std::fs::create_dir_all(root.join(folder)).unwrap();
    }
    std::fs::write(root.join("assets/scenarios/chirp.ron"), "").unwrap();
    let (_, output, _) = run(name, "echo started", words);
    let errors = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{errors}");
    assert_eq!(errors.lines().count(), 1, "{errors}");
    errors
}

#[test]
fn a_run_that_is_not_there_is_answered_with_the_nearest_before_anything_is_built() {
    for words in [
        &["eval", "--run", "frist", "--stage", "purple"][..],
        &["figures", "--run", "second", "--run", "frist"],
        &["report", "--run", "frist"],
        &["train", "--stage", "purple", "--run", "frist", "--resume"],
        &["record", "--run", "frist", "--stage", "purple", "--episode", "0", "--out", "x"],
    ] {
        let errors = refused_in_a_root_with_runs("unknown_run", words);
        assert!(errors.contains("did you mean `first`? (one of: first, second)"), "{errors}");
    }
}

#[test]
fn a_scenario_that_is_not_there_is_answered_with_the_nearest() {
    let errors = refused_in_a_root_with_runs("unknown_scenario", &["track", "--scenario", "chrip"]);
    assert!(errors.contains("did you mean `chirp`? (one of: chirp, all)"), "{errors}");
}

#[test]
fn where_there_is_no_run_the_way_to_the_first_is_said() {
    let (_, output, _) = run("no_run", "echo started", &["report", "--run", "a"]);
    let errors = String::from_utf8(output.stderr).unwrap();
    assert!(errors.contains("cargo xtask train --stage purple --run a"), "{errors}");
}

#[test]
fn a_machine_without_a_compiler_is_told_what_to_get() {
    let output = Command::new(env!("CARGO_BIN_EXE_xtask")).arg("doctor").env("PATH", "").output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(1), "{text}");
    for part in ["MISSING  Rust", "https://rustup.rs", "MISSING  C compiler", "build-essential", "2 missing"]
    {
        assert!(text.contains(part), "no '{part}' in: {text}");
    }
}
