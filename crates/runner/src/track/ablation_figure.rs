//! The picture of the ablation.

use std::path::Path;

use anyhow::Result;
use figures::{Axis, Chart, Course, Layer, Panel, Series, Style, SvgTheme, Theme};

use super::ablation::Run;
use crate::store;

/// Part of the run that is shown \[s\].
const SHOWN: [f64; 2] = [0.3, 0.9];

/// Draws lift's motion of every way into `folder`, as SVG and PNG.
///
/// # Errors
/// A file cannot be written.
pub fn draw(runs: &[Run], folder: &Path) -> Result<String> {
    let quantities = [
        ("Lift velocity", "m/s", 1),
        ("Lift acceleration", "m/s²", 2),
        ("Lift effort", "N", 3),
        ("Boom above 5 Hz", "rad/s²", 4),
    ];
    let panel = |(label, unit, column): (&str, &str, usize)| {
        let series = |(number, run): (usize, &Run)| {
            let shown = run.samples.iter().filter(|sample| (SHOWN[0]..=SHOWN[1]).contains(&sample[0]));
            Layer::Series(Series {
                name: run.result.profile.clone(),
                points: shown.map(|sample| [sample[0], sample[column]]).collect(),
                course: Course::Straight,
                style: Style::nth(number).unmarked(),
            })
        };
        Panel {
            height: 150.0,
            ..Panel::new(Axis::new(label, unit), runs.iter().enumerate().map(series).collect())
        }
    };
    let chart = Chart {
        panels: quantities.into_iter().map(panel).collect(),
        ..Chart::new("The same actions in four ways", Axis::new("Time", "s"))
    };
    let figure = chart.draw()?;
    let (svg, png) = (folder.join("ablation.svg"), folder.join("ablation.png"));
    store::write_whole(&svg, figure.svg(SvgTheme::Reader).as_bytes())?;
    store::write_whole(&png, &figure.png(Theme::Light, 2.0)?)?;
    Ok(format!("drawn {} and {}\n", svg.display(), png.display()))
}
