//! A batch of vectors as the products want it: features outside, samples inside.

use crate::lanes::{add_lanes, sum_lanes, transpose};

/// Samples that lie side by side: two vectors of AVX-512, four of AVX2.
pub(crate) const LANES: usize = 32;

/// One feature of [`LANES`] samples.
pub(crate) type Lanes = [f32; LANES];

/// A batch of vectors in blocks of [`LANES`] samples: [block][feature][sample of the block].
///
/// Invariant: a batch that is no multiple of [`LANES`] is filled up with samples whose content means nothing; where
/// they could enter a sum, they are 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Blocks {
    batch: usize,
    width: usize,
    values: Vec<Lanes>,
}

impl Blocks {
    /// All 0.
    pub(crate) fn zero(batch: usize, width: usize) -> Self {
        Self { batch, width, values: vec![[0.0; LANES]; batch.div_ceil(LANES) * width] }
    }

    /// Row-major parts side by side, each given with its width; the samples that fill up are 0.
    pub(crate) fn from_rows(parts: &[(&[f32], usize)]) -> Self {
        let width = parts.iter().map(|(_, width)| width).sum();
        let batch = parts.first().map_or(0, |(values, width)| values.len() / width);
        let mut blocks = Self::zero(batch, width);
        for (index, block) in blocks.values.chunks_exact_mut(width).enumerate() {
            let mut first = 0;
            for (values, width) in parts {
                let features = &mut block[first..first + width];
                for (sample, row) in values.chunks_exact(*width).skip(index * LANES).take(LANES).enumerate() {
                    for (feature, value) in features.iter_mut().zip(row) {
                        feature[sample] = *value;
                    }
                }
                first += width;
            }
        }
        blocks
    }

    /// Row-major: [batch, width].
    pub(crate) fn to_rows(&self) -> Vec<f32> {
        let mut rows = vec![0.0; self.batch * self.width];
        for (block, rows) in self.iter().zip(rows.chunks_mut(LANES * self.width)) {
            for (sample, row) in rows.chunks_exact_mut(self.width).enumerate() {
                for (value, feature) in row.iter_mut().zip(block) {
                    *value = feature[sample];
                }
            }
        }
        rows
    }

    /// Samples.
    pub(crate) fn batch(&self) -> usize {
        self.batch
    }

    /// Features.
    pub(crate) fn width(&self) -> usize {
        self.width
    }

    /// Block by block: \[feature\].
    pub(crate) fn iter(&self) -> impl ExactSizeIterator<Item = &[Lanes]> {
        self.values.chunks_exact(self.width)
    }

    /// As [`Blocks::iter`], to change.
    pub(crate) fn iter_mut(&mut self) -> impl ExactSizeIterator<Item = &mut [Lanes]> {
        self.values.chunks_exact_mut(self.width)
    }

    /// Sum over the samples of each feature, in an order that depends on the batch alone.
    pub(crate) fn sum(&self, sums: &mut [f32]) {
        for (feature, sum) in sums.iter_mut().enumerate() {
            let mut lanes = [0.0; LANES];
            for block in self.iter() {
                add_lanes(&mut lanes, &block[feature]);
            }
            *sum = sum_lanes(lanes);
        }
    }

    /// Samples outside, in panels of [`LANES`] features: [panel][sample][feature of the panel], filled up with 0.
    pub(crate) fn to_panels(&self) -> Vec<Lanes> {
        let samples = self.iter().len() * LANES;
        let mut panels = vec![[0.0; LANES]; self.width.div_ceil(LANES) * samples];
        for (panel, samples) in panels.chunks_exact_mut(samples).enumerate() {
            for (block, samples) in self.iter().zip(samples.chunks_exact_mut(LANES)) {
                let features = &block[panel * LANES..self.width.min((panel + 1) * LANES)];
                transpose(features, samples);
            }
        }
        panels
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counted(batch: usize, width: usize) -> Vec<f32> {
        (0..batch * width).map(|index| index as f32).collect()
    }

    #[test]
    fn rows_survive_the_way_there_and_back() {
        for (batch, width) in [(1, 1), (5, 3), (32, 7), (33, 2), (100, 40)] {
            let rows = counted(batch, width);
            assert_eq!(Blocks::from_rows(&[(&rows, width)]).to_rows(), rows, "{batch} by {width}");
        }
    }

    #[test]
    fn parts_lie_side_by_side() {
        let joined = Blocks::from_rows(&[(&[1.0, 2.0, 3.0, 4.0], 2), (&[9.0, 8.0], 1)]);
        assert_eq!(joined.to_rows(), [1.0, 2.0, 9.0, 3.0, 4.0, 8.0]);
    }

    #[test]
    fn panels_are_the_transpose_filled_up_with_zeros() {
        let (batch, width) = (40, 37);
        let blocks = Blocks::from_rows(&[(&counted(batch, width), width)]);
        let panels = blocks.to_panels();
        assert_eq!(panels.len(), 2 * 64);
        for (index, row) in panels.iter().enumerate() {
            let (panel, sample) = (index / 64, index % 64);
            for (column, value) in row.iter().enumerate() {
                let feature = panel * LANES + column;
                let inside = feature < width && sample < batch;
                let expected = if inside { (sample * width + feature) as f32 } else { 0.0 };
                assert_eq!(*value, expected, "sample {sample}, feature {feature}");
            }
        }
    }

    #[test]
    fn features_are_summed_over_the_samples() {
        let blocks = Blocks::from_rows(&[(&counted(70, 2), 2)]);
        let mut sums = [f32::NAN; 2];
        blocks.sum(&mut sums);
        assert_eq!(sums, [4830.0, 4900.0]);
    }
}
