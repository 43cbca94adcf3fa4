//! Rules of the source files and manifests.

use super::metadata::{Package, Workspace};
use super::{Problem, arithmetic};
use anyhow::Context as _;
use std::path::{Path, PathBuf};

/// Longest source file; beyond it, one file holds more than one idea.
const MOST_LINES: usize = 500;

/// Crates that export a name to a linker, which is an unsafe attribute. Their roots say `deny` instead of `forbid`, and the
/// one exception `expect`s it with its reason; their manifests repeat the workspace's lints, since only `forbid` cannot
/// be relaxed.
const EXPORTING: &[&str] = &["jbtg-c", "jbtg-bare"];

/// Checks every manifest and source file of the workspace; adds to `problems`.
///
/// Returns the number of source files.
///
/// # Errors
/// A file or folder cannot be read.
pub(super) fn check(workspace: &Workspace, problems: &mut Vec<Problem>) -> anyhow::Result<usize> {
    let mut count = 0;
    for package in &workspace.packages {
        let manifest = read(&package.manifest)?;
        let exports = EXPORTING.contains(&package.name.as_str());
        if !exports {
            problems.extend(manifest_problem(&place(workspace, &package.manifest), &manifest));
        }
        let lint = if exports { Lint::Deny } else { Lint::Forbid };
        for file in rust_files(package)? {
            let role = Role::of(&file, package);
            let (place, text) = (place(workspace, &file), read(&file)?);
            problems.extend(file_problems(&place, &text, (role, lint)));
            problems.extend(arithmetic::problems(&place, &text));
            count += 1;
        }
    }
    Ok(count)
}

/// What the root of a crate says about unsafe code.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Lint {
    Forbid,
    Deny,
}

impl Lint {
    const fn line(self) -> &'static str {
        match self {
            Self::Forbid => "#![forbid(unsafe_code)]",
            Self::Deny => "#![deny(unsafe_code)]",
        }
    }
}

/// What a source file is, as far as the rules tell files apart.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Role {
    /// Root of a library, a program, an example or a build script.
    Root,
    /// `tests.rs` under `src`: the tests of the file whose folder it stands in, and documented there.
    Tests,
    /// Everything else.
    Module,
}

impl Role {
    fn of(file: &Path, package: &Package) -> Self {
        if package.roots.iter().any(|root| root == file) {
            Self::Root
        } else if file.ends_with("tests.rs") {
            Self::Tests
        } else {
            Self::Module
        }
    }
}

/// A crate that does not take the workspace's lints has none of them, `unsafe_code` included.
fn manifest_problem(place: &str, manifest: &str) -> Option<Problem> {
    let mut lines = manifest.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
    let takes = lines.by_ref().any(|line| line == "[lints]") && lines.next() == Some("workspace = true");
    (!takes).then(|| Problem::new(place, "add `[lints]` with `workspace = true`"))
}

fn file_problems(place: &str, text: &str, (role, lint): (Role, Lint)) -> Vec<Problem> {
    let mut problems = Vec::new();
    let documented = text.starts_with("//! ") || text.starts_with("#![doc = include_str!(");
    if role != Role::Tests && !documented {
        problems.push(Problem::new(place, "begin with a `//! ` line that says what the file is for"));
    }
    if role == Role::Root && !text.lines().any(|line| line.trim_end() == lint.line()) {
        problems.push(Problem::new(place, format!("is the root of a crate; add `{}`", lint.line())));
    }
    let lines = text.lines().count();
    if lines > MOST_LINES {
        problems.push(Problem::new(place, format!("{lines} lines; split it, {MOST_LINES} is the most")));
    }
    for (index, line) in text.lines().enumerate() {
        if line.trim_start().starts_with("#[ignore") {
            let message = "no test is ignored; let an environment variable choose how much it does";
            problems.push(Problem::new(format!("{place}:{}", index + 1), message));
        }
    }
    problems
}

/// Every `.rs` file in the package's folder, in a fixed order.
fn rust_files(package: &Package) -> anyhow::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    let mut folders: Vec<PathBuf> = package.manifest.parent().map(Path::to_owned).into_iter().collect();
    while let Some(folder) = folders.pop() {
        let entries = std::fs::read_dir(&folder).with_context(|| folder.display().to_string())?;
        for entry in entries {
            let entry = entry.with_context(|| folder.display().to_string())?;
            let kind = entry.file_type().with_context(|| entry.path().display().to_string())?;
            let name = entry.file_name();
            if kind.is_dir() && name != "target" {
                folders.push(entry.path());
            } else if kind.is_file() && Path::new(&name).extension().is_some_and(|end| end == "rs") {
                files.push(entry.path());
            }
        }
    }
    files.sort();
    Ok(files)
}

