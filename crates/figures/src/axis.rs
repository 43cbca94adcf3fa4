//! Axes: what they measure, and where a value lies on them.

use crate::drawing::text_width;
use crate::error::FigureError;
use crate::ticks::{self, Ticks, superscript};

/// How values are spread along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spacing {
    /// Evenly.
    Linear,
    /// By their logarithm; values that are not positive have no place.
    Logarithmic,
}

/// What an axis measures.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The quantity, such as "Velocity".
    pub label: String,
    /// Its unit, such as "m/s"; "–" for a quantity without one.
    pub unit: String,
    /// Lower and upper end; from the data if `None`.
    pub range: Option<[f64; 2]>,
    /// How values are spread.
    pub spacing: Spacing,
    /// Names in place of ticks at 0, 1, 2, …; none for a quantity.
    pub categories: Vec<String>,
}

impl Axis {
    /// A linear axis whose range comes from the data.
    #[must_use]
    pub fn new(label: &str, unit: &str) -> Self {
        Self {
            label: label.to_owned(),
            unit: unit.to_owned(),
            range: None,
            spacing: Spacing::Linear,
            categories: Vec::new(),
        }
    }

    /// The same with a given range.
    #[must_use]
    pub fn from_to(self, min: f64, max: f64) -> Self {
        Self { range: Some([min, max]), ..self }
    }

    /// Label and unit as they stand beside the axis.
    pub(crate) fn caption(&self, exponent: i32) -> String {
        if !self.categories.is_empty() {
            return self.label.clone();
        }
        let factor = if exponent == 0 { String::new() } else { format!("10{} ", superscript(exponent)) };
        format!("{} [{factor}{}]", self.label, self.unit)
    }

    /// Checks the axis and gives it its range: the given one, or that of the values, `padding` of it more at each end.
    ///
    /// # Errors
    /// [`FigureError::Unlabelled`], [`FigureError::NoData`] or [`FigureError::Range`].
    pub(crate) fn resolve(
        &self,
        figure: &str,
        values: impl Iterator<Item = f64>,
        padding: f64,
    ) -> Result<Span, FigureError> {
        if self.label.trim().is_empty() || self.unit.trim().is_empty() {
            let (label, unit) = (self.label.clone(), self.unit.clone());
            return Err(FigureError::Unlabelled { figure: figure.to_owned(), label, unit });
        }
        let spacing = self.spacing;
        let [min, max] = match self.range {
            Some(range) => range,
            None if !self.categories.is_empty() => [-0.5, self.categories.len() as f64 - 0.5],
            None => {
                let has_place =
                    |value: &f64| value.is_finite() && (spacing == Spacing::Linear || *value > 0.0);
                let extent = values.filter(has_place).fold(None, |extent: Option<[f64; 2]>, value| {
                    Some(extent.map_or([value; 2], |[min, max]| [min.min(value), max.max(value)]))
                });
                let Some(extent) = extent else {
                    return Err(FigureError::NoData { figure: figure.to_owned(), axis: self.label.clone() });
                };
                widened(extent, spacing, padding)
            }
        };
        let span = Span { min, max, spacing };
        let (low, high) = (span.place(min), span.place(max));
        if min.is_finite() && max.is_finite() && (high - low).is_finite() && high > low {
            Ok(span)
        } else {
            Err(FigureError::Range {
                figure: figure.to_owned(),
                axis: self.label.clone(),
                min: min.to_string(),
                max: max.to_string(),
            })
        }
    }

    pub(crate) fn ticks(&self, span: &Span, wanted: usize) -> Ticks {
        if !self.categories.is_empty() {
            let marks = self.categories.iter().enumerate().map(|(index, name)| (index as f64, name.clone()));
            return Ticks { marks: marks.collect(), exponent: 0 };
        }
        match span.spacing {
            Spacing::Linear => ticks::linear(span.min, span.max, wanted),
            Spacing::Logarithmic => ticks::logarithmic(span.min, span.max, wanted),
        }
    }
}

/// A range with room around it, also where all values are equal.
fn widened([min, max]: [f64; 2], spacing: Spacing, padding: f64) -> [f64; 2] {
    match spacing {
        Spacing::Linear => {
            let magnitude = min.abs().max(max.abs());
            // Below a billionth of its magnitude, labels could no longer tell the ends apart.
            if max - min > 1e-9 * magnitude {
                let room = padding * (max - min);
                [min - room, max + room]
            } else {
                let room = if magnitude > 0.0 { 0.1 * magnitude } else { 1.0 };
                [min - room, max + room]
            }
        }
        Spacing::Logarithmic => {
            let factor = if max > min { (max / min).powf(padding) } else { 2.0 };
            [min / factor, max * factor]
        }
    }
}

/// The range of an axis. Invariant: both ends are finite and have different places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Span {
    pub(crate) min: f64,
    pub(crate) max: f64,
    pub(crate) spacing: Spacing,
}

impl Span {
    fn place(&self, value: f64) -> f64 {
        match self.spacing {
            Spacing::Linear => value,
            Spacing::Logarithmic => value.log10(),
        }
    }

    /// Share of the way from the lower to the upper end; NaN for a value that has no place.
    pub(crate) fn share(&self, value: f64) -> f64 {
        let (low, high) = (self.place(self.min), self.place(self.max));
        (self.place(value) - low) / (high - low)
    }
}

/// Width of the widest label \[px\].
pub(crate) fn widest(ticks: &Ticks, size: f64) -> f64 {
    ticks.marks.iter().map(|(_, label)| text_width(label, size)).fold(0.0, f64::max)
}
