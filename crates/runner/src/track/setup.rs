//! Which law follows, what it knows, and the crane of a scenario in front of it.

use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

use adaptive_ctrl::{
    AdaptiveController, AnyController, Bounds, EffortLimits, GainTable, Gains, JointSpec, PdController,
    PdGains, PidController, PidGains,
};
use anyhow::{Context, Result, bail, ensure};
use hiab_dynamics::{CraneModel, PlantFile};
use serde::de::DeserializeOwned;

use super::scenario::Scenario;
use crate::config::{ConfigSpec, read_ron};
use crate::control::{ComputedTorque, Controllers, TorqueGains};
use crate::course::Profile;
use crate::machine::{self, FeedforwardModel, Machine, Zones};
use crate::motion::Motion;
use crate::surroundings::{ActuatorFault, Surroundings};
use crate::{store, suggest};

/// A control law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    /// The paper's.
    Adaptive,
    /// Proportional-derivative.
    Pd,
    /// With an integral.
    Pid,
    /// On the model of the crane without payload.
    ComputedTorque,
    /// On the model of the crane as it is.
    ComputedTorqueExact,
}

impl Law {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::Adaptive, Self::Pd, Self::Pid, Self::ComputedTorque, Self::ComputedTorqueExact];

    /// The name as in commands.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Adaptive => "adaptive",
            Self::Pd => "pd",
            Self::Pid => "pid",
            Self::ComputedTorque => "computed-torque",
            Self::ComputedTorqueExact => "computed-torque-exact",
        }
    }
}

/// What the feedforward of a law of single joints knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Knowledge {
    /// Nothing: the law alone, as in the paper.
    None,
    /// The plant of the scenario without its payload, with friction and armature as the controllers believe.
    Nominal,
    /// The crane as it is, payload and all.
    Exact,
}

impl Knowledge {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::None, Self::Nominal, Self::Exact];

    /// The name as in commands.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Nominal => "nominal",
            Self::Exact => "exact",
        }
    }
}

impl fmt::Display for Law {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Law {
    type Err = anyhow::Error;

    fn from_str(name: &str) -> Result<Self> {
        let names: Vec<&str> = Self::ALL.into_iter().map(Self::name).collect();
        let found = Self::ALL.into_iter().find(|law| law.name() == name);
        found.with_context(|| unknown("controller", name, &names))
    }
}

impl FromStr for Knowledge {
    type Err = anyhow::Error;

    fn from_str(name: &str) -> Result<Self> {
        let names: Vec<&str> = Self::ALL.into_iter().map(Self::name).collect();
        let found = Self::ALL.into_iter().find(|knowledge| knowledge.name() == name);
        found.with_context(|| unknown("feedforward", name, &names))
    }
}

fn unknown(what: &str, name: &str, names: &[&str]) -> String {
    let hint =
        suggest::nearest(name, names).map(|near| format!("; did you mean '{near}'?")).unwrap_or_default();
    format!("no {what} is called '{name}'{hint} (there are {})", names.join(", "))
}

/// Gains of one law for every joint, in the order of the actuators.
#[derive(Clone, Debug, PartialEq)]
pub enum LawGains {
    /// Of the adaptive law.
    Adaptive(Vec<Gains>),
    /// Of PD.
    Pd(Vec<PdGains>),
    /// Of PID.
    Pid(Vec<PidGains>),
    /// Of computed torque.
    ComputedTorque(Vec<TorqueGains>),
}

/// Which law follows, and what it knows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setup {
    /// The law.
    pub law: Law,
    /// What its feedforward knows; computed torque has its own model instead.
    pub knowledge: Knowledge,
    /// How velocities change.
    pub profile: Profile,
    /// Shape of the jerk-bounded ramps, if not the configuration's.
    pub shape: Option<jbtg::Shape>,
    /// Whether the Lyapunov function is followed, which costs as much as the simulation.
    pub lyapunov: bool,
    /// Whether the displacement of the tip by held joints is measured, which costs half as much.
    pub tip: bool,
}

