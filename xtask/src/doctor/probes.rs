//! One look at the machine for each thing that a command needs.

use super::Finding;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The oldest compiler that the workspace builds with.
const RUST: &str = env!("CARGO_PKG_RUST_VERSION");

/// The machine without an operating system that `footprint` builds for.
const BARE_TARGET: &str = "thumbv7em-none-eabihf";

/// The version of cargo-deny that `deny.toml` is written for.
const CARGO_DENY: &str = "0.20.2";

/// Disk space of the target folder after `train` and `test` \[GB\].
const DISK: f64 = 6.0;

/// Memory of a training with a full replay, and of compiling burn \[GB\].
const MEMORY: f64 = 3.0;

/// Everything, what the README's two commands need first.
pub(super) fn all() -> Vec<Finding> {
    let apt =
        |package: &str, elsewhere: &str| format!("apt-get install {package} (Debian, Ubuntu); {elsewhere}");
    let finding =
        |name, found, needed_by, remedy: String| Finding { name, found, needed_by, essential: false, remedy };
    let essential = |name, found, needed_by, remedy| Finding {
        essential: true,
        ..finding(name, found, needed_by, remedy)
    };
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
    let cxx = std::env::var("CXX").unwrap_or_else(|_| "c++".to_owned());
    let rustup = "https://rustup.rs, then: rustup update stable";
    vec![
        essential("Rust", rust(), "everything", rustup.to_owned()),
        essential(
            "C compiler",
            version(&compiler, &["--version"]),
            "everything: cargo links with it; train, test",
            apt("build-essential", "xcode-select --install (macOS)"),
        ),
        essential(
            "disk space",
            disk(),
            "train, test",
            "make room, or set CARGO_TARGET_DIR to another disk".to_owned(),
        ),
        finding(
            "memory",
            memory(),
            "train",
            "fewer build jobs: CARGO_BUILD_JOBS=1; a smaller replay_capacity".to_owned(),
        ),
        finding("processor", Ok(processor()), "train, eval", String::new()),
        finding(
            "rustfmt",
            version("rustfmt", &["--version"]),
            ".ci/run",
            "rustup component add rustfmt".to_owned(),
        ),
        finding(
            "clippy",
            version("cargo-clippy", &["--version"]),
            ".ci/run",
            "rustup component add clippy".to_owned(),
        ),
        finding(BARE_TARGET, bare_target(), "footprint, .ci/run", format!("rustup target add {BARE_TARGET}")),
        finding(
            "C++ compiler",
            version(&cxx, &["--version"]),
            "the benches of crates/peers, .ci/run",
            apt("g++", "xcode-select --install (macOS)"),
        ),
        finding("browser opener", opener(), "report --open", apt("xdg-utils", "or open the file by hand")),
        finding(
            "Chromium",
            version("chromium", &["--version"]),
            ".ci/browse, .ci/run",
            apt("chromium", "https://www.chromium.org"),
        ),
        finding(
            "Python with venv",
            python(),
            ".ci/tensorboard, .ci/run",
            apt("python3-venv", "https://www.python.org"),
        ),
        finding(
            "TensorBoard",
            version("tensorboard", &["--version"]),
            "only to look at runs/ live: tensorboard --logdir runs",
            "python3 -m venv .venv && .venv/bin/pip install tensorboard".to_owned(),
        ),
        finding(
            "cargo-deny",
            cargo_deny(),
            ".ci/run",
            format!("cargo install cargo-deny --locked --version {CARGO_DENY}"),
        ),
    ]
}

/// The first line that a program prints.
fn version(program: &str, arguments: &[&str]) -> Result<String, String> {
    let printed = printed(program, arguments)?;
    let line = printed.lines().find(|line| !line.trim().is_empty()).unwrap_or("there, and says nothing");
    Ok(line.trim().chars().take(60).collect())
}

/// What a program prints, if it can be run and succeeds.
fn printed(program: &str, arguments: &[&str]) -> Result<String, String> {
    let output = Command::new(program).args(arguments).stdin(Stdio::null()).output();
    match output {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Err("not found".to_owned()),
        Err(error) => Err(error.to_string()),
        Ok(output) if !output.status.success() => Err(format!("`{program}` fails: {}", output.status)),
        Ok(output) => Ok(String::from_utf8_lossy(&output.stdout).into_owned()),
    }
}

fn rust() -> Result<String, String> {
    let line = version("rustc", &["--version"])?;
    if at_least(&line, RUST) { Ok(line) } else { Err(format!("{line}, {RUST} or newer is needed")) }
}

/// True if the first version number in `line` is `least` or newer.
fn at_least(line: &str, least: &str) -> bool {
    let numbers = |text: &str| -> Vec<u32> {
        let starts = text.find(|c: char| c.is_ascii_digit()).unwrap_or(text.len());
        let number = text[starts..].split(|c: char| !c.is_ascii_digit() && c != '.').next().unwrap_or("");
        number.split('.').map_while(|part| part.parse().ok()).collect()
    };
    let found = numbers(line);
    !found.is_empty() && found >= numbers(least)
}

fn bare_target() -> Result<String, String> {
    let folder = printed("rustc", &["--print", "target-libdir", "--target", BARE_TARGET])?;
    if Path::new(folder.trim()).is_dir() { Ok("there".to_owned()) } else { Err("not installed".to_owned()) }
}

