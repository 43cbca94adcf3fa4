//! The configuration of a run: one RON file that alone reproduces it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow};
use serde::{Deserialize, Serialize, de::DeserializeOwned};

use crate::stage::Stage;
use crate::store;

/// The configuration that commands use when none is named.
pub const DEFAULT: &str = "assets/config/default.ron";

/// The learner's hyperparameters, read only by programs that learn.
#[cfg(feature = "training")]
pub type Learner = sac_burn::Config;
/// The learner's hyperparameters: carried along unread by programs that do not learn.
#[cfg(not(feature = "training"))]
pub type Learner = ron::Value;

/// The whole configuration as written down; every field is in the file, none has a default.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConfigSpec {
    /// Version of the file's format.
    pub schema: u32,
    /// Seed of everything that is drawn: networks, noise, starts and targets.
    pub seed: u64,
    /// The crane and its controller.
    pub crane: Crane,
    /// How often each part acts.
    pub rates: Rates,
    /// How the reference moves.
    pub motion: Motion,
    /// What is to be done.
    pub task: Task,
    /// What is rewarded.
    pub reward: Reward,
    /// When a stage is mastered.
    pub curriculum: Curriculum,
    /// The learner's hyperparameters.
    pub learner: Learner,
}

/// The crane: files relative to the project's root, and what it carries.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Crane {
    /// The tree of links and joints.
    pub urdf: PathBuf,
    /// The cylinder loops and the actuators with their limits.
    pub loops: PathBuf,
    /// Friction and reflected inertia of the actuators.
    pub plants: PathBuf,
    /// Which entry of `plants` is simulated.
    pub plant: String,
    /// Mass at the tip \[kg\], unknown to the controller.
    pub payload: f64,
    /// Gains of the adaptive controller.
    pub gains: PathBuf,
    /// What the controller knows of the crane.
    pub feedforward: Feedforward,
    /// Folder of the braking tables, one per joint.
    pub tables: PathBuf,
    /// Regions of the curriculum.
    pub regions: PathBuf,
}

/// What the controller knows of the crane beside its errors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Feedforward {
    /// Nothing: the paper's law.
    None,
    /// The effort that the reference needs by the model of the crane and its plant, without any payload.
    Nominal,
}

/// A method of integration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Integrator {
    /// First order, one evaluation of the dynamics; its positions run ahead of an accelerated joint.
    SemiImplicitEuler,
    /// The classical Runge-Kutta method of fourth order, four evaluations.
    Rk4,
}

/// Rates as integer dividers of one tick, so that nothing drifts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rates {
    /// Ticks per second: the rate of integration.
    pub integration_hz: u32,
    /// How the simulated crane is integrated over a tick.
    pub integrator: Integrator,
    /// The controller acts on every so many ticks.
    pub controller_divider: u32,
    /// The reference is sampled on every so many ticks.
    pub reference_divider: u32,
    /// The policy acts on every so many ticks.
    pub policy_divider: u32,
}

/// How the reference moves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// Shape of the acceleration ramps.
    pub shape: jbtg::Shape,
    /// How a velocity change is spread over a period.
    pub timing: jbtg::Timing,
    /// What the reference of each joint leaves of the limits to the actual motion.
    pub tracking_margin: BTreeMap<String, TrackingMargin>,
}

/// Shares of an actuator's limits that the reference leaves to the tracking error, in [0, 1).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrackingMargin {
    /// Share of the position range at either end.
    pub position: f64,
    /// Share of the velocity limit.
    pub velocity: f64,
    /// Share of the acceleration limit.
    pub acceleration: f64,
    /// Share of the jerk limit.
    pub jerk: f64,
}

/// What is to be done: bring the tip to a target and to rest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// Joints that the policy moves, in the order of its actions; all others are held by the controller.
    pub moving: Vec<String>,
    /// Positions of the held joints [rad or m], by joint.
    pub held: Vec<(String, f64)>,
    /// Distance of tip and target at which the target counts as reached \[m\].
    pub reach_distance: f64,
    /// Tip speed below which the target counts as reached [m/s].
    pub reach_speed: f64,
    /// Steps after which an episode is cut off.
    pub max_steps: u32,
}

