//! Training of one stage, from its start or from a checkpoint, until it is mastered.

mod finished;
mod overlap;
mod record;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use anyhow::{Context, Result, ensure};
use sac_burn::{Agent, Policy};

pub use self::finished::Finished;
use self::overlap::{Acting, Played};
use self::record::{EpisodeRecord, Means, Recorder};
use crate::certificate::{Certificate, Part};
use crate::checkpoint::{self, Header};
use crate::command::Interrupted;
use crate::config::{ConfigSpec, Goal, run_folder};
use crate::curriculum::{EpisodeResult, Mastery};
use crate::digest::Digest;
use crate::draw::{Purpose, Stream};
use crate::environment::{Ending, Environment};
use crate::evaluation::{self, Evaluation, Plan, Violations};
use crate::evidence::Evidence;
use crate::interrupt::Stop;
use crate::machine::{Machine, short};
use crate::observation::Scaling;
use crate::progress::{Display, Learner, Progress, Status, Worst};
use crate::stage::Stage;
use crate::trained::{self, Trained};
use crate::{difference, store};

/// Which training is wanted.
#[derive(Clone, Debug)]
pub struct Request {
    /// Name of the run.
    pub run: String,
    /// The stage.
    pub stage: Stage,
    /// Total number of episodes at which the stage ends at the latest; the configuration's if `None`.
    pub episodes: Option<u64>,
    /// How progress is shown.
    pub display: Display,
    /// When to stop before the end.
    pub stop: Stop,
}

/// A training in progress.
pub struct Training {
    folder: PathBuf,
    config: ConfigSpec,
    stage: Stage,
    machine: Arc<Machine>,
    environment: Environment,
    scaling: Scaling,
    agent: Agent,
    mastery: Mastery,
    evidence: Evidence,
    steps: u64,
    recorder: Recorder,
    time: TimeSpent,
    /// Of the last episode in which the learner learnt.
    learnt: Option<Means>,
}

/// Where the time of a training went \[s\], since it was last resumed; for people, never part of what a seed determines.
#[derive(Clone, Copy, Debug, Default, serde::Serialize)]
struct TimeSpent {
    environment: f64,
    learner: f64,
    total: f64,
    steps: u64,
    updates: u64,
    /// The most that the process held at once \[bytes\]; `None` where the system does not tell.
    peak_memory: Option<u64>,
    /// For comparison with another machine, which is why it stands beside its times.
    metrics_digest: Option<Digest>,
}

impl Training {
    /// Starts a stage from nothing, or from the best checkpoint of the stage before.
    ///
    /// # Errors
    /// The stage before was not trained, the stage itself was already, or the run's folder cannot be written.
    pub fn start(request: &Request, config: ConfigSpec) -> Result<Self> {
        let Request { run, stage, .. } = request;
        let folder = run_folder(run, *stage);
        ensure!(
            !latest(&folder).exists(),
            "{} holds a training already; continue it with --resume, or name another run with --run",
            folder.display()
        );
        let machine = Arc::new(Machine::load(&config)?);
        let scaling = machine.scaling();
        let agent = match stage.before() {
            None => Agent::new(config.learner.clone(), scaling.len(), machine.moving().len(), config.seed)?,
            Some(before) => {
                let path = best(&run_folder(run, before));
                ensure!(
                    path.exists(),
                    "stage {stage} starts from the best checkpoint of stage {before}, and {} is missing; first run: \
                     cargo xtask train --stage {before} --run {run}",
                    path.display()
                );
                inherit(&path, &config, &scaling)?
            }
        };
        store::write_whole(&folder.join("config.ron"), config.to_ron()?.as_bytes())?;
        let recorder = Recorder::create(&folder)?;
        let joints = machine.joints().len();
        Ok(Self {
            environment: Environment::new(Arc::clone(&machine), false),
            evidence: Evidence::none(joints),
            mastery: Mastery::new(),
            steps: 0,
            time: TimeSpent::default(),
            learnt: None,
            stage: *stage,
            folder,
            config,
            machine,
            scaling,
            agent,
            recorder,
        })
    }

