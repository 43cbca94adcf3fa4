//! The crane: what does not change while it moves.
#![expect(non_snake_case, reason = "monogram frames")]

use nalgebra::Vector3;

use crate::actuator::{Actuator, actuators_from_specs};
use crate::data::Data;
use crate::error::{ModelError, PlantError};
use crate::loop_file::LoopFile;
use crate::loops::ClosedLoop;
use crate::plant::{Friction, Plant};
use crate::spatial::{Inertia, MassProperties, Transform};
use crate::tree::{Tree, finite, refuse_duplicates};

/// A crane: URDF tree, closed cylinder loops, actuators, and what was built onto it.
///
/// Immutable in use: all that changes from state to state lives in a [`Data`], so one model serves many threads.
///
/// Coordinates are the actuators' positions y [rad or m], in the order of [`actuators`](Self::actuators). The
/// loops are eliminated: tree positions q = γ(y), q̇ = G(y)ẏ, q̈ = Gÿ + ġ, with γ in closed form. Every tree joint
/// depends on one actuator, so G has one non-zero entry per row.
///
/// # Examples
/// ```
/// use hiab_dynamics::CraneModel;
///
/// let urdf = r#"<robot name="lever">
///   <link name="ground"/>
///   <link name="arm"><inertial><origin xyz="0.5 0 0"/><mass value="2"/>
///     <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>
///   <link name="tip"/>
///   <joint name="hinge" type="revolute"><parent link="ground"/><child link="arm"/><axis xyz="0 -1 0"/>
///     <limit lower="-1" upper="1" effort="50" velocity="1"/></joint>
///   <joint name="tip_fixed" type="fixed"><parent link="arm"/><child link="tip"/><origin xyz="1 0 0"/></joint>
/// </robot>"#;
/// let loops = r#"(urdf: "lever.urdf", tip_link: "tip", closed_loops: [], actuators: [
///   (joint: "hinge", lower: -1.0, upper: 1.0, effort: 50.0, velocity: 1.0, acceleration: 2.0, jerk: 20.0,
///    armature: 0.0)])"#;
///
/// let model = CraneModel::from_urdf(urdf, loops)?.with_payload(1.0)?;
/// let mut data = model.new_data();
/// model.update_dynamics(&mut data, &[0.0], &[0.0])?;
/// assert!((data.gravity_effort()[0] - 9.81 * (2.0 * 0.5 + 1.0)).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct CraneModel {
    pub(crate) tree: Tree,
    pub(crate) actuators: Vec<Actuator>,
    pub(crate) loops: Vec<ClosedLoop>,
    /// Actuator that each tree joint depends on.
    pub(crate) driven_by: Vec<usize>,
    pub(crate) gravity: Vector3<f64>,
    pub(crate) payload: f64,
    /// Inertia of each body in its own frame, payload included.
    pub(crate) inertias: Vec<Inertia>,
    pub(crate) armature: Vec<f64>,
    pub(crate) friction: Vec<Friction>,
    pub(crate) tip_link: usize,
    pub(crate) tip_body: usize,
    pub(crate) X_BT: Transform,
    /// Tree joints between tip and ground, from the tip down.
    pub(crate) tip_path: Vec<usize>,
}

