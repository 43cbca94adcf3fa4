//! `play`: one episode of a trained policy, step by step.

use crate::flags::Play;
use crate::names;
use crate::runner::{Binary, Call};
use std::process::ExitCode;

impl Play {
    pub(crate) fn call(&self) -> Call {
        Call::new(Binary::Runner, "play")
            .whose(&self.whose)
            .option("stage", self.stage)
            .option("episode", self.episode.map(|episode| episode.to_string()))
            .option("seed", self.seed.map(|seed| seed.to_string()))
            .option("json", self.json.as_deref())
    }

    pub(crate) fn run(self) -> anyhow::Result<ExitCode> {
        names::check_whose(&self.whose)?;
        self.call().run()
    }
}
