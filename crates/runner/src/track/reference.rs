//! The references of the scenarios, as actions per policy step.

use std::collections::VecDeque;

use anyhow::{Context, Result, ensure};
use hiab_dynamics::Data;
use safezone::Request;

use super::action::action_for;
use super::scenario::{Recording, Reference};
use crate::machine::Machine;
use crate::motion::Motion;

/// How fast the tip goes back to its side of the square [1/s].
const RETURN_RATE: f64 = 2.0;

/// Weight against large velocities near singular postures, of the velocity limits [m/s].
const DAMPING: f64 = 0.05;

/// Actions of one part of a scenario: from a start, until they end.
#[derive(Debug)]
pub struct Part {
    /// Position of every joint at the start [rad or m].
    pub start: Vec<f64>,
    course: Actions,
}

#[derive(Debug)]
enum Actions {
    Recorded(VecDeque<Vec<f32>>),
    Chirp { steps: u32, step: u32, period: f64, from_hz: f64, to_hz: f64, ratio: f64 },
    Square(Box<Square>),
    Rest { steps: u32 },
}

/// The tip on its way round a square.
#[derive(Debug)]
struct Square {
    data: Data,
    /// The tip's way: corners in the crane's plane \[m\], the next one first.
    corners: VecDeque<[f64; 2]>,
    /// Where the tip should be.
    point: [f64; 2],
    speed: f64,
    period: f64,
}

/// The parts of a reference.
///
/// # Errors
/// A recorded episode is missing or made for another machine, or a start has not one number for each moving joint.
pub fn parts(reference: &Reference, machine: &Machine) -> Result<Vec<Part>> {
    let period = machine.rates().policy_period();
    let steps = |duration: f64| (duration / period).round() as u32;
    let from = |start: &[f64], course: Actions| -> Result<Vec<Part>> {
        Ok(vec![Part { start: posture(start, machine)?, course }])
    };
    match reference {
        Reference::Episodes(files) => {
            let names: Vec<&str> =
                machine.moving().iter().map(|&joint| machine.joints()[joint].name.as_str()).collect();
            let part = |file: &std::path::PathBuf| {
                let recording = Recording::read(file, &names, period)?;
                let start: Vec<f64> = names.iter().map(|name| recording.start[*name]).collect();
                let course = Actions::Recorded(recording.actions.into());
                Ok(Part { start: posture(&start, machine)?, course })
            };
            files.iter().map(part).collect()
        }
        Reference::Chirp { start, duration, from_hz, to_hz, ratio } => {
            let (from_hz, to_hz, ratio) = (*from_hz, *to_hz, *ratio);
            from(start, Actions::Chirp { steps: steps(*duration), step: 0, period, from_hz, to_hz, ratio })
        }
        Reference::Rest { start, duration } => from(start, Actions::Rest { steps: steps(*duration) }),
        Reference::Square { start, side, speed, rounds } => {
            let posture = posture(start, machine)?;
            let model = machine.model();
            let mut data = model.new_data();
            model.update_kinematics(&mut data, &posture, &vec![0.0; posture.len()])?;
            let [x, _, z] = model.tip_pose(&data).position;
            let round = [[x + side, z], [x + side, z + side], [x, z + side], [x, z]];
            let corners = (0..*rounds).flat_map(|_| round).collect();
            let square = Square { data, corners, point: [x, z], speed: *speed, period };
            from(start, Actions::Square(Box::new(square)))
        }
    }
}

/// Every joint's position, with the moving ones at `start`.
fn posture(start: &[f64], machine: &Machine) -> Result<Vec<f64>> {
    ensure!(
        start.len() == machine.moving().len(),
        "reference.start has {} numbers, must have one for each of the {} moving joints",
        start.len(),
        machine.moving().len()
    );
    let mut posture = machine.rest_posture().to_vec();
    for (&joint, &position) in machine.moving().iter().zip(start) {
        let setup = &machine.joints()[joint];
        let range = setup.zone.planner().limits().position();
        ensure!(
            (range.min..=range.max).contains(&position),
            "reference.start of {} is {position}, outside [{}, {}]",
            setup.name,
            range.min,
            range.max
        );
        posture[joint] = position;
    }
    Ok(posture)
}

