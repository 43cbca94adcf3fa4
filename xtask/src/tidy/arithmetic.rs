//! Numbers of a training are the same on every processor, so they come from no function that chooses by the processor.
//!
//! The platform's mathematical library has several versions of sine, logarithm and the like, with and without fused
//! multiplication, which differ in the last bits; `libm` has one. Clippy's `disallowed-methods` could say this too, but
//! not except tests, which may take the platform's.

use super::Problem;

/// Folders whose results a training depends on.
const EXACT: &[&str] = &[
    "crates/adaptive-ctrl/src/",
    "crates/hiab-dynamics/src/",
    "crates/jbtg/src/",
    "crates/runner/src/",
    "crates/safezone/src/",
];

/// Within these, what no training runs: pictures, scenarios, searches for gains, commands, and tests' own inputs.
const BESIDE: &[&str] = &[
    "crates/jbtg/src/strategies.rs",
    "crates/runner/src/kinematics/",
    "crates/runner/src/pictures",
    "crates/runner/src/track",
    "crates/runner/src/tune",
];

/// Methods of `f64` and `f32` that the platform's library computes. A square root is exact everywhere.
const PLATFORM: &[&str] = &[
    "acos", "acosh", "asin", "asinh", "atan", "atan2", "atanh", "cbrt", "cos", "cosh", "exp", "exp2",
    "exp_m1", "hypot", "ln", "ln_1p", "log", "log10", "log2", "powf", "sin", "sin_cos", "sinh", "tan",
    "tanh",
];

/// What one file calls that it should take from `libm`; tests may call what they like.
pub(super) fn problems(place: &str, text: &str) -> Vec<Problem> {
    let under = |folders: &[&str]| folders.iter().any(|folder| place.starts_with(folder));
    if !under(EXACT) || under(BESIDE) || place.ends_with("/tests.rs") || place.contains("/tests/") {
        return Vec::new();
    }
    let lines = text.lines().take_while(|line| line.trim() != "#[cfg(test)]").enumerate();
    lines
        .flat_map(|(index, line)| {
            let code = line.split("//").next().unwrap_or_default();
            let called = PLATFORM.iter().filter(move |name| code.contains(&format!(".{name}(")));
            called.map(move |name| {
                let message = format!("`{name}` differs from processor to processor; take it from `libm`");
                Problem::new(format!("{place}:{}", index + 1), message)
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(place: &str, text: &str) -> Vec<String> {
        problems(place, text).iter().map(Problem::to_string).collect()
    }

    #[test]
    fn a_function_of_the_platform_is_found_with_its_line() {
        let text = "let x = 1;\nlet y = angle.sin_cos().0 + z.ln();\n";
        assert_eq!(
            found("crates/hiab-dynamics/src/a.rs", text),
            [
                "crates/hiab-dynamics/src/a.rs:2: `ln` differs from processor to processor; take it from `libm`",
                "crates/hiab-dynamics/src/a.rs:2: `sin_cos` differs from processor to processor; take it from `libm`",
            ]
        );
    }

    #[test]
    fn what_is_exact_or_no_part_of_a_training_passes() {
        for (place, text) in [
            ("crates/runner/src/a.rs", "let x = libm::sin(y) + z.sqrt() + z.powi(2); // y.sin()\n"),
            ("crates/runner/src/a.rs", "let x = 1;\n#[cfg(test)]\nmod tests { let y = x.sin(); }\n"),
            ("crates/runner/src/a/tests.rs", "x.sin()\n"),
            ("crates/runner/tests/a.rs", "x.sin()\n"),
            ("crates/runner/src/track/reference.rs", "x.sin()\n"),
            ("crates/figures/src/a.rs", "x.sin()\n"),
        ] {
            assert_eq!(found(place, text), [""; 0], "{place}: {text}");
        }
    }
}
