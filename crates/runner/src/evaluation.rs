//! Deterministic evaluation of a policy on fresh episodes.

use std::collections::BTreeMap;
use std::sync::Arc;

use anyhow::Result;
use sac_burn::Policy;
use serde::{Deserialize, Serialize};

use crate::draw::{Purpose, Stream};
use crate::environment::{Ending, Environment};
use crate::evidence::{Evidence, PerQuantity};
use crate::machine::Machine;
use crate::observation::Scaling;
use crate::stage::Stage;
use crate::statistics;

/// Most episodes that are named for having failed.
pub const MAX_NAMED: usize = 20;

/// Which episodes are played.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// The region.
    pub stage: Stage,
    /// How many.
    pub episodes: u64,
    /// Seed of starts and targets.
    pub seed: u64,
    /// Which stream they come from.
    pub purpose: Purpose,
}

/// Mean, median and 95 % quantile of a time \[s\]; `null` in JSON if nothing was reached.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Times {
    /// Arithmetic mean.
    pub mean: Option<f64>,
    /// Median.
    pub median: Option<f64>,
    /// 95 % quantile.
    pub p95: Option<f64>,
}

/// Mean and largest distance \[m\] or speed [m/s].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Distances {
    /// Arithmetic mean.
    pub mean: Option<f64>,
    /// The largest.
    pub max: Option<f64>,
}

/// How the tip arrives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Arrival {
    /// Distance of tip and target \[m\].
    pub tip_error_m: Distances,
    /// Speed of the tip [m/s].
    pub tip_speed_m_s: Distances,
}

/// The largest alone \[m\].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Largest {
    /// The largest.
    pub max: f64,
}

/// Counts of limits that did not hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Violations {
    /// Segments of the reference beyond a limit.
    pub reference: u64,
    /// Ticks of the actual motion beyond a limit.
    pub actual: u64,
}

/// Largest deviations of a joint from its reference.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrackingError {
    /// Of the position [rad or m].
    pub position_max: f64,
    /// Of the velocity [rad/s or m/s].
    pub velocity_max: f64,
}

/// The result of an evaluation; its fields are the keys of `eval.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Episodes played.
    pub episodes: u64,
    /// Share that reached the target.
    pub success_rate: f64,
    /// Wilson interval of the success rate at 95 % confidence.
    pub success_ci95: [f64; 2],
    /// Numbers of the first episodes that did not reach the target, [`MAX_NAMED`] at most, for `play --episode`.
    #[serde(default)] // files of earlier versions do not say
    pub not_reached: Vec<u64>,
    /// Time to reach the target, of the episodes that did.
    pub time_to_reach_s: Times,
    /// Distance of tip and target when the episode ended, of all episodes.
    pub tip_error_m: Distances,
    /// Distance and speed of the tip when the target was reached, of the episodes that did.
    #[serde(default)] // files of earlier versions do not say
    pub at_success: Arrival,
    /// Limits that did not hold.
    pub violations: Violations,
    /// Worst margins of the reference to the actuators' limits, over all joints, relative and exact.
    pub worst_margin: PerQuantity,
    /// Deviation from the reference, by joint.
    pub tracking_error: BTreeMap<String, TrackingError>,
    /// Displacement of the tip by the errors of all held joints together.
    pub held_joint_tip_error_m: Largest,
    /// Share of safe ranges that the position limits narrowed.
    pub intervention_rate: f64,
    /// Share of controller commands that saturated.
    pub saturation_rate: f64,
    /// Commands that the fail-safe gave.
    pub failsafe_count: u64,
}

/// What an evaluation found.
#[derive(Clone, Debug)]
pub struct Evaluation {
    /// For a reader.
    pub summary: Summary,
    /// For the certificate.
    pub evidence: Evidence,
}

struct Played {
    number: u64,
    reached: bool,
    steps: u32,
    tip_error: f64,
    tip_speed: f64,
}

