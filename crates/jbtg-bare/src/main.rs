//! One joint in a control loop without an operating system, allocator or standard library.
//!
//! `cargo xtask footprint` builds it for a Cortex-M4F, tells the size of its code, and fails if any of the panic
//! machinery is in it: then no function used here can panic, whatever it is given. All numbers that come from outside
//! are opaque to the optimiser, so nothing is computed beforehand. Elsewhere it does nothing.
#![cfg_attr(target_os = "none", no_std, no_main)]
#![deny(unsafe_code)]

use core::hint::black_box;

use jbtg::{Interval, Limits, LimitsSpec, Planner, PlannerSpec, Shape, State, Timing};
use safezone::{Request, SafeZone, Samples};

/// One period of a joint: command, step, samples, extrema. None where something is refused.
#[inline(never)]
fn control(spec: PlannerSpec, position: f64, velocity: f64, action: f64) -> Option<State> {
    let zone = SafeZone::closed_form(Planner::try_from(spec).ok()?).ok()?;
    let mut samples = Samples::default();
    let sampled = SafeZone::sampled(*zone.planner(), &mut samples).ok()?;
    black_box(sampled.range(position, velocity));
    let command = zone.command(position, velocity, Request::Action(action));
    let step = zone.planner().ramp(position, velocity, command.velocity).ok()?;
    for tick in 0..50_u32 {
        black_box(step.state_at(f64::from(tick) * 1e-3));
    }
    black_box(step.extrema());
    let furthest = zone.planner().waypoint(position, velocity, command.velocity).ok()?;
    black_box(furthest.state_at(black_box(0.01)));
    Some(step.end())
}

fn run() {
    let interval = |min, max| Interval::new(black_box(min), black_box(max));
    let limits = Limits::try_from(LimitsSpec {
        position: interval(0.14, 0.50),
        velocity: interval(-0.15, 0.15),
        acceleration: interval(-1.0, 1.0),
        jerk: interval(-100.0, 100.0),
    });
    let shape = if black_box(true) { Shape::Smoothstep } else { Shape::SineQuintic };
    let timing = if black_box(true) { Timing::Stretched } else { Timing::Fastest };
    if let Ok(limits) = limits {
        let spec = PlannerSpec { limits, shape, timing, period: black_box(0.05) };
        black_box(control(spec, black_box(0.3), black_box(0.1), black_box(1.0)));
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    run();
}

/// The entry that the linker looks for.
#[cfg(target_os = "none")]
#[expect(unsafe_code, reason = "an exported name is an unsafe attribute; it exists once, here")]
#[unsafe(no_mangle)]
extern "C" fn _start() -> ! {
    loop {
        run();
    }
}

#[cfg(target_os = "none")]
#[panic_handler]
fn halt(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {
        core::hint::spin_loop();
    }
}
