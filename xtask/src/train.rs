//! `train`: train one stage, or all of them.

use crate::flags::{Stages, Train};
use crate::names;
use crate::runner::{Binary, Call};
use std::process::ExitCode;

impl Train {
    pub(crate) fn call(&self) -> Call {
        let call = Call::new(Binary::Runner, "train");
        let call = match self.stages {
            Stages::All => call.switch("all", true),
            Stages::One(stage) => call.value("stage", stage),
        };
        call.option("run", self.run.as_deref())
            .option("seed", self.seed.map(|seed| seed.to_string()))
            .option("episodes", self.episodes.map(|episodes| episodes.to_string()))
            .option("config", self.config.as_deref())
            .switch("resume", self.resume)
            .switch("quiet", self.quiet)
            .switch("plain", self.plain)
    }

    pub(crate) fn run(self) -> anyhow::Result<ExitCode> {
        // `--all --resume` may begin a run.
        if let (true, Stages::One(_), Some(run)) = (self.resume, &self.stages, &self.run) {
            names::check_run(run)?;
        }
        self.call().run()
    }
}
