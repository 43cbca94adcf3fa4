//! What the crane is over its workspace: extremes of inertia, angles and speeds.

use anyhow::Result;
use hiab_dynamics::{Actuator, CraneModel};
use jbtg::Interval;

/// Postures per moving joint at which the crane is surveyed.
const SURVEY_POINTS: usize = 7;

/// Most postures that inertia is surveyed at: all ends and middles of eight joints.
const MAX_CORNERS: u64 = 6561;

/// Steps through the corners if they are more: a large prime.
const STRIDE: u64 = 2_147_483_647;

/// Extremes over the postures that the task visits; of inertia over all that the crane can reach.
#[derive(Debug)]
pub(super) struct Survey {
    /// Range of the diagonal of M⁻¹, by joint.
    pub(super) inverse_inertia: Vec<Interval>,
    /// Range of every boom's angle \[rad\].
    pub(super) boom_angle: Vec<Interval>,
    /// Largest angular velocity of every boom [rad/s].
    pub(super) boom_speed: Vec<f64>,
    /// Largest tip speed that a single moving joint causes [m/s].
    pub(super) tip_speed: f64,
}

/// Visits a grid of postures: every moving joint over its range, with and without the payload; and the corners of all
/// that the crane can reach.
pub(super) fn survey(
    model: &CraneModel,
    believed: &CraneModel,
    moving: &[usize],
    booms: &[usize],
    rest_posture: &[f64],
) -> Result<Survey> {
    let joints = model.actuators().len();
    let empty = Interval::new(f64::INFINITY, f64::NEG_INFINITY);
    let mut survey = Survey {
        inverse_inertia: vec![empty; joints],
        boom_angle: vec![empty; booms.len()],
        boom_speed: vec![0.0; booms.len()],
        tip_speed: 0.0,
    };
    let still = vec![0.0; joints];
    let mut jacobian = vec![0.0; 6 * joints];
    for model in [model, believed] {
        let mut data = model.new_data();
        for number in 0..SURVEY_POINTS.pow(moving.len() as u32) {
            let mut posture = rest_posture.to_vec();
            let mut rest = number;
            for &joint in moving {
                let actuator = &model.actuators()[joint];
                let share = (rest % SURVEY_POINTS) as f64 / (SURVEY_POINTS - 1) as f64;
                posture[joint] = actuator.lower() + share * (actuator.upper() - actuator.lower());
                rest /= SURVEY_POINTS;
            }
            model.update_kinematics(&mut data, &posture, &still)?;
            for (boom, &tree_joint) in booms.iter().enumerate() {
                let limit = model.actuators()[model.driving_actuator(tree_joint)].velocity_limit();
                let speed = data.tree_slope()[tree_joint].abs() * limit;
                survey.boom_angle[boom] = survey.boom_angle[boom].including(data.tree_position()[tree_joint]);
                survey.boom_speed[boom] = survey.boom_speed[boom].max(speed);
            }
            model.tip_jacobian(&data, &mut jacobian)?;
            for &joint in moving {
                let column = [jacobian[joint], jacobian[joints + joint], jacobian[2 * joints + joint]];
                let speed = column.iter().map(|x| x * x).sum::<f64>().sqrt();
                let limit = model.actuators()[joint].velocity_limit();
                survey.tip_speed = survey.tip_speed.max(speed * limit);
            }
        }
    }
    survey_inertia(believed, &mut survey)?;
    Ok(survey)
}

/// Ranges of inertia of the crane that the controllers are built for: no payload, and held joints turned, too.
fn survey_inertia(believed: &CraneModel, survey: &mut Survey) -> Result<()> {
    let still = vec![0.0; believed.actuators().len()];
    let (mut data, mut diagonal) = (believed.new_data(), still.clone());
    for posture in corner_postures(believed) {
        believed.update_dynamics(&mut data, &posture, &still)?;
        believed.inverse_effective_inertia(&mut data, &mut diagonal)?;
        for (range, &value) in survey.inverse_inertia.iter_mut().zip(&diagonal) {
            *range = range.including(value);
        }
    }
    Ok(())
}

/// Postures over all that the crane can reach: every joint at its ends and its middle, or, if those are too many, a
/// part of them that is spread evenly.
pub fn corner_postures(model: &CraneModel) -> impl Iterator<Item = Vec<f64>> {
    let actuators = model.actuators();
    let total = 3_u64.pow(actuators.len() as u32);
    (0..total.min(MAX_CORNERS)).map(move |number| {
        // Coprime to 3, so no posture comes twice.
        let mut rest = number * STRIDE % total;
        let at = |actuator: &Actuator| {
            let share = (rest % 3) as f64 / 2.0;
            rest /= 3;
            actuator.lower() + share * (actuator.upper() - actuator.lower())
        };
        actuators.iter().map(at).collect()
    })
}

#[cfg(test)]
mod tests {
    use crate::config::ConfigSpec;
    use crate::draw::{Purpose, Stream};
    use crate::machine::Machine;
    use crate::stage::Stage;

    /// How far a posture between the corners may lie outside of what they span. Where a joint is 6 % heavier, a damping
    /// ratio of 0.5 is 0.485; where it is 10 % lighter, a gain margin of 4 is 3.6.
    const BETWEEN_CORNERS: [(&str, f64); 2] = [("default", 0.06), ("excavator", 0.1)];

    #[test]
    fn hardly_any_posture_is_lighter_or_heavier_than_surveyed() {
        for (config, between) in BETWEEN_CORNERS {
            let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
            std::env::set_current_dir(root).unwrap();
            let config = ConfigSpec::read(format!("assets/config/{config}.ron").as_ref()).unwrap();
            let machine = Machine::load(&config).unwrap();
            let (model, mut draws) =
                (machine.believed_model(), Stream::of_episode(1, Purpose::Evaluation, Stage::Orange, 0));
            let still = vec![0.0; model.actuators().len()];
            let (mut data, mut inverse) = (model.new_data(), still.clone());
            for _ in 0..5000 {
                let posture: Vec<f64> = model
                    .actuators()
                    .iter()
                    .map(|actuator| draws.uniform(actuator.lower(), actuator.upper()))
                    .collect();
                model.update_dynamics(&mut data, &posture, &still).unwrap();
                model.inverse_effective_inertia(&mut data, &mut inverse).unwrap();
                for (joint, &found) in machine.joints().iter().zip(&inverse) {
                    let known = joint.spec.inverse_inertia;
                    let inside = known.min() * (1.0 - between)..=known.max() * (1.0 + between);
                    assert!(inside.contains(&found), "{}: {found} at {posture:?}, {known:?}", joint.name);
                }
            }
        }
    }
}
