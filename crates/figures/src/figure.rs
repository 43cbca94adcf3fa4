//! A figure that is laid out, to be written in one form or another.

use crate::colour::{SvgTheme, Theme};
use crate::drawing::Drawing;
use crate::error::FigureError;
use crate::{png, svg};

/// A figure that is laid out.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    drawing: Drawing,
}

impl From<Drawing> for Figure {
    fn from(drawing: Drawing) -> Self {
        Self { drawing }
    }
}

impl Figure {
    /// Its title.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.drawing.title
    }

    /// Width and height \[px\] at scale 1.
    #[must_use]
    pub fn size(&self) -> [f64; 2] {
        [self.drawing.width, self.drawing.height]
    }

    /// The figure as an SVG document, which may stand in the midst of HTML too, several in one page.
    #[must_use]
    pub fn svg(&self, theme: SvgTheme) -> String {
        svg::write(&self.drawing, theme)
    }

    /// The figure as a PNG with `scale` times as many pixels as [`Figure::size`] says.
    ///
    /// # Errors
    /// [`FigureError::Pixels`] if that is none or more than 16384 along a side, [`FigureError::Png`] if they cannot be
    /// encoded.
    pub fn png(&self, theme: Theme, scale: f64) -> Result<Vec<u8>, FigureError> {
        png::encode(&self.drawing, theme, scale)
    }
}