fn cargo_deny() -> Result<String, String> {
    let line = version("cargo-deny", &["--version"])?;
    if line.ends_with(CARGO_DENY) { Ok(line) } else { Err(format!("{line}, wanted is {CARGO_DENY}")) }
}

fn python() -> Result<String, String> {
    printed("python3", &["-c", "import ensurepip, venv"])?;
    version("python3", &["--version"])
}

fn opener() -> Result<String, String> {
    let program = if cfg!(target_os = "macos") { "open" } else { "xdg-open" };
    in_path(program).map(|path| path.display().to_string()).ok_or_else(|| format!("{program} not found"))
}

/// Where a program is.
fn in_path(program: &str) -> Option<PathBuf> {
    let folders = std::env::var_os("PATH")?;
    std::env::split_paths(&folders).map(|folder| folder.join(program)).find(|path| path.is_file())
}

fn disk() -> Result<String, String> {
    let folder = std::env::var("CARGO_TARGET_DIR").unwrap_or_else(|_| ".".to_owned());
    let folder = if Path::new(&folder).exists() { folder } else { ".".to_owned() };
    match printed("df", &["-Pk", &folder]).ok().and_then(|table| available(&table)) {
        // Nothing is known where there is no `df`, and that is no reason to stop.
        None => Ok("unknown".to_owned()),
        Some(free) if free < DISK => Err(format!("{free:.1} GB free, {DISK:.0} GB are needed")),
        Some(free) => Ok(format!("{free:.0} GB free")),
    }
}

/// Space in what `df -Pk` prints \[GB\].
fn available(table: &str) -> Option<f64> {
    let kilobytes: f64 = table.lines().nth(1)?.split_whitespace().nth(3)?.parse().ok()?;
    Some(kilobytes * 1024.0 / 1e9)
}

fn memory() -> Result<String, String> {
    match std::fs::read_to_string("/proc/meminfo").ok().and_then(|text| total_memory(&text)) {
        None => Ok("unknown".to_owned()),
        Some(total) if total < MEMORY => Err(format!("{total:.1} GB, {MEMORY:.0} GB are comfortable")),
        Some(total) => Ok(format!("{total:.0} GB")),
    }
}

/// Memory in what Linux says of it \[GB\].
fn total_memory(meminfo: &str) -> Option<f64> {
    let line = meminfo.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
    let kilobytes: f64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kilobytes * 1024.0 / 1e9)
}

/// Cores and the vector units that the learner can use; burn chooses at run time.
fn processor() -> String {
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let word = if cores == 1 { "core" } else { "cores" };
    format!("{cores} {word}, {}", vectors())
}

#[cfg(target_arch = "x86_64")]
fn vectors() -> String {
    let units = [
        ("AVX-512", std::arch::is_x86_feature_detected!("avx512f")),
        ("AVX2", std::arch::is_x86_feature_detected!("avx2")),
        ("FMA", std::arch::is_x86_feature_detected!("fma")),
    ];
    let there: Vec<&str> = units.iter().filter(|(_, there)| *there).map(|(name, _)| *name).collect();
    if there.is_empty() {
        "x86-64 without AVX2: slow".to_owned()
    } else {
        format!("x86-64 with {}", there.join(", "))
    }
}

#[cfg(not(target_arch = "x86_64"))]
fn vectors() -> String {
    std::env::consts::ARCH.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_compared_as_numbers() {
        for (line, least, enough) in [
            ("rustc 1.95.0 (f5f9a2d8b 2026-04-14)", "1.95", true),
            ("rustc 1.100.0-nightly", "1.95", true),
            ("rustc 1.94.1", "1.95", false),
            ("rustc 2.0", "1.95", true),
            ("no number", "1.95", false),
        ] {
            assert_eq!(at_least(line, least), enough, "{line}");
        }
    }

    #[test]
    fn sizes_are_read_from_what_the_system_prints() {
        let table = "Filesystem 1024-blocks Used Available Capacity Mounted on\n/dev/a 264000000 20000000 1000000 8% /\n";
        assert!((available(table).unwrap() - 1.024).abs() < 1e-12);
        assert_eq!(available("df: no such file"), None);
        assert!(
            (total_memory("MemTotal:       24000000 kB\nMemFree: 1 kB\n").unwrap() - 24.576).abs() < 1e-12
        );
        assert_eq!(total_memory(""), None);
    }

    #[test]
    fn a_program_that_is_not_there_or_fails_is_told_apart() {
        assert_eq!(printed("no-such-program-anywhere", &[]), Err("not found".to_owned()));
        assert!(printed("rustc", &["--no-such-flag"]).unwrap_err().contains("fails"));
        assert!(version("rustc", &["--version"]).unwrap().starts_with("rustc "));
    }

    #[test]
    fn the_essential_things_come_first_and_everything_has_a_remedy() {
        let all = all();
        let last = all.iter().rposition(|finding| finding.essential).unwrap();
        assert!(all[..=last].iter().all(|finding| finding.essential));
        assert!(
            all.iter().filter(|finding| finding.found.is_err()).all(|finding| !finding.remedy.is_empty())
        );
    }
}
