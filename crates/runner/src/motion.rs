//! The multi-rate loop: policy, reference, controller and dynamics, all integer dividers of one tick.

mod views;

use std::sync::Arc;

use adaptive_ctrl::{Command, Input, Measurement, Reference, Saturation};
use anyhow::{Context, Result};
use hiab_dynamics::{CraneModel, Data};
use jbtg::{Extrema, Interval, State};
use safezone::{Request, Source};

use crate::config::Integrator;
use crate::control::Controllers;
use crate::course::{Course, Profile};
use crate::evidence::Evidence;
use crate::feedforward::Feedforward;
use crate::governor::Governor;
use crate::interpolation::Interpolation;
use crate::machine::{FeedforwardModel, Joint, Machine};
use crate::surroundings::{Surroundings, Tick};

/// Rounds after which load and resting place agree to rounding.
const HOLDING_ROUNDS: u32 = 5;

/// The crane in motion: the simulated plant, its controllers, its reference.
///
/// One call of [`Motion::advance`] is one policy period. Nothing in it allocates.
#[derive(Debug)]
pub struct Motion {
    machine: Arc<Machine>,
    data: Data,
    controllers: Controllers,
    surroundings: Surroundings,
    profile: Profile,
    governor: Governor,
    /// Since the start \[s\].
    time: f64,
    position: Vec<f64>,
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
    /// What the controllers command.
    effort: Vec<f64>,
    /// What they commanded a tick ago, which a late command leaves in force for one tick more.
    effort_before: Vec<f64>,
    is_late: bool,
    /// What the actuators exert.
    exerted: Vec<f64>,
    /// What the crane takes that the controllers are built for: beyond that is load.
    expected: Feedforward,
    /// What the laws are told instead, if not that.
    told: Option<Feedforward>,
    /// What held the crane at the start beyond what the laws are told: they are told it from then on \[N·m or N\].
    taken_over: Vec<f64>,
    /// Where every joint should be at the end of the present tick.
    wanted: Vec<State>,
    /// Controllers' inputs and outputs of the present tick.
    references: Vec<Reference>,
    measured: Vec<Measurement>,
    commands: Vec<Command>,
    /// Scratch: velocities before the present tick.
    velocity_before: Vec<f64>,
    /// Scratch: another posture than the present one.
    undisturbed: Vec<f64>,
    /// State of every joint's reference at the beginning of the policy period.
    reference: Vec<State>,
    /// Every joint's reference from its last sample to the next.
    between: Vec<Interpolation>,
    /// This period's reference of every moving joint, in the order of the actions.
    courses: Vec<Course>,
    evidence: Evidence,
    watch_held_joints: bool,
}

impl Motion {
    /// A crane at the middle of its ranges; [`Motion::start`] puts it where it should be.
    ///
    /// `watch_held_joints` measures the tip displacement by the held joints at every sample of the reference, which
    /// costs two forward kinematics each.
    #[must_use]
    pub fn new(machine: Arc<Machine>, watch_held_joints: bool) -> Self {
        let controllers = Controllers::adaptive(&machine);
        Self::with(machine, controllers, Surroundings::calm(), Profile::JerkBounded, watch_held_joints)
    }

    /// The same with other controllers, surroundings that disturb, or another way to change velocity.
    #[must_use]
    pub fn with(
        machine: Arc<Machine>,
        controllers: Controllers,
        surroundings: Surroundings,
        profile: Profile,
        watch_held_joints: bool,
    ) -> Self {
        let joints = machine.joints().len();
        let idle = Command { effort: 0.0, saturation: Saturation::None, input: Input::Used };
        Self {
            data: machine.model().new_data(),
            controllers,
            surroundings,
            profile,
            governor: Governor::new(joints),
            time: 0.0,
            effort_before: vec![0.0; joints],
            is_late: false,
            exerted: vec![0.0; joints],
            wanted: vec![at_rest(0.0); joints],
            references: vec![Reference::default(); joints],
            measured: vec![Measurement::default(); joints],
            commands: vec![idle; joints],
            position: vec![0.0; joints],
            velocity: vec![0.0; joints],
            acceleration: vec![0.0; joints],
            effort: vec![0.0; joints],
            expected: Feedforward::new(Some(machine.believed_model()), joints),
            told: match machine.feedforward() {
                FeedforwardModel::Believed => None,
                FeedforwardModel::None => Some(Feedforward::new(None, joints)),
                FeedforwardModel::Other(model) => Some(Feedforward::new(Some(model), joints)),
            },
            taken_over: vec![0.0; joints],
            velocity_before: vec![0.0; joints],
            undisturbed: vec![0.0; joints],
            reference: vec![at_rest(0.0); joints],
            between: vec![Interpolation::at_rest(0.0); joints],
            courses: Vec::with_capacity(machine.moving().len()),
            evidence: Evidence::none(joints),
            watch_held_joints,
            machine,
        }
    }

