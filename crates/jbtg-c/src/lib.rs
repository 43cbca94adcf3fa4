#![doc = include_str!("../README.md")]
//!
//! # Picture
//!
//! ```text
//! jbtg_spec ─ jbtg_joint_init ─▶ jbtg_joint ─ jbtg_command_action ─▶ the next velocity, never unsafe
//!                                    │                                   │
//!                                    └──── jbtg_plan ◀───────────────────┘
//!                                              ▼
//!                                          jbtg_step ─ jbtg_step_state_at ─▶ position, velocity, acceleration, jerk
//! ```
//!
//! # Units
//! SI: rad or m for a position, and that per s, s² and s³. A period is in s.
//!
//! # Example
//! From Rust, as C would: memory is handed in, and a status comes back.
//! ```
//! use std::mem::MaybeUninit;
//!
//! use jbtg_c::{Interval, JBTG_SMOOTHSTEP, JBTG_STRETCHED, Limits, Spec, Status, jbtg_joint_init, jbtg_safe_range};
//!
//! let both = |limit: f64| Interval { min: -limit, max: limit };
//! let position = Interval { min: 0.14, max: 0.50 };
//! let limits = Limits { position, velocity: both(0.15), acceleration: both(1.0), jerk: both(100.0) };
//! let spec = Spec { limits, period: 0.05, shape: JBTG_SMOOTHSTEP, timing: JBTG_STRETCHED };
//! let mut joint = MaybeUninit::uninit();
//! assert_eq!(jbtg_joint_init(Some(&mut joint), Some(&spec)), Status::Ok);
//! // Without memory there is an answer, too.
//! assert_eq!(jbtg_safe_range(None, 0.3, 0.0, None), Status::NullPointer);
//! ```
//!
//! # Feature flags
//! - `std` (default): square roots from the standard library.
//! - `libm`: square roots from `libm`, for targets without an operating system; a panic, which no function can reach,
//!   would halt there.
//!
//! Values cross the border by copy and objects live in memory that the caller provides, so there is no unsafe block
//! here: a pointer from C is an `Option` of a reference.
#![cfg_attr(target_os = "none", no_std)]
#![deny(unsafe_code)]

mod functions;
mod joint;
mod status;
mod types;

pub use functions::{
    jbtg_authority_of, jbtg_check_limits, jbtg_command_action, jbtg_command_velocity, jbtg_joint_init,
    jbtg_plan, jbtg_plan_interrupt, jbtg_plan_stop, jbtg_plan_waypoint, jbtg_reachable, jbtg_safe_range,
    jbtg_sampler_advance, jbtg_sampler_command, jbtg_sampler_init, jbtg_sampler_upcoming, jbtg_status_text,
    jbtg_step_extrema, jbtg_step_state_at, jbtg_stopping_distance,
};
pub use joint::{JOINT_WORDS, Joint, SAMPLER_WORDS, STEP_WORDS, Sampler, Step};
pub use status::{RangeStatus, Status};
pub use types::{
    Authority, Command, Extrema, Interval, JBTG_FASTEST, JBTG_SINE_QUINTIC, JBTG_SMOOTHSTEP, JBTG_STRETCHED,
    Limits, Range, Sample, Spec, State,
};

/// The Rust of the guide for motion-control engineers, compiled and run with the documentation's other examples.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/motion-control.md")]
struct Guide;

/// Halts. No exported function can panic, which `cargo xtask footprint` checks.
#[cfg(target_os = "none")]
#[panic_handler]
fn halt(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {
        core::hint::spin_loop();
    }
}
