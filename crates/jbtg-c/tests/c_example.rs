//! The C example compiles without a warning, runs, and computes what the Rust crates compute, bit for bit.
#![expect(clippy::unwrap_used, reason = "helpers of tests: a broken fixture must fail them")]

use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use std::process::Command;

use jbtg::{Interval, Limits, LimitsSpec, Planner, PlannerSpec, Sampler, Shape, Timing};
use safezone::SafeZone;

/// Builds the static library in the profile of this test.
fn library() -> PathBuf {
    let target = std::env::current_exe().unwrap().ancestors().nth(2).unwrap().to_owned();
    let mut build = Command::new(env!("CARGO"));
    build.args(["build", "--quiet", "--package", "jbtg-c", "--lib"]);
    if target.ends_with("release") {
        build.arg("--release");
    }
    assert!(build.status().unwrap().success());
    target.join("libjbtg_c.a")
}

fn compile(source: &Path, program: &Path) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let output = Command::new(std::env::var_os("CC").unwrap_or_else(|| "cc".into()))
        .args(["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-I"])
        .args([&folder.join("include"), source, &library(), Path::new("-o"), program])
        .args(["-lm", "-lpthread", "-ldl"])
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// The numbers of the example's CSV, as the Rust crates have them.
fn expected() -> Vec<[f64; 4]> {
    let limits = Limits::try_from(LimitsSpec {
        position: Interval::new(0.14, 0.50),
        velocity: Interval::new(-0.15, 0.10),
        acceleration: Interval::new(-1.0, 0.5),
        jerk: Interval::new(-100.0, 100.0),
    })
    .unwrap();
    let (shape, timing) = (Shape::Smoothstep, Timing::Stretched);
    let planner = Planner::try_from(PlannerSpec { limits, shape, timing, period: 0.05 }).unwrap();
    let zone = SafeZone::closed_form(planner).unwrap();
    let mut sampler = Sampler::at_rest(planner, NonZeroU32::new(50).unwrap(), 0.30).unwrap();
    let mut rows = Vec::new();
    for period in 0..200 {
        let now = sampler.upcoming();
        if period < 180 {
            let range = zone.range(now.position, now.velocity);
            sampler.command(if period < 100 { range.max } else { range.min }).unwrap();
        }
        for _ in 0..50 {
            let state = sampler.advance().state;
            rows.push([state.position, state.velocity, state.acceleration, state.jerk]);
        }
    }
    rows
}

#[test]
fn the_c_example_computes_what_rust_computes() {
    let program = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("velocity_joint");
    compile(&Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/velocity_joint.c"), &program);
    let output = Command::new(&program).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').skip(1).map(|number| number.parse().unwrap()).collect())
        .collect();
    let expected = expected();
    assert_eq!(rows.len(), expected.len());
    for (row, wanted) in rows.iter().zip(&expected) {
        assert_eq!(row, wanted);
    }
    // Both limits were reached, from inside.
    let last = |row: usize| rows[row][0];
    assert!(last(4999) > 0.499 && last(9999) < 0.141, "{} {}", last(4999), last(9999));
}
