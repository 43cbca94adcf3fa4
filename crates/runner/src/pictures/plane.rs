//! The crane's plane: regions of the curriculum and an episode in them [P, Fig. workspace].

use figures::{
    Axis, Chart, Colour, Dash, Figure, FigureError, Layer, Marker, Panel, Proportion, Region, Style,
};

use super::{line, points};
use crate::machine::Machine;
use crate::recording::Recording;
use crate::stage::Stage;

/// The regions, other episodes faintly, and one episode from start to target.
///
/// # Errors
/// Never for a loaded machine.
pub fn workspace(machine: &Machine, shown: &Recording, others: &[Recording]) -> Result<Figure, FigureError> {
    let regions = machine.regions();
    let region = |name: &str, polygon: &crate::region::Polygon, colour, dash| {
        let vertices = polygon.vertices().iter().map(|&(x, z)| [x, z]).collect();
        Layer::Region(Region { name: name.to_owned(), vertices, colour, dash })
    };
    let mut layers = vec![
        region("workspace", regions.workspace(), Colour::Blue, Dash::Solid),
        region("orange", regions.of(Stage::Orange), Colour::Orange, Dash::LongDash),
        region("yellow", regions.of(Stage::Yellow), Colour::Yellow, Dash::DashDot),
        region("purple", regions.of(Stage::Purple), Colour::Purple, Dash::Dashed),
    ];
    let faint = Style { colour: Colour::Muted, dash: Dash::Solid, marker: None, width: 0.7 };
    for (index, other) in others.iter().enumerate() {
        layers.push(line(
            if index == 0 { "other episodes" } else { "" },
            faint,
            other.tips.iter().map(in_plane),
        ));
    }
    let bold = Style { colour: Colour::Ink, dash: Dash::Solid, marker: None, width: 2.2 };
    let marked = |marker, colour| Style { colour, marker: Some(marker), ..bold };
    layers.extend([
        line("tip of this one", bold, shown.tips.iter().map(in_plane)),
        points("start", marked(Marker::Square, Colour::Ink), shown.tips.first().map(in_plane)),
        points("target", marked(Marker::Cross, Colour::Vermillion), [in_plane(&shown.episode.target)]),
    ]);
    Chart {
        panels: vec![Panel::new(Axis::new("Height z", "m"), layers)],
        width: 440.0,
        proportion: Proportion::Equal,
        ..Chart::new("Workspace, regions of the curriculum, and an episode", Axis::new("Reach x", "m"))
    }
    .draw()
}

fn in_plane([x, _, z]: &[f64; 3]) -> [f64; 2] {
    [*x, *z]
}
