//! Who watches a case: nobody in a run, a writer when one case is replayed.

use std::collections::VecDeque;
use std::fmt::Write as _;

use safezone::{Command, RangeStatus, SafeZone};

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
    /// A step is made in which every promise held.
    fn step(&mut self, state: (f64, f64), command: &Command, next: f64);
    /// A promise is broken.
    fn fault(&mut self, zone: &SafeZone<'_>, moment: &Moment);
}

/// Watches nothing.
pub(super) struct Nobody;

impl Witness for Nobody {
    fn zone(&mut self, _: &SafeZone<'_>) {}

    #[inline]
    fn step(&mut self, _: (f64, f64), _: &Command, _: f64) {}

    fn fault(&mut self, _: &SafeZone<'_>, _: &Moment) {}
}

/// Steps before a fault that are written down with it.
const REMEMBERED: usize = 12;

/// Writes down every joint and every fault with the steps before it, with all digits.
#[derive(Debug, Default)]
pub(super) struct Words {
    text: String,
    /// The last steps: position, velocity, the velocity taken, and the status of the range.
    steps: VecDeque<(f64, f64, f64, RangeStatus)>,
}

impl Words {
    pub(super) fn into_text(self) -> String {
        self.text
    }

    fn line(&mut self, line: std::fmt::Arguments<'_>) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.text, "{line}");
    }
}

impl Witness for Words {
    fn zone(&mut self, zone: &SafeZone<'_>) {
        let source = if zone.table().is_some() { "table" } else { "closed form" };
        self.line(format_args!("joint ({source}): {:?}", zone.planner().spec()));
    }

    fn step(&mut self, (position, velocity): (f64, f64), command: &Command, next: f64) {
        if self.steps.len() == REMEMBERED {
            self.steps.pop_front();
        }
        self.steps.push_back((position, velocity, next, command.range.status));
    }

    fn fault(&mut self, zone: &SafeZone<'_>, moment: &Moment) {
        let Moment { number, state: (position, velocity), command, next, fault } = *moment;
        for (position, velocity, next, status) in std::mem::take(&mut self.steps) {
            self.line(format_args!("  before: ({position:?}, {velocity:?}) to {next:?}, {status:?}"));
        }
        self.line(format_args!("step {number}: {fault:?}"));
        self.line(format_args!("  from ({position:?}, {velocity:?}) to velocity {next:?}: {command:?}"));
        let stop = position + velocity.signum() * zone.stopping_distance(velocity);
        self.line(format_args!("  braking at once stops at {stop:?}"));
        if let Ok(step) = zone.planner().ramp(position, velocity, next) {
            self.line(format_args!("  {:?}", step.extrema()));
        }
    }
}
