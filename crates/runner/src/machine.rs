//! The crane with its limits, safe zones and controllers, put together from the files that a configuration names.

mod survey;

use std::path::Path;

use adaptive_ctrl::{AdaptiveController, Bounds, EffortLimits, GainTable, Gains, InverseInertia, JointSpec};
use anyhow::{Context, Result, anyhow, ensure};
use hiab_dynamics::{Actuator, CraneModel, LoopFile, PlantFile};
use jbtg::{Interval, Limits, LimitsSpec, Planner, PlannerSpec, SymmetricLimits};
use safezone::{BrakingTable, SafeZone};

use crate::config::{ConfigSpec, Feedforward, Rates, Reward, Task, TrackingMargin, read_ron};
use crate::environment::MAX_MOVING;
use crate::governor::GENTLE;
use crate::observation::{Scaling, ScalingSpec};
use crate::region::Regions;
use crate::store;

pub use survey::corner_postures;
use survey::{Survey, survey};

/// Reach distances that count as near when the policy is shown where the target is.
const NEAR: f64 = 10.0;

/// One joint of the machine.
#[derive(Debug)]
pub struct Joint {
    /// Name as in the URDF.
    pub name: String,
    /// Limits of its actuator.
    pub limits: Limits,
    /// Largest effort of its actuator, both signs [N·m or N].
    pub effort_limit: f64,
    /// Its safe velocities. The limits there are the actuator's less the tracking margin.
    pub zone: SafeZone<'static>,
    /// The same for gentle accelerations, which effort suffices for under load.
    pub gentle_zone: SafeZone<'static>,
    /// What its controller is told about it.
    pub spec: JointSpec,
    /// Its gains of the adaptive law.
    pub gains: Gains,
    /// Its controller, as built.
    pub controller: AdaptiveController,
}

/// Where braking distances come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Zones {
    /// The tables on disk, checked against the configuration.
    FromTables,
    /// Their closed form, for a motion that no tables were built for.
    ClosedForm,
}

/// What the laws of single joints are told of the effort that the reference takes.
#[derive(Clone, Debug)]
pub enum FeedforwardModel {
    /// Nothing: the paper's law.
    None,
    /// What the crane takes without payload, [`Machine::believed_model`].
    Believed,
    /// What another crane takes.
    Other(Box<CraneModel>),
}

/// Everything about the crane that does not change while it moves.
#[derive(Debug)]
pub struct Machine {
    model: CraneModel,
    believed: CraneModel,
    feedforward: FeedforwardModel,
    joints: Vec<Joint>,
    moving: Vec<usize>,
    held: Vec<usize>,
    booms: Vec<usize>,
    rest_posture: Vec<f64>,
    survey: Survey,
    rates: Rates,
    task: Task,
    reward: Reward,
    regions: Regions,
}

impl Machine {
    /// Loads the crane that a configuration names.
    ///
    /// # Errors
    /// A file is missing or wrong, a name in one is not in another, a braking table is stale, or a controller would
    /// not be stable; the message names file, field and cause.
    pub fn load(config: &ConfigSpec) -> Result<Self> {
        Self::load_with(config, Zones::FromTables)
    }