impl CraneModel {
    /// Builds a crane from the texts of its URDF and of its loop file (RON).
    ///
    /// The URDF may have revolute, continuous, prismatic and fixed joints. Position, velocity and effort limits
    /// come from the loop file's actuators; those of the URDF serve only to choose the whole turn of dependent
    /// joints. A loop is solvable while the sine of the triangle's angle at the turned hinge is at least 0.15,
    /// and, where the actuator's range begins at or above zero, from stroke zero on.
    ///
    /// Gravity is 9.81 m/s² along −z, the payload 0, friction 0 and the armature that of the loop file.
    ///
    /// # Errors
    /// [`ModelError`] names the offending link, joint, loop or actuator, and the field.
    pub fn from_urdf(urdf: &str, loops: &str) -> Result<Self, ModelError> {
        let file = LoopFile::from_ron(loops)?;
        let tree = Tree::from_urdf(urdf)?;
        refuse_duplicates("loop", file.closed_loops.iter().map(|spec| &spec.name))?;
        let actuators = actuators_from_specs(&file.actuators, &tree)?;
        let loops = file
            .closed_loops
            .iter()
            .map(|spec| ClosedLoop::from_spec(spec, &tree, &actuators))
            .collect::<Result<Vec<_>, _>>()?;
        let driven_by = assign_joints(&tree, &actuators, &loops)?;

        let Some(tip_link) = tree.link(&file.tip_link) else {
            let (owner, kind) = ("loop file".to_owned(), "link");
            return Err(ModelError::UnknownName { owner, field: "tip_link", kind, name: file.tip_link });
        };
        let Some(tip_body) = tree.links[tip_link].body else {
            return Err(ModelError::TipDoesNotMove { link: file.tip_link });
        };
        let tip_path = std::iter::successors(Some(tip_body), |body| tree.joints[*body].parent).collect();
        let model = Self {
            driven_by,
            gravity: Vector3::new(0.0, 0.0, -9.81),
            payload: 0.0,
            inertias: tree.joints.iter().map(|joint| joint.mass.about_origin()).collect(),
            armature: actuators.iter().map(Actuator::armature).collect(),
            friction: vec![Friction::NONE; actuators.len()],
            tip_link,
            tip_body,
            X_BT: tree.links[tip_link].X_BL,
            tip_path,
            tree,
            actuators,
            loops,
        };
        model.check_mass_matrix()?;
        Ok(model)
    }

    /// The same crane with a point mass `payload` \[kg\] at the tip; it replaces an earlier one.
    ///
    /// # Errors
    /// [`ModelError::NotFinite`] or [`ModelError::Negative`].
    pub fn with_payload(mut self, payload: f64) -> Result<Self, ModelError> {
        let owner = || "payload".to_owned();
        finite(&owner, "mass", &[payload])?;
        if payload < 0.0 {
            return Err(ModelError::Negative { owner: owner(), field: "mass", value: payload });
        }
        let point = MassProperties::point(payload, self.X_BT.translation);
        self.inertias[self.tip_body] = self.tree.joints[self.tip_body].mass.joined(&point).about_origin();
        self.payload = payload;
        Ok(self)
    }

    /// The same crane with the armature and friction of `plant`, which replace earlier ones and the loop file's
    /// armature. Actuators that the plant does not name have neither.
    ///
    /// # Errors
    /// [`PlantError`] if the plant names a joint that is no actuator here, or a value is out of range.
    pub fn with_plant(mut self, plant: &Plant) -> Result<Self, PlantError> {
        plant.check()?;
        self.armature.fill(0.0);
        self.friction.fill(Friction::NONE);
        for (joint, values) in &plant.actuators {
            let Some(k) = self.actuator_index(joint) else {
                return Err(PlantError::UnknownActuator { joint: joint.clone() });
            };
            self.armature[k] = values.armature;
            self.friction[k] = values.friction();
        }
        Ok(self)
    }

    /// The same crane in the gravity field `gravity` [m/s²], world axes.
    ///
    /// # Errors
    /// [`ModelError::NotFinite`].
    pub fn with_gravity(mut self, gravity: [f64; 3]) -> Result<Self, ModelError> {
        finite(&|| "world".to_owned(), "gravity", &gravity)?;
        self.gravity = Vector3::from(gravity);
        Ok(self)
    }

    /// A workspace of the right size; the only thing here that allocates after construction.
    pub fn new_data(&self) -> Data {
        Data::new(self.actuators.len(), self.tree.joints.len())
    }

    /// The actuators, in the order of every vector of positions, velocities and efforts.
    pub fn actuators(&self) -> &[Actuator] {
        &self.actuators
    }

    /// Index of the actuator that moves `joint`.
    pub fn actuator_index(&self, joint: &str) -> Option<usize> {
        self.actuators.iter().position(|actuator| actuator.name() == joint)
    }

