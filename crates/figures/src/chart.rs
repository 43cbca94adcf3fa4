//! Charts: panels above each other that share the x axis.

use crate::axis::{Axis, Span, widest};
use crate::colour::Colour;
use crate::drawing::{Anchor, Drawing, Rect, Stroke, solid, text_width};
use crate::error::FigureError;
use crate::layer::{Heat, Layer, Limit};
use crate::plot::{self, Frame};
use crate::ticks::Ticks;
use crate::{Figure, legend};

/// Sizes of text \[px\].
pub(crate) const TITLE: f64 = 15.0;
pub(crate) const LABEL: f64 = 13.0;
pub(crate) const TICK: f64 = 12.0;

/// Room around everything \[px\].
pub(crate) const EDGE: f64 = 12.0;

/// Room below the title \[px\].
const UNDER_TITLE: f64 = 10.0;

/// Room between two panels \[px\].
const BETWEEN: f64 = 14.0;

/// Width of a colour bar with the room beside it \[px\].
const BAR: f64 = 16.0;
const BESIDE_BAR: f64 = 16.0;

/// How long a unit of y is beside a unit of x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Proportion {
    /// As it comes: every panel has its own height.
    Free,
    /// Equally long, as in a map; the height follows.
    Equal,
}

/// A panel: what is drawn over the shared x axis and an own y axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// The y axis.
    pub y: Axis,
    /// What is drawn; later layers cover earlier ones.
    pub layers: Vec<Layer>,
    /// Limits of y, always in view.
    pub limits: Vec<Limit>,
    /// Height of the area with the data \[px\]; not used with [`Proportion::Equal`].
    pub height: f64,
}

impl Panel {
    /// A panel of ordinary height without limits.
    #[must_use]
    pub fn new(y: Axis, layers: Vec<Layer>) -> Self {
        Self { y, layers, limits: Vec::new(), height: 200.0 }
    }
}

/// Panels above each other with one x axis.
///
/// # Examples
/// ```
/// use figures::{Axis, Chart, Course, Layer, Limit, Panel, Series, Style, Theme};
///
/// let points = (0..=50).map(|k| [f64::from(k) * 0.1, (f64::from(k) * 0.1).sin() * 0.1]).collect();
/// let speed = Series { name: "lift".into(), points, course: Course::Straight, style: Style::nth(0) };
/// let chart = Chart {
///     panels: vec![Panel {
///         limits: Limit::both(-0.15, 0.15),
///         ..Panel::new(Axis::new("Velocity", "m/s"), vec![Layer::Series(speed)])
///     }],
///     ..Chart::new("Speed of the lift cylinder", Axis::new("Time", "s"))
/// };
/// let figure = chart.draw()?;
/// assert!(figure.svg(figures::SvgTheme::Reader).contains("Velocity [m/s]"));
/// assert!(figure.png(Theme::Dark, 2.0)?.starts_with(b"\x89PNG"));
/// # Ok::<(), figures::FigureError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// Stands above everything.
    pub title: String,
    /// The axis that all panels share.
    pub x: Axis,
    /// From top to bottom.
    pub panels: Vec<Panel>,
    /// Width of the whole figure \[px\].
    pub width: f64,
    /// Lengths of units on both axes.
    pub proportion: Proportion,
}

/// A panel with its ranges and ticks.
struct Prepared<'a> {
    panel: &'a Panel,
    /// Layers that the legend names.
    names: Vec<&'a Layer>,
    y: Span,
    ticks: Ticks,
    heat: Option<(&'a Heat, Span, Ticks)>,
}

impl Chart {
    /// A chart without panels, of the width of a page's column.
    #[must_use]
    pub fn new(title: &str, x: Axis) -> Self {
        Self { title: title.to_owned(), x, panels: Vec::new(), width: 760.0, proportion: Proportion::Free }
    }

