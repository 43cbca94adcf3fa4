//! What a run counts. Sums and maxima alone, so that the order in which cases end does not matter.

use serde::Serialize;

use super::judge::Fault;

/// Largest excess over the limits of each quantity, relative to the width of its interval; 0 where none was exceeded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Excess {
    /// Of the position interval.
    pub position: f64,
    /// Of the velocity interval.
    pub velocity: f64,
    /// Of the acceleration interval.
    pub acceleration: f64,
    /// Of the jerk interval.
    pub jerk: f64,
}

impl Excess {
    /// Whether every excess is at most `bar`. False for NaN.
    #[inline]
    pub(super) fn is_within(&self, bar: f64) -> bool {
        self.position <= bar && self.velocity <= bar && self.acceleration <= bar && self.jerk <= bar
    }

    #[inline]
    fn each(&self) -> [f64; 4] {
        [self.position, self.velocity, self.acceleration, self.jerk]
    }

    /// The larger of each; NaN counts as infinite.
    #[inline]
    fn worst(&self, other: &Self) -> Self {
        let pick = |a: f64, b: f64| if b.is_nan() { f64::INFINITY } else { a.max(b) };
        Self {
            position: pick(self.position, other.position),
            velocity: pick(self.velocity, other.velocity),
            acceleration: pick(self.acceleration, other.acceleration),
            jerk: pick(self.jerk, other.jerk),
        }
    }
}

/// How often each promise was broken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Faults {
    /// A limit was exceeded by more than [`MOST_EXCESS`](super::MOST_EXCESS).
    pub limit: u64,
    /// A range was empty.
    pub empty_range: u64,
    /// A range did not hold braking, or not what it commanded.
    pub no_braking: u64,
    /// A velocity of a range could not be planned.
    pub refused: u64,
    /// A status promised too much or too little.
    pub status: u64,
}

impl Faults {
    /// All of them: the violations.
    #[must_use]
    pub const fn total(&self) -> u64 {
        self.limit + self.empty_range + self.no_braking + self.refused + self.status
    }
}

/// The counts of one case or of many.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tally {
    /// Steps made.
    pub steps: u64,
    /// Promises broken.
    pub faults: Faults,
    /// Largest excesses.
    pub worst: Excess,
    /// The largest excess of all, and the first case that has it.
    pub worst_case: Option<(f64, u64)>,
    /// The first case with a fault.
    pub first_faulty_case: Option<u64>,
    /// Joints: sets of limits with their shape, timing and period.
    pub zones: u64,
    /// Those of them whose braking distances came from a table.
    pub zones_with_table: u64,
    /// Those whose ranges came from samples.
    pub zones_with_samples: u64,
    /// Draws that the planner or the zone refused.
    pub refused: u64,
    /// Changes of limits while the joint moved.
    pub changes: u64,
    /// Steps whose range the position limits narrowed.
    pub narrowed: u64,
    /// Steps on a way back from outside the limits.
    pub recovering: u64,
}

impl Tally {
    #[inline]
    pub(super) fn excess(&mut self, excess: &Excess) {
        if !excess.is_within(0.0) {
            self.worst = self.worst.worst(excess);
        }
    }

    pub(super) fn fault(&mut self, fault: &Fault) {
        let count = match fault {
            Fault::Limit(_) => &mut self.faults.limit,
            Fault::EmptyRange => &mut self.faults.empty_range,
            Fault::NoBraking => &mut self.faults.no_braking,
            Fault::Refused(_) => &mut self.faults.refused,
            Fault::Status => &mut self.faults.status,
        };
        *count += 1;
    }

    /// Says which case these counts are of.
    pub(super) fn of_case(mut self, case: u64) -> Self {
        let most = self.worst.each().into_iter().fold(0.0, f64::max);
        self.worst_case = (most > 0.0).then_some((most, case));
        self.first_faulty_case = (self.faults.total() > 0).then_some(case);
        self
    }

    /// Both together.
    #[must_use]
    pub(super) fn and(self, other: Self) -> Self {
        let (a, b) = (self.faults, other.faults);
        Self {
            steps: self.steps + other.steps,
            faults: Faults {
                limit: a.limit + b.limit,
                empty_range: a.empty_range + b.empty_range,
                no_braking: a.no_braking + b.no_braking,
                refused: a.refused + b.refused,
                status: a.status + b.status,
            },
            worst: self.worst.worst(&other.worst),
            worst_case: worse(self.worst_case, other.worst_case),
            first_faulty_case: [self.first_faulty_case, other.first_faulty_case].into_iter().flatten().min(),
            zones: self.zones + other.zones,
            zones_with_table: self.zones_with_table + other.zones_with_table,
            zones_with_samples: self.zones_with_samples + other.zones_with_samples,
            refused: self.refused + other.refused,
            changes: self.changes + other.changes,
            narrowed: self.narrowed + other.narrowed,
            recovering: self.recovering + other.recovering,
        }
    }
}

/// The larger excess; of two equal ones that of the earlier case.
fn worse(a: Option<(f64, u64)>, b: Option<(f64, u64)>) -> Option<(f64, u64)> {
    let (Some(one), Some(other)) = (a, b) else { return a.or(b) };
    let is_other = other.0 > one.0 || (other.0 == one.0 && other.1 < one.1);
    Some(if is_other { other } else { one })
}
