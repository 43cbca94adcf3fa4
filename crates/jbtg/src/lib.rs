#![doc = include_str!("../README.md")]
//!
//! # Picture
//!
//! ```text
//! velocity                      a ramp is one quintic in position: acceleration rises from 0 and
//!  v₂ ┤          ╭─────●        returns to 0, and jerk with it; between the ramps it is constant
//!     │        ╱
//!     │      ╱                  Stretched: the change takes the whole period
//!  v₁ ┤●────╯                   Fastest:   ramp at the limits, then cruise at v₂
//!     └┴───────────────┴─▶ time
//!      0             period     ● the policy chooses v₂; the next step begins where this one ends
//! ```
//!
//! # Feature flags
//! - `std` (default): square roots from the standard library.
//! - `libm`: square roots from `libm`, for `no_std` targets.
//! - `serde`: [`Limits`], [`PlannerSpec`], [`State`] and what they hold as serde data.
//! - `proptest`: module `strategies` for property tests.
//!
//! The crate never allocates, logs or reads a clock. Units are SI throughout: "rad or m" stands for rad at a
//! revolute joint and m at a prismatic one. \[P\] is the paper named in `docs/references.md`.
#![cfg_attr(not(feature = "std"), no_std)]
#![forbid(unsafe_code)]

#[cfg(not(any(feature = "std", feature = "libm")))]
compile_error!("jbtg needs a square root: enable the feature `std` or the feature `libm`");

mod detour;
mod extrema;
mod interval;
mod limits;
mod math;
mod planner;
mod pulse;
mod roots;
mod sampler;
mod segment;
mod shape;
mod standstill;
mod stop;
#[cfg(feature = "proptest")]
pub mod strategies;
mod synchronized;
mod trajectory;

pub use detour::{Detour, DetourCase, PulseKind};
pub use extrema::Extrema;
pub use interval::Interval;
pub use limits::{Limits, LimitsError, LimitsSpec, Quantity, SymmetricLimits};
pub use planner::{Authority, MIN_AUTHORITY_SHARE, Planner, PlannerError, PlannerSpec, RampError};
pub use pulse::Direction;
pub use sampler::{Origin, Sample, Sampler};
pub use segment::{Segment, State};
pub use shape::{Shape, Timing};
pub use stop::{Stop, StopError, StopStatus};
pub use synchronized::{Synchronized, SynchronizedError, SynchronizedStep};
pub use trajectory::{ControlPoint, MAX_SEGMENTS, Trajectory};
