//! What every crate may depend on directly: the layers of `docs/ARCHITECTURE.md`, as a table.
//!
//! A line here says that a crate may; the line above the dependency in its manifest says why it does.

/// What one crate may name in its manifest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Allowed {
    pub(super) name: &'static str,
    /// Normal dependencies.
    pub(super) normal: &'static [&'static str],
    /// Normal dependencies that a feature must switch on.
    pub(super) optional: &'static [&'static str],
    /// Dependencies of the build script.
    pub(super) build: &'static [&'static str],
    /// Dependencies of tests, examples and benches.
    pub(super) dev: &'static [&'static str],
}

/// A crate that may depend on nothing.
const NOTHING: Allowed = Allowed { name: "", normal: &[], optional: &[], build: &[], dev: &[] };

/// The allow-list, from the bottom layer up. A crate that is not in it fails, and so does a line that no crate
/// uses.
pub(super) const ALLOWED: &[Allowed] = &[
    Allowed {
        name: "jbtg",
        optional: &["libm", "proptest", "serde"],
        dev: &["allocation-counter", "criterion", "jbtg", "nalgebra", "num-rational", "proptest", "ron"],
        ..NOTHING
    },
    Allowed {
        name: "safezone",
        normal: &["jbtg", "thiserror"],
        optional: &["libm", "ron", "serde"],
        dev: &["allocation-counter", "criterion", "jbtg", "proptest", "safezone"],
        ..NOTHING
    },
    Allowed {
        name: "adaptive-ctrl",
        normal: &["libm", "thiserror"],
        optional: &["serde"],
        dev: &["proptest", "ron"],
        ..NOTHING
    },
    Allowed {
        name: "hiab-dynamics",
        normal: &["libm", "nalgebra", "ron", "serde", "thiserror", "urdf-rs", "xml-rs"],
        dev: &["adaptive-ctrl", "allocation-counter", "criterion", "proptest", "serde_json"],
        ..NOTHING
    },
    Allowed {
        name: "sac-burn",
        normal: &[
            "burn",
            "crc32fast",
            "libm",
            "pulp",
            "rand_core",
            "rand_xoshiro",
            "serde",
            "serde_json",
            "thiserror",
            "tracing",
        ],
        dev: &["burn", "criterion", "mimalloc", "ron"],
        ..NOTHING
    },
    Allowed { name: "figures", normal: &["thiserror", "tiny-skia"], dev: &["xml-rs"], ..NOTHING },
    Allowed {
        name: "runner",
        normal: &[
            "adaptive-ctrl",
            "hiab-dynamics",
            "jbtg",
            "safezone",
            "anyhow",
            "libm",
            "rand_xoshiro",
            "ron",
            "serde",
            "serde_json",
            "thiserror",
            "tracing",
            "tracing-subscriber",
        ],
        optional: &["figures", "sac-burn", "crc32c", "indicatif", "mimalloc", "signal-hook", "urdf-rs"],
        dev: &["tempfile"],
        ..NOTHING
    },
    Allowed { name: "jbtg-c", normal: &["jbtg", "safezone"], dev: &["cbindgen"], ..NOTHING },
    Allowed { name: "jbtg-bare", normal: &["jbtg", "safezone"], ..NOTHING },
    Allowed {
        name: "peers",
        normal: &["jbtg", "safezone", "rsruckig", "ruckig"],
        dev: &["criterion"],
        ..NOTHING
    },
    Allowed { name: "xtask", normal: &["anyhow", "object", "serde_json"], ..NOTHING },
];

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    impl Allowed {
        fn everything(&self) -> impl Iterator<Item = &'static str> {
            [self.normal, self.optional, self.build, self.dev].into_iter().flatten().copied()
        }

        /// Other crates of this workspace; a crate may name itself, for features that its tests need.
        fn ours(&self, names: impl Iterator<Item = &'static str>) -> BTreeSet<&'static str> {
            let is_ours = |name: &&str| ALLOWED.iter().any(|other| other.name == *name);
            names.filter(is_ours).filter(|name| *name != self.name).collect()
        }

        /// What ends up in whoever uses the crate.
        fn layers_below(&self) -> BTreeSet<&'static str> {
            self.ours([self.normal, self.optional, self.build].into_iter().flatten().copied())
        }

        /// What its tests, examples and benches use beyond that.
        fn beside_in_tests(&self) -> BTreeSet<&'static str> {
            self.ours(self.dev.iter().copied()).difference(&self.layers_below()).copied().collect()
        }
    }

    #[test]
    fn the_layers_are_those_of_the_design() {
        for (name, below) in [
            ("jbtg", vec![]),
            ("safezone", vec!["jbtg"]),
            ("adaptive-ctrl", vec![]),
            ("hiab-dynamics", vec![]),
            ("sac-burn", vec![]),
            ("figures", vec![]),
            ("runner", vec!["adaptive-ctrl", "figures", "hiab-dynamics", "jbtg", "safezone", "sac-burn"]),
            ("jbtg-c", vec!["jbtg", "safezone"]),
            ("jbtg-bare", vec!["jbtg", "safezone"]),
            ("peers", vec!["jbtg", "safezone"]),
            ("xtask", vec![]),
        ] {
            let allowed = ALLOWED.iter().find(|allowed| allowed.name == name).unwrap();
            assert_eq!(allowed.layers_below(), BTreeSet::from_iter(below), "{name}");
        }
    }

    #[test]
    fn only_the_dynamics_look_beside_their_layer_and_only_in_tests() {
        for allowed in ALLOWED {
            // A tick of the whole loop is timed there, and watched for allocations.
            let expected = if allowed.name == "hiab-dynamics" { vec!["adaptive-ctrl"] } else { vec![] };
            assert_eq!(allowed.beside_in_tests(), BTreeSet::from_iter(expected), "{}", allowed.name);
        }
    }

    #[test]
    fn burn_ends_in_one_crate() {
        for allowed in ALLOWED.iter().filter(|allowed| allowed.name != "sac-burn") {
            assert!(!allowed.everything().any(|name| name.starts_with("burn")), "{}", allowed.name);
        }
    }

    #[test]
    fn the_trajectory_crate_requires_nothing() {
        assert!(ALLOWED[0].name == "jbtg" && ALLOWED[0].normal.is_empty() && ALLOWED[0].build.is_empty());
    }
}