    /// Continues a stage from its last checkpoint, bit for bit as if it had never stopped.
    ///
    /// # Errors
    /// There is no checkpoint, it is damaged, or `wanted` asks for another configuration than the run's.
    pub fn resume(request: &Request, wanted: Option<&ConfigSpec>, seed: Option<u64>) -> Result<Self> {
        let Request { run, stage, .. } = request;
        let folder = run_folder(run, *stage);
        let path = latest(&folder);
        ensure!(
            path.exists(),
            "there is nothing to resume: {} is missing; first run: cargo xtask train --stage {stage} --run {run}",
            path.display()
        );
        let (header, agent) = checkpoint::read(&path)?;
        ensure!(header.stage == *stage, "{} is of stage {}, not {stage}", path.display(), header.stage);
        let config = header.config;
        let mut wanted = wanted.cloned().unwrap_or_else(|| config.clone());
        wanted.seed = seed.unwrap_or(wanted.seed);
        same_configuration(&config, &wanted).with_context(|| {
            format!(
                "{} cannot be resumed with another configuration or seed; leave --config and --seed away, or name \
                 another run with --run",
                folder.display()
            )
        })?;
        let machine = Arc::new(Machine::load(&config)?);
        same_crane(&path, &header.scaling, &machine.scaling())?;
        let recorder = Recorder::reopen(&folder, header.metrics_length, header.events_length)?;
        Ok(Self {
            environment: Environment::new(Arc::clone(&machine), false),
            evidence: header.evidence,
            mastery: header.mastery,
            steps: header.steps,
            scaling: header.scaling,
            time: TimeSpent::default(),
            learnt: None,
            stage: *stage,
            folder,
            config,
            machine,
            agent,
            recorder,
        })
    }

    /// Trains until the stage is mastered or the episodes are used up, evaluates the best checkpoint and writes
    /// `eval.json` and `certificate.json`.
    ///
    /// # Errors
    /// The learning diverged, the simulation left its range, or a file cannot be written. [`Interrupted`] if it was
    /// asked to stop: its state after the last whole episode is then in the latest checkpoint.
    pub fn run(mut self, request: &Request) -> Result<Finished> {
        // A number of episodes that was asked for is the only bound.
        let mut goal = *self.goal();
        let episodes = request.episodes.unwrap_or(goal.max_episodes);
        if request.episodes.is_some() {
            goal.max_steps = u64::MAX;
        }
        let mut progress = Progress::start(request.display, self.stage.name(), episodes);
        let started = now();
        let mut checkpoint_at = self.steps + self.config.curriculum.checkpoint_every;
        while !self.mastery.is_over(self.steps, episodes, &goal) {
            if request.stop.is_wanted() {
                self.save_latest()?;
                progress.finish();
                return Err(self.interrupted(&request.run).into());
            }
            if let Some(rate) = self.episode()? {
                progress.say(&self.confirmation(rate));
                progress.forget_speed();
            }
            progress.update(&self.status());
            if self.steps >= checkpoint_at {
                checkpoint_at = self.steps + self.config.curriculum.checkpoint_every;
                self.save_latest()?;
            }
        }
        self.save_latest()?;
        progress.say("evaluating the best policy");
        let evaluation = self.close()?;
        progress.finish();
        self.time.total = started.elapsed().as_secs_f64();
        self.time.peak_memory = store::peak_memory();
        let digest = Digest::of(&store::read_bytes(&self.folder.join(record::METRICS))?);
        self.time.metrics_digest = Some(digest);
        write_json(&self.folder.join("timing.json"), &self.time)?;
        Ok(Finished {
            episodes: self.mastery.episodes,
            steps: self.steps,
            mastered: self.mastery.mastered,
            violations: violations(&[&self.evidence, &evaluation.evidence]),
            stage: self.stage,
            window_success_rate: self.mastery.success_rate(),
            digest,
            folder: self.folder,
            evaluation,
        })
    }

    /// When the stage is mastered.
    fn goal(&self) -> &Goal {
        self.config.curriculum.of(self.stage)
    }

    /// What a person is shown.
    fn status(&self) -> Status {
        let name = |joint: usize| short(&self.machine.joints()[joint].name).replace('_', " ");
        let (margin, place) = self
            .evidence
            .worst_actual()
            .map_or((1.0, String::new()), |(margin, joint, of)| (margin, format!("{} {of}", name(joint))));
        Status {
            episode: self.mastery.episodes,
            steps: self.steps,
            updates: self.time.updates,
            success_rate: self.mastery.success_rate(),
            return_: self.mastery.mean_return(),
            learner: self.learnt.map(|means| Learner {
                entropy_temperature: means.entropy_temperature,
                critic_loss: means.critic,
                actor_loss: means.actor,
            }),
            worst: Worst { margin, place },
        }
    }