    /// Draws the chart.
    ///
    /// Points that are not finite are gaps. An axis without a range takes that of everything finite on it, limits
    /// included; where that is a single value, it has room around it.
    ///
    /// # Errors
    /// An axis lacks its label, unit or any value, or has a range that is none; or lists do not fit together.
    pub fn draw(&self) -> Result<Figure, FigureError> {
        let title = &self.title;
        let xs = self.panels.iter().flat_map(|panel| panel.layers.iter().flat_map(Layer::xs));
        let x = self.x.resolve(title, xs, if self.proportion == Proportion::Equal { 0.04 } else { 0.0 })?;
        let panels =
            (0..self.panels.len()).map(|index| self.prepare(index)).collect::<Result<Vec<_>, _>>()?;

        let wide_ticks = panels.iter().map(|p| widest(&p.ticks, TICK)).fold(0.0, f64::max);
        let left = EDGE + LABEL + 10.0 + wide_ticks + 8.0;
        let right = self.width - EDGE - panels.iter().map(beside).fold(8.0, f64::max);
        let plot_width = (right - left).max(1.0);
        let mut top = EDGE + TITLE + UNDER_TITLE;
        let mut rects = Vec::new();
        for prepared in &panels {
            top += legend::height(&prepared.names, plot_width);
            let height = match self.proportion {
                Proportion::Free => prepared.panel.height.max(20.0),
                Proportion::Equal => plot_width * (prepared.y.max - prepared.y.min) / (x.max - x.min),
            };
            rects.push(Rect { left, top, right, bottom: top + height });
            top += height + BETWEEN;
        }
        let below = top - BETWEEN + 8.0 + TICK + 8.0 + LABEL + EDGE;
        let mut drawing = Drawing::new(title, self.width, below);
        drawing.text(
            [left, EDGE + TITLE - 2.0],
            title,
            fitted(title, TITLE, self.width - left - EDGE),
            Anchor::Start,
            Colour::Ink,
        );
        let x_ticks = self.x.ticks(&x, wanted(plot_width, 90.0));
        for (index, (prepared, &rect)) in panels.iter().zip(&rects).enumerate() {
            let frame = Frame { rect, x, y: prepared.y };
            prepared.draw(&mut drawing, &frame, &x_ticks);
            if index + 1 == panels.len() {
                x_axis(&mut drawing, &frame, &x_ticks, &self.x.caption(x_ticks.exponent));
            }
        }
        Ok(Figure::from(drawing))
    }

    fn prepare(&self, index: usize) -> Result<Prepared<'_>, FigureError> {
        let (title, panel) = (&self.title, &self.panels[index]);
        for layer in &panel.layers {
            check_lengths(title, layer, &panel.y)?;
        }
        let limits = panel.limits.iter().map(|limit| limit.value);
        let y = panel.y.resolve(title, panel.layers.iter().flat_map(Layer::ys).chain(limits), 0.05)?;
        // Bars stand on their axis.
        let has_bars = panel.layers.iter().any(|layer| matches!(layer, Layer::Histogram(_)));
        let y = if has_bars && panel.y.range.is_none() { Span { min: y.min.max(0.0), ..y } } else { y };
        let heat = panel.layers.iter().find_map(|layer| match layer {
            Layer::Heat(heat) => Some(heat),
            _ => None,
        });
        let heat = match heat {
            None => None,
            Some(heat) => {
                let span = heat.quantity.resolve(title, heat.values.iter().copied(), 0.0)?;
                Some((heat, span, heat.quantity.ticks(&span, 6)))
            }
        };
        let height = if self.proportion == Proportion::Equal { 400.0 } else { panel.height };
        // A name that an earlier panel has explained already does not come again.
        let before = self.panels[..index].iter().flat_map(|panel| &panel.layers);
        let known = legend::entries(before).len();
        let names =
            legend::entries(self.panels[..=index].iter().flat_map(|panel| &panel.layers)).split_off(known);
        Ok(Prepared { panel, names, y, ticks: panel.y.ticks(&y, wanted(height, 42.0)), heat })
    }
}

pub(crate) fn wanted(length: f64, each: f64) -> usize {
    (length / each).round().clamp(2.0, 12.0) as usize
}

/// The size, or what of it makes the text fit into `width`.
pub(crate) fn fitted(text: &str, size: f64, width: f64) -> f64 {
    size.min(width / text_width(text, 1.0).max(1e-9))
}

/// Room on the right of a panel: names of limits, or a colour bar.
fn beside(prepared: &Prepared<'_>) -> f64 {
    let names = prepared.panel.limits.iter().map(|limit| 6.0 + text_width(&limit.name, TICK));
    let names = names.fold(0.0, f64::max);
    match &prepared.heat {
        None => names,
        Some((_, _, ticks)) => names + BESIDE_BAR + BAR + 8.0 + widest(ticks, TICK) + 10.0 + LABEL,
    }
}

pub(crate) fn check_lengths(figure: &str, layer: &Layer, y: &Axis) -> Result<(), FigureError> {
    let (what, expected, found) = match layer {
        Layer::Heat(heat) => {
            let cells = heat.x_edges.len().saturating_sub(1) * heat.y_edges.len().saturating_sub(1);
            ("a heat map", cells, heat.values.len())
        }
        Layer::Histogram(histogram) => {
            ("a histogram", histogram.edges.len().saturating_sub(1), histogram.heights.len())
        }
        Layer::Boxes(boxes) => ("a row of boxes", y.categories.len(), boxes.distributions.len()),
        _ => return Ok(()),
    };
    let figure = figure.to_owned();
    if expected == found { Ok(()) } else { Err(FigureError::Length { figure, what, expected, found }) }
}

