//! A drawing as PNG bytes.

use tiny_skia::{Color, FillRule, LineCap, LineJoin, Mask, Path, PathBuilder, Pixmap, StrokeDash, Transform};

use crate::colour::Theme;
use crate::drawing::{Anchor, Direction, Drawing, Item, Paint, Point, Rect, Stroke, Text, text_width};
use crate::error::FigureError;
use crate::font::{self, Command};

/// Longest side of a picture \[px\].
const MOST_PIXELS: f64 = 16384.0;

pub(crate) fn encode(drawing: &Drawing, theme: Theme, scale: f64) -> Result<Vec<u8>, FigureError> {
    let (width, height) = ((drawing.width * scale).ceil(), (drawing.height * scale).ceil());
    let refused = || FigureError::Pixels { width: width.to_string(), height: height.to_string() };
    if !(width >= 1.0 && height >= 1.0 && width <= MOST_PIXELS && height <= MOST_PIXELS) {
        return Err(refused());
    }
    let pixmap = Pixmap::new(width as u32, height as u32).ok_or_else(refused)?;
    let mut canvas = Canvas { pixmap, theme, transform: Transform::from_scale(scale as f32, scale as f32) };
    canvas.pixmap.fill(canvas.color(Paint { colour: crate::Colour::Paper, opacity: 1.0 }));
    let mut mask: Option<(Rect, Mask)> = None;
    for item in &drawing.items {
        if let Item::Path { clip: Some(clip), .. } | Item::Disc { clip: Some(clip), .. } = item
            && mask.as_ref().is_none_or(|(known, _)| known != clip)
        {
            mask = canvas.mask(*clip).map(|made| (*clip, made));
        }
        canvas.item(item, mask.as_ref().map(|(_, mask)| mask));
    }
    canvas.pixmap.encode_png().map_err(|error| FigureError::Png(error.to_string()))
}

struct Canvas {
    pixmap: Pixmap,
    theme: Theme,
    transform: Transform,
}

impl Canvas {
    fn color(&self, paint: Paint) -> Color {
        let [red, green, blue] = paint.colour.rgb(self.theme);
        Color::from_rgba8(red, green, blue, (paint.opacity.clamp(0.0, 1.0) * 255.0).round() as u8)
    }

    fn paint(&self, paint: Paint, anti_alias: bool) -> tiny_skia::Paint<'static> {
        let mut made = tiny_skia::Paint { anti_alias, ..tiny_skia::Paint::default() };
        made.set_color(self.color(paint));
        made
    }

    fn mask(&self, clip: Rect) -> Option<Mask> {
        let mut mask = Mask::new(self.pixmap.width(), self.pixmap.height())?;
        let path = path(&[clip.corners()], true)?;
        mask.fill_path(&path, FillRule::Winding, true, self.transform);
        Some(mask)
    }

    fn item(&mut self, item: &Item, mask: Option<&Mask>) {
        match item {
            Item::Path { pieces, closed, fill, stroke, clip } => {
                if let Some(path) = path(pieces, *closed) {
                    self.path(&path, *fill, *stroke, mask.filter(|_| clip.is_some()));
                }
            }
            Item::Disc { centre: [x, y], radius, fill, stroke, clip } => {
                if let Some(path) = PathBuilder::from_circle(*x as f32, *y as f32, *radius as f32) {
                    self.path(&path, *fill, *stroke, mask.filter(|_| clip.is_some()));
                }
            }
            Item::Text(text) => self.text(text),
        }
    }

    fn path(&mut self, path: &Path, fill: Option<Paint>, stroke: Option<Stroke>, mask: Option<&Mask>) {
        if let Some(paint) = fill {
            // Cells of a heat map touch: smoothed edges would leave seams between them.
            let smooth = !matches!(paint.colour, crate::Colour::Scale(_));
            let paint = self.paint(paint, smooth);
            self.pixmap.fill_path(path, &paint, FillRule::EvenOdd, self.transform, mask);
        }
        if let Some(stroke) = stroke {
            let paint = self.paint(stroke.paint, true);
            let dashes = stroke.dashes.iter().map(|&length| length as f32).collect();
            let line = tiny_skia::Stroke {
                width: stroke.width as f32,
                line_cap: LineCap::Butt,
                line_join: LineJoin::Round,
                dash: StrokeDash::new(dashes, 0.0),
                ..tiny_skia::Stroke::default()
            };
            self.pixmap.stroke_path(path, &paint, &line, self.transform, mask);
        }
    }

    fn text(&mut self, text: &Text) {
        let width = text_width(&text.text, text.size);
        let back = match text.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => width / 2.0,
            Anchor::End => width,
        };
        let size = text.size as f32;
        let back = back as f32;
        let [x, y] = text.at.map(|coordinate| coordinate as f32);
        // Of the text: its direction, and up from its base line.
        let place = |along: f32, up: f32| match text.direction {
            Direction::Right => (x + along, y - up),
            Direction::Up => (x - up, y - along),
        };
        let mut builder = PathBuilder::new();
        for (start, outline) in font::outlines(&text.text) {
            let at = |[u, v]: [f32; 2]| place((start + u) * size - back, v * size);
            for command in outline {
                match *command {
                    Command::Move(point) => {
                        let (x, y) = at(point);
                        builder.move_to(x, y);
                    }
                    Command::Line(point) => {
                        let (x, y) = at(point);
                        builder.line_to(x, y);
                    }
                    Command::Quad(control, point) => {
                        let ((x1, y1), (x2, y2)) = (at(control), at(point));
                        builder.quad_to(x1, y1, x2, y2);
                    }
                    Command::Close => builder.close(),
                }
            }
        }
        if let Some(path) = builder.finish() {
            let paint = self.paint(Paint { colour: text.colour, opacity: 1.0 }, true);
            self.pixmap.fill_path(&path, &paint, FillRule::Winding, self.transform, None);
        }
    }
}

fn path(pieces: &[Vec<Point>], closed: bool) -> Option<Path> {
    let mut builder = PathBuilder::new();
    for piece in pieces {
        for (index, &[x, y]) in piece.iter().enumerate() {
            if index == 0 {
                builder.move_to(x as f32, y as f32);
            } else {
                builder.line_to(x as f32, y as f32);
            }
        }
        if closed {
            builder.close();
        }
    }
    builder.finish()
}
