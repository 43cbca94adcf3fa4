//! `tables`: build or check the braking tables.

use crate::flags::Tables;
use crate::runner::{Binary, Call};
use std::process::ExitCode;

impl Tables {
    pub(crate) fn call(&self) -> Call {
        Call::new(Binary::Kinematics, "tables")
            .switch("check", self.check)
            .option("config", self.config.as_deref())
    }

    pub(crate) fn run(self) -> anyhow::Result<ExitCode> {
        self.call().run()
    }
}