    /// Names of the moving joints of the tree, in the order of [`Data::tree_position`]: the URDF's order, but
    /// parents first.
    pub fn tree_joint_names(&self) -> impl ExactSizeIterator<Item = &str> {
        self.tree.joints.iter().map(|joint| joint.name.as_str())
    }

    /// Index of the moving joint `name`.
    pub fn tree_joint_index(&self, name: &str) -> Option<usize> {
        self.tree.joint(name)
    }

    /// Actuator that tree joint `joint` depends on.
    pub fn driving_actuator(&self, joint: usize) -> usize {
        self.driven_by[joint]
    }

    /// Names of all links, in the order of the URDF.
    pub fn link_names(&self) -> impl ExactSizeIterator<Item = &str> {
        self.tree.links.iter().map(|link| link.name.as_str())
    }

    /// Index of the link `name`.
    pub fn link_index(&self, name: &str) -> Option<usize> {
        self.tree.link(name)
    }

    /// Index of the tip's link.
    pub fn tip_link(&self) -> usize {
        self.tip_link
    }

    /// Mass of the payload \[kg\], a point at the tip.
    pub fn payload(&self) -> f64 {
        self.payload
    }

    /// Acceleration of free fall [m/s²], world axes.
    pub fn gravity(&self) -> [f64; 3] {
        self.gravity.into()
    }

    /// Reflected inertia per actuator [kg·m² or kg], of the plant if one was given.
    pub fn armature(&self) -> &[f64] {
        &self.armature
    }

    /// Positions that actuator `actuator` may have without a loop losing its solution [rad or m]; unbounded
    /// without a loop.
    pub fn solvable_range(&self, actuator: usize) -> (f64, f64) {
        let of_loops = self.loops.iter().filter(|l| l.actuator == actuator);
        of_loops.fold((f64::NEG_INFINITY, f64::INFINITY), |(low, high), l| {
            (low.max(l.triangle.min_stroke), high.min(l.triangle.max_stroke))
        })
    }

    fn check_mass_matrix(&self) -> Result<(), ModelError> {
        let middle: Vec<f64> = self.actuators.iter().map(|a| 0.5 * (a.lower() + a.upper())).collect();
        let mut data = self.new_data();
        let pivot = match self.update_dynamics(&mut data, &middle, &vec![0.0; middle.len()]) {
            Ok(()) => crate::cholesky::factorize(middle.len(), &data.mass_matrix, &mut data.factor).err(),
            Err(_) => None, // every loop closes at mid-range, as `ClosedLoop::from_spec` checked
        };
        match pivot {
            Some((k, _)) => {
                Err(ModelError::SingularMassMatrix { joint: self.actuators[k].name().to_owned() })
            }
            None => Ok(()),
        }
    }
}

/// Gives every tree joint its one actuator.
fn assign_joints(
    tree: &Tree,
    actuators: &[Actuator],
    loops: &[ClosedLoop],
) -> Result<Vec<usize>, ModelError> {
    let mut driven_by: Vec<Option<usize>> = vec![None; tree.joints.len()];
    for (k, actuator) in actuators.iter().enumerate() {
        driven_by[actuator.tree_joint] = Some(k);
    }
    for (i, first) in loops.iter().enumerate() {
        let of_first = [first.main, first.barrel];
        for second in &loops[i + 1..] {
            let shared = of_first.into_iter().find(|joint| [second.main, second.barrel].contains(joint));
            let shared_rod =
                (first.actuator == second.actuator).then(|| actuators[first.actuator].tree_joint);
            if let Some(joint) = shared.or(shared_rod) {
                let joint = tree.joints[joint].name.clone();
                let (first, second) = (first.name.clone(), second.name.clone());
                return Err(ModelError::JointInTwoLoops { joint, first, second });
            }
        }
        for joint in of_first {
            driven_by[joint] = Some(first.actuator);
        }
    }
    let undetermined =
        |joint: usize| ModelError::UndeterminedJoint { joint: tree.joints[joint].name.clone() };
    driven_by.into_iter().enumerate().map(|(joint, k)| k.ok_or_else(|| undetermined(joint))).collect()
}
