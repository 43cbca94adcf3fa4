//! When a stage is mastered.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use crate::config::Goal;

/// How an episode ended, as far as the curriculum is concerned.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EpisodeResult {
    /// True if the target was reached.
    pub reached: bool,
    /// Sum of the rewards.
    pub return_: f64,
}

/// State of a stage's curriculum; the checkpoint holds it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mastery {
    /// Results of the last episodes, at most the window's length.
    recent: VecDeque<EpisodeResult>,
    /// Episodes finished.
    pub episodes: u64,
    /// Episode at which the last confirmation was made.
    last_confirmation: Option<u64>,
    /// Success rate of the best confirmation so far; its networks are in the best checkpoint.
    pub best_confirmed: Option<f64>,
    /// True once a confirmation passed.
    pub mastered: bool,
}

impl Mastery {
    /// Before the first episode.
    #[must_use]
    pub fn new() -> Self {
        Self {
            recent: VecDeque::new(),
            episodes: 0,
            last_confirmation: None,
            best_confirmed: None,
            mastered: false,
        }
    }

    /// True if the stage ends after `steps` environment steps: mastered, or without hope of it.
    #[must_use]
    pub fn is_over(&self, steps: u64, episodes: u64, goal: &Goal) -> bool {
        self.mastered || self.episodes >= episodes || steps >= goal.max_steps
    }

    /// Counts an episode.
    pub fn add(&mut self, result: EpisodeResult, goal: &Goal) {
        self.episodes += 1;
        self.recent.push_back(result);
        while self.recent.len() > goal.window {
            self.recent.pop_front();
        }
    }

    /// Share of successes over the window, or over what there is of it; 0 before the first episode.
    #[must_use]
    pub fn success_rate(&self) -> f64 {
        let reached = self.recent.iter().filter(|result| result.reached).count();
        reached as f64 / self.recent.len().max(1) as f64
    }

    /// Mean return over the window; 0 before the first episode.
    #[must_use]
    pub fn mean_return(&self) -> f64 {
        self.recent.iter().map(|result| result.return_).sum::<f64>() / self.recent.len().max(1) as f64
    }

    /// True if the window is full of enough successes and the last confirmation is long enough ago for another.
    #[must_use]
    pub fn wants_confirmation(&self, goal: &Goal) -> bool {
        let since = self.last_confirmation.map_or(u64::MAX, |last| self.episodes - last);
        self.recent.len() >= goal.window
            && self.success_rate() >= goal.mastered_at
            && since >= goal.confirm_every
    }

    /// Notes a confirmation; true if it is the best so far.
    pub fn confirm(&mut self, success_rate: f64, goal: &Goal) -> bool {
        self.last_confirmation = Some(self.episodes);
        self.mastered |= success_rate >= goal.confirmed_at;
        let best = self.best_confirmed.is_none_or(|best| success_rate >= best);
        if best {
            self.best_confirmed = Some(success_rate);
        }
        best
    }
}

impl Default for Mastery {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOAL: Goal = Goal {
        max_episodes: 100,
        max_steps: 1000,
        window: 4,
        mastered_at: 0.75,
        confirm_episodes: 10,
        confirmed_at: 0.9,
        confirm_every: 3,
    };

    fn after(reached: &[bool]) -> Mastery {
        let mut mastery = Mastery::new();
        for &reached in reached {
            mastery.add(EpisodeResult { reached, return_: 1.0 }, &GOAL);
        }
        mastery
    }

    #[test]
    fn a_full_window_of_successes_asks_for_confirmation() {
        assert!(!after(&[true, true, true]).wants_confirmation(&GOAL), "the window is not full");
        assert!(!after(&[true, false, true, false]).wants_confirmation(&GOAL));
        assert!(after(&[false, true, true, true]).wants_confirmation(&GOAL));
        assert!(
            after(&[false, false, true, true, true, true]).wants_confirmation(&GOAL),
            "old failures count"
        );
    }

    #[test]
    fn a_failed_confirmation_is_repeated_only_after_a_while() {
        let mut mastery = after(&[true; 4]);
        assert!(mastery.confirm(0.5, &GOAL));
        assert!(!mastery.mastered && !mastery.wants_confirmation(&GOAL));
        for _ in 0..3 {
            mastery.add(EpisodeResult { reached: true, return_: 0.0 }, &GOAL);
        }
        assert!(mastery.wants_confirmation(&GOAL));
        assert!(!mastery.confirm(0.4, &GOAL), "worse than the first");
        assert!(mastery.confirm(0.95, &GOAL) && mastery.mastered);
        assert_eq!(mastery.best_confirmed, Some(0.95));
    }
}
