#![doc = include_str!("../README.md")]
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
    jbtg_plan, jbtg_plan_stop, jbtg_plan_waypoint, jbtg_reachable, jbtg_safe_range, jbtg_sampler_advance,
    jbtg_sampler_command, jbtg_sampler_init, jbtg_sampler_upcoming, jbtg_status_text, jbtg_step_extrema,
    jbtg_step_state_at, jbtg_stopping_distance,
};
pub use joint::{JOINT_WORDS, Joint, SAMPLER_WORDS, STEP_WORDS, Sampler, Step};
pub use status::{RangeStatus, Status};
pub use types::{
    Authority, Command, Extrema, Interval, JBTG_FASTEST, JBTG_SINE_QUINTIC, JBTG_SMOOTHSTEP, JBTG_STRETCHED,
    Limits, Range, Sample, Spec, State,
};

/// Halts. No exported function can panic, which `cargo xtask footprint` checks.
#[cfg(target_os = "none")]
#[panic_handler]
fn halt(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {
        core::hint::spin_loop();
    }
}
