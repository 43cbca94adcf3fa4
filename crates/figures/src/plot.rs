//! Draws layers into a rectangle.

use crate::axis::Span;
use crate::colour::Colour;
use crate::drawing::{Drawing, Item, Paint, Point, Rect, Stroke, solid};
use crate::layer::{
    Band, Boxes, Course, Heat, Histogram, Layer, Limit, Marker, Outline, Region, Series, Style,
};

/// Pixels that are used for a point or line beyond the rectangle; far enough not to be seen.
const FAR: f64 = 1e5;

/// Most markers along a line.
const MOST_MARKERS: usize = 14;

/// Shades of a heat map: more cannot be told apart, and equal ones share one path.
const SHADES: f64 = 63.0;

/// A rectangle with the axes that belong to its sides.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub(crate) rect: Rect,
    pub(crate) x: Span,
    pub(crate) y: Span,
}

impl Frame {
    pub(crate) fn x(&self, value: f64) -> f64 {
        (self.rect.left + self.x.share(value) * self.rect.width()).clamp(-FAR, FAR)
    }

    pub(crate) fn y(&self, value: f64) -> f64 {
        (self.rect.bottom - self.y.share(value) * self.rect.height()).clamp(-FAR, FAR)
    }

    /// Place of a point; none if a coordinate has no place on its axis.
    fn place(&self, [x, y]: [f64; 2]) -> Option<Point> {
        let place = [self.x(x), self.y(y)];
        (x.is_finite() && y.is_finite() && place.iter().all(|c| c.is_finite())).then_some(place)
    }

    /// Points in runs without gaps.
    fn runs(&self, points: impl Iterator<Item = [f64; 2]>) -> Vec<Vec<Point>> {
        let mut runs = vec![Vec::new()];
        for point in points {
            match (self.place(point), runs.last_mut()) {
                (Some(place), Some(run)) => run.push(place),
                _ => runs.push(Vec::new()),
            }
        }
        runs.retain(|run| !run.is_empty());
        runs
    }
}

pub(crate) fn layer(drawing: &mut Drawing, frame: &Frame, layer: &Layer, order: usize) {
    match layer {
        Layer::Series(series) => self::series(drawing, frame, series, order),
        Layer::Band(band) => self::band(drawing, frame, band),
        Layer::Region(region) => self::region(drawing, frame, region),
        Layer::Histogram(histogram) => self::histogram(drawing, frame, histogram),
        Layer::Boxes(boxes) => self::boxes(drawing, frame, boxes),
        Layer::Heat(heat) => self::heat(drawing, frame, heat),
        Layer::Outline(outline) => self::outline(drawing, frame, outline),
    }
}

/// The forbidden side of a limit, faintly, under the data.
pub(crate) fn forbidden(drawing: &mut Drawing, frame: &Frame, limit: &Limit) {
    let Rect { left, right, top, bottom } = frame.rect;
    let y = frame.y(limit.value).clamp(top, bottom);
    let rect = match limit.forbidden {
        crate::Forbidden::Above => Rect { left, right, top, bottom: y },
        crate::Forbidden::Below => Rect { left, right, top: y, bottom },
    };
    if rect.height() > 0.0 {
        drawing.polygon(rect.corners(), Some(Paint { colour: Colour::Grey, opacity: 0.16 }), None, None);
    }
}

/// The line of a limit, over the data.
pub(crate) fn limit(drawing: &mut Drawing, frame: &Frame, limit: &Limit) {
    let y = frame.y(limit.value);
    if (frame.rect.top - 0.5..=frame.rect.bottom + 0.5).contains(&y) {
        let stroke = Stroke { paint: solid(Colour::Ink), width: 1.1, dashes: &[7.0, 4.0] };
        drawing.line(vec![[frame.rect.left, y], [frame.rect.right, y]], stroke, None);
    }
}

