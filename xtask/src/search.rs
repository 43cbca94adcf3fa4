//! `search`: train and judge the candidates for the default configuration.

use crate::flags::Search;
use crate::runner::{Binary, Call};
use std::process::ExitCode;

impl Search {
    pub(crate) fn call(&self) -> Call {
        Call::new(Binary::Runner, "search")
            .option("space", self.space.as_deref())
            .option("out", self.out.as_deref())
            .switch("quiet", self.quiet)
    }

    pub(crate) fn run(self) -> anyhow::Result<ExitCode> {
        self.call().run()
    }
}
