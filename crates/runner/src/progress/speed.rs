//! How fast something counts, of late.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// Time over which a speed is taken: a training slows down once its learner begins.
const MEMORY: Duration = Duration::from_secs(15);

/// What has been done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Count {
    pub(super) episode: u64,
    pub(super) steps: u64,
    pub(super) updates: u64,
}

/// What is done per second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PerSecond {
    pub(super) episodes: f64,
    pub(super) steps: f64,
    pub(super) updates: f64,
}

/// Counts of the last while.
#[derive(Debug)]
pub(super) struct Speedometer {
    counts: VecDeque<(Instant, Count)>,
}

impl Speedometer {
    pub(super) fn new() -> Self {
        Self { counts: VecDeque::new() }
    }

    /// Adds a count; what is older than the memory is forgotten, but for one to measure from.
    pub(super) fn add(&mut self, at: Instant, count: Count) {
        self.counts.push_back((at, count));
        while self.counts.get(1).is_some_and(|(second, _)| at.duration_since(*second) >= MEMORY) {
            self.counts.pop_front();
        }
    }

    /// None before the second count.
    pub(super) fn per_second(&self) -> Option<PerSecond> {
        let (begin, first) = self.counts.front()?;
        let (end, last) = self.counts.back()?;
        let seconds = end.duration_since(*begin).as_secs_f64();
        let rate = |of: fn(&Count) -> u64| (of(last) - of(first)) as f64 / seconds;
        (seconds > 0.0).then(|| PerSecond {
            episodes: rate(|count| count.episode),
            steps: rate(|count| count.steps),
            updates: rate(|count| count.updates),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_fast_long_ago_is_forgotten() {
        #[expect(clippy::disallowed_methods, reason = "any instant will do")]
        let start = Instant::now();
        let mut speed = Speedometer::new();
        assert_eq!(speed.per_second(), None);
        for second in 0..=100 {
            // A thousand steps a second, and ten once the learner begins.
            let steps = if second < 50 { 1000 * second } else { 50_000 + 10 * (second - 50) };
            let count = Count { episode: second, steps, updates: second.saturating_sub(50) };
            speed.add(start + Duration::from_secs(second), count);
        }
        assert_eq!(speed.per_second(), Some(PerSecond { episodes: 1.0, steps: 10.0, updates: 1.0 }));
        assert!(speed.counts.len() < 20, "{}", speed.counts.len());
    }
}