impl Setup {
    /// A law with the nominal feedforward, or with its own model, on the reference as shipped.
    #[must_use]
    pub fn of(law: Law) -> Self {
        let knowledge = match law {
            Law::Adaptive | Law::Pd | Law::Pid => Knowledge::Nominal,
            Law::ComputedTorque | Law::ComputedTorqueExact => Knowledge::None,
        };
        Self { law, knowledge, profile: Profile::JerkBounded, shape: None, lyapunov: true, tip: true }
    }
}

/// The crane of a scenario as its controllers know it, and as it is.
#[derive(Debug)]
pub struct Stage {
    /// The machine: simulated as it is, limits and safe zones as configured.
    pub machine: Arc<Machine>,
    specs: Vec<JointSpec>,
    setup: Setup,
}

impl Stage {
    /// Loads everything that `scenario` names, for `setup`.
    ///
    /// # Errors
    /// A file is missing or wrong, or a name in the scenario is not in them; the message says which.
    pub fn load(scenario: &Scenario, setup: Setup) -> Result<Self> {
        let mut config = ConfigSpec::read(&scenario.config)?;
        config.crane.plant.clone_from(&scenario.plant);
        config.crane.gains.clone_from(&scenario.gains.adaptive);
        config.crane.payload = 0.0;
        let rates = &mut config.rates;
        rates.integration_hz *= scenario.substeps;
        rates.controller_divider *= scenario.substeps;
        rates.reference_divider *= scenario.substeps;
        rates.policy_divider *= scenario.substeps;
        let zones = match setup.shape {
            // The tables on disk are for the configured shape; with another one the same distances in closed form.
            Some(shape) if shape != config.motion.shape => {
                config.motion.shape = shape;
                Zones::ClosedForm
            }
            _ => Zones::FromTables,
        };
        let truth = true_model(scenario, &config)?;
        let feedforward = match setup.knowledge {
            Knowledge::None => FeedforwardModel::None,
            Knowledge::Nominal => FeedforwardModel::Believed,
            Knowledge::Exact => FeedforwardModel::Other(Box::new(truth.clone())),
        };
        let machine = Machine::load_with(&config, zones)?.with_simulated(truth).with_feedforward(feedforward);
        for joint in scenario.effort_limits.keys() {
            index(&machine, "effort_limits", joint)?;
        }
        let specs = machine.joints().iter().map(|joint| {
            let share = scenario.effort_limits.get(&joint.name).copied().unwrap_or(1.0);
            let limit = share * joint.effort_limit;
            let effort_limits = EffortLimits::try_from(Bounds { lower: -limit, upper: limit })?;
            Ok(JointSpec { effort_limits, ..joint.spec })
        });
        let specs = specs.collect::<Result<Vec<_>>>()?;
        if matches!(setup.law, Law::ComputedTorque | Law::ComputedTorqueExact) {
            ensure!(
                setup.knowledge == Knowledge::None,
                "{} has its own model: it takes no feedforward",
                setup.law
            );
        }
        Ok(Self { machine: Arc::new(machine), specs, setup })
    }

    /// The gains of the law from the scenario's files.
    ///
    /// # Errors
    /// A file is missing or wrong; the message names it and how it is made.
    pub fn gains(&self, scenario: &Scenario) -> Result<LawGains> {
        let files = &scenario.gains;
        Ok(match self.setup.law {
            Law::Adaptive => {
                LawGains::Adaptive(self.machine.joints().iter().map(|joint| joint.gains).collect())
            }
            Law::Pd => LawGains::Pd(self.table(&files.pd)?),
            Law::Pid => LawGains::Pid(self.table(&files.pid)?),
            Law::ComputedTorque | Law::ComputedTorqueExact => {
                LawGains::ComputedTorque(self.table(&files.computed_torque)?)
            }
        })
    }

    fn table<G: DeserializeOwned + Copy>(&self, path: &std::path::Path) -> Result<Vec<G>> {
        let table: GainTable<G> = read_ron(path).with_context(|| "made by: cargo xtask tune".to_owned())?;
        let names: Vec<&str> = self.machine.joints().iter().map(|joint| joint.name.as_str()).collect();
        table.in_order(&names).with_context(|| path.display().to_string())
    }