    /// What is said of a confirmation.
    fn confirmation(&self, rate: f64) -> String {
        let (stage, episode) = (self.stage, self.mastery.episodes);
        let word = if self.mastery.mastered { "mastered" } else { "not enough yet" };
        let of = self.goal().confirm_episodes;
        format!(
            "{stage} episode {episode}: {:.1} % of {of} reached without exploration, {word}",
            100.0 * rate
        )
    }

    /// What is said of a training that was asked to stop.
    fn interrupted(&self, run: &str) -> Interrupted {
        let (stage, episodes, steps) = (self.stage, self.mastery.episodes, self.steps);
        Interrupted(format!(
            "{stage}: stopped after {episodes} episodes, {steps} steps; go on with: cargo xtask train --stage {stage} \
             --run {run} --resume"
        ))
    }

    /// One training episode, its record, and a confirmation if it is time for one; gives its success rate.
    fn episode(&mut self) -> Result<Option<f64>> {
        let number = self.mastery.episodes;
        let mut stream = Stream::of_episode(self.config.seed, Purpose::Training, self.stage, number);
        let episode = self.environment.draw(self.machine.regions().of(self.stage), &mut stream)?;
        self.environment.start(&episode)?;
        let acting = self.acting(number);
        let played = overlap::play(&mut self.environment, &mut self.agent, &self.scaling, acting)
            .with_context(|| format!("episode {number}"))?;
        let Played { ending, return_, losses, .. } = played;
        let steps = u64::from(self.environment.steps());
        self.steps += steps;
        self.time.steps += steps;
        self.time.updates += played.updates;
        self.time.environment += played.environment;
        self.time.learner += played.learner;
        let reached = ending == Ending::Reached;
        self.mastery.add(EpisodeResult { reached, return_ }, self.config.curriculum.of(self.stage));
        let seen = self.environment.take_evidence();
        self.evidence.join(&seen);
        let confirmed = self.confirm_if_due()?;
        self.learnt = losses.means().or(self.learnt);
        self.recorder.add(&EpisodeRecord {
            episode: self.mastery.episodes,
            step: self.steps,
            reached,
            return_,
            length: self.environment.steps(),
            tip_error: self.environment.distance(),
            success_rate: self.mastery.success_rate(),
            mean_return: self.mastery.mean_return(),
            intervention_rate: seen.intervention_rate(),
            violations: seen.reference_violations + seen.actual_violations,
            confirmed,
            losses: losses.means(),
        })?;
        Ok(confirmed)
    }

    /// Whether an episode explores.
    fn acting(&self, episode: u64) -> Acting {
        match self.config.curriculum.noiseless_every {
            0 => Acting::Exploring,
            every if (episode + 1).is_multiple_of(every) => Acting::Noiseless,
            _ => Acting::Exploring,
        }
    }

    /// Confirms the stage by a deterministic evaluation if its window of successes asks for one; gives the success rate.
    fn confirm_if_due(&mut self) -> Result<Option<f64>> {
        if !self.mastery.wants_confirmation(self.goal()) {
            return Ok(None);
        }
        let plan = self.plan(Purpose::Confirmation);
        let policy = self.agent.policy();
        let evaluation = evaluation::evaluate(policy, &self.scaling, &self.machine, plan)?;
        let rate = evaluation.summary.success_rate;
        self.evidence.join(&evaluation.evidence);
        if self.mastery.confirm(rate, self.config.curriculum.of(self.stage)) {
            self.save(&best(&self.folder))?;
        }
        Ok(Some(rate))
    }

    fn plan(&self, purpose: Purpose) -> Plan {
        let episodes = self.goal().confirm_episodes;
        Plan { stage: self.stage, episodes, seed: self.config.seed, purpose }
    }

