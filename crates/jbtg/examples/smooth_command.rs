//! A joystick's velocity, 20 times a second, as a smooth motion, 1000 times a second.
//!
//! ```text
//! cargo run --example smooth_command > motion.csv
//! ```
//! Two seconds of a joint with the limits of a loader crane's telescope. The operator pushes, pulls back, lets go; at 1.5 s the
//! radio link drops, and the joint brakes.

#![forbid(unsafe_code)]

use std::io::{self, Write};
use std::num::NonZeroU32;

use jbtg::{Interval, Limits, Origin, Planner, PlannerSpec, Sampler, Shape, SymmetricLimits, Timing};

const COMMAND_HZ: u32 = 20;
const TICKS_PER_COMMAND: NonZeroU32 = NonZeroU32::new(50).expect("not zero");
const SECONDS: u32 = 2;

/// What the operator asks for in command period `period` [m/s]; `None` when nothing arrives.
fn joystick(period: u32) -> Option<f64> {
    match period {
        0..10 => Some(0.10),
        10..20 => Some(-0.15),
        20..24 => Some(0.0),
        24..30 => Some(0.12),
        _ => None,
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let limits = Limits::try_from(SymmetricLimits {
        position: Interval::new(0.14, 0.50), // m
        velocity: 0.15,                      // m/s
        acceleration: 1.0,                   // m/s²
        jerk: 100.0,                         // m/s³
    })?;
    let planner = Planner::try_from(PlannerSpec {
        limits,
        shape: Shape::Smoothstep,
        timing: Timing::Stretched,
        period: f64::from(COMMAND_HZ).recip(),
    })?;
    let mut sampler = Sampler::at_rest(planner, TICKS_PER_COMMAND, 0.30)?;
    let mut out = io::stdout().lock();
    writeln!(out, "time,command,position,velocity,acceleration,jerk,origin")?;
    let tick_hz = COMMAND_HZ * TICKS_PER_COMMAND.get();
    for tick in 1..=SECONDS * tick_hz {
        let command = joystick((tick - 1) / TICKS_PER_COMMAND);
        if sampler.is_due() {
            // As fast towards the joystick's velocity as one period allows; without one the sampler brakes.
            command.map(|velocity| sampler.command_saturated(velocity)).transpose()?;
        }
        let sample = sampler.advance();
        let state = sample.state;
        let time = f64::from(tick) / f64::from(tick_hz);
        let asked = command.map_or_else(String::new, |velocity| velocity.to_string());
        let origin = if sample.origin == Origin::Command { "command" } else { "brake" };
        let (position, velocity) = (state.position, state.velocity);
        let (acceleration, jerk) = (state.acceleration, state.jerk);
        writeln!(out, "{time:.3},{asked},{position:.9},{velocity:.9},{acceleration:.6},{jerk:.4},{origin}")?;
    }
    Ok(())
}
