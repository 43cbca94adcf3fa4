//! `dynamics`: the dynamics of given states.

use crate::flags::Dynamics;
use crate::runner::{Binary, Call};
use std::process::ExitCode;

impl Dynamics {
    pub(crate) fn call(&self) -> Call {
        Call::new(Binary::Kinematics, "dynamics")
            .value("states", self.states.as_os_str())
            .option("config", self.config.as_deref())
    }

    pub(crate) fn run(self) -> anyhow::Result<ExitCode> {
        self.call().run()
    }
}