    /// Puts the crane to rest with its references at `position`, held by its controllers.
    ///
    /// The effort that holds it then is known: what the feedforward leaves of it is added to the feedforward from then
    /// on, and every law starts without an error. Without a feedforward a joint rests a little beside its reference; the
    /// crane is put there, and its first command is what holds it. `JointController::start_holding` says how far.
    ///
    /// # Errors
    /// A position that no loop closes at, or a load that the actuators cannot hold.
    pub fn start(&mut self, position: &[f64]) -> Result<()> {
        let machine = Arc::clone(&self.machine);
        self.velocity.fill(0.0);
        self.acceleration.fill(0.0);
        self.position.copy_from_slice(position);
        for (joint, &position) in position.iter().enumerate() {
            self.reference[joint] = at_rest(position);
            self.between[joint] = Interpolation::at_rest(position);
        }
        self.expect(&machine, 0.0, 0.0)?;
        self.taken_over.fill(0.0);
        // The load depends on where the crane rests, and that a little on the load: each round leaves about a thousandth
        // of what the last one left.
        let (mut unknown, mut reference) = (vec![0.0; position.len()], vec![0.0; position.len()]);
        for _ in 0..HOLDING_ROUNDS {
            machine.model().update_dynamics(&mut self.data, &self.position, &self.velocity)?;
            self.effort.copy_from_slice(self.data.gravity_effort());
            for (joint, unknown) in unknown.iter_mut().enumerate() {
                *unknown = self.effort[joint] - self.feedforward()[joint];
            }
            if !matches!(machine.feedforward(), FeedforwardModel::None) {
                // Refuses what the actuators cannot hold at all.
                self.controllers.hold(&machine, &self.position, &self.effort, &mut reference)?;
                self.taken_over.copy_from_slice(&unknown);
                unknown.fill(0.0);
            }
            self.controllers.hold(&machine, &self.position, &unknown, &mut reference)?;
            for (joint, reference) in reference.iter().enumerate() {
                self.position[joint] += position[joint] - reference;
            }
        }
        self.time = 0.0;
        let load = self.effort.iter().zip(self.expected.effort()).map(|(held, expected)| held - expected);
        let limits = machine.joints().iter().map(|joint| joint.effort_limit);
        self.governor.start(load.zip(limits));
        self.is_late = false;
        self.effort_before.copy_from_slice(&self.effort);
        self.exerted.copy_from_slice(&self.effort);
        for (joint, setup) in machine.joints().iter().enumerate() {
            let point = |value| Interval { min: value, max: value };
            let extrema = Extrema {
                position: point(position[joint]),
                velocity: point(0.0),
                acceleration: point(0.0),
                jerk: point(0.0),
            };
            self.evidence.add_reference(joint, &extrema, &setup.limits, &setup.limits);
        }
        Ok(())
    }

    /// One policy period under `actions`, one for each moving joint.
    ///
    /// # Errors
    /// The simulated crane left the range in which its loops close: the limits were not kept.
    ///
    /// # Panics
    /// `actions` has another length than there are moving joints.
    pub fn advance(&mut self, actions: &[Request]) -> Result<()> {
        self.advance_seen(actions, |_| {})
    }

    /// [`Motion::advance`], and `see` is shown the motion after every tick.
    ///
    /// # Errors
    /// As there.
    ///
    /// # Panics
    /// As there.
    pub fn advance_seen(&mut self, actions: &[Request], mut see: impl FnMut(&Self)) -> Result<()> {
        let machine = Arc::clone(&self.machine);
        assert_eq!(actions.len(), machine.moving().len(), "one action for each moving joint");
        self.plan(&machine, actions)?;
        let rates = machine.rates();
        let tick_period = rates.tick_period();
        let mut sampled_at = 0;
        for tick in 0..rates.policy_divider {
            if tick % rates.reference_divider == 0 {
                sampled_at = tick;
                self.sample(&machine, tick);
                if self.watch_held_joints {
                    self.measure_held_joints(&machine)?;
                }
            }
            if tick % rates.controller_divider == 0 {
                self.control(&machine, f64::from(tick - sampled_at) * tick_period)?;
            }
            self.integrate(&machine, tick_period)?;
            self.witness(&machine, f64::from(tick + 1 - sampled_at) * tick_period, tick_period);
            see(self);
        }
        for (&joint, course) in machine.moving().iter().zip(&self.courses) {
            self.reference[joint] = course.end();
        }
        Ok(())
    }

