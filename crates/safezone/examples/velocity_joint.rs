//! A velocity-controlled joint with position limits: a command at 20 Hz, samples at 1 kHz, as CSV on standard output.
//!
//! An operator pushes against the upper limit for five seconds and then against the lower one, harder than is possible.
//! `cargo run -p safezone --example velocity_joint > joint.csv`
#![forbid(unsafe_code)]

use std::error::Error;
use std::io::{BufWriter, Write as _};

use jbtg::{Interval, Limits, LimitsSpec, Planner, PlannerSpec, Shape, Timing};
use safezone::SafeZone;

/// Ticks of 1 ms in one period.
const TICKS: u32 = 50;

fn main() -> Result<(), Box<dyn Error>> {
    let limits = Limits::try_from(LimitsSpec {
        position: Interval::new(0.14, 0.50),    // m
        velocity: Interval::new(-0.15, 0.10),   // m/s
        acceleration: Interval::new(-1.0, 0.5), // m/s²
        jerk: Interval::new(-100.0, 100.0),     // m/s³
    })?;
    let (shape, timing) = (Shape::Smoothstep, Timing::Stretched);
    let planner = Planner::try_from(PlannerSpec { limits, shape, timing, period: f64::from(TICKS) * 1e-3 })?;
    let zone = SafeZone::closed_form(planner)?;

    let mut csv = BufWriter::new(std::io::stdout().lock());
    writeln!(csv, "t,position,velocity,acceleration,jerk,least_safe_velocity,greatest_safe_velocity")?;
    let (mut position, mut velocity) = (0.30, 0.0);
    for period in 0..200 {
        let wanted: f64 = if period < 100 { 1.0 } else { -1.0 };
        let range = zone.range(position, velocity);
        let step = planner.ramp(position, velocity, wanted.max(range.min).min(range.max))?;
        for tick in 1..=TICKS {
            let state = step.state_at(f64::from(tick) * 1e-3);
            let t = f64::from(period * TICKS + tick) * 1e-3;
            writeln!(
                csv,
                "{t:.3},{},{},{},{},{},{}",
                state.position, state.velocity, state.acceleration, state.jerk, range.min, range.max
            )?;
        }
        let extrema = step.extrema();
        assert!(
            limits.position().min <= extrema.position.min && extrema.position.max <= limits.position().max
        );
        (position, velocity) = (step.end().position, step.end().velocity);
    }
    csv.flush()?;
    Ok(())
}
