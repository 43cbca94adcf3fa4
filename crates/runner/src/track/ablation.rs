//! What the jerk-bounded generator is for: the same actions of a policy, sent to the controllers in four ways.

use std::fmt::Write as _;

use anyhow::Result;
use jbtg::Shape;
use serde::{Deserialize, Serialize};

use super::play::{Ending, play};
use super::scenario::Scenario;
use super::setup::{Law, Setup, Stage};
use crate::course::Profile;
use crate::motion::Motion;

/// The scenario whose actions are played.
const SCENARIO: &str = "policy";

/// Vibration is what lies above this frequency \[Hz\]: ten times slower motion is what a policy asks for.
const VIBRATION_HZ: f64 = 5.0;

/// The ways to change velocity, from the crudest to the system's own.
const WAYS: [(&str, Profile, Option<Shape>); 4] = [
    ("step", Profile::Step, None),
    ("trapezoid", Profile::Trapezoid, None),
    ("sine-quintic", Profile::JerkBounded, Some(Shape::SineQuintic)),
    ("smoothstep", Profile::JerkBounded, Some(Shape::Smoothstep)),
];

/// Numbers of one way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AblationResult {
    /// Its name.
    pub profile: String,
    /// How the run ended.
    pub ending: Ending,
    /// Largest position error of a moving joint \[m\].
    pub position_error_max_m: f64,
    /// Largest velocity error of a moving joint [m/s].
    pub velocity_error_max: f64,
    /// Largest effort of a moving joint, as a share of its limit.
    pub effort_peak_share: f64,
    /// Largest actual jerk of a moving joint [m/s³].
    pub jerk_max: f64,
    /// Root mean square of the actual jerk, the worst moving joint's [m/s³].
    pub jerk_rms: f64,
    /// Work that the actuators did \[J\].
    pub work_j: f64,
    /// Root mean square of the boom's angular acceleration above 5 Hz [rad/s²].
    pub boom_vibration: f64,
    /// Root mean square of the stick's angular acceleration above 5 Hz [rad/s²].
    pub stick_vibration: f64,
    /// Largest displacement of the tip by the held joints \[m\].
    pub held_joint_tip_error_m: f64,
    /// Share of commands that an effort limit cut, the worst joint's.
    pub saturation_rate: f64,
    /// Ticks beyond the actuators' acceleration limits.
    pub acceleration_violations: u64,
    /// Ticks beyond the actuators' jerk limits.
    pub jerk_violations: u64,
}

/// One way with its motion, for a picture.
#[derive(Clone, Debug)]
pub struct Run {
    /// Its numbers.
    pub result: AblationResult,
    /// Time, lift velocity, acceleration, effort, and boom angular acceleration above 5 Hz, at every tick.
    pub samples: Vec<[f64; 5]>,
}

/// Angular acceleration of one boom, and what of it lies above [`VIBRATION_HZ`].
#[derive(Clone, Copy, Debug, Default)]
struct Vibration {
    last_velocity: Option<f64>,
    slow: [f64; 2],
    squares: f64,
    ticks: u64,
    present: f64,
}

impl Vibration {
    /// After a tick of `period` \[s\]; a second-order low pass of two equal poles is taken off the acceleration.
    fn add(&mut self, velocity: f64, period: f64) {
        let last = self.last_velocity.replace(velocity).unwrap_or(velocity);
        let acceleration = (velocity - last) / period;
        let share = 1.0 - (-std::f64::consts::TAU * VIBRATION_HZ * period).exp();
        self.slow[0] += share * (acceleration - self.slow[0]);
        self.slow[1] += share * (self.slow[0] - self.slow[1]);
        self.present = acceleration - self.slow[1];
        self.squares += self.present * self.present;
        self.ticks += 1;
    }

    fn rms(&self) -> f64 {
        (self.squares / self.ticks.max(1) as f64).sqrt()
    }
}

/// Plays the recorded actions in all ways, with the adaptive law and its feedforward.
///
/// # Errors
/// A file is missing or wrong.
pub fn run() -> Result<Vec<Run>> {
    WAYS.into_iter().map(|(name, profile, shape)| one(name, profile, shape)).collect()
}