fn read(file: &Path) -> anyhow::Result<String> {
    std::fs::read_to_string(file).with_context(|| file.display().to_string())
}

fn place(workspace: &Workspace, file: &Path) -> String {
    file.strip_prefix(&workspace.root).unwrap_or(file).display().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROOT: &str = "//! What it is for.\n#![forbid(unsafe_code)]\n";

    /// The lines of what is found in one file.
    fn found(text: &str, role: Role) -> Vec<String> {
        file_problems("a.rs", text, (role, Lint::Forbid)).iter().map(Problem::to_string).collect()
    }

    #[track_caller]
    fn check_one(text: &str, role: Role, part: &str) {
        let lines = found(text, role);
        assert!(lines.len() == 1 && lines[0].contains(part), "expected `{part}` alone, found {lines:#?}");
    }

    #[test]
    fn clean_files_pass() {
        for (text, role) in [
            (ROOT, Role::Root),
            ("#![doc = include_str!(\"../README.md\")]\n#![forbid(unsafe_code)]\n", Role::Root),
            ("//! What it is for.\n", Role::Module),
            ("use super::*;\n", Role::Tests),
        ] {
            assert_eq!(found(text, role), [""; 0], "{text}");
        }
    }

    #[test]
    fn a_file_that_does_not_say_what_it_is_for_is_found() {
        check_one("use std::fmt;\n", Role::Module, "a.rs: begin with");
        check_one("//!\n", Role::Module, "begin with");
        check_one("", Role::Module, "begin with");
    }

    #[test]
    fn a_root_that_does_not_forbid_unsafe_code_is_found() {
        for text in [
            "//! A crate.\n",
            "//! A crate.\n// #![forbid(unsafe_code)]\n",
            "//! A.\n#![deny(unsafe_code)]\n",
        ] {
            check_one(text, Role::Root, "add `#![forbid(unsafe_code)]`");
        }
    }

    #[test]
    fn a_root_that_exports_names_denies_unsafe_code_at_least() {
        let problems = |text| file_problems("a.rs", text, (Role::Root, Lint::Deny)).len();
        assert_eq!(problems("//! A.\n#![deny(unsafe_code)]\n"), 0);
        assert_eq!(problems("//! A.\n#![warn(unsafe_code)]\n"), 1);
    }

    #[test]
    fn a_file_is_too_long_from_the_next_line_on() {
        let long = |lines: usize| String::from("//! Long.\n") + &"// x\n".repeat(lines - 1);
        assert_eq!(found(&long(MOST_LINES), Role::Module), [""; 0]);
        check_one(&long(MOST_LINES + 1), Role::Module, "501 lines");
    }

    #[test]
    fn an_ignored_test_is_found_with_its_line() {
        check_one(
            "#[test]\n    #[ignore = \"slow\"]\nfn f() {}\n",
            Role::Tests,
            "a.rs:2: no test is ignored",
        );
    }

    #[test]
    fn a_manifest_without_the_workspace_s_lints_is_found() {
        assert_eq!(manifest_problem("m", "[package]\n[lints]\n# why\nworkspace = true\n"), None);
        for manifest in [
            "",
            "[lints]\n",
            "[lints]\nworkspace = false\n",
            "[package]\nworkspace = true\n",
            "# [lints]\nworkspace = true\n",
        ] {
            assert!(manifest_problem("m", manifest).is_some(), "{manifest}");
        }
    }

    #[test]
    fn files_are_told_apart_by_their_part_in_the_crate() {
        let package = Package {
            name: "x".to_owned(),
            manifest: PathBuf::from("/w/x/Cargo.toml"),
            dependencies: Vec::new(),
            roots: vec![PathBuf::from("/w/x/src/lib.rs"), PathBuf::from("/w/x/src/bin/tests.rs")],
        };
        for (file, role) in [
            ("/w/x/src/lib.rs", Role::Root),
            ("/w/x/src/bin/tests.rs", Role::Root),
            ("/w/x/src/flags/tests.rs", Role::Tests),
            ("/w/x/src/lib/lib.rs", Role::Module),
            ("/w/x/src/mytests.rs", Role::Module),
        ] {
            assert_eq!(Role::of(Path::new(file), &package), role, "{file}");
        }
    }
}
