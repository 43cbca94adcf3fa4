//! The multi-rate loop, the task, training, evaluation and recording.
//!
//! In one picture: a policy acts at 20 Hz, [`motion`] turns each action into a safe velocity and a jerk-bounded way
//! there, samples it at 1 kHz, tracks it at 2 kHz and integrates the crane's dynamics; [`environment`] makes a task of
//! it, `training` lets a policy learn it, `evaluation` says how well it did, and [`evidence`] keeps count of every limit
//! meanwhile. Only this crate opens files, draws seeds and reads the clock.
//!
//! ```text
//! machine ──▶ motion ──▶ environment ──▶ training ──▶ runs/NAME/STAGE ──▶ gallery, report
//!   files      2 kHz      20 Hz            SAC        metrics, checkpoints, certificate
//! ```
//!
//! # Units
//! SI: m, rad, s, kg, N and N·m; "rad or m" is rad at a hinge and m at a cylinder. Margins are shares of a limit: 1 is
//! rest in the middle, 0 is the limit.
//!
//! # Example
//! The safe velocities of a joint near its limit, from the crane's own files.
//! ```
//! use std::path::Path;
//!
//! use runner::config::{ConfigSpec, DEFAULT};
//! use runner::machine::Machine;
//!
//! # std::env::set_current_dir("../..")?;
//! let machine = Machine::load(&ConfigSpec::read(Path::new(DEFAULT))?)?;
//! let lift = machine.joints().iter().find(|joint| joint.name == "lift_joint").expect("the crane has one");
//! let range = lift.zone.range(0.495, 0.05); // m, m/s
//! assert!(range.min <= range.max && range.max < 0.05, "5 mm before its limit the cylinder has to brake");
//! # Ok::<(), anyhow::Error>(())
//! ```
//!
//! # Features
//! - `training` (default): learning and evaluating policies, which takes burn. Without it the programs about motion
//!   alone build in seconds.
//! - `figures` (default): pictures of runs and of motion.
#![forbid(unsafe_code)]

#[cfg(feature = "training")]
pub mod actions;
pub mod arguments;
pub mod command;
pub mod config;
pub mod control;
pub mod course;
pub mod difference;
pub mod digest;
pub mod draw;
pub mod environment;
pub mod evidence;
mod feedforward;
pub mod governor;
mod interpolation;
pub mod kinematics;
pub mod machine;
pub mod motion;
pub mod observation;
#[cfg(feature = "figures")]
pub mod pictures;
pub mod recording;
pub mod region;
pub mod stage;
pub mod statistics;
pub mod store;
pub mod suggest;
pub mod surroundings;
pub mod track;
pub mod tune;

#[cfg(feature = "training")]
pub mod certificate;
#[cfg(feature = "training")]
pub mod checkpoint;
#[cfg(feature = "training")]
pub mod curriculum;
#[cfg(feature = "training")]
pub mod evaluation;
#[cfg(feature = "training")]
pub mod frame;
#[cfg(all(feature = "figures", feature = "training"))]
pub mod gallery;
#[cfg(feature = "training")]
pub mod interrupt;
#[cfg(feature = "training")]
pub mod play;
#[cfg(feature = "training")]
pub mod progress;
#[cfg(all(feature = "figures", feature = "training"))]
pub mod report;
#[cfg(feature = "training")]
pub mod search;
#[cfg(feature = "training")]
pub mod tensorboard;
#[cfg(feature = "training")]
pub mod trained;
#[cfg(feature = "training")]
pub mod training;
