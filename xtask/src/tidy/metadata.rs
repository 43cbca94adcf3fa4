//! The part of `cargo metadata` that `tidy` looks at.

use anyhow::{Context as _, bail};
use serde_json::Value;
use std::fmt;
use std::path::{Path, PathBuf};

/// The workspace as cargo sees it.
#[derive(Debug)]
pub(super) struct Workspace {
    pub(super) root: PathBuf,
    pub(super) packages: Vec<Package>,
}

/// One crate of the workspace.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Package {
    pub(super) name: String,
    pub(super) manifest: PathBuf,
    pub(super) dependencies: Vec<Dependency>,
    /// Root files of what others build: libraries, programs, examples, build scripts. Not tests and benches.
    pub(super) roots: Vec<PathBuf>,
}

/// A dependency that a manifest names, under its real name even if it is renamed there.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Dependency {
    pub(super) name: String,
    pub(super) kind: Kind,
    pub(super) optional: bool,
}

/// The table of the manifest that a dependency stands in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Normal,
    Build,
    Dev,
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Normal => "normal",
            Self::Build => "build",
            Self::Dev => "dev",
        })
    }
}

impl Workspace {
    /// From the JSON of `cargo metadata --no-deps --format-version 1`.
    ///
    /// # Errors
    /// The text is no JSON, or a field that is needed is not there.
    pub(super) fn read(json: &str) -> anyhow::Result<Self> {
        let value: Value = serde_json::from_str(json).context("cargo metadata: output is not JSON")?;
        let root = Path::new(text(&value, "workspace_root")?).to_owned();
        let packages = list(&value, "packages")?.iter().map(Package::read).collect::<Result<_, _>>()?;
        Ok(Self { root, packages })
    }
}

impl Package {
    fn read(value: &Value) -> anyhow::Result<Self> {
        let mut roots = Vec::new();
        for target in list(value, "targets")? {
            let kinds = list(target, "kind")?;
            if !kinds.iter().any(|kind| kind == "test" || kind == "bench") {
                roots.push(PathBuf::from(text(target, "src_path")?));
            }
        }
        Ok(Self {
            name: text(value, "name")?.to_owned(),
            manifest: PathBuf::from(text(value, "manifest_path")?),
            dependencies: list(value, "dependencies")?
                .iter()
                .map(Dependency::read)
                .collect::<Result<_, _>>()?,
            roots,
        })
    }
}

impl Dependency {
    fn read(value: &Value) -> anyhow::Result<Self> {
        let kind = match value.get("kind").and_then(Value::as_str) {
            None => Kind::Normal,
            Some("build") => Kind::Build,
            Some("dev") => Kind::Dev,
            Some(kind) => bail!("cargo metadata: unknown kind of dependency `{kind}`"),
        };
        let optional = value.get("optional").and_then(Value::as_bool).unwrap_or(false);
        Ok(Self { name: text(value, "name")?.to_owned(), kind, optional })
    }
}

fn text<'a>(value: &'a Value, field: &str) -> anyhow::Result<&'a str> {
    let text = value.get(field).and_then(Value::as_str);
    text.with_context(|| format!("cargo metadata: no text `{field}`"))
}

fn list<'a>(value: &'a Value, field: &str) -> anyhow::Result<&'a [Value]> {
    let list = value.get(field).and_then(Value::as_array);
    list.map(Vec::as_slice).with_context(|| format!("cargo metadata: no list `{field}`"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLANTED: &str = r#"{
        "workspace_root": "/w",
        "packages": [{
            "name": "jbtg",
            "manifest_path": "/w/crates/jbtg/Cargo.toml",
            "targets": [
                {"kind": ["lib"], "src_path": "/w/crates/jbtg/src/lib.rs"},
                {"kind": ["test"], "src_path": "/w/crates/jbtg/tests/paper.rs"},
                {"kind": ["custom-build"], "src_path": "/w/crates/jbtg/build.rs"}
            ],
            "dependencies": [
                {"name": "libm", "kind": null, "optional": true, "rename": "roots"},
                {"name": "cc", "kind": "build", "optional": false},
                {"name": "proptest", "kind": "dev", "optional": false}
            ]
        }]
    }"#;

    #[test]
    fn dependencies_keep_their_kind_and_their_real_name() {
        let workspace = Workspace::read(PLANTED).unwrap();
        let [package] = workspace.packages.as_slice() else { panic!("one package was planted") };
        let read: Vec<_> =
            package.dependencies.iter().map(|d| (d.name.as_str(), d.kind, d.optional)).collect();
        let planted =
            [("libm", Kind::Normal, true), ("cc", Kind::Build, false), ("proptest", Kind::Dev, false)];
        assert_eq!(read, planted);
    }

    #[test]
    fn build_scripts_are_roots_and_tests_are_not() {
        let workspace = Workspace::read(PLANTED).unwrap();
        let roots = ["/w/crates/jbtg/src/lib.rs", "/w/crates/jbtg/build.rs"].map(PathBuf::from);
        assert_eq!(workspace.packages[0].roots, roots);
    }

    #[test]
    fn what_is_no_metadata_is_refused() {
        for (json, part) in [
            ("", "not JSON"),
            ("{}", "no text `workspace_root`"),
            (r#"{"workspace_root": "/w"}"#, "no list `packages`"),
            (r#"{"workspace_root": "/w", "packages": [{}]}"#, "no list `targets`"),
            (&PLANTED.replace(r#""build""#, r#""odd""#), "unknown kind of dependency `odd`"),
        ] {
            let error = format!("{:#}", Workspace::read(json).unwrap_err());
            assert!(error.contains(part), "{error}");
        }
    }
}
