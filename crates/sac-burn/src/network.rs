//! Multi-layer perceptrons: one for the actor, two side by side for the twin critics.
//!
//! Matrix products are burn's, batched over the members; bias, ReLU and their gradients are fused loops on the same
//! memory, since Flex would make one pass and one allocation per operation. The backward pass is written out here:
//! it computes what a loss needs and no more, so that the actor's loss costs no gradient of a critic weight.

use crate::lanes::{Moments, add_bias, add_bias_relu, relu_backward, sum_rows};
use crate::lanes::{adam, follow};
use crate::noise::Noise;
use crate::tensor::{Host, Matrices, matrices};
use crate::{adam::Adam, lanes::AdamStep};

/// One fully connected layer of every member.
#[derive(Debug)]
pub(crate) struct Layer {
    /// [member, input, output]. `None` only while [`Layer::with_weights`] works on it.
    weights: Option<Matrices>,
    /// [member, output].
    bias: Vec<f32>,
}

/// Perceptrons of equal shape, with ReLU between the layers and nothing after the last.
#[derive(Debug)]
pub(crate) struct Network {
    members: usize,
    /// Inputs, hidden units layer by layer, outputs.
    widths: Vec<usize>,
    layers: Vec<Layer>,
}

/// What a forward pass leaves behind for the backward pass.
#[derive(Debug)]
pub(crate) struct Tape {
    batch: usize,
    /// Input of each layer, [1 or member, batch, width].
    inputs: Vec<Matrices>,
    /// [member, batch, output], row-major.
    pub(crate) output: Vec<f32>,
}

/// Gradient of a loss with respect to every weight and bias, layer by layer.
#[derive(Debug)]
pub(crate) struct Gradients {
    weights: Vec<Host>,
    biases: Vec<Vec<f32>>,
}

/// State of Adam for one network.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Optimizer {
    /// Steps taken.
    pub(crate) steps: u64,
    /// Weights and bias, layer by layer.
    pub(crate) moments: Vec<[Moments; 2]>,
}

impl Layer {
    fn weights(&self) -> Matrices {
        self.weights.clone().expect("weights are out only inside with_weights")
    }

    /// Works on the weights as a host slice, in place.
    fn with_weights<R>(&mut self, work: impl FnOnce(&mut [f32]) -> R) -> R {
        let mut host = Host::take(self.weights.take().expect("weights are out only inside with_weights"));
        let result = work(host.values_mut());
        self.weights = Some(host.give());
        result
    }
}

impl Network {
    /// Weights and biases uniform within ±1/√inputs, drawn from `noise` in order.
    pub(crate) fn new(members: usize, widths: &[usize], noise: &mut Noise) -> Self {
        let mut layers = Vec::with_capacity(widths.len() - 1);
        for pair in widths.windows(2) {
            let bound = 1.0 / (pair[0] as f32).sqrt();
            let mut draw = |count| (0..count).map(|_| noise.uniform(bound)).collect::<Vec<f32>>();
            let weights = matrices(draw(members * pair[0] * pair[1]), [members, pair[0], pair[1]]);
            layers.push(Layer { weights: Some(weights), bias: draw(members * pair[1]) });
        }
        Self { members, widths: widths.to_vec(), layers }
    }

    /// A copy that shares nothing.
    pub(crate) fn duplicate(&self) -> Self {
        let mut copy = Self { members: self.members, widths: self.widths.clone(), layers: Vec::new() };
        for (layer, pair) in self.layers.iter().zip(self.widths.windows(2)) {
            let weights = Host::take(layer.weights()).values().to_vec();
            let weights = Some(matrices(weights, [self.members, pair[0], pair[1]]));
            copy.layers.push(Layer { weights, bias: layer.bias.clone() });
        }
        copy
    }

    /// Inputs, hidden units layer by layer, outputs.
    pub(crate) fn widths(&self) -> &[usize] {
        &self.widths
    }

    /// Output alone, [member, batch, output], for an input of [batch, input] that all members share.
    pub(crate) fn forward(&self, input: Vec<f32>) -> Vec<f32> {
        self.run(input, |_| ()).1
    }

    /// Output and what [`Network::gradients`] and [`Network::input_gradient`] need.
    pub(crate) fn forward_taped(&self, input: Vec<f32>) -> Tape {
        let mut inputs = Vec::with_capacity(self.layers.len());
        let (batch, output) = self.run(input, |x| inputs.push(x.clone()));
        Tape { batch, inputs, output }
    }

    fn run(&self, input: Vec<f32>, mut keep: impl FnMut(&Matrices)) -> (usize, Vec<f32>) {
        let batch = input.len() / self.widths[0];
        let mut x = matrices(input, [1, batch, self.widths[0]]);
        for (index, layer) in self.layers.iter().enumerate() {
            keep(&x);
            let mut y = Host::take(x.matmul(layer.weights()));
            let width = self.widths[index + 1];
            let last = index + 1 == self.layers.len();
            for (values, bias) in
                y.values_mut().chunks_exact_mut(batch * width).zip(layer.bias.chunks_exact(width))
            {
                if last { add_bias(values, bias) } else { add_bias_relu(values, bias) }
            }
            if last {
                return (batch, y.values().to_vec());
            }
            x = y.give();
        }
        unreachable!("the last layer returns, and a network has at least one")
    }

