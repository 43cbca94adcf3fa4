//! Static load chart: the largest payload that the actuators hold, over positions of the tip in the crane's plane.

use nalgebra::{Matrix2, Vector2, Vector3};
use serde::{Deserialize, Serialize};

use crate::data::Data;
use crate::error::DynamicsError;
use crate::kinematics::check;
use crate::model::CraneModel;

/// Residual of the inverse kinematics \[m\].
const ON_POINT: f64 = 1e-10;

/// Newton steps from a start that is at most one survey cell away; it converges in five or not at all.
const NEWTON_STEPS: usize = 20;

/// Evenly spaced values, both ends included.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// The first value \[m\].
    pub from: f64,
    /// The last value \[m\].
    pub to: f64,
    /// How many, at least 2.
    pub points: usize,
}

impl Axis {
    /// Value number `index`.
    pub fn value(&self, index: usize) -> f64 {
        self.from + (self.to - self.from) * (index as f64) / (self.points - 1) as f64
    }
}

/// What a load chart is to show.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadChartSpec {
    /// Horizontal tip positions: x of the world, the crane's plane at slew 0.
    pub x: Axis,
    /// Heights of the tip: z of the world.
    pub z: Axis,
    /// Actuators that place the tip. The first two are solved for; the others are redundant and tried over their
    /// ranges.
    pub moving: Vec<usize>,
    /// Position of every actuator [rad or m]; those of the moving ones do not matter.
    pub posture: Vec<f64>,
    /// Values per redundant actuator that are tried, and starts per solved one, at least 2.
    pub samples: usize,
}

/// The largest payload at one tip position.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LoadPoint {
    /// Largest payload \[kg\], a point at the tip.
    pub payload: f64,
    /// The actuator that is at its effort limit under it.
    pub limited_by: usize,
    /// Positions of all actuators that hold it [rad or m].
    pub position: Vec<f64>,
}

/// Largest payloads over a grid of tip positions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LoadChart {
    /// Horizontal tip positions.
    pub x: Axis,
    /// Heights of the tip.
    pub z: Axis,
    /// Row by row from the lowest height, each from the first x; `None` where the tip cannot be, or the actuators
    /// do not even hold the crane itself.
    pub points: Vec<Option<LoadPoint>>,
}

impl LoadChart {
    /// The point at column `column` of x and row `row` of z.
    ///
    /// # Panics
    /// If there is no such column or row.
    pub fn point(&self, column: usize, row: usize) -> Option<&LoadPoint> {
        assert!(column < self.x.points && row < self.z.points, "({column}, {row}) is outside the chart");
        self.points[row * self.x.points + column].as_ref()
    }
}

/// A posture, and where its tip is.
struct Surveyed {
    posture: Vec<f64>,
    tip: Vector2<f64>,
}

impl CraneModel {
    /// Largest payload at rest, and the actuator that limits it, with the actuators at `position`; `None` if their
    /// effort limits do not even hold the crane. Infinite, limited by actuator 0, if the payload loads none of them.
    ///
    /// The efforts are affine in the payload, so the answer is exact. Friction, which would help, and the model's own
    /// payload do not count.
    ///
    /// # Errors
    /// Those of [`update_kinematics`](Self::update_kinematics).
    pub fn largest_payload(
        &self,
        data: &mut Data,
        position: &[f64],
    ) -> Result<Option<(f64, usize)>, DynamicsError> {
        let mut effort = vec![0.0; position.len()];
        let mut per_mass = vec![0.0; position.len()];
        self.holding_efforts(data, position, &mut effort, &mut per_mass)?;
        let mut largest = (f64::INFINITY, 0);
        for (k, actuator) in self.actuators.iter().enumerate() {
            let limit = actuator.effort_limit();
            if effort[k].abs() > limit {
                return Ok(None);
            }
            let payload = (limit - effort[k] * per_mass[k].signum()) / per_mass[k].abs();
            if payload < largest.0 {
                largest = (payload, k);
            }
        }
        Ok(Some(largest))
    }

    /// Efforts that hold the bare crane at rest, and what each kilogram at the tip adds.
    fn holding_efforts(
        &self,
        data: &mut Data,
        position: &[f64],
        effort: &mut [f64],
        per_mass: &mut [f64],
    ) -> Result<(), DynamicsError> {
        per_mass.fill(0.0); // also the velocity at rest
        self.update_dynamics(data, position, per_mass)?;
        let p_wt = self.tip_point(data);
        for &i in &self.tip_path {
            let rise = data.columns[i].linear_at(&p_wt);
            per_mass[self.driven_by[i]] -= rise.dot(&self.gravity);
        }
        for k in 0..effort.len() {
            effort[k] = data.gravity_effort[k] - self.payload * per_mass[k];
        }
        Ok(())
    }

