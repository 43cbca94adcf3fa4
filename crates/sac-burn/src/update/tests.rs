//! One whole update against the same update by automatic differentiation, from the definitions.

use burn::tensor::activation::relu;
use burn::tensor::{Device, Tensor, TensorData};

use super::*;
use crate::config::{Config, ConfigSpec};
use crate::network::Network;
use crate::transition::{Outcome, Transition};

const OBSERVATION: usize = 5;
const ACTION: usize = 2;
const BATCH: usize = 24;
const DISCOUNT: f64 = 0.9;
const RATE: f64 = 1e-2;
const POLYAK: f64 = 0.25;
const ALPHA: f64 = 0.3;

/// With β₁ = β₂ = 0 one Adam step moves each parameter by η·g/(|g| + ε), and ε is so large here
/// that the move tells the size of the gradient and not only its sign.
fn agent() -> Agent {
    let spec = ConfigSpec {
        batch_size: BATCH,
        replay_capacity: 100,
        discount: DISCOUNT,
        learning_rate: RATE,
        polyak: POLYAK,
        random_steps: 0,
        update_after: BATCH,
        hidden: vec![12, 9],
        initial_entropy_temperature: ALPHA,
        adam_beta_1: 0.0,
        adam_beta_2: 0.0,
        adam_epsilon: 1.0,
        ..Config::table_1().spec().clone()
    };
    let mut agent = Agent::new(Config::try_from(spec).unwrap(), OBSERVATION, ACTION, 21).unwrap();
    let mut noise = Noise::new(22);
    let mut draw = |values: &mut [f32]| values.fill_with(|| noise.uniform(1.0));
    for step in 0..60 {
        let (mut observation, mut next_observation) = ([0.0; OBSERVATION], [0.0; OBSERVATION]);
        let (mut action, mut reward) = ([0.0; ACTION], [0.0]);
        draw(&mut observation);
        draw(&mut next_observation);
        draw(&mut action);
        draw(&mut reward);
        let transition = Transition {
            observation: &observation,
            action: &action,
            reward: 3.0 * reward[0],
            next_observation: &next_observation,
            outcome: [Outcome::Continues, Outcome::Terminal, Outcome::Truncated][step % 3],
        };
        agent.remember(&transition).unwrap();
    }
    agent
}

fn parameters(network: &Network) -> Vec<Vec<f32>> {
    let mut arrays = Vec::new();
    network.visit(|values| arrays.push(values.to_vec()));
    arrays
}

fn tensor(values: &[f32], shape: [usize; 2]) -> Tensor<2> {
    Tensor::from_data(TensorData::new(values.to_vec(), shape), &Device::flex().autodiff())
}

fn numbers<const D: usize>(tensor: &Tensor<D>) -> Vec<f32> {
    tensor.clone().into_data().as_slice::<f32>().unwrap().to_vec()
}

/// One member of a network as leaves of the graph: weights and bias, layer by layer.
struct Leaves(Vec<Tensor<2>>);

impl Leaves {
    fn of(network: &Network, member: usize) -> Self {
        let mut leaves = Vec::new();
        for (pair, arrays) in network.widths().windows(2).zip(parameters(network).chunks(2)) {
            let part = |array: &[f32], rows: usize| {
                let size = rows * pair[1];
                tensor(&array[member * size..(member + 1) * size], [rows, pair[1]]).require_grad()
            };
            leaves.push(part(&arrays[0], pair[0]));
            leaves.push(part(&arrays[1], 1));
        }
        Self(leaves)
    }

    fn forward(&self, input: Tensor<2>) -> Tensor<2> {
        let last = self.0.len() / 2 - 1;
        self.0.chunks(2).enumerate().fold(input, |x, (index, layer)| {
            let y = x.matmul(layer[0].clone()) + layer[1].clone();
            if index < last { relu(y) } else { y }
        })
    }

    /// Parameters after one Adam step without momentum on `loss`: p − η·g/(|g| + ε).
    fn stepped(&self, loss: Tensor<1>) -> Vec<Vec<f32>> {
        let mut slopes = loss.backward();
        let step = |leaf: &Tensor<2>| {
            let gradient = numbers(&leaf.grad_remove(&mut slopes).unwrap());
            let moved = numbers(leaf).into_iter().zip(gradient).map(|(p, g)| {
                let g = f64::from(g);
                (f64::from(p) - RATE * g / (g.abs() + 1.0)) as f32
            });
            moved.collect()
        };
        self.0.iter().map(step).collect()
    }
}

/// Actions and ln π, [batch, 1], straight from the definition: ln N(u; μ, σ) − Σ ln(1 − tanh² u).
fn draw(actor: &Leaves, observations: Tensor<2>, noise: &[f32]) -> (Tensor<2>, Tensor<2>) {
    let head = actor.forward(observations);
    let mean = head.clone().slice([0..BATCH, 0..ACTION]);
    let log_std = head.slice([0..BATCH, ACTION..2 * ACTION]);
    let epsilon = tensor(noise, [BATCH, ACTION]);
    let action = (mean + log_std.clone().exp() * epsilon.clone()).tanh();
    let normal = epsilon.powf_scalar(2.0) * -0.5 - log_std - 0.5 * (2.0 * std::f64::consts::PI).ln();
    let log = normal - (action.clone().powf_scalar(2.0) * -1.0 + 1.0).log();
    (action, log.sum_dim(1))
}

fn smaller_q(critics: &[Leaves; 2], input: &Tensor<2>) -> Tensor<2> {
    critics[0].forward(input.clone()).min_pair(critics[1].forward(input.clone()))
}

