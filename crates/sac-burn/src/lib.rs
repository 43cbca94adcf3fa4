//! Soft actor-critic (Haarnoja et al. 2018), exact to the bit, with burn beside it.
//!
//! The learning layer of the workspace. The public interface is flat `f32` slices and bytes; it knows neither cranes
//! nor files nor clocks.
//!
//! ```text
//!  observation ──► Agent::act ──► action ──► your environment
//!       ▲                                        │ reward, next observation
//!       │          Agent::update ◄── Replay ◄────┘ Agent::remember
//!       └───────── one batch: twin critics, target critics, actor, entropy temperature
//! ```
//!
//! - [`Config`]: every hyperparameter, checked; [`Config::table_1`] is the paper's.
//! - [`Agent`]: acts, remembers, updates, and saves and loads itself so that resuming continues bit for bit.
//! - [`Replay`]: the memory that the agent learns from, in one allocation.
//! - [`Policy`]: the deterministic policy alone, for evaluation and deployment.
//! - [`ActorModule`]: a policy as a burn module.
//!
//! # Units
//! None: observations are expected near [-1, 1], actions are in [-1, 1], rewards and returns are the task's own.
//! Everything that is counted in steps means steps of the environment.
//!
//! # Example
//! A point on a line that is paid for standing near 0.5, for as long as one update takes.
//! ```
//! use sac_burn::{Agent, Config, ConfigSpec, Outcome, Transition};
//!
//! let small = ConfigSpec {
//!     hidden: vec![8, 8],
//!     batch_size: 8,
//!     replay_capacity: 100,
//!     random_steps: 10,
//!     update_after: 10,
//!     ..Config::table_1().spec().clone()
//! };
//! let mut agent = Agent::new(Config::try_from(small)?, 1, 1, 0)?;
//! let (mut place, mut action) = ([0.0_f32], [0.0_f32]);
//! let losses = loop {
//!     agent.act(&place, &mut action);
//!     let next = [(place[0] + 0.1 * action[0]).clamp(-1.0, 1.0)];
//!     agent.remember(&Transition {
//!         observation: &place,
//!         action: &action,
//!         reward: -(next[0] - 0.5).abs(),
//!         next_observation: &next,
//!         outcome: Outcome::Continues,
//!     })?;
//!     place = next;
//!     if let Some(losses) = agent.update() {
//!         break losses;
//!     }
//! };
//! assert!(losses.critic.is_finite() && agent.updates() == 1);
//!
//! // What is deployed: the mean action, and nothing of the learning.
//! agent.policy().act(&place, &mut action);
//! assert!(action[0].abs() <= 1.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Speed
//! One thread. Matrix products take most of an update, with AVX-512 where the machine has it. What is left is
//! sensitive to the allocator: give the *binary* mimalloc, since buffers of some hundred kilobytes come and go with
//! every product and glibc may return each to the operating system. `benches/sac.rs` measures all of it.
//!
//! # Determinism
//! Equal configuration, seed and sequence of calls give equal bits on every x86-64 processor: all noise comes from one
//! generator that the checkpoint holds, every number of a matrix product is one chain of fused multiply-adds in a fixed
//! order, other sums have a fixed order too, and elementary functions are `libm`'s. burn's automatic differentiation
//! is the reference that the tests hold the gradients against.
#![forbid(unsafe_code)]

mod adam;
mod agent;
mod blocks;
mod checkpoint;
mod config;
mod lanes;
mod losses;
mod module;
mod network;
mod noise;
mod objective;
mod policy;
mod product;
mod replay;
mod squash;
mod temperature;
mod transition;
mod update;
mod wire;

pub use agent::{Agent, AgentError, ReplayStart};
pub use config::{Config, ConfigError, ConfigSpec};
pub use losses::Losses;
pub use module::ActorModule;
pub use noise::Noise;
pub use policy::Policy;
pub use replay::{Batch, Replay, ReplayAllocationError};
pub use transition::{Outcome, Transition, TransitionError};
pub use wire::CheckpointError;
