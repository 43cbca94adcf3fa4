//! Multi-layer perceptrons: one for the actor, two side by side for the twin critics.
//!
//! The backward pass is written out here: it computes what a loss needs and no more, so that the actor's loss costs no
//! gradient of a critic weight. Bias and ReLU are part of the products.

use crate::adam::Adam;
use crate::blocks::Blocks;
use crate::lanes::{AdamStep, Moments, adam, follow};
use crate::noise::Noise;
use crate::product::{Weights, backward, forward, outer};

/// One fully connected layer of every member.
#[derive(Clone, Debug)]
struct Layer {
    inputs: usize,
    outputs: usize,
    /// [member, input, output].
    weights: Vec<f32>,
    /// [member, output].
    bias: Vec<f32>,
}

/// Perceptrons of equal shape, with ReLU between the layers and nothing after the last.
#[derive(Clone, Debug)]
pub(crate) struct Network {
    members: usize,
    /// Inputs, hidden units layer by layer, outputs.
    widths: Vec<usize>,
    layers: Vec<Layer>,
}

/// What a forward pass leaves behind for the backward pass.
#[derive(Debug)]
pub(crate) struct Tape<'a> {
    input: &'a Blocks,
    /// Inputs of the second layer and those after it, of each member.
    hidden: Vec<Vec<Blocks>>,
    /// [member, batch, output], row-major.
    pub(crate) output: Vec<f32>,
}

/// Gradient of a loss with respect to every weight and bias, layer by layer.
#[derive(Debug)]
pub(crate) struct Gradients {
    weights: Vec<Vec<f32>>,
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
    fn forward(&self, member: usize, relu: bool, input: &Blocks) -> Blocks {
        let bias = &self.bias[member * self.outputs..][..self.outputs];
        forward(self.weights(member, 0, self.inputs), bias, relu, input)
    }

    /// Weights of one member from the inputs `from..to`.
    fn weights(&self, member: usize, from: usize, to: usize) -> Weights<'_> {
        let start = (member * self.inputs + from) * self.outputs;
        let values = &self.weights[start..start + (to - from) * self.outputs];
        Weights { values, outputs: self.outputs }
    }
}

impl Network {
    /// Weights and biases uniform within ±1/√inputs, drawn from `noise` in order.
    pub(crate) fn new(members: usize, widths: &[usize], noise: &mut Noise) -> Self {
        let mut layers = Vec::with_capacity(widths.len() - 1);
        for pair in widths.windows(2) {
            let [inputs, outputs] = [pair[0], pair[1]];
            let bound = 1.0 / (inputs as f32).sqrt();
            let mut draw = |count| (0..count).map(|_| noise.uniform(bound)).collect::<Vec<f32>>();
            let weights = draw(members * inputs * outputs);
            layers.push(Layer { inputs, outputs, weights, bias: draw(members * outputs) });
        }
        Self { members, widths: widths.to_vec(), layers }
    }

    /// Inputs, hidden units layer by layer, outputs.
    pub(crate) fn widths(&self) -> &[usize] {
        &self.widths
    }

    /// Output alone, [member, batch, output], for an input that all members share.
    pub(crate) fn forward(&self, input: &Blocks) -> Vec<f32> {
        self.run(input, |_| ())
    }