fn series(drawing: &mut Drawing, frame: &Frame, series: &Series, order: usize) {
    let Style { colour, dash, marker, width } = series.style;
    let clip = Some(frame.rect);
    let runs = match series.course {
        Course::Straight | Course::Points => frame.runs(series.points.iter().copied()),
        Course::Steps => frame.runs(stairs(&series.points, frame.x.max)),
    };
    if series.course != Course::Points {
        let stroke = Stroke { paint: solid(colour), width, dashes: dash.lengths() };
        let pieces: Vec<_> = runs.iter().filter(|run| run.len() > 1).map(|run| thinned(run)).collect();
        if !pieces.is_empty() {
            drawing.items.push(Item::Path { pieces, closed: false, fill: None, stroke: Some(stroke), clip });
        }
    }
    let places: Vec<Point> = series.points.iter().filter_map(|&point| frame.place(point)).collect();
    let lonely = runs.iter().all(|run| run.len() == 1);
    if let Some(marker) = marker.or(lonely.then_some(Marker::Disc)) {
        let every = match series.course {
            Course::Points => 1,
            _ => places.len().div_ceil(MOST_MARKERS).max(1),
        };
        // Points that are close together must not hide each other.
        let size = (frame.rect.width() / places.len() as f64 / 12.0).clamp(0.5, 1.0);
        let size = if series.course == Course::Points { size } else { 1.0 };
        // Series of equal length would hide each other's markers.
        for &place in places.iter().skip(order * every / 4 % every).step_by(every) {
            self::marker(drawing, place, marker, colour, size, clip);
        }
    }
}

/// Corners of a staircase whose last step ends at `end`.
fn stairs(points: &[[f64; 2]], end: f64) -> impl Iterator<Item = [f64; 2]> + '_ {
    points.iter().enumerate().flat_map(move |(index, &[x, y])| {
        let next = points.get(index + 1).map_or(end.max(x), |next| next[0]);
        [[x, y], [next, y]]
    })
}

/// Leaves out points that no one could see: of those in the same half pixel column the first, last, highest and lowest
/// remain. Lines that run back and forth keep all of their points.
fn thinned(run: &[Point]) -> Vec<Point> {
    if run.len() < 500 || run.windows(2).any(|pair| pair[0][0] > pair[1][0]) {
        return run.to_vec();
    }
    let mut kept = Vec::new();
    for column in run.chunk_by(|a, b| (2.0 * a[0]).floor() == (2.0 * b[0]).floor()) {
        let extreme = |sign: f64| {
            let ahead = |best: usize, (index, point): (usize, &Point)| {
                if sign * point[1] > sign * column[best][1] { index } else { best }
            };
            column.iter().enumerate().fold(0, ahead)
        };
        let mut indices = [0, extreme(1.0), extreme(-1.0), column.len() - 1];
        indices.sort_unstable();
        let mut last = None;
        for index in indices {
            if last != Some(index) {
                kept.push(column[index]);
            }
            last = Some(index);
        }
    }
    kept
}

/// A sign of `size` 1 at most at a point.
pub(crate) fn marker(
    drawing: &mut Drawing,
    [x, y]: Point,
    marker: Marker,
    colour: Colour,
    size: f64,
    clip: Option<Rect>,
) {
    let rim = Some(Stroke::solid(Colour::Paper, 0.8));
    let fill = Some(solid(colour));
    let at = |offsets: &[Point]| offsets.iter().map(|[dx, dy]| [x + size * dx, y + size * dy]).collect();
    let centre = [x, y];
    let (radius, half) = (3.4 * size, 3.2);
    match marker {
        Marker::Disc => drawing.items.push(Item::Disc { centre, radius, fill, stroke: rim, clip }),
        Marker::Ring => {
            let stroke = Some(Stroke::solid(colour, 1.6 * size));
            let fill = Some(solid(Colour::Paper));
            drawing.items.push(Item::Disc { centre, radius, fill, stroke, clip });
        }
        Marker::Square => {
            let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
            drawing.polygon(at(&corners), fill, rim, clip);
        }
        Marker::Triangle => drawing.polygon(at(&[[0.0, -4.4], [4.2, 3.2], [-4.2, 3.2]]), fill, rim, clip),
        Marker::Diamond => {
            drawing.polygon(at(&[[0.0, -4.6], [4.6, 0.0], [0.0, 4.6], [-4.6, 0.0]]), fill, rim, clip);
        }
        Marker::Cross => {
            let arms = [at(&[[-3.6, -3.6], [3.6, 3.6]]), at(&[[-3.6, 3.6], [3.6, -3.6]])];
            let stroke = Some(Stroke::solid(colour, 2.0));
            let pieces = arms.into();
            drawing.items.push(Item::Path { pieces, closed: false, fill: None, stroke, clip });
        }
    }
}

