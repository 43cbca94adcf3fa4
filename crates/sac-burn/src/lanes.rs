//! Element-wise loops, compiled for the vector unit that the machine has.
//!
//! Each is a plain loop without reassociation or fused multiply-add, so the vector width changes the speed and not
//! the result. Each closure consumes its iterator and so is `FnOnce` alone: only then is it its body, and not a call
//! of it, that is compiled for the vector unit.

use pulp::Arch;

use crate::blocks::{LANES, Lanes};

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

/// sums ← sums + values.
pub(crate) fn add_lanes(sums: &mut Lanes, values: &Lanes) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum += value;
    }
}

/// Sum of the lanes, by halves.
pub(crate) fn sum_lanes(mut lanes: Lanes) -> f32 {
    let mut half = LANES / 2;
    while half > 0 {
        for lane in 0..half {
            lanes[lane] += lanes[lane + half];
        }
        half /= 2;
    }
    lanes[0]
}

/// columns[s][f] ← rows[f][s], for up to [`LANES`] rows; what no row fills stays.
pub(crate) fn transpose(rows: &[Lanes], columns: &mut [Lanes]) {
    for (sample, column) in columns.iter_mut().enumerate() {
        for (value, row) in column.iter_mut().zip(rows) {
            *value = row[sample];
        }
    }
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
