//! Names of the layers, in lines above a panel, where they hide no data.

use crate::colour::Colour;
use crate::drawing::{Anchor, Drawing, Item, Paint, Rect, Stroke, solid, text_width};
use crate::layer::{Course, Layer};
use crate::plot;

/// Size of the text \[px\].
const TEXT: f64 = 12.0;

/// Height of a line of names \[px\].
const LINE: f64 = 18.0;

/// Width of a sample \[px\].
const SAMPLE: f64 = 26.0;

/// Room between two names \[px\].
const GAP: f64 = 18.0;

/// The layers that a legend names: those that have a name which no layer before gives to the same look.
pub(crate) fn entries<'a>(layers: impl IntoIterator<Item = &'a Layer>) -> Vec<&'a Layer> {
    let mut entries: Vec<&Layer> = Vec::new();
    for layer in layers {
        if !layer.name().is_empty() && !entries.iter().any(|known| same(known, layer)) {
            entries.push(layer);
        }
    }
    entries
}

/// True if the legend would say the same of both.
fn same(one: &Layer, other: &Layer) -> bool {
    one.name() == other.name()
        && match (one, other) {
            (Layer::Series(a), Layer::Series(b)) => a.style == b.style,
            (Layer::Band(a), Layer::Band(b)) => a.colour == b.colour,
            (Layer::Region(a), Layer::Region(b)) => (a.colour, a.dash) == (b.colour, b.dash),
            (Layer::Histogram(a), Layer::Histogram(b)) => a.colour == b.colour,
            (Layer::Boxes(a), Layer::Boxes(b)) => a.colour == b.colour,
            _ => false,
        }
}

/// Names in lines that fit into `width`.
fn lines<'a>(layers: &[&'a Layer], width: f64) -> Vec<Vec<(&'a Layer, &'a str, f64)>> {
    let mut lines: Vec<Vec<_>> = Vec::new();
    let mut right = f64::INFINITY;
    for &layer in layers {
        let name = layer.name();
        let wide = SAMPLE + 6.0 + text_width(name, TEXT);
        if right + wide > width {
            lines.push(Vec::new());
            right = 0.0;
        }
        if let Some(line) = lines.last_mut() {
            line.push((layer, name, right));
        }
        right += wide + GAP;
    }
    lines
}

/// Height that the names need above a panel of this width \[px\].
pub(crate) fn height(layers: &[&Layer], width: f64) -> f64 {
    match lines(layers, width).len() {
        0 => 0.0,
        count => count as f64 * LINE + 4.0,
    }
}

/// Draws the names above `panel`.
pub(crate) fn draw(drawing: &mut Drawing, layers: &[&Layer], panel: &Rect) {
    let top = panel.top - height(layers, panel.width());
    for (row, line) in lines(layers, panel.width()).into_iter().enumerate() {
        let middle = top + (row as f64 + 0.5) * LINE;
        for (layer, name, left) in line {
            let left = panel.left + left;
            sample(drawing, layer, left, middle);
            drawing.text([left + SAMPLE + 6.0, middle + 4.2], name, TEXT, Anchor::Start, Colour::Ink);
        }
    }
}

fn sample(drawing: &mut Drawing, layer: &Layer, left: f64, middle: f64) {
    let right = left + SAMPLE;
    let patch = Rect { left: left + 3.0, right, top: middle - 5.5, bottom: middle + 5.5 }.corners();
    match layer {
        Layer::Series(series) => {
            let style = series.style;
            if series.course != Course::Points {
                let stroke =
                    Stroke { paint: solid(style.colour), width: style.width, dashes: style.dash.lengths() };
                drawing.line(vec![[left, middle], [right, middle]], stroke, None);
            }
            if let Some(marker) = style.marker {
                plot::marker(drawing, [left + SAMPLE / 2.0, middle], marker, style.colour, 1.0, None);
            }
        }
        Layer::Band(band) => {
            let edge = Stroke { paint: Paint { colour: band.colour, opacity: 0.6 }, width: 0.9, dashes: &[] };
            drawing.polygon(patch, Some(Paint { colour: band.colour, opacity: 0.2 }), Some(edge), None);
        }
        Layer::Region(region) => {
            let edge = Stroke { paint: solid(region.colour), width: 1.6, dashes: region.dash.lengths() };
            drawing.polygon(patch, Some(Paint { colour: region.colour, opacity: 0.2 }), Some(edge), None);
        }
        Layer::Histogram(histogram) => {
            let edge = Stroke::solid(histogram.colour, 0.8);
            let paint = Paint { colour: histogram.colour, opacity: 0.45 };
            drawing.polygon(patch, Some(paint), Some(edge), None);
        }
        Layer::Boxes(boxes) => {
            let edge = Stroke::solid(boxes.colour, 1.3);
            drawing.polygon(patch, Some(Paint { colour: boxes.colour, opacity: 0.3 }), Some(edge), None);
            let centre = left + 3.0 + (SAMPLE - 3.0) / 2.0;
            let pieces = vec![vec![[centre, middle - 5.5], [centre, middle + 5.5]]];
            let stroke = Some(Stroke::solid(Colour::Ink, 2.0));
            drawing.items.push(Item::Path { pieces, closed: false, fill: None, stroke, clip: None });
        }
        Layer::Heat(_) | Layer::Outline(_) => {}
    }
}

impl Layer {
    /// The name in the legend; empty for layers that are named elsewhere.
    fn name(&self) -> &str {
        match self {
            Self::Series(series) => &series.name,
            Self::Band(band) => &band.name,
            Self::Region(region) => &region.name,
            Self::Histogram(histogram) => &histogram.name,
            Self::Boxes(boxes) => &boxes.name,
            Self::Heat(_) | Self::Outline(_) => "",
        }
    }
}