fn one(name: &str, profile: Profile, shape: Option<Shape>) -> Result<Run> {
    let scenario = Scenario::read(SCENARIO)?;
    let stage =
        Stage::load(&scenario, Setup { profile, shape, lyapunov: false, ..Setup::of(Law::Adaptive) })?;
    let gains = stage.gains(&scenario)?;
    let machine = &stage.machine;
    let (moving, booms) = (machine.moving().to_vec(), machine.booms().to_vec());
    let period = machine.rates().tick_period();
    let mut data = machine.model().new_data();
    let mut vibration = vec![Vibration::default(); booms.len()];
    let mut last_acceleration = vec![0.0; moving.len()];
    let (mut jerk_max, mut samples) = (0.0_f64, Vec::new());
    let mut before = 0.0;
    let mut see = |motion: &Motion, time: f64| {
        if motion.time() < before {
            // The next episode starts from rest.
            for vibration in &mut vibration {
                vibration.last_velocity = None;
            }
            last_acceleration.fill(0.0);
        }
        before = motion.time();
        if machine.model().update_kinematics(&mut data, motion.position(), motion.velocity()).is_err() {
            return;
        }
        for (vibration, &boom) in vibration.iter_mut().zip(&booms) {
            vibration.add(data.tree_velocity()[boom], period);
        }
        for (last, &joint) in last_acceleration.iter_mut().zip(&moving) {
            let acceleration = motion.acceleration()[joint];
            jerk_max = jerk_max.max((acceleration - *last).abs() / period);
            *last = acceleration;
        }
        let lift = moving[0];
        samples.push([
            time,
            motion.velocity()[lift],
            motion.acceleration()[lift],
            motion.exerted()[lift],
            vibration[0].present,
        ]);
    };
    let played = play(&scenario, &stage, &gains, &mut see)?;
    let joints = || moving.iter().map(|&joint| (&played.joints[joint], &machine.joints()[joint]));
    let worst = |value: &dyn Fn(&super::measures::JointMeasures) -> f64| {
        joints().map(|(seen, _)| value(seen)).fold(0.0, f64::max)
    };
    let result = AblationResult {
        profile: name.to_owned(),
        ending: played.ending.clone(),
        position_error_max_m: worst(&|seen| seen.position_error.max),
        velocity_error_max: worst(&|seen| seen.velocity_error.max),
        effort_peak_share: joints()
            .map(|(seen, joint)| seen.effort_peak / joint.effort_limit)
            .fold(0.0, f64::max),
        jerk_max,
        jerk_rms: worst(&|seen| seen.jerk_rms),
        work_j: joints().map(|(seen, _)| seen.work).sum(),
        boom_vibration: vibration.first().map_or(0.0, Vibration::rms),
        stick_vibration: vibration.get(1).map_or(0.0, Vibration::rms),
        held_joint_tip_error_m: played.held_joint_tip_error,
        saturation_rate: worst(&|seen| seen.saturation_rate),
        acceleration_violations: played.joints.iter().map(|seen| seen.violations.acceleration).sum(),
        jerk_violations: played.joints.iter().map(|seen| seen.violations.jerk).sum(),
    };
    Ok(Run { result, samples })
}

/// The numbers as a table.
#[must_use]
pub fn table(runs: &[Run]) -> String {
    let mut text = format!(
        "{:<13} {:>8} {:>9} {:>8} {:>11} {:>10} {:>8} {:>10} {:>11} {:>8} {:>7} {:>7} {:>7}\n",
        "profile",
        "pos mm",
        "vel mm/s",
        "effort %",
        "jerk max",
        "jerk rms",
        "work J",
        "boom >5Hz",
        "stick >5Hz",
        "held mm",
        "sat %",
        "a>",
        "j>"
    );
    for Run { result, .. } in runs {
        let _ = writeln!(
            text,
            "{:<13} {:>8.3} {:>9.2} {:>8.1} {:>11.1} {:>10.2} {:>8.0} {:>10.4} {:>11.4} {:>8.3} {:>7.2} {:>7} {:>7}",
            result.profile,
            1e3 * result.position_error_max_m,
            1e3 * result.velocity_error_max,
            100.0 * result.effort_peak_share,
            result.jerk_max,
            result.jerk_rms,
            result.work_j,
            result.boom_vibration,
            result.stick_vibration,
            1e3 * result.held_joint_tip_error_m,
            100.0 * result.saturation_rate,
            result.acceleration_violations,
            result.jerk_violations,
        );
    }
    text
}
