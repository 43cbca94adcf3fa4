//! The replay memory: a ring of transitions in one flat host allocation.

use crate::noise::Noise;
use crate::transition::{Transition, TransitionError};

/// Ring of the last `capacity` transitions.
///
/// Row-major, one transition per row: observation, action, next observation, reward, continuation (1, or 0 after a
/// terminal step). Rows lie side by side, so that drawing one touches a few neighbouring cache lines. The whole
/// capacity is reserved once and never moved; the operating system backs only what was written. One million
/// transitions of 32 observations and 3 actions take 276 MB.
#[derive(Debug)]
pub struct Replay {
    observation_dim: usize,
    action_dim: usize,
    capacity: usize,
    /// Row that the next transition goes to once the ring is full.
    next: usize,
    rows: Vec<f32>,
}

/// A drawn batch, each part row-major.
#[derive(Clone, Debug, Default)]
pub struct Batch {
    /// \[batch, observation\].
    pub observations: Vec<f32>,
    /// \[batch, action\].
    pub actions: Vec<f32>,
    /// \[batch, observation\].
    pub next_observations: Vec<f32>,
    /// \[batch\].
    pub rewards: Vec<f32>,
    /// \[batch\]: 0 where the step was terminal, else 1.
    pub continuations: Vec<f32>,
}

/// The replay memory could not be allocated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no memory for a replay of {capacity} transitions of {row} numbers")]
pub struct ReplayAllocationError {
    /// Transitions asked for.
    pub capacity: usize,
    /// Numbers in each.
    pub row: usize,
}

impl Replay {
    /// Reserves the whole capacity.
    ///
    /// # Errors
    /// [`ReplayAllocationError`] if there is no address space for it.
    ///
    /// # Panics
    /// If `capacity` is 0.
    pub fn new(
        observation_dim: usize,
        action_dim: usize,
        capacity: usize,
    ) -> Result<Self, ReplayAllocationError> {
        assert!(capacity > 0, "a replay memory must hold something");
        let row = 2 * observation_dim + action_dim + 2;
        let error = ReplayAllocationError { capacity, row };
        let mut rows = Vec::new();
        rows.try_reserve_exact(capacity.checked_mul(row).ok_or(error)?).map_err(|_| error)?;
        Ok(Self { observation_dim, action_dim, capacity, next: 0, rows })
    }

    /// Transitions that it can hold.
    pub fn capacity(&self) -> usize {
        self.capacity
    }

    /// Whether it holds no transition.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Transitions that it holds.
    pub fn len(&self) -> usize {
        self.rows.len() / self.row()
    }

    /// Position at which the next transition will overwrite the oldest; 0 until the ring is full.
    pub(crate) fn next(&self) -> usize {
        self.next
    }

    /// The filled part, row after row.
    pub(crate) fn rows(&self) -> &[f32] {
        &self.rows
    }

    /// Numbers in one row.
    pub(crate) fn row(&self) -> usize {
        2 * self.observation_dim + self.action_dim + 2
    }

    /// Appends a transition; overwrites the oldest if the ring is full.
    ///
    /// # Errors
    /// [`TransitionError`] if a length is wrong, a number is not finite or the action leaves [−1, 1]; nothing is
    /// stored then.
    pub fn push(&mut self, transition: &Transition<'_>) -> Result<(), TransitionError> {
        transition.check(self.observation_dim, self.action_dim)?;
        let tail = [transition.reward, transition.outcome.continuation()];
        let parts = [transition.observation, transition.action, transition.next_observation, tail.as_slice()];
        if self.len() < self.capacity {
            for part in parts {
                self.rows.extend_from_slice(part);
            }
        } else {
            let mut at = self.next * self.row();
            for part in parts {
                self.rows[at..at + part.len()].copy_from_slice(part);
                at += part.len();
            }
            self.next = (self.next + 1) % self.capacity;
        }
        Ok(())
    }

    /// Forgets every transition; the allocation stays.
    pub fn clear(&mut self) {
        self.rows.clear();
        self.next = 0;
    }

    /// Draws `size` transitions uniformly and with replacement into `batch`, whose former content goes.
    ///
    /// # Panics
    /// If the memory is empty and `size` is not 0.
    pub fn sample(&self, size: usize, noise: &mut Noise, batch: &mut Batch) {
        let (o, a, row) = (self.observation_dim, self.action_dim, self.row());
        batch.clear();
        let count = self.len();
        assert!(count > 0 || size == 0, "cannot draw from an empty replay memory");
        let starts: Vec<usize> = (0..size).map(|_| noise.index(count) * row).collect();
        for start in starts {
            let row = &self.rows[start..start + row];
            batch.observations.extend_from_slice(&row[..o]);
            batch.actions.extend_from_slice(&row[o..o + a]);
            batch.next_observations.extend_from_slice(&row[o + a..2 * o + a]);
            batch.rewards.push(row[2 * o + a]);
            batch.continuations.push(row[2 * o + a + 1]);
        }
    }