fn band(drawing: &mut Drawing, frame: &Frame, band: &Band) {
    let clip = Some(frame.rect);
    let edge = |index: usize| {
        let points: Vec<[f64; 2]> = band
            .points
            .iter()
            .map(|point| {
                let is_gap = point.iter().any(|value| !value.is_finite());
                if is_gap { [f64::NAN; 2] } else { [point[0], point[index]] }
            })
            .collect();
        match band.course {
            Course::Steps => frame.runs(stairs(&points, frame.x.max)),
            Course::Straight | Course::Points => frame.runs(points.into_iter()),
        }
    };
    for (low, high) in edge(1).into_iter().zip(edge(2)) {
        let (low, high) = (thinned(&low), thinned(&high));
        let area: Vec<Point> = low.iter().copied().chain(high.iter().rev().copied()).collect();
        let paint = Paint { colour: band.colour, opacity: 0.2 };
        drawing.polygon(area, Some(paint), None, clip);
        let edge = Stroke { paint: Paint { colour: band.colour, opacity: 0.6 }, width: 0.9, dashes: &[] };
        drawing.items.push(Item::Path {
            pieces: vec![low, high],
            closed: false,
            fill: None,
            stroke: Some(edge),
            clip,
        });
    }
}

fn region(drawing: &mut Drawing, frame: &Frame, region: &Region) {
    let vertices: Vec<Point> = region.vertices.iter().filter_map(|&point| frame.place(point)).collect();
    // Regions often lie in each other: their colours must not mix.
    let under = Some(Paint { colour: Colour::Paper, opacity: 0.7 });
    drawing.polygon(vertices.clone(), under, None, Some(frame.rect));
    let fill = Some(Paint { colour: region.colour, opacity: 0.25 });
    let stroke = Some(Stroke { paint: solid(region.colour), width: 1.6, dashes: region.dash.lengths() });
    drawing.polygon(vertices, fill, stroke, Some(frame.rect));
}

fn histogram(drawing: &mut Drawing, frame: &Frame, histogram: &Histogram) {
    for (edges, &height) in histogram.edges.windows(2).zip(&histogram.heights) {
        let rect = Rect {
            left: frame.x(edges[0]),
            right: frame.x(edges[1]),
            top: frame.y(height),
            bottom: frame.rect.bottom,
        };
        if height > 0.0 && rect.corners().iter().flatten().all(|c| c.is_finite()) {
            let fill = Some(Paint { colour: histogram.colour, opacity: 0.45 });
            let stroke = Some(Stroke::solid(histogram.colour, 0.8));
            drawing.polygon(rect.corners(), fill, stroke, Some(frame.rect));
        }
    }
}

