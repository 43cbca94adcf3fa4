//! The whole agent as a stream: resuming from it continues bit for bit.

use std::io::{Read, Write};

use serde::{Deserialize, Serialize};

use crate::agent::{Agent, AgentError};
use crate::config::Config;
use crate::network::Optimizer;
use crate::noise::Noise;
use crate::policy::count;
use crate::wire::{CheckpointError, Format, Frame, Unframe, check_finite};

/// Version 1 had no averaged policy: its policy was the actor.
const FORMAT: Format = Format { magic: *b"sac-agnt", name: "agent checkpoint", version: 2, upgrade };

fn upgrade(version: u32, header: &mut serde_json::Value) {
    if version == 1
        && let Some(config) = header.get_mut("config").and_then(serde_json::Value::as_object_mut)
    {
        config.insert("policy_share".into(), 1.0.into());
    }
}

/// Everything but the numbers: enough to know how many of them follow.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Header {
    config: Config,
    observation_dim: usize,
    action_dim: usize,
    steps: u64,
    updates: u64,
    actor_steps: u64,
    critic_steps: u64,
    temperature_steps: u64,
    replay_len: usize,
    replay_next: usize,
    noise: Noise,
}

impl Agent {
    /// Writes everything that resuming needs: networks, target critics, policy, Adam moments and step counts, entropy
    /// temperature, the filled part of the replay memory, the state of the generator, counters, configuration.
    ///
    /// Many small writes: hand in a buffered writer. The caller sees to it that a file is written whole or not at
    /// all; a torn one is refused by [`Agent::load`].
    ///
    /// # Errors
    /// [`CheckpointError::NotFinite`] if training has diverged, before anything is written;
    /// [`CheckpointError::Io`] if the writer fails.
    pub fn save(&self, out: &mut impl Write) -> Result<(), CheckpointError> {
        self.check_finite()?;
        let header = Header {
            config: self.config.clone(),
            observation_dim: self.observation_dim,
            action_dim: self.action_dim,
            steps: self.steps,
            updates: self.updates,
            actor_steps: self.actor_optimizer.steps,
            critic_steps: self.critic_optimizer.steps,
            temperature_steps: self.temperature.steps,
            replay_len: self.replay.len(),
            replay_next: self.replay.next(),
            noise: self.noise.clone(),
        };
        let mut frame = Frame::begin(out, FORMAT, &header, number_bytes(&header, FORMAT.version))?;
        for value in [self.temperature.log, self.temperature.moments[0], self.temperature.moments[1]] {
            frame.double(value)?;
        }
        for network in [&self.actor, &self.critics, &self.targets] {
            let mut result = Ok(());
            network.visit(|values| {
                if result.is_ok() {
                    result = frame.numbers(values);
                }
            });
            result?;
        }
        for (weights, bias) in self.policy.layers() {
            frame.numbers(weights)?;
            frame.numbers(bias)?;
        }
        for optimizer in [&self.actor_optimizer, &self.critic_optimizer] {
            for moments in optimizer.moments.iter().flatten() {
                frame.numbers(&moments.first)?;
                frame.numbers(&moments.second)?;
            }
        }
        frame.numbers(self.replay.rows())?;
        frame.finish()
    }

