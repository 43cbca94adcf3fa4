//! A scenario, played.

use anyhow::{Context, Result};
use safezone::Request;
use serde::{Deserialize, Serialize};

use super::lyapunov::{Lyapunov, Watch};
use super::measures::{JointMeasures, Meter, Sample};
use super::reference::{parts, stop};
use super::scenario::Scenario;
use super::setup::{LawGains, Stage};
use crate::config::Rates;
use crate::governor::Overload;
use crate::motion::Motion;

/// How a run ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Ending {
    /// The reference was followed to its end.
    Completed,
    /// An actuator had less effort than the load takes: the run ended where its brakes would be set.
    Overload(Overload),
    /// The simulated crane left the range in which its loops close.
    Broken {
        /// When \[s\].
        time: f64,
        /// What happened.
        cause: String,
    },
}

/// The result of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Played {
    /// How it ended.
    pub ending: Ending,
    /// When \[s\].
    pub duration: f64,
    /// Whether the effort that was left could hold the crane at rest, wherever it was.
    pub holdable: bool,
    /// By joint, in the order of the actuators.
    pub joints: Vec<JointMeasures>,
    /// V of the paper by joint, of the adaptive law.
    pub lyapunov: Vec<Option<Lyapunov>>,
    /// Largest displacement of the tip by the errors of all held joints together \[m\].
    pub held_joint_tip_error: f64,
    /// Policy steps in which the governor held the reference to gentle accelerations.
    pub gentle_steps: u64,
}

/// Is shown the motion after every tick, and how long a tick is \[s\].
pub trait Observer {
    /// After a tick; `time` since the scenario began \[s\].
    fn see(&mut self, motion: &Motion, time: f64);
}

impl<F: FnMut(&Motion, f64)> Observer for F {
    fn see(&mut self, motion: &Motion, time: f64) {
        self(motion, time);
    }
}

struct Player<'a> {
    scenario: &'a Scenario,
    stage: &'a Stage,
    meters: Vec<Meter>,
    watch: Watch,
    rates: Rates,
    before: f64,
    last_moved: f64,
    tick: u32,
    holdable: bool,
    /// Scratch: the tip's, at the last tick.
    jacobian: Vec<f64>,
    trouble: Option<anyhow::Error>,
}

/// Plays `scenario` on `stage` with `gains`; `observer` sees every tick.
///
/// Parts of a reference follow one another, each from its own start; forces and faults go by the time since the
/// beginning of each part.
///
/// # Errors
/// A name in the scenario is wrong, gains are not stable, or the crane cannot be held at a start. What happens to the
/// crane after that is a result and no error.
pub fn play(
    scenario: &Scenario,
    stage: &Stage,
    gains: &LawGains,
    observer: &mut dyn Observer,
) -> Result<Played> {
    let machine = &stage.machine;
    let rates = machine.rates();
    let mut motion = stage.motion(scenario, gains)?;
    let mut player = Player {
        scenario,
        stage,
        meters: vec![Meter::default(); machine.joints().len()],
        watch: Watch::new(&motion, machine.model(), rates.controller_period(), stage.setup().lyapunov),
        rates,
        before: 0.0,
        last_moved: 0.0,
        tick: 0,
        holdable: true,
        jacobian: vec![0.0; 6 * machine.joints().len()],
        trouble: None,
    };
    let mut actions = vec![Request::Missing; machine.moving().len()];
    let mut ending = Ending::Completed;
    let settle = (scenario.settle / rates.policy_period()).round() as u32;
    'parts: for mut part in parts(&scenario.reference, machine)? {
        player.watch.start_part();
        motion.start(&part.start).context("at the start of the scenario")?;
        let mut rest = settle;
        loop {
            if !part.next(&motion, &mut actions)? {
                if rest == 0 {
                    break;
                }
                rest -= 1;
                stop(&motion, &mut actions);
            }
            if let Err(error) = motion.advance_seen(&actions, |motion| player.see(motion, observer)) {
                let cause = crate::command::one_line(&error);
                ending = Ending::Broken { time: player.before + motion.time(), cause };
                break 'parts;
            }
            if let Some(error) = player.trouble.take() {
                return Err(error);
            }
            if let Some(overload) = motion.overload() {
                ending = Ending::Overload(overload);
                break 'parts;
            }
        }
        player.before += motion.time();
        player.last_moved -= motion.time();
    }
    let duration =
        if matches!(ending, Ending::Completed) { player.before } else { player.before + motion.time() };
    let calm = duration + if matches!(ending, Ending::Completed) { player.last_moved } else { 0.0 };
    let period = rates.tick_period();
    Ok(Played {
        ending,
        duration,
        holdable: player.holdable,
        joints: player.meters.iter().map(|meter| meter.result(calm, duration, period)).collect(),
        lyapunov: player.watch.results(),
        gentle_steps: motion.gentle_periods(),
        held_joint_tip_error: motion.take_evidence().held_joint_tip_error,
    })
}

impl Player<'_> {
    fn see(&mut self, motion: &Motion, observer: &mut dyn Observer) {
        let machine = &self.stage.machine;
        let time = self.before + motion.time();
        let (_, _, commands) = motion.commands();
        for (joint, (setup, meter)) in machine.joints().iter().zip(&mut self.meters).enumerate() {
            let sample = Sample {
                time,
                period: self.rates.tick_period(),
                position: motion.position()[joint],
                velocity: motion.velocity()[joint],
                acceleration: motion.acceleration()[joint],
                wanted: motion.wanted()[joint],
                exerted: motion.exerted()[joint],
                saturation: commands[joint].saturation,
            };
            meter.add(&sample, &setup.limits);
            if sample.wanted.velocity.abs() > 0.0 {
                self.last_moved = motion.time();
            }
        }
        if motion.time() <= self.scenario.last_event() + self.rates.tick_period() {
            self.last_moved = motion.time();
        }
        self.tick = (self.tick + 1) % self.rates.controller_divider;
        if self.tick == 0 {
            if let Err(error) = self.watch.look(motion, machine.model()) {
                self.trouble.get_or_insert(error);
            }
            self.holdable &= self.can_be_held(motion);
            if self.stage.setup().tip
                && let Err(error) = self.measure_held_joints(motion)
            {
                self.trouble.get_or_insert(error);
            }
        }
        observer.see(motion, time);
    }

    /// What the error of every held joint alone makes of the tip: its column of the Jacobian.
    fn measure_held_joints(&mut self, motion: &Motion) -> Result<()> {
        let machine = &self.stage.machine;
        let joints = machine.joints().len();
        machine.model().tip_jacobian(motion.dynamics(), &mut self.jacobian)?;
        for &joint in machine.held() {
            let error = motion.position()[joint] - motion.wanted()[joint].position;
            let lever = (0..3).map(|axis| self.jacobian[axis * joints + joint].powi(2)).sum::<f64>().sqrt();
            self.meters[joint].add_tip_error(lever * error.abs());
        }
        Ok(())
    }

    /// Whether what is left of every actuator's effort exceeds the load at rest here.
    fn can_be_held(&self, motion: &Motion) -> bool {
        let load = motion.dynamics().gravity_effort();
        let left = |joint: usize| {
            let limits = self.stage.specs()[joint].effort_limits;
            let faults = self.scenario.faults.iter().filter(|fault| {
                fault.joint == self.stage.machine.joints()[joint].name && fault.at <= motion.time()
            });
            faults.fold(limits.upper(), |limit, fault| limit * fault.share)
        };
        load.iter().enumerate().all(|(joint, load)| load.abs() <= left(joint))
    }
}
