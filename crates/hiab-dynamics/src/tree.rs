//! The URDF as a tree of moving bodies; links on fixed joints are lumped into the body that carries them.
#![expect(non_snake_case, reason = "monogram frames")]

use std::collections::HashMap;

use nalgebra::{Matrix3, Vector3};
use urdf_rs::JointType;

use crate::error::ModelError;
use crate::fault::TreeFault;
use crate::joint::{JointKind, TreeJoint};
use crate::spatial::{MassProperties, Transform};
use crate::urdf_text;

/// A tree of bodies, each moved by one joint against its parent. Bodies and joints share their index; a parent's
/// index is smaller than its child's.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    pub(crate) joints: Vec<TreeJoint>,
    pub(crate) links: Vec<TreeLink>,
    /// Joints of the URDF that do not move.
    pub(crate) fixed_joints: Vec<String>,
}

/// A link of the URDF, posed in its body.
#[derive(Clone, Debug)]
pub(crate) struct TreeLink {
    pub(crate) name: String,
    /// Body that it belongs to; `None` is the ground.
    pub(crate) body: Option<usize>,
    /// Pose of the link L in its body B, or in the world.
    pub(crate) X_BL: Transform,
}

impl Tree {
    /// Index of the link `name`.
    pub(crate) fn link(&self, name: &str) -> Option<usize> {
        self.links.iter().position(|link| link.name == name)
    }

    /// Index of the moving joint `name`.
    pub(crate) fn joint(&self, name: &str) -> Option<usize> {
        self.joints.iter().position(|joint| joint.name == name)
    }

    /// Builds the tree from the URDF's text.
    pub(crate) fn from_urdf(text: &str) -> Result<Self, ModelError> {
        urdf_text::check(text)?;
        let robot = urdf_rs::read_from_string(text)?;
        check_names(&robot)?;
        let mut own_mass = Vec::with_capacity(robot.links.len());
        for link in &robot.links {
            own_mass.push(link_mass(link)?);
        }
        for joint in &robot.joints {
            check_joint(joint)?;
        }
        let root = find_root(&robot)?;

        let index: HashMap<&str, usize> =
            robot.links.iter().enumerate().map(|(i, link)| (link.name.as_str(), i)).collect();
        let mut placed: Vec<Option<(Option<usize>, Transform)>> = vec![None; robot.links.len()];
        placed[root] = Some((None, Transform::identity()));
        let mut tree = Self { joints: Vec::new(), links: Vec::new(), fixed_joints: Vec::new() };
        let mut open: Vec<&urdf_rs::Joint> = robot.joints.iter().collect();
        // In the order of the file wherever that puts parents first.
        while !open.is_empty() {
            let Some(next) =
                open.iter().position(|joint| placed[index[joint.parent.link.as_str()]].is_some())
            else {
                let fault = TreeFault::Cycle { joint: open[0].name.clone() };
                return Err(ModelError::NotATree { fault });
            };
            let joint = open.remove(next);
            let child = index[joint.child.link.as_str()];
            let Some((parent, X_PL)) = placed[index[joint.parent.link.as_str()]] else { continue };
            let X_PJ = X_PL * pose(&joint.origin);
            placed[child] = if joint.joint_type == JointType::Fixed {
                tree.fixed_joints.push(joint.name.clone());
                if let Some(body) = parent {
                    let lumped = own_mass[child].expressed_in(&X_PJ);
                    tree.joints[body].mass = tree.joints[body].mass.joined(&lumped);
                }
                Some((parent, X_PJ))
            } else {
                tree.joints.push(moving_joint(joint, parent, X_PJ, own_mass[child])?);
                Some((Some(tree.joints.len() - 1), Transform::identity()))
            };
        }
        for (link, place) in robot.links.iter().zip(placed) {
            // Every link but the root is some joint's child, and every joint has been placed.
            let (body, X_BL) = place.unwrap_or((None, Transform::identity()));
            tree.links.push(TreeLink { name: link.name.clone(), body, X_BL });
        }
        tree.check_bodies(&robot)?;
        Ok(tree)
    }

