//! From the pins of the URDF to the triangles of the loops.
#![expect(non_snake_case, reason = "monogram frames")]

use std::f64::consts::{PI, TAU};

use nalgebra::{Vector2, Vector3};

use crate::actuator::Actuator;
use crate::error::ModelError;
use crate::fault::{CloseFault, LoopFault};
use crate::joint::JointKind;
use crate::loop_file::{Branch, ClosedLoopSpec, LoopKind};
use crate::spatial::Transform;
use crate::tree::Tree;
use crate::triangle::{MIN_SIN_AT_HINGE, Triangle};

/// How far from parallel axes may be \[1\], and how far from one plane pins may be \[m\]: what rounding of published
/// drawings to a micrometre leaves.
const PLANARITY: f64 = 1e-6;

/// A loop and the joints that it determines.
#[derive(Clone, Debug)]
pub(crate) struct ClosedLoop {
    pub(crate) name: String,
    /// Actuator index of the cylinder.
    pub(crate) actuator: usize,
    /// Tree index of the turned joint.
    pub(crate) main: usize,
    /// Tree index of the barrel's joint.
    pub(crate) barrel: usize,
    pub(crate) triangle: Triangle,
}

impl ClosedLoop {
    /// Finds the loop's joints and pins in the tree and derives its triangle.
    pub(crate) fn from_spec(
        spec: &ClosedLoopSpec,
        tree: &Tree,
        actuators: &[Actuator],
    ) -> Result<Self, ModelError> {
        let Members { actuator, rod, main, barrel, rod_link, main_link } = members(spec, tree, actuators)?;
        let not_planar = |what, value: f64| {
            let (closed_loop, bound) = (spec.name.clone(), PLANARITY);
            Err(ModelError::NotPlanar { closed_loop, what, value, bound })
        };
        let zero_side = |side| Err(topology(spec, LoopFault::ZeroSide { side }));

        // Everything in the frame of P, the body that both hinges start on, with main and barrel joint at zero.
        let X_PO = tree.joints[main].X_PJ;
        let X_PC = tree.joints[barrel].X_PJ;
        let X_CR = tree.joints[rod].X_PJ;
        let n = X_PO.rotation * tree.joints[main].axis;
        let n_barrel = X_PC.rotation * tree.joints[barrel].axis;
        let along = X_PC.rotation * (X_CR.rotation * tree.joints[rod].axis);
        let barrel_sign = n.dot(&n_barrel).signum();
        let skew = (n_barrel - n * barrel_sign).norm();
        if skew > PLANARITY {
            return not_planar("the sine of the angle between its hinge axes", skew);
        }
        if n.dot(&along).abs() > PLANARITY {
            return not_planar("the cylinder's slope to the hinges' plane", n.dot(&along).abs());
        }
        let center = X_PC.translation - X_PO.translation;
        let rod_pin = X_PC.rotation * (X_CR * in_body(tree, rod_link)).translation;
        let main_pin = X_PO.rotation * in_body(tree, main_link).translation;
        let gap = n.dot(&(center + rod_pin - main_pin)).abs();
        if gap > PLANARITY {
            return not_planar("the gap between its pins along the hinge axis", gap);
        }

        let plane = Plane::across(&n, &along);
        let (c, p0, r0) = (plane.project(&center), plane.project(&main_pin), plane.project(&rod_pin));
        let (a, b) = (c.norm(), p0.norm());
        if a <= PLANARITY {
            return zero_side("the side between the two hinges");
        }
        if b <= PLANARITY {
            return zero_side("the side between the turned joint and the pin");
        }
        let lambda = r0.x;
        let eta = r0.y;
        let eta = if eta.abs() < 1e-12 * (a + b) { 0.0 } else { eta };

        let range = &actuators[actuator];
        let shape = Shape { a, b, lambda, eta };
        let (min_stroke, max_stroke) = usable_strokes(spec, &shape, range, &tree.joints[main].name)?;

        let branch = match spec.branch {
            Branch::Positive => 1.0,
            Branch::Negative => -1.0,
        };
        let angle = |v: &Vector2<f64>| libm::atan2(v.y, v.x);
        let mut triangle = Triangle {
            a,
            b,
            lambda,
            eta,
            branch,
            main_zero: angle(&c) - angle(&p0),
            barrel_zero: barrel_sign * (angle(&c) + PI), // the cylinder's own direction is the plane's x axis
            barrel_sign,
            min_stroke,
            max_stroke,
        };
        // Whole turns: as near to the URDF's limits as they go, at mid-range, and so everywhere.
        let (at_main, at_barrel) = triangle.solve(0.5 * (range.lower() + range.upper()));
        triangle.main_zero += turns_towards(tree.joints[main].middle, at_main.position);
        triangle.barrel_zero += turns_towards(tree.joints[barrel].middle, at_barrel.position);
        Ok(Self { name: spec.name.clone(), actuator, main, barrel, triangle })
    }
}

