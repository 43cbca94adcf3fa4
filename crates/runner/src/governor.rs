//! Slows the reference where effort does not suffice for its full acceleration, and notices where it does not suffice at
//! all.
//!
//! What a law commands beyond what the reference takes of the crane without payload is load that the limits of the
//! reference were not chosen for: a payload, a force, a fault; whether the law itself knows of it makes no difference.
//! While that is more than [`LOADED`] of an actuator's limit, or a command is saturated, the reference keeps to gentle
//! accelerations ([`GENTLE`]), and to velocities from which gentle braking stops inside the limits. With nothing unknown
//! it never acts.

use adaptive_ctrl::{Command, Saturation};
use serde::{Deserialize, Serialize};

/// Share of an actuator's effort limit from which on an unexplained effort counts as load.
pub const LOADED: f64 = 0.05;

/// Share of the reference's acceleration limit that is left under load.
pub const GENTLE: f64 = 0.3;

/// Policy periods for which load counts after it was last seen.
const MEMORY: u32 = 20;

/// Policy periods in a row of full saturation and growing error, after which an actuator counts as overloaded.
const OVERLOADED_PERIODS: u32 = 4;

/// An actuator whose effort does not hold what it carries.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Overload {
    /// Which joint.
    pub joint: String,
    /// When it was noticed \[s\].
    pub time: f64,
    /// The effort commanded there, its limit [N or N·m].
    pub effort: f64,
    /// How far the joint had gone from its reference [m or rad].
    pub error: f64,
}

/// Looks at every command of a policy period, and says before the next one how the reference may move.
#[derive(Clone, Debug)]
pub(crate) struct Governor {
    joints: Vec<Seen>,
    commands: u32,
    /// Periods for which load still counts.
    loaded: u32,
    /// Periods in which the reference was held to gentle accelerations.
    pub(crate) gentle_periods: u64,
}

#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    /// Saturated commands of the present period.
    saturated: u32,
    /// Whether more than [`LOADED`] of the limit was unexplained in it.
    is_loaded: bool,
    /// Size of the position error at the last period's end.
    error: f64,
    /// Periods in a row of full saturation and growing error.
    losing: u32,
}

impl Governor {
    pub(crate) fn new(joints: usize) -> Self {
        Self { joints: vec![Seen::default(); joints], commands: 0, loaded: 0, gentle_periods: 0 }
    }

    /// A new start under efforts of which the crane without payload explains only a part; what was counted stays.
    pub(crate) fn start(&mut self, unexplained: impl Iterator<Item = (f64, f64)>) {
        *self = Self { gentle_periods: self.gentle_periods, ..Self::new(self.joints.len()) };
        for (seen, (effort, limit)) in self.joints.iter_mut().zip(unexplained) {
            seen.is_loaded = effort.abs() > LOADED * limit;
        }
    }

    /// Notes a tick's command of one joint that takes the effort `expected` without load and exerts `limit` at most.
    pub(crate) fn note(&mut self, joint: usize, expected: f64, command: &Command, limit: f64) {
        let seen = &mut self.joints[joint];
        seen.saturated += u32::from(command.saturation != Saturation::None);
        seen.is_loaded |= (command.effort - expected).abs() > LOADED * limit;
    }

    /// Notes that a tick is over.
    pub(crate) fn tick(&mut self) {
        self.commands += 1;
    }

    /// Closes a period in which every joint ended `errors` off. True if the reference is to be gentle in the next one.
    pub(crate) fn judge(&mut self, errors: impl Iterator<Item = f64>) -> bool {
        let any = self.joints.iter().any(|seen| seen.is_loaded || seen.saturated > 0);
        self.loaded = if any { MEMORY } else { self.loaded.saturating_sub(1) };
        for (seen, error) in self.joints.iter_mut().zip(errors) {
            let is_full = self.commands > 0 && seen.saturated == self.commands;
            let losing = if is_full && error.abs() > seen.error { seen.losing + 1 } else { 0 };
            *seen = Seen { saturated: 0, is_loaded: false, error: error.abs(), losing };
        }
        self.commands = 0;
        self.gentle_periods += u64::from(self.loaded > 0);
        self.loaded > 0
    }

    /// The first joint that loses against its load.
    pub(crate) fn overloaded(&self) -> Option<(usize, f64)> {
        let joint = self.joints.iter().position(|seen| seen.losing >= OVERLOADED_PERIODS)?;
        Some((joint, self.joints[joint].error))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use adaptive_ctrl::Input;

    fn period(governor: &mut Governor, effort: f64, saturation: Saturation, error: f64) -> bool {
        for _ in 0..10 {
            let command = Command { effort, saturation, input: Input::Used };
            governor.note(0, 50.0, &command, 100.0);
            governor.tick();
        }
        governor.judge([error].into_iter())
    }

    #[test]
    fn unexplained_effort_makes_it_gentle_for_a_while() {
        let mut governor = Governor::new(1);
        assert!(!period(&mut governor, 54.0, Saturation::None, 0.0));
        assert!(period(&mut governor, 56.0, Saturation::None, 0.0));
        assert!((1..MEMORY).all(|_| period(&mut governor, 50.0, Saturation::None, 0.0)));
        assert!(!period(&mut governor, 50.0, Saturation::None, 0.0));
        governor.start([(6.0, 100.0)].into_iter());
        assert!(governor.judge([0.0].into_iter()), "known from the start");
    }

    #[test]
    fn only_a_joint_that_goes_on_losing_is_overloaded() {
        let mut governor = Governor::new(1);
        for n in 1..10 {
            // Saturated, but on its way back.
            period(&mut governor, 100.0, Saturation::AtUpper, 1.0 / f64::from(n));
            assert!(n == 1 || governor.overloaded().is_none());
        }
        for n in 1..=OVERLOADED_PERIODS {
            assert!(governor.overloaded().is_none());
            period(&mut governor, 100.0, Saturation::AtUpper, f64::from(n));
        }
        assert_eq!(governor.overloaded(), Some((0, f64::from(OVERLOADED_PERIODS))));
    }
}