    fn check_bodies(&self, robot: &urdf_rs::Robot) -> Result<(), ModelError> {
        for joint in &self.joints {
            let child = robot.joints.iter().find(|j| j.name == joint.name).map(|j| j.child.link.clone());
            let link = child.unwrap_or_default();
            if joint.mass.mass <= 0.0 {
                return Err(ModelError::MasslessBody { link, joint: joint.name.clone() });
            }
            let moments = principal_moments(&joint.mass.about_center);
            if moments[0] <= 1e-12 * moments[2] || moments[0] <= 0.0 {
                let rule = "positive on a moving body";
                return Err(ModelError::BadInertia { link, moments, rule });
            }
        }
        Ok(())
    }
}

fn check_names(robot: &urdf_rs::Robot) -> Result<(), ModelError> {
    let links = robot.links.iter().map(|link| &link.name);
    refuse_duplicates("link", links)?;
    refuse_duplicates("joint", robot.joints.iter().map(|joint| &joint.name))?;
    for joint in &robot.joints {
        for (field, name) in [("parent", &joint.parent.link), ("child", &joint.child.link)] {
            if !robot.links.iter().any(|link| link.name == *name) {
                let owner = format!("joint `{}`", joint.name);
                return Err(ModelError::UnknownName { owner, field, kind: "link", name: name.clone() });
            }
        }
    }
    Ok(())
}

/// Refuses the second of two equal names.
pub(crate) fn refuse_duplicates<'a>(
    kind: &'static str,
    names: impl Iterator<Item = &'a String>,
) -> Result<(), ModelError> {
    let mut seen = std::collections::HashSet::new();
    for name in names {
        if !seen.insert(name) {
            return Err(ModelError::DuplicateName { kind, name: name.clone() });
        }
    }
    Ok(())
}

fn find_root(robot: &urdf_rs::Robot) -> Result<usize, ModelError> {
    let not_a_tree = |fault| Err(ModelError::NotATree { fault });
    let mut parent_joint: HashMap<&str, &str> = HashMap::new();
    for joint in &robot.joints {
        if let Some(first) = parent_joint.insert(&joint.child.link, &joint.name) {
            let (link, first, second) = (joint.child.link.clone(), first.into(), joint.name.clone());
            return not_a_tree(TreeFault::TwoParents { link, first, second });
        }
    }
    let mut roots = (0..robot.links.len()).filter(|i| !parent_joint.contains_key(&*robot.links[*i].name));
    match (roots.next(), roots.next(), robot.joints.first()) {
        (Some(root), None, _) => Ok(root),
        (Some(first), Some(second), _) => {
            let name = |i: usize| robot.links[i].name.clone();
            not_a_tree(TreeFault::TwoRoots { first: name(first), second: name(second) })
        }
        (None, _, Some(joint)) => not_a_tree(TreeFault::Cycle { joint: joint.name.clone() }),
        (None, _, None) => not_a_tree(TreeFault::Empty),
    }
}

fn check_joint(joint: &urdf_rs::Joint) -> Result<(), ModelError> {
    let unsupported = |found: &str| {
        Err(ModelError::UnsupportedJoint { joint: joint.name.clone(), found: found.to_owned() })
    };
    match joint.joint_type {
        JointType::Revolute | JointType::Continuous | JointType::Prismatic | JointType::Fixed => {}
        JointType::Floating => return unsupported("floating"),
        JointType::Planar => return unsupported("planar"),
        JointType::Spherical => return unsupported("spherical"),
    }
    if joint.mimic.is_some() {
        return unsupported("mimic");
    }
    let owner = || format!("joint `{}`", joint.name);
    finite(&owner, "origin xyz", &joint.origin.xyz.0)?;
    finite(&owner, "origin rpy", &joint.origin.rpy.0)?;
    finite(&owner, "axis", &joint.axis.xyz.0)?;
    finite(&owner, "limit", &[joint.limit.lower, joint.limit.upper, joint.limit.effort, joint.limit.velocity])
}