#[track_caller]
fn check_close(what: &str, found: &[Vec<f32>], expected: &[Vec<f32>], before: &[Vec<f32>]) {
    for (array, ((found, expected), before)) in found.iter().zip(expected).zip(before).enumerate() {
        assert_eq!(found.len(), expected.len(), "{what}: lengths of array {array}");
        assert_ne!(expected, before, "{what}: the reference does not move array {array}");
        for (i, (f, e)) in found.iter().zip(expected).enumerate() {
            assert!(
                (f - e).abs() < 1e-6,
                "{what}, array {array}[{i}]: {f} against {e}, before {}",
                before[i]
            );
        }
    }
}

/// Arrays of two members one behind the other, as [`Network::visit`] shows them.
fn side_by_side(first: Vec<Vec<f32>>, second: Vec<Vec<f32>>) -> Vec<Vec<f32>> {
    first.into_iter().zip(second).map(|(a, b)| [a, b].concat()).collect()
}

#[test]
fn an_update_agrees_with_automatic_differentiation_of_the_definitions() {
    let mut agent = agent();
    // The draws of the coming update, in its order: batch, next actions, fresh actions.
    let (mut generator, mut batch) = (agent.noise.clone(), Batch::default());
    agent.replay.sample(BATCH, &mut generator, &mut batch);
    let next_noise = normal(&mut generator, BATCH * ACTION);
    let fresh_noise = normal(&mut generator, BATCH * ACTION);
    let observations = tensor(&batch.observations, [BATCH, OBSERVATION]);
    let next_observations = tensor(&batch.next_observations, [BATCH, OBSERVATION]);
    let [actor_before, critics_before, targets_before] =
        [&agent.actor, &agent.critics, &agent.targets].map(parameters);

    let actor = Leaves::of(&agent.actor, 0);
    let critics = [0, 1].map(|member| Leaves::of(&agent.critics, member));
    let targets = [0, 1].map(|member| Leaves::of(&agent.targets, member));
    let (next_action, next_log) = draw(&actor, next_observations.clone(), &next_noise);
    let next_value = smaller_q(&targets, &Tensor::cat(vec![next_observations, next_action], 1));
    let soft_value = next_value - next_log * ALPHA;
    let target =
        tensor(&batch.rewards, [BATCH, 1]) + soft_value * tensor(&batch.continuations, [BATCH, 1]) * DISCOUNT;
    let target = target.detach();
    let remembered = tensor(&batch.actions, [BATCH, ACTION]);
    let input = Tensor::cat(vec![observations.clone(), remembered], 1);
    let losses = critics.each_ref().map(|critic| {
        let error = critic.forward(input.clone()) - target.clone();
        error.powf_scalar(2.0).mean() * 0.5
    });
    let critic_loss: f32 = losses.iter().map(|loss| numbers(loss)[0]).sum();
    let [first, second] = losses;
    let critics_after = side_by_side(critics[0].stepped(first), critics[1].stepped(second));

    let reported = agent.update().unwrap();
    check_close("critics", &parameters(&agent.critics), &critics_after, &critics_before);
    assert!((reported.critic - f64::from(critic_loss)).abs() < 1e-5, "{reported:?}, critic {critic_loss}");
    let followed: Vec<Vec<f32>> = targets_before
        .iter()
        .zip(&critics_after)
        .map(|(t, c)| t.iter().zip(c).map(|(t, c)| t + POLYAK as f32 * (c - t)).collect())
        .collect();
    check_close("target critics", &parameters(&agent.targets), &followed, &targets_before);

    // The actor's loss sees the critics as they are now.
    let updated = [0, 1].map(|member| Leaves::of(&agent.critics, member));
    let (action, log) = draw(&actor, observations.clone(), &fresh_noise);
    let value = smaller_q(&updated, &Tensor::cat(vec![observations, action], 1));
    let loss = (log.clone() * ALPHA - value).mean();
    let entropy = -mean(&numbers(&log));
    assert!((reported.actor - f64::from(numbers(&loss)[0])).abs() < 1e-5, "{reported:?}, actor {loss}");
    assert!((reported.entropy - entropy).abs() < 1e-5, "{reported:?}, entropy {entropy}");
    check_close("actor", &parameters(&agent.actor), &actor.stepped(loss), &actor_before);

    let slope = entropy + ACTION as f64; // ∂/∂ln α of −ln α·(mean ln π + H̄), with H̄ = −ACTION
    let log_alpha = ALPHA.ln() - RATE * slope / (slope.abs() + 1.0);
    let found = agent.temperature.log;
    assert!((found - log_alpha).abs() < 1e-6, "ln α {found} against {log_alpha}");
    assert_eq!(agent.noise, generator, "the update draws something else as well");
}

fn policy(agent: &Agent) -> Vec<Vec<f32>> {
    agent.policy.layers().flat_map(|(weights, bias)| [weights.to_vec(), bias.to_vec()]).collect()
}

#[test]
fn the_policy_follows_the_actor_by_its_share_and_is_the_actor_with_a_share_of_one() {
    let mut agent = agent();
    agent.update().unwrap();
    assert_eq!(policy(&agent), parameters(&agent.actor));

    let spec = ConfigSpec { policy_share: 0.25, ..agent.config().spec().clone() };
    agent.config = Config::try_from(spec).unwrap();
    let before = policy(&agent);
    agent.update().unwrap();
    let actor = parameters(&agent.actor);
    let expected: Vec<Vec<f32>> = before
        .iter()
        .zip(&actor)
        .map(|(p, a)| p.iter().zip(a).map(|(p, a)| p + 0.25 * (a - p)).collect())
        .collect();
    check_close("policy", &policy(&agent), &expected, &before);
}
