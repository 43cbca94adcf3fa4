//! `load-chart`: the largest payload over the workspace.

use crate::flags::LoadChart;
use crate::runner::{Binary, Call};
use std::process::ExitCode;

impl LoadChart {
    pub(crate) fn call(&self) -> Call {
        // Drawing takes a build with pictures; numbers alone do not.
        let binary = if self.svg.is_some() { Binary::Pictures } else { Binary::Kinematics };
        Call::new(binary, "load-chart")
            .option("config", self.config.as_deref())
            .option("json", self.json.as_deref())
            .option("svg", self.svg.as_deref())
    }

    pub(crate) fn run(self) -> anyhow::Result<ExitCode> {
        self.call().run()
    }
}
