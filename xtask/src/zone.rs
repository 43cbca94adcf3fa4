//! `zone`: the safe velocity range of one joint.

use crate::flags::Zone;
use crate::runner::{Binary, Call};
use std::process::ExitCode;

impl Zone {
    pub(crate) fn call(&self) -> Call {
        Call::new(Binary::Kinematics, "zone")
            .value("joint", self.joint.as_str())
            .value("position", self.position.to_string())
            .value("velocity", self.velocity.to_string())
            .option("config", self.config.as_deref())
            .switch("json", self.json)
    }

    pub(crate) fn run(self) -> anyhow::Result<ExitCode> {
        self.call().run()
    }
}
