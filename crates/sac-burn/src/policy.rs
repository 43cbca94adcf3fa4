//! The deterministic policy alone: what evaluation and a deployed controller need.

use serde::{Deserialize, Serialize};

use crate::lanes::{apply_layer, follow};
use crate::network::Network;
use crate::wire::{CheckpointError, Format, Frame, Unframe, check_finite};

const FORMAT: Format = Format { magic: *b"sac-plcy", name: "policy", version: 1, upgrade: |_, _| () };

/// The actor's weights on the host, and its action without noise: tanh of the mean.
///
/// One observation costs one pass over the weights and no tensor, so it suits a control loop. Equal weights and
/// observations give bit-identical actions on one machine, and [`crate::Agent::act_deterministic`] is this very
/// function. Scaling of observations and actions is the caller's.
///
/// # Examples
/// ```
/// use sac_burn::{Agent, Config, Policy};
///
/// let mut agent = Agent::new(Config::table_1(), 4, 2, 7)?;
/// let policy = Policy::from_bytes(&agent.policy().to_bytes())?;
/// let (mut from_agent, mut from_policy) = ([0.0; 2], [0.0; 2]);
/// agent.act_deterministic(&[0.1, 0.2, 0.3, 0.4], &mut from_agent);
/// policy.act(&[0.1, 0.2, 0.3, 0.4], &mut from_policy);
/// assert_eq!(from_agent, from_policy);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Policy {
    /// Observation, hidden units layer by layer, twice the action (mean, then ln σ).
    widths: Vec<usize>,
    layers: Vec<HostLayer>,
}

#[derive(Clone, Debug, PartialEq)]
struct HostLayer {
    /// [input, output].
    weights: Vec<f32>,
    bias: Vec<f32>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Header {
    widths: Vec<usize>,
}

impl Policy {
    /// Copies the weights of an actor.
    pub(crate) fn of(actor: &Network) -> Self {
        let mut policy = Self::zero(actor.widths().to_vec());
        policy.copy_from(actor);
        policy
    }

    /// Copies the weights of an actor of the same shape, without allocating.
    pub(crate) fn copy_from(&mut self, actor: &Network) {
        let mut arrays = self.layers.iter_mut().flat_map(|l| [&mut l.weights, &mut l.bias]);
        actor.visit(|values| {
            if let Some(array) = arrays.next() {
                array.copy_from_slice(values);
            }
        });
    }

    /// Takes over `share` of every weight of `actor`; all of it bit for bit if the share is 1.
    pub(crate) fn follow(&mut self, share: f32, actor: &Self) {
        for (layer, actor) in self.layers.iter_mut().zip(&actor.layers) {
            if share < 1.0 {
                follow(share, &mut layer.weights, &actor.weights);
                follow(share, &mut layer.bias, &actor.bias);
            } else {
                layer.clone_from(actor);
            }
        }
    }

    fn zero(widths: Vec<usize>) -> Self {
        let layers = widths
            .windows(2)
            .map(|pair| HostLayer { weights: vec![0.0; pair[0] * pair[1]], bias: vec![0.0; pair[1]] })
            .collect();
        Self { widths, layers }
    }

    /// Components of an observation.
    pub fn observation_dim(&self) -> usize {
        self.widths[0]
    }

    /// Components of an action.
    pub fn action_dim(&self) -> usize {
        self.widths[self.widths.len() - 1] / 2
    }

    /// Writes tanh(mean) into `action`, each component in [−1, 1].
    ///
    /// Defined for finite observations; NaN in, NaN out.
    ///
    /// # Panics
    /// If a slice does not have the policy's length.
    pub fn act(&self, observation: &[f32], action: &mut [f32]) {
        assert_eq!(action.len(), self.action_dim(), "length of the action");
        let head = self.head(observation);
        for (a, mean) in action.iter_mut().zip(head) {
            *a = libm::tanhf(mean);
        }
    }

    /// Shows every parameter array in the order of [`Network::visit`], to change it; stops at the first error.
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

    /// Weights [input, output] and bias of each layer.
    pub(crate) fn layers(&self) -> impl Iterator<Item = (&[f32], &[f32])> {
        self.layers.iter().map(|layer| (layer.weights.as_slice(), layer.bias.as_slice()))
    }

    /// Mean and ln σ, not yet clamped: [2·action].
    pub(crate) fn head(&self, observation: &[f32]) -> Vec<f32> {
        assert_eq!(observation.len(), self.observation_dim(), "length of the observation");
        let mut x = observation.to_vec();
        let last = self.layers.len() - 1;
        for (index, layer) in self.layers.iter().enumerate() {
            let mut y = vec![0.0; layer.bias.len()];
            apply_layer(&layer.weights, &layer.bias, &x, &mut y);
            if index < last {
                for value in &mut y {
                    *value = if *value < 0.0 { 0.0 } else { *value };
                }
            }
            x = y;
        }
        x
    }

    /// The policy as bytes, with a version and a checksum.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        let header = Header { widths: self.widths.clone() };
        let write = |out: &mut Vec<u8>| {
            let mut frame = Frame::begin(out, FORMAT, &header, 4 * count(&self.widths))?;
            for layer in &self.layers {
                frame.numbers(&layer.weights)?;
                frame.numbers(&layer.bias)?;
            }
            frame.finish()
        };
        write(&mut bytes).expect("writing a short list of numbers to memory cannot fail");
        bytes
    }

    /// Reads what [`Policy::to_bytes`] wrote, and nothing else.
    ///
    /// # Errors
    /// [`CheckpointError`] if the bytes are no policy, of another version, too short, too long, damaged or not finite.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, CheckpointError> {
        let mut input = bytes;
        let (mut frame, header) = Unframe::begin::<Header>(&mut input, FORMAT)?;
        let widths = header.widths;
        if widths.len() < 2 || widths.contains(&0) || widths[widths.len() - 1] % 2 != 0 {
            let (expected, found) = (2, widths.len() as u64);
            return Err(CheckpointError::Inconsistent { part: "number of layer widths", expected, found });
        }
        frame.expect_numbers(4u64.saturating_mul(count(&widths)))?;
        let mut policy = Self::zero(widths);
        policy.visit_mut(|values| frame.numbers(values))?;
        frame.finish()?;
        policy.visit_mut(|values| check_finite("policy", values))?;
        match input.len() {
            0 => Ok(policy),
            n => Err(CheckpointError::Inconsistent {
                part: "length of what follows the policy [bytes]",
                expected: 0,
                found: n as u64,
            }),
        }
    }
}

/// Weights and biases of one perceptron; saturates, so that a damaged header cannot wrap it.
pub(crate) fn count(widths: &[usize]) -> u64 {
    widths.windows(2).fold(0u64, |sum, pair| {
        let layer = (pair[0] as u64).saturating_add(1).saturating_mul(pair[1] as u64);
        sum.saturating_add(layer)
    })
}