    /// Output and what [`Network::gradients`] and [`Network::input_gradient`] need.
    pub(crate) fn forward_taped<'a>(&self, input: &'a Blocks) -> Tape<'a> {
        let mut all = Vec::with_capacity(self.members * self.layers.len());
        let output = self.run(input, |x| all.push(x));
        let mut all = all.into_iter();
        let per_member = self.layers.len() - 1;
        let hidden = (0..self.members).map(|_| all.by_ref().take(per_member).collect()).collect();
        Tape { input, hidden, output }
    }

    /// The outputs; `keep` is given what goes from layer to layer, member by member.
    fn run(&self, input: &Blocks, mut keep: impl FnMut(Blocks)) -> Vec<f32> {
        let (last, hidden) = self.layers.split_last().expect("a network has at least one layer");
        let mut output = Vec::with_capacity(self.members * input.batch() * last.outputs);
        for member in 0..self.members {
            let mut x: Option<Blocks> = None;
            for layer in hidden {
                let y = layer.forward(member, true, x.as_ref().unwrap_or(input));
                x.replace(y).map(&mut keep);
            }
            output.extend(last.forward(member, false, x.as_ref().unwrap_or(input)).to_rows());
            x.map(&mut keep);
        }
        output
    }

    /// Gradient with respect to the parameters, for `upstream` = ∂loss/∂output of shape [member, batch, output].
    pub(crate) fn gradients(&self, tape: &Tape<'_>, upstream: &[f32]) -> Gradients {
        let zeros = |array: fn(&Layer) -> &Vec<f32>| -> Vec<Vec<f32>> {
            self.layers.iter().map(|layer| vec![0.0; array(layer).len()]).collect()
        };
        let mut gradients = Gradients { weights: zeros(|l| &l.weights), biases: zeros(|l| &l.bias) };
        for (member, upstream) in upstream.chunks_exact(upstream.len() / self.members).enumerate() {
            let mut dy = Blocks::from_rows(&[(upstream, self.widths[self.layers.len()])]);
            for (index, layer) in self.layers.iter().enumerate().rev() {
                let size = layer.inputs * layer.outputs;
                let input = tape.input_of(member, index);
                outer(input, &dy, &mut gradients.weights[index][member * size..][..size]);
                dy.sum(&mut gradients.biases[index][member * layer.outputs..][..layer.outputs]);
                if index > 0 {
                    dy = backward(layer.weights(member, 0, layer.inputs), &dy, Some(input));
                }
            }
        }
        gradients
    }

    /// Gradient with respect to the inputs `from..to`, [batch, to − from], summed over the members.
    pub(crate) fn input_gradient(
        &self,
        tape: &Tape<'_>,
        upstream: &[f32],
        from: usize,
        to: usize,
    ) -> Vec<f32> {
        let mut sum = vec![0.0; tape.input.batch() * (to - from)];
        for (member, upstream) in upstream.chunks_exact(upstream.len() / self.members).enumerate() {
            let mut dy = Blocks::from_rows(&[(upstream, self.widths[self.layers.len()])]);
            for (index, layer) in self.layers.iter().enumerate().skip(1).rev() {
                let input = tape.input_of(member, index);
                dy = backward(layer.weights(member, 0, layer.inputs), &dy, Some(input));
            }
            let dx = backward(self.layers[0].weights(member, from, to), &dy, None).to_rows();
            for (sum, dx) in sum.iter_mut().zip(dx) {
                *sum += dx;
            }
        }
        sum
    }

    /// One Adam step.
    pub(crate) fn step(&mut self, adam_: &Adam, optimizer: &mut Optimizer, gradients: &Gradients) {
        let step = optimizer.begin(adam_);
        for (index, layer) in self.layers.iter_mut().enumerate() {
            let [weights, bias] = &mut optimizer.moments[index];
            adam(step, &mut layer.weights, weights, &gradients.weights[index]);
            adam(step, &mut layer.bias, bias, &gradients.biases[index]);
        }
    }

    /// One Adam step, after which `target` follows by `polyak`: target ← (1 − polyak)·target + polyak·online.
    pub(crate) fn step_followed(
        &mut self,
        adam: &Adam,
        optimizer: &mut Optimizer,
        gradients: &Gradients,
        target: &mut Self,
        polyak: f32,
    ) {
        self.step(adam, optimizer, gradients);
        for (layer, target) in self.layers.iter().zip(&mut target.layers) {
            follow(polyak, &mut target.weights, &layer.weights);
            follow(polyak, &mut target.bias, &layer.bias);
        }
    }

    /// Shows every parameter array in a fixed order: weights then bias, layer by layer.
    pub(crate) fn visit(&self, mut visitor: impl FnMut(&[f32])) {
        for layer in &self.layers {
            visitor(&layer.weights);
            visitor(&layer.bias);
        }
    }

    /// As [`Network::visit`], to change the parameters; stops at the first error.
    pub(crate) fn visit_mut<E>(
        &mut self,
        mut visitor: impl FnMut(&mut [f32]) -> Result<(), E>,
    ) -> Result<(), E> {
        for layer in &mut self.layers {
            visitor(&mut layer.weights)?;
            visitor(&mut layer.bias)?;
        }
        Ok(())
    }
}

impl Tape<'_> {
    fn input_of(&self, member: usize, layer: usize) -> &Blocks {
        match layer.checked_sub(1) {
            None => self.input,
            Some(hidden) => &self.hidden[member][hidden],
        }
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
