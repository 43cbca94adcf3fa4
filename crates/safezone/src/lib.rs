#![doc = include_str!("../README.md")]
//!
//! # Picture
//!
//! ```text
//! velocity
//!  max ┤━━━━━━━━━━━━━━━╮          inside: the joint can stop before its limit by braking
//!      │     ●→→→→→→●   ╲         step by step, D(v) is the distance that this takes
//!      │    safe      ↘   ╲
//!    0 ┼───────────────●───┤ p_max
//!      │                         the range at a position: every next velocity whose step
//!  min ┤╮━━━━━━━━━━━━━━━━━━      ends inside; braking is always one of them
//!      └──────────────────────▶ position
//! ```
//!
//! Units are SI: "rad or m" stands for rad at a revolute joint and m at a prismatic one.
//!
//! # Feature flags
//! - `std` (default): the standard library.
//! - `libm`: square roots from `libm`, for `no_std` targets; no allocation.
//! - `build`: builds [`BrakingTable`]s and reads and writes their RON form.
//!
//! The crate never opens a file, logs or reads a clock. The argument behind the guarantee is in
//! `docs/guarantee.md`; \[P\] is the paper named in `docs/references.md`.
#![cfg_attr(not(feature = "std"), no_std)]
#![forbid(unsafe_code)]

#[cfg(feature = "build")]
mod builder;
mod command;
mod curve;
mod hash;
mod interior;
mod lag;
mod math;
mod range;
#[cfg(feature = "build")]
mod ron_form;
mod sampled;
mod side;
mod solve;
mod table;
mod turns;
mod zone;

#[cfg(feature = "build")]
pub use builder::{BuildError, MAX_KNOTS};
pub use command::{Command, FailSafeReason, Request, Source};
pub use range::{RangeStatus, SafeRange};
#[cfg(feature = "build")]
pub use ron_form::ParseError;
pub use sampled::Samples;
pub use side::Side;
pub use table::{BrakingTable, Knot, SCHEMA, TableError, TableParts};
pub use zone::{SafeZone, ZoneError};
