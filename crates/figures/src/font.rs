//! Widths and outlines of text, from a table of glyphs within the crate.
//!
//! DejaVu Sans, without kerning. Layout measures with it, and PNG draws with it; an SVG names it first and falls back to
//! fonts that are no wider.

use std::collections::BTreeMap;
use std::sync::OnceLock;

/// Written by `assets/glyphs.py`, which describes the format.
const TABLE: &str = include_str!("../assets/glyphs.txt");

/// Shown in place of a character that the table lacks.
const UNKNOWN: char = '□';

/// A step of an outline, in units of the text's size, y upwards, from the glyph's origin on the base line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Command {
    Move([f32; 2]),
    Line([f32; 2]),
    Quad([f32; 2], [f32; 2]),
    Close,
}

#[derive(Debug)]
struct Glyph {
    advance: f32,
    outline: Vec<Command>,
}

/// Width of a line of text at size 1.
pub(crate) fn width(text: &str) -> f64 {
    text.chars().map(|c| f64::from(glyph(c).advance)).sum()
}

/// Outlines of a line of text at size 1: for each glyph where it begins, and its commands.
pub(crate) fn outlines(text: &str) -> impl Iterator<Item = (f32, &'static [Command])> {
    text.chars().scan(0.0, |pen, c| {
        let glyph = glyph(c);
        let start = *pen;
        *pen += glyph.advance;
        Some((start, glyph.outline.as_slice()))
    })
}

fn glyph(c: char) -> &'static Glyph {
    static GLYPHS: OnceLock<BTreeMap<char, Glyph>> = OnceLock::new();
    let glyphs = GLYPHS.get_or_init(|| parse(TABLE).expect("a test reads the table"));
    glyphs.get(&c).unwrap_or_else(|| &glyphs[&UNKNOWN])
}

/// `None` if the table is not of the generator's form.
fn parse(table: &str) -> Option<BTreeMap<char, Glyph>> {
    let mut lines = table.lines();
    let em: f32 = lines.next()?.parse().ok()?;
    lines
        .map(|line| {
            let mut words = line.splitn(3, ' ');
            let c = char::from_u32(u32::from_str_radix(words.next()?, 16).ok()?)?;
            let advance = words.next()?.parse::<f32>().ok()? / em;
            let outline = words.next().map_or(Some(Vec::new()), |path| commands(path, em))?;
            Some((c, Glyph { advance, outline }))
        })
        .collect()
}

fn commands(path: &str, em: f32) -> Option<Vec<Command>> {
    let starts = path.char_indices().filter(|(_, c)| c.is_ascii_uppercase()).map(|(at, _)| at);
    let ends = starts.clone().skip(1).chain([path.len()]);
    starts
        .zip(ends)
        .map(|(start, end)| {
            let mut numbers = path[start + 1..end].split_whitespace().map(|word| word.parse::<f32>().ok());
            let mut point = || Some([numbers.next()?? / em, numbers.next()?? / em]);
            match path.as_bytes()[start] {
                b'M' => point().map(Command::Move),
                b'L' => point().map(Command::Line),
                b'Q' => Some(Command::Quad(point()?, point()?)),
                b'Z' => Some(Command::Close),
                _ => None,
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_holds_what_figures_of_a_crane_are_labelled_with() {
        let glyphs = parse(TABLE).unwrap();
        for c in "Jerk [m/s³] ẋ₂ −0.15 ×10⁻³ Δv ≤ ∞ π θ° – µ ‖e‖ →".chars() {
            let glyph = &glyphs.get(&c).unwrap_or_else(|| panic!("'{c}' is missing"));
            assert!(glyph.advance > 0.0 && (c == ' ' || glyph.outline.len() > 3), "{c}");
        }
    }

    #[test]
    fn an_unknown_character_is_a_box() {
        assert_eq!(width("\u{1F600}"), width("□"));
    }

    #[test]
    fn digits_are_equally_wide_so_that_ticks_line_up() {
        assert_eq!(width("0000"), width("1487"));
        assert!((width("0") - 0.636).abs() < 1e-3);
    }

    #[test]
    fn glyphs_follow_each_other_by_their_advances() {
        let starts: Vec<f32> = outlines("ab c").map(|(start, _)| start).collect();
        assert_eq!(starts[0], 0.0);
        assert_eq!(starts[3], width("ab ") as f32);
    }
}
