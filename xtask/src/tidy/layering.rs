//! Compares direct dependencies with the allow-list.

use super::Problem;
use super::allowed::Allowed;
use super::metadata::{Dependency, Kind, Package};
use crate::suggest::nearest;

/// Where the allow-list is, for messages.
const LIST: &str = "xtask/src/tidy/allowed.rs";

/// Everything in which the packages and the allow-list differ, in either direction.
pub(super) fn check(packages: &[Package], allowed: &[Allowed]) -> Vec<Problem> {
    let mut problems = Vec::new();
    for package in packages {
        match allowed.iter().find(|entry| entry.name == package.name) {
            Some(entry) => compare(package, entry, &mut problems),
            None => problems.push(unlisted(package, allowed)),
        }
    }
    for entry in allowed {
        if !packages.iter().any(|package| package.name == entry.name) {
            let names: Vec<&str> = packages.iter().map(|package| package.name.as_str()).collect();
            let message = format!("no crate of the workspace is called that; correct {LIST}");
            problems.push(Problem::new(entry.name, message + &meant(entry.name, &names)));
        }
    }
    problems
}

fn compare(package: &Package, entry: &Allowed, problems: &mut Vec<Problem>) {
    for dependency in &package.dependencies {
        let Dependency { name, kind, optional } = dependency;
        let may = listed(entry, *kind).any(|listed| listed == name);
        if !may {
            let message =
                format!("{kind} dependency `{name}` breaks the layering; remove it, or allow it in {LIST}");
            problems.push(Problem::new(&package.name, message));
        } else if *kind == Kind::Normal && entry.optional.contains(&name.as_str()) && !optional {
            let message =
                format!("{kind} dependency `{name}` must be `optional = true`, switched on by a feature");
            problems.push(Problem::new(&package.name, message));
        }
    }
    for kind in [Kind::Normal, Kind::Build, Kind::Dev] {
        for name in listed(entry, kind) {
            let used = |dependency: &Dependency| dependency.kind == kind && dependency.name == *name;
            if !package.dependencies.iter().any(used) {
                let message =
                    format!("{kind} dependency `{name}` is allowed but not there; remove it from {LIST}");
                problems.push(Problem::new(&package.name, message));
            }
        }
    }
}

fn unlisted(package: &Package, allowed: &[Allowed]) -> Problem {
    let names: Vec<&str> = allowed.iter().map(|entry| entry.name).collect();
    let message = format!("crate is not on the allow-list; say in {LIST} what it may depend on");
    Problem::new(&package.name, message + &meant(&package.name, &names))
}

fn listed(entry: &Allowed, kind: Kind) -> impl Iterator<Item = &'static str> {
    let (always, by_feature) = match kind {
        Kind::Normal => (entry.normal, entry.optional),
        Kind::Build => (entry.build, Default::default()),
        Kind::Dev => (entry.dev, Default::default()),
    };
    always.iter().chain(by_feature).copied()
}

fn meant(name: &str, names: &[&str]) -> String {
    nearest(name, names).map(|near| format!(" (did you mean `{near}`?)")).unwrap_or_default()
}

#[cfg(test)]
mod tests;
