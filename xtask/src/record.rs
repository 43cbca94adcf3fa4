//! `record`: actions of a trained policy as a file.

use crate::flags::Record;
use crate::names;
use crate::runner::{Binary, Call};
use std::process::ExitCode;

impl Record {
    pub(crate) fn call(&self) -> Call {
        Call::new(Binary::Runner, "record")
            .whose(&self.whose)
            .option("stage", self.stage)
            .value("episode", self.episode.to_string())
            .value("out", self.out.as_os_str())
            .option("region", self.region)
            .option("seed", self.seed.map(|seed| seed.to_string()))
    }

    pub(crate) fn run(self) -> anyhow::Result<ExitCode> {
        names::check_whose(&self.whose)?;
        self.call().run()
    }
}
