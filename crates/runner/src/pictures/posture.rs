//! The crane as it looks, from the shapes in its URDF and the frames of its links.

use std::collections::BTreeMap;

use anyhow::{Context, Result};
use figures::{Axis, Colour, Dash, Figure, Layer, Marker, Outline, Part, Picture, Strip, Style};
use hiab_dynamics::{Data, Pose};
use urdf_rs::{Geometry, JointType};

use super::{Shown, line, points};
use crate::machine::Machine;

/// Pictures in a strip.
const PICTURES: usize = 5;

/// Why a URDF does not say what a crane looks like.
#[derive(Debug, thiserror::Error)]
pub enum LooksError {
    /// It cannot be read.
    #[error(transparent)]
    Urdf(#[from] urdf_rs::UrdfError),
    /// No link has a box or a cylinder.
    #[error("no link has a visual that is a box or a cylinder")]
    NoShape,
}

/// What links look like and what joints measure.
#[derive(Clone, Debug)]
pub struct Looks {
    shapes: Vec<Shape>,
    units: BTreeMap<String, &'static str>,
}

/// A box around a link, or around a cylinder of a link.
#[derive(Clone, Debug)]
struct Shape {
    link: String,
    /// Rotation matrix and position of the box in the link's frame.
    rotation: [[f64; 3]; 3],
    position: [f64; 3],
    /// Half of each side \[m\].
    half: [f64; 3],
    is_cylinder: bool,
}

impl Looks {
    /// From the text of a URDF. Meshes and spheres are left out.
    ///
    /// # Errors
    /// [`LooksError`].
    pub fn from_urdf(text: &str) -> Result<Self, LooksError> {
        let robot = urdf_rs::read_from_string(text)?;
        let mut shapes = Vec::new();
        for link in &robot.links {
            for visual in &link.visual {
                let (half, is_cylinder) = match &visual.geometry {
                    Geometry::Box { size } => (size.0.map(|side| side / 2.0), false),
                    Geometry::Cylinder { radius, length } => ([*radius, *radius, length / 2.0], true),
                    _ => continue,
                };
                let (rotation, position) = (rotation(visual.origin.rpy.0), visual.origin.xyz.0);
                shapes.push(Shape { link: link.name.clone(), rotation, position, half, is_cylinder });
            }
        }
        if shapes.is_empty() {
            return Err(LooksError::NoShape);
        }
        let unit = |kind: &JointType| if *kind == JointType::Prismatic { "m" } else { "rad" };
        let units = robot.joints.iter().map(|joint| (joint.name.clone(), unit(&joint.joint_type))).collect();
        Ok(Self { shapes, units })
    }

    /// Unit of a joint's position; radians for one that is not known.
    #[must_use]
    pub fn unit(&self, joint: &str) -> &'static str {
        self.units.get(joint).copied().unwrap_or("rad")
    }

    /// The crane in the plane (x, z) at `posture`, every link as the shadow of its shape.
    fn outline(&self, machine: &Machine, data: &mut Data, posture: &[f64]) -> Result<Outline> {
        let model = machine.model();
        model.update_kinematics(data, posture, &vec![0.0; posture.len()])?;
        let colours = [Colour::Grey, Colour::Blue, Colour::Sky, Colour::Orange, Colour::Purple];
        let parts = self.shapes.iter().enumerate().map(|(index, shape)| {
            let link = model.link_index(&shape.link).context("the model has every link of its URDF")?;
            let colour = if shape.is_cylinder { Colour::Green } else { colours[index % colours.len()] };
            Ok(Part { vertices: shape.shadow(&model.link_pose(data, link)), colour })
        });
        Ok(Outline { parts: parts.collect::<Result<_>>()? })
    }
}

impl Shape {
    /// Outline of the shape's shadow on the plane (x, z), with its link at `pose`.
    fn shadow(&self, pose: &Pose) -> Vec<[f64; 2]> {
        let corners = (0..8_u8).map(|corner| {
            let side = |axis: usize| if corner >> axis & 1 == 0 { -self.half[axis] } else { self.half[axis] };
            let in_link = moved(&self.rotation, self.position, [side(0), side(1), side(2)]);
            let [x, _, z] = moved(&pose.rotation, pose.position, in_link);
            [x, z]
        });
        hull(corners.collect())
    }
}

/// Rotation matrix of roll, pitch and yaw about fixed axes, as in URDF.
fn rotation([roll, pitch, yaw]: [f64; 3]) -> [[f64; 3]; 3] {
    let ((sr, cr), (sp, cp), (sy, cy)) = (roll.sin_cos(), pitch.sin_cos(), yaw.sin_cos());
    [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
}

fn moved(rotation: &[[f64; 3]; 3], position: [f64; 3], point: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| {
        position[axis] + rotation[axis].iter().zip(point).map(|(r, p)| r * p).sum::<f64>()
    })
}

/// Convex hull, by Andrew's monotone chain.
fn hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let turns_left = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0.0
    };
    let half = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for point in points {
            while chain.len() > 1 && !turns_left(chain[chain.len() - 2], chain[chain.len() - 1], point) {
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut around = half(&mut points.iter().copied());
    around.extend(half(&mut points.iter().rev().copied()));
    around
}

/// The crane's posture at several times of an episode, with the way of its tip so far and its target.
///
/// # Errors
/// A posture at which no loop closes; a recording has none.
pub fn postures(shown: &Shown<'_>) -> Result<Figure> {
    let recording = shown.recording;
    let last = recording.postures.len() - 1;
    let mut data = shown.machine.model().new_data();
    let way = Style { colour: Colour::Ink, dash: Dash::Solid, marker: None, width: 1.6 };
    let cross = Style { colour: Colour::Vermillion, marker: Some(Marker::Cross), ..way };
    let mut pictures = Vec::new();
    for index in 0..PICTURES {
        let at = index * last / (PICTURES - 1);
        let time = at as f64 * shown.machine.rates().policy_period();
        let outline = shown.looks.outline(shown.machine, &mut data, &recording.postures[at])?;
        let [x, _, z] = recording.episode.target;
        let so_far = recording.tips[..=at].iter().map(|[x, _, z]| [*x, *z]);
        pictures.push(Picture {
            caption: format!("t = {time:.2} s"),
            layers: vec![
                Layer::Outline(outline),
                line("way of the tip", way, so_far),
                points("target", cross, [[x, z]]),
            ],
        });
    }
    let strip = Strip {
        title: "The crane on its way to the target".to_owned(),
        x: Axis::new("Reach x", "m"),
        y: Axis::new("Height z", "m"),
        pictures,
        columns: PICTURES,
        width: 1000.0,
    };
    Ok(strip.draw()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hull_of_a_square_with_points_inside_is_the_square() {
        let mut points = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.5], [0.5, 0.0]];
        points.extend([[0.0, 0.0], [1.0, 1.0]]);
        assert_eq!(hull(points), [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    }

    #[test]
    fn a_quarter_turn_about_y_lays_a_cylinder_along_x() {
        let quarter = std::f64::consts::FRAC_PI_2;
        let [x, y, z] = moved(&rotation([0.0, quarter, 0.0]), [1.0, 2.0, 3.0], [0.0, 0.0, 1.0]);
        assert!((x - 2.0).abs() < 1e-15 && (y - 2.0).abs() < 1e-15 && (z - 3.0).abs() < 1e-15);
    }

    #[test]
    fn a_urdf_without_shapes_is_refused() {
        let bare = r#"<robot name="r"><link name="base"/></robot>"#;
        assert!(matches!(Looks::from_urdf(bare), Err(LooksError::NoShape)));
    }
}