    /// Chooses each moving joint's next velocity within its safe range, and plans the way there.
    fn plan(&mut self, machine: &Machine, actions: &[Request]) -> Result<()> {
        self.courses.clear();
        let errors = self.position.iter().zip(&self.reference).map(|(at, wanted)| at - wanted.position);
        // Part of the generator: actions that are sent on without it are slowed by nothing.
        let is_gentle = self.governor.judge(errors) && self.profile == Profile::JerkBounded;
        for (&joint, &action) in machine.moving().iter().zip(actions) {
            let setup = &machine.joints()[joint];
            let State { position, velocity, .. } = self.reference[joint];
            let command = setup.zone.command(position, velocity, action);
            let range = command.range;
            self.evidence.ranges += 1;
            self.evidence.narrowed_ranges += u64::from(range.narrowed);
            self.evidence.empty_ranges += u64::from(!(range.min <= range.max));
            self.evidence.failsafe_commands += u64::from(matches!(command.source, Source::FailSafe(_)));
            self.evidence.clamped_actions +=
                u64::from(matches!(command.source, Source::PolicyClamped { .. }));
            let velocity = if is_gentle {
                // The gentle zone where it can have its way, the full one in any case.
                let wanted = setup.gentle_zone.command(position, velocity, action).velocity;
                wanted.clamp(range.min, range.max)
            } else {
                command.velocity
            };
            let course = self.course(setup, joint, velocity)?;
            self.courses.push(course);
        }
        Ok(())
    }

    /// The way of one joint to `velocity`.
    fn course(&mut self, setup: &Joint, joint: usize, wanted: f64) -> Result<Course> {
        let State { position, velocity, .. } = self.reference[joint];
        let planner = setup.zone.planner();
        let period = self.machine.rates().policy_period();
        match self.profile {
            Profile::JerkBounded => {
                let trajectory = planner.ramp(position, velocity, wanted).with_context(|| {
                    format!("{}: the zone allowed what the generator cannot do", setup.name)
                })?;
                let extrema = trajectory.extrema();
                self.evidence.add_reference(joint, &extrema, &setup.limits, planner.limits());
                Ok(Course::JerkBounded(trajectory))
            }
            Profile::Step => Ok(Course::ramp(position, velocity, wanted, period, None)),
            Profile::Trapezoid => {
                let limit = planner.limits().acceleration().max;
                Ok(Course::ramp(position, velocity, wanted, period, Some(limit)))
            }
        }
    }

    /// Samples the reference of the moving joints at `tick` of this period, and one sample ahead.
    fn sample(&mut self, machine: &Machine, tick: u32) {
        let rates = machine.rates();
        let time = |tick: u32| f64::from(tick) * rates.tick_period();
        let next = (tick + rates.reference_divider).min(rates.policy_divider);
        for (&joint, course) in machine.moving().iter().zip(&self.courses) {
            let end = if next == rates.policy_divider { course.end() } else { course.state_at(time(next)) };
            self.between[joint] = Interpolation::new(course.state_at(time(tick)), end, time(next - tick));
        }
    }

    /// One command of every controller, `ahead` of the reference's last sample.
    fn control(&mut self, machine: &Machine, ahead: f64) -> Result<()> {
        let tick = self.surroundings.tick();
        if tick == Tick::Dropped {
            return Ok(());
        }
        self.is_late = tick == Tick::Late;
        self.effort_before.copy_from_slice(&self.effort);
        let period = machine.rates().controller_period();
        self.expect(machine, ahead, period)?;
        for joint in 0..self.between.len() {
            let wanted = self.between[joint].state_at(ahead);
            self.references[joint] = Reference {
                position: wanted.position,
                velocity: wanted.velocity,
                acceleration: self.between[joint].state_at(ahead + 0.5 * period).acceleration,
                effort: self.feedforward()[joint] + self.taken_over[joint],
            };
            let (position, velocity) = self.surroundings.sensed(self.position[joint], self.velocity[joint]);
            self.measured[joint] = Measurement { position, velocity };
        }
        self.controllers.step(&self.references, &self.measured, &mut self.commands)?;
        self.governor.tick();
        for (joint, command) in self.commands.iter().enumerate() {
            let limit = machine.joints()[joint].effort_limit;
            self.governor.note(joint, self.expected.effort()[joint], command, limit);
            self.effort[joint] = command.effort;
            self.evidence.commands += 1;
            self.evidence.saturated_commands += u64::from(command.saturation != Saturation::None);
        }
        Ok(())
    }

    /// The effort that the reference takes, `ahead` of its last sample and for `period` from then: as the crane is
    /// believed to be, and as the laws are told.
    fn expect(&mut self, machine: &Machine, ahead: f64, period: f64) -> Result<()> {
        self.expected.update(Some(machine.believed_model()), &self.between, ahead, period)?;
        match (machine.feedforward(), &mut self.told) {
            (FeedforwardModel::Other(model), Some(told)) => {
                told.update(Some(model), &self.between, ahead, period)
            }
            _ => Ok(()),
        }
    }

