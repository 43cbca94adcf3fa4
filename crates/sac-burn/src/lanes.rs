//! Element-wise loops, compiled for the vector unit that the machine has.
//!
//! Each is a plain loop without reassociation or fused multiply-add, so the vector width changes the speed and not
//! the result. Each closure consumes its iterator and so is `FnOnce` alone: only then is it its body, and not a call
//! of it, that is compiled for the vector unit.

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
///
/// Moments below the least normal number become 0. Those of a unit that is never active any more would otherwise
/// stay subnormal for ever, and each operation on one takes a hundred cycles.
pub(crate) fn adam(step: AdamStep, parameters: &mut [f32], moments: &mut Moments, gradient: &[f32]) {
    let moments = moments.first.iter_mut().zip(&mut moments.second);
    let elements = parameters.iter_mut().zip(moments).zip(gradient);
    Arch::new().dispatch(
        #[inline(always)]
        move || {
            for ((parameter, (first, second)), &g) in elements {
                let m = normal_or_zero(step.beta_1 * *first + (1.0 - step.beta_1) * g);
                let v = normal_or_zero(step.beta_2 * *second + (1.0 - step.beta_2) * (g * g));
                *first = m;
                *second = v;
                *parameter -= step.step_size * m / (v.sqrt() * step.second_scale + step.epsilon);
            }
        },
    );
}

/// 0 for subnormal numbers. NaN stays NaN.
#[inline(always)]
fn normal_or_zero(x: f32) -> f32 {
    if x.abs() < f32::MIN_POSITIVE { 0.0 } else { x }
}

/// Polyak averaging in place: target ← target + share·(online − target).
pub(crate) fn follow(share: f32, target: &mut [f32], online: &[f32]) {
    let elements = target.iter_mut().zip(online);
    Arch::new().dispatch(
        #[inline(always)]
        move || {
            for (target, online) in elements {
                *target += share * (online - *target);
            }
        },
    );
}

/// Adds a bias to every row: values [rows, width], bias \[width\].
pub(crate) fn add_bias(values: &mut [f32], bias: &[f32]) {
    let rows = values.chunks_exact_mut(bias.len());
    Arch::new().dispatch(
        #[inline(always)]
        move || {
            for row in rows {
                for (value, b) in row.iter_mut().zip(bias) {
                    *value += b;
                }
            }
        },
    );
}

/// Adds a bias to every row and cuts negative numbers: max(0, value + bias). NaN stays NaN.
pub(crate) fn add_bias_relu(values: &mut [f32], bias: &[f32]) {
    let rows = values.chunks_exact_mut(bias.len());
    Arch::new().dispatch(
        #[inline(always)]
        move || {
            for row in rows {
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
    sum.fill(0.0);
    let rows = values.chunks_exact(sum.len());
    Arch::new().dispatch(
        #[inline(always)]
        move || {
            for row in rows {
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
    bias_gradient.fill(0.0);
    let width = bias_gradient.len();
    let rows = gradient.chunks_exact_mut(width).zip(output.chunks_exact(width));
    Arch::new().dispatch(
        #[inline(always)]
        move || {
            for (row, output) in rows {
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
    output.copy_from_slice(bias);
    let rows = input.iter().zip(weights.chunks_exact(bias.len()));
    Arch::new().dispatch(
        #[inline(always)]
        move || {
            for (x, row) in rows {
                if *x != 0.0 {
                    for (y, w) in output.iter_mut().zip(row) {
                        *y += x * w;
                    }
                }
            }
        },
    );
}