fn moving_joint(
    joint: &urdf_rs::Joint,
    parent: Option<usize>,
    X_PJ: Transform,
    mass: MassProperties,
) -> Result<TreeJoint, ModelError> {
    let Some(axis) = Vector3::from(joint.axis.xyz.0).try_normalize(1e-9) else {
        return Err(ModelError::ZeroAxis { joint: joint.name.clone() });
    };
    let kind =
        if joint.joint_type == JointType::Prismatic { JointKind::Prismatic } else { JointKind::Revolute };
    let limited = joint.joint_type != JointType::Continuous && joint.limit.lower < joint.limit.upper;
    let middle = limited.then_some(0.5 * (joint.limit.lower + joint.limit.upper));
    Ok(TreeJoint::new(joint.name.clone(), kind, parent, X_PJ, axis, middle, mass))
}

fn link_mass(link: &urdf_rs::Link) -> Result<MassProperties, ModelError> {
    let owner = || format!("link `{}`", link.name);
    let inertial = &link.inertial;
    let i = &inertial.inertia;
    finite(&owner, "mass", &[inertial.mass.value])?;
    finite(&owner, "inertia", &[i.ixx, i.ixy, i.ixz, i.iyy, i.iyz, i.izz])?;
    finite(&owner, "inertial origin xyz", &inertial.origin.xyz.0)?;
    finite(&owner, "inertial origin rpy", &inertial.origin.rpy.0)?;
    let about_center = Matrix3::new(i.ixx, i.ixy, i.ixz, i.ixy, i.iyy, i.iyz, i.ixz, i.iyz, i.izz);
    let mass = inertial.mass.value;
    if mass < 0.0 || (mass == 0.0 && about_center != Matrix3::zeros()) {
        return Err(ModelError::BadMass { link: link.name.clone(), mass });
    }
    let moments = principal_moments(&about_center);
    // Published values carry about nine digits.
    let slack = 1e-8 * moments[2].abs();
    let bad = |rule| Err(ModelError::BadInertia { link: link.name.clone(), moments, rule });
    if moments[0] < -slack {
        return bad("not negative");
    }
    if moments[0] + moments[1] < moments[2] - slack {
        return bad("such that the two smaller ones add up to at least the third");
    }
    let own = MassProperties { mass, center: Vector3::zeros(), about_center };
    Ok(own.expressed_in(&pose(&inertial.origin)))
}

fn principal_moments(matrix: &Matrix3<f64>) -> [f64; 3] {
    let eigen = matrix.symmetric_eigenvalues();
    let mut moments = [eigen[0], eigen[1], eigen[2]];
    moments.sort_by(f64::total_cmp);
    moments
}

fn pose(origin: &urdf_rs::Pose) -> Transform {
    let [roll, pitch, yaw] = origin.rpy.0;
    Transform { rotation: rotation(roll, pitch, yaw), translation: Vector3::from(origin.xyz.0) }
}

/// The URDF's rotation: about the fixed x axis by `roll`, then y by `pitch`, then z by `yaw` \[rad\].
fn rotation(roll: f64, pitch: f64, yaw: f64) -> Matrix3<f64> {
    let [(sr, cr), (sp, cp), (sy, cy)] = [roll, pitch, yaw].map(libm::sincos);
    Matrix3::new(
        cy * cp,
        cy * sp * sr - sy * cr,
        cy * sp * cr + sy * sr,
        sy * cp,
        sy * sp * sr + cy * cr,
        sy * sp * cr - cy * sr,
        -sp,
        cp * sr,
        cp * cr,
    )
}

/// Refuses NaN and infinity.
pub(crate) fn finite(
    owner: &dyn Fn() -> String,
    field: &'static str,
    values: &[f64],
) -> Result<(), ModelError> {
    match values.iter().find(|value| !value.is_finite()) {
        Some(value) => Err(ModelError::NotFinite { owner: owner(), field, value: *value }),
        None => Ok(()),
    }
}
