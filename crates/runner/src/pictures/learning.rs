//! Learning curves: one run as a line, several as a band around their median.

use figures::{Axis, Band, Chart, Colour, Course, Figure, FigureError, Layer, Panel, Style};
use serde::Deserialize;

use super::line;
use crate::statistics;

/// Points along the axis of environment steps.
const POINTS: u64 = 300;

/// The part of a line of `metrics.jsonl` that is drawn.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct CurvePoint {
    /// Environment steps at the episode's end.
    pub step: u64,
    /// Share of successes over the rolling window.
    pub success_rate: f64,
    /// Mean return over the rolling window.
    pub mean_return: f64,
    /// Means over the episode's updates, if there were any.
    pub losses: Option<CurveLosses>,
}

/// Means over the updates of an episode.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct CurveLosses {
    /// Weight of the entropy.
    pub entropy_temperature: f64,
}

/// Takes a number out of a line, if it has it.
type Recorded = fn(&CurvePoint) -> Option<f64>;

/// One run's learning of one stage.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Name of the run.
    pub run: String,
    /// Episode by episode.
    pub points: Vec<CurvePoint>,
}

/// Success, return and entropy temperature against environment steps.
///
/// Of several runs the band reaches from the lowest to the highest at each step, and the line is their median; a run
/// that has ended, having mastered its stage, counts with its last value.
///
/// # Errors
/// No run has an episode.
pub fn learning(stage: &str, curves: &[Curve]) -> Result<Figure, FigureError> {
    let quantities: [(&str, Recorded); 3] = [
        ("Success rate", |point| Some(point.success_rate)),
        ("Mean return", |point| Some(point.mean_return)),
        ("Entropy temperature", |point| point.losses.as_ref().map(|losses| losses.entropy_temperature)),
    ];
    let end =
        curves.iter().filter_map(|curve| curve.points.last()).map(|point| point.step).max().unwrap_or(0);
    let panel = |(label, of): &(&str, Recorded)| {
        let style = Style { width: 2.0, ..Style::nth(0).unmarked() };
        let layers = match curves {
            [only] => {
                let points = only.points.iter().filter_map(|point| Some([thousands(point.step), of(point)?]));
                vec![line(&format!("run {}", only.run), style, points)]
            }
            several => {
                let steps = (0..=POINTS).map(|k| k * end / POINTS);
                let spread: Vec<[f64; 4]> = steps.filter_map(|step| spread_at(several, step, *of)).collect();
                vec![
                    Layer::Band(Band {
                        name: format!("lowest to highest of {} runs", several.len()),
                        points: spread.iter().map(|&[x, low, _, high]| [x, low, high]).collect(),
                        course: Course::Straight,
                        colour: Colour::Blue,
                    }),
                    line("median", style, spread.iter().map(|&[x, _, median, _]| [x, median])),
                ]
            }
        };
        let axis = Axis::new(label, "–");
        let axis = if *label == "Success rate" { axis.from_to(-0.03, 1.03) } else { axis };
        Panel { height: 150.0, ..Panel::new(axis, layers) }
    };
    let x = Axis::new("Environment steps", "10³");
    let x = if end > 0 { x.from_to(0.0, thousands(end)) } else { x };
    Chart {
        panels: quantities.iter().map(panel).collect(),
        ..Chart::new(&format!("Learning of stage {stage}"), x)
    }
    .draw()
}

fn thousands(step: u64) -> f64 {
    step as f64 / 1000.0
}

/// Step in thousands, lowest, median and highest value over the runs that have one by then.
fn spread_at(curves: &[Curve], step: u64, of: Recorded) -> Option<[f64; 4]> {
    let value = |curve: &Curve| {
        let until = curve.points.partition_point(|point| point.step <= step);
        curve.points[..until].iter().rev().find_map(of)
    };
    let values: Vec<f64> = curves.iter().filter_map(value).collect();
    let [low, median, high] = [0.0, 0.5, 1.0].map(|share| statistics::quantile(&values, share));
    Some([thousands(step), low?, median?, high?])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(points: &[(u64, f64)]) -> Curve {
        let point = |&(step, success_rate): &(u64, f64)| CurvePoint {
            step,
            success_rate,
            mean_return: 0.0,
            losses: None,
        };
        Curve { run: "a".to_owned(), points: points.iter().map(point).collect() }
    }

    #[test]
    fn a_run_counts_from_its_first_episode_and_with_its_last_value_after_its_end() {
        let curves = [curve(&[(10, 0.0), (20, 0.5), (30, 1.0)]), curve(&[(15, 0.2), (60, 0.8)])];
        let at = |step| spread_at(&curves, step, |point| Some(point.success_rate));
        assert_eq!(at(5), None);
        assert_eq!(at(12), Some([0.012, 0.0, 0.0, 0.0]));
        assert_eq!(at(20), Some([0.02, 0.2, 0.35, 0.5]));
        assert_eq!(at(60), Some([0.06, 0.8, 0.9, 1.0]));
    }

    #[test]
    fn without_an_episode_there_is_no_picture() {
        assert!(matches!(learning("purple", &[curve(&[])]), Err(FigureError::NoData { .. })));
    }
}