    /// [`Machine::load`], with braking distances from where `zones` says.
    ///
    /// # Errors
    /// As there; in closed form also a timing or jerk limits that have none.
    pub fn load_with(config: &ConfigSpec, zones: Zones) -> Result<Self> {
        let crane = &config.crane;
        let model = load_model(config)?;
        let gains: GainTable = read_ron(&crane.gains)?;
        let regions: Regions = read_ron(&crane.regions)?;
        let loops: LoopFile = read_ron(&crane.loops)?;
        let (moving, held, rest_posture) = assign_joints(&model, &config.task)?;
        let booms = loops
            .closed_loops
            .iter()
            .filter_map(|closed_loop| closed_loop.dependent.first())
            .filter_map(|joint| model.tree_joint_index(joint))
            .collect::<Vec<_>>();
        let believed = load_unloaded_model(config)?;
        let survey = survey(&model, &believed, &moving, &booms, &rest_posture)?;
        let names: Vec<&str> = model.actuators().iter().map(Actuator::name).collect();
        let gains = gains.in_order(&names).with_context(|| crane.gains.display().to_string())?;
        let period = config.rates.controller_period();
        let joints = model
            .actuators()
            .iter()
            .zip(gains)
            .zip(&survey.inverse_inertia)
            .map(|((actuator, gains), inertia)| {
                let limits = actuator_limits(actuator).with_context(|| in_loops(crane, actuator))?;
                let zone = match zones {
                    Zones::FromTables => load_zone(config, actuator)?,
                    Zones::ClosedForm => SafeZone::closed_form(planner(actuator, config)?)?,
                };
                let gentle_zone = gentle_zone(zone.planner()).with_context(|| in_loops(crane, actuator))?;
                let spec = JointSpec {
                    period,
                    inverse_inertia: InverseInertia::try_from(Bounds {
                        lower: inertia.min,
                        upper: inertia.max,
                    })?,
                    effort_limits: EffortLimits::symmetric(actuator.effort_limit())?,
                };
                let controller = AdaptiveController::new(gains, spec)
                    .with_context(|| format!("{}: {}", crane.gains.display(), actuator.name()))?;
                let (name, effort_limit) = (actuator.name().to_owned(), actuator.effort_limit());
                Ok(Joint { name, limits, effort_limit, zone, gentle_zone, spec, gains, controller })
            })
            .collect::<Result<Vec<_>>>()?;
        let (rates, task, reward) = (config.rates, config.task.clone(), config.reward);
        let feedforward = match crane.feedforward {
            Feedforward::None => FeedforwardModel::None,
            Feedforward::Nominal => FeedforwardModel::Believed,
        };
        Ok(Self {
            model,
            believed,
            feedforward,
            joints,
            moving,
            held,
            booms,
            rest_posture,
            survey,
            rates,
            task,
            reward,
            regions,
        })
    }

    /// The same machine with another crane behind it: what its controllers know stays as it is.
    #[must_use]
    pub fn with_simulated(mut self, model: CraneModel) -> Self {
        self.model = model;
        self
    }

    /// The same machine with another feedforward.
    #[must_use]
    pub fn with_feedforward(mut self, feedforward: FeedforwardModel) -> Self {
        self.feedforward = feedforward;
        self
    }

    /// The rigid bodies and the plant.
    #[must_use]
    pub fn model(&self) -> &CraneModel {
        &self.model
    }

    /// The crane without payload, for whose loads the limits of the reference are chosen.
    #[must_use]
    pub fn believed_model(&self) -> &CraneModel {
        &self.believed
    }

    /// What the laws of single joints know of it.
    #[must_use]
    pub fn feedforward(&self) -> &FeedforwardModel {
        &self.feedforward
    }

    /// Every joint, in the order of the model's actuators.
    #[must_use]
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// Joints that the policy moves, in the order of its actions.
    #[must_use]
    pub fn moving(&self) -> &[usize] {
        &self.moving
    }

    /// Joints that their controllers hold.
    #[must_use]
    pub fn held(&self) -> &[usize] {
        &self.held
    }

    /// Tree joints of the booms that cylinders turn.
    #[must_use]
    pub fn booms(&self) -> &[usize] {
        &self.booms
    }

    /// Every joint at rest: the held ones where they are held, the moving ones in the middle of their range.
    #[must_use]
    pub fn rest_posture(&self) -> &[f64] {
        &self.rest_posture
    }

    /// The rates of the loop.
    #[must_use]
    pub fn rates(&self) -> Rates {
        self.rates
    }

    /// The task.
    #[must_use]
    pub fn task(&self) -> &Task {
        &self.task
    }

    /// The weights of the reward.
    #[must_use]
    pub fn reward(&self) -> Reward {
        self.reward
    }

    /// The regions of the curriculum.
    #[must_use]
    pub fn regions(&self) -> &Regions {
        &self.regions
    }

