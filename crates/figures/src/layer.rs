//! What may lie in a panel.

use crate::axis::Axis;
use crate::colour::Colour;

/// How one value leads to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Course {
    /// Straight lines between the points.
    Straight,
    /// Each value holds until the next point; the last one until the axis ends.
    Steps,
    /// Not at all: the points alone.
    Points,
}

/// Dashes of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dash {
    /// None.
    Solid,
    /// Even dashes.
    Dashed,
    /// Dots.
    Dotted,
    /// Dashes and dots in turn.
    DashDot,
    /// Long dashes.
    LongDash,
}

impl Dash {
    pub(crate) fn lengths(self) -> &'static [f64] {
        match self {
            Self::Solid => &[],
            Self::Dashed => &[6.0, 3.0],
            Self::Dotted => &[1.6, 2.4],
            Self::DashDot => &[7.0, 2.5, 1.6, 2.5],
            Self::LongDash => &[12.0, 4.0],
        }
    }
}

/// A sign at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// A filled disc.
    Disc,
    /// A filled square.
    Square,
    /// A filled triangle, point upwards.
    Triangle,
    /// A filled diamond.
    Diamond,
    /// An oblique cross.
    Cross,
    /// An empty ring.
    Ring,
}

/// Look of a series: three things that tell it apart, of which a reader may lack two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// Colour of line and markers.
    pub colour: Colour,
    /// Dashes of the line.
    pub dash: Dash,
    /// Sign at the points; at some of them if there are many.
    pub marker: Option<Marker>,
    /// Width of the line \[px\].
    pub width: f64,
}

impl Style {
    /// The look of the nth series; the first eight differ in colour, dash and marker.
    #[must_use]
    pub fn nth(n: usize) -> Self {
        const LOOKS: [(Colour, Dash, Marker); 8] = [
            (Colour::Blue, Dash::Solid, Marker::Disc),
            (Colour::Vermillion, Dash::Dashed, Marker::Square),
            (Colour::Green, Dash::DashDot, Marker::Triangle),
            (Colour::Purple, Dash::Dotted, Marker::Diamond),
            (Colour::Orange, Dash::LongDash, Marker::Cross),
            (Colour::Sky, Dash::Solid, Marker::Ring),
            (Colour::Ink, Dash::Dashed, Marker::Disc),
            (Colour::Grey, Dash::DashDot, Marker::Square),
        ];
        let (colour, dash, marker) = LOOKS[n % LOOKS.len()];
        Self { colour, dash, marker: Some(marker), width: 1.8 }
    }

    /// The same without markers.
    #[must_use]
    pub fn unmarked(self) -> Self {
        Self { marker: None, ..self }
    }
}

/// Points in the order in which they are joined.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Name in the legend; not in it if empty.
    pub name: String,
    /// Points (x, y); one that is not finite is a gap.
    pub points: Vec<[f64; 2]>,
    /// How they are joined.
    pub course: Course,
    /// How they look.
    pub style: Style,
}

/// An area between a lower and an upper value.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    /// Name in the legend; not in it if empty.
    pub name: String,
    /// Points (x, lower, upper); one that is not finite is a gap.
    pub points: Vec<[f64; 3]>,
    /// How one point leads to the next.
    pub course: Course,
    /// Colour of area and edges.
    pub colour: Colour,
}

/// A filled polygon.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// Name in the legend; not in it if empty.
    pub name: String,
    /// Vertices (x, y) in order.
    pub vertices: Vec<[f64; 2]>,
    /// Colour of area and edge.
    pub colour: Colour,
    /// Dashes of the edge.
    pub dash: Dash,
}

/// Counts in intervals.
#[derive(Clone, Debug, PartialEq)]
pub struct Histogram {
    /// Name in the legend; not in it if empty.
    pub name: String,
    /// Ends of the intervals, ascending, one more than there are counts.
    pub edges: Vec<f64>,
    /// Height of each bar.
    pub heights: Vec<f64>,
    /// Colour of the bars.
    pub colour: Colour,
}

/// Distributions beside each other along the y axis, which names them by its categories.
#[derive(Clone, Debug, PartialEq)]
pub struct Boxes {
    /// Name in the legend; not in it if empty.
    pub name: String,
    /// For each category its distribution, or none.
    pub distributions: Vec<Option<crate::Distribution>>,
    /// Colour of the boxes.
    pub colour: Colour,
    /// Offset from the category's place, for several kinds beside each other, in [-0.5, 0.5].
    pub offset: f64,
    /// Thickness of a box, 1 for all the room that a category has.
    pub thickness: f64,
}

