//! The Lyapunov function of the paper's proof along a run, and the balls that theory puts it in.

use adaptive_ctrl::{
    AdaptiveController, AnyController, Bounds, GainsSpec, InverseInertia, OperatingRange, Parameters,
    UltimateBound,
};
use anyhow::Result;
use hiab_dynamics::{CraneModel, Data};
use serde::{Deserialize, Serialize};

use crate::control::Controllers;
use crate::motion::Motion;

/// What a theorem says of a joint's run, and what the run was.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lyapunov {
    /// Largest V that the theorem allows, with the run's largest uncertainty: max(V(0), V∞).
    pub bound: f64,
    /// Largest V of the run.
    pub observed: f64,
    /// Largest disturbance of the run: all that the law does not know, as an effort [N or N·m].
    pub disturbance: f64,
    /// Largest position error that the sampled loop allows under that disturbance [m or rad]; none where no quadratic
    /// function shows it.
    pub position_bound: Option<f64>,
    /// Largest position error of the run [m or rad].
    pub position_observed: f64,
}

/// Follows every joint's V.
#[derive(Debug)]
pub(crate) struct Watch {
    data: Data,
    inverse_inertia: Vec<f64>,
    joints: Vec<Option<JointWatch>>,
    period: f64,
}

#[derive(Clone, Copy, Debug)]
struct JointWatch {
    gains: GainsSpec,
    /// Errors, parameters and A at the last tick; none before the first.
    last: Option<(f64, f64, Parameters, f64)>,
    start: (f64, f64),
    start_value: Option<f64>,
    observed: f64,
    position: f64,
    disturbance: f64,
    /// Largest difference of a tick's step and the mean of the velocities around it [m or rad].
    slip: f64,
    /// Largest |W|: the disturbance with u̇_v/A and ½z₂·d(1/A)/dt, which the proof takes for bounded.
    uncertainty: f64,
    inverse_inertia: (f64, f64),
    reached: Parameters,
}

fn adaptive(controllers: &Controllers, joint: usize) -> Option<&AdaptiveController> {
    match controllers {
        Controllers::Joints(joints) => match &joints[joint] {
            AnyController::Adaptive(controller) => Some(controller),
            _ => None,
        },
        Controllers::ComputedTorque(_) => None,
    }
}

impl Watch {
    /// For a motion whose controllers act every `period` \[s\]; follows nothing unless it is on.
    pub(crate) fn new(motion: &Motion, model: &CraneModel, period: f64, is_on: bool) -> Self {
        let joints = model.actuators().len();
        let watch = |joint| {
            adaptive(motion.controllers(), joint).filter(|_| is_on).map(|controller| JointWatch {
                gains: *controller.gains(),
                last: None,
                start: (0.0, 0.0),
                start_value: None,
                observed: 0.0,
                position: 0.0,
                disturbance: 0.0,
                slip: 0.0,
                uncertainty: 0.0,
                inverse_inertia: (f64::INFINITY, 0.0),
                reached: Parameters { position: 0.0, velocity: 0.0 },
            })
        };
        Self {
            data: model.new_data(),
            inverse_inertia: vec![0.0; joints],
            joints: (0..joints).map(watch).collect(),
            period,
        }
    }

    /// The next part of a scenario starts: nothing leads from the last state to the next.
    pub(crate) fn start_part(&mut self) {
        for joint in self.joints.iter_mut().flatten() {
            joint.last = None;
        }
    }

    /// Looks at the state after a tick of the controllers.
    pub(crate) fn look(&mut self, motion: &Motion, model: &CraneModel) -> Result<()> {
        if self.joints.iter().all(Option::is_none) {
            return Ok(());
        }
        model.update_dynamics(&mut self.data, motion.position(), motion.velocity())?;
        model.inverse_effective_inertia(&mut self.data, &mut self.inverse_inertia)?;
        for (joint, watch) in self.joints.iter_mut().enumerate() {
            let (Some(watch), Some(controller)) = (watch, adaptive(motion.controllers(), joint)) else {
                continue;
            };
            let wanted = motion.wanted()[joint];
            let e1 = motion.position()[joint] - wanted.position;
            let e2 = motion.velocity()[joint] - wanted.velocity;
            watch.add(e1, e2, controller.parameters(), self.inverse_inertia[joint], self.period);
        }
        Ok(())
    }

