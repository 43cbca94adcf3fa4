//! What each generator does at a position limit, as a table: `cargo run --release -p peers`.
//!
//! A policy wants full speed towards the upper limit. *Replanned*: every period the generator is asked anew, from the
//! state that the last plan has reached. *Held*: it is asked once and the plan is followed to its end and beyond. Where
//! a generator reports an error, the joint follows what came with it: best braking, with rsruckig. Positions are watched every 0.1 ms; ours are exact extrema.
#![forbid(unsafe_code)]
#![expect(clippy::print_stdout, reason = "the table is the program's result")]

use jbtg::{Direction, Interval, Timing};
use peers::{Joint, RsRuckig, Ruckig, State, TELESCOPE, zone};

/// How long a joint is watched \[s\].
const WATCHED: f64 = 8.0;

/// A generator that plans from a state to a velocity.
trait Generator {
    fn plan(&mut self, state: State, target: f64) -> bool;
    fn at(&self, time: f64) -> State;
}

impl Generator for RsRuckig {
    fn plan(&mut self, state: State, target: f64) -> bool {
        RsRuckig::plan(self, state, target)
    }

    fn at(&self, time: f64) -> State {
        RsRuckig::at(self, time)
    }
}

impl Generator for Ruckig {
    fn plan(&mut self, state: State, target: f64) -> bool {
        Ruckig::plan(self, state, target)
    }

    fn at(&self, time: f64) -> State {
        Ruckig::at(self, time)
    }
}

/// What became of the joint.
#[derive(Clone, Copy, Debug)]
struct Outcome {
    /// Greatest position less the limit [m].
    excess: f64,
    errors: u32,
    /// Speed at the end [m/s].
    speed: f64,
}

/// Greatest position of a plan up to `end` \[s\].
fn follow(generator: &dyn Generator, end: f64) -> f64 {
    let ticks = (end * 1e4).round() as u32;
    (0..=ticks).map(|tick| generator.at(f64::from(tick) * 1e-4)[0]).fold(f64::NEG_INFINITY, f64::max)
}

fn replanned(generator: &mut dyn Generator, joint: Joint, period: f64) -> Outcome {
    let mut state = [0.30, 0.0, 0.0];
    let (mut most, mut errors) = (state[0], 0);
    for _ in 0..(WATCHED / period).round() as u32 {
        errors += u32::from(!generator.plan(state, joint.velocity));
        most = most.max(follow(generator, period));
        state = generator.at(period);
    }
    Outcome { excess: most - joint.position.max, errors, speed: state[1] }
}

fn held(generator: &mut dyn Generator, joint: Joint) -> Outcome {
    let errors = u32::from(!generator.plan([0.30, 0.0, 0.0], joint.velocity));
    let most = follow(generator, WATCHED);
    Outcome { excess: most - joint.position.max, errors, speed: generator.at(WATCHED)[1] }
}

/// Ours; held and replanned are the same, since every velocity is taken from the safe range of its own period.
fn ours(joint: Joint, timing: Timing, period: f64) -> Outcome {
    let zone = zone(joint, timing, period);
    let (mut position, mut velocity, mut most) = (0.30, 0.0, 0.30_f64);
    let mut errors = 0;
    for _ in 0..(WATCHED / period).round() as u32 {
        let next = zone.command(position, velocity, 1.0).velocity;
        match zone.planner().ramp(position, velocity, next) {
            Ok(step) => {
                most = most.max(step.extrema().position.max);
                (position, velocity) = (step.end().position, step.end().velocity);
            }
            Err(_) => errors += 1,
        }
    }
    Outcome { excess: most - joint.position.max, errors, speed: velocity }
}

/// Least time in which jbtg changes the velocity from rest by `change` [m/s] with zero acceleration at both ends \[s\].
fn least_time(joint: Joint, change: f64) -> f64 {
    let (mut short, mut long) = (1e-4, 10.0);
    for _ in 0..60 {
        let period = f64::sqrt(short * long);
        let reaches = zone(joint, Timing::Fastest, period).planner().reachable(0.0).max >= change;
        if reaches { long = period } else { short = period }
    }
    long
}

/// What smooth jerk and zero acceleration at every period's end cost.
fn print_costs() {
    println!();
    println!("Time for a velocity change from rest");
    println!("{:>12} {:>12} {:>12} {:>8}", "change", "ruckig", "jbtg", "longer");
    // Far from every position limit, and fast enough for all of them.
    let joint = Joint { position: Interval::new(-1e3, 1e3), velocity: 2.0, ..TELESCOPE };
    for change in [0.001, 0.005, 0.01, 0.15, 0.5, 1.0] {
        let mut peer = Ruckig::new(joint, 0.05);
        assert!(peer.plan([0.0; 3], change), "nothing is in the way");
        let (theirs, ours) = (peer.duration(), least_time(joint, change));
        println!(
            "{change:>8.3} m/s {:>9.2} ms {:>9.2} ms {:>7.1} %",
            1e3 * theirs,
            1e3 * ours,
            100.0 * (ours / theirs - 1.0)
        );
    }
    println!();
    println!("Acceleration left by zero acceleration at every period's end");
    for period in [0.2, 0.1, 0.05, 0.02, 0.01] {
        let zone = zone(TELESCOPE, Timing::Stretched, period);
        let share = zone.planner().authority(Direction::Increasing).share;
        println!("{:>6.0} ms {:>6.1} %", 1e3 * period, 100.0 * share);
    }
}

fn row(name: &str, period: f64, Outcome { excess, errors, speed }: Outcome) {
    println!("{name:<28} {:>6.0} ms {:>+12.6} mm {errors:>8} {speed:>9.4} m/s", 1e3 * period, 1e3 * excess);
}

fn main() {
    println!("Full speed towards the upper limit of the telescope for {WATCHED} s");
    println!(
        "{:<28} {:>9} {:>15} {:>8} {:>13}",
        "generator", "period", "beyond limit", "errors", "last speed"
    );
    for period in [0.05, 0.02] {
        row("safezone, stretched", period, ours(TELESCOPE, Timing::Stretched, period));
        row("safezone, fastest", period, ours(TELESCOPE, Timing::Fastest, period));
        row(
            "rsruckig, replanned",
            period,
            replanned(&mut RsRuckig::new(TELESCOPE, period), TELESCOPE, period),
        );
        row("rsruckig, held", period, held(&mut RsRuckig::new(TELESCOPE, period), TELESCOPE));
        row("ruckig, replanned", period, replanned(&mut Ruckig::new(TELESCOPE, period), TELESCOPE, period));
        row("ruckig, held", period, held(&mut Ruckig::new(TELESCOPE, period), TELESCOPE));
    }
    print_costs();
}
