//! Why a figure cannot be drawn.

/// Why a figure cannot be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FigureError {
    /// An axis has no label or no unit; a quantity without one has the unit "–".
    #[error("{figure}: an axis needs a label and a unit, got '{label}' in '{unit}'")]
    Unlabelled {
        /// Title of the figure.
        figure: String,
        /// The axis's label.
        label: String,
        /// The axis's unit.
        unit: String,
    },
    /// Nothing finite is to be drawn along an axis, and no range is given for it.
    #[error("{figure}: no finite value along '{axis}', and no range is given for it")]
    NoData {
        /// Title of the figure.
        figure: String,
        /// Label of the axis.
        axis: String,
    },
    /// The range of an axis has no positive finite extent, or a logarithmic axis reaches 0.
    #[error("{figure}: '{axis}' cannot run from {min} to {max}")]
    Range {
        /// Title of the figure.
        figure: String,
        /// Label of the axis.
        axis: String,
        /// Lower end, as text: it need not be finite.
        min: String,
        /// Upper end, as text.
        max: String,
    },
    /// Parts of a figure have lengths that do not fit together.
    #[error("{figure}: {what} has {found} entries where {expected} are needed")]
    Length {
        /// Title of the figure.
        figure: String,
        /// What has the wrong length.
        what: &'static str,
        /// Entries needed.
        expected: usize,
        /// Entries found.
        found: usize,
    },
    /// The picture has more pixels than can be held, or none.
    #[error("a picture of {width} by {height} pixels cannot be made")]
    Pixels {
        /// Width, as text: it need not be a whole number.
        width: String,
        /// Height, as text.
        height: String,
    },
    /// The PNG encoder failed.
    #[error("cannot encode PNG: {0}")]
    Png(String),
}