fn boxes(drawing: &mut Drawing, frame: &Frame, boxes: &Boxes) {
    let clip = Some(frame.rect);
    for (index, found) in boxes.distributions.iter().enumerate() {
        let Some(found) = found else { continue };
        let at = index as f64 + boxes.offset;
        let half = boxes.thickness / 2.0;
        let (middle, top, bottom) = (frame.y(at), frame.y(at + half), frame.y(at - half));
        let [min, lower, median, upper, max] =
            [found.min, found.lower, found.median, found.upper, found.max].map(|value| frame.x(value));
        let stroke = Stroke::solid(boxes.colour, 1.3);
        let (cap_top, cap_bottom) = (middle + 0.5 * (top - middle), middle + 0.5 * (bottom - middle));
        let pieces = vec![
            vec![[min, middle], [lower, middle]],
            vec![[upper, middle], [max, middle]],
            vec![[min, cap_top], [min, cap_bottom]],
            vec![[max, cap_top], [max, cap_bottom]],
        ];
        drawing.items.push(Item::Path { pieces, closed: false, fill: None, stroke: Some(stroke), clip });
        let body = Rect { left: lower, right: upper, top, bottom };
        let fill = Some(Paint { colour: boxes.colour, opacity: 0.3 });
        drawing.polygon(body.corners(), fill, Some(stroke), clip);
        drawing.line(vec![[median, top], [median, bottom]], Stroke::solid(Colour::Ink, 2.0), clip);
    }
}

fn heat(drawing: &mut Drawing, frame: &Frame, heat: &Heat) {
    let Ok(span) = heat.quantity.resolve("", heat.values.iter().copied(), 0.0) else { return };
    let columns = heat.x_edges.len().saturating_sub(1);
    let mut cells: Vec<Vec<Vec<Point>>> = vec![Vec::new(); SHADES as usize + 1];
    for (row, edges) in heat.y_edges.windows(2).enumerate() {
        let (top, bottom) = (frame.y(edges[1]), frame.y(edges[0]));
        let shade = |column: usize| shade(span.share(heat.values[row * columns + column]));
        let mut column = 0;
        while column < columns {
            let start = column;
            let here = shade(start);
            // Neighbours of one shade are one rectangle.
            while column < columns && shade(column) == here {
                column += 1;
            }
            if let Some(here) = here {
                let (left, right) = (frame.x(heat.x_edges[start]), frame.x(heat.x_edges[column]));
                cells[here].push(Rect { left, top, right, bottom }.corners());
            }
        }
    }
    for (shade, pieces) in cells.into_iter().enumerate().filter(|(_, pieces)| !pieces.is_empty()) {
        let fill = Some(solid(Colour::Scale((shade as f64 / SHADES * 255.0).round() as u8)));
        drawing.items.push(Item::Path { pieces, closed: true, fill, stroke: None, clip: Some(frame.rect) });
    }
}

/// Index of a shade for a share of the scale; none for a value without a place.
fn shade(share: f64) -> Option<usize> {
    share.is_finite().then(|| (share.clamp(0.0, 1.0) * SHADES).round() as usize)
}

fn outline(drawing: &mut Drawing, frame: &Frame, outline: &Outline) {
    let clip = Some(frame.rect);
    for part in &outline.parts {
        let vertices: Vec<Point> = part.vertices.iter().filter_map(|&point| frame.place(point)).collect();
        // Parts lie in front of each other, and show where they do.
        drawing.polygon(vertices.clone(), Some(Paint { colour: Colour::Paper, opacity: 0.6 }), None, clip);
        let stroke = Some(Stroke::solid(part.colour, 1.1));
        drawing.polygon(vertices, Some(Paint { colour: part.colour, opacity: 0.45 }), stroke, clip);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_every_peak() {
        let run: Vec<Point> = (0..100_000)
            .map(|k| [f64::from(k) * 1e-3, if k == 51_234 { 900.0 } else { f64::from(k % 7) }])
            .collect();
        let thin = thinned(&run);
        assert!(thin.len() <= 4 * 201, "{} points remain", thin.len());
        let highest = |points: &[Point]| points.iter().map(|p| p[1]).fold(f64::MIN, f64::max);
        assert_eq!(highest(&thin), 900.0);
        assert_eq!((thin[0], thin[thin.len() - 1]), (run[0], run[run.len() - 1]));
    }

    #[test]
    fn stairs_hold_each_value_until_the_next_point() {
        let corners: Vec<_> = stairs(&[[0.0, 1.0], [1.0, 3.0]], 2.0).collect();
        assert_eq!(corners, [[0.0, 1.0], [1.0, 1.0], [1.0, 3.0], [2.0, 3.0]]);
    }
}
