//! Every figure of a run: plays episodes with its policy, reads what it left on disk, and draws.

use std::path::Path;
use std::sync::Arc;

use anyhow::{Context, Result, anyhow, ensure};
use figures::{Figure, SvgTheme, Theme};

use crate::config::run_folder;
use crate::draw::{Purpose, Stream};
use crate::environment::{Ending, Environment};
use crate::machine::Machine;
use crate::pictures::{self, Curve, Looks, Shown};
use crate::recording::{self, Detail, Recording};
use crate::stage::Stage;
use crate::trained::{Place, Trained};
use crate::{store, suggest};

/// Pixels of a PNG for each of a figure.
const PNG_SCALE: f64 = 2.0;

/// Other episodes shown faintly in the workspace.
const FAINT: usize = 24;

/// What is to be drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// Runs whose learning is drawn; the first one's policy is shown unless `policy` names another.
    pub runs: Vec<String>,
    /// Stage whose policy is shown; the last one that was trained if `None`.
    pub stage: Option<Stage>,
    /// A policy that is shown: the name of one that comes with the project, or a file.
    pub policy: Option<String>,
    /// Episodes that are played.
    pub episodes: u64,
    /// Names of the figures that are wanted; all if there is none.
    pub only: Vec<String>,
}

/// A figure and its name, which is its file's without the ending.
pub type Named = (String, Figure);

/// Draws every figure.
///
/// # Errors
/// No run and no policy is given, one is missing or was not trained, or a file of it is damaged.
pub fn draw(source: &Source) -> Result<Vec<Named>> {
    ensure!(source.episodes > 0, "--episodes must be at least 1");
    let mut figures = of_policy(&shown(source)?.read()?, source.episodes)?;
    for stage in Stage::ALL {
        let curves = curves(&source.runs, stage)?;
        if !curves.is_empty() {
            figures.push((format!("learning-{stage}"), pictures::learning(stage.name(), &curves)?));
        }
    }
    wanted(figures, &source.only)
}

/// The figures of these names, or all.
fn wanted(figures: Vec<Named>, only: &[String]) -> Result<Vec<Named>> {
    let known: Vec<&str> = figures.iter().map(|(name, _)| name.as_str()).collect();
    for name in only {
        let hint = suggest::nearest(name, &known).map(|near| format!("; did you mean '{near}'?"));
        ensure!(
            known.contains(&name.as_str()),
            "no figure is called '{name}' here{} (there are {})",
            hint.unwrap_or_default(),
            known.join(", ")
        );
    }
    Ok(figures.into_iter().filter(|(name, _)| only.is_empty() || only.contains(name)).collect())
}

/// Writes every figure as SVG, which follows the reader's light or dark, and as PNG for either.
///
/// # Errors
/// The folder cannot be written.
pub fn write(figures: &[Named], folder: &Path) -> Result<()> {
    let file = |name: String, contents: &[u8]| store::write_whole(&folder.join(name), contents);
    for (name, figure) in figures {
        file(format!("{name}.svg"), figure.svg(SvgTheme::Reader).as_bytes())?;
        file(format!("{name}.png"), &figure.png(Theme::Light, PNG_SCALE)?)?;
        file(format!("{name}-dark.png"), &figure.png(Theme::Dark, PNG_SCALE)?)?;
    }
    Ok(())
}

/// The policy that was named, or that of the first run's stage, or of the last stage that it has trained.
fn shown(source: &Source) -> Result<Place> {
    if let Some(policy) = &source.policy {
        return Ok(Place::Named(policy.clone()));
    }
    let run = source.runs.first().ok_or_else(|| anyhow!("give --run NAME or --policy FILE"))?;
    let place = |stage: Stage| Place::Run(run.clone(), stage);
    let last = Stage::ALL.into_iter().rev().find(|&stage| place(stage).file().is_ok());
    Ok(place(source.stage.or(last).unwrap_or(Stage::Purple)))
}