/// Values over a plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Heat {
    /// What is shown, its unit, and the range of the colours.
    pub quantity: Axis,
    /// Edges of the columns, ascending.
    pub x_edges: Vec<f64>,
    /// Edges of the rows, ascending.
    pub y_edges: Vec<f64>,
    /// Values row by row from the lowest row; one that is not finite is left blank.
    pub values: Vec<f64>,
}

/// A thing drawn as it looks, part by part.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Later parts cover earlier ones.
    pub parts: Vec<Part>,
}

/// A filled polygon without a name.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Vertices (x, y) in order.
    pub vertices: Vec<[f64; 2]>,
    /// Colour of area and edge.
    pub colour: Colour,
}

/// One layer of a panel; later ones cover earlier ones.
#[derive(Clone, Debug, PartialEq)]
pub enum Layer {
    /// A line, steps or points.
    Series(Series),
    /// An area between two lines.
    Band(Band),
    /// A polygon.
    Region(Region),
    /// Bars from 0.
    Histogram(Histogram),
    /// Distributions side by side.
    Boxes(Boxes),
    /// Colours over a plane; the chart has its colour bar on the right.
    Heat(Heat),
    /// A drawing of a thing.
    Outline(Outline),
}

/// Which side of a limit is forbidden.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Forbidden {
    /// Greater values.
    Above,
    /// Smaller values.
    Below,
}

/// A limit of the y axis: a dashed line, with the side shaded that is forbidden.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// Stands on the right, outside the data.
    pub name: String,
    /// Where it is.
    pub value: f64,
    /// Which side is shaded.
    pub forbidden: Forbidden,
}

impl Limit {
    /// Both ends of an interval, called "min" and "max".
    #[must_use]
    pub fn both(min: f64, max: f64) -> Vec<Self> {
        vec![
            Self { name: "min".to_owned(), value: min, forbidden: Forbidden::Below },
            Self { name: "max".to_owned(), value: max, forbidden: Forbidden::Above },
        ]
    }
}

impl Layer {
    /// Every x that must be in view.
    pub(crate) fn xs(&self) -> Box<dyn Iterator<Item = f64> + '_> {
        match self {
            Self::Series(series) => Box::new(visible(&series.points).map(|[x, _]| x)),
            Self::Band(band) => Box::new(band.points.iter().filter(|p| finite(&p[..])).map(|p| p[0])),
            Self::Region(region) => Box::new(visible(&region.vertices).map(|[x, _]| x)),
            Self::Histogram(histogram) => Box::new(histogram.edges.iter().copied()),
            Self::Boxes(boxes) => {
                Box::new(boxes.distributions.iter().flatten().flat_map(|found| [found.min, found.max]))
            }
            Self::Heat(heat) => Box::new(heat.x_edges.iter().copied()),
            Self::Outline(outline) => {
                Box::new(outline.parts.iter().flat_map(|part| visible(&part.vertices)).map(|[x, _]| x))
            }
        }
    }

    /// Every y that must be in view.
    pub(crate) fn ys(&self) -> Box<dyn Iterator<Item = f64> + '_> {
        match self {
            Self::Series(series) => Box::new(visible(&series.points).map(|[_, y]| y)),
            Self::Band(band) => {
                let seen = band.points.iter().filter(|p| finite(&p[..]));
                Box::new(seen.flat_map(|&[_, low, high]| [low, high]))
            }
            Self::Region(region) => Box::new(visible(&region.vertices).map(|[_, y]| y)),
            Self::Histogram(histogram) => Box::new(histogram.heights.iter().copied().chain([0.0])),
            Self::Boxes(_) => Box::new(std::iter::empty()),
            Self::Heat(heat) => Box::new(heat.y_edges.iter().copied()),
            Self::Outline(outline) => {
                Box::new(outline.parts.iter().flat_map(|part| visible(&part.vertices)).map(|[_, y]| y))
            }
        }
    }
}

fn finite(values: &[f64]) -> bool {
    values.iter().all(|value| value.is_finite())
}

fn visible(points: &[[f64; 2]]) -> impl Iterator<Item = [f64; 2]> + '_ {
    points.iter().copied().filter(|point| finite(point))
}
