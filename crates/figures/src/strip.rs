//! Pictures beside each other on equal axes: one thing at several times.

use crate::axis::{Axis, widest};
use crate::chart::{EDGE, LABEL, TICK, TITLE, check_lengths, fitted, grid, wanted, x_axis, y_axis};
use crate::colour::Colour;
use crate::drawing::{Anchor, Drawing, Rect};
use crate::error::FigureError;
use crate::layer::Layer;
use crate::plot::{self, Frame};
use crate::{Figure, legend};

/// Room between two pictures \[px\].
const BETWEEN: f64 = 14.0;

/// Height of a caption with the room below it \[px\].
const CAPTION: f64 = 20.0;

/// One picture of a strip.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Stands above it.
    pub caption: String,
    /// What is drawn; later layers cover earlier ones.
    pub layers: Vec<Layer>,
}

/// Pictures in rows, all with the same axes, on which units are equally long.
///
/// The names of all layers stand once, above everything.
#[derive(Clone, Debug, PartialEq)]
pub struct Strip {
    /// Stands above everything.
    pub title: String,
    /// The x axis of every picture.
    pub x: Axis,
    /// The y axis of every picture.
    pub y: Axis,
    /// In the order in which one reads.
    pub pictures: Vec<Picture>,
    /// Pictures in a row.
    pub columns: usize,
    /// Width of the whole figure \[px\].
    pub width: f64,
}

impl Strip {
    /// Draws the strip.
    ///
    /// # Errors
    /// As [`Chart::draw`](crate::Chart::draw).
    pub fn draw(&self) -> Result<Figure, FigureError> {
        let title = &self.title;
        let layers = || self.pictures.iter().flat_map(|picture| &picture.layers);
        for layer in layers() {
            check_lengths(title, layer, &self.y)?;
        }
        let x = self.x.resolve(title, layers().flat_map(Layer::xs), 0.04)?;
        let y = self.y.resolve(title, layers().flat_map(Layer::ys), 0.04)?;
        let columns = self.columns.clamp(1, self.pictures.len().max(1));

        let y_ticks = self.y.ticks(&y, 5);
        let left = EDGE + LABEL + 10.0 + widest(&y_ticks, TICK) + 8.0;
        let all = self.width - EDGE - 8.0 - left;
        let width = ((all - (columns - 1) as f64 * BETWEEN) / columns as f64).max(10.0);
        let height = width * (y.max - y.min) / (x.max - x.min);
        let names = legend::entries(layers());
        let top = EDGE + TITLE + 8.0 + legend::height(&names, all) + CAPTION;
        let rows = self.pictures.len().div_ceil(columns);
        let below = 8.0 + TICK + 8.0 + LABEL + EDGE;
        let total = top + rows as f64 * (height + CAPTION + BETWEEN) - CAPTION - BETWEEN + below;

        let mut drawing = Drawing::new(title, self.width, total);
        let size = fitted(title, TITLE, self.width - left - EDGE);
        drawing.text([left, EDGE + TITLE - 2.0], title, size, Anchor::Start, Colour::Ink);
        let above = Rect { left, right: left + all, top: top - CAPTION, bottom: top };
        legend::draw(&mut drawing, &names, &above);
        let x_ticks = self.x.ticks(&x, wanted(width, 60.0));
        for (index, picture) in self.pictures.iter().enumerate() {
            let (row, column) = (index / columns, index % columns);
            let left = left + column as f64 * (width + BETWEEN);
            let top = top + row as f64 * (height + CAPTION + BETWEEN);
            let rect = Rect { left, top, right: left + width, bottom: top + height };
            let frame = Frame { rect, x, y };
            grid(&mut drawing, &frame, &x_ticks, &y_ticks, true);
            for (order, layer) in picture.layers.iter().enumerate() {
                plot::layer(&mut drawing, &frame, layer, order);
            }
            let caption = &picture.caption;
            let size = fitted(caption, TICK, width);
            drawing.text([(left + rect.right) / 2.0, top - 6.0], caption, size, Anchor::Middle, Colour::Ink);
            if column == 0 {
                y_axis(&mut drawing, &frame, &y_ticks, &self.y.caption(y_ticks.exponent));
            }
            if index + columns >= self.pictures.len() {
                x_axis(&mut drawing, &frame, &x_ticks, &self.x.caption(x_ticks.exponent));
            }
        }
        Ok(Figure::from(drawing))
    }
}