/// Weights of the four terms of the reward [P, § II-A].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reward {
    /// Cost per step of the norm of the moving joints' efforts, each relative to its limit.
    pub effort: f64,
    /// Cost per step and metre between tip and target.
    pub distance: f64,
    /// Cost per step and m/s of tip speed.
    pub speed: f64,
    /// Reward on reaching the target.
    pub success: f64,
}

/// When each stage is mastered, and how often its state is kept.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Curriculum {
    /// Environment steps between two checkpoints.
    pub checkpoint_every: u64,
    /// Every n-th episode is played without exploration, as an evaluation is, and learnt from like any other; 0 for
    /// none. Exploration carries the tip over places at which the policy alone would rest, so they are not seen
    /// otherwise.
    pub noiseless_every: u64,
    /// The first stage.
    pub purple: Goal,
    /// The second stage.
    pub yellow: Goal,
    /// The last stage.
    pub orange: Goal,
}

/// When one stage is mastered, and when it ends without.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Goal {
    /// Episodes after which the stage ends, mastered or not.
    pub max_episodes: u64,
    /// Environment steps after which the stage ends with the episode in progress, mastered or not.
    pub max_steps: u64,
    /// Episodes of the rolling window over which success is counted.
    pub window: usize,
    /// Share of successes over a full window that asks for a confirmation.
    pub mastered_at: f64,
    /// Episodes of the evaluation without exploration that confirms a mastered stage.
    pub confirm_episodes: u64,
    /// Share of successes that the confirmation needs.
    pub confirmed_at: f64,
    /// Episodes between two confirmations at the least.
    pub confirm_every: u64,
}

impl Curriculum {
    /// When a stage is mastered.
    #[must_use]
    pub fn of(&self, stage: Stage) -> &Goal {
        match stage {
            Stage::Purple => &self.purple,
            Stage::Yellow => &self.yellow,
            Stage::Orange => &self.orange,
        }
    }

    fn check(&self) -> Result<(), ConfigError> {
        positive("curriculum.checkpoint_every".into(), self.checkpoint_every as f64)?;
        for stage in Stage::ALL {
            let goal = self.of(stage);
            let counts = [
                ("max_episodes", goal.max_episodes),
                ("max_steps", goal.max_steps),
                ("window", goal.window as u64),
                ("confirm_episodes", goal.confirm_episodes),
                ("confirm_every", goal.confirm_every),
            ];
            for (field, value) in counts {
                positive(format!("curriculum.{stage}.{field}"), value as f64)?;
            }
            for (field, value) in [("mastered_at", goal.mastered_at), ("confirmed_at", goal.confirmed_at)] {
                if !(0.0..=1.0).contains(&value) {
                    let field = format!("curriculum.{stage}.{field}");
                    return Err(ConfigError::OutOfRange { field, expected: "in [0, 1]", value });
                }
            }
        }
        Ok(())
    }
}

fn positive(field: String, value: f64) -> Result<(), ConfigError> {
    if !(value.is_finite() && value > 0.0) {
        return Err(ConfigError::OutOfRange { field, expected: "finite and > 0", value });
    }
    Ok(())
}

/// Why a configuration cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ConfigError {
    /// The file was written for another version of this program.
    #[error("schema is {0}, this program reads schema 1")]
    Schema(u32),
    /// A divider is zero, or the rates do not fit together.
    #[error("rates.{field}: {cause}")]
    Rates {
        /// Which field.
        field: &'static str,
        /// What is wrong with it.
        cause: String,
    },
    /// A number is outside its range.
    #[error("{field} must be {expected}, got {value}")]
    OutOfRange {
        /// Which field.
        field: String,
        /// What it may be.
        expected: &'static str,
        /// What it is.
        value: f64,
    },
    /// No joint is to be moved.
    #[error("task.moving names no joint")]
    NothingMoves,
}

impl ConfigSpec {
    /// Reads and checks a configuration.
    ///
    /// # Errors
    /// The file is missing, is no RON of this form (line and column are named), or holds a value out of range.
    pub fn read(path: &Path) -> Result<Self> {
        let config: Self = read_ron(path)?;
        config.check().with_context(|| path.display().to_string())?;
        Ok(config)
    }

