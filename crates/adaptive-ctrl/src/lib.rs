//! Adaptive robust joint control, with PD and PID baselines.
//!
//! One controller per joint turns a reference and a measurement, both plain numbers, into an
//! effort. [`AdaptiveController`] is the subsystem-based law of the paper, [P, Eqs. (304), (305),
//! (307), (310), (311)]; [`PdController`] and [`PidController`] are the "classical controllers" that
//! it is set against. All three share [`JointController`], and [`Joints`] steps a fixed number of
//! them, one per joint of a machine.
//!
//! A controller is checked when it is built: [`AdaptiveController::new`] refuses gains that the
//! sampled loop could not keep stable over the stated range of inertia. After that a step cannot
//! fail; what happened in it is a status in the [`Command`]. Nothing here allocates during a step,
//! logs or reads a clock.
//!
//! # Picture
//!
//! ```text
//! reference  position ─────▶ ⊖ e₁ ─ k₁ ─▶ ⊕ ─▶ ⊖ z₂ ─ k₅ ─────▶ ⊕ ─▶ [ limits ] ─▶ effort
//!            velocity ──────────────────▶ ┘    ▲     k₆ φ̂₂ ──▶ ┘ ▲
//! measured   position ─────▶ ┘                 │   grows with    │ effort that a model
//!            velocity ─────────────────────────┘   the error     │ expects, if there is one
//! ```
//!
//! # Units
//!
//! SI: positions \[rad or m\], efforts \[N·m or N\], inertia \[kg·m² or kg\], periods \[s\]. Gains belong to one joint and
//! one period.
//!
//! # Example
//!
//! ```
//! use adaptive_ctrl::{
//!     AdaptiveController, Bounds, EffortLimits, Gains, GainsSpec, InverseInertia, JointController, JointSpec,
//!     Measurement, Reference, Saturation,
//! };
//!
//! let gains = Gains::try_from(GainsSpec {
//!     k1: 160.0, k2: 1e4, k3: 5.0, k4: 1.0, k5: 1e6, k6: 1e5, k7: 5.0, k8: 1.0,
//! })?;
//! let joint = JointSpec {
//!     period: 0.0005,
//!     inverse_inertia: InverseInertia::of_inertia(Bounds { lower: 1100.0, upper: 1500.0 })?, // kg
//!     effort_limits: EffortLimits::symmetric(37_300.0)?,                                     // N
//! };
//! let mut telescope = AdaptiveController::new(gains, joint)?;
//!
//! // Take over a joint that 900 N hold at rest: the first command is those 900 N.
//! let measured = Measurement { position: 0.3, velocity: 0.0 };
//! let start: Reference = telescope.start_holding(measured, 900.0)?;
//! let command = telescope.step(start, measured);
//! assert!((command.effort - 900.0).abs() < 1e-6);
//! assert_eq!(command.saturation, Saturation::None);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Features
//!
//! - `std` (default): standard-library support of the dependencies, and [`GainTable`] together with
//!   `serde`. Without it the crate is `no_std` and never allocates.
//! - `serde` (default): [`Gains`], [`PdGains`] and [`PidGains`] can be read from configuration.
#![cfg_attr(not(feature = "std"), no_std)]
#![forbid(unsafe_code)]

mod adaptive;
mod any;
mod ball;
mod coupled;
mod gains;
mod interface;
mod joints;
mod law;
mod limits;
mod pd;
mod pid;
mod stability;
#[cfg(all(feature = "std", feature = "serde"))]
mod table;

pub use adaptive::{Adaptation, AdaptiveController, Parameters};
pub use any::AnyController;
pub use ball::{OperatingRange, UltimateBound};
pub use coupled::coupled_damping_per_tick;
pub use gains::{Gains, GainsError, GainsSpec};
pub use interface::{Command, HoldError, Input, JointController, Measurement, Reference, Saturation};
pub use joints::{JointHoldError, Joints};
pub use limits::{Bounds, EffortLimits, InverseInertia, JointSpec, LimitsError};
pub use pd::{PdController, PdGains, PdGainsSpec};
pub use pid::{PidController, PidGains, PidGainsSpec};
pub use stability::{DiscreteLoop, MAX_DAMPING_PER_TICK, MIN_DAMPING_RATIO, StabilityError};
#[cfg(all(feature = "std", feature = "serde"))]
pub use table::{GAIN_TABLE_SCHEMA, GainTable, GainTableError, GainTableSpec};
