//! What a picture consists of: a list of items in the order in which they cover each other.
//!
//! Coordinates are pixels at scale 1, x to the right and y down.

use crate::colour::Colour;
use crate::font;

/// A point \[px\].
pub(crate) type Point = [f64; 2];

/// An axis-parallel rectangle \[px\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rect {
    pub(crate) left: f64,
    pub(crate) top: f64,
    pub(crate) right: f64,
    pub(crate) bottom: f64,
}

impl Rect {
    pub(crate) fn width(&self) -> f64 {
        self.right - self.left
    }

    pub(crate) fn height(&self) -> f64 {
        self.bottom - self.top
    }

    pub(crate) fn corners(&self) -> Vec<Point> {
        let Self { left, top, right, bottom } = *self;
        vec![[left, top], [right, top], [right, bottom], [left, bottom]]
    }
}

/// A colour with its opacity in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Paint {
    pub(crate) colour: Colour,
    pub(crate) opacity: f64,
}

/// A colour that hides what is under it.
pub(crate) fn solid(colour: Colour) -> Paint {
    Paint { colour, opacity: 1.0 }
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stroke {
    pub(crate) paint: Paint,
    pub(crate) width: f64,
    /// Lengths of dashes and gaps \[px\]; empty for a solid line.
    pub(crate) dashes: &'static [f64],
}

impl Stroke {
    pub(crate) fn solid(colour: Colour, width: f64) -> Self {
        Self { paint: solid(colour), width, dashes: &[] }
    }
}

/// Which point of a text its position means, along the text; across it is always the base line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Direction {
    Right,
    Up,
}

/// A line of text.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Text {
    pub(crate) at: Point,
    pub(crate) text: String,
    pub(crate) size: f64,
    pub(crate) anchor: Anchor,
    pub(crate) direction: Direction,
    pub(crate) colour: Colour,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Item {
    /// Pieces of one path; `closed` joins the ends of each.
    Path {
        pieces: Vec<Vec<Point>>,
        closed: bool,
        fill: Option<Paint>,
        stroke: Option<Stroke>,
        clip: Option<Rect>,
    },
    Disc {
        centre: Point,
        radius: f64,
        fill: Option<Paint>,
        stroke: Option<Stroke>,
        clip: Option<Rect>,
    },
    Text(Text),
}

/// A picture that is not yet text or pixels.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Drawing {
    pub(crate) title: String,
    pub(crate) width: f64,
    pub(crate) height: f64,
    pub(crate) items: Vec<Item>,
}

impl Drawing {
    pub(crate) fn new(title: &str, width: f64, height: f64) -> Self {
        Self { title: title.to_owned(), width, height, items: Vec::new() }
    }

    pub(crate) fn line(&mut self, points: Vec<Point>, stroke: Stroke, clip: Option<Rect>) {
        self.items.push(Item::Path {
            pieces: vec![points],
            closed: false,
            fill: None,
            stroke: Some(stroke),
            clip,
        });
    }

    pub(crate) fn polygon(
        &mut self,
        points: Vec<Point>,
        fill: Option<Paint>,
        stroke: Option<Stroke>,
        clip: Option<Rect>,
    ) {
        self.items.push(Item::Path { pieces: vec![points], closed: true, fill, stroke, clip });
    }

    pub(crate) fn text(&mut self, at: Point, text: &str, size: f64, anchor: Anchor, colour: Colour) {
        let direction = Direction::Right;
        self.items.push(Item::Text(Text { at, text: text.to_owned(), size, anchor, direction, colour }));
    }

    /// A line of text that runs upwards, centred on `at`.
    pub(crate) fn text_upwards(&mut self, at: Point, text: &str, size: f64, colour: Colour) {
        let (anchor, direction) = (Anchor::Middle, Direction::Up);
        self.items.push(Item::Text(Text { at, text: text.to_owned(), size, anchor, direction, colour }));
    }
}

/// Width of a line of text \[px\].
pub(crate) fn text_width(text: &str, size: f64) -> f64 {
    font::width(text) * size
}
