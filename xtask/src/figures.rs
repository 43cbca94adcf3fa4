//! `figures` and `report`: a run to be looked at.

use crate::args::UsageError;
use crate::flags::{Figures, Report};
use crate::names;
use crate::runner::{Binary, Call};
use std::process::ExitCode;

impl Figures {
    fn check_names(&self) -> Result<(), UsageError> {
        self.policy.iter().try_for_each(|policy| names::check_policy(policy))?;
        self.runs.iter().try_for_each(|run| names::check_run(run))
    }

    pub(crate) fn call(&self) -> Call {
        self.call_of("figures")
    }

    fn call_of(&self, command: &str) -> Call {
        let runs = self.runs.iter().map(String::as_str);
        let call = runs
            .fold(Call::new(Binary::Runner, command), |call, run| call.value("run", run))
            .option("policy", self.policy.as_deref())
            .option("stage", self.stage)
            .option("episodes", self.episodes.map(|episodes| episodes.to_string()))
            .option("out", self.out.as_deref());
        self.only.iter().fold(call, |call, &name| call.value("figure", name))
    }

    pub(crate) fn run(self) -> anyhow::Result<ExitCode> {
        self.check_names()?;
        self.call().run()
    }
}

impl Report {
    pub(crate) fn call(&self) -> Call {
        self.figures.call_of("report").switch("open", self.open)
    }

    pub(crate) fn run(self) -> anyhow::Result<ExitCode> {
        self.figures.check_names()?;
        self.call().run()
    }
}