/// Figures of a policy and its machine.
fn of_policy(trained: &Trained, episodes: u64) -> Result<Vec<Named>> {
    let machine = trained.machine()?;
    let urdf = &trained.config.crane.urdf;
    let looks = Looks::from_urdf(&store::read_text(urdf)?).with_context(|| urdf.display().to_string())?;
    let recordings = play_all(trained, &machine, episodes)?;
    let chosen = most_telling(&recordings);
    let mut environment = Environment::new(Arc::clone(&machine), false);
    let episode = &recordings[chosen].episode;
    let recording = play(trained, &mut environment, episode, Detail::Ticks)?;
    let shown = Shown { machine: &machine, looks: &looks, recording: &recording };
    let joint = shown.busiest();
    let others: Vec<Recording> = recordings.iter().take(FAINT).cloned().collect();
    Ok([
        ("architecture", pictures::architecture(&machine)?),
        ("workspace", pictures::workspace(&machine, &recording, &others)?),
        ("posture", pictures::postures(&shown)?),
        ("safe-zone", pictures::zone(&shown, shown.most_confined())?),
        ("velocity-profile", pictures::velocity_profile(&shown)?),
        ("motion", pictures::motion(&shown, joint)?),
        ("tracking", pictures::tracking(&shown)?),
        ("tracking-error", pictures::tracking_error(&shown)?),
        ("margins", pictures::margins(&machine, &recordings)?),
    ]
    .map(|(name, figure)| (name.to_owned(), figure))
    .into())
}

/// The evaluation's first episodes, shared among the machine's cores; which core played one does not matter.
fn play_all(trained: &Trained, machine: &Arc<Machine>, episodes: u64) -> Result<Vec<Recording>> {
    let workers = std::thread::available_parallelism().map_or(1, |n| n.get() as u64);
    let part = |worker: u64| -> Result<Vec<(u64, Recording)>> {
        let mut environment = Environment::new(Arc::clone(machine), false);
        (worker..episodes)
            .step_by(workers as usize)
            .map(|number| {
                let (seed, stage) = (trained.config.seed, trained.stage);
                let mut stream = Stream::of_episode(seed, Purpose::Evaluation, stage, number);
                let episode = environment.draw(machine.regions().of(stage), &mut stream)?;
                Ok((number, play(trained, &mut environment, &episode, Detail::Steps)?))
            })
            .collect()
    };
    let parts = std::thread::scope(|scope| {
        let handles: Vec<_> = (0..workers).map(|worker| scope.spawn(move || part(worker))).collect();
        let joined = handles.into_iter().map(|handle| {
            handle.join().expect("an episode that panics is a bug, and its message is on stderr")
        });
        joined.collect::<Result<Vec<_>>>()
    })?;
    let mut played = parts.concat();
    played.sort_by_key(|(number, _)| *number);
    Ok(played.into_iter().map(|(_, recording)| recording).collect())
}

fn play(
    trained: &Trained,
    environment: &mut Environment,
    episode: &crate::environment::Episode,
    detail: Detail,
) -> Result<Recording> {
    let mut input = vec![0.0; trained.scaling.len()];
    recording::play(environment, episode, detail, |environment, action| {
        environment.observe(&trained.scaling, &mut input);
        trained.policy.act(&input, action);
    })
}

/// The longest way to a target that was reached; the longest way at all if none was.
fn most_telling(recordings: &[Recording]) -> usize {
    let way = |recording: &Recording| {
        let squares = recording.tips[0].iter().zip(recording.episode.target).map(|(a, b)| (a - b).powi(2));
        squares.sum::<f64>()
    };
    let rank = |recording: &Recording| (recording.ending == Ending::Reached, way(recording));
    (0..recordings.len())
        .max_by(|&a, &b| {
            let ((reached_a, way_a), (reached_b, way_b)) = (rank(&recordings[a]), rank(&recordings[b]));
            reached_a.cmp(&reached_b).then(way_a.total_cmp(&way_b))
        })
        .unwrap_or_default()
}

/// What the runs that trained a stage recorded of it.
fn curves(runs: &[String], stage: Stage) -> Result<Vec<Curve>> {
    let mut curves = Vec::new();
    for run in runs {
        let path = run_folder(run, stage).join("metrics.jsonl");
        if !path.exists() {
            continue;
        }
        let text = store::read_text(&path)?;
        let point = |(index, line): (usize, &str)| {
            serde_json::from_str(line).with_context(|| format!("{}:{}", path.display(), index + 1))
        };
        let points: Vec<_> = text.lines().enumerate().map(point).collect::<Result<_>>()?;
        if !points.is_empty() {
            curves.push(Curve { run: run.clone(), points });
        }
    }
    Ok(curves)
}
