//! Pictures of plain data: line charts with bands, steps and limits, heat maps, regions, distributions, postures and
//! block diagrams, as SVG text and PNG bytes.
//!
//! ```text
//! Chart { title, x: Axis, panels: [Panel { y: Axis, layers: [Layer], limits: [Limit] }] }
//!    │ draw(): ranges, round ticks, legends above the data
//!    ▼
//! Figure ── svg(theme) ──▶ text      light, dark, or what the reader's screen prefers
//!        └─ png(theme, scale) ──▶ bytes
//! ```
//!
//! The crate knows no robots and no files: numbers go in, text or bytes come out, and the same numbers always give the
//! same text. Every axis has a label and a unit, or the figure is refused. Series differ in colour (Okabe and Ito), in
//! dash and in marker, so a figure can be read in grey print and with any colour blindness. Lengths are pixels at scale
//! 1; data is in whatever unit its axis names.
//!
//! Text is measured and, in a PNG, drawn with outlines of DejaVu Sans that the crate holds; no font need be installed.
//!
//! # Example
//!
//! ```
//! use figures::{Axis, Chart, Course, Layer, Limit, Panel, Series, Style, SvgTheme};
//!
//! let points = (0..=50).map(|k| [f64::from(k) * 0.01, (f64::from(k) * 0.1).sin() * 0.1]).collect();
//! let style = Style::nth(0).unmarked();
//! let line = Series { name: "lift".to_owned(), points, course: Course::Straight, style };
//! let panel = Panel::new(Axis::new("Velocity", "m/s"), vec![Layer::Series(line)]);
//! let panels = vec![Panel { limits: Limit::both(-0.15, 0.15), ..panel }];
//! let chart = Chart { panels, ..Chart::new("A joint within its limits", Axis::new("Time", "s")) };
//! let svg = chart.draw()?.svg(SvgTheme::Reader);
//! assert!(svg.starts_with("<svg ") && svg.contains("Time [s]"));
//! # Ok::<(), figures::FigureError>(())
//! ```
#![forbid(unsafe_code)]

mod axis;
mod chart;
mod colour;
mod diagram;
mod distribution;
mod drawing;
mod error;
mod figure;
mod font;
mod layer;
mod legend;
mod plot;
mod png;
mod strip;
mod svg;
mod ticks;

pub use axis::{Axis, Spacing};
pub use chart::{Chart, Panel, Proportion};
pub use colour::{Colour, SvgTheme, Theme};
pub use diagram::{Arrow, Diagram, Node};
pub use distribution::Distribution;
pub use error::FigureError;
pub use figure::Figure;
pub use layer::{
    Band, Boxes, Course, Dash, Forbidden, Heat, Histogram, Layer, Limit, Marker, Outline, Part, Region,
    Series, Style,
};
pub use strip::{Picture, Strip};
