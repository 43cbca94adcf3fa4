//! The result of runs as JSON, as text and as CSV.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::{Deserialize, Serialize};

use super::lyapunov::Lyapunov;
use super::measures::{JointMeasures, Violations};
use super::play::{Ending, Played};
use super::setup::{Setup, Stage};
use crate::motion::Motion;

/// Samples of the CSV per second.
const CSV_HZ: u32 = 200;

/// The result of one run; its fields are the keys of the JSON.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// The scenario's name.
    pub scenario: String,
    /// The law's name.
    pub controller: String,
    /// What its feedforward knows.
    pub feedforward: String,
    /// How it ended.
    pub ending: Ending,
    /// When it ended \[s\].
    pub duration_s: f64,
    /// Whether the effort that was left could hold the crane at rest, wherever it was.
    pub load_can_be_held: bool,
    /// Largest displacement of the tip by the errors of all held joints together \[m\].
    pub held_joint_tip_error_m: f64,
    /// Ticks beyond a limit of an actuator, all joints together.
    pub violations: Violations,
    /// Policy steps in which the governor held the reference to gentle accelerations.
    pub gentle_steps: u64,
    /// By joint.
    pub joints: BTreeMap<String, JointReport>,
}

/// The result of one joint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct JointReport {
    /// What was measured.
    #[serde(flatten)]
    pub measures: JointMeasures,
    /// V of the paper: what the theorem allows and what was observed; of the adaptive law alone.
    pub lyapunov: Option<Lyapunov>,
}

/// Puts a run into its form.
#[must_use]
pub fn report(scenario: &str, setup: Setup, stage: &Stage, played: &Played) -> Report {
    let joints = stage.machine.joints().iter().zip(&played.joints).zip(&played.lyapunov);
    let joints = joints
        .map(|((joint, &measures), &lyapunov)| (joint.name.clone(), JointReport { measures, lyapunov }))
        .collect();
    let violations = played.joints.iter().fold(Violations::default(), |sum, joint| Violations {
        position: sum.position + joint.violations.position,
        velocity: sum.velocity + joint.violations.velocity,
        acceleration: sum.acceleration + joint.violations.acceleration,
        jerk: sum.jerk + joint.violations.jerk,
    });
    Report {
        scenario: scenario.to_owned(),
        controller: setup.law.name().to_owned(),
        feedforward: setup.knowledge.name().to_owned(),
        ending: played.ending.clone(),
        duration_s: played.duration,
        load_can_be_held: played.holdable,
        held_joint_tip_error_m: played.held_joint_tip_error,
        violations,
        gentle_steps: played.gentle_steps,
        joints,
    }
}

/// A table of runs, one line each: the worst moving joint's errors in mm and mm/s.
#[must_use]
pub fn table(reports: &[(Report, Vec<String>)]) -> String {
    let mut text = format!(
        "{:<22} {:<22} {:>9} {:>9} {:>8} {:>6} {:>5} {:>6} {:>6} {:>7} {:>7}  {}\n",
        "scenario",
        "controller",
        "pos mm",
        "vel mm/s",
        "held mm",
        "sat %",
        "gent",
        "x>",
        "v>",
        "a>",
        "j>",
        "ended"
    );
    for (report, moving) in reports {
        let worst = |value: &dyn Fn(&JointMeasures) -> f64| {
            let joints = moving.iter().filter_map(|name| report.joints.get(name));
            joints.map(|joint| value(&joint.measures)).fold(0.0, f64::max)
        };
        let ended = match &report.ending {
            Ending::Completed => "completed".to_owned(),
            Ending::Overload(overload) => format!("overload of {} at {:.2} s", overload.joint, overload.time),
            Ending::Broken { time, cause } => format!("broken at {time:.2} s: {cause}"),
        };
        let Violations { position, velocity, acceleration, jerk } = report.violations;
        let law = format!("{} ({})", report.controller, report.feedforward);
        let _ = writeln!(
            text,
            "{:<22} {:<22} {:>9.3} {:>9.2} {:>8.3} {:>6.2} {:>5} {:>6} {:>6} {:>7} {:>7}  {}",
            report.scenario,
            law,
            1e3 * worst(&|joint| joint.position_error.max),
            1e3 * worst(&|joint| joint.velocity_error.max),
            1e3 * report.held_joint_tip_error_m,
            100.0 * worst(&|joint| joint.saturation_rate),
            report.gentle_steps,
            position,
            velocity,
            acceleration,
            jerk,
            ended
        );
    }
    text
}

/// Writes down a run as it goes.
#[derive(Debug)]
pub struct Csv {
    text: String,
    every: u32,
    tick: u32,
}

impl Csv {
    /// For a stage's machine.
    #[must_use]
    pub fn new(stage: &Stage) -> Self {
        let mut text = "time".to_owned();
        for joint in stage.machine.joints() {
            for column in ["position", "velocity", "wanted_position", "wanted_velocity", "effort"] {
                let _ = write!(text, ",{}.{column}", joint.name);
            }
        }
        text.push('\n');
        let every = (stage.machine.rates().integration_hz / CSV_HZ).max(1);
        Self { text, every, tick: 0 }
    }

    /// After a tick.
    pub fn see(&mut self, motion: &Motion, time: f64) {
        self.tick = (self.tick + 1) % self.every;
        if self.tick != 0 {
            return;
        }
        let _ = write!(self.text, "{time:.6}");
        for (joint, wanted) in motion.wanted().iter().enumerate() {
            let _ = write!(
                self.text,
                ",{},{},{},{},{}",
                motion.position()[joint],
                motion.velocity()[joint],
                wanted.position,
                wanted.velocity,
                motion.exerted()[joint]
            );
        }
        self.text.push('\n');
    }

    /// What was written.
    #[must_use]
    pub fn finish(self) -> String {
        self.text
    }
}
