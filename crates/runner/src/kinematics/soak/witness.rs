//! Who watches a case: nobody in a run, a writer when one case is replayed.

use std::fmt::Write as _;

use safezone::{Command, SafeZone};

use super::judge::Fault;

/// A step that broke a promise.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment {
    /// Which step of the case, from 1.
    pub(super) number: u64,
    /// Position [rad or m] and velocity [rad/s or m/s] at its start.
    pub(super) state: (f64, f64),
    pub(super) command: Command,
    /// The velocity that the adversary took from the range [rad/s or m/s].
    pub(super) next: f64,
    pub(super) fault: Fault,
}

/// Is told what happens in a case.
pub(super) trait Witness {
    /// A joint's limits take effect.
    fn zone(&mut self, zone: &SafeZone<'_>);
    /// A promise is broken.
    fn fault(&mut self, zone: &SafeZone<'_>, moment: &Moment);
}

/// Watches nothing.
pub(super) struct Nobody;

impl Witness for Nobody {
    fn zone(&mut self, _: &SafeZone<'_>) {}

    fn fault(&mut self, _: &SafeZone<'_>, _: &Moment) {}
}

/// Writes down every joint and every fault, with all digits.
#[derive(Debug, Default)]
pub(super) struct Words(String);

impl Words {
    pub(super) fn into_text(self) -> String {
        self.0
    }

    fn line(&mut self, line: std::fmt::Arguments<'_>) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.0, "{line}");
    }
}

impl Witness for Words {
    fn zone(&mut self, zone: &SafeZone<'_>) {
        let source = if zone.table().is_some() { "table" } else { "closed form" };
        self.line(format_args!("joint ({source}): {:?}", zone.planner().spec()));
    }

    fn fault(&mut self, zone: &SafeZone<'_>, moment: &Moment) {
        let Moment { number, state: (position, velocity), command, next, fault } = *moment;
        self.line(format_args!("step {number}: {fault:?}"));
        self.line(format_args!("  from ({position:?}, {velocity:?}) to velocity {next:?}: {command:?}"));
        let stop = position + velocity.signum() * zone.stopping_distance(velocity);
        self.line(format_args!("  braking at once stops at {stop:?}"));
        if let Ok(step) = zone.planner().ramp(position, velocity, next) {
            self.line(format_args!("  {:?}", step.extrema()));
        }
    }
}
