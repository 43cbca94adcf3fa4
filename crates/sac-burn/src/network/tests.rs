use burn::tensor::activation::relu;
use burn::tensor::{Device, Tensor, TensorData};

use super::*;
use crate::config::{Config, ConfigSpec};

const BATCH: usize = 5;

fn numbers(count: usize, seed: u64) -> Vec<f32> {
    let mut values = vec![0.0; count];
    Noise::new(seed).fill_normal(&mut values);
    values
}

fn rows(values: &[f32], width: usize) -> Blocks {
    Blocks::from_rows(&[(values, width)])
}

/// Σ output·upstream, summed in double precision: its slope with respect to the output is `upstream`.
fn weighted_output(network: &Network, input: &[f32], upstream: &[f32]) -> f64 {
    let output = network.forward(&rows(input, network.widths()[0]));
    output.iter().zip(upstream).map(|(y, u)| f64::from(*y) * f64::from(*u)).sum()
}

fn parameters(network: &Network) -> Vec<Vec<f32>> {
    let mut arrays = Vec::new();
    network.visit(|values| arrays.push(values.to_vec()));
    arrays
}

fn with_parameter(network: &mut Network, array: usize, index: usize, change: f32) {
    let mut at = 0;
    let result = network.visit_mut(|values| {
        if at == array {
            values[index] += change;
        }
        at += 1;
        Ok::<(), ()>(())
    });
    assert_eq!(result, Ok(()));
}

/// Gradients in the order of [`Network::visit`].
fn flat(gradients: &Gradients) -> Vec<Vec<f32>> {
    let layers = gradients.weights.iter().zip(&gradients.biases);
    layers.flat_map(|(w, b)| [w.clone(), b.clone()]).collect()
}

#[track_caller]
fn check_close(what: &str, found: &[f32], expected: &[f32], tolerance: f32) {
    assert_eq!(found.len(), expected.len(), "{what}: lengths");
    for (i, (f, e)) in found.iter().zip(expected).enumerate() {
        assert!((f - e).abs() <= tolerance * (1.0 + e.abs()), "{what}[{i}]: {f} against {e}");
    }
}

#[test]
fn gradients_of_every_parameter_agree_with_finite_differences() {
    for members in [1, 2] {
        let mut network = Network::new(members, &[3, 7, 6, 2], &mut Noise::new(11));
        let (input, upstream) = (numbers(BATCH * 3, 1), numbers(members * BATCH * 2, 2));
        let blocks = rows(&input, 3);
        let gradients = flat(&network.gradients(&network.forward_taped(&blocks), &upstream));
        let h = 1e-3;
        let (mut checked, mut kinks) = (0, 0);
        for (array, gradient) in gradients.iter().enumerate() {
            for (index, found) in gradient.iter().enumerate() {
                let here = weighted_output(&network, &input, &upstream);
                with_parameter(&mut network, array, index, h);
                let up = weighted_output(&network, &input, &upstream);
                with_parameter(&mut network, array, index, -2.0 * h);
                let down = weighted_output(&network, &input, &upstream);
                with_parameter(&mut network, array, index, h);
                let h = f64::from(h);
                // Piecewise linear in one parameter: one-sided slopes differ only across a kink of a ReLU.
                if ((up - here) - (here - down)).abs() > 1e-5 {
                    kinks += 1;
                    continue;
                }
                let expected = (up - down) / (2.0 * h);
                let error = (f64::from(*found) - expected).abs();
                assert!(error < 3e-3 * (1.0 + expected.abs()), "array {array}[{index}]: {found}, {expected}");
                checked += 1;
            }
        }
        assert!(kinks * 10 < checked, "{kinks} kinks, {checked} slopes checked");
    }
}

#[test]
fn input_gradient_agrees_with_finite_differences_and_sums_the_members() {
    let network = Network::new(2, &[5, 8, 8, 1], &mut Noise::new(12));
    let (input, upstream) = (numbers(BATCH * 5, 3), numbers(2 * BATCH, 4));
    let blocks = rows(&input, 5);
    let gradient = network.input_gradient(&network.forward_taped(&blocks), &upstream, 3, 5);
    for row in 0..BATCH {
        for column in 3..5 {
            let (mut up, mut down) = (input.clone(), input.clone());
            up[row * 5 + column] += 1e-3;
            down[row * 5 + column] -= 1e-3;
            let step = f64::from(up[row * 5 + column] - down[row * 5 + column]);
            let rise =
                weighted_output(&network, &up, &upstream) - weighted_output(&network, &down, &upstream);
            let (found, expected) = (f64::from(gradient[row * 2 + column - 3]), rise / step);
            assert!((found - expected).abs() < 3e-3, "row {row}, input {column}: {found} against {expected}");
        }
    }
}

