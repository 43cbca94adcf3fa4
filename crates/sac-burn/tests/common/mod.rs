//! A small agent and a small world for the integration tests.
#![allow(dead_code, reason = "each test binary uses a part")]

use sac_burn::{Agent, Config, ConfigSpec, Losses, Outcome, Transition};

/// Two layers of 32, batches of 32, updates from the 64th transition.
pub(crate) fn small() -> ConfigSpec {
    ConfigSpec {
        batch_size: 32,
        replay_capacity: 300,
        random_steps: 50,
        update_after: 64,
        learning_rate: 1e-3,
        polyak: 0.005,
        hidden: vec![32, 32],
        ..Config::table_1().spec().clone()
    }
}

pub(crate) fn agent(spec: ConfigSpec, seed: u64) -> Agent {
    let config = Config::try_from(spec).expect("the specification is valid");
    Agent::new(config, 3, 2, seed).expect("there is memory for the replay")
}

/// A deterministic world of three observed numbers: enough to exercise the agent, nothing to learn.
pub(crate) struct World {
    pub(crate) tick: u64,
}

impl World {
    fn observation(&self) -> [f32; 3] {
        let t = self.tick as f32;
        [(0.3 * t).sin(), (0.7 * t).cos(), (0.11 * t).sin()]
    }

    /// Runs the agent for `steps` steps with an update after each; bits of every action and every loss.
    pub(crate) fn run(&mut self, agent: &mut Agent, steps: u64) -> Vec<u64> {
        let mut trace = Vec::new();
        for _ in 0..steps {
            let observation = self.observation();
            let mut action = [0.0; 2];
            agent.act(&observation, &mut action);
            self.tick += 1;
            let outcome = match self.tick % 17 {
                0 => Outcome::Terminal,
                9 => Outcome::Truncated,
                _ => Outcome::Continues,
            };
            let next_observation = self.observation();
            let transition = Transition {
                observation: &observation,
                action: &action,
                reward: observation[0] * action[0] - action[1].abs(),
                next_observation: &next_observation,
                outcome,
            };
            agent.remember(&transition).expect("the transition is finite");
            trace.extend(action.map(|a| u64::from(a.to_bits())));
            trace.extend(agent.update().map(bits).into_iter().flatten());
        }
        trace
    }
}

pub(crate) fn bits(losses: Losses) -> [u64; 8] {
    [
        losses.critic,
        losses.actor,
        losses.temperature,
        losses.entropy_temperature,
        losses.mean_q,
        losses.mean_target,
        losses.entropy,
        losses.mean_reward,
    ]
    .map(f64::to_bits)
}

pub(crate) fn saved(agent: &Agent) -> Vec<u8> {
    let mut bytes = Vec::new();
    agent.save(&mut bytes).expect("memory can be written");
    bytes
}
