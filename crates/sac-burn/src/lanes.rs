//! Element-wise loops, compiled for the vector unit that the machine has.
//!
//! Each is a plain loop without reassociation or fused multiply-add, so the vector width changes the speed and not
//! the result.

use pulp::Arch;

/// Adam's coefficients of one step, bias corrections included.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AdamStep {
    pub(crate) beta_1: f32,
    pub(crate) beta_2: f32,
    /// η/(1 − β₁ᵗ).
    pub(crate) step_size: f32,
    /// 1/√(1 − β₂ᵗ).
    pub(crate) second_scale: f32,
    pub(crate) epsilon: f32,
}

/// Moments of the gradient of one parameter array.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Moments {
    pub(crate) first: Vec<f32>,
    pub(crate) second: Vec<f32>,
}

impl Moments {
    pub(crate) fn zero(len: usize) -> Self {
        Self { first: vec![0.0; len], second: vec![0.0; len] }
    }
}

/// One Adam step in place: m ← β₁m + (1 − β₁)g, v ← β₂v + (1 − β₂)g², p ← p − η m̂/(√v̂ + ε).
pub(crate) fn adam(step: AdamStep, parameters: &mut [f32], moments: &mut Moments, gradient: &[f32]) {
    let n = parameters.len();
    let (first, second) = (&mut moments.first[..n], &mut moments.second[..n]);
    let gradient = &gradient[..n];
    Arch::new().dispatch(
        #[inline(always)]
        || {
            for i in 0..n {
                let g = gradient[i];
                let m = step.beta_1 * first[i] + (1.0 - step.beta_1) * g;
                let v = step.beta_2 * second[i] + (1.0 - step.beta_2) * (g * g);
                first[i] = m;
                second[i] = v;
                parameters[i] -= step.step_size * m / (v.sqrt() * step.second_scale + step.epsilon);
            }
        },
    );
}

/// Polyak averaging in place: target ← target + share·(online − target).
pub(crate) fn follow(share: f32, target: &mut [f32], online: &[f32]) {
    let n = target.len();
    let online = &online[..n];
    Arch::new().dispatch(
        #[inline(always)]
        || {
            for i in 0..n {
                target[i] += share * (online[i] - target[i]);
            }
        },
    );
}

/// Adds a bias to every row: values [rows, width], bias \[width\].
pub(crate) fn add_bias(values: &mut [f32], bias: &[f32]) {
    Arch::new().dispatch(
        #[inline(always)]
        || {
            for row in values.chunks_exact_mut(bias.len()) {
                for (value, b) in row.iter_mut().zip(bias) {
                    *value += b;
                }
            }
        },
    );
}

/// Adds a bias to every row and cuts negative numbers: max(0, value + bias). NaN stays NaN.
pub(crate) fn add_bias_relu(values: &mut [f32], bias: &[f32]) {
    Arch::new().dispatch(
        #[inline(always)]
        || {
            for row in values.chunks_exact_mut(bias.len()) {
                for (value, b) in row.iter_mut().zip(bias) {
                    let x = *value + b;
                    *value = if x < 0.0 { 0.0 } else { x };
                }
            }
        },
    );
}

/// Sum of the rows: values [rows, width] → \[width\], added row by row.
pub(crate) fn sum_rows(values: &[f32], sum: &mut [f32]) {
    Arch::new().dispatch(
        #[inline(always)]
        || {
            sum.fill(0.0);
            for row in values.chunks_exact(sum.len()) {
                for (s, value) in sum.iter_mut().zip(row) {
                    *s += value;
                }
            }
        },
    );
}

/// Backward pass of [`add_bias_relu`]: clears the gradient where the output was cut, and sums the rows of what is
/// left into the gradient of the bias.
pub(crate) fn relu_backward(gradient: &mut [f32], output: &[f32], bias_gradient: &mut [f32]) {
    let width = bias_gradient.len();
    Arch::new().dispatch(
        #[inline(always)]
        || {
            bias_gradient.fill(0.0);
            for (row, output) in gradient.chunks_exact_mut(width).zip(output.chunks_exact(width)) {
                for ((g, o), sum) in row.iter_mut().zip(output).zip(bias_gradient.iter_mut()) {
                    let kept = if *o > 0.0 { *g } else { 0.0 };
                    *g = kept;
                    *sum += kept;
                }
            }
        },
    );
}

/// One input through one layer: output ← bias + inputᵀ·weights, weights [inputs, outputs], inputs in order.
///
/// Skips inputs that are exactly 0, which after a ReLU is about half of them.
pub(crate) fn apply_layer(weights: &[f32], bias: &[f32], input: &[f32], output: &mut [f32]) {
    Arch::new().dispatch(
        #[inline(always)]
        || {
            output.copy_from_slice(bias);
            for (x, row) in input.iter().zip(weights.chunks_exact(bias.len())) {
                if *x != 0.0 {
                    for (y, w) in output.iter_mut().zip(row) {
                        *y += x * w;
                    }
                }
            }
        },
    );
}