#[test]
fn forward_and_backward_agree_with_automatic_differentiation() {
    let members = 2;
    let widths = [35, 64, 48, 3];
    let network = Network::new(members, &widths, &mut Noise::new(13));
    let (input, upstream) = (numbers(BATCH * 35, 5), numbers(members * BATCH * 3, 6));

    let device = Device::flex().autodiff();
    let leaf = |values: &[f32], shape: [usize; 3]| {
        Tensor::<3>::from_data(TensorData::new(values.to_vec(), shape), &device).require_grad()
    };
    let x = leaf(&input, [1, BATCH, 35]);
    let mut leaves = Vec::new();
    for (pair, arrays) in widths.windows(2).zip(parameters(&network).chunks(2)) {
        leaves.push(leaf(&arrays[0], [members, pair[0], pair[1]]));
        leaves.push(leaf(&arrays[1], [members, 1, pair[1]]));
    }
    let mut y = x.clone();
    for (index, layer) in leaves.chunks(2).enumerate() {
        y = y.matmul(layer[0].clone()) + layer[1].clone();
        if index < 2 {
            y = relu(y);
        }
    }
    let output = y.clone().into_data().as_slice::<f32>().unwrap().to_vec();
    let weights = Tensor::<3>::from_data(TensorData::new(upstream.clone(), [members, BATCH, 3]), &device);
    let mut slopes = (y * weights).sum().backward();
    let mut slope = |leaf: &Tensor<3>| {
        leaf.grad_remove(&mut slopes).unwrap().into_data().as_slice::<f32>().unwrap().to_vec()
    };

    let blocks = rows(&input, 35);
    let tape = network.forward_taped(&blocks);
    check_close("output", &tape.output, &output, 1e-5);
    check_close("output without tape", &network.forward(&blocks), &tape.output, 0.0);
    let gradients = flat(&network.gradients(&tape, &upstream));
    for (index, (gradient, leaf)) in gradients.iter().zip(&leaves).enumerate() {
        check_close(&format!("parameter array {index}"), gradient, &slope(leaf), 1e-5);
    }
    let by_input = network.input_gradient(&tape, &upstream, 0, 35);
    check_close("input", &by_input, &slope(&x), 1e-5);
}

#[test]
fn members_do_not_see_each_other() {
    let mut network = Network::new(2, &[3, 4, 1], &mut Noise::new(14));
    let input = rows(&numbers(BATCH * 3, 7), 3);
    let before = network.forward(&input);
    with_parameter(&mut network, 0, 3 * 4, 0.5); // first weight of the second member
    let after = network.forward(&input);
    assert_eq!(before[..BATCH], after[..BATCH]);
    assert_ne!(before[BATCH..], after[BATCH..]);
    let mut upstream = vec![0.0; 2 * BATCH];
    upstream[..BATCH].fill(1.0);
    let gradients = flat(&network.gradients(&network.forward_taped(&input), &upstream));
    assert!(gradients[0][..12].iter().any(|g| *g != 0.0));
    assert!(gradients[0][12..].iter().all(|g| *g == 0.0));
}

#[test]
fn target_follows_by_the_polyak_share_of_the_updated_weights() {
    let spec = ConfigSpec { learning_rate: 0.01, ..Config::table_1().spec().clone() };
    let adam = Adam::new(&spec);
    let mut online = Network::new(2, &[3, 4, 1], &mut Noise::new(15));
    let mut target = Network::new(2, &[3, 4, 1], &mut Noise::new(16));
    let old_target = parameters(&target);
    let old_online = parameters(&online);
    let mut optimizer = Optimizer::new(&online);
    let input = rows(&numbers(BATCH * 3, 8), 3);
    let gradients = online.gradients(&online.forward_taped(&input), &numbers(2 * BATCH, 9));
    online.step_followed(&adam, &mut optimizer, &gradients, &mut target, 0.25);
    let new_online = parameters(&online);
    assert_ne!(old_online, new_online);
    for ((old, new), online) in old_target.iter().zip(parameters(&target)).zip(&new_online) {
        let expected: Vec<f32> = old.iter().zip(online).map(|(t, o)| 0.75 * t + 0.25 * o).collect();
        check_close("target", &new, &expected, 1e-6);
    }
}

#[test]
fn initial_parameters_lie_within_one_over_the_root_of_the_inputs_and_fill_that_range() {
    let network = Network::new(2, &[16, 64, 1], &mut Noise::new(18));
    for (array, bound) in parameters(&network).iter().zip([0.25f32, 0.25, 0.125, 0.125]) {
        assert!(array.iter().all(|w| w.abs() <= bound));
        assert!(array.len() < 64 || array.iter().any(|w| w.abs() > 0.9 * bound));
    }
}
