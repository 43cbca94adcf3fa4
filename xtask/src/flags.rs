//! The whole grammar of the command line.
//!
//! [`COMMANDS`] is what may be written, and what `help` prints; the types below are what the commands
//! get, checked.

mod commands;

use crate::args::{Parsed, UsageError, Values};
use std::path::PathBuf;

pub(crate) use commands::{COMMANDS, Command, Flag};

/// What a curriculum stage may be called.
pub(crate) const STAGES: &[&str] = &["purple", "yellow", "orange"];

/// The actuated joints of the default configuration's crane. A test compares them with the crane's own file.
pub(crate) const JOINTS: &[&str] = &[
    "slew_joint",
    "lift_joint",
    "tilt_joint",
    "telescope_joint",
    "wrist_pitch_joint",
    "wrist_yaw_joint",
    "wrist_roll_joint",
];

/// Acceleration ramps that `profile` knows.
pub(crate) const SHAPES: &[&str] = &["smoothstep", "sine-quintic"];

/// Timings that `profile` knows.
pub(crate) const TIMINGS: &[&str] = &["stretched", "fastest"];

/// Control laws that `track` knows.
pub(crate) const CONTROLLERS: &[&str] =
    &["adaptive", "pd", "pid", "computed-torque", "computed-torque-exact"];

/// Control laws that `tune` finds gains for.
pub(crate) const TUNED: &[&str] = &["adaptive", "pd", "pid", "computed-torque"];

/// What a feedforward may know.
pub(crate) const FEEDFORWARDS: &[&str] = &["none", "nominal", "exact"];

/// Plants that gains are tuned for.
pub(crate) const PLANTS: &[&str] = &["electric", "light"];

/// Figures of a policy, and of the learning of each stage.
pub(crate) const FIGURES: &[&str] = &[
    "architecture",
    "workspace",
    "posture",
    "safe-zone",
    "velocity-profile",
    "motion",
    "tracking",
    "tracking-error",
    "margins",
    "learning-purple",
    "learning-yellow",
    "learning-orange",
];

