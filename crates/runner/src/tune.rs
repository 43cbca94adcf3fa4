//! Gains for every control law by one procedure and one budget.
//!
//! Each law starts from the rules of `docs/control.md`: gains that its stability conditions allow, and that correspond to
//! one another (PD is the adaptive law that does not adapt, PID is PD with a slow integral, computed torque has PD's
//! rates). Then, `budget`
//! times: every gain of every joint is multiplied by a random factor and the training scenarios are played; the joints
//! whose own worst error fell take their new gains together, and keep them if the power mean of all joints' worst errors
//! falls. Errors count in units of what is allowed. Gains that the conditions on stability and damping refuse, which are
//! the same for every law, are drawn again. One seed gives one result.

pub mod candidate;
pub mod coupling;
pub mod file;

use anyhow::{Context, Result};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{RngCore, SeedableRng};

use crate::motion::Motion;
use crate::track::play::{Ending, play};
use crate::track::scenario::Scenario;
use crate::track::setup::{Law, LawGains, Setup, Stage};
use crate::tune::coupling::Coupling;

/// Scenarios of the training set, by plant.
pub const TRAINING: [(&str, &[&str]); 2] =
    [("electric", &["payload", "force", "friction"]), ("light", &["hydraulic"])];

/// Errors of a moving joint that count as one [m, m/s].
const MOVING: (f64, f64) = (5e-4, 0.01);

/// Displacement of the tip by a held joint that counts as one \[m\]: half of what all of them may cause together.
const HELD: f64 = 1.5e-3;

/// Power of the mean over the joints that is to fall: near enough to the worst joint, and smooth.
const POWER: i32 = 4;

/// Largest [`adaptive_ctrl::coupled_damping_per_tick`] of all joints together that a candidate may have.
const MAX_COUPLED_DAMPING: f64 = 1.0;

/// Draws of gains until one set is stable.
const MAX_DRAWS: u32 = 200;

/// What a tuning is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Tuning {
    /// The law.
    pub law: Law,
    /// Which gain family: `electric`, or `light` for plants without reflected inertia.
    pub family: &'static str,
    /// Plays of the training set.
    pub budget: u32,
    /// Seed of the draws.
    pub seed: u64,
}

/// What a tuning found.
#[derive(Clone, Debug)]
pub struct Tuned {
    /// The gains.
    pub gains: LawGains,
    /// Largest normalised error of any joint with the gains of the law's file, if it has any that are stable; with those
    /// of the start; and with those found.
    pub worst: (Option<f64>, f64, f64),
    /// What the search lowers, at the start and at the end.
    pub objective: (f64, f64),
    /// Largest normalised error by joint, at the end.
    pub joints: Vec<(String, f64)>,
}

struct Course {
    scenario: Scenario,
    stage: Stage,
    /// Position and velocity error of every joint that count as one.
    units: Vec<(f64, f64)>,
}

/// Tunes one law.
///
/// # Errors
/// A scenario of the training set is missing or wrong, or no gains near the start are stable.
pub fn tune(tuning: Tuning) -> Result<Tuned> {
    let names = TRAINING.iter().find(|(family, _)| *family == tuning.family).map(|(_, names)| *names);
    let names = names.with_context(|| format!("no training set is called '{}'", tuning.family))?;
    let courses = names
        .iter()
        .map(|name| {
            let scenario = Scenario::read_training(name)?;
            let stage =
                Stage::load(&scenario, Setup { lyapunov: false, tip: false, ..Setup::of(tuning.law) })?;
            let units = units(&stage)?;
            Ok(Course { scenario, stage, units })
        })
        .collect::<Result<Vec<_>>>()?;
    let stage = &courses[0].stage;
    let coupling = Coupling::new(stage.believed(), stage.machine.rates().controller_period())?;
    let mut draws = Draws(Xoshiro256PlusPlus::seed_from_u64(tuning.seed));
    let shipped = match stage.gains(&courses[0].scenario) {
        Ok(gains) => Some(worst(&score(&courses, &gains)?)),
        Err(_) => None,
    };
    let mut best = candidate::start(stage, tuning.law, &courses[0].units)?;
    stage.controllers(&best).context("the gains that the search starts from")?;
    let mut scores = score(&courses, &best)?;
    let (first, first_objective) = (worst(&scores), objective(&scores));
    for round in 0..tuning.budget {
        // From half a decade down to a twentieth.
        let spread = 0.5 * 0.1_f64.powf(f64::from(round) / f64::from(tuning.budget.max(1)));
        let Some(tried) = draw(stage, &coupling, &best, spread, &mut draws) else { continue };
        let found = score(&courses, &tried)?;
        let better: Vec<bool> = found.iter().zip(&scores).map(|(new, old)| new < old).collect();
        if !better.contains(&true) {
            continue;
        }
        let mixed = candidate::mix(&best, &tried, &better);
        if !is_stable(stage, &coupling, &mixed) {
            continue;
        }
        let after = score(&courses, &mixed)?;
        if objective(&after) < objective(&scores) {
            (best, scores) = (mixed, after);
        }
    }
    let joints = stage.machine.joints().iter().zip(&scores);
    let joints = joints.map(|(joint, &score)| (joint.name.clone(), score)).collect();
    let objective = (first_objective, objective(&scores));
    Ok(Tuned { gains: best, objective, worst: (shipped, first, worst(&scores)), joints })
}

