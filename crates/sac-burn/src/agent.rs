//! The agent: networks, optimisers, replay memory and noise under one roof.

use crate::config::{Config, ConfigError};
use crate::network::{Network, Optimizer};
use crate::noise::Noise;
use crate::policy::Policy;
use crate::replay::{Batch, Replay, ReplayAllocationError};
use crate::squash::{StdBounds, sample};
use crate::temperature::Temperature;
use crate::transition::{Transition, TransitionError};

/// A soft actor-critic agent (Haarnoja et al. 2018) on flat `f32` slices.
///
/// Twin critics, squashed Gaussian policy, learned entropy temperature. It is deterministic: equal configuration,
/// seed and sequence of calls give bit-identical weights and actions on one machine. Speaks of neither files nor
/// clocks; observations come normalised, actions lie in [−1, 1].
///
/// # Examples
/// ```
/// use sac_burn::{Agent, Config, ConfigSpec, Outcome, Transition};
///
/// let spec = ConfigSpec { batch_size: 8, random_steps: 8, update_after: 8, ..Config::table_1().spec().clone() };
/// let mut agent = Agent::new(Config::try_from(spec)?, 2, 1, 7)?;
/// let mut action = [0.0];
/// for step in 0..16 {
///     agent.act(&[0.0, 1.0], &mut action); // uniform while warming up, then drawn from the policy
///     agent.remember(&Transition {
///         observation: &[0.0, 1.0],
///         action: &action,
///         reward: -action[0].abs(),
///         next_observation: &[0.0, 1.0],
///         outcome: if step % 4 == 3 { Outcome::Truncated } else { Outcome::Continues },
///     })?;
///     if let Some(losses) = agent.update() {
///         assert!(losses.is_finite());
///     }
/// }
/// assert_eq!((agent.steps(), agent.updates()), (16, 9));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Agent {
    pub(crate) config: Config,
    pub(crate) observation_dim: usize,
    pub(crate) action_dim: usize,
    pub(crate) actor: Network,
    pub(crate) critics: Network,
    pub(crate) targets: Network,
    pub(crate) actor_optimizer: Optimizer,
    pub(crate) critic_optimizer: Optimizer,
    pub(crate) temperature: Temperature,
    pub(crate) replay: Replay,
    pub(crate) noise: Noise,
    /// Transitions remembered since the agent was made.
    pub(crate) steps: u64,
    /// Gradient updates since the agent was made.
    pub(crate) updates: u64,
    /// The actor as it acts on one observation at a time; equal to it after every update.
    pub(crate) explorer: Policy,
    /// What was learnt: follows the actor by `policy_share` per update.
    pub(crate) policy: Policy,
    /// Kept between updates for its memory alone.
    pub(crate) batch: Batch,
}

/// Why an agent could not be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AgentError {
    /// A dimension is zero.
    #[error("{dimension} must be at least 1, got 0")]
    ZeroDimension {
        /// Which dimension.
        dimension: &'static str,
    },
    /// The hyperparameters are not usable.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// There is no memory for the replay.
    #[error(transparent)]
    Replay(#[from] ReplayAllocationError),
    /// A later stage asks for networks of another shape than those it continues.
    #[error(
        "hidden layers cannot change between stages: they are {found:?}, the new stage asks for {expected:?}"
    )]
    HiddenLayers {
        /// Hidden layers of the new configuration.
        expected: Vec<usize>,
        /// Hidden layers of the agent.
        found: Vec<usize>,
    },
}

/// What becomes of the remembered transitions when a new stage begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReplayStart {
    /// Keep them, the newest first to stay if the capacity shrinks.
    Keep,
    /// Forget them; updates wait until `update_after` new ones are there.
    Clear,
}

impl Agent {
    /// A fresh agent whose every random number comes from `seed`.
    ///
    /// Reserves the replay memory at once, 4·(2·`observation_dim` + `action_dim` + 2) bytes per transition; the
    /// operating system backs it as it fills.
    ///
    /// # Errors
    /// [`AgentError::ZeroDimension`] if there is nothing to see or to do, [`AgentError::Replay`] if the replay
    /// memory cannot be reserved.
    pub fn new(
        config: Config,
        observation_dim: usize,
        action_dim: usize,
        seed: u64,
    ) -> Result<Self, AgentError> {
        for (dimension, size) in [("observation_dim", observation_dim), ("action_dim", action_dim)] {
            if size == 0 {
                return Err(AgentError::ZeroDimension { dimension });
            }
        }
        let spec = config.spec();
        let replay = Replay::new(observation_dim, action_dim, spec.replay_capacity)?;
        let mut noise = Noise::new(seed);
        let widths = |inputs: usize, outputs: usize| [&[inputs], spec.hidden.as_slice(), &[outputs]].concat();
        let actor = Network::new(1, &widths(observation_dim, 2 * action_dim), &mut noise);
        let critics = Network::new(2, &widths(observation_dim + action_dim, 1), &mut noise);
        Ok(Self {
            observation_dim,
            action_dim,
            targets: critics.clone(),
            actor_optimizer: Optimizer::new(&actor),
            critic_optimizer: Optimizer::new(&critics),
            temperature: Temperature::new(spec.initial_entropy_temperature),
            explorer: Policy::of(&actor),
            policy: Policy::of(&actor),
            replay,
            noise,
            steps: 0,
            updates: 0,
            batch: Batch::default(),
            actor,
            critics,
            config,
        })
    }

