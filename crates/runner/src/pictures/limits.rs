//! How far every joint stayed from every limit.

use figures::{Axis, Boxes, Chart, Colour, Distribution, Figure, FigureError, Layer, Panel, Spacing};

use super::Quantity;
use crate::evidence::PerQuantity;
use crate::machine::{Machine, short};
use crate::recording::Recording;

/// For each quantity and joint the distribution, over episodes, of the smallest margin to the actuator's limit.
///
/// A margin of 1 is rest at the middle, 0 is the limit. The axis is logarithmic as long as every margin is positive.
///
/// # Errors
/// There is no recording.
pub fn margins(machine: &Machine, recordings: &[Recording]) -> Result<Figure, FigureError> {
    let quantities: [(&str, Quantity<PerQuantity>); 4] = [
        ("Position", |margins| margins.position),
        ("Velocity", |margins| margins.velocity),
        ("Acceleration", |margins| margins.acceleration),
        ("Jerk", |margins| margins.jerk),
    ];
    // From bottom to top, so the first joint comes first for a reader.
    let joints: Vec<usize> = (0..machine.joints().len()).rev().collect();
    let names =
        || joints.iter().map(|&joint| short(&machine.joints()[joint].name).replace('_', " ")).collect();
    let smallest = |joint: usize, of: Quantity<PerQuantity>, actual: bool| -> Vec<f64> {
        let seen = recordings.iter().map(|recording| &recording.evidence.joints[joint]);
        seen.map(|joint| of(if actual { &joint.actual } else { &joint.reference })).collect()
    };
    let boxes = |name: &str, of: Quantity<PerQuantity>, actual: bool, colour, offset| {
        let distributions =
            joints.iter().map(|&joint| Distribution::of(&smallest(joint, of, actual))).collect();
        Layer::Boxes(Boxes { name: name.to_owned(), distributions, colour, offset, thickness: 0.32 })
    };
    let panels = quantities.map(|(label, of)| Panel {
        height: 26.0 * joints.len() as f64,
        ..Panel::new(
            Axis { categories: names(), ..Axis::new(label, "–") },
            vec![
                boxes("reference, exact", of, false, Colour::Blue, 0.19),
                boxes("actual motion, every tick", of, true, Colour::Vermillion, -0.19),
            ],
        )
    });
    let all = quantities.iter().flat_map(|(_, of)| {
        joints.iter().flat_map(|&joint| [smallest(joint, *of, false), smallest(joint, *of, true)].concat())
    });
    let least = all.fold(1.0, f64::min);
    let axis = Axis::new("Smallest margin of an episode, as a share of the limit", "–");
    let x = if least > 0.0 {
        Axis { spacing: Spacing::Logarithmic, ..axis.from_to(least.min(1e-3) * 0.8, 1.1) }
    } else {
        axis
    };
    Chart {
        panels: panels.into(),
        ..Chart::new(&format!("Margins to every limit in {} episodes", recordings.len()), x)
    }
    .draw()
}
