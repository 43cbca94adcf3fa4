//! The policy as a burn module: for burn's other backends, its records and its automatic differentiation.

use burn::module::{Module, Param};
use burn::nn::{Linear, LinearConfig};
use burn::tensor::activation::relu;
use burn::tensor::{Device, Tensor, TensorData};

use crate::policy::Policy;

/// The actor as burn's linear layers, to carry a policy to another of burn's devices, to write it as one of burn's
/// records, or to differentiate through it.
///
/// Learning does not go through it: `product` says why. Both agree but for the order of their sums, and the tests
/// hold each gradient of the learner against burn's automatic differentiation.
///
/// # Examples
/// ```
/// use burn::tensor::{Device, Tensor};
/// use sac_burn::{ActorModule, Agent, Config};
///
/// let agent = Agent::new(Config::table_1(), 4, 2, 7)?;
/// let module = ActorModule::of(agent.policy(), &Device::flex());
/// let actions = module.forward(Tensor::<2>::from_data([[0.1f32, 0.2, 0.3, 0.4]], &Device::flex()));
/// let mut expected = [0.0; 2];
/// agent.act_deterministic(&[0.1, 0.2, 0.3, 0.4], &mut expected);
/// for (found, expected) in actions.into_data().as_slice::<f32>().unwrap().iter().zip(expected) {
///     assert!((found - expected).abs() < 1e-5);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Module, Debug)]
pub struct ActorModule {
    layers: Vec<Linear>,
}

impl ActorModule {
    /// The actor of `policy`, on `device`.
    pub fn of(policy: &Policy, device: &Device) -> Self {
        let layers = policy.layers().map(|(weights, bias)| {
            let (inputs, outputs) = (weights.len() / bias.len(), bias.len());
            let tensor = |values: &[f32], shape: [usize; 2]| {
                Tensor::<2>::from_data(TensorData::new(values.to_vec(), shape), device)
            };
            let mut layer = LinearConfig::new(inputs, outputs).init(device);
            layer.weight = Param::from_tensor(tensor(weights, [inputs, outputs]));
            layer.bias = Some(Param::from_tensor(tensor(bias, [1, outputs]).reshape([outputs])));
            layer
        });
        Self { layers: layers.collect() }
    }

    /// The deterministic action, tanh of the mean. Shapes: [batch, observation] → [batch, action].
    pub fn forward(&self, observations: Tensor<2>) -> Tensor<2> {
        let head = self.head(observations);
        let [batch, width] = head.dims();
        head.slice([0..batch, 0..width / 2]).tanh()
    }

    /// Means, then ln σ before it is clamped. Shapes: [batch, observation] → [batch, 2·action].
    pub fn head(&self, observations: Tensor<2>) -> Tensor<2> {
        let last = self.layers.len() - 1;
        self.layers.iter().enumerate().fold(observations, |x, (index, layer)| {
            let y = layer.forward(x);
            if index < last { relu(y) } else { y }
        })
    }
}
