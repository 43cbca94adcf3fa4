//! A scenario: one RON file with every number of it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use serde::{Deserialize, Serialize};

use crate::config::read_ron;
use crate::surroundings::{Sensors, Timing, TipForce};

/// Folder of the scenarios.
pub const FOLDER: &str = "assets/scenarios";

/// A scenario as written down.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// Version of the file's format.
    pub schema: u32,
    /// What it is for, in a sentence.
    pub summary: String,
    /// The configuration that it starts from.
    pub config: PathBuf,
    /// Which entry of the configuration's plants the crane has, and the controllers believe it has.
    pub plant: String,
    /// Gains of every law, for that plant.
    pub gains: GainFiles,
    /// Integration steps per step of the configuration: a light plant with dry friction needs shorter ones.
    pub substeps: u32,
    /// What moves.
    pub reference: Reference,
    /// Time at the end in which the reference brakes and the motion settles \[s\].
    pub settle: f64,
    /// What the crane really is.
    pub truth: Truth,
    /// Forces at the tip.
    pub forces: Vec<TipForce>,
    /// Shares of the actuators' effort limits that there are, and that the controllers know of, by joint.
    pub effort_limits: BTreeMap<String, f64>,
    /// Actuators that lose part of what they are commanded.
    pub faults: Vec<Fault>,
    /// What sensors add.
    pub sensors: Sensors,
    /// Whether the controllers' computer is on time.
    pub timing: Timing,
    /// Seed of all noise.
    pub seed: u64,
}

/// Gain files, one for each law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GainFiles {
    /// Of the adaptive law.
    pub adaptive: PathBuf,
    /// Of PD.
    pub pd: PathBuf,
    /// Of PID.
    pub pid: PathBuf,
    /// Of computed torque.
    pub computed_torque: PathBuf,
}

/// What the crane is, where its controllers believe otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Truth {
    /// Mass at the tip \[kg\]; the controllers know of none.
    pub payload: f64,
    /// Share of the plant's Coulomb and viscous friction that there is.
    pub friction: f64,
    /// Share of the plant's reflected inertia that there is.
    pub armature: f64,
}

/// An actuator that loses force.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fault {
    /// Which joint.
    pub joint: String,
    /// When \[s\].
    pub at: f64,
    /// Share that is left.
    pub share: f64,
}

/// What the moving joints are to do. `start` is their position at the start \[m\], in the order of the actions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Reference {
    /// The actions of recorded episodes, one after another.
    Episodes(Vec<PathBuf>),
    /// Sines of growing frequency over the whole of the safe range; each joint by a factor faster than the one before.
    Chirp {
        /// Positions at the start \[m\].
        start: Vec<f64>,
        /// Duration \[s\].
        duration: f64,
        /// Frequency of the first joint at the start \[Hz\].
        from_hz: f64,
        /// Frequency of the first joint at the end \[Hz\].
        to_hz: f64,
        /// Ratio of a joint's frequency to that of the joint before it.
        ratio: f64,
    },
    /// The tip round a square in the crane's plane.
    Square {
        /// Positions at the start \[m\]; the tip is then at the first corner.
        start: Vec<f64>,
        /// Length of a side \[m\]: away from the column first, then up, back, and down.
        side: f64,
        /// Speed along the sides [m/s].
        speed: f64,
        /// Times round.
        rounds: u32,
    },
    /// Nothing: every joint is held.
    Rest {
        /// Positions at the start \[m\].
        start: Vec<f64>,
        /// Duration \[s\].
        duration: f64,
    },
}

/// Recorded actions of a policy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recording {
    /// Version of the file's format.
    pub schema: u32,
    /// Where it comes from.
    pub source: String,
    /// Period of the policy \[s\].
    pub period: f64,
    /// Position of every moving joint at the start \[m\].
    pub start: BTreeMap<String, f64>,
    /// One action for each moving joint, in the order of `joints`, per policy step.
    pub joints: Vec<String>,
    /// The actions, in [-1, 1].
    pub actions: Vec<Vec<f32>>,
}

impl Scenario {
    /// Reads and checks the scenario `name` of the scenarios' folder.
    ///
    /// # Errors
    /// No file has that name (the nearest one is named), it is no RON of this form, or a value is out of range; the
    /// message names file, field and cause.
    pub fn read(name: &str) -> Result<Self> {
        let path = Path::new(FOLDER).join(format!("{name}.ron"));
        if !path.is_file() {
            let known = names()?;
            let known: Vec<&str> = known.iter().map(String::as_str).collect();
            let hint = crate::suggest::nearest(name, &known).map(|near| format!("; did you mean '{near}'?"));
            bail!(
                "no scenario is called '{name}'{} (there are {}, and all)",
                hint.unwrap_or_default(),
                known.join(", ")
            );
        }
        Self::read_file(&path)
    }

    /// Reads and checks the scenario `name` of those that gains are tuned on.
    ///
    /// # Errors
    /// The file is missing, is no RON of this form, or a value is out of range.
    pub fn read_training(name: &str) -> Result<Self> {
        Self::read_file(&Path::new(FOLDER).join("training").join(format!("{name}.ron")))
    }