    /// What was seen of every joint.
    pub(crate) fn results(&self) -> Vec<Option<Lyapunov>> {
        self.joints.iter().map(|watch| watch.map(|watch| watch.result(self.period))).collect()
    }
}

impl JointWatch {
    fn add(&mut self, e1: f64, e2: f64, parameters: Parameters, inverse: f64, period: f64) {
        let GainsSpec { k1, k2, k3, k4, k5, k6, k7, .. } = self.gains;
        let rate = 0.5 * (k1 + k2 * parameters.position);
        let z2 = e2 + rate * e1;
        let value = 0.5 * e1 * e1
            + 0.5 * z2 * z2 / inverse
            + 0.5 * parameters.position.powi(2) / k3
            + 0.5 * parameters.velocity.powi(2) / k7;
        if self.start_value.is_none() {
            self.start_value = Some(value);
            self.start = (e1, e2);
        }
        self.observed = self.observed.max(value);
        self.position = self.position.max(e1.abs());
        self.inverse_inertia = (self.inverse_inertia.0.min(inverse), self.inverse_inertia.1.max(inverse));
        self.reached.position = self.reached.position.max(parameters.position);
        self.reached.velocity = self.reached.velocity.max(parameters.velocity);
        if let Some((last_e1, last_e2, before, last_inverse)) = self.last {
            // The law at the tick's beginning, held over it; what the error does besides is disturbance.
            let rate = 0.5 * (k1 + k2 * before.position);
            let z2 = last_e2 + rate * last_e1;
            let damping = 0.5 * (k5 + k6 * before.velocity);
            let law = -last_e1 - damping * z2;
            let disturbance = (e2 - last_e2) / period / last_inverse - law;
            let growth = -k3 * k4 * before.position + 0.5 * k2 * k3 * last_e1 * last_e1;
            let virtual_rate = -rate * last_e2 - 0.5 * k2 * growth * last_e1; // u̇_v
            let drift = 0.5 * z2 * (1.0 / inverse - 1.0 / last_inverse) / period;
            self.disturbance = self.disturbance.max(disturbance.abs());
            self.slip = self.slip.max((e1 - last_e1 - 0.5 * period * (e2 + last_e2)).abs());
            self.uncertainty =
                self.uncertainty.max((disturbance - virtual_rate / last_inverse + drift).abs());
        }
        self.last = Some((e1, e2, parameters, inverse));
    }

    fn result(&self, period: f64) -> Lyapunov {
        let GainsSpec { k1, k2, k3, k4, k5, k6, k7, k8 } = self.gains;
        let (least, most) = self.inverse_inertia;
        // V̇ ≤ −ψV + W²/k₅ with φ₁* = φ₂* = 0: docs/control.md.
        let psi =
            [k1, 0.5 * k5 * least, 2.0 * k3 * k4, 2.0 * k7 * k8].into_iter().fold(f64::INFINITY, f64::min);
        let ultimate = self.uncertainty.powi(2) / (psi * k5);
        // The range that the run was in, by the run itself.
        let ball =
            InverseInertia::try_from(Bounds { lower: least, upper: most }).ok().and_then(|inverse_inertia| {
                let range = OperatingRange {
                    period,
                    inverse_inertia,
                    rate: Bounds { lower: 0.5 * k1, upper: 0.5 * (k1 + k2 * self.reached.position) },
                    damping: Bounds { lower: 0.5 * k5, upper: 0.5 * (k5 + k6 * self.reached.velocity) },
                };
                UltimateBound::new(&range).ok().flatten()
            });
        let position_bound = ball.map(|ball| {
            let radius = ball
                .radius_with_slip(self.disturbance, self.slip)
                .max(ball.distance(self.start.0, self.start.1));
            ball.position(radius)
        });
        Lyapunov {
            bound: ultimate.max(self.start_value.unwrap_or(0.0)),
            observed: self.observed,
            disturbance: self.disturbance,
            position_bound,
            position_observed: self.position,
        }
    }
}
