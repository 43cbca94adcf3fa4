//! `eval`: evaluate a trained policy.

use crate::flags::Eval;
use crate::names;
use crate::runner::{Binary, Call};
use std::process::ExitCode;

impl Eval {
    pub(crate) fn call(&self) -> Call {
        Call::new(Binary::Runner, "eval")
            .whose(&self.whose)
            .value("stage", self.stage)
            .option("episodes", self.episodes.map(|episodes| episodes.to_string()))
            .option("seed", self.seed.map(|seed| seed.to_string()))
            .option("json", self.json.as_deref())
    }

    pub(crate) fn run(self) -> anyhow::Result<ExitCode> {
        names::check_whose(&self.whose)?;
        self.call().run()
    }
}
