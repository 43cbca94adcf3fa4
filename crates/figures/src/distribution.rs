//! Summaries of many numbers.

/// Five numbers that stand for many.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distribution {
    /// The smallest.
    pub min: f64,
    /// A quarter are smaller.
    pub lower: f64,
    /// Half are smaller.
    pub median: f64,
    /// Three quarters are smaller.
    pub upper: f64,
    /// The largest.
    pub max: f64,
}

impl Distribution {
    /// Of the finite ones among `values`, interpolated between neighbours; `None` if there is none.
    #[must_use]
    pub fn of(values: &[f64]) -> Option<Self> {
        let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let last = sorted.len().checked_sub(1)?;
        let quantile = |share: f64| {
            let place = share * last as f64;
            let below = place.floor() as usize;
            let above = (below + 1).min(last);
            sorted[below] + (place - below as f64) * (sorted[above] - sorted[below])
        };
        Some(Self {
            min: sorted[0],
            lower: quantile(0.25),
            median: quantile(0.5),
            upper: quantile(0.75),
            max: sorted[last],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_are_interpolated_and_gaps_left_out() {
        let found = Distribution::of(&[4.0, f64::NAN, 1.0, 2.0, 3.0, f64::INFINITY]).unwrap();
        assert_eq!((found.min, found.max), (1.0, 4.0));
        assert_eq!((found.lower, found.median, found.upper), (1.75, 2.5, 3.25));
        assert_eq!(Distribution::of(&[f64::NAN]), None);
        assert_eq!(Distribution::of(&[7.0]).unwrap().upper, 7.0);
    }
}
