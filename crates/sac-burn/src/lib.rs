//! Soft actor-critic (Haarnoja et al. 2018) on burn's Flex backend.
//!
//! The learning layer of the workspace, and where burn ends: the public interface is flat `f32` slices and bytes. It
//! knows neither cranes nor files nor clocks.
//!
//! - [`Config`]: every hyperparameter, checked; [`Config::table_1`] is the paper's.
//! - [`Agent`]: acts, remembers, updates, and saves and loads itself so that resuming continues bit for bit.
//! - [`Replay`]: the memory that the agent learns from, in one allocation.
//! - [`Policy`]: the deterministic policy alone, for evaluation and deployment.
//!
//! # Speed
//! One thread. Matrix products take most of an update, with AVX-512 where the machine has it. What is left is
//! sensitive to the allocator: give the *binary* mimalloc, since buffers of some hundred kilobytes come and go with
//! every product and glibc may return each to the operating system. `benches/sac.rs` measures all of it.
//!
//! # Determinism
//! All noise is drawn on the host from one generator that the checkpoint holds. burn's `rayon` feature is off, so
//! no sum depends on how threads split it. Other machines may round differently.
#![forbid(unsafe_code)]

mod adam;
mod agent;
mod checkpoint;
mod config;
mod lanes;
mod losses;
mod network;
mod noise;
mod objective;
mod policy;
mod replay;
mod squash;
mod temperature;
mod tensor;
mod transition;
mod update;
mod wire;

pub use agent::{Agent, AgentError, ReplayStart};
pub use config::{Config, ConfigError, ConfigSpec};
pub use losses::Losses;
pub use noise::Noise;
pub use policy::Policy;
pub use replay::{Batch, Replay, ReplayAllocationError};
pub use transition::{Outcome, Transition, TransitionError};
pub use wire::CheckpointError;
