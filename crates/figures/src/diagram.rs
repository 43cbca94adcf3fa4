//! Block diagrams: boxes on a grid and arrows between neighbours.

use crate::Figure;
use crate::chart::{EDGE, TITLE, fitted};
use crate::colour::Colour;
use crate::drawing::{Anchor, Drawing, Paint, Point, Rect, Stroke, solid, text_width};
use crate::error::FigureError;

/// Sizes of text \[px\].
const NAME: f64 = 14.0;
const LINE: f64 = 12.0;
const LABEL: f64 = 12.0;

/// Distance of two lines of text \[px\].
const LEADING: f64 = 17.0;

/// Room within a box, and least room between two \[px\].
const INSIDE: f64 = 14.0;
const BETWEEN_ROWS: f64 = 64.0;

/// From an upright arrow to its label \[px\].
const BESIDE_ARROW: f64 = 9.0;

/// A box.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Its place from the left, from 0.
    pub column: usize,
    /// Its place from the top, from 0.
    pub row: usize,
    /// Its name.
    pub name: String,
    /// What it does, line by line.
    pub lines: Vec<String>,
    /// Colour of area and edge.
    pub colour: Colour,
}

/// An arrow from one box to a neighbour in its row or column.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrow {
    /// Index of the box where it begins.
    pub from: usize,
    /// Index of the box where it ends.
    pub to: usize,
    /// What it carries, line by line.
    pub lines: Vec<String>,
    /// Distance from the middle line of the boxes \[px\], down or to the right: for two arrows side by side.
    pub shift: f64,
}

/// Boxes and arrows.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagram {
    /// Stands above everything.
    pub title: String,
    /// The boxes.
    pub nodes: Vec<Node>,
    /// The arrows.
    pub arrows: Vec<Arrow>,
}

impl Diagram {
    /// Draws the diagram, as large as its text needs.
    ///
    /// # Errors
    /// [`FigureError::NoData`] without any box, [`FigureError::Length`] if an arrow names a box that is not there.
    pub fn draw(&self) -> Result<Figure, FigureError> {
        let figure = || self.title.clone();
        if self.nodes.is_empty() {
            return Err(FigureError::NoData { figure: figure(), axis: "boxes".to_owned() });
        }
        let last = self.arrows.iter().map(|arrow| arrow.from.max(arrow.to)).max();
        if let Some(last) = last.filter(|&last| last >= self.nodes.len()) {
            let (expected, found) = (last + 1, self.nodes.len());
            return Err(FigureError::Length { figure: figure(), what: "a diagram", expected, found });
        }
        let rects = self.place();
        // The label of an upright arrow may reach beyond the last column.
        let labels =
            self.arrows.iter().filter(|arrow| self.nodes[arrow.from].row != self.nodes[arrow.to].row);
        let ends = labels.map(|arrow| {
            let from = &rects[arrow.from];
            (from.left + from.right) / 2.0 + arrow.shift + BESIDE_ARROW + widest_line(&arrow.lines)
        });
        let right = rects.iter().map(|rect| rect.right).chain(ends).fold(0.0, f64::max);
        let lower = self.arrows.iter().filter(|arrow| arrow.shift > 0.0).map(|arrow| {
            let from = &rects[arrow.from];
            (from.top + from.bottom) / 2.0 + arrow.shift + arrow.lines.len() as f64 * LEADING + 4.0
        });
        let bottom = rects.iter().map(|rect| rect.bottom).chain(lower).fold(0.0, f64::max);
        let mut drawing = Drawing::new(&self.title, right + EDGE, bottom + EDGE);
        let size = fitted(&self.title, TITLE, right - EDGE);
        drawing.text([EDGE, EDGE + TITLE - 2.0], &self.title, size, Anchor::Start, Colour::Ink);
        for (node, rect) in self.nodes.iter().zip(&rects) {
            draw_node(&mut drawing, node, rect);
        }
        for arrow in &self.arrows {
            draw_arrow(&mut drawing, arrow, &rects[arrow.from], &rects[arrow.to]);
        }
        Ok(Figure::from(drawing))
    }

