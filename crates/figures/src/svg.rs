//! A drawing as SVG text: the same drawing gives the same text.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use crate::colour::{Colour, NAMED, SvgTheme, Theme};
use crate::drawing::{Anchor, Direction, Drawing, Item, Paint, Point, Rect, Stroke};

/// Fonts that a reader may have, the one that was measured with first; the others are narrower.
const FONTS: &str = "DejaVu Sans,Verdana,Helvetica,Arial,sans-serif";

pub(crate) fn write(drawing: &Drawing, theme: SvgTheme) -> String {
    let mut writer = Writer { text: String::new(), clips: Vec::new(), name: fingerprint(drawing) };
    writer.document(drawing, theme);
    writer.text
}

struct Writer {
    text: String,
    clips: Vec<Rect>,
    /// Begins every id, so that several figures in one page do not share any.
    name: String,
}

/// Appends formatted text; writing to a string cannot fail.
macro_rules! put {
    ($writer:expr, $($part:tt)*) => {
        write!($writer.text, $($part)*).expect("a string takes every text")
    };
}

impl Writer {
    fn document(&mut self, drawing: &Drawing, theme: SvgTheme) {
        let (width, height) = (number(drawing.width), number(drawing.height));
        let title = escape(&drawing.title);
        put!(
            self,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{title}\" font-family=\"{FONTS}\">\n\
             <title>{title}</title>\n"
        );
        self.style(drawing, theme);
        self.clip_paths(drawing);
        put!(self, "<rect width=\"{width}\" height=\"{height}\" class=\"f-paper\"/>\n");
        for item in &drawing.items {
            self.item(item);
        }
        self.text.push_str("</svg>\n");
    }

    /// One rule for each colour that occurs. Class names and rules are the same in every figure of one theme, so
    /// figures in one page do not disturb each other.
    fn style(&mut self, drawing: &Drawing, theme: SvgTheme) {
        let mut used = BTreeSet::from([Colour::Paper]);
        for item in &drawing.items {
            match item {
                Item::Path { fill, stroke, .. } | Item::Disc { fill, stroke, .. } => {
                    used.extend(fill.map(|paint| paint.colour));
                    used.extend(stroke.map(|stroke| stroke.paint.colour));
                }
                Item::Text(text) => {
                    used.insert(text.colour);
                }
            }
        }
        let rules = |theme: Theme| {
            let mut rules = String::new();
            for (colour, class) in NAMED.iter().filter(|(colour, _)| used.contains(colour)) {
                let [red, green, blue] = colour.rgb(theme);
                let value = format!("#{red:02x}{green:02x}{blue:02x}");
                rules += &format!(".f-{class}{{fill:{value}}}.s-{class}{{stroke:{value}}}");
            }
            rules
        };
        match theme {
            SvgTheme::Fixed(theme) => put!(self, "<style>{}</style>\n", rules(theme)),
            SvgTheme::Reader => {
                let (light, dark) = (rules(Theme::Light), rules(Theme::Dark));
                put!(self, "<style>{light}@media screen and (prefers-color-scheme:dark){{{dark}}}</style>\n");
            }
        }
    }

    fn clip_paths(&mut self, drawing: &Drawing) {
        for item in &drawing.items {
            if let Item::Path { clip: Some(clip), .. } | Item::Disc { clip: Some(clip), .. } = item
                && !self.clips.contains(clip)
            {
                let (index, name) = (self.clips.len(), &self.name);
                let (x, y) = (number(clip.left), number(clip.top));
                let (width, height) = (number(clip.width()), number(clip.height()));
                put!(
                    self,
                    "<clipPath id=\"{name}-{index}\"><rect x=\"{x}\" y=\"{y}\" width=\"{width}\" \
                     height=\"{height}\"/></clipPath>\n"
                );
                self.clips.push(*clip);
            }
        }
    }

