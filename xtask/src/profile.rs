//! `profile`: plan one velocity change.

use crate::flags::Profile;
use crate::runner::{Binary, Call};
use std::process::ExitCode;

impl Profile {
    pub(crate) fn call(&self) -> Call {
        let numbers = [
            ("v1", self.v1),
            ("v2", self.v2),
            ("dt", self.dt),
            ("vmax", self.vmax),
            ("amax", self.amax),
            ("jmax", self.jmax),
        ];
        // Rust prints the shortest text that reads back as the same number.
        let call = Call::new(Binary::Kinematics, "profile");
        let call = numbers.iter().fold(call, |call, (flag, number)| call.value(flag, number.to_string()));
        call.option("shape", self.shape)
            .option("timing", self.timing)
            .option("hz", self.hz.map(|hz| hz.to_string()))
    }

    pub(crate) fn run(self) -> anyhow::Result<ExitCode> {
        self.call().run()
    }
}