    /// The law with `gains` in front of the crane.
    ///
    /// # Errors
    /// Gains that are not stable; the message names the joint.
    pub fn controllers(&self, gains: &LawGains) -> Result<Controllers> {
        fn joints<G: Copy, C: Into<AnyController>, E: std::error::Error + Send + Sync + 'static>(
            stage: &Stage,
            gains: &[G],
            build: impl Fn(G, JointSpec) -> Result<C, E>,
        ) -> Result<Controllers> {
            let names = stage.machine.joints().iter().map(|joint| &joint.name);
            let controllers =
                gains.iter().zip(&stage.specs).zip(names).map(|((&gains, &spec), name)| {
                    Ok(build(gains, spec).with_context(|| name.clone())?.into())
                });
            Ok(Controllers::Joints(controllers.collect::<Result<Vec<_>>>()?))
        }
        match gains {
            LawGains::Adaptive(gains) => joints(self, gains, AdaptiveController::new),
            LawGains::Pd(gains) => joints(self, gains, PdController::new),
            LawGains::Pid(gains) => joints(self, gains, PidController::new),
            LawGains::ComputedTorque(gains) => {
                let model = match self.setup.law {
                    Law::ComputedTorqueExact => self.machine.model().clone(),
                    _ => self.believed().clone(),
                };
                let limits = self.specs.iter().map(|spec| spec.effort_limits).collect();
                let period = self.machine.rates().controller_period();
                let law = ComputedTorque::new(model, gains.clone(), limits, period)?;
                Ok(Controllers::ComputedTorque(Box::new(law)))
            }
        }
    }

    /// The crane with the law, disturbed as the scenario has it.
    ///
    /// # Errors
    /// The scenario names a joint that the crane has not, or gains are not stable.
    pub fn motion(&self, scenario: &Scenario, gains: &LawGains) -> Result<Motion> {
        let faults = scenario.faults.iter().map(|fault| {
            let joint = index(&self.machine, "faults", &fault.joint)?;
            Ok(ActuatorFault { joint, at: fault.at, share: fault.share })
        });
        let surroundings = Surroundings::new(
            scenario.forces.clone(),
            faults.collect::<Result<_>>()?,
            scenario.sensors,
            scenario.timing,
            scenario.seed,
        );
        let controllers = self.controllers(gains)?;
        let Setup { profile, tip, .. } = self.setup;
        Ok(Motion::with(Arc::clone(&self.machine), controllers, surroundings, profile, tip))
    }

    /// The crane as the controllers believe it to be: without payload.
    #[must_use]
    pub fn believed(&self) -> &CraneModel {
        self.machine.believed_model()
    }

    /// The setup that it was loaded for.
    #[must_use]
    pub fn setup(&self) -> Setup {
        self.setup
    }

    /// What the controllers are told about every joint.
    #[must_use]
    pub fn specs(&self) -> &[JointSpec] {
        &self.specs
    }
}

fn index(machine: &Machine, field: &str, joint: &str) -> Result<usize> {
    let names: Vec<&str> = machine.joints().iter().map(|joint| joint.name.as_str()).collect();
    match names.iter().position(|name| *name == joint) {
        Some(index) => Ok(index),
        None => bail!("{field}: {}", unknown("joint", joint, &names)),
    }
}

/// The crane as it is.
fn true_model(scenario: &Scenario, config: &ConfigSpec) -> Result<CraneModel> {
    let truth = scenario.truth;
    let plants = PlantFile::from_ron(&store::read_text(&config.crane.plants)?)?;
    let mut plant = plants.plant(&config.crane.plant)?.clone();
    for actuator in plant.actuators.values_mut() {
        actuator.armature *= truth.armature;
        actuator.coulomb *= truth.friction;
        actuator.viscous *= truth.friction;
    }
    Ok(machine::load_model(config)?.with_plant(&plant)?.with_payload(truth.payload)?)
}
