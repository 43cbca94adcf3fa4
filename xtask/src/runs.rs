//! `runs`: what there is under `runs/`.

use crate::flags::Runs;
use crate::runner::{Binary, Call};
use std::process::ExitCode;

impl Runs {
    pub(crate) fn call(&self) -> Call {
        Call::new(Binary::Kinematics, "runs").switch("json", self.json)
    }

    pub(crate) fn run(self) -> anyhow::Result<ExitCode> {
        self.call().run()
    }
}
