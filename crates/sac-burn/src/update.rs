//! One gradient update of an agent.

use tracing::trace_span;

use crate::adam::Adam;
use crate::agent::Agent;
use crate::blocks::Blocks;
use crate::losses::Losses;
use crate::noise::Noise;
use crate::objective::{critic_loss, mean, smaller, targets};
use crate::replay::Batch;
use crate::squash::{head_gradient, sample};

impl Agent {
    /// One gradient update of critics, actor, entropy temperature and target critics, in this order.
    ///
    /// `None`, and nothing happens, until the replay memory holds `update_after` transitions and a batch. The actor
    /// sees the critics just updated; all parts use the temperature from before.
    pub fn update(&mut self) -> Option<Losses> {
        if self.replay.len() < self.config.update_threshold() {
            return None;
        }
        let _span = trace_span!("update", update = self.updates).entered();
        let mut batch = std::mem::take(&mut self.batch);
        self.replay.sample(self.config.spec().batch_size, &mut self.noise, &mut batch);
        let adam = Adam::new(self.config.spec());
        let mut losses = Losses {
            entropy_temperature: self.temperature.value(),
            mean_reward: mean(&batch.rewards),
            ..Losses::default()
        };
        self.update_critics(&batch, &adam, &mut losses);
        self.update_actor(&batch, &adam, &mut losses);
        let target_entropy = self.config.target_entropy(self.action_dim);
        losses.temperature = self.temperature.step(&adam, -losses.entropy, target_entropy);
        self.follow_actor();
        self.batch = batch;
        self.updates += 1;
        Some(losses)
    }

    fn update_critics(&mut self, batch: &Batch, adam: &Adam, losses: &mut Losses) {
        let spec = self.config.spec();
        let noise = normal(&mut self.noise, spec.batch_size * self.action_dim);
        let head = self.actor.forward(&self.actor_input(&batch.next_observations));
        let next = sample(&head, &noise, self.action_dim, self.std_bounds());
        let next_q = self.targets.forward(&self.critic_input(&batch.next_observations, &next.actions));
        let alpha = losses.entropy_temperature as f32;
        let targets = targets(batch, &next_q, &next.log_probabilities, spec.discount as f32, alpha);

        let input = self.critic_input(&batch.observations, &batch.actions);
        let tape = self.critics.forward_taped(&input);
        losses.mean_q = mean(&tape.output);
        losses.mean_target = mean(&targets);
        let (loss, slope) = critic_loss(&tape.output, &targets);
        losses.critic = loss;
        let gradients = self.critics.gradients(&tape, &slope);
        let polyak = spec.polyak as f32;
        let optimizer = &mut self.critic_optimizer;
        self.critics.step_followed(adam, optimizer, &gradients, &mut self.targets, polyak);
    }

    fn update_actor(&mut self, batch: &Batch, adam: &Adam, losses: &mut Losses) {
        let noise = normal(&mut self.noise, self.config.spec().batch_size * self.action_dim);
        let input = self.actor_input(&batch.observations);
        let tape = self.actor.forward_taped(&input);
        let bounds = self.std_bounds();
        let drawn = sample(&tape.output, &noise, self.action_dim, bounds);
        let critic_input = self.critic_input(&batch.observations, &drawn.actions);
        let critic_tape = self.critics.forward_taped(&critic_input);
        let (values, mask) = smaller(&critic_tape.output);
        let inputs = self.observation_dim + self.action_dim;
        let value_slope = self.critics.input_gradient(&critic_tape, &mask, self.observation_dim, inputs);

        let mean_log_probability = mean(&drawn.log_probabilities);
        losses.entropy = -mean_log_probability;
        losses.actor = losses.entropy_temperature * mean_log_probability - mean(&values);
        let alpha = losses.entropy_temperature as f32;
        let (head, actions) = (&tape.output, &drawn.actions);
        let slope = head_gradient(head, &noise, actions, &value_slope, alpha, self.action_dim, bounds);
        let gradients = self.actor.gradients(&tape, &slope);
        self.actor.step(adam, &mut self.actor_optimizer, &gradients);
    }

    fn actor_input(&self, observations: &[f32]) -> Blocks {
        Blocks::from_rows(&[(observations, self.observation_dim)])
    }

    /// Observation and action side by side.
    fn critic_input(&self, observations: &[f32], actions: &[f32]) -> Blocks {
        Blocks::from_rows(&[(observations, self.observation_dim), (actions, self.action_dim)])
    }
}

fn normal(noise: &mut Noise, count: usize) -> Vec<f32> {
    let mut values = vec![0.0; count];
    noise.fill_normal(&mut values);
    values
}

#[cfg(test)]
mod tests;