    /// Constants that bring every feature to the order of one, from the limits: see
    /// [`crate::observation::Features`] for the order. Where the target is, is scaled by what is near rather than by the
    /// workspace, and so reaches the order of ten far away.
    ///
    /// # Panics
    /// Never: a checked machine has positive ranges.
    #[must_use]
    pub fn scaling(&self) -> Scaling {
        let mut pairs: Vec<(f64, f64)> = Vec::new();
        let ranges = |ranges: &mut dyn Iterator<Item = Interval>| -> Vec<(f64, f64)> {
            ranges.map(|range| (0.5 * (range.min + range.max), 0.5 * range.width())).collect()
        };
        pairs.extend(self.joints.iter().map(|joint| (0.0, joint.effort_limit)));
        pairs.extend(ranges(&mut self.joints.iter().map(|joint| joint.limits.position())));
        pairs.extend(ranges(&mut self.survey.boom_angle.iter().copied()));
        pairs.extend(self.joints.iter().map(|joint| (0.0, joint.limits.velocity().max)));
        pairs.extend(self.survey.boom_speed.iter().map(|&speed| (0.0, speed)));
        let corners = self.regions.workspace().vertices();
        let extent = |coordinate: fn(&(f64, f64)) -> f64| {
            let values = corners.iter().map(coordinate);
            values.fold(Interval::new(f64::INFINITY, f64::NEG_INFINITY), Interval::including)
        };
        let (x, z) = (extent(|corner| corner.0), extent(|corner| corner.1));
        pairs.extend(ranges(&mut [x, z].into_iter()));
        pairs.extend([(0.0, self.survey.tip_speed); 2]);
        pairs.extend([(0.0, NEAR * self.task.reach_distance); 3]);
        let (offset, scale) = pairs.into_iter().unzip();
        Scaling::try_from(ScalingSpec { offset, scale }).expect("ranges of a checked machine are positive")
    }
}

/// A joint's name as people say it: without the URDF's ending.
#[must_use]
pub fn short(joint: &str) -> &str {
    joint.strip_suffix("_joint").unwrap_or(joint)
}

/// The rigid bodies with plant and payload.
///
/// # Errors
/// A file is missing or wrong; the message names it, the field and the cause.
pub fn load_model(config: &ConfigSpec) -> Result<CraneModel> {
    Ok(load_unloaded_model(config)?.with_payload(config.crane.payload)?)
}

fn load_unloaded_model(config: &ConfigSpec) -> Result<CraneModel> {
    let crane = &config.crane;
    let urdf = store::read_text(&crane.urdf)?;
    let loops = store::read_text(&crane.loops)?;
    let plants = store::read_text(&crane.plants)?;
    let bare = CraneModel::from_urdf(&urdf, &loops)
        .with_context(|| format!("{} with {}", crane.urdf.display(), crane.loops.display()))?;
    let in_plants = || crane.plants.display().to_string();
    let plants = PlantFile::from_ron(&plants).with_context(in_plants)?;
    let plant = plants.plant(&crane.plant).with_context(in_plants)?;
    bare.with_plant(plant).with_context(in_plants)
}

fn in_loops(crane: &crate::config::Crane, actuator: &Actuator) -> String {
    format!("{}: actuator {}", crane.loops.display(), actuator.name())
}

/// Limits of an actuator.
///
/// # Errors
/// A limit that is none; a loaded model has checked them.
pub fn actuator_limits(actuator: &Actuator) -> Result<Limits> {
    Ok(Limits::try_from(SymmetricLimits {
        position: Interval::new(actuator.lower(), actuator.upper()),
        velocity: actuator.velocity_limit(),
        acceleration: actuator.acceleration_limit(),
        jerk: actuator.jerk_limit(),
    })?)
}

/// Limits of the reference: the actuator's, less the margin for the tracking error.
fn reference_limits(limits: &Limits, margin: TrackingMargin) -> Result<Limits> {
    let part = |interval: Interval, share: f64| {
        Interval::new(interval.min * (1.0 - share), interval.max * (1.0 - share))
    };
    let position = limits.position();
    let gap = margin.position * position.width();
    Ok(Limits::try_from(LimitsSpec {
        position: Interval::new(position.min + gap, position.max - gap),
        velocity: part(limits.velocity(), margin.velocity),
        acceleration: part(limits.acceleration(), margin.acceleration),
        jerk: part(limits.jerk(), margin.jerk),
    })?)
}

