//! One episode of a trained policy, step by step, for a person to read.

use std::fmt;

use anyhow::Result;
use serde::Serialize;

use crate::actions::Take;
use crate::draw::{Purpose, Stream};
use crate::environment::{Ending, Environment};
use crate::evaluation::Violations;
use crate::stage::Stage;
use crate::trained::Trained;

/// One episode; as JSON, every number in SI units.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Played {
    /// The stage that the policy was trained in.
    pub policy_stage: Stage,
    /// The stage in whose region start and target lie.
    pub stage: Stage,
    /// Seed of start and target.
    pub seed: u64,
    /// Number of the episode, as in an evaluation with that seed.
    pub episode: u64,
    /// Names of the joints that the policy moves.
    pub joints: Vec<String>,
    /// Their positions at the start [rad or m].
    pub start: Vec<f64>,
    /// Target in the world \[m\].
    pub target: [f64; 3],
    /// Every policy step.
    pub steps: Vec<PlayedStep>,
    /// How it ended.
    pub result: PlayedResult,
}

/// One policy step: what was there when it began, and what it brought.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlayedStep {
    /// Since the start of the episode \[s\].
    pub time: f64,
    /// Tip in the world \[m\].
    pub tip: [f64; 3],
    /// Distance of tip and target \[m\].
    pub distance: f64,
    /// Tip speed [m/s].
    pub speed: f64,
    /// The action, by joint.
    pub action: Vec<f32>,
    /// Whether a position limit narrowed the safe range, by joint.
    pub narrowed: Vec<bool>,
    /// Reward of the step.
    pub reward: f64,
}

/// How an episode ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PlayedResult {
    /// True if the target was reached.
    pub reached: bool,
    /// Duration \[s\].
    pub time: f64,
    /// Distance of tip and target at the end \[m\].
    pub tip_error: f64,
    /// Tip speed at the end [m/s].
    pub speed: f64,
    /// Sum of the rewards.
    #[serde(rename = "return")]
    pub return_: f64,
    /// Limits that did not hold.
    pub violations: Violations,
}

/// Plays one episode of an evaluation with the policy's mean action.
///
/// # Errors
/// The crane cannot be loaded, the region cannot be reached, or the simulation left its range.
pub fn play(trained: &Trained, take: Take) -> Result<Played> {
    let Take { stage, seed, episode } = take;
    let machine = trained.machine()?;
    let period = machine.rates().policy_period();
    let mut environment = Environment::new(machine.clone(), false);
    let mut stream = Stream::of_episode(seed, Purpose::Evaluation, stage, episode);
    let drawn = environment.draw(machine.regions().of(stage), &mut stream)?;
    environment.start(&drawn)?;
    let mut input = vec![0.0; trained.scaling.len()];
    let mut action = vec![0.0; trained.policy.action_dim()];
    let mut steps = Vec::new();
    let mut return_ = 0.0;
    let ending = loop {
        environment.observe(&trained.scaling, &mut input);
        trained.policy.act(&input, &mut action);
        let (tip, distance, speed) = (environment.tip(), environment.distance(), environment.tip_speed());
        let narrowed = machine.moving().iter().map(|&joint| {
            let reference = environment.motion().reference()[joint];
            machine.joints()[joint].zone.range(reference.position, reference.velocity).narrowed
        });
        let narrowed = narrowed.collect();
        let time = f64::from(environment.steps()) * period;
        let step = environment.step(&action)?;
        return_ += step.reward;
        let action = action.clone();
        steps.push(PlayedStep { time, tip, distance, speed, action, narrowed, reward: step.reward });
        if let Some(ending) = step.ending {
            break ending;
        }
    };
    let evidence = environment.take_evidence();
    Ok(Played {
        policy_stage: trained.stage,
        stage,
        seed,
        episode,
        joints: machine.moving().iter().map(|&joint| machine.joints()[joint].name.clone()).collect(),
        start: machine.moving().iter().map(|&joint| drawn.start[joint]).collect(),
        target: drawn.target,
        result: PlayedResult {
            reached: ending == Ending::Reached,
            time: f64::from(environment.steps()) * period,
            tip_error: environment.distance(),
            speed: environment.tip_speed(),
            return_,
            violations: Violations {
                reference: evidence.reference_violations,
                actual: evidence.actual_violations,
            },
        },
        steps,
    })
}

impl fmt::Display for Played {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> =
            self.joints.iter().map(|name| name.strip_suffix("_joint").unwrap_or(name)).collect();
        writeln!(
            f,
            "policy of stage {}, episode {} of stage {}, seed {}",
            self.policy_stage, self.episode, self.stage, self.seed
        )?;
        let start: Vec<String> =
            names.iter().zip(&self.start).map(|(name, at)| format!("{name} {at:.3}")).collect();
        let [x, _, z] = self.target;
        writeln!(f, "start {}; target x {x:.3} m, z {z:.3} m\n", start.join(", "))?;
        write!(f, "{:>7} {:>8} {:>8} {:>9} {:>7} ", "time", "tip x", "tip z", "distance", "speed")?;
        let widths: Vec<usize> = names.iter().map(|name| name.chars().count().max(6)).collect();
        for (name, width) in names.iter().zip(&widths) {
            write!(f, " {name:>width$}")?;
        }
        writeln!(f, "  {:>7}  narrowed", "reward")?;
        write!(f, "{:>7} {:>8} {:>8} {:>9} {:>7} ", "s", "m", "m", "m", "m/s")?;
        for width in &widths {
            write!(f, " {:>width$}", "action")?;
        }
        writeln!(f)?;
        for step in &self.steps {
            let [x, _, z] = step.tip;
            let PlayedStep { time, distance, speed, reward, .. } = step;
            write!(f, "{time:>7.2} {x:>8.3} {z:>8.3} {distance:>9.3} {speed:>7.3} ")?;
            for (action, width) in step.action.iter().zip(&widths) {
                write!(f, " {action:>+width$.2}")?;
            }
            let narrowed = names.iter().zip(&step.narrowed).filter(|(_, narrowed)| **narrowed);
            let narrowed: Vec<&str> = narrowed.map(|(name, _)| *name).collect();
            let narrowed = if narrowed.is_empty() { "-".to_owned() } else { narrowed.join(" ") };
            writeln!(f, "  {reward:>+7.2}  {narrowed}")?;
        }
        let PlayedResult { reached, time, tip_error, speed, return_, violations } = self.result;
        writeln!(
            f,
            "\n{} after {} steps, {time:.2} s: {:.1} cm from the target at {:.1} cm/s, return {return_:.2}, violations of \
             limits {} (reference) and {} (actual)",
            if reached { "reached" } else { "not reached" },
            self.steps.len(),
            100.0 * tip_error,
            100.0 * speed,
            violations.reference,
            violations.actual
        )
    }
}