/// Plays the plan's episodes with the policy's mean action.
///
/// Episodes are independent and are shared among the machine's cores; the result does not depend on how many there are.
///
/// # Errors
/// The region cannot be reached, or the simulation left its range.
pub fn evaluate(
    policy: &Policy,
    scaling: &Scaling,
    machine: &Arc<Machine>,
    plan: Plan,
) -> Result<Evaluation> {
    let workers = std::thread::available_parallelism().map_or(1, |n| n.get() as u64);
    let parts = std::thread::scope(|scope| {
        let handles: Vec<_> = (0..workers)
            .map(|worker| {
                let numbers = (worker..plan.episodes).step_by(workers as usize);
                scope.spawn(move || play(policy, scaling, machine, plan, numbers))
            })
            .collect();
        handles
            .into_iter()
            .map(|handle| {
                handle.join().expect("an episode that panics is a bug, and its message is on stderr")
            })
            .collect::<Result<Vec<_>>>()
    })?;
    let mut evidence = Evidence::none(machine.joints().len());
    let mut played = Vec::with_capacity(plan.episodes as usize);
    for (episodes, seen) in parts {
        evidence.join(&seen);
        played.extend(episodes);
    }
    played.sort_by_key(|episode: &Played| episode.number);
    let summary = summarise(&played, &evidence, machine);
    Ok(Evaluation { summary, evidence })
}

fn play(
    policy: &Policy,
    scaling: &Scaling,
    machine: &Arc<Machine>,
    plan: Plan,
    numbers: impl Iterator<Item = u64>,
) -> Result<(Vec<Played>, Evidence)> {
    let mut environment = Environment::new(Arc::clone(machine), true);
    let mut input = vec![0.0; scaling.len()];
    let mut action = vec![0.0; policy.action_dim()];
    let mut played = Vec::new();
    for number in numbers {
        let mut stream = Stream::of_episode(plan.seed, plan.purpose, plan.stage, number);
        let episode = environment.draw(machine.regions().of(plan.stage), &mut stream)?;
        environment.start(&episode)?;
        let ending = loop {
            environment.observe(scaling, &mut input);
            policy.act(&input, &mut action);
            if let Some(ending) = environment.step(&action)?.ending {
                break ending;
            }
        };
        let (reached, steps) = (ending == Ending::Reached, environment.steps());
        let (tip_error, tip_speed) = (environment.distance(), environment.speed());
        played.push(Played { number, reached, steps, tip_error, tip_speed });
    }
    Ok((played, environment.take_evidence()))
}

fn distances(sample: &[f64]) -> Distances {
    Distances { mean: statistics::mean(sample), max: statistics::maximum(sample) }
}

fn summarise(played: &[Played], evidence: &Evidence, machine: &Machine) -> Summary {
    let period = machine.rates().policy_period();
    let times: Vec<f64> = played.iter().filter(|e| e.reached).map(|e| f64::from(e.steps) * period).collect();
    let errors: Vec<f64> = played.iter().map(|e| e.tip_error).collect();
    let at_success =
        |of: fn(&Played) -> f64| distances(&played.iter().filter(|e| e.reached).map(of).collect::<Vec<_>>());
    let joint_errors = machine.joints().iter().zip(&evidence.joints).map(|(joint, seen)| {
        let error =
            TrackingError { position_max: seen.position_error_max, velocity_max: seen.velocity_error_max };
        (joint.name.clone(), error)
    });
    Summary {
        episodes: played.len() as u64,
        success_rate: times.len() as f64 / played.len().max(1) as f64,
        success_ci95: statistics::wilson_95(times.len(), played.len()),
        not_reached: played.iter().filter(|e| !e.reached).map(|e| e.number).take(MAX_NAMED).collect(),
        time_to_reach_s: Times {
            mean: statistics::mean(&times),
            median: statistics::quantile(&times, 0.5),
            p95: statistics::quantile(&times, 0.95),
        },
        tip_error_m: distances(&errors),
        at_success: Arrival {
            tip_error_m: at_success(|episode| episode.tip_error),
            tip_speed_m_s: at_success(|episode| episode.tip_speed),
        },
        violations: Violations {
            reference: evidence.reference_violations,
            actual: evidence.actual_violations,
        },
        worst_margin: evidence.worst_reference_margin(),
        tracking_error: joint_errors.collect(),
        held_joint_tip_error_m: Largest { max: evidence.held_joint_tip_error },
        intervention_rate: evidence.intervention_rate(),
        saturation_rate: evidence.saturation_rate(),
        failsafe_count: evidence.failsafe_commands,
    }
}