    /// What the laws are told of it [N·m or N].
    fn feedforward(&self) -> &[f64] {
        self.told.as_ref().unwrap_or(&self.expected).effort()
    }

    fn integrate(&mut self, machine: &Machine, period: f64) -> Result<()> {
        self.velocity_before.copy_from_slice(&self.velocity);
        let commanded = if self.is_late { &self.effort_before } else { &self.effort };
        for (joint, (exerted, &effort)) in self.exerted.iter_mut().zip(commanded).enumerate() {
            *exerted = self.surroundings.exerted(joint, effort, self.time);
        }
        self.is_late = false;
        let wrench = self.surroundings.tip_wrench(self.time);
        let step = match machine.rates().integrator {
            Integrator::SemiImplicitEuler => CraneModel::semi_implicit_euler,
            Integrator::Rk4 => CraneModel::rk4,
        };
        let (position, velocity) = (&mut self.position, &mut self.velocity);
        step(machine.model(), &mut self.data, position, velocity, &self.exerted, wrench.as_ref(), period)
            .context("the simulated crane cannot go on")?;
        self.time += period;
        Ok(())
    }

    /// Notes where every joint really is after a tick, `ahead` of the reference's last sample.
    ///
    /// The effort is held over a tick, so the acceleration is the change of velocity over it, and the jerk the change of
    /// acceleration from one tick to the next.
    fn witness(&mut self, machine: &Machine, ahead: f64, period: f64) {
        for (joint, setup) in machine.joints().iter().enumerate() {
            let acceleration = (self.velocity[joint] - self.velocity_before[joint]) / period;
            let actual = State {
                position: self.position[joint],
                velocity: self.velocity[joint],
                acceleration,
                jerk: (acceleration - self.acceleration[joint]) / period,
            };
            self.acceleration[joint] = acceleration;
            let reference = self.between[joint].state_at(ahead);
            self.wanted[joint] = reference;
            self.evidence.add_actual(joint, &actual, &reference, &setup.limits);
        }
    }

    /// Displacement of the tip by the errors of all held joints together.
    fn measure_held_joints(&mut self, machine: &Machine) -> Result<()> {
        self.undisturbed.copy_from_slice(&self.position);
        for &joint in machine.held() {
            self.undisturbed[joint] = self.reference[joint].position;
        }
        machine.model().update_kinematics(&mut self.data, &self.undisturbed, &self.velocity)?;
        let wanted = machine.model().tip_pose(&self.data).position;
        machine.model().update_kinematics(&mut self.data, &self.position, &self.velocity)?;
        let found = machine.model().tip_pose(&self.data).position;
        let error = wanted.iter().zip(found).map(|(w, f)| (w - f).powi(2)).sum::<f64>().sqrt();
        self.evidence.held_joint_tip_error = self.evidence.held_joint_tip_error.max(error);
        Ok(())
    }

    /// Tip position \[m\] and velocity [m/s] in the world, and angle \[rad\] and angular velocity [rad/s] of every boom.
    ///
    /// # Errors
    /// A loop does not close here.
    pub fn look(
        &mut self,
        boom_angle: &mut [f64],
        boom_velocity: &mut [f64],
    ) -> Result<([f64; 3], [f64; 3])> {
        let machine = Arc::clone(&self.machine);
        machine.model().update_kinematics(&mut self.data, &self.position, &self.velocity)?;
        for (boom, &joint) in machine.booms().iter().enumerate() {
            boom_angle[boom] = self.data.tree_position()[joint];
            boom_velocity[boom] = self.data.tree_velocity()[joint];
        }
        let model = machine.model();
        Ok((model.tip_pose(&self.data).position, model.tip_velocity(&self.data).linear))
    }

    /// Tip position in the world \[m\] with every joint at `posture`.
    ///
    /// # Errors
    /// A loop does not close there.
    pub fn tip_at(&mut self, posture: &[f64]) -> Result<[f64; 3]> {
        self.undisturbed.fill(0.0);
        self.machine.model().update_kinematics(&mut self.data, posture, &self.undisturbed)?;
        Ok(self.machine.model().tip_pose(&self.data).position)
    }

    /// Takes what was seen since the last call.
    pub fn take_evidence(&mut self) -> Evidence {
        std::mem::replace(&mut self.evidence, Evidence::none(self.position.len()))
    }
}

fn at_rest(position: f64) -> State {
    State { position, velocity: 0.0, acceleration: 0.0, jerk: 0.0 }
}
