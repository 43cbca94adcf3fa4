//! A joint that is stopped in the middle of a step, as CSV: time, position, velocity, acceleration, jerk.
//!
//! Run with `cargo run -p jbtg --example emergency_stop`.
#![forbid(unsafe_code)]
#![expect(clippy::print_stdout, reason = "its output is what it is for")]

use jbtg::{Interval, Limits, Planner, PlannerSpec, Shape, State, SymmetricLimits, Timing};

const TICK: f64 = 0.001; // s

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let limits = Limits::try_from(SymmetricLimits {
        position: Interval::new(0.14, 0.50), // m
        velocity: 0.15,                      // m/s
        acceleration: 1.0,                   // m/s²
        jerk: 100.0,                         // m/s³
    })?;
    let spec = PlannerSpec { limits, shape: Shape::Smoothstep, timing: Timing::Stretched, period: 0.05 };
    let planner = Planner::try_from(spec)?;

    // The button is pressed 23 ms into a step that accelerates.
    let step = planner.ramp(0.30, 0.08, planner.reachable(0.08).max)?;
    let stop = planner.interrupt(&step, 0.023)?;

    println!("time,position,velocity,acceleration,jerk");
    let end = stop.begin + stop.trajectory.duration();
    for tick in 0..=(end / TICK) as u32 + 1 {
        let time = f64::from(tick) * TICK;
        let State { position, velocity, acceleration, jerk } =
            if time < stop.begin { step.state_at(time) } else { stop.trajectory.state_at(time - stop.begin) };
        println!("{time:.3},{position:.6},{velocity:.6},{acceleration:.6},{jerk:.4}");
    }
    Ok(())
}