    /// Rectangles of the boxes: columns as wide as their widest box, gaps as wide as the labels in them.
    fn place(&self) -> Vec<Rect> {
        let count = |of: fn(&Node) -> usize| self.nodes.iter().map(of).max().map_or(0, |last| last + 1);
        let (columns, rows) = (count(|node| node.column), count(|node| node.row));
        let mut widths = vec![0.0_f64; columns];
        let mut heights = vec![0.0_f64; rows];
        let mut gaps = vec![3.0 * INSIDE; columns];
        for node in &self.nodes {
            let lines = node.lines.iter().map(|line| text_width(line, LINE)).fold(0.0, f64::max);
            let width = lines.max(text_width(&node.name, NAME)) + 2.0 * INSIDE;
            widths[node.column] = widths[node.column].max(width);
            let height = (node.lines.len() + 1) as f64 * LEADING + 1.5 * INSIDE;
            heights[node.row] = heights[node.row].max(height);
        }
        for arrow in &self.arrows {
            let (from, to) = (&self.nodes[arrow.from], &self.nodes[arrow.to]);
            let label = widest_line(&arrow.lines) + 2.5 * INSIDE;
            if from.row == to.row {
                let gap = from.column.min(to.column);
                gaps[gap] = gaps[gap].max(label);
            } else {
                // The label of an upright arrow stands on its right, over box and gap.
                let room = gaps[from.column] + widths[from.column] / 2.0 - arrow.shift;
                gaps[from.column] += (label - room).max(0.0);
            }
        }
        let along = |sizes: &[f64], gap: &dyn Fn(usize) -> f64, start: f64| -> Vec<f64> {
            let mut at = start;
            let mut starts = Vec::new();
            for (index, size) in sizes.iter().enumerate() {
                starts.push(at);
                at += size + gap(index);
            }
            starts
        };
        let lefts = along(&widths, &|index| gaps[index], EDGE);
        let tops = along(&heights, &|_| BETWEEN_ROWS, EDGE + TITLE + 14.0);
        let rect = |node: &Node| {
            let (left, top) = (lefts[node.column], tops[node.row]);
            Rect { left, top, right: left + widths[node.column], bottom: top + heights[node.row] }
        };
        self.nodes.iter().map(rect).collect()
    }
}

fn widest_line(lines: &[String]) -> f64 {
    lines.iter().map(|line| text_width(line, LABEL)).fold(0.0, f64::max)
}

fn draw_node(drawing: &mut Drawing, node: &Node, rect: &Rect) {
    let fill = Some(Paint { colour: node.colour, opacity: 0.14 });
    drawing.polygon(rect.corners(), fill, Some(Stroke::solid(node.colour, 1.6)), None);
    let middle = (rect.left + rect.right) / 2.0;
    let height = (node.lines.len() + 1) as f64 * LEADING;
    let mut y = (rect.top + rect.bottom - height) / 2.0 + NAME - 1.0;
    drawing.text([middle, y], &node.name, NAME, Anchor::Middle, Colour::Ink);
    for line in &node.lines {
        y += LEADING;
        drawing.text([middle, y], line, LINE, Anchor::Middle, Colour::Muted);
    }
}

fn draw_arrow(drawing: &mut Drawing, arrow: &Arrow, from: &Rect, to: &Rect) {
    const HEAD: f64 = 8.0;
    let middle = |low: f64, high: f64| (low + high) / 2.0;
    let is_level = from.top == to.top;
    let (start, end): (Point, Point) = if is_level {
        let y = middle(from.top, from.bottom) + arrow.shift;
        if from.left < to.left { ([from.right, y], [to.left, y]) } else { ([from.left, y], [to.right, y]) }
    } else {
        let x = middle(from.left, from.right) + arrow.shift;
        if from.top < to.top { ([x, from.bottom], [x, to.top]) } else { ([x, from.top], [x, to.bottom]) }
    };
    let length = (end[0] - start[0]).hypot(end[1] - start[1]).max(1.0);
    let along = [(end[0] - start[0]) / length, (end[1] - start[1]) / length];
    let neck = [end[0] - HEAD * along[0], end[1] - HEAD * along[1]];
    drawing.line(vec![start, neck], Stroke::solid(Colour::Ink, 1.5), None);
    let wing = |side: f64| [neck[0] - side * along[1] * HEAD / 2.0, neck[1] + side * along[0] * HEAD / 2.0];
    drawing.polygon(vec![end, wing(1.0), wing(-1.0)], Some(solid(Colour::Ink)), None, None);
    let count = arrow.lines.len() as f64;
    for (index, line) in arrow.lines.iter().enumerate() {
        let at = index as f64;
        if is_level {
            // Above the line, or below it if the arrow is the lower of two.
            let y = if arrow.shift > 0.0 {
                start[1] + (at + 1.0) * LEADING - 2.0
            } else {
                start[1] - 6.0 - (count - 1.0 - at) * LEADING
            };
            drawing.text([middle(start[0], end[0]), y], line, LABEL, Anchor::Middle, Colour::Ink);
        } else {
            let y = middle(start[1], end[1]) + 4.0 + (at - (count - 1.0) / 2.0) * LEADING;
            drawing.text([start[0] + BESIDE_ARROW, y], line, LABEL, Anchor::Start, Colour::Ink);
        }
    }
}
