//! Commands that learn or use a policy: `train`, `eval`, `play`, `record`, `search`, `figures` and `report`.
#![forbid(unsafe_code)]

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Result, anyhow, bail, ensure};
use runner::actions::Take;
use runner::arguments::Arguments;
use runner::config::{self, ConfigSpec, run_folder};
use runner::draw::Purpose;
use runner::evaluation::{self, Plan};
use runner::interrupt::Stop;
use runner::progress::Display;
use runner::stage::Stage;
use runner::trained::{Place, Trained};
use runner::training::{self, Request, Training};
use runner::{actions, command, play, search, store};
#[cfg(feature = "figures")]
use runner::{gallery, report};

#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// Name of the run if none is given.
const DEFAULT_RUN: &str = "default";

/// Episodes of an evaluation if no number is given.
const DEFAULT_EPISODES: u64 = 200;

/// Episodes behind the figures if no number is given.
#[cfg(feature = "figures")]
const DRAWN_EPISODES: u64 = 60;

fn main() -> ExitCode {
    command::run(dispatch)
}

fn dispatch(command: &str, words: Vec<String>) -> Result<String> {
    match command {
        "train" => train(Arguments::parse(words, &["all", "resume", "deterministic", "quiet", "plain"])?),
        "eval" => eval(Arguments::parse(words, &[])?),
        "play" => play(Arguments::parse(words, &[])?),
        "record" => record(Arguments::parse(words, &[])?),
        "search" => search(Arguments::parse(words, &["quiet"])?),
        "figures" => figures(Arguments::parse(words, &[])?),
        "report" => report(Arguments::parse(words, &["open"])?),
        _ => bail!(
            "no command is called '{command}'; there are train, eval, play, record, search, figures and report"
        ),
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
    // Accepted so that it may be asked for: no training here is anything else.
    arguments.switch("deterministic")?;
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
    let stop = Stop::on_signals()?;
    let mut report = String::new();
    for stage in stages {
        let request = Request { run: run.clone(), stage, episodes, display, stop: stop.clone() };
        let begun = training::latest(&run_folder(&run, stage)).exists();
        // `--all --resume` goes on in the stage where it stopped and starts the stages after it.
        let training = if resume && (begun || !all) {
            Training::resume(&request, wanted.as_ref(), seed)?
        } else {
            let mut config = match (&wanted, stage.before()) {
                (Some(config), _) => config.clone(),
                (None, Some(before)) if begun_config(&run, before).exists() => {
                    ConfigSpec::read(&begun_config(&run, before))?
                }
                (None, _) => ConfigSpec::read(Path::new(config::DEFAULT))?,
            };
            config.seed = seed.unwrap_or(config.seed);
            Training::start(&request, config)?
        };
        report += &training.run(&request)?.to_string();
    }
    Ok(report)
}

/// The configuration that a run keeps of a stage; the stage after it goes on with that.
fn begun_config(run: &str, stage: Stage) -> PathBuf {
    run_folder(run, stage).join("config.ron")
}

fn eval(mut arguments: Arguments) -> Result<String> {
    let stage: Stage = arguments.required("stage")?;
    let place = policy(&mut arguments, stage)?;
    let episodes = arguments.optional("episodes")?.unwrap_or(DEFAULT_EPISODES);
    let seed: Option<u64> = arguments.optional("seed")?;
    let json: Option<PathBuf> = arguments.optional("json")?;
    arguments.finish()?;
    ensure!(episodes > 0, "--episodes must be at least 1");
    let trained = place.read()?;
    let seed = seed.unwrap_or(trained.config.seed);
    let plan = Plan { stage, episodes, seed, purpose: Purpose::Evaluation };
    let evaluation = evaluation::evaluate(&trained.policy, &trained.scaling, &trained.machine()?, plan)?;
    let result = serde_json::to_string_pretty(&evaluation.summary)? + "\n";
    if let Some(path) = json {
        store::write_whole(&path, result.as_bytes())?;
    }
    Ok(result)
}

fn play(mut arguments: Arguments) -> Result<String> {
    let stage: Option<Stage> = arguments.optional("stage")?;
    let place = policy(&mut arguments, stage.unwrap_or(Stage::Purple))?;
    let episode = arguments.optional("episode")?.unwrap_or(0);
    let seed: Option<u64> = arguments.optional("seed")?;
    let json: Option<PathBuf> = arguments.optional("json")?;
    arguments.finish()?;
    let trained = place.read()?;
    let take = take(&trained, stage, seed, episode);
    let played = play::play(&trained, take)?;
    if let Some(path) = json {
        store::write_whole(&path, (serde_json::to_string_pretty(&played)? + "\n").as_bytes())?;
    }
    Ok(played.to_string())
}

fn record(mut arguments: Arguments) -> Result<String> {
    let stage: Option<Stage> = arguments.optional("stage")?;
    let place = policy(&mut arguments, stage.unwrap_or(Stage::Purple))?;
    let region: Option<Stage> = arguments.optional("region")?;
    let episode = arguments.required("episode")?;
    let seed: Option<u64> = arguments.optional("seed")?;
    let out: PathBuf = arguments.required("out")?;
    arguments.finish()?;
    let trained = place.read()?;
    let take = take(&trained, region.or(stage), seed, episode);
    let origin = format!("best policy of stage {}, trained with seed {}", trained.stage, trained.config.seed);
    actions::record(&trained.policy, &trained.scaling, &trained.machine()?, take, &origin, &out)
}

fn search(mut arguments: Arguments) -> Result<String> {
    let space: Option<PathBuf> = arguments.optional("space")?;
    let out: Option<PathBuf> = arguments.optional("out")?;
    let display = if arguments.switch("quiet")? { Display::Quiet } else { Display::Automatic };
    arguments.finish()?;
    let space = space.unwrap_or_else(|| search::SPACE.into());
    let rows = search::search(&space, display)?;
    let table = search::table(&rows);
    if let Some(path) = out {
        let json = serde_json::to_string_pretty(&rows)? + "\n";
        store::write_whole(&path.with_extension("json"), json.as_bytes())?;
        store::write_whole(&path, search::page(&space, &path, &table).as_bytes())?;
    }
    Ok(table)
}

/// Which episode is meant, by the policy's own stage and seed where none are given.
fn take(trained: &Trained, stage: Option<Stage>, seed: Option<u64>, episode: u64) -> Take {
    Take { stage: stage.unwrap_or(trained.stage), seed: seed.unwrap_or(trained.config.seed), episode }
}

/// The policy that `--policy` names, or that of `stage` of the run that `--run` names.
fn policy(arguments: &mut Arguments, stage: Stage) -> Result<Place> {
    let named: Option<String> = arguments.optional("policy")?;
    let run: Option<String> = arguments.optional("run")?;
    match (named, run) {
        (Some(named), None) => Ok(Place::Named(named)),
        (None, Some(run)) => Ok(Place::Run(run_name(Some(run))?, stage)),
        _ => bail!("give either --run NAME or --policy NAME|FILE"),
    }
}

#[cfg(feature = "figures")]
fn figures(mut arguments: Arguments) -> Result<String> {
    let source = source(&mut arguments)?;
    let out = place(&mut arguments, &source, "figures")?;
    arguments.finish()?;
    let drawn = gallery::draw(&source)?;
    gallery::write(&drawn, &out)?;
    let mut report =
        format!("{} figures in {}, each as .svg, .png and -dark.png:\n", drawn.len(), out.display());
    for (name, figure) in &drawn {
        report += &format!("  {name:17} {}\n", figure.title());
    }
    Ok(report)
}

#[cfg(feature = "figures")]
fn report(mut arguments: Arguments) -> Result<String> {
    let open = arguments.switch("open")?;
    let source = source(&mut arguments)?;
    let path = place(&mut arguments, &source, "report.html")?;
    arguments.finish()?;
    ensure!(!source.runs.is_empty() || source.policy.is_some(), "give --run NAME or --policy NAME");
    let html = report::html(&source)?;
    store::write_whole(&path, html.as_bytes())?;
    let opened = if open { self::open(&path) } else { String::new() };
    Ok(format!(
        "{} ({:.1} MB, nothing else needed to read it)\n{opened}",
        path.display(),
        html.len() as f64 / 1e6
    ))
}

/// Where `--out` says, or under the first run's folder.
#[cfg(feature = "figures")]
fn place(arguments: &mut Arguments, source: &gallery::Source, name: &str) -> Result<PathBuf> {
    let under_run = || match source.runs.first() {
        Some(run) => Path::new("runs").join(run).join(name),
        None => PathBuf::from(name),
    };
    Ok(arguments.optional("out")?.unwrap_or_else(under_run))
}

/// Shows a file in whatever shows such files here; gives what is to be said if nothing does.
#[cfg(feature = "figures")]
fn open(path: &Path) -> String {
    let program = if cfg!(target_os = "macos") { "open" } else { "xdg-open" };
    match std::process::Command::new(program).arg(path).spawn() {
        Ok(_) => String::new(),
        Err(error) => format!("cannot open it: {program}: {error}\n"),
    }
}

#[cfg(not(feature = "figures"))]
fn figures(_arguments: Arguments) -> Result<String> {
    bail!("this program was built without pictures; build it with the feature `figures`")
}

#[cfg(not(feature = "figures"))]
fn report(arguments: Arguments) -> Result<String> {
    figures(arguments)
}

/// What is to be drawn.
#[cfg(feature = "figures")]
fn source(arguments: &mut Arguments) -> Result<gallery::Source> {
    let runs: Vec<String> = arguments.all("run")?;
    let runs = runs.into_iter().map(|run| run_name(Some(run))).collect::<Result<Vec<_>>>()?;
    let policy = arguments.optional("policy")?;
    let (stage, episodes) = (arguments.optional("stage")?, arguments.optional("episodes")?);
    let only = arguments.all("figure")?;
    Ok(gallery::Source { runs, stage, policy, episodes: episodes.unwrap_or(DRAWN_EPISODES), only })
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