    /// Reads what [`Agent::save`] wrote, and leaves the reader just behind it.
    ///
    /// The agent's configuration is that of the checkpoint; [`Agent::start_from`] replaces it. Hand in a buffered
    /// reader.
    ///
    /// # Errors
    /// [`CheckpointError`], with the cause, if the stream is no checkpoint, of another version, truncated, damaged,
    /// not finite or contradicts itself, or if there is no memory for its replay.
    pub fn load(input: &mut impl Read) -> Result<Self, CheckpointError> {
        let (mut frame, header) = Unframe::begin::<Header>(input, FORMAT)?;
        check_replay(&header)?;
        let version = frame.version();
        frame.expect_numbers(number_bytes(&header, version))?;
        let (observation_dim, action_dim) = (header.observation_dim, header.action_dim);
        let mut agent =
            Self::new(header.config, observation_dim, action_dim, 0).map_err(|error| match error {
                AgentError::Replay(error) => CheckpointError::Replay(error),
                _ => {
                    CheckpointError::Inconsistent { part: "a dimension of the agent", expected: 1, found: 0 }
                }
            })?;
        agent.temperature.log = frame.double()?;
        agent.temperature.moments = [frame.double()?, frame.double()?];
        for network in [&mut agent.actor, &mut agent.critics, &mut agent.targets] {
            network.visit_mut(|values| frame.numbers(values))?;
        }
        agent.refresh_explorer();
        agent.policy.clone_from(&agent.explorer);
        if version > 1 {
            agent.policy.visit_mut(|values| frame.numbers(values))?;
        }
        for optimizer in [&mut agent.actor_optimizer, &mut agent.critic_optimizer] {
            read_moments(&mut frame, optimizer)?;
        }
        agent.replay.restore(header.replay_len, header.replay_next, |row| frame.numbers(row))?;
        frame.finish()?;
        agent.actor_optimizer.steps = header.actor_steps;
        agent.critic_optimizer.steps = header.critic_steps;
        agent.temperature.steps = header.temperature_steps;
        agent.steps = header.steps;
        agent.updates = header.updates;
        agent.noise = header.noise;
        agent.check_finite()?;
        Ok(agent)
    }

    /// What is learnt; the replay memory takes finite numbers alone.
    fn check_finite(&self) -> Result<(), CheckpointError> {
        let temperature = &self.temperature;
        for value in [temperature.log, temperature.moments[0], temperature.moments[1]] {
            if !value.is_finite() {
                return Err(CheckpointError::NotFinite { part: "entropy temperature", value });
            }
        }
        for (part, network) in
            [("actor", &self.actor), ("critics", &self.critics), ("target critics", &self.targets)]
        {
            let mut result = Ok(());
            network.visit(|values| {
                if result.is_ok() {
                    result = check_finite(part, values);
                }
            });
            result?;
        }
        for (weights, bias) in self.policy.layers() {
            check_finite("policy", weights)?;
            check_finite("policy", bias)?;
        }
        for optimizer in [&self.actor_optimizer, &self.critic_optimizer] {
            for moments in optimizer.moments.iter().flatten() {
                check_finite("moments of Adam", &moments.first)?;
                check_finite("moments of Adam", &moments.second)?;
            }
        }
        Ok(())
    }
}

fn read_moments<R: Read>(
    frame: &mut Unframe<'_, R>,
    optimizer: &mut Optimizer,
) -> Result<(), CheckpointError> {
    for moments in optimizer.moments.iter_mut().flatten() {
        frame.numbers(&mut moments.first)?;
        frame.numbers(&mut moments.second)?;
    }
    Ok(())
}

/// The ring's position must be one that a ring of this capacity and filling can have.
fn check_replay(header: &Header) -> Result<(), CheckpointError> {
    let capacity = header.config.spec().replay_capacity as u64;
    let (len, next) = (header.replay_len as u64, header.replay_next as u64);
    if len > capacity {
        return Err(CheckpointError::Inconsistent { part: "replay_len", expected: capacity, found: len });
    }
    let limit = if len == capacity { capacity } else { 1 };
    if next >= limit {
        return Err(CheckpointError::Inconsistent { part: "replay_next", expected: limit - 1, found: next });
    }
    Ok(())
}

/// Bytes of numbers that belong to a header; saturates, so that no header can wrap it.
fn number_bytes(header: &Header, version: u32) -> u64 {
    let hidden = header.config.spec().hidden.as_slice();
    let (o, a) = (header.observation_dim, header.action_dim);
    let actor = count(&[&[o], hidden, &[a.saturating_mul(2)]].concat());
    let critic = count(&[&[o.saturating_add(a)], hidden, &[1]].concat());
    // Actor with two moments and, from version 2 on, its average; two critics, their targets, two moments of the critics.
    let networks =
        actor.saturating_mul(if version > 1 { 4 } else { 3 }).saturating_add(critic.saturating_mul(8));
    let row = (o as u64).saturating_mul(2).saturating_add(a as u64).saturating_add(2);
    let replay = row.saturating_mul(header.replay_len as u64);
    networks.saturating_add(replay).saturating_mul(4).saturating_add(24)
}

#[cfg(test)]
mod tests;
