//! The static load chart: the largest payload over the positions that the tip can take in the crane's plane.

use std::collections::BTreeMap;
use std::path::PathBuf;

#[cfg(feature = "figures")]
use anyhow::Context;
use anyhow::{Result, anyhow, bail, ensure};
use hiab_dynamics::{Actuator, Axis, CraneModel, LoadChart, LoadChartSpec, LoadPoint};
use serde::Serialize;

use crate::config::{ConfigSpec, read_ron};
use crate::machine;
use crate::region::Regions;
use crate::store;

/// Distance of neighbouring tip positions \[m\].
const SPACING: f64 = 0.05;

/// Width of the picture \[px\]: a crane reaches twice as far up and down as ahead.
#[cfg(feature = "figures")]
const WIDTH: f64 = 520.0;

/// Values per redundant joint that are tried.
const SAMPLES: usize = 25;

/// Where the chart is written beside its summary.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LoadChartFiles {
    /// All of it, as JSON.
    pub json: Option<PathBuf>,
    /// Its picture.
    pub svg: Option<PathBuf>,
}

/// The chart with names, as the JSON file has it.
#[derive(Serialize)]
struct NamedChart<'a> {
    /// What `limited_by` and `position` count.
    actuators: &'a [&'a str],
    x: Axis,
    z: Axis,
    points: &'a [Option<LoadPoint>],
}

/// Charts the largest payload that the configured crane holds at rest, held joints where the task holds them, over the
/// workspace of its regions. Gives a summary.
///
/// # Errors
/// A file is missing or wrong, the task moves fewer than two joints, or a result cannot be written.
pub fn load_chart(config: &ConfigSpec, files: &LoadChartFiles) -> Result<String> {
    let model = machine::load_model(config)?;
    let regions: Regions = read_ron(&config.crane.regions)?;
    let corners = regions.workspace().vertices();
    let (moving, posture) = joints(&model, config)?;
    let x = axis(corners.iter().map(|corner| corner.0));
    let z = axis(corners.iter().map(|corner| corner.1));
    let chart = model.load_chart(&LoadChartSpec { x, z, moving, posture, samples: SAMPLES })?;
    let actuators: Vec<&str> = model.actuators().iter().map(Actuator::name).collect();
    if let Some(path) = &files.json {
        let LoadChart { x, z, points } = &chart;
        let named = NamedChart { actuators: &actuators, x: *x, z: *z, points };
        store::write_whole(path, (serde_json::to_string(&named)? + "\n").as_bytes())?;
    }
    if let Some(path) = &files.svg {
        store::write_whole(path, picture(&chart)?.as_bytes())?;
    }
    summary(&chart, &actuators)
}

/// Joints that place the tip, and where the others are held.
fn joints(model: &CraneModel, config: &ConfigSpec) -> Result<(Vec<usize>, Vec<f64>)> {
    let index = |joint: &str| {
        let known = || model.actuators().iter().map(Actuator::name).collect::<Vec<_>>().join(", ");
        model
            .actuator_index(joint)
            .ok_or_else(|| anyhow!("task: no actuator is called '{joint}'; there are {}", known()))
    };
    let moving = config.task.moving.iter().map(|joint| index(joint)).collect::<Result<Vec<_>>>()?;
    ensure!(moving.len() >= 2, "task.moving: a load chart needs two joints that move, got {}", moving.len());
    let middle = |actuator: &Actuator| 0.5 * (actuator.lower() + actuator.upper());
    let mut posture: Vec<f64> = model.actuators().iter().map(middle).collect();
    for (joint, position) in &config.task.held {
        posture[index(joint)?] = *position;
    }
    Ok((moving, posture))
}

/// Round positions around all of `values`.
fn axis(values: impl Iterator<Item = f64> + Clone) -> Axis {
    let least = values.clone().fold(f64::INFINITY, f64::min);
    let greatest = values.fold(f64::NEG_INFINITY, f64::max);
    let (first, last) = ((least / SPACING).floor() - 1.0, (greatest / SPACING).ceil() + 1.0);
    Axis { from: first * SPACING, to: last * SPACING, points: (last - first) as usize + 1 }
}

fn summary(chart: &LoadChart, actuators: &[&str]) -> Result<String> {
    let place = |index: usize| (chart.x.value(index % chart.x.points), chart.z.value(index / chart.x.points));
    let points = || chart.points.iter().enumerate().filter_map(|(i, point)| Some((i, point.as_ref()?)));
    let payload = |a: &(usize, &LoadPoint), b: &(usize, &LoadPoint)| a.1.payload.total_cmp(&b.1.payload);
    let (Some(least), Some(greatest)) = (points().min_by(payload), points().max_by(payload)) else {
        bail!("the crane holds itself nowhere in its workspace: check effort limits and masses");
    };
    let mut limits: BTreeMap<usize, usize> = BTreeMap::new();
    points().for_each(|(_, point)| *limits.entry(point.limited_by).or_default() += 1);
    let mut text = format!("{} of {} tip positions are in reach\n", points().count(), chart.points.len());
    for (name, (index, point)) in [("least", least), ("greatest", greatest)] {
        let ((x, z), actuator) = (place(index), actuators[point.limited_by]);
        text += &format!(
            "{name} payload: {:.0} kg at x {x:.1} m, z {z:.1} m, limited by {actuator}\n",
            point.payload
        );
    }
    for (actuator, count) in limits {
        text += &format!("limited by {}: {count} positions\n", actuators[actuator]);
    }
    Ok(text)
}

#[cfg(feature = "figures")]
fn picture(chart: &LoadChart) -> Result<String> {
    use figures::{Axis, Chart, Heat, Layer, Panel, Proportion, SvgTheme};

    // What is out of reach all along an edge is left out.
    let reached = || chart.points.iter().enumerate().filter(|(_, point)| point.is_some()).map(|(i, _)| i);
    let span = |indices: &mut dyn Iterator<Item = usize>| {
        indices.fold((usize::MAX, 0), |(least, most), i| (least.min(i), most.max(i)))
    };
    let (left, right) = span(&mut reached().map(|i| i % chart.x.points));
    let (bottom, top) = span(&mut reached().map(|i| i / chart.x.points));
    let edges = |axis: hiab_dynamics::Axis, (first, last): (usize, usize)| -> Vec<f64> {
        let half = 0.5 * (axis.value(1) - axis.value(0));
        (first..=last).map(|i| axis.value(i) - half).chain([axis.value(last) + half]).collect()
    };
    let value = |x: usize, z: usize| chart.points[z * chart.x.points + x].as_ref().map(|point| point.payload);
    let values = (bottom..=top).flat_map(|z| (left..=right).map(move |x| value(x, z).unwrap_or(f64::NAN)));
    let heat = Heat {
        quantity: Axis::new("Largest payload", "kg"),
        x_edges: edges(chart.x, (left, right)),
        y_edges: edges(chart.z, (bottom, top)),
        values: values.collect(),
    };
    let panel = Panel::new(Axis::new("Height of the tip", "m"), vec![Layer::Heat(heat)]);
    let chart = Chart {
        panels: vec![panel],
        proportion: Proportion::Equal,
        width: WIDTH,
        ..Chart::new("Static load chart", Axis::new("Distance from the slew axis", "m"))
    };
    Ok(chart.draw().context("load chart")?.svg(SvgTheme::Reader))
}

#[cfg(not(feature = "figures"))]
fn picture(_chart: &LoadChart) -> Result<String> {
    bail!("this program was built without pictures; build it with the feature `figures`")
}
