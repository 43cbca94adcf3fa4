//! What the agent remembers of one environment step.

/// How a step ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The episode goes on from the next observation.
    Continues,
    /// The episode ended because of the state that was reached: nothing can be earned after it, so the value of
    /// the next observation does not count.
    Terminal,
    /// The episode was cut off, by a time limit for instance: what could have been earned after it does count, so
    /// the target bootstraps from the next observation exactly as for [`Outcome::Continues`].
    Truncated,
}

impl Outcome {
    /// Factor of the bootstrap value: 0 if and only if the step is terminal.
    pub(crate) fn continuation(self) -> f32 {
        match self {
            Self::Continues | Self::Truncated => 1.0,
            Self::Terminal => 0.0,
        }
    }
}

/// One environment step, borrowed from the caller.
#[derive(Clone, Copy, Debug)]
pub struct Transition<'a> {
    /// What the policy saw.
    pub observation: &'a [f32],
    /// What it did, each component in [−1, 1].
    pub action: &'a [f32],
    /// What it earned.
    pub reward: f32,
    /// What it saw next; of the ended episode, not of the one that a reset began.
    pub next_observation: &'a [f32],
    /// Whether and why the episode ended with this step.
    pub outcome: Outcome,
}

/// Why a transition was not remembered.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TransitionError {
    /// A slice has the wrong length.
    #[error("{part} has {found} components, the agent has {expected}")]
    Length {
        /// Which slice.
        part: &'static str,
        /// Components that the agent was made for.
        expected: usize,
        /// Components of the slice.
        found: usize,
    },
    /// A number is NaN or infinite: one of them would spoil every weight for good.
    #[error("{part}[{index}] is not finite: {value}")]
    NotFinite {
        /// Which slice.
        part: &'static str,
        /// Component of the slice.
        index: usize,
        /// What was given.
        value: f32,
    },
    /// An action lies outside [−1, 1], where the policy's own actions never are.
    #[error("action[{index}] is outside [-1, 1]: {value}")]
    ActionOutOfRange {
        /// Component of the action.
        index: usize,
        /// What was given.
        value: f32,
    },
}

impl Transition<'_> {
    /// Checks lengths, finite numbers and the range of the action.
    pub(crate) fn check(&self, observation_dim: usize, action_dim: usize) -> Result<(), TransitionError> {
        let parts = [
            ("observation", self.observation, observation_dim),
            ("action", self.action, action_dim),
            ("reward", std::slice::from_ref(&self.reward), 1),
            ("next_observation", self.next_observation, observation_dim),
        ];
        for (part, values, expected) in parts {
            if values.len() != expected {
                return Err(TransitionError::Length { part, expected, found: values.len() });
            }
            if let Some(index) = values.iter().position(|x| !x.is_finite()) {
                return Err(TransitionError::NotFinite { part, index, value: values[index] });
            }
        }
        match self.action.iter().position(|a| a.abs() > 1.0) {
            Some(index) => Err(TransitionError::ActionOutOfRange { index, value: self.action[index] }),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: Transition<'_> = Transition {
        observation: &[0.0, 1.0],
        action: &[1.0],
        reward: -3.0,
        next_observation: &[0.5, 0.5],
        outcome: Outcome::Continues,
    };

    #[test]
    fn refuses_wrong_lengths_non_finite_numbers_and_actions_outside_the_unit_box() {
        assert_eq!(GOOD.check(2, 1), Ok(()));
        let error = GOOD.check(3, 1).unwrap_err();
        assert_eq!(error, TransitionError::Length { part: "observation", expected: 3, found: 2 });
        let error = Transition { reward: f32::NAN, ..GOOD }.check(2, 1).unwrap_err();
        assert!(matches!(error, TransitionError::NotFinite { part: "reward", index: 0, .. }), "{error}");
        let error = Transition { next_observation: &[0.0, f32::INFINITY], ..GOOD }.check(2, 1).unwrap_err();
        assert!(matches!(error, TransitionError::NotFinite { part: "next_observation", index: 1, .. }));
        let error = Transition { action: &[-1.5], ..GOOD }.check(2, 1).unwrap_err();
        assert_eq!(error, TransitionError::ActionOutOfRange { index: 0, value: -1.5 });
    }

    #[test]
    fn only_a_terminal_step_cuts_the_bootstrap() {
        assert_eq!(Outcome::Continues.continuation(), 1.0);
        assert_eq!(Outcome::Truncated.continuation(), 1.0);
        assert_eq!(Outcome::Terminal.continuation(), 0.0);
    }
}