    /// Continues a trained agent in a new stage of the curriculum, under that stage's hyperparameters.
    ///
    /// Networks, optimisers, entropy temperature, counters and the state of the generator carry over, so no second
    /// random phase begins. `initial_entropy_temperature` of the new configuration is not used.
    ///
    /// # Errors
    /// [`AgentError::HiddenLayers`] if the new configuration has other hidden layers, [`AgentError::Replay`] if
    /// a replay memory of another capacity cannot be reserved.
    pub fn start_from(previous: Self, config: Config, replay: ReplayStart) -> Result<Self, AgentError> {
        let mut agent = previous;
        let (expected, found) = (&config.spec().hidden, &agent.config.spec().hidden);
        if expected != found {
            return Err(AgentError::HiddenLayers { expected: expected.clone(), found: found.clone() });
        }
        if replay == ReplayStart::Clear {
            agent.replay.clear();
        }
        if config.spec().replay_capacity != agent.replay.capacity() {
            agent.replay = agent.replay.with_capacity(config.spec().replay_capacity)?;
        }
        agent.config = config;
        Ok(agent)
    }

    /// Hyperparameters.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// Components of an observation.
    pub fn observation_dim(&self) -> usize {
        self.observation_dim
    }

    /// Components of an action.
    pub fn action_dim(&self) -> usize {
        self.action_dim
    }

    /// Transitions remembered since the agent was made, in all stages.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Gradient updates since the agent was made, in all stages.
    pub fn updates(&self) -> u64 {
        self.updates
    }

    /// Transitions in the replay memory.
    pub fn replay_len(&self) -> usize {
        self.replay.len()
    }

    /// Entropy temperature α.
    pub fn entropy_temperature(&self) -> f64 {
        self.temperature.value()
    }

    /// Whether [`Agent::act`] still draws uniform actions: fewer than `random_steps` transitions were remembered.
    pub fn is_warming_up(&self) -> bool {
        self.steps < self.config.spec().random_steps
    }

    /// The deterministic policy as it is now: a moving average of the actors that the updates made.
    pub fn policy(&self) -> &Policy {
        &self.policy
    }

    /// Forgets every remembered transition. Updates wait until `update_after` new ones are there.
    pub fn clear_replay(&mut self) {
        self.replay.clear();
    }

    /// Draws an action to explore with: uniform in [−1, 1) while warming up, then from the squashed Gaussian.
    ///
    /// # Panics
    /// If a slice does not have the agent's length.
    pub fn act(&mut self, observation: &[f32], action: &mut [f32]) {
        assert_eq!(observation.len(), self.observation_dim, "length of the observation");
        assert_eq!(action.len(), self.action_dim, "length of the action");
        if self.is_warming_up() {
            action.fill_with(|| self.noise.uniform(1.0));
            return;
        }
        let head = self.explorer.head(observation);
        let mut noise = vec![0.0; self.action_dim];
        self.noise.fill_normal(&mut noise);
        action.copy_from_slice(&sample(&head, &noise, self.action_dim, self.std_bounds()).actions);
    }

    /// The action without noise, tanh of the mean; touches nothing and draws nothing.
    ///
    /// # Panics
    /// If a slice does not have the agent's length.
    pub fn act_deterministic(&self, observation: &[f32], action: &mut [f32]) {
        self.policy.act(observation, action);
    }

    /// Stores one environment step and counts it.
    ///
    /// # Errors
    /// [`TransitionError`] if a length is wrong, a number is not finite or the action leaves [−1, 1]; nothing is
    /// stored then.
    pub fn remember(&mut self, transition: &Transition<'_>) -> Result<(), TransitionError> {
        self.replay.push(transition)?;
        self.steps += 1;
        Ok(())
    }

    /// Bounds of ln σ.
    pub(crate) fn std_bounds(&self) -> StdBounds {
        let spec = self.config.spec();
        StdBounds { min: spec.log_std_min as f32, max: spec.log_std_max as f32 }
    }

    /// Lets the policy follow the actor after an update.
    pub(crate) fn follow_actor(&mut self) {
        self.refresh_explorer();
        self.policy.follow(self.config.spec().policy_share as f32, &self.explorer);
    }

    /// Brings the host copy of the actor up to date after its weights were replaced.
    pub(crate) fn refresh_explorer(&mut self) {
        self.explorer.copy_from(&self.actor);
    }
}
