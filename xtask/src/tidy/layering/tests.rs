use super::*;
use std::path::PathBuf;

const ALLOWED: &[Allowed] = &[
    Allowed { name: "jbtg", normal: &[], optional: &["libm"], build: &[], dev: &["proptest"] },
    Allowed { name: "safezone", normal: &["jbtg"], optional: &[], build: &["cc"], dev: &[] },
];

fn package(name: &str, dependencies: &[(&str, Kind, bool)]) -> Package {
    let dependency = |(name, kind, optional): &(&str, Kind, bool)| Dependency {
        name: (*name).to_owned(),
        kind: *kind,
        optional: *optional,
    };
    Package {
        name: name.to_owned(),
        manifest: PathBuf::new(),
        dependencies: dependencies.iter().map(dependency).collect(),
        roots: Vec::new(),
    }
}

/// The two crates exactly as the allow-list above has them.
fn clean() -> Vec<Package> {
    vec![
        package("jbtg", &[("libm", Kind::Normal, true), ("proptest", Kind::Dev, false)]),
        package("safezone", &[("jbtg", Kind::Normal, false), ("cc", Kind::Build, false)]),
    ]
}

/// Plants one more dependency and demands one problem whose line has every part.
#[track_caller]
fn check_planted(into: usize, dependency: (&str, Kind, bool), parts: &[&str]) {
    let mut packages = clean();
    packages[into].dependencies.extend(package("", &[dependency]).dependencies);
    check_one(&packages, parts);
}

#[track_caller]
fn check_one(packages: &[Package], parts: &[&str]) {
    let lines: Vec<String> = check(packages, ALLOWED).iter().map(Problem::to_string).collect();
    let [line] = lines.as_slice() else { panic!("one problem was planted, found {lines:#?}") };
    for part in parts {
        assert!(line.contains(part), "`{part}` is not in: {line}");
    }
}

#[test]
fn what_the_list_allows_passes() {
    assert_eq!(check(&clean(), ALLOWED), []);
}

#[test]
fn an_arrow_that_points_up_is_found() {
    check_planted(0, ("safezone", Kind::Normal, false), &["jbtg: normal dependency `safezone`", LIST]);
}

#[test]
fn an_optional_arrow_that_points_up_is_found() {
    check_planted(0, ("safezone", Kind::Normal, true), &["jbtg: normal dependency `safezone`"]);
}

#[test]
fn kinds_are_told_apart() {
    // Each is allowed to the crate, but in another table of its manifest.
    check_planted(0, ("proptest", Kind::Normal, false), &["jbtg: normal dependency `proptest`"]);
    check_planted(0, ("libm", Kind::Build, false), &["jbtg: build dependency `libm`"]);
    check_planted(1, ("cc", Kind::Dev, false), &["safezone: dev dependency `cc`"]);
}

#[test]
fn a_dependency_that_must_be_optional_may_not_be_required() {
    let mut packages = clean();
    packages[0].dependencies[0].optional = false;
    check_one(&packages, &["jbtg", "`libm`", "optional = true"]);
}

#[test]
fn a_misspelt_dependency_is_found_from_both_sides() {
    let mut packages = clean();
    packages[1].dependencies[0].name = "jbgt".to_owned();
    let lines: Vec<String> = check(&packages, ALLOWED).iter().map(Problem::to_string).collect();
    assert_eq!(lines.len(), 2, "{lines:#?}");
    assert!(
        lines[0].contains("`jbgt` breaks the layering")
            && lines[1].contains("`jbtg` is allowed but not there")
    );
}

#[test]
fn a_misspelt_crate_is_found_from_both_sides() {
    let mut packages = clean();
    packages[0].name = "jbgt".to_owned();
    let lines: Vec<String> = check(&packages, ALLOWED).iter().map(Problem::to_string).collect();
    assert_eq!(lines.len(), 2, "{lines:#?}");
    assert!(lines[0].contains("jbgt: crate is not on the allow-list") && lines[0].contains("`jbtg`"));
    assert!(lines[1].contains("jbtg: no crate of the workspace") && lines[1].contains("`jbgt`"));
}

#[test]
fn a_line_that_nothing_uses_is_stale() {
    let mut packages = clean();
    packages[0].dependencies.pop();
    check_one(&packages, &["jbtg: dev dependency `proptest` is allowed but not there"]);
}
