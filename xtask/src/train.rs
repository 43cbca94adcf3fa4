//! `train`: train one stage, or all of them.

use crate::flags::{Stages, Train};
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
        self.call().run()
    }
}
