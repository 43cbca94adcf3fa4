//! The few statistics that reports need.

/// Mean of a sample; `None` for an empty one.
#[must_use]
pub fn mean(sample: &[f64]) -> Option<f64> {
    (!sample.is_empty()).then(|| sample.iter().sum::<f64>() / sample.len() as f64)
}

/// Largest value of a sample; `None` for an empty one.
#[must_use]
pub fn maximum(sample: &[f64]) -> Option<f64> {
    sample.iter().copied().reduce(f64::max)
}

/// Quantile of a sample by linear interpolation between order statistics (Hyndman and Fan's type 7).
///
/// `fraction` in [0, 1]; `None` for an empty sample.
#[must_use]
pub fn quantile(sample: &[f64], fraction: f64) -> Option<f64> {
    if sample.is_empty() {
        return None;
    }
    let mut sorted = sample.to_vec();
    sorted.sort_by(f64::total_cmp);
    let rank = fraction.clamp(0.0, 1.0) * (sorted.len() - 1) as f64;
    let below = rank.floor() as usize;
    let above = rank.ceil() as usize;
    Some(sorted[below] + (rank - rank.floor()) * (sorted[above] - sorted[below]))
}

/// Mean of the middle half: the quarters at either end are left out, the numbers at their borders in part; `None` of an
/// empty sample.
///
/// Agarwal et al. 2021, "Deep reinforcement learning at the edge of the statistical precipice".
#[must_use]
pub fn interquartile_mean(sample: &[f64]) -> Option<f64> {
    if sample.is_empty() {
        return None;
    }
    let mut sorted = sample.to_vec();
    sorted.sort_by(f64::total_cmp);
    let quarter = sorted.len() as f64 / 4.0;
    let (low, high) = (quarter, 3.0 * quarter);
    let weighted = sorted.iter().enumerate().map(|(index, value)| {
        let (from, to) = (index as f64, index as f64 + 1.0);
        value * (to.min(high) - from.max(low)).max(0.0)
    });
    Some(weighted.sum::<f64>() / (high - low))
}

/// Wilson score interval of a success rate at 95 % confidence: never outside [0, 1], and sound at 0 and 100 %.
///
/// `trials` must be at least `successes`; no trial at all gives [0, 1].
#[must_use]
pub fn wilson_95(successes: usize, trials: usize) -> [f64; 2] {
    if trials == 0 {
        return [0.0, 1.0];
    }
    const Z: f64 = 1.959_963_984_540_054; // 97.5 % quantile of the normal distribution
    let n = trials as f64;
    let p = successes as f64 / n;
    let centre = p + Z * Z / (2.0 * n);
    let half = Z * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
    let scale = 1.0 + Z * Z / n;
    [((centre - half) / scale).max(0.0), ((centre + half) / scale).min(1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_interpolate_between_order_statistics() {
        let sample = [4.0, 1.0, 3.0, 2.0];
        assert_eq!(quantile(&sample, 0.5), Some(2.5));
        assert_eq!(quantile(&sample, 1.0), Some(4.0));
        assert_eq!(quantile(&sample, 0.0), Some(1.0));
        assert_eq!(quantile(&[], 0.5), None);
    }

    #[test]
    fn the_interquartile_mean_leaves_out_a_quarter_at_either_end() {
        assert_eq!(interquartile_mean(&[9.0, 1.0, 2.0, 4.0]), Some(3.0));
        // Of five, three and half of a quarter: 2 and 4 count with 0.75, 3 with 1.
        assert_eq!(interquartile_mean(&[-50.0, 2.0, 3.0, 5.0, 90.0]), Some((1.5 + 3.0 + 3.75) / 2.5));
        assert_eq!(interquartile_mean(&[7.0]), Some(7.0));
        assert_eq!(interquartile_mean(&[]), None);
    }

    #[test]
    fn wilson_interval_matches_the_published_example() {
        // 90 of 100: [0.826, 0.945], as in Brown, Cai and DasGupta (2001).
        let [low, high] = wilson_95(90, 100);
        assert!((low - 0.8256).abs() < 1e-4 && (high - 0.9448).abs() < 1e-4, "[{low}, {high}]");
        assert_eq!(wilson_95(200, 200)[1], 1.0);
        assert!(wilson_95(200, 200)[0] > 0.98);
        assert_eq!(wilson_95(0, 0), [0.0, 1.0]);
    }
}