/// The sides of a loop's triangle.
struct Shape {
    a: f64,
    b: f64,
    lambda: f64,
    eta: f64,
}

/// Solvable strokes \[m\], which must contain the actuator's range.
fn usable_strokes(
    spec: &ClosedLoopSpec,
    shape: &Shape,
    range: &Actuator,
    main: &str,
) -> Result<(f64, f64), ModelError> {
    let Shape { a, b, lambda, eta } = *shape;
    let (closed_loop, joint) = (spec.name.clone(), spec.independent.clone());
    let fault = |stroke: f64| Box::new(close_fault(shape, stroke, main.to_owned()));
    let Some((min_stroke, max_stroke)) = Triangle::solvable_strokes(a, b, lambda, eta) else {
        return Err(ModelError::LoopNeverCloses { closed_loop, joint, fault: fault(range.lower()) });
    };
    // A range that begins at or above zero counts from the cylinder's retracted length: no rod goes below it.
    let retracted = range.lower() >= 0.0 && min_stroke < 0.0;
    let min_stroke = if retracted { 0.0 } else { min_stroke };
    if max_stroke < min_stroke {
        return Err(ModelError::LoopNeverCloses { closed_loop, joint, fault: fault(range.lower()) });
    }
    let ends = [range.lower(), range.upper()];
    match ends.into_iter().find(|end| !(min_stroke..=max_stroke).contains(end)) {
        None => Ok((min_stroke, max_stroke)),
        Some(stroke) => Err(ModelError::LoopCannotClose {
            closed_loop,
            joint,
            lower: range.lower(),
            upper: range.upper(),
            solvable_lower: min_stroke,
            solvable_upper: max_stroke,
            stroke,
            fault: fault(stroke),
        }),
    }
}

/// Why a loop of this shape has no usable solution at `stroke`.
fn close_fault(shape: &Shape, stroke: f64, main: String) -> CloseFault {
    let Shape { a, b, lambda, eta } = *shape;
    let along = lambda + stroke;
    let length = libm::hypot(along, eta);
    if along <= 0.0 {
        CloseFault::BehindHinge
    } else if length < (a - b).abs() {
        CloseFault::TooShort { main, gap: (a - b).abs() - length }
    } else if length > a + b {
        CloseFault::TooLong { main, gap: length - (a + b) }
    } else {
        let angle = libm::acos(((a * a + b * b - length * length) / (2.0 * a * b)).clamp(-1.0, 1.0));
        CloseFault::NearSingular { main, angle: angle.min(PI - angle), bound: libm::asin(MIN_SIN_AT_HINGE) }
    }
}

struct Members {
    actuator: usize,
    rod: usize,
    main: usize,
    barrel: usize,
    rod_link: usize,
    main_link: usize,
}