impl Prepared<'_> {
    fn draw(&self, drawing: &mut Drawing, frame: &Frame, x_ticks: &Ticks) {
        let Panel { y, layers, limits, .. } = self.panel;
        grid(drawing, frame, x_ticks, &self.ticks, y.categories.is_empty());
        for limit in limits {
            plot::forbidden(drawing, frame, limit);
        }
        for (order, layer) in layers.iter().enumerate() {
            plot::layer(drawing, frame, layer, order);
        }
        for limit in limits {
            plot::limit(drawing, frame, limit);
        }
        limit_names(drawing, frame, limits);
        y_axis(drawing, frame, &self.ticks, &y.caption(self.ticks.exponent));
        legend::draw(drawing, &self.names, &frame.rect);
        if let Some((heat, span, ticks)) = &self.heat {
            colour_bar(drawing, &frame.rect, span, ticks, &heat.quantity.caption(ticks.exponent));
        }
    }
}

pub(crate) fn grid(drawing: &mut Drawing, frame: &Frame, x_ticks: &Ticks, y_ticks: &Ticks, has_rows: bool) {
    let line = Stroke::solid(Colour::Grid, 1.0);
    let Rect { left, top, right, bottom } = frame.rect;
    for (value, _) in &x_ticks.marks {
        let x = frame.x(*value);
        drawing.line(vec![[x, top], [x, bottom]], line, None);
    }
    for (value, _) in y_ticks.marks.iter().filter(|_| has_rows) {
        let y = frame.y(*value);
        drawing.line(vec![[left, y], [right, y]], line, None);
    }
}

/// Names beside their lines, moved apart where they would touch.
fn limit_names(drawing: &mut Drawing, frame: &Frame, limits: &[Limit]) {
    let mut names: Vec<(f64, &str)> =
        limits.iter().map(|limit| (frame.y(limit.value), limit.name.as_str())).collect();
    names.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut free = f64::NEG_INFINITY;
    for (y, name) in names {
        let y = y.max(free);
        free = y + TICK + 1.0;
        drawing.text([frame.rect.right + 6.0, y + 4.0], name, TICK, Anchor::Start, Colour::Muted);
    }
}

pub(crate) fn y_axis(drawing: &mut Drawing, frame: &Frame, ticks: &Ticks, caption: &str) {
    let Rect { left, top, bottom, .. } = frame.rect;
    for (value, label) in &ticks.marks {
        let y = frame.y(*value);
        drawing.line(vec![[left - 4.0, y], [left, y]], Stroke::solid(Colour::Muted, 1.0), None);
        drawing.text([left - 8.0, y + 4.2], label, TICK, Anchor::End, Colour::Ink);
    }
    drawing.line(vec![[left, top], [left, bottom]], Stroke::solid(Colour::Muted, 1.2), None);
    let at = [EDGE + LABEL - 2.0, (top + bottom) / 2.0];
    drawing.text_upwards(
        at,
        caption,
        fitted(caption, LABEL, frame.rect.height() + BETWEEN - 4.0),
        Colour::Ink,
    );
}

pub(crate) fn x_axis(drawing: &mut Drawing, frame: &Frame, ticks: &Ticks, caption: &str) {
    let Rect { left, right, bottom, .. } = frame.rect;
    drawing.line(vec![[left, bottom], [right, bottom]], Stroke::solid(Colour::Muted, 1.2), None);
    for (value, label) in &ticks.marks {
        let x = frame.x(*value);
        drawing.line(vec![[x, bottom], [x, bottom + 4.0]], Stroke::solid(Colour::Muted, 1.0), None);
        drawing.text([x, bottom + 8.0 + TICK - 2.0], label, TICK, Anchor::Middle, Colour::Ink);
    }
    let at = [(left + right) / 2.0, bottom + 8.0 + TICK + 8.0 + LABEL - 2.0];
    drawing.text(at, caption, fitted(caption, LABEL, right - left + 40.0), Anchor::Middle, Colour::Ink);
}

fn colour_bar(drawing: &mut Drawing, panel: &Rect, span: &Span, ticks: &Ticks, caption: &str) {
    let left = panel.right + BESIDE_BAR;
    let rect = Rect { left, right: left + BAR, ..*panel };
    let steps = 64;
    for step in 0..steps {
        let share = |step: i32| rect.bottom - f64::from(step) / f64::from(steps) * rect.height();
        let cell = Rect { top: share(step + 1), bottom: share(step), ..rect };
        let shade = Colour::Scale((f64::from(step) / f64::from(steps - 1) * 255.0).round() as u8);
        drawing.polygon(cell.corners(), Some(solid(shade)), None, None);
    }
    drawing.polygon(rect.corners(), None, Some(Stroke::solid(Colour::Muted, 1.0)), None);
    for (value, label) in &ticks.marks {
        let y = rect.bottom - span.share(*value) * rect.height();
        drawing.line(vec![[rect.right, y], [rect.right + 4.0, y]], Stroke::solid(Colour::Muted, 1.0), None);
        drawing.text([rect.right + 8.0, y + 4.2], label, TICK, Anchor::Start, Colour::Ink);
    }
    let x = rect.right + 8.0 + widest(ticks, TICK) + 8.0 + LABEL - 2.0;
    let size = fitted(caption, LABEL, rect.height() + 24.0);
    drawing.text_upwards([x, (rect.top + rect.bottom) / 2.0], caption, size, Colour::Ink);
}
