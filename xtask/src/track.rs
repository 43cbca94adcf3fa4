//! `track`, `tune`, `ablation`: control laws against scenarios.

use crate::flags::{Ablation, Track, Tune};
use crate::names;
use crate::runner::{Binary, Call};
use std::process::ExitCode;

impl Track {
    pub(crate) fn call(&self) -> Call {
        Call::new(Binary::Kinematics, "track")
            .value("scenario", self.scenario.as_str())
            .option("controller", self.controller)
            .option("feedforward", self.feedforward)
            .option("json", self.json.as_deref())
            .option("csv", self.csv.as_deref())
    }

    pub(crate) fn run(self) -> anyhow::Result<ExitCode> {
        names::check_scenario(&self.scenario)?;
        self.call().run()
    }
}

impl Tune {
    pub(crate) fn call(&self) -> Call {
        Call::new(Binary::Kinematics, "tune")
            .option("controller", self.controller)
            .option("plant", self.plant)
            .option("budget", self.budget.map(|budget| budget.to_string()))
            .option("seed", self.seed.map(|seed| seed.to_string()))
    }

    pub(crate) fn run(self) -> anyhow::Result<ExitCode> {
        self.call().run()
    }
}

impl Ablation {
    pub(crate) fn call(&self) -> Call {
        Call::new(Binary::Pictures, "ablation")
            .option("json", self.json.as_deref())
            .option("out", self.out.as_deref())
    }

    pub(crate) fn run(self) -> anyhow::Result<ExitCode> {
        self.call().run()
    }
}
