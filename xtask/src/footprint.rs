//! `footprint`: what `jbtg` and `safezone` cost without an operating system, and that nothing there can panic.

use crate::runner::cargo;
use anyhow::{Context as _, ensure};
use object::{Object as _, ObjectSection as _, ObjectSymbol as _, SectionKind};
use std::fmt::Write as _;
use std::path::Path;
use std::process::{Command, ExitCode};

/// The program that is measured, and the machine that it is built for: a Cortex-M4F.
const PROGRAM: &str = "jbtg-bare";
const TARGET: &str = "thumbv7em-none-eabihf";

/// Parts of symbols that only code that can panic refers to, in either mangling.
const PANIC: &[&str] =
    &["panicking", "rust_begin_unwind", "slice_index_fail", "unwrap_failed", "expect_failed"];

/// Builds the program and prints the size of its sections.
///
/// # Errors
/// It does not build, is no ELF file, or some of the panic machinery is linked in.
pub(crate) fn run() -> anyhow::Result<ExitCode> {
    let arguments = ["build", "--quiet", "--profile", "bare", "--package", PROGRAM, "--target", TARGET];
    let status = Command::new(cargo()).args(arguments).status().context("failed to start cargo")?;
    ensure!(
        status.success(),
        "footprint: {PROGRAM} does not build; is {TARGET} there? `rustup target add {TARGET}`"
    );
    let target = std::env::var_os("CARGO_TARGET_DIR").unwrap_or_else(|| "target".into());
    let path = Path::new(&target).join(TARGET).join("bare").join(PROGRAM);
    let bytes = std::fs::read(&path).with_context(|| path.display().to_string())?;
    let footprint = Footprint::read(&bytes).with_context(|| path.display().to_string())?;
    footprint.check()?;
    crate::print(&footprint.text())
}

/// What a program consists of.
#[derive(Debug, Default, PartialEq)]
struct Footprint {
    /// Sections that take memory, with their sizes in bytes.
    sections: Vec<(String, u64)>,
    /// Symbols of the panic machinery.
    panics: Vec<String>,
}

impl Footprint {
    /// From the bytes of an ELF file.
    fn read(bytes: &[u8]) -> anyhow::Result<Self> {
        let file = object::File::parse(bytes)?;
        let mut footprint = Self::default();
        for section in file.sections() {
            let takes_memory = matches!(
                section.kind(),
                SectionKind::Text
                    | SectionKind::ReadOnlyData
                    | SectionKind::Data
                    | SectionKind::UninitializedData
            );
            if takes_memory && section.size() > 0 {
                footprint.sections.push((section.name()?.to_owned(), section.size()));
            }
        }
        let mut names = Vec::new();
        for symbol in file.symbols() {
            names.push(symbol.name()?.to_owned());
        }
        ensure!(!names.is_empty(), "the program has no symbols, so that nothing can be said about panics");
        footprint.panics = names.into_iter().filter(|name| is_panic(name)).collect();
        Ok(footprint)
    }

    fn check(&self) -> anyhow::Result<()> {
        ensure!(
            self.panics.is_empty(),
            "footprint: a panic can be reached; linked in: {}",
            self.panics.join(", ")
        );
        Ok(())
    }

    fn text(&self) -> String {
        let mut text = format!("{PROGRAM} for {TARGET}: no panic can be reached\n");
        for (name, size) in &self.sections {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{name:<16} {size:>8} bytes");
        }
        let total: u64 = self.sections.iter().map(|(_, size)| size).sum();
        let _ = writeln!(text, "{:<16} {total:>8} bytes", "all");
        text
    }
}

fn is_panic(symbol: &str) -> bool {
    PANIC.iter().any(|part| symbol.contains(part))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panic_symbols_are_told_in_both_manglings() {
        for symbol in [
            "_ZN4core9panicking18panic_bounds_check17h0123456789abcdefE",
            "_RNvNtCs5l0EXMQXRMU_4core9panicking9panic_fmt",
            "_RNvCsdBezzDwma51_7___rustc17rust_begin_unwind",
            "_RNvNtNtCs0_4core5slice5index16slice_index_fail",
        ] {
            assert!(is_panic(symbol), "{symbol}");
        }
        for symbol in ["_start", "_RNvMs_NtCs_4jbtg7plannerNtB4_7Planner4ramp", "__aeabi_dadd"] {
            assert!(!is_panic(symbol), "{symbol}");
        }
    }

    #[test]
    fn a_program_that_can_panic_is_refused_with_the_symbol() {
        let clean =
            Footprint { sections: vec![(".text".into(), 1000), (".rodata".into(), 24)], panics: vec![] };
        clean.check().unwrap();
        assert!(clean.text().ends_with("all                  1024 bytes\n"), "{}", clean.text());
        let panics = Footprint { panics: vec!["core::panicking::panic_fmt".into()], ..clean };
        assert!(panics.check().unwrap_err().to_string().contains("panicking::panic_fmt"));
    }

    #[test]
    fn what_is_no_program_is_refused() {
        assert!(Footprint::read(b"no ELF file at all").is_err());
        // This test itself is a program that can panic.
        let own = std::fs::read(std::env::current_exe().unwrap()).unwrap();
        assert!(Footprint::read(&own).unwrap().check().is_err());
    }
}