fn members(spec: &ClosedLoopSpec, tree: &Tree, actuators: &[Actuator]) -> Result<Members, ModelError> {
    let joint = |field, name: &str| {
        tree.joint(name).ok_or_else(|| {
            let owner = format!("loop `{}`", spec.name);
            ModelError::UnknownName { owner, field, kind: "moving joint", name: name.to_owned() }
        })
    };
    let link = |field, name: &str| {
        tree.link(name).ok_or_else(|| {
            let owner = format!("loop `{}`", spec.name);
            ModelError::UnknownName { owner, field, kind: "link", name: name.to_owned() }
        })
    };
    let fail = |fault| Err(topology(spec, fault));

    if spec.kind == LoopKind::Frame6d {
        return fail(LoopFault::Weld);
    }
    let rod = joint("independent", &spec.independent)?;
    let [first, second] = spec.dependent.as_slice() else {
        return fail(LoopFault::DependentCount { found: spec.dependent.len() });
    };
    let (first, second) = (joint("dependent", first)?, joint("dependent", second)?);
    let (frame_a, frame_b) = (link("frame_a", &spec.frame_a)?, link("frame_b", &spec.frame_b)?);
    let name = |i: usize| tree.joints[i].name.clone();

    if tree.joints[rod].kind != JointKind::Prismatic {
        return fail(LoopFault::IndependentNotPrismatic { joint: name(rod) });
    }
    for dependent in [first, second] {
        if let Some(actuator) = actuators.iter().find(|a| a.tree_joint == dependent) {
            let (joint, closed_loop) = (actuator.name().to_owned(), spec.name.clone());
            return Err(ModelError::DependentActuator { joint, closed_loop });
        }
        if tree.joints[dependent].kind != JointKind::Revolute {
            return fail(LoopFault::DependentNotRevolute { joint: name(dependent) });
        }
    }
    let Some(actuator) = actuators.iter().position(|a| a.tree_joint == rod) else {
        return fail(LoopFault::IndependentNotActuated { joint: name(rod) });
    };
    let (main, barrel) = match tree.joints[rod].parent {
        Some(body) if body == second && first != second => (first, second),
        Some(body) if body == first && first != second => (second, first),
        _ => return fail(LoopFault::NoBarrel { joint: name(rod) }),
    };
    if tree.joints[main].parent != tree.joints[barrel].parent {
        return fail(LoopFault::HingesOnDifferentBodies { barrel: name(barrel), main: name(main) });
    }
    let on = |link: usize, body: usize| tree.links[link].body == Some(body);
    let (rod_link, main_link) = if on(frame_a, rod) && on(frame_b, main) {
        (frame_a, frame_b)
    } else if on(frame_b, rod) && on(frame_a, main) {
        (frame_b, frame_a)
    } else {
        return fail(LoopFault::PinElsewhere { rod: name(rod), main: name(main) });
    };
    Ok(Members { actuator, rod, main, barrel, rod_link, main_link })
}

fn topology(spec: &ClosedLoopSpec, fault: LoopFault) -> ModelError {
    ModelError::LoopTopology { closed_loop: spec.name.clone(), fault }
}

fn in_body(tree: &Tree, link: usize) -> Transform {
    tree.links[link].X_BL
}

/// Whole turns \[rad\] that bring `angle` nearest to `middle`, or into [−π, π] without one.
fn turns_towards(middle: Option<f64>, angle: f64) -> f64 {
    TAU * ((middle.unwrap_or(0.0) - angle) / TAU).round()
}

/// Right-handed axes of the plane across a unit normal.
struct Plane {
    x: Vector3<f64>,
    y: Vector3<f64>,
}

impl Plane {
    fn across(normal: &Vector3<f64>, towards: &Vector3<f64>) -> Self {
        let flat = towards - normal * normal.dot(towards);
        // `towards` is a unit vector within 1e-6 of the plane, so its projection cannot vanish.
        let x = flat / flat.norm();
        Self { x, y: normal.cross(&x) }
    }

    fn project(&self, v: &Vector3<f64>) -> Vector2<f64> {
        Vector2::new(self.x.dot(v), self.y.dot(v))
    }
}