    /// Gradient with respect to the parameters, for `upstream` = ∂loss/∂output of shape [member, batch, output].
    pub(crate) fn gradients(&self, mut tape: Tape, upstream: Vec<f32>) -> Gradients {
        let depth = self.layers.len();
        let mut weights = Vec::with_capacity(depth);
        let mut biases: Vec<Vec<f32>> = self.layers.iter().map(|l| vec![0.0; l.bias.len()]).collect();
        let outputs = self.widths[depth];
        for (values, sum) in
            upstream.chunks_exact(tape.batch * outputs).zip(biases[depth - 1].chunks_exact_mut(outputs))
        {
            sum_rows(values, sum);
        }
        let mut dy = matrices(upstream, [self.members, tape.batch, outputs]);
        for index in (0..depth).rev() {
            let input = tape.inputs.pop().expect("the tape has one input per layer");
            weights.push(Host::take(input.clone().swap_dims(1, 2).matmul(dy.clone())));
            if index > 0 {
                let dx = dy.matmul(self.layers[index].weights().swap_dims(1, 2));
                dy = self.through_relu(index, input, dx, tape.batch, &mut biases[index - 1]);
            }
        }
        weights.reverse();
        Gradients { weights, biases }
    }

    /// Gradient with respect to the inputs `from..to`, [batch, to − from], summed over the members.
    pub(crate) fn input_gradient(
        &self,
        mut tape: Tape,
        upstream: Vec<f32>,
        from: usize,
        to: usize,
    ) -> Vec<f32> {
        let depth = self.layers.len();
        let mut unused: Vec<f32> = Vec::new();
        let mut dy = matrices(upstream, [self.members, tape.batch, self.widths[depth]]);
        for index in (1..depth).rev() {
            let input = tape.inputs.pop().expect("the tape has one input per layer");
            let dx = dy.matmul(self.layers[index].weights().swap_dims(1, 2));
            unused.resize(self.members * self.widths[index], 0.0);
            dy = self.through_relu(index, input, dx, tape.batch, &mut unused);
        }
        let rows = self.layers[0].weights().narrow(1, from, to - from);
        let dx = Host::take(dy.matmul(rows.swap_dims(1, 2)));
        let mut sum = vec![0.0; tape.batch * (to - from)];
        sum_rows(dx.values(), &mut sum);
        sum
    }

    /// Takes ∂loss/∂(input of layer `index`) to before the ReLU that made that input, and sums the bias gradient.
    fn through_relu(
        &self,
        index: usize,
        input: Matrices,
        gradient: Matrices,
        batch: usize,
        bias_gradient: &mut [f32],
    ) -> Matrices {
        let width = self.widths[index];
        let (output, mut gradient) = (Host::take(input), Host::take(gradient));
        let size = batch * width;
        for ((g, o), b) in gradient
            .values_mut()
            .chunks_exact_mut(size)
            .zip(output.values().chunks_exact(size))
            .zip(bias_gradient.chunks_exact_mut(width))
        {
            relu_backward(g, o, b);
        }
        gradient.give()
    }

    /// One Adam step.
    pub(crate) fn step(&mut self, adam_: &Adam, optimizer: &mut Optimizer, gradients: &Gradients) {
        let step = optimizer.begin(adam_);
        for (index, layer) in self.layers.iter_mut().enumerate() {
            let [weights, bias] = &mut optimizer.moments[index];
            layer.with_weights(|w| adam(step, w, weights, gradients.weights[index].values()));
            adam(step, &mut layer.bias, bias, &gradients.biases[index]);
        }
    }

    /// One Adam step, after which `target` follows by `polyak`: target ← (1 − polyak)·target + polyak·online.
    pub(crate) fn step_followed(
        &mut self,
        adam_: &Adam,
        optimizer: &mut Optimizer,
        gradients: &Gradients,
        target: &mut Self,
        polyak: f32,
    ) {
        let step = optimizer.begin(adam_);
        for (index, (layer, target)) in self.layers.iter_mut().zip(&mut target.layers).enumerate() {
            let [weights, bias] = &mut optimizer.moments[index];
            layer.with_weights(|w| {
                adam(step, w, weights, gradients.weights[index].values());
                target.with_weights(|t| follow(polyak, t, w));
            });
            adam(step, &mut layer.bias, bias, &gradients.biases[index]);
            follow(polyak, &mut target.bias, &layer.bias);
        }
    }

    /// Shows every parameter array in a fixed order: weights then bias, layer by layer.
    pub(crate) fn visit(&self, mut visitor: impl FnMut(&[f32])) {
        for layer in &self.layers {
            visitor(Host::take(layer.weights()).values());
            visitor(&layer.bias);
        }
    }

    /// As [`Network::visit`], to change the parameters; stops at the first error.
    pub(crate) fn visit_mut<E>(
        &mut self,
        mut visitor: impl FnMut(&mut [f32]) -> Result<(), E>,
    ) -> Result<(), E> {
        for layer in &mut self.layers {
            layer.with_weights(&mut visitor)?;
            visitor(&mut layer.bias)?;
        }
        Ok(())
    }
}

impl Optimizer {
    /// No step taken, all moments zero.
    pub(crate) fn new(network: &Network) -> Self {
        let moments = network
            .widths
            .windows(2)
            .map(|pair| {
                [Moments::zero(network.members * pair[0] * pair[1]), Moments::zero(network.members * pair[1])]
            })
            .collect();
        Self { steps: 0, moments }
    }

    fn begin(&mut self, adam: &Adam) -> AdamStep {
        self.steps += 1;
        adam.step(self.steps)
    }
}

#[cfg(test)]
mod tests;