    fn read_file(path: &Path) -> Result<Self> {
        let scenario: Self = read_ron(path)?;
        scenario.check().with_context(|| path.display().to_string())?;
        Ok(scenario)
    }

    fn check(&self) -> Result<()> {
        ensure!(self.schema == 1, "schema is {}, this program reads schema 1", self.schema);
        ensure!(self.substeps >= 1, "substeps must be at least 1, got {}", self.substeps);
        let not_negative = [
            ("settle", self.settle),
            ("truth.payload", self.truth.payload),
            ("truth.friction", self.truth.friction),
            ("truth.armature", self.truth.armature),
            ("sensors.position_noise", self.sensors.position_noise),
            ("sensors.velocity_noise", self.sensors.velocity_noise),
            ("sensors.position_resolution", self.sensors.position_resolution),
            ("sensors.velocity_resolution", self.sensors.velocity_resolution),
        ];
        for (field, value) in not_negative {
            ensure!(value.is_finite() && value >= 0.0, "{field} must be finite and ≥ 0, got {value}");
        }
        for (field, value) in [("timing.late", self.timing.late), ("timing.dropped", self.timing.dropped)] {
            ensure!((0.0..=1.0).contains(&value), "{field} must be in [0, 1], got {value}");
        }
        let Timing { late, dropped } = self.timing;
        ensure!(late + dropped <= 1.0, "timing: late and dropped together must be at most 1");
        for (joint, &share) in &self.effort_limits {
            ensure!(share > 0.0 && share <= 1.0, "effort_limits of {joint} must be in (0, 1], got {share}");
        }
        for fault in &self.faults {
            let Fault { joint, at, share } = fault;
            ensure!(at.is_finite() && *at >= 0.0, "faults of {joint}: at must be finite and ≥ 0, got {at}");
            ensure!((0.0..=1.0).contains(share), "faults of {joint}: share must be in [0, 1], got {share}");
        }
        for (index, force) in self.forces.iter().enumerate() {
            ensure!(
                0.0 <= force.from && force.from < force.until && force.force.iter().all(|f| f.is_finite()),
                "forces, entry {index}: from must be ≥ 0 and before until, and the force finite"
            );
        }
        let positive = |field: &str, value: f64| {
            ensure!(
                value.is_finite() && value > 0.0,
                "reference.{field} must be finite and > 0, got {value}"
            );
            Ok(())
        };
        match &self.reference {
            Reference::Episodes(files) => ensure!(!files.is_empty(), "reference names no episode"),
            Reference::Chirp { duration, from_hz, to_hz, ratio, .. } => {
                positive("duration", *duration)?;
                positive("from_hz", *from_hz)?;
                positive("to_hz", *to_hz)?;
                positive("ratio", *ratio)?;
            }
            Reference::Square { side, speed, .. } => {
                positive("side", *side)?;
                positive("speed", *speed)?;
            }
            Reference::Rest { duration, .. } => positive("duration", *duration)?,
        }
        Ok(())
    }

    /// The last moment at which a force or a fault sets in or ends \[s\].
    pub(crate) fn last_event(&self) -> f64 {
        let forces = self.forces.iter().flat_map(|force| [force.from, force.until]);
        forces.chain(self.faults.iter().map(|fault| fault.at)).fold(0.0, f64::max)
    }
}

/// Names of all scenarios, in order.
///
/// # Errors
/// The folder cannot be read.
pub fn names() -> Result<Vec<String>> {
    let folder = || format!("cannot list {FOLDER}");
    let mut names = Vec::new();
    for entry in std::fs::read_dir(FOLDER).with_context(folder)? {
        let path = entry.with_context(folder)?.path();
        if path.extension().is_some_and(|extension| extension == "ron") {
            names.extend(path.file_stem().and_then(|stem| stem.to_str()).map(str::to_owned));
        }
    }
    names.sort();
    Ok(names)
}

impl Recording {
    /// Reads a recorded episode for a machine whose moving joints are `joints`, acting every `period` \[s\].
    ///
    /// # Errors
    /// The file is missing, is no RON of this form, or was recorded for another machine; the message names the file.
    pub fn read(path: &Path, joints: &[&str], period: f64) -> Result<Self> {
        let recording: Self = read_ron(path)?;
        let check = || {
            ensure!(recording.schema == 1, "schema is {}, this program reads schema 1", recording.schema);
            ensure!(recording.joints == joints, "joints are {:?}, must be {joints:?}", recording.joints);
            ensure!(
                (recording.period - period).abs() < 1e-12,
                "period is {}, must be {period}",
                recording.period
            );
            for joint in joints {
                ensure!(recording.start.contains_key(*joint), "start has no {joint}");
            }
            for (step, action) in recording.actions.iter().enumerate() {
                ensure!(action.len() == joints.len(), "actions, entry {step}: one number for each joint");
            }
            Ok(())
        };
        check().with_context(|| path.display().to_string())?;
        Ok(recording)
    }
}
