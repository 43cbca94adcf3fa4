//! Actuators: the coordinates of a model, and their limits.

use crate::error::ModelError;
use crate::loop_file::ActuatorSpec;
use crate::tree::{Tree, finite, refuse_duplicates};

/// One actuator.
///
/// Invariant: all limits are finite, `lower` < `upper`, the others > 0, `armature` ≥ 0.
#[derive(Clone, Debug)]
pub struct Actuator {
    spec: ActuatorSpec,
    pub(crate) tree_joint: usize,
}

impl Actuator {
    /// Name of the joint that it moves.
    pub fn name(&self) -> &str {
        &self.spec.joint
    }

    /// Least position [rad or m].
    pub fn lower(&self) -> f64 {
        self.spec.lower
    }

    /// Greatest position [rad or m].
    pub fn upper(&self) -> f64 {
        self.spec.upper
    }

    /// Greatest velocity, both signs [rad/s or m/s].
    pub fn velocity_limit(&self) -> f64 {
        self.spec.velocity
    }

    /// Greatest acceleration, both signs [rad/s² or m/s²].
    pub fn acceleration_limit(&self) -> f64 {
        self.spec.acceleration
    }

    /// Greatest jerk, both signs [rad/s³ or m/s³].
    pub fn jerk_limit(&self) -> f64 {
        self.spec.jerk
    }

    /// Greatest effort, both signs [N·m or N].
    pub fn effort_limit(&self) -> f64 {
        self.spec.effort
    }

    /// Reflected inertia of the loop file [kg·m² or kg]. A plant replaces it in the dynamics, not here.
    pub fn armature(&self) -> f64 {
        self.spec.armature
    }

    /// Index of its joint among the tree joints.
    pub fn tree_joint(&self) -> usize {
        self.tree_joint
    }
}

/// Checks all actuators and finds their joints.
pub(crate) fn actuators_from_specs(specs: &[ActuatorSpec], tree: &Tree) -> Result<Vec<Actuator>, ModelError> {
    if specs.is_empty() {
        return Err(ModelError::NoActuators);
    }
    refuse_duplicates("actuator", specs.iter().map(|spec| &spec.joint))?;
    specs.iter().map(|spec| actuator_from_spec(spec, tree)).collect()
}

fn actuator_from_spec(spec: &ActuatorSpec, tree: &Tree) -> Result<Actuator, ModelError> {
    let joint = || spec.joint.clone();
    let owner = || format!("actuator `{}`", spec.joint);
    let Some(tree_joint) = tree.joint(&spec.joint) else {
        if tree.fixed_joints.contains(&spec.joint) {
            return Err(ModelError::ActuatorOnFixedJoint { joint: joint() });
        }
        return Err(ModelError::UnknownName { owner: owner(), field: "joint", kind: "joint", name: joint() });
    };
    let positive = [
        ("effort", spec.effort),
        ("velocity", spec.velocity),
        ("acceleration", spec.acceleration),
        ("jerk", spec.jerk),
    ];
    let rest = [("lower", spec.lower), ("upper", spec.upper), ("armature", spec.armature)];
    for (field, value) in rest.into_iter().chain(positive) {
        finite(&owner, field, &[value])?;
    }
    if spec.lower >= spec.upper {
        return Err(ModelError::EmptyRange { joint: joint(), lower: spec.lower, upper: spec.upper });
    }
    for (field, value) in positive {
        if value <= 0.0 {
            return Err(ModelError::NotPositive { joint: joint(), field, value });
        }
    }
    if spec.armature < 0.0 {
        return Err(ModelError::Negative { owner: owner(), field: "armature", value: spec.armature });
    }
    Ok(Actuator { spec: spec.clone(), tree_joint })
}