    /// Evaluates the best policy on episodes never seen before and writes the results.
    ///
    /// Without any confirmation the present networks are the best there are. What is found here does not enter the
    /// state of the training, so that a training that stopped here and went on equals one that never stopped.
    fn close(&mut self) -> Result<Evaluation> {
        let path = best(&self.folder);
        if self.mastery.best_confirmed.is_none() {
            self.save(&path)?;
        }
        let (best, agent) = checkpoint::read(&path)?;
        let plan = self.plan(Purpose::Evaluation);
        let evaluation = evaluation::evaluate(agent.policy(), &self.scaling, &self.machine, plan)?;
        write_json(&self.folder.join("eval.json"), &evaluation.summary)?;
        let names = || self.machine.joints().iter().map(|joint| joint.name.as_str());
        let certificate = Certificate {
            schema: 1,
            stage: self.stage,
            seed: self.config.seed,
            plant: self.config.crane.plant.clone(),
            episodes: self.mastery.episodes,
            steps: self.steps,
            violations: violations(&[&self.evidence, &evaluation.evidence]),
            training: Part::new(names(), &self.evidence),
            evaluation: Part::new(names(), &evaluation.evidence),
        };
        write_json(&self.folder.join("certificate.json"), &certificate)?;
        let header = trained::Header {
            program: trained::program(),
            stage: self.stage,
            seed: self.config.seed,
            episodes: best.mastery.episodes,
            steps: best.steps,
            total_steps: agent.steps(),
            evaluation: evaluation.summary.clone(),
            certificate,
            scaling: self.scaling.clone(),
            config: self.config.clone(),
        };
        self.write_policy(&header, agent.policy())?;
        Ok(evaluation)
    }

    /// Writes the policy's file, and reads it again to see that it is what was evaluated.
    fn write_policy(&self, header: &trained::Header, policy: &Policy) -> Result<()> {
        let path = trained::file_of(&self.folder, self.stage);
        trained::write(&path, header, policy)?;
        let read = Trained::read(&path)?;
        ensure!(
            read.policy == *policy && read.header.as_ref() == Some(header),
            "{} is not what was evaluated",
            path.display()
        );
        Ok(())
    }

    fn save_latest(&mut self) -> Result<()> {
        let path = latest(&self.folder);
        self.save(&path)
    }

    fn save(&mut self, path: &Path) -> Result<()> {
        let (metrics_length, events_length) = self.recorder.sync()?;
        let header = Header {
            config: self.config.clone(),
            stage: self.stage,
            mastery: self.mastery.clone(),
            steps: self.steps,
            evidence: self.evidence.clone(),
            metrics_length,
            events_length,
            scaling: self.scaling.clone(),
        };
        checkpoint::write(path, &header, &self.agent)
    }
}

/// Limits that did not hold in any part.
fn violations(parts: &[&Evidence]) -> Violations {
    Violations {
        reference: parts.iter().map(|part| part.reference_violations).sum(),
        actual: parts.iter().map(|part| part.actual_violations).sum(),
    }
}

/// The newest checkpoint of a stage.
#[must_use]
pub fn latest(folder: &Path) -> PathBuf {
    folder.join("checkpoints").join("latest")
}

/// The checkpoint of a stage that was best when it was confirmed.
#[must_use]
pub fn best(folder: &Path) -> PathBuf {
    folder.join("checkpoints").join("best")
}

/// The agent of the stage before, ready to go on in this one: its replay is kept, since the regions are nested and what
/// was seen in the smaller one is as true in the larger.
fn inherit(path: &Path, config: &ConfigSpec, scaling: &Scaling) -> Result<Agent> {
    let (header, agent) = checkpoint::read(path)?;
    same_configuration(&header.config, config)
        .with_context(|| format!("{} was trained with another configuration", path.display()))?;
    same_crane(path, &header.scaling, scaling)?;
    Ok(agent)
}

/// Refuses a crane whose limits changed since: the learner knows its state by its share of them.
fn same_crane(path: &Path, trained: &Scaling, present: &Scaling) -> Result<()> {
    ensure!(
        trained.agrees_with(present),
        "{} scales its observations differently: the limits of the crane changed since; train its stage again under \
         another name, or restore the limits",
        path.display()
    );
    Ok(())
}

/// Refuses another configuration and says which fields differ.
fn same_configuration(trained: &ConfigSpec, wanted: &ConfigSpec) -> Result<()> {
    let found = difference::differences(trained, wanted)?;
    ensure!(found.is_empty(), "{}", found.join("; "));
    Ok(())
}

fn write_json(path: &Path, value: &impl serde::Serialize) -> Result<()> {
    let mut json = serde_json::to_vec_pretty(value)?;
    json.push(b'\n');
    store::write_whole(path, &json)
}

#[expect(clippy::disallowed_methods, reason = "the share of environment and learner is for a person to see")]
fn now() -> Instant {
    Instant::now()
}
