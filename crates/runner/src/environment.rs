//! The task as an environment: start, observe, act, be rewarded.

use std::sync::Arc;

use anyhow::{Result, bail};
use safezone::Request;

use crate::draw::Stream;
use crate::evidence::Evidence;
use crate::machine::Machine;
use crate::motion::Motion;
use crate::observation::{Features, Scaling};
use crate::region::Polygon;

/// Draws of strokes until one puts the tip into the region; regions fill more than a thousandth of the workspace.
const MAX_DRAWS: u32 = 100_000;

/// Where an episode starts and what it aims at.
#[derive(Clone, Debug, PartialEq)]
pub struct Episode {
    /// Position of every joint at the start [rad or m].
    pub start: Vec<f64>,
    /// Target in the world \[m\], in the plane that the tip moves in.
    pub target: [f64; 3],
}

/// How an episode ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The tip was at the target and slow enough.
    Reached,
    /// The steps were used up.
    TimeOut,
    /// An actuator has less effort than its load takes ([`Motion::overload`] says which): the brakes are set.
    Overload,
}

/// What one step brought.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Reward of the step.
    pub reward: f64,
    /// Set if the episode is over.
    pub ending: Option<Ending>,
}

/// A crane with a target.
#[derive(Debug)]
pub struct Environment {
    machine: Arc<Machine>,
    motion: Motion,
    target: [f64; 3],
    steps: u32,
    boom_angle: Vec<f64>,
    boom_velocity: Vec<f64>,
    tip: Tip,
}

/// The tip in the world [m, m/s].
#[derive(Clone, Copy, Debug, Default)]
struct Tip {
    position: [f64; 3],
    velocity: [f64; 3],
}

impl Environment {
    /// An environment without an episode; [`Environment::start`] begins one.
    #[must_use]
    pub fn new(machine: Arc<Machine>, watch_held_joints: bool) -> Self {
        let booms = machine.booms().len();
        Self {
            motion: Motion::new(Arc::clone(&machine), watch_held_joints),
            target: [0.0; 3],
            steps: 0,
            boom_angle: vec![0.0; booms],
            boom_velocity: vec![0.0; booms],
            tip: Tip::default(),
            machine,
        }
    }

    /// Draws an episode: start and target both in `region`, both where the crane can be.
    ///
    /// The strokes of the moving joints are drawn uniformly in the reference's limits until the tip lies in the region,
    /// once for the start and once for the target, so every target can be reached.
    ///
    /// # Errors
    /// The region holds next to nothing that the tip can reach.
    pub fn draw(&mut self, region: &Polygon, stream: &mut Stream) -> Result<Episode> {
        let (start, _) = self.draw_posture(region, stream)?;
        let (_, target) = self.draw_posture(region, stream)?;
        Ok(Episode { start, target })
    }

    fn draw_posture(&mut self, region: &Polygon, stream: &mut Stream) -> Result<(Vec<f64>, [f64; 3])> {
        let machine = Arc::clone(&self.machine);
        let mut posture = machine.rest_posture().to_vec();
        for _ in 0..MAX_DRAWS {
            for &joint in machine.moving() {
                let range = machine.joints()[joint].zone.planner().limits().position();
                posture[joint] = stream.uniform(range.min, range.max);
            }
            let tip = self.motion.tip_at(&posture)?;
            if region.contains(in_plane(tip).into()) {
                return Ok((posture, tip));
            }
        }
        bail!("the tip was in the region in none of {MAX_DRAWS} random postures; is the region reachable?")
    }

    /// Begins an episode.
    ///
    /// # Errors
    /// The crane cannot rest where the episode starts.
    pub fn start(&mut self, episode: &Episode) -> Result<()> {
        self.motion.start(&episode.start)?;
        self.target = episode.target;
        self.steps = 0;
        self.look()
    }

    /// One policy period under `action`, one number in [-1, 1] for each moving joint.
    ///
    /// # Errors
    /// The simulated crane left the range in which its loops close.
    pub fn step(&mut self, action: &[f32]) -> Result<Step> {
        self.step_seen(action, |_| {})
    }

    /// [`Environment::step`], and `see` is shown the motion after every tick.
    ///
    /// # Errors
    /// As there.
    pub fn step_seen(&mut self, action: &[f32], see: impl FnMut(&Motion)) -> Result<Step> {
        let mut commands = [Request::Missing; MAX_MOVING];
        for (command, &value) in commands.iter_mut().zip(action) {
            *command = Request::Action(f64::from(value));
        }
        self.motion.advance_seen(&commands[..action.len()], see)?;
        self.steps += 1;
        self.look()?;
        let machine = &self.machine;
        let task = machine.task();
        let speed = self.speed();
        let reached = self.distance() <= task.reach_distance && speed < task.reach_speed;
        let ending = if reached {
            Some(Ending::Reached)
        } else if self.motion.overload().is_some() {
            Some(Ending::Overload)
        } else if self.steps >= task.max_steps {
            Some(Ending::TimeOut)
        } else {
            None
        };
        let effort = machine
            .moving()
            .iter()
            .map(|&joint| (self.motion.effort()[joint] / machine.joints()[joint].effort_limit).powi(2))
            .sum::<f64>()
            .sqrt();
        let weights = machine.reward();
        let reward = if reached { weights.success } else { 0.0 }
            - weights.effort * effort
            - weights.distance * self.distance()
            - weights.speed * speed;
        Ok(Step { reward, ending })
    }

    /// The policy's input. Shape: `[scaling.len()]`.
    pub fn observe(&self, scaling: &Scaling, input: &mut [f32]) {
        let features = Features {
            effort: self.motion.effort(),
            position: self.motion.position(),
            boom_angle: &self.boom_angle,
            velocity: self.motion.velocity(),
            boom_velocity: &self.boom_velocity,
            tip: in_plane(self.tip.position),
            tip_velocity: in_plane(self.tip.velocity),
            target_from_tip: in_plane(std::array::from_fn(|axis| {
                self.target[axis] - self.tip.position[axis]
            })),
            distance: self.distance(),
        };
        scaling.apply(&features, input);
    }

    /// Distance of tip and target \[m\].
    #[must_use]
    pub fn distance(&self) -> f64 {
        norm(std::array::from_fn(|axis| self.tip.position[axis] - self.target[axis]))
    }

    /// Speed of the tip [m/s].
    #[must_use]
    pub fn speed(&self) -> f64 {
        norm(self.tip.velocity)
    }

    /// Tip position in the world \[m\].
    #[must_use]
    pub fn tip(&self) -> [f64; 3] {
        self.tip.position
    }

    /// Speed of the tip [m/s].
    #[must_use]
    pub fn tip_speed(&self) -> f64 {
        norm(self.tip.velocity)
    }

    /// The crane in motion.
    #[must_use]
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// Steps of the present episode.
    #[must_use]
    pub fn steps(&self) -> u32 {
        self.steps
    }

    /// Takes what was seen since the last call.
    pub fn take_evidence(&mut self) -> Evidence {
        self.motion.take_evidence()
    }

    /// Looks where tip and booms are now.
    fn look(&mut self) -> Result<()> {
        let (position, velocity) = self.motion.look(&mut self.boom_angle, &mut self.boom_velocity)?;
        self.tip = Tip { position, velocity };
        Ok(())
    }
}

/// Most joints that a policy may move.
pub const MAX_MOVING: usize = 16;

fn norm(vector: [f64; 3]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The part of a vector in the crane's plane at slew 0.
fn in_plane([x, _, z]: [f64; 3]) -> [f64; 2] {
    [x, z]
}
