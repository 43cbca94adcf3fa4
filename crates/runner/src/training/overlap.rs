//! One episode in which environment and learner work side by side on two cores.
//!
//! The schedule is fixed, so the result does not depend on which of them is quicker: the action of step t is chosen,
//! then the environment takes step t while the learner makes the update that the transition of step t − 1 is due, and
//! only then is transition t remembered.

use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::time::Instant;

use anyhow::{Context, Result};
use sac_burn::{Agent, Outcome, Transition};

use super::now;
use super::record::LossMeans;
use crate::environment::{Ending, Environment};
use crate::observation::Scaling;

/// What an episode brought.
#[derive(Debug)]
pub(super) struct Played {
    pub(super) ending: Ending,
    pub(super) return_: f64,
    pub(super) losses: LossMeans,
    pub(super) updates: u64,
    /// Time of the environment \[s\].
    pub(super) environment: f64,
    /// Time of the learner \[s\].
    pub(super) learner: f64,
}

/// What the environment answers to an action.
struct Seen {
    observation: Vec<f32>,
    reward: f64,
    ending: Option<Ending>,
    seconds: f64,
}

/// How an episode's actions are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Acting {
    /// The actor draws them.
    Exploring,
    /// The policy's mean, as in an evaluation; drawn all the same while the learner warms up.
    Noiseless,
}

/// Plays the episode that `environment` has begun, and learns from it.
///
/// # Errors
/// The simulation left its range, or learning diverged.
pub(super) fn play(
    environment: &mut Environment,
    agent: &mut Agent,
    scaling: &Scaling,
    acting: Acting,
) -> Result<Played> {
    let mut observation = vec![0.0; scaling.len()];
    environment.observe(scaling, &mut observation);
    std::thread::scope(|scope| {
        let (to_environment, actions) = sync_channel::<Vec<f32>>(1);
        let (to_learner, answers) = sync_channel(1);
        scope.spawn(move || {
            for action in actions {
                if to_learner.send(step(environment, scaling, &action)).is_err() {
                    break;
                }
            }
        });
        learn(agent, observation, acting, &to_environment, &answers)
    })
}

fn step(environment: &mut Environment, scaling: &Scaling, action: &[f32]) -> Result<Seen> {
    let begun = now();
    let step = environment.step(action)?;
    let mut observation = vec![0.0; scaling.len()];
    environment.observe(scaling, &mut observation);
    Ok(Seen { observation, reward: step.reward, ending: step.ending, seconds: seconds(begun) })
}

/// The learner's part.
fn learn(
    agent: &mut Agent,
    mut observation: Vec<f32>,
    acting: Acting,
    to_environment: &SyncSender<Vec<f32>>,
    answers: &Receiver<Result<Seen>>,
) -> Result<Played> {
    const GONE: &str = "the environment answers every action; if it panicked, its message is on stderr";
    let mut played = Played {
        ending: Ending::TimeOut,
        return_: 0.0,
        losses: LossMeans::default(),
        updates: 0,
        environment: 0.0,
        learner: 0.0,
    };
    loop {
        let begun = now();
        let mut action = vec![0.0; agent.action_dim()];
        if acting == Acting::Noiseless && agent.updates() > 0 {
            agent.act_deterministic(&observation, &mut action);
        } else {
            agent.act(&observation, &mut action);
        }
        to_environment.send(action.clone()).expect(GONE);
        for _ in 0..agent.config().spec().updates_per_step {
            if let Some(update) = agent.update() {
                played.losses.add(&update).context("learning diverged")?;
                played.updates += 1;
            }
        }
        played.learner += seconds(begun);
        let seen = answers.recv().expect(GONE)?;
        let outcome = match seen.ending {
            None => Outcome::Continues,
            Some(Ending::Reached) => Outcome::Terminal,
            // Neither is the task's doing: what would have followed counts as if the episode had gone on.
            Some(Ending::TimeOut | Ending::Overload) => Outcome::Truncated,
        };
        agent.remember(&Transition {
            observation: &observation,
            action: &action,
            reward: seen.reward as f32,
            next_observation: &seen.observation,
            outcome,
        })?;
        played.environment += seen.seconds;
        played.return_ += seen.reward;
        observation = seen.observation;
        if let Some(ending) = seen.ending {
            played.ending = ending;
            return Ok(played);
        }
    }
}

fn seconds(begun: Instant) -> f64 {
    begun.elapsed().as_secs_f64()
}