/// The generator of a joint's reference.
///
/// # Errors
/// Limits and period leave no motion; the message says which.
pub fn planner(actuator: &Actuator, config: &ConfigSpec) -> Result<Planner> {
    let ConfigSpec { crane, motion, rates, .. } = config;
    let name = actuator.name();
    let margin = *motion
        .tracking_margin
        .get(name)
        .ok_or_else(|| anyhow!("motion.tracking_margin has no entry for {name}; every actuator needs one"))?;
    let limits = actuator_limits(actuator)
        .and_then(|limits| reference_limits(&limits, margin))
        .with_context(|| in_loops(crane, actuator))?;
    let spec =
        PlannerSpec { limits, shape: motion.shape, timing: motion.timing, period: rates.policy_period() };
    Planner::try_from(spec).with_context(|| in_loops(crane, actuator))
}

/// File of a joint's braking table.
#[must_use]
pub fn table_path(config: &ConfigSpec, joint: &str) -> std::path::PathBuf {
    config.crane.tables.join(format!("{joint}.ron"))
}

/// The safe zone of a joint, from its table on disk.
///
/// # Errors
/// The table is missing, damaged or stale; the message names the command that builds it.
pub fn load_zone(config: &ConfigSpec, actuator: &Actuator) -> Result<SafeZone<'static>> {
    let planner = planner(actuator, config)?;
    let path = table_path(config, actuator.name());
    let remedy = || format!("{} (rebuild it with: cargo xtask tables [--config FILE])", path.display());
    let table = read_table(&path).with_context(remedy)?;
    SafeZone::new(planner, table).with_context(remedy)
}

/// The safe zone of the same joint with [`GENTLE`] of its acceleration; its table is small, and built here.
fn gentle_zone(planner: &Planner) -> Result<SafeZone<'static>> {
    let limits = planner.limits();
    let share = |interval: Interval| Interval::new(GENTLE * interval.min, GENTLE * interval.max);
    let gentle = Limits::try_from(LimitsSpec {
        position: limits.position(),
        velocity: limits.velocity(),
        acceleration: share(limits.acceleration()),
        jerk: limits.jerk(),
    })?;
    let planner = Planner::try_from(PlannerSpec { limits: gentle, ..*planner.spec() })?;
    let table = BrakingTable::build(&planner)?;
    Ok(SafeZone::new(planner, table)?)
}

fn read_table(path: &Path) -> Result<BrakingTable<'static>> {
    let text = store::read_text(path)?;
    BrakingTable::from_ron(&text).map_err(|error| anyhow!("{error}"))
}

/// Which joints move and which are held where; every joint must be one or the other.
fn assign_joints(model: &CraneModel, task: &Task) -> Result<(Vec<usize>, Vec<usize>, Vec<f64>)> {
    let index = |field: &str, joint: &str| {
        let known = || model.actuators().iter().map(Actuator::name).collect::<Vec<_>>().join(", ");
        model
            .actuator_index(joint)
            .ok_or_else(|| anyhow!("{field}: no actuator is called '{joint}'; there are {}", known()))
    };
    let moving = task.moving.iter().map(|joint| index("task.moving", joint)).collect::<Result<Vec<_>>>()?;
    ensure!(
        moving.len() <= MAX_MOVING,
        "task.moving: at most {MAX_MOVING} joints may move, got {}",
        moving.len()
    );
    let mut posture: Vec<f64> =
        model.actuators().iter().map(|actuator| 0.5 * (actuator.lower() + actuator.upper())).collect();
    let mut held = Vec::new();
    for (joint, position) in &task.held {
        let joint = index("task.held", joint)?;
        let actuator = &model.actuators()[joint];
        ensure!(
            (actuator.lower()..=actuator.upper()).contains(position),
            "task.held: {} is held at {position}, outside its limits [{}, {}]",
            actuator.name(),
            actuator.lower(),
            actuator.upper()
        );
        posture[joint] = *position;
        held.push(joint);
    }
    for (joint, actuator) in model.actuators().iter().enumerate() {
        let times = moving.iter().chain(&held).filter(|&&assigned| assigned == joint).count();
        ensure!(
            times == 1,
            "task: {} must be named once, in moving or in held; it is named {times} times",
            actuator.name()
        );
    }
    Ok((moving, held, posture))
}
