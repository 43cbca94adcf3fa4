//! Matrix products of one layer and a batch, whose bits do not depend on the processor.
//!
//! Every number of a result is one chain of fused multiply-adds in the order of the summed index. Fused
//! multiply-adds round once by definition, and how many chains run side by side does not enter any of them; so
//! AVX-512, AVX2 and a processor without either (where each is a function call) give equal bits. General libraries
//! block the summed index by cache sizes and cannot promise that.
//!
//! A tile of rows × 2 vectors stays in registers: the larger operand's panel of [`LANES`] columns is contiguous and
//! in the first cache, and the numbers of the other are broadcast from where they lie, so nothing is packed.

use pulp::{Arch, Simd, WithSimd};

use crate::blocks::{Blocks, LANES, Lanes};

/// Weights of one layer of one perceptron, [input, output], row-major.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Weights<'a> {
    pub(crate) values: &'a [f32],
    pub(crate) outputs: usize,
}

/// output ← bias + weightsᵀ·input for every sample, then max(0, ·) if `relu`; NaN stays NaN.
pub(crate) fn forward(weights: Weights<'_>, bias: &[f32], relu: bool, input: &Blocks) -> Blocks {
    let mut output = Blocks::zero(input.batch(), weights.outputs);
    for (input, output) in input.iter().zip(output.iter_mut()) {
        Arch::new().dispatch(Tiled(Forward { weights, bias, relu, input, output }));
    }
    output
}

/// slope ← weights·upstream for every sample: the slope of a loss with respect to a layer's inputs `from..`, as many
/// as there are rows of weights in `weights`; 0 where the input was cut by a ReLU, which `input` tells.
pub(crate) fn backward(weights: Weights<'_>, upstream: &Blocks, input: Option<&Blocks>) -> Blocks {
    let mut slope = Blocks::zero(upstream.batch(), weights.values.len() / weights.outputs);
    let mut inputs = input.into_iter().flat_map(Blocks::iter);
    for (upstream, slope) in upstream.iter().zip(slope.iter_mut()) {
        let input = inputs.next();
        Arch::new().dispatch(Tiled(Backward { weights, upstream, input, slope }));
    }
    slope
}

/// gradient ← Σ over the samples of input·upstreamᵀ, [input, output]; `upstream` must be 0 in the samples that fill
/// up its last block.
pub(crate) fn outer(input: &Blocks, upstream: &Blocks, gradient: &mut [f32]) {
    let samples = input.iter().len() * LANES;
    for (panel, upstream_panel) in upstream.to_panels().chunks_exact(samples).enumerate() {
        let first = panel * LANES;
        let columns = (upstream.width() - first).min(LANES);
        let operation =
            Outer { input, upstream: upstream_panel, gradient, outputs: upstream.width(), first, columns };
        Arch::new().dispatch(Tiled(operation));
    }
}

/// A product that is computed in tiles of rows.
trait Operation {
    fn rows(&self) -> usize;

    /// Computes `R` rows from `first` on.
    fn tile<S: Simd, const R: usize>(&mut self, simd: S, first: usize);
}

struct Tiled<O>(O);

impl<O: Operation> WithSimd for Tiled<O> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let rows = self.0.rows();
        let mut row = 0;
        // As many chains as the vector unit has registers for, with some left for the operands.
        if S::F32_LANES == 16 {
            while row + 12 <= rows {
                self.0.tile::<S, 12>(simd, row);
                row += 12;
            }
        }
        while row + 6 <= rows {
            self.0.tile::<S, 6>(simd, row);
            row += 6;
        }
        while row + 2 <= rows {
            self.0.tile::<S, 2>(simd, row);
            row += 2;
        }
        if row < rows {
            self.0.tile::<S, 1>(simd, row);
        }
    }
}

/// `R` numbers for every step of the summed index.
trait Broadcast<const R: usize>: Copy {
    fn at(self, step: usize, row: usize) -> f32;
}

/// Numbers that lie along the summed index: row by row.
#[derive(Clone, Copy)]
struct Along<'a, const R: usize>([&'a [f32]; R]);

impl<const R: usize> Broadcast<R> for Along<'_, R> {
    #[inline(always)]
    fn at(self, step: usize, row: usize) -> f32 {
        self.0[row][step]
    }
}

/// Numbers that lie across the summed index: `R` neighbours for each step.
#[derive(Clone, Copy)]
struct Across<'a> {
    values: &'a [f32],
    first: usize,
    stride: usize,
}

impl<const R: usize> Broadcast<R> for Across<'_> {
    #[inline(always)]
    fn at(self, step: usize, row: usize) -> f32 {
        self.values[step * self.stride + self.first..][..R][row]
    }
}

/// Two vectors of each row.
type Tile<S, const R: usize> = [[<S as Simd>::f32s; 2]; R];