    /// The largest payload for every tip position of a grid in the crane's plane.
    ///
    /// Every position is reached exactly, by Newton's method on the first two moving actuators from the nearest
    /// surveyed posture; over the redundant ones the best of `samples` values each is taken, so with redundancy the
    /// chart is a lower bound that rises with `samples`. Allocates; not for control loops.
    ///
    /// # Errors
    /// [`DynamicsError::Length`] or [`DynamicsError::NotFinite`] for the posture or the axes.
    ///
    /// # Panics
    /// If `moving` names fewer than two actuators or one that is not there, or an axis or `samples` is below 2.
    pub fn load_chart(&self, spec: &LoadChartSpec) -> Result<LoadChart, DynamicsError> {
        let LoadChartSpec { x, z, moving, posture, samples } = spec;
        check("posture", posture, self.actuators.len())?;
        check("axes", &[x.from, x.to, z.from, z.to], 4)?;
        assert!(
            moving.len() >= 2 && moving.iter().all(|k| *k < posture.len()),
            "two moving actuators at least"
        );
        assert!(x.points >= 2 && z.points >= 2 && *samples >= 2, "two points and two samples at least");

        let mut data = self.new_data();
        let (solved, redundant) = ([moving[0], moving[1]], &moving[2..]);
        let mut points: Vec<Option<LoadPoint>> = vec![None; x.points * z.points];
        for number in 0..samples.pow(redundant.len() as u32) {
            let mut posture = posture.clone();
            self.spread(&mut posture, redundant, *samples, number);
            let survey = self.survey(&mut data, &posture, solved, *samples)?;
            for (index, best) in points.iter_mut().enumerate() {
                let target = Vector2::new(x.value(index % x.points), z.value(index / x.points));
                for position in self.reach(&mut data, &survey, solved, target)? {
                    if let Some((payload, limited_by)) = self.largest_payload(&mut data, &position)?
                        && best.as_ref().is_none_or(|best| payload > best.payload)
                    {
                        *best = Some(LoadPoint { payload, limited_by, position });
                    }
                }
            }
        }
        Ok(LoadChart { x: *x, z: *z, points })
    }

    /// Puts `actuators` to sample `number` of a grid over their ranges.
    fn spread(&self, posture: &mut [f64], actuators: &[usize], samples: usize, mut number: usize) {
        for &k in actuators {
            let (lower, upper) = (self.actuators[k].lower(), self.actuators[k].upper());
            posture[k] = lower + (upper - lower) * (number % samples) as f64 / (samples - 1) as f64;
            number /= samples;
        }
    }

    /// Tip positions over a grid of the two solved actuators.
    fn survey(
        &self,
        data: &mut Data,
        posture: &[f64],
        solved: [usize; 2],
        samples: usize,
    ) -> Result<Vec<Surveyed>, DynamicsError> {
        let mut survey = Vec::with_capacity(samples * samples);
        for number in 0..samples * samples {
            let mut posture = posture.to_vec();
            self.spread(&mut posture, &solved, samples, number);
            let (tip, _) = self.tip_in_plane(data, &posture, solved)?;
            survey.push(Surveyed { posture, tip });
        }
        Ok(survey)
    }

    /// Postures whose tip is at `target`: from the nearest surveyed one, and from the nearest of the other half of the
    /// second actuator's range, where an arm that bends the other way would be.
    fn reach(
        &self,
        data: &mut Data,
        survey: &[Surveyed],
        solved: [usize; 2],
        target: Vector2<f64>,
    ) -> Result<Vec<Vec<f64>>, DynamicsError> {
        let second = &self.actuators[solved[1]];
        let middle = 0.5 * (second.lower() + second.upper());
        let mut found = Vec::new();
        for upper_half in [false, true] {
            let half = survey.iter().filter(|at| (at.posture[solved[1]] > middle) == upper_half);
            let distance = |at: &&Surveyed| (at.tip - target).norm_squared();
            let Some(start) = half.min_by(|a, b| distance(a).total_cmp(&distance(b))) else { continue };
            found.extend(self.newton(data, start.posture.clone(), solved, target)?);
        }
        Ok(found)
    }

    /// Newton's method on the two solved actuators; `None` if it does not arrive within their ranges.
    fn newton(
        &self,
        data: &mut Data,
        mut posture: Vec<f64>,
        solved: [usize; 2],
        target: Vector2<f64>,
    ) -> Result<Option<Vec<f64>>, DynamicsError> {
        for _ in 0..NEWTON_STEPS {
            let (tip, jacobian) = self.tip_in_plane(data, &posture, solved)?;
            let error = target - tip;
            if error.norm() < ON_POINT {
                return Ok(Some(posture));
            }
            let Some(inverse) = jacobian.try_inverse() else { return Ok(None) };
            let step = inverse * error;
            for (&k, step) in solved.iter().zip(step.iter()) {
                // Kept within the range: a loop need not close beyond it, and a tip that is not there yet may come back.
                posture[k] = (posture[k] + step).clamp(self.actuators[k].lower(), self.actuators[k].upper());
            }
        }
        Ok(None)
    }

    /// The tip (x, z), and its derivatives by the two solved actuators.
    fn tip_in_plane(
        &self,
        data: &mut Data,
        posture: &[f64],
        solved: [usize; 2],
    ) -> Result<(Vector2<f64>, Matrix2<f64>), DynamicsError> {
        self.update_kinematics(data, posture, &vec![0.0; posture.len()])?;
        let p_wt: Vector3<f64> = self.tip_point(data);
        let mut jacobian = Matrix2::zeros();
        for &i in &self.tip_path {
            let Some(column) = solved.iter().position(|k| *k == self.driven_by[i]) else { continue };
            let rate = data.columns[i].linear_at(&p_wt);
            jacobian[(0, column)] += rate.x;
            jacobian[(1, column)] += rate.z;
        }
        Ok((Vector2::new(p_wt.x, p_wt.z), jacobian))
    }
}
