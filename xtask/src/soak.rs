//! `soak`: adversaries against the safe ranges.

use crate::flags::Soak;
use crate::runner::{Binary, Call};
use std::process::ExitCode;

impl Soak {
    pub(crate) fn call(&self) -> Call {
        let number = |number: Option<u64>| number.map(|number| number.to_string());
        Call::new(Binary::Kinematics, "soak")
            .value("steps", self.steps.to_string())
            .value("seed", self.seed.to_string())
            .option("json", self.json.as_deref())
            .option("threads", number(self.threads))
            .option("case", number(self.case))
    }

    pub(crate) fn run(self) -> anyhow::Result<ExitCode> {
        self.call().run()
    }
}