impl Part {
    /// Writes the actions of the next policy step; false once there are none.
    ///
    /// # Errors
    /// The crane cannot be where its reference is.
    pub fn next(&mut self, motion: &Motion, actions: &mut [Request]) -> Result<bool> {
        match &mut self.course {
            Actions::Recorded(recorded) => {
                let Some(step) = recorded.pop_front() else { return Ok(false) };
                for (action, value) in actions.iter_mut().zip(step) {
                    *action = Request::Action(f64::from(value));
                }
            }
            Actions::Chirp { steps, step, period, from_hz, to_hz, ratio } => {
                if *step == *steps {
                    return Ok(false);
                }
                let (t, end) = (f64::from(*step) * *period, f64::from(*steps) * *period);
                // Phase of a frequency that grows with time.
                let cycles = *from_hz * t + 0.5 * (*to_hz - *from_hz) * t * t / end;
                for (joint, action) in actions.iter_mut().enumerate() {
                    let phase = std::f64::consts::TAU * cycles * ratio.powi(joint as i32);
                    *action = Request::Action(phase.sin());
                }
                *step += 1;
            }
            Actions::Rest { steps } => {
                if *steps == 0 {
                    return Ok(false);
                }
                *steps -= 1;
                stop(motion, actions);
            }
            Actions::Square(square) => return square.next(motion, actions),
        }
        Ok(true)
    }
}

/// Actions that bring every moving joint to rest.
pub fn stop(motion: &Motion, actions: &mut [Request]) {
    let machine = motion.machine();
    for (action, &joint) in actions.iter_mut().zip(machine.moving()) {
        let now = motion.reference()[joint];
        let range = machine.joints()[joint].zone.range(now.position, now.velocity);
        *action = Request::Action(action_for(&range, range.brake));
    }
}

impl Square {
    fn next(&mut self, motion: &Motion, actions: &mut [Request]) -> Result<bool> {
        let Some(&corner) = self.corners.front() else { return Ok(false) };
        let machine = motion.machine();
        let (model, joints) = (machine.model(), machine.joints().len());
        let position: Vec<f64> = motion.reference().iter().map(|state| state.position).collect();
        model
            .update_kinematics(&mut self.data, &position, &vec![0.0; joints])
            .context("the reference left the range in which loops close")?;
        let [x, _, z] = model.tip_pose(&self.data).position;
        let mut jacobian = vec![0.0; 6 * joints];
        model.tip_jacobian(&self.data, &mut jacobian)?;
        // The point goes on along its side; the tip follows it.
        let way = [corner[0] - self.point[0], corner[1] - self.point[1]];
        let left = way[0].hypot(way[1]);
        let stride = (self.speed * self.period).min(left);
        if left > 0.0 {
            self.point = [self.point[0] + way[0] * stride / left, self.point[1] + way[1] * stride / left];
        }
        if left <= stride {
            self.corners.pop_front();
        }
        let along = if left > 0.0 { stride / self.period / left } else { 0.0 };
        let wanted = [
            way[0] * along + RETURN_RATE * (self.point[0] - x),
            way[1] * along + RETURN_RATE * (self.point[1] - z),
        ];
        // Damped least squares: ẏ = Jᵀ(JJᵀ + λ²)⁻¹·v.
        let column = |&joint: &usize| [jacobian[joint], jacobian[2 * joints + joint]];
        let columns: Vec<[f64; 2]> = machine.moving().iter().map(column).collect();
        let mut square = [DAMPING * DAMPING, 0.0, DAMPING * DAMPING];
        for [jx, jz] in &columns {
            square = [square[0] + jx * jx, square[1] + jx * jz, square[2] + jz * jz];
        }
        let determinant = square[0] * square[2] - square[1] * square[1];
        let y = [
            (square[2] * wanted[0] - square[1] * wanted[1]) / determinant,
            (square[0] * wanted[1] - square[1] * wanted[0]) / determinant,
        ];
        for ((action, &joint), [jx, jz]) in actions.iter_mut().zip(machine.moving()).zip(&columns) {
            let now = motion.reference()[joint];
            let range = machine.joints()[joint].zone.range(now.position, now.velocity);
            *action = Request::Action(action_for(&range, jx * y[0] + jz * y[1]));
        }
        Ok(true)
    }
}