    /// Puts back the filled part of a checkpoint: appends as many numbers as `fill` writes into each given slice.
    ///
    /// Calls `fill` with slices that together hold `count` rows, then sets the ring's position.
    pub(crate) fn restore<E>(
        &mut self,
        count: usize,
        next: usize,
        mut fill: impl FnMut(&mut [f32]) -> Result<(), E>,
    ) -> Result<(), E> {
        self.clear();
        for _ in 0..count {
            let start = self.rows.len();
            self.rows.resize(start + self.row(), 0.0);
            fill(&mut self.rows[start..])?;
        }
        self.next = next;
        Ok(())
    }

    /// The same transitions in a ring of another capacity: the newest, in order of age.
    pub(crate) fn with_capacity(&self, capacity: usize) -> Result<Self, ReplayAllocationError> {
        let mut other = Self::new(self.observation_dim, self.action_dim, capacity)?;
        let (count, row) = (self.len(), self.row());
        for age in count.saturating_sub(capacity)..count {
            let at = (self.next + age) % count * row;
            other.rows.extend_from_slice(&self.rows[at..at + row]);
        }
        Ok(other)
    }
}

impl Batch {
    fn clear(&mut self) {
        self.observations.clear();
        self.actions.clear();
        self.next_observations.clear();
        self.rewards.clear();
        self.continuations.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transition::Outcome;

    fn push(replay: &mut Replay, value: f32, outcome: Outcome) {
        let observation = [value, value + 0.25];
        let next_observation = [value + 0.5, value + 0.75];
        let transition = Transition {
            observation: &observation,
            action: &[value / 100.0],
            reward: -value,
            next_observation: &next_observation,
            outcome,
        };
        replay.push(&transition).unwrap();
    }

    fn rewards(replay: &Replay) -> Vec<f32> {
        replay.rows.chunks(replay.row()).map(|row| row[5]).collect()
    }

    #[test]
    fn a_full_ring_overwrites_the_oldest_and_never_moves() {
        let mut replay = Replay::new(2, 1, 3).unwrap();
        let place = replay.rows.as_ptr();
        for value in 1..=5 {
            push(&mut replay, value as f32, Outcome::Continues);
        }
        assert_eq!((replay.len(), replay.next()), (3, 2));
        assert_eq!(rewards(&replay), [-4.0, -5.0, -3.0]);
        assert_eq!(replay.rows.as_ptr(), place);
        replay.clear();
        assert_eq!((replay.len(), replay.next()), (0, 0));
        assert_eq!(replay.rows.as_ptr(), place);
    }

    #[test]
    fn every_transition_is_drawn_and_comes_back_whole() {
        let mut replay = Replay::new(2, 1, 8).unwrap();
        for value in 0..8 {
            push(&mut replay, value as f32, if value == 3 { Outcome::Terminal } else { Outcome::Truncated });
        }
        let mut batch = Batch::default();
        let mut seen = [false; 8];
        replay.sample(200, &mut Noise::new(1), &mut batch);
        for i in 0..200 {
            let value = -batch.rewards[i];
            seen[value as usize] = true;
            assert_eq!(batch.observations[2 * i..2 * i + 2], [value, value + 0.25]);
            assert_eq!(batch.actions[i], value / 100.0);
            assert_eq!(batch.next_observations[2 * i..2 * i + 2], [value + 0.5, value + 0.75]);
            assert_eq!(batch.continuations[i], if value == 3.0 { 0.0 } else { 1.0 });
        }
        assert!(seen.iter().all(|&s| s), "not every transition was drawn: {seen:?}");
    }

    #[test]
    fn another_capacity_keeps_the_newest_in_order() {
        let mut replay = Replay::new(2, 1, 4).unwrap();
        for value in 1..=6 {
            push(&mut replay, value as f32, Outcome::Continues);
        }
        assert_eq!(rewards(&replay.with_capacity(3).unwrap()), [-4.0, -5.0, -6.0]);
        let mut larger = replay.with_capacity(9).unwrap();
        push(&mut larger, 7.0, Outcome::Continues);
        assert_eq!(rewards(&larger), [-3.0, -4.0, -5.0, -6.0, -7.0]);
    }

    #[test]
    fn a_capacity_beyond_all_memory_is_an_error() {
        let error = Replay::new(32, 3, usize::MAX / 8).unwrap_err();
        assert_eq!(error, ReplayAllocationError { capacity: usize::MAX / 8, row: 69 });
    }
}