    fn item(&mut self, item: &Item) {
        match item {
            Item::Path { pieces, closed, fill, stroke, clip } => {
                self.text.push_str("<path d=\"");
                for piece in pieces {
                    self.piece(piece, *closed);
                }
                self.text.push('"');
                self.look(*fill, *stroke, *clip);
                self.text.push_str("/>\n");
            }
            Item::Disc { centre: [x, y], radius, fill, stroke, clip } => {
                let (x, y, radius) = (number(*x), number(*y), number(*radius));
                put!(self, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"");
                self.look(*fill, *stroke, *clip);
                self.text.push_str("/>\n");
            }
            Item::Text(text) => {
                let (x, y, size) = (number(text.at[0]), number(text.at[1]), number(text.size));
                put!(
                    self,
                    "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" class=\"f-{}\"",
                    class(text.colour)
                );
                match text.anchor {
                    Anchor::Start => {}
                    Anchor::Middle => self.text.push_str(" text-anchor=\"middle\""),
                    Anchor::End => self.text.push_str(" text-anchor=\"end\""),
                }
                if text.direction == Direction::Up {
                    put!(self, " transform=\"rotate(-90 {x} {y})\"");
                }
                put!(self, ">{}</text>\n", escape(&text.text));
            }
        }
    }

    /// Absolute for the first point, relative for the rest, which is shorter; rounding does not add up.
    fn piece(&mut self, points: &[Point], closed: bool) {
        let Some(first) = points.first() else { return };
        let rounded = |[x, y]: Point| [(x * 100.0).round(), (y * 100.0).round()];
        let mut last = rounded(*first);
        put!(self, "M{} {}", number(last[0] / 100.0), number(last[1] / 100.0));
        for (index, point) in points[1..].iter().enumerate() {
            let next = rounded(*point);
            let step = [(next[0] - last[0]) / 100.0, (next[1] - last[1]) / 100.0];
            put!(self, "{}{} {}", if index == 0 { "l" } else { " " }, number(step[0]), number(step[1]));
            last = next;
        }
        if closed {
            self.text.push('z');
        }
    }

    fn look(&mut self, fill: Option<Paint>, stroke: Option<Stroke>, clip: Option<Rect>) {
        let mut classes = Vec::new();
        match fill {
            None => self.text.push_str(" fill=\"none\""),
            Some(Paint { colour: Colour::Scale(share), .. }) => {
                let [red, green, blue] = Colour::Scale(share).rgb(Theme::Light);
                put!(self, " fill=\"#{red:02x}{green:02x}{blue:02x}\" shape-rendering=\"crispEdges\"");
            }
            Some(paint) => {
                classes.push(format!("f-{}", class(paint.colour)));
                if paint.opacity < 1.0 {
                    put!(self, " fill-opacity=\"{}\"", number(paint.opacity));
                }
            }
        }
        if let Some(stroke) = stroke {
            classes.push(format!("s-{}", class(stroke.paint.colour)));
            put!(self, " stroke-width=\"{}\" stroke-linejoin=\"round\"", number(stroke.width));
            if stroke.paint.opacity < 1.0 {
                put!(self, " stroke-opacity=\"{}\"", number(stroke.paint.opacity));
            }
            if !stroke.dashes.is_empty() {
                let dashes: Vec<String> = stroke.dashes.iter().map(|&length| number(length)).collect();
                put!(self, " stroke-dasharray=\"{}\"", dashes.join(" "));
            }
        }
        if !classes.is_empty() {
            put!(self, " class=\"{}\"", classes.join(" "));
        }
        if let Some(index) = clip.and_then(|clip| self.clips.iter().position(|known| *known == clip)) {
            put!(self, " clip-path=\"url(#{}-{index})\"", self.name);
        }
    }
}

fn class(colour: Colour) -> &'static str {
    NAMED.iter().find(|(named, _)| *named == colour).map_or("ink", |(_, class)| class)
}

/// Two decimals at most: a hundredth of a pixel.
fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            // XML has no other control characters.
            c if c.is_control() && !"\t\n\r".contains(c) => escaped.push('\u{FFFD}'),
            c => escaped.push(c),
        }
    }
    escaped
}

/// A name that differs for drawings that differ: FNV-1a over the title and the items.
fn fingerprint(drawing: &Drawing) -> String {
    let mut hash: u64 = 0xcbf2_9ce4_8422_2325;
    for byte in format!("{drawing:?}").bytes() {
        hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    }
    format!("c{hash:016x}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (value, text) in [(0.0, "0"), (-0.001, "0"), (12.5, "12.5"), (100.0, "100"), (-3.456, "-3.46")] {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn text_cannot_break_out_of_the_document() {
        assert_eq!(escape("a<b & \"c\"\u{1}"), "a&lt;b &amp; &quot;c&quot;\u{FFFD}");
    }
}