/// acc + Σ broadcast·panel over the steps of the panel, of the vectors `at` and `at + 1` of each step.
#[inline(always)]
fn accumulate<S: Simd, const R: usize>(
    simd: S,
    mut acc: Tile<S, R>,
    broadcast: impl Broadcast<R>,
    panel: &[Lanes],
    at: usize,
) -> Tile<S, R> {
    for (step, lanes) in panel.iter().enumerate() {
        let vectors = S::as_simd_f32s(lanes).0;
        let (first, second) = (vectors[at], vectors[at + 1]);
        for (row, acc) in acc.iter_mut().enumerate() {
            let number = simd.splat_f32s(broadcast.at(step, row));
            acc[0] = simd.mul_add_f32s(number, first, acc[0]);
            acc[1] = simd.mul_add_f32s(number, second, acc[1]);
        }
    }
    acc
}

/// Pairs of vectors that make up [`LANES`].
#[inline(always)]
fn pairs<S: Simd>() -> impl Iterator<Item = usize> {
    (0..LANES / S::F32_LANES).step_by(2)
}

/// x, or 0 where `sign` is negative; NaN stays NaN.
#[inline(always)]
fn cut<S: Simd>(simd: S, x: S::f32s) -> S::f32s {
    let zero = simd.splat_f32s(0.0);
    simd.select_f32s(simd.less_than_f32s(x, zero), zero, x)
}

struct Forward<'a> {
    weights: Weights<'a>,
    bias: &'a [f32],
    relu: bool,
    input: &'a [Lanes],
    output: &'a mut [Lanes],
}

impl Operation for Forward<'_> {
    fn rows(&self) -> usize {
        self.output.len()
    }

    #[inline(always)]
    fn tile<S: Simd, const R: usize>(&mut self, simd: S, first: usize) {
        let Weights { values, outputs } = self.weights;
        for at in pairs::<S>() {
            let bias: Tile<S, R> = std::array::from_fn(|row| [simd.splat_f32s(self.bias[first + row]); 2]);
            let acc = accumulate(simd, bias, Across { values, first, stride: outputs }, self.input, at);
            for (acc, output) in acc.iter().zip(&mut self.output[first..first + R]) {
                let output = S::as_mut_simd_f32s(output).0;
                for (index, &sum) in acc.iter().enumerate() {
                    output[at + index] = if self.relu { cut(simd, sum) } else { sum };
                }
            }
        }
    }
}

struct Backward<'a> {
    weights: Weights<'a>,
    upstream: &'a [Lanes],
    input: Option<&'a [Lanes]>,
    slope: &'a mut [Lanes],
}

impl Operation for Backward<'_> {
    fn rows(&self) -> usize {
        self.slope.len()
    }

    #[inline(always)]
    fn tile<S: Simd, const R: usize>(&mut self, simd: S, first: usize) {
        let Weights { values, outputs } = self.weights;
        let rows = Along(std::array::from_fn::<_, R, _>(|row| &values[(first + row) * outputs..][..outputs]));
        let zero = simd.splat_f32s(0.0);
        for at in pairs::<S>() {
            let acc = accumulate(simd, [[zero; 2]; R], rows, &self.upstream[..outputs], at);
            for (row, acc) in acc.iter().enumerate() {
                let slope = S::as_mut_simd_f32s(&mut self.slope[first + row]).0;
                for (index, &sum) in acc.iter().enumerate() {
                    slope[at + index] = match self.input {
                        None => sum,
                        Some(input) => {
                            let input = S::as_simd_f32s(&input[first + row]).0[at + index];
                            simd.select_f32s(simd.less_than_f32s(zero, input), sum, zero)
                        }
                    };
                }
            }
        }
    }
}

struct Outer<'a> {
    input: &'a Blocks,
    /// [sample][output of the panel].
    upstream: &'a [Lanes],
    gradient: &'a mut [f32],
    outputs: usize,
    first: usize,
    columns: usize,
}

impl Operation for Outer<'_> {
    fn rows(&self) -> usize {
        self.input.width()
    }

    #[inline(always)]
    fn tile<S: Simd, const R: usize>(&mut self, simd: S, first: usize) {
        let mut sums = [[0.0; LANES]; R];
        for at in pairs::<S>() {
            let mut acc = [[simd.splat_f32s(0.0); 2]; R];
            for (input, upstream) in self.input.iter().zip(self.upstream.chunks_exact(LANES)) {
                let rows = Along(std::array::from_fn::<_, R, _>(|row| input[first + row].as_slice()));
                acc = accumulate(simd, acc, rows, upstream, at);
            }
            for (sums, acc) in sums.iter_mut().zip(acc) {
                S::as_mut_simd_f32s(sums).0[at..at + 2].copy_from_slice(&acc);
            }
        }
        for (row, sums) in sums.iter().enumerate() {
            let start = (first + row) * self.outputs + self.first;
            self.gradient[start..start + self.columns].copy_from_slice(&sums[..self.columns]);
        }
    }
}

#[cfg(test)]
mod tests;
