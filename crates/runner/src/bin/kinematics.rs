//! Commands about motion alone: `tables`, `profile`, `zone`, `soak`, `dynamics`, `load-chart`, `track`, `tune`,
//! `ablation`; and `runs`, which lists what was trained. Builds without the learner.
#![forbid(unsafe_code)]

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::str::FromStr;

use anyhow::{Result, bail};
use jbtg::{Shape, Timing};
use runner::arguments::Arguments;
use runner::command;
use runner::config::{self, ConfigSpec};
use runner::kinematics::soak::{self, SoakRequest};
use runner::kinematics::{
    self, AblationRequest, LoadChartFiles, ProfileRequest, RunsFormat, Tables, TrackRequest, TuneRequest,
    ZoneFormat,
};
use runner::track::setup::Law;

/// Every command.
const COMMANDS: &str = "tables, zone, profile, soak, dynamics, load-chart, track, tune, ablation and runs";

fn main() -> ExitCode {
    command::run(dispatch)
}

fn dispatch(command: &str, words: Vec<String>) -> Result<String> {
    let mut arguments = Arguments::parse(words, switches(command))?;
    match command {
        "tables" => {
            let what = if arguments.switch("check")? { Tables::Check } else { Tables::Build };
            let config = configuration(&mut arguments)?;
            arguments.finish()?;
            kinematics::tables(&config, what)
        }
        "zone" => {
            let config = configuration(&mut arguments)?;
            let joint: String = arguments.required("joint")?;
            let position = arguments.required("position")?;
            let velocity = arguments.required("velocity")?;
            let format = if arguments.switch("json")? { ZoneFormat::Json } else { ZoneFormat::Text };
            arguments.finish()?;
            kinematics::zone(&config, &joint, position, velocity, format)
        }
        "runs" => {
            let format = if arguments.switch("json")? { RunsFormat::Json } else { RunsFormat::Text };
            arguments.finish()?;
            kinematics::runs(format)
        }
        "profile" => {
            let request = ProfileRequest {
                v1: arguments.required("v1")?,
                v2: arguments.required("v2")?,
                dt: arguments.required("dt")?,
                vmax: arguments.required("vmax")?,
                amax: arguments.required("amax")?,
                jmax: arguments.required("jmax")?,
                shape: arguments.optional("shape")?.map_or(Shape::Smoothstep, |ShapeName(shape)| shape),
                timing: arguments.optional("timing")?.map_or(Timing::Stretched, |TimingName(timing)| timing),
                hz: arguments.optional("hz")?.unwrap_or(10_000.0),
            };
            arguments.finish()?;
            kinematics::profile(&request)
        }
        "dynamics" => {
            let config = configuration(&mut arguments)?;
            let states: PathBuf = arguments.required("states")?;
            arguments.finish()?;
            kinematics::dynamics(&config, &states)
        }
        "soak" => {
            let request = SoakRequest {
                steps: arguments.required("steps")?,
                seed: arguments.required("seed")?,
                threads: arguments.optional("threads")?,
                json: arguments.optional("json")?,
                case: arguments.optional("case")?,
            };
            arguments.finish()?;
            soak::soak(&request)
        }
        "load-chart" => {
            let config = configuration(&mut arguments)?;
            let files = LoadChartFiles { json: arguments.optional("json")?, svg: arguments.optional("svg")? };
            arguments.finish()?;
            kinematics::load_chart(&config, &files)
        }
        "track" => {
            let request = TrackRequest {
                scenario: arguments.required("scenario")?,
                law: arguments.optional("controller")?.unwrap_or(Law::Adaptive),
                knowledge: arguments.optional("feedforward")?,
                json: arguments.optional("json")?,
                csv: arguments.optional("csv")?,
            };
            arguments.finish()?;
            kinematics::track(&request)
        }
        "tune" => {
            let request = TuneRequest {
                law: arguments.optional("controller")?,
                family: arguments.optional("plant")?,
                budget: arguments.optional("budget")?,
                seed: arguments.optional("seed")?,
            };
            arguments.finish()?;
            kinematics::tune(&request)
        }
        "ablation" => {
            let request =
                AblationRequest { json: arguments.optional("json")?, out: arguments.optional("out")? };
            arguments.finish()?;
            kinematics::ablation(&request)
        }
        _ => bail!("no command is called '{command}'; there are {COMMANDS}"),
    }
}

/// Flags of `command` that take no value.
fn switches(command: &str) -> &'static [&'static str] {
    match command {
        "tables" => &["check"],
        "zone" | "runs" => &["json"],
        _ => &[],
    }
}

fn configuration(arguments: &mut Arguments) -> Result<ConfigSpec> {
    let path: Option<PathBuf> = arguments.optional("config")?;
    ConfigSpec::read(path.as_deref().unwrap_or(Path::new(config::DEFAULT)))
}

struct ShapeName(Shape);

impl FromStr for ShapeName {
    type Err = anyhow::Error;

    fn from_str(name: &str) -> Result<Self> {
        match name {
            "smoothstep" => Ok(Self(Shape::Smoothstep)),
            "sine-quintic" => Ok(Self(Shape::SineQuintic)),
            _ => bail!("no shape is called that; there are smoothstep and sine-quintic"),
        }
    }
}

struct TimingName(Timing);

impl FromStr for TimingName {
    type Err = anyhow::Error;

    fn from_str(name: &str) -> Result<Self> {
        match name {
            "stretched" => Ok(Self(Timing::Stretched)),
            "fastest" => Ok(Self(Timing::Fastest)),
            _ => bail!("no timing is called that; there are stretched and fastest"),
        }
    }
}
