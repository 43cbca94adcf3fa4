//! Tracking under load, disturbance and wrong models: scenarios as data, played against any of the control laws.
//!
//! A [`scenario::Scenario`] says what moves, what the crane really is and what disturbs it; a [`setup::Setup`] which law
//! tries to follow; [`play::play`] plays the one with the other and measures. `cargo xtask track` prints the result.

pub mod ablation;
#[cfg(feature = "figures")]
pub mod ablation_figure;
pub mod action;
pub mod lyapunov;
pub mod measures;
pub mod play;
pub mod reference;
pub mod report;
pub mod scenario;
pub mod setup;
