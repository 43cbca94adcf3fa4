use super::*;
use crate::noise::Noise;

const BATCHES: [usize; 4] = [1, 24, 32, 128];
const SHAPES: [(usize, usize); 6] = [(1, 1), (3, 7), (35, 64), (37, 33), (64, 6), (256, 12)];

fn numbers(count: usize, seed: u64) -> Vec<f32> {
    let mut values = vec![0.0; count];
    Noise::new(seed).fill_normal(&mut values);
    values
}

fn for_all_shapes(check: impl Fn(usize, usize, usize)) {
    for batch in BATCHES {
        for (inputs, outputs) in SHAPES {
            check(batch, inputs, outputs);
        }
    }
}

#[track_caller]
fn check_bits(found: &[f32], expected: &[f32]) {
    assert_eq!(found.len(), expected.len());
    for (index, (f, e)) in found.iter().zip(expected).enumerate() {
        assert_eq!(f.to_bits(), e.to_bits(), "{index}: {f} against {e}");
    }
}

/// One chain of fused multiply-adds, as a processor without any vector unit computes it.
fn chain(start: f32, factors: impl Iterator<Item = (f32, f32)>) -> f32 {
    factors.fold(start, |sum, (a, b)| a.mul_add(b, sum))
}

#[test]
fn forward_is_one_chain_of_fused_multiply_adds_to_the_bit() {
    for_all_shapes(|batch, inputs, outputs| {
        let (weights, bias) = (numbers(inputs * outputs, 1), numbers(outputs, 2));
        let x = numbers(batch * inputs, 3);
        for relu in [false, true] {
            let expected: Vec<f32> = (0..batch * outputs)
                .map(|at| {
                    let (m, n) = (at / outputs, at % outputs);
                    let sum =
                        chain(bias[n], (0..inputs).map(|k| (weights[k * outputs + n], x[m * inputs + k])));
                    if relu && sum < 0.0 { 0.0 } else { sum }
                })
                .collect();
            let input = Blocks::from_rows(&[(&x, inputs)]);
            let found = forward(Weights { values: &weights, outputs }, &bias, relu, &input);
            check_bits(&found.to_rows(), &expected);
        }
    });
}

#[test]
fn backward_is_one_chain_to_the_bit_and_nothing_where_a_relu_cut() {
    for_all_shapes(|batch, inputs, outputs| {
        let (weights, dy) = (numbers(inputs * outputs, 1), numbers(batch * outputs, 2));
        let x: Vec<f32> = numbers(batch * inputs, 3).into_iter().map(|x| x.max(0.0)).collect();
        let slope = |at: usize| {
            let (m, k) = (at / inputs, at % inputs);
            chain(0.0, (0..outputs).map(|n| (weights[k * outputs + n], dy[m * outputs + n])))
        };
        let plain: Vec<f32> = (0..batch * inputs).map(slope).collect();
        let cut: Vec<f32> = plain.iter().zip(&x).map(|(s, x)| if *x > 0.0 { *s } else { 0.0 }).collect();
        let upstream = Blocks::from_rows(&[(&dy, outputs)]);
        let weights = Weights { values: &weights, outputs };
        check_bits(&backward(weights, &upstream, None).to_rows(), &plain);
        let input = Blocks::from_rows(&[(&x, inputs)]);
        check_bits(&backward(weights, &upstream, Some(&input)).to_rows(), &cut);
    });
}

#[test]
fn the_gradient_of_weights_is_one_chain_over_the_samples_to_the_bit() {
    for_all_shapes(|batch, inputs, outputs| {
        let (x, dy) = (numbers(batch * inputs, 1), numbers(batch * outputs, 2));
        let expected: Vec<f32> = (0..inputs * outputs)
            .map(|at| {
                let (k, n) = (at / outputs, at % outputs);
                chain(0.0, (0..batch).map(|m| (x[m * inputs + k], dy[m * outputs + n])))
            })
            .collect();
        let mut found = vec![f32::NAN; inputs * outputs];
        outer(&Blocks::from_rows(&[(&x, inputs)]), &Blocks::from_rows(&[(&dy, outputs)]), &mut found);
        check_bits(&found, &expected);
    });
}

#[test]
fn every_vector_unit_of_this_machine_gives_the_bits_of_none() {
    let (batch, inputs, outputs) = (64, 37, 45);
    let (weights, bias, x) = (numbers(inputs * outputs, 1), numbers(outputs, 2), numbers(batch * inputs, 3));
    let input = Blocks::from_rows(&[(&x, inputs)]);
    let run = |dispatch: &dyn Fn(Tiled<Forward<'_>>)| {
        let mut output = Blocks::zero(batch, outputs);
        let weights = Weights { values: &weights, outputs };
        for (input, output) in input.iter().zip(output.iter_mut()) {
            dispatch(Tiled(Forward { weights, bias: &bias, relu: true, input, output }));
        }
        output.to_rows()
    };
    let plain = run(&|tiled| tiled.with_simd(pulp::Scalar));
    check_bits(&run(&|tiled| Arch::new().dispatch(tiled)), &plain);
    if let Some(v3) = pulp::x86::V3::try_new() {
        check_bits(&run(&|tiled| pulp::Simd::vectorize(v3, tiled)), &plain);
    }
}

#[test]
fn nan_stays_nan_through_a_relu() {
    let input = Blocks::from_rows(&[(&[f32::NAN], 1)]);
    let output = forward(Weights { values: &[1.0], outputs: 1 }, &[0.0], true, &input);
    assert!(output.to_rows()[0].is_nan());
}