/// A command line that has been understood. Paths are absolute.
#[derive(Debug)]
pub(crate) enum Invocation {
    Help(Option<&'static Command>),
    Tables(Tables),
    Train(Train),
    Eval(Eval),
    Play(Play),
    Figures(Figures),
    Report(Report),
    Runs(Runs),
    Doctor,
    Profile(Profile),
    Zone(Zone),
    Soak(Soak),
    Dynamics(Dynamics),
    LoadChart(LoadChart),
    Footprint,
    Track(Track),
    Tune(Tune),
    Ablation(Ablation),
    Record(Record),
    Search(Search),
    Tidy,
}

#[derive(Debug, PartialEq)]
pub(crate) struct Tables {
    pub(crate) check: bool,
    pub(crate) config: Option<PathBuf>,
}

#[derive(Debug, PartialEq)]
pub(crate) struct Train {
    pub(crate) stages: Stages,
    pub(crate) run: Option<String>,
    pub(crate) seed: Option<u64>,
    pub(crate) episodes: Option<u64>,
    pub(crate) config: Option<PathBuf>,
    pub(crate) resume: bool,
    pub(crate) quiet: bool,
    pub(crate) plain: bool,
}

/// What to train.
#[derive(Debug, PartialEq)]
pub(crate) enum Stages {
    All,
    One(&'static str),
}

/// Whose policy: the one or the other.
#[derive(Debug, PartialEq)]
pub(crate) enum Whose {
    /// A run's, of the stage that the command names.
    Run(String),
    /// A policy that comes with the project, or the absolute path of a file.
    Policy(String),
}

#[derive(Debug, PartialEq)]
pub(crate) struct Eval {
    pub(crate) whose: Whose,
    pub(crate) stage: &'static str,
    pub(crate) episodes: Option<u64>,
    pub(crate) seed: Option<u64>,
    pub(crate) json: Option<PathBuf>,
}

#[derive(Debug, PartialEq)]
pub(crate) struct Play {
    pub(crate) whose: Whose,
    pub(crate) stage: Option<&'static str>,
    pub(crate) episode: Option<u64>,
    pub(crate) seed: Option<u64>,
    pub(crate) json: Option<PathBuf>,
}

#[derive(Debug, PartialEq)]
pub(crate) struct Figures {
    pub(crate) runs: Vec<String>,
    pub(crate) policy: Option<String>,
    pub(crate) stage: Option<&'static str>,
    pub(crate) episodes: Option<u64>,
    pub(crate) out: Option<PathBuf>,
    /// Figures to draw; all if there is none.
    pub(crate) only: Vec<&'static str>,
}

#[derive(Debug, PartialEq)]
pub(crate) struct Report {
    pub(crate) figures: Figures,
    pub(crate) open: bool,
}

#[derive(Debug, PartialEq)]
pub(crate) struct Runs {
    pub(crate) json: bool,
}

#[derive(Debug, PartialEq)]
pub(crate) struct Profile {
    pub(crate) v1: f64,
    pub(crate) v2: f64,
    pub(crate) dt: f64,
    pub(crate) vmax: f64,
    pub(crate) amax: f64,
    pub(crate) jmax: f64,
    pub(crate) shape: Option<&'static str>,
    pub(crate) timing: Option<&'static str>,
    pub(crate) hz: Option<u64>,
}

#[derive(Debug, PartialEq)]
pub(crate) struct Zone {
    pub(crate) joint: String,
    pub(crate) position: f64,
    pub(crate) velocity: f64,
    pub(crate) config: Option<PathBuf>,
    pub(crate) json: bool,
}

#[derive(Debug, PartialEq)]
pub(crate) struct Soak {
    pub(crate) steps: u64,
    pub(crate) seed: u64,
    pub(crate) json: Option<PathBuf>,
    pub(crate) threads: Option<u64>,
    pub(crate) case: Option<u64>,
}

#[derive(Debug, PartialEq)]
pub(crate) struct Dynamics {
    pub(crate) states: PathBuf,
    pub(crate) config: Option<PathBuf>,
}

#[derive(Debug, PartialEq)]
pub(crate) struct LoadChart {
    pub(crate) config: Option<PathBuf>,
    pub(crate) json: Option<PathBuf>,
    pub(crate) svg: Option<PathBuf>,
}

#[derive(Debug, PartialEq)]
pub(crate) struct Track {
    pub(crate) scenario: String,
    pub(crate) controller: Option<&'static str>,
    pub(crate) feedforward: Option<&'static str>,
    pub(crate) json: Option<PathBuf>,
    pub(crate) csv: Option<PathBuf>,
}

#[derive(Debug, PartialEq)]
pub(crate) struct Tune {
    pub(crate) controller: Option<&'static str>,
    pub(crate) plant: Option<&'static str>,
    pub(crate) budget: Option<u64>,
    pub(crate) seed: Option<u64>,
}

#[derive(Debug, PartialEq)]
pub(crate) struct Ablation {
    pub(crate) json: Option<PathBuf>,
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, PartialEq)]
pub(crate) struct Search {
    pub(crate) space: Option<PathBuf>,
    pub(crate) out: Option<PathBuf>,
    pub(crate) quiet: bool,
}

/// `record`.
#[derive(Debug)]
pub(crate) struct Record {
    pub(crate) whose: Whose,
    pub(crate) stage: Option<&'static str>,
    pub(crate) episode: u64,
    pub(crate) out: PathBuf,
    pub(crate) region: Option<&'static str>,
    pub(crate) seed: Option<u64>,
}

impl Invocation {
    /// From the words after `cargo xtask`.
    pub(crate) fn parse(words: Vec<String>) -> Result<Self, UsageError> {
        let parsed = match Parsed::read(words)? {
            Parsed::Help(command) => return Ok(Self::Help(command)),
            Parsed::Command(values) => values,
        };
        Ok(match parsed.command.name {
            "tables" => Self::Tables(Tables {
                check: parsed.switch("check"),
                config: parsed.existing_file("config")?,
            }),
            "train" => Self::Train(Train {
                stages: match (parsed.one_of("stage", STAGES)?, parsed.switch("all")) {
                    (Some(stage), false) => Stages::One(stage),
                    (None, true) => Stages::All,
                    (Some(_), true) => return Err(parsed.error("give either --stage or --all, not both")),
                    (None, false) => {
                        let wanted = format!("needs --stage STAGE ({}) or --all", STAGES.join(", "));
                        return Err(parsed.error(&wanted));
                    }
                },
                run: parsed.run_name("run")?,
                seed: parsed.integer("seed", 0)?,
                episodes: parsed.integer("episodes", 1)?,
                config: parsed.existing_file("config")?,
                resume: parsed.switch("resume"),
                quiet: parsed.switch("quiet"),
                plain: parsed.switch("plain"),
            }),
            "eval" => Self::Eval(Eval {
                whose: whose(&parsed)?,
                stage: parsed.given("stage", parsed.one_of("stage", STAGES)?)?,
                episodes: parsed.integer("episodes", 1)?,
                seed: parsed.integer("seed", 0)?,
                json: parsed.file("json")?,
            }),
            "play" => Self::Play(Play {
                whose: whose(&parsed)?,
                stage: stage_of_run(&parsed)?,
                episode: parsed.integer("episode", 0)?,
                seed: parsed.integer("seed", 0)?,
                json: parsed.file("json")?,
            }),
            "figures" => {
                let figures = figures(&parsed)?;
                if figures.runs.is_empty() && figures.policy.is_none() {
                    return Err(parsed.error("needs --run NAME or --policy NAME"));
                }
                Self::Figures(figures)
            }
            "report" => {
                let report = Report { figures: figures(&parsed)?, open: parsed.switch("open") };
                if report.figures.runs.is_empty() && report.figures.policy.is_none() {
                    return Err(parsed.error("needs --run NAME or --policy NAME"));
                }
                Self::Report(report)
            }
            "runs" => Self::Runs(Runs { json: parsed.switch("json") }),
            "doctor" => Self::Doctor,
            "profile" => Self::Profile(Profile {
                v1: parsed.number("v1")?,
                v2: parsed.number("v2")?,
                dt: parsed.number("dt")?,
                vmax: parsed.number("vmax")?,
                amax: parsed.number("amax")?,
                jmax: parsed.number("jmax")?,
                shape: parsed.one_of("shape", SHAPES)?,
                timing: parsed.one_of("timing", TIMINGS)?,
                hz: parsed.integer("hz", 1)?,
            }),
            "zone" => Self::Zone(Zone {
                joint: parsed.joint("joint", "config")?,
                position: parsed.number("position")?,
                velocity: parsed.number("velocity")?,
                config: parsed.existing_file("config")?,
                json: parsed.switch("json"),
            }),
            "soak" => Self::Soak(Soak {
                steps: parsed.given("steps", parsed.integer("steps", 1)?)?,
                seed: parsed.given("seed", parsed.integer("seed", 0)?)?,
                json: parsed.file("json")?,
                threads: parsed.integer("threads", 1)?,
                case: parsed.integer("case", 0)?,
            }),
            "dynamics" => Self::Dynamics(Dynamics {
                states: parsed.given("states", parsed.existing_file("states")?)?,
                config: parsed.existing_file("config")?,
            }),
            "load-chart" => Self::LoadChart(LoadChart {
                config: parsed.existing_file("config")?,
                json: parsed.file("json")?,
                svg: parsed.file("svg")?,
            }),
            "footprint" => Self::Footprint,
            "track" => Self::Track(Track {
                scenario: parsed.given("scenario", parsed.run_name("scenario")?)?,
                controller: parsed.one_of("controller", CONTROLLERS)?,
                feedforward: parsed.one_of("feedforward", FEEDFORWARDS)?,
                json: parsed.file("json")?,
                csv: parsed.file("csv")?,
            }),
            "tune" => Self::Tune(Tune {
                controller: parsed.one_of("controller", TUNED)?,
                plant: parsed.one_of("plant", PLANTS)?,
                budget: parsed.integer("budget", 1)?,
                seed: parsed.integer("seed", 0)?,
            }),
            "ablation" => Self::Ablation(Ablation { json: parsed.file("json")?, out: parsed.file("out")? }),
            "record" => Self::Record(Record {
                whose: whose(&parsed)?,
                stage: stage_of_run(&parsed)?,
                episode: parsed.given("episode", parsed.integer("episode", 0)?)?,
                out: parsed.given("out", parsed.file("out")?)?,
                region: parsed.one_of("region", STAGES)?,
                seed: parsed.integer("seed", 0)?,
            }),
            "search" => Self::Search(Search {
                space: parsed.existing_file("space")?,
                out: parsed.file("out")?,
                quiet: parsed.switch("quiet"),
            }),
            "tidy" => Self::Tidy,
            _ => Self::Help(None),
        })
    }
}

/// `--run` or `--policy`.
fn whose(parsed: &Values) -> Result<Whose, UsageError> {
    match (parsed.run_name("run")?, parsed.policy("policy")?) {
        (Some(run), None) => Ok(Whose::Run(run)),
        (None, Some(policy)) => Ok(Whose::Policy(policy)),
        (Some(_), Some(_)) => Err(parsed.error("give either --run or --policy, not both")),
        (None, None) => Err(parsed.error("needs --run NAME or --policy NAME")),
    }
}

/// `--stage`, which says whose policy of a run is meant.
fn stage_of_run(parsed: &Values) -> Result<Option<&'static str>, UsageError> {
    let stage = parsed.one_of("stage", STAGES)?;
    if stage.is_none() && parsed.switch("run") {
        return Err(parsed.error("needs --stage STAGE with --run"));
    }
    Ok(stage)
}

/// What `figures` and `report` have in common.
fn figures(parsed: &Values) -> Result<Figures, UsageError> {
    Ok(Figures {
        runs: parsed.run_names("run")?,
        policy: parsed.policy("policy")?,
        stage: parsed.one_of("stage", STAGES)?,
        episodes: parsed.integer("episodes", 1)?,
        out: parsed.file("out")?,
        only: parsed.all_of("figure", FIGURES)?,
    })
}

#[cfg(test)]
mod tests;
