//! Commands that learn or use a policy: `train` and `eval`.
#![forbid(unsafe_code)]

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

use anyhow::{Result, anyhow, bail, ensure};
use runner::arguments::Arguments;
use runner::config::{self, ConfigSpec, run_folder};
use runner::draw::Purpose;
use runner::evaluation::{self, Plan};
use runner::machine::Machine;
use runner::progress::Display;
use runner::stage::Stage;
use runner::training::{self, Request, Training};
use runner::{checkpoint, command, store};

#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// Name of the run if none is given.
const DEFAULT_RUN: &str = "default";

/// Episodes of an evaluation if no number is given.
const DEFAULT_EPISODES: u64 = 200;

fn main() -> ExitCode {
    command::run(dispatch)
}

fn dispatch(command: &str, words: Vec<String>) -> Result<String> {
    match command {
        "train" => train(Arguments::parse(words, &["all", "resume", "quiet", "plain"])?),
        "eval" => eval(Arguments::parse(words, &[])?),
        _ => bail!("no command is called '{command}'; there are train and eval"),
    }
}

fn train(mut arguments: Arguments) -> Result<String> {
    let stage: Option<Stage> = arguments.optional("stage")?;
    let all = arguments.switch("all")?;
    let run = run_name(arguments.optional("run")?)?;
    let seed: Option<u64> = arguments.optional("seed")?;
    let episodes: Option<u64> = arguments.optional("episodes")?;
    let file: Option<PathBuf> = arguments.optional("config")?;
    let resume = arguments.switch("resume")?;
    let display = match (arguments.switch("quiet")?, arguments.switch("plain")?) {
        (true, _) => Display::Quiet,
        (false, true) => Display::Lines,
        (false, false) => Display::Automatic,
    };
    arguments.finish()?;
    let stages = match (stage, all) {
        (Some(stage), false) => vec![stage],
        (None, true) => Stage::ALL.to_vec(),
        _ => bail!("give --stage purple|yellow|orange, or --all"),
    };
    let wanted = file.as_deref().map(ConfigSpec::read).transpose()?;
    let mut report = String::new();
    for stage in stages {
        let request = Request { run: run.clone(), stage, episodes, display };
        let begun = training::latest(&run_folder(&run, stage)).exists();
        // `--all --resume` goes on in the stage where it stopped and starts the stages after it.
        let training = if resume && (begun || !all) {
            Training::resume(&request, wanted.as_ref(), seed)?
        } else {
            let mut config = match &wanted {
                Some(config) => config.clone(),
                None => ConfigSpec::read(Path::new(config::DEFAULT))?,
            };
            config.seed = seed.unwrap_or(config.seed);
            Training::start(&request, config)?
        };
        report += &training.run(&request)?.to_string();
    }
    Ok(report)
}

fn eval(mut arguments: Arguments) -> Result<String> {
    let run = run_name(Some(arguments.required("run")?))?;
    let stage: Stage = arguments.required("stage")?;
    let episodes = arguments.optional("episodes")?.unwrap_or(DEFAULT_EPISODES);
    let seed: Option<u64> = arguments.optional("seed")?;
    let json: Option<PathBuf> = arguments.optional("json")?;
    arguments.finish()?;
    ensure!(episodes > 0, "--episodes must be at least 1");
    let path = training::best(&run_folder(&run, stage));
    ensure!(
        path.exists(),
        "run '{run}' has no trained stage {stage}: {} is missing; first run: cargo xtask train --stage {stage} --run {run}",
        path.display()
    );
    let (header, agent) = checkpoint::read(&path)?;
    let machine = Arc::new(Machine::load(&header.config)?);
    let seed = seed.unwrap_or(header.config.seed);
    let plan = Plan { stage, episodes, seed, purpose: Purpose::Evaluation };
    let evaluation = evaluation::evaluate(agent.policy(), &header.scaling, &machine, plan)?;
    let result = serde_json::to_string_pretty(&evaluation.summary)? + "\n";
    if let Some(path) = json {
        store::write_whole(&path, result.as_bytes())?;
    }
    Ok(result)
}

/// A name that is one folder under `runs/`.
fn run_name(given: Option<String>) -> Result<String> {
    let name = given.unwrap_or_else(|| DEFAULT_RUN.to_owned());
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
    if name.is_empty() || name.starts_with('.') || !name.chars().all(is_plain) {
        return Err(anyhow!("--run '{name}': a name is made of letters, digits, '-', '_' and '.'"));
    }
    Ok(name)
}
