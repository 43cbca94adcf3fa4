//! The states of one joint, tick by tick, for a control loop.

use core::num::NonZeroU32;

use crate::{Planner, RampError, State, Trajectory};

/// Where the motion of a [`Sample`] comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Origin {
    /// A velocity that was commanded in time.
    Command,
    /// No velocity was there when the period began, so the joint brakes, or rests.
    Brake,
}

/// What [`Sampler::advance`] yields at every tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Where the joint should be at this tick.
    pub state: State,
    /// Why it is there.
    pub origin: Origin,
    /// Whether this tick ends a period: without a command before the next tick the joint brakes.
    pub is_due: bool,
}

/// Turns a velocity per period into a state per tick, for one joint and for ever.
///
/// Time is a whole number of ticks, so nothing drifts: the state at the last tick of a period is the commanded end
/// state bit for bit, and the next period starts from those bits.
///
/// A velocity may be commanded at any time. It is planned from the end of the running period; of several commands in
/// one period the last counts. If none has come when a period begins, the joint brakes in that period: towards zero by
/// as much as one period allows, and so on until it rests or a command comes, which then takes effect one period
/// later than it should have. `safezone` keeps its limits with exactly this way of braking, so a joint whose commands
/// came out of its ranges stays inside its position limits when they stop coming.
///
/// # Examples
/// ```
/// # use core::num::NonZeroU32;
/// # use jbtg::{Interval, Limits, Planner, PlannerSpec, Sampler, Shape, SymmetricLimits, Timing};
/// # let limits = Limits::try_from(SymmetricLimits {
/// #     position: Interval::new(0.14, 0.50), velocity: 0.15, acceleration: 1.0, jerk: 100.0,
/// # })?;
/// # let planner = Planner::try_from(PlannerSpec {
/// #     limits, shape: Shape::Smoothstep, timing: Timing::Stretched, period: 0.05,
/// # })?;
/// // 20 Hz commands, 1 kHz samples
/// let mut sampler = Sampler::at_rest(planner, NonZeroU32::new(50).ok_or("no ticks")?, 0.30)?;
/// sampler.command(0.03)?;
/// for _ in 0..50 {
///     let sample = sampler.advance();
///     assert!(sample.state.acceleration <= 1.0);
/// }
/// assert_eq!(sampler.state().velocity, 0.03);
/// sampler.advance(); // nothing was commanded
/// assert!(sampler.upcoming().velocity < 0.03);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Sampler {
    planner: Planner,
    ticks: NonZeroU32,
    /// Of the running period, in 1..=`ticks`; `ticks` before the first.
    tick: u32,
    origin: Origin,
    running: Trajectory,
    commanded: Option<Trajectory>,
}

impl Sampler {
    /// A sampler of `ticks` samples per period of `planner`, for a joint at rest at `position` [rad or m].
    ///
    /// # Errors
    /// [`RampError::NotFinite`] if `position` is NaN or infinite.
    pub fn at_rest(planner: Planner, ticks: NonZeroU32, position: f64) -> Result<Self, RampError> {
        let running = planner.ramp(position, 0.0, 0.0)?;
        Ok(Self { planner, ticks, tick: ticks.get(), origin: Origin::Brake, running, commanded: None })
    }

    /// Commands the `velocity` at which the next period ends [rad/s or m/s].
    ///
    /// # Errors
    /// Those of [`Planner::ramp`]: [`RampError::Unreachable`] with what is reachable from [`Sampler::upcoming`]. The
    /// sampler is then as it was, an earlier command for the same period included.
    pub fn command(&mut self, velocity: f64) -> Result<(), RampError> {
        let State { position, velocity: from, .. } = self.upcoming();
        self.commanded = Some(self.planner.ramp(position, from, velocity)?);
        Ok(())
    }

    /// [`Sampler::command`] of the reachable velocity nearest to `velocity`; returns it.
    ///
    /// # Errors
    /// [`RampError::NotFinite`] for a NaN or an infinity.
    pub fn command_saturated(&mut self, velocity: f64) -> Result<f64, RampError> {
        let State { position, velocity: from, .. } = self.upcoming();
        let step = self.planner.ramp_saturated(position, from, velocity)?;
        self.commanded = Some(step);
        Ok(step.end().velocity)
    }

    /// Goes to the next tick.
    pub fn advance(&mut self) -> Sample {
        if self.is_due() {
            let State { position, velocity, .. } = self.running.end();
            (self.running, self.origin) = match self.commanded.take() {
                Some(step) => (step, Origin::Command),
                None => (self.planner.brake(position, velocity), Origin::Brake),
            };
            self.tick = 0;
        }
        self.tick += 1;
        Sample { state: self.state(), origin: self.origin, is_due: self.is_due() }
    }

    /// State at the present tick; before the first, the state of rest.
    #[must_use]
    pub fn state(&self) -> State {
        if self.is_due() {
            self.running.end()
        } else {
            let share = f64::from(self.tick) / f64::from(self.ticks.get());
            self.running.state_at(share * self.planner.period())
        }
    }

    /// Whether the running period ends at the present tick, so that the next one needs a command.
    #[must_use]
    pub const fn is_due(&self) -> bool {
        self.tick == self.ticks.get()
    }

    /// Whether the next period has its command.
    #[must_use]
    pub const fn is_commanded(&self) -> bool {
        self.commanded.is_some()
    }

    /// State at the end of the running period: where the next command starts from. Its range of safe velocities is
    /// that of this position and velocity.
    #[must_use]
    pub const fn upcoming(&self) -> State {
        self.running.end()
    }

    /// The planner of every period.
    #[must_use]
    pub const fn planner(&self) -> &Planner {
        &self.planner
    }

    /// Ticks per period.
    #[must_use]
    pub const fn ticks(&self) -> NonZeroU32 {
        self.ticks
    }
}
