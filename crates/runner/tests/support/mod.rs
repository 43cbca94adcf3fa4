//! A project folder of its own for each test, with the real assets, and the programs to run in it.
#![expect(clippy::unwrap_used, reason = "helpers of tests are tests too")]
#![allow(dead_code, unreachable_pub, reason = "every test file takes what it needs")]

#[cfg(feature = "training")]
pub mod learning;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

/// A folder that holds a copy of the project's assets.
pub struct Project {
    folder: TempDir,
}

impl Project {
    pub fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        copy(&workspace_root().join("assets"), &folder.path().join("assets"));
        Self { folder }
    }

    pub fn path(&self, relative: &str) -> PathBuf {
        self.folder.path().join(relative)
    }

    pub fn text(&self, relative: &str) -> String {
        fs::read_to_string(self.path(relative)).unwrap()
    }

    pub fn bytes(&self, relative: &str) -> Vec<u8> {
        fs::read(self.path(relative)).unwrap()
    }

    pub fn write(&self, relative: &str, contents: impl AsRef<[u8]>) {
        fs::write(self.path(relative), contents).unwrap();
    }

    /// Replaces a text that must occur in a file.
    #[track_caller]
    pub fn edit(&self, relative: &str, old: &str, new: &str) {
        let text = self.text(relative);
        assert!(text.contains(old), "{relative} has no '{old}'");
        self.write(relative, text.replacen(old, new, 1));
    }

    /// Runs `kinematics` here.
    pub fn kinematics(&self, arguments: &str) -> Output {
        self.run(Command::new(env!("CARGO_BIN_EXE_kinematics")), arguments)
    }

    pub fn run(&self, mut program: Command, arguments: &str) -> Output {
        program.args(arguments.split_whitespace()).current_dir(self.folder.path()).output().unwrap()
    }
}

/// The program must succeed; gives what it printed.
#[track_caller]
pub fn check_success(output: &Output) -> String {
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{}: {errors}", output.status);
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// The program must fail with one line that holds all of `parts`, and print nothing.
#[track_caller]
pub fn check_refusal(output: &Output, parts: &[&str]) {
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success(), "it succeeded, where {parts:?} was expected");
    assert!(output.stdout.is_empty(), "a failure prints no result");
    let lines: Vec<&str> = errors.lines().filter(|line| line.starts_with("error: ")).collect();
    assert_eq!(lines.len(), 1, "one line of error: {errors}");
    assert!(!errors.contains("panicked"), "{errors}");
    for part in parts {
        assert!(lines[0].contains(part), "no '{part}' in: {}", lines[0]);
    }
}

pub fn workspace_root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let target = to.join(entry.file_name());
        if entry.file_type().unwrap().is_dir() {
            copy(&entry.path(), &target);
        } else {
            fs::copy(entry.path(), target).unwrap();
        }
    }
}