/// Worst normalised error of every joint over the training set; infinite where a run did not end as it should.
fn score(courses: &[Course], gains: &LawGains) -> Result<Vec<f64>> {
    let mut scores = vec![0.0_f64; courses[0].stage.machine.joints().len()];
    for Course { scenario, stage, units } in courses {
        let mut blind = |_: &Motion, _: f64| {};
        let Ok(played) = play(scenario, stage, gains, &mut blind) else {
            return Ok(vec![f64::INFINITY; scores.len()]);
        };
        let complete = played.ending == Ending::Completed;
        for ((score, seen), unit) in scores.iter_mut().zip(&played.joints).zip(units) {
            let error = (seen.position_error.max / unit.0).max(seen.velocity_error.max / unit.1);
            *score = score.max(if complete && error.is_finite() { error } else { f64::INFINITY });
        }
    }
    Ok(scores)
}

/// What errors of every joint count as one: those of [`MOVING`], and for a held joint what moves the tip by [`HELD`]
/// where it moves it most. Velocity does not count there.
fn units(stage: &Stage) -> Result<Vec<(f64, f64)>> {
    let machine = &stage.machine;
    let (model, joints) = (machine.model(), machine.joints().len());
    let (mut data, mut jacobian) = (model.new_data(), vec![0.0; 6 * joints]);
    let mut lever = vec![0.0_f64; joints];
    for posture in postures(stage) {
        model.update_kinematics(&mut data, &posture, &vec![0.0; joints])?;
        model.tip_jacobian(&data, &mut jacobian)?;
        for (joint, lever) in lever.iter_mut().enumerate() {
            let column = (0..3).map(|axis| jacobian[axis * joints + joint].powi(2)).sum::<f64>().sqrt();
            *lever = lever.max(column);
        }
    }
    let unit = |(joint, lever): (usize, &f64)| {
        if machine.moving().contains(&joint) { MOVING } else { (HELD / lever.max(0.05), f64::INFINITY) }
    };
    Ok(lever.iter().enumerate().map(unit).collect())
}

/// Postures over the workspace: ends and middle of every moving joint.
fn postures(stage: &Stage) -> impl Iterator<Item = Vec<f64>> {
    let machine = &stage.machine;
    (0..3_u32.pow(machine.moving().len() as u32)).map(move |number| {
        let (mut posture, mut rest) = (machine.rest_posture().to_vec(), number);
        for &joint in machine.moving() {
            let range = machine.joints()[joint].limits.position();
            posture[joint] = range.min + f64::from(rest % 3) / 2.0 * range.width();
            rest /= 3;
        }
        posture
    })
}

/// What the search lowers.
fn objective(scores: &[f64]) -> f64 {
    scores.iter().map(|score| score.powi(POWER)).sum()
}

fn worst(scores: &[f64]) -> f64 {
    scores.iter().copied().fold(0.0, f64::max)
}

/// Gains near `best` that are stable; none if the draws are used up.
fn draw(
    stage: &Stage,
    coupling: &Coupling,
    best: &LawGains,
    spread: f64,
    draws: &mut Draws,
) -> Option<LawGains> {
    for _ in 0..MAX_DRAWS {
        let tried = candidate::near(best, &mut || 10.0_f64.powf(spread * draws.symmetric()));
        // Joints that are refused keep what they have.
        let Some(tried) = candidate::accepted(stage, best, tried) else { continue };
        if is_stable(stage, coupling, &tried) {
            return Some(tried);
        }
    }
    None
}

/// Whether the law accepts the gains and all joints together stay calm over the workspace.
fn is_stable(stage: &Stage, coupling: &Coupling, gains: &LawGains) -> bool {
    let calm = candidate::damping(gains)
        .is_none_or(|damping| coupling.damping_per_tick(&damping) <= MAX_COUPLED_DAMPING);
    calm && stage.controllers(gains).is_ok()
}

/// The draws of a tuning.
struct Draws(Xoshiro256PlusPlus);

impl Draws {
    /// Uniform in [-1, 1).
    fn symmetric(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * (-52.0_f64).exp2() - 1.0
    }
}
