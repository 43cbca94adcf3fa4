//! One velocity change, sampled.

use std::fmt::Write as _;

use anyhow::{Context, Result, ensure};
use jbtg::{Interval, Limits, Planner, PlannerSpec, Shape, State, SymmetricLimits, Timing};

/// Most samples of one profile.
const MAX_SAMPLES: f64 = 1e8;

/// Half the position interval of a joint that may go anywhere [rad or m].
const FAR: f64 = 1e6;

/// A velocity change under symmetric limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfileRequest {
    /// Velocity at the start [rad/s or m/s].
    pub v1: f64,
    /// Velocity at the end [rad/s or m/s].
    pub v2: f64,
    /// Duration \[s\].
    pub dt: f64,
    /// Velocity limit [rad/s or m/s].
    pub vmax: f64,
    /// Acceleration limit [rad/s² or m/s²].
    pub amax: f64,
    /// Jerk limit [rad/s³ or m/s³].
    pub jmax: f64,
    /// Shape of the acceleration ramps.
    pub shape: Shape,
    /// How the change is spread over the duration.
    pub timing: Timing,
    /// Samples per second.
    pub hz: f64,
}

/// The profile as CSV: `t,position,velocity,acceleration,jerk`, from position 0, both ends included.
///
/// # Errors
/// A limit is none, the duration is too short, or the change cannot be made in it; the message then says what can.
pub fn profile(request: &ProfileRequest) -> Result<String> {
    let ProfileRequest { v1, v2, dt, vmax, amax, jmax, shape, timing, hz } = *request;
    ensure!(hz.is_finite() && hz > 0.0, "--hz must be finite and > 0, got {hz}");
    let limits = Limits::try_from(SymmetricLimits {
        position: Interval::new(-FAR, FAR),
        velocity: vmax,
        acceleration: amax,
        jerk: jmax,
    })?;
    let planner = Planner::try_from(PlannerSpec { limits, shape, timing, period: dt })
        .context("--dt, --amax and --jmax do not fit together")?;
    if planner.is_period_short() {
        tracing::warn!(dt, "shorter than three ramps: much of the acceleration goes unused");
    }
    let trajectory = planner.ramp(0.0, v1, v2)?;
    ensure!(dt * hz <= MAX_SAMPLES, "--dt {dt} at --hz {hz} is more than {MAX_SAMPLES:e} samples");
    let mut csv = String::from("t,position,velocity,acceleration,jerk\n");
    let mut sample = |t: f64, state: State| {
        let State { position, velocity, acceleration, jerk } = state;
        writeln!(csv, "{t},{position},{velocity},{acceleration},{jerk}").context("memory cannot be written")
    };
    // The last sample is the end itself, which a whole number of steps may miss by rounding.
    let inner = (dt * hz - 1e-6).ceil().max(0.0) as u64;
    for tick in 0..inner {
        let t = tick as f64 / hz;
        sample(t, trajectory.state_at(t))?;
    }
    sample(dt, trajectory.end())?;
    Ok(csv)
}