    /// The configuration as RON, every field written out.
    ///
    /// # Errors
    /// A value has no RON form; none of ours lacks one.
    pub fn to_ron(&self) -> Result<String> {
        let pretty = ron::ser::PrettyConfig::new().struct_names(false);
        ron::ser::to_string_pretty(self, pretty)
            .map_err(|error| anyhow!("cannot write the configuration: {error}"))
    }

    pub(crate) fn check(&self) -> Result<(), ConfigError> {
        if self.schema != 1 {
            return Err(ConfigError::Schema(self.schema));
        }
        self.rates.check()?;
        if self.task.moving.is_empty() {
            return Err(ConfigError::NothingMoves);
        }
        for (joint, margin) in &self.motion.tracking_margin {
            let shares = [
                ("position", margin.position, 0.5, "in [0, 0.5)"),
                ("velocity", margin.velocity, 1.0, "in [0, 1)"),
                ("acceleration", margin.acceleration, 1.0, "in [0, 1)"),
                ("jerk", margin.jerk, 1.0, "in [0, 1)"),
            ];
            for (quantity, value, end, expected) in shares {
                if !(0.0..end).contains(&value) {
                    let field = format!("motion.tracking_margin of {joint}: {quantity}");
                    return Err(ConfigError::OutOfRange { field, expected, value });
                }
            }
        }
        let positives = [
            ("task.reach_distance", self.task.reach_distance),
            ("task.reach_speed", self.task.reach_speed),
            ("task.max_steps", f64::from(self.task.max_steps)),
        ];
        for (field, value) in positives {
            positive(field.into(), value)?;
        }
        let not_negative = [
            ("crane.payload", self.crane.payload),
            ("reward.effort", self.reward.effort),
            ("reward.distance", self.reward.distance),
            ("reward.speed", self.reward.speed),
            ("reward.success", self.reward.success),
        ];
        for (field, value) in not_negative {
            if !(value.is_finite() && value >= 0.0) {
                return Err(ConfigError::OutOfRange {
                    field: field.into(),
                    expected: "finite and ≥ 0",
                    value,
                });
            }
        }
        self.curriculum.check()
    }
}

impl Rates {
    /// Duration of one tick \[s\].
    #[must_use]
    pub fn tick_period(self) -> f64 {
        1.0 / f64::from(self.integration_hz)
    }

    /// Period of the policy \[s\].
    #[must_use]
    pub fn policy_period(self) -> f64 {
        f64::from(self.policy_divider) / f64::from(self.integration_hz)
    }

    /// Period of the controller \[s\].
    #[must_use]
    pub fn controller_period(self) -> f64 {
        f64::from(self.controller_divider) / f64::from(self.integration_hz)
    }

    fn check(self) -> Result<(), ConfigError> {
        let fields = [
            ("integration_hz", self.integration_hz),
            ("controller_divider", self.controller_divider),
            ("reference_divider", self.reference_divider),
            ("policy_divider", self.policy_divider),
        ];
        if let Some((field, _)) = fields.into_iter().find(|(_, value)| *value == 0) {
            return Err(ConfigError::Rates { field, cause: "must be at least 1, got 0".into() });
        }
        let nested = [
            ("reference_divider", self.reference_divider, "controller_divider", self.controller_divider),
            ("policy_divider", self.policy_divider, "reference_divider", self.reference_divider),
        ];
        for (field, slow, name, fast) in nested {
            if slow % fast != 0 {
                let cause = format!("{slow} must be a multiple of {name}, which is {fast}");
                return Err(ConfigError::Rates { field, cause });
            }
        }
        Ok(())
    }
}

/// Reads a RON file; an error names the file, line, column and cause.
///
/// # Errors
/// The file is missing or is no RON of this form.
pub fn read_ron<T: DeserializeOwned>(path: &Path) -> Result<T> {
    let text = store::read_text(path)?;
    ron::from_str(&text).map_err(|error| anyhow!("{}:{error}", path.display()))
}

/// Folder of a run's stage.
#[must_use]
pub fn run_folder(run: &str, stage: Stage) -> PathBuf {
    Path::new("runs").join(run).join(stage.name())
}
