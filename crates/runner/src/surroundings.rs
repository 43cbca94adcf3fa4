//! What happens to the crane from outside and inside that its controllers do not know: forces, faults, bad sensors, a
//! late computer.

use hiab_dynamics::Wrench;
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{RngCore, SeedableRng};
use serde::{Deserialize, Serialize};

/// A force at the tip over some time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TipForce {
    /// When it begins \[s\].
    pub from: f64,
    /// When it ends \[s\].
    pub until: f64,
    /// The force in world axes \[N\].
    pub force: [f64; 3],
}

/// An actuator that exerts only a share of what it is commanded, from some time on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActuatorFault {
    /// Which joint, in the order of the actuators.
    pub joint: usize,
    /// Since when \[s\].
    pub at: f64,
    /// What is left, in [0, 1].
    pub share: f64,
}

/// What sensors add: Gaussian noise of the standard deviation given, then rounding to the resolution. Zero is none.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sensors {
    /// Standard deviation of a position [m or rad].
    pub position_noise: f64,
    /// Standard deviation of a velocity [m/s or rad/s].
    pub velocity_noise: f64,
    /// Step of a position [m or rad].
    pub position_resolution: f64,
    /// Step of a velocity [m/s or rad/s].
    pub velocity_resolution: f64,
}

/// How often the controllers' computer is not on time: probabilities per tick, in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Timing {
    /// A command takes effect one tick late.
    pub late: f64,
    /// A tick is left out: the last command stays, and no controller moves.
    pub dropped: f64,
}

/// Everything that the controllers do not know. Deterministic: all noise comes from one seed.
#[derive(Clone, Debug)]
pub struct Surroundings {
    /// Forces at the tip; those that overlap add up.
    pub forces: Vec<TipForce>,
    /// Faults of actuators.
    pub faults: Vec<ActuatorFault>,
    /// What sensors add.
    pub sensors: Sensors,
    /// Whether the computer is on time.
    pub timing: Timing,
    noise: Xoshiro256PlusPlus,
    is_calm: bool,
}

/// What becomes of one tick of the controllers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tick {
    OnTime,
    Late,
    Dropped,
}

impl Surroundings {
    /// Nothing disturbs.
    #[must_use]
    pub fn calm() -> Self {
        let sensors = Sensors {
            position_noise: 0.0,
            velocity_noise: 0.0,
            position_resolution: 0.0,
            velocity_resolution: 0.0,
        };
        let timing = Timing { late: 0.0, dropped: 0.0 };
        Self::new(Vec::new(), Vec::new(), sensors, timing, 0)
    }

    /// Surroundings whose noise comes from `seed`.
    #[must_use]
    pub fn new(
        forces: Vec<TipForce>,
        faults: Vec<ActuatorFault>,
        sensors: Sensors,
        timing: Timing,
        seed: u64,
    ) -> Self {
        let Sensors { position_noise, velocity_noise, position_resolution, velocity_resolution } = sensors;
        let numbers = [
            position_noise,
            velocity_noise,
            position_resolution,
            velocity_resolution,
            timing.late,
            timing.dropped,
        ];
        let is_calm = forces.is_empty() && faults.is_empty() && numbers.iter().all(|&x| x <= 0.0);
        Self { forces, faults, sensors, timing, noise: Xoshiro256PlusPlus::seed_from_u64(seed), is_calm }
    }

    /// Sum of the forces at `time`, if there is one.
    pub(crate) fn tip_wrench(&self, time: f64) -> Option<Wrench> {
        let mut acting =
            self.forces.iter().filter(|force| force.from <= time && time < force.until).peekable();
        acting.peek()?;
        let force =
            acting.fold([0.0; 3], |sum, next| std::array::from_fn(|axis| sum[axis] + next.force[axis]));
        Some(Wrench { force, moment: [0.0; 3] })
    }

    /// What an actuator exerts that is commanded `effort` at `time` [N·m or N].
    pub(crate) fn exerted(&self, joint: usize, effort: f64, time: f64) -> f64 {
        let mut present = self.faults.iter().filter(|fault| fault.joint == joint && fault.at <= time);
        present.next().map_or(effort, |fault| fault.share * effort)
    }

    /// What the sensors of a joint say.
    pub(crate) fn sensed(&mut self, position: f64, velocity: f64) -> (f64, f64) {
        if self.is_calm {
            return (position, velocity);
        }
        let Sensors { position_noise, velocity_noise, position_resolution, velocity_resolution } =
            self.sensors;
        let round = |value: f64, step: f64| if step > 0.0 { (value / step).round() * step } else { value };
        let position = position + position_noise * self.gaussian();
        let velocity = velocity + velocity_noise * self.gaussian();
        (round(position, position_resolution), round(velocity, velocity_resolution))
    }

    /// Whether the controllers' computer makes it this time.
    pub(crate) fn tick(&mut self) -> Tick {
        if self.is_calm {
            return Tick::OnTime;
        }
        let draw = self.unit();
        if draw < self.timing.dropped {
            Tick::Dropped
        } else if draw < self.timing.dropped + self.timing.late {
            Tick::Late
        } else {
            Tick::OnTime
        }
    }

    /// Uniform in [0, 1).
    fn unit(&mut self) -> f64 {
        (self.noise.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Standard normal, by Box and Muller.
    fn gaussian(&mut self) -> f64 {
        let (u, v) = (1.0 - self.unit(), self.unit());
        (-2.0 * libm::log(u)).sqrt() * libm::cos(std::f64::consts::TAU * v)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_has_the_spread_asked_for_and_repeats() {
        let sensors = Sensors {
            position_noise: 2e-5,
            velocity_noise: 1e-3,
            position_resolution: 0.0,
            velocity_resolution: 0.0,
        };
        let timing = Timing { late: 0.1, dropped: 0.05 };
        let build = || Surroundings::new(Vec::new(), Vec::new(), sensors, timing, 3);
        let (mut one, mut other) = (build(), build());
        let mut squares = 0.0;
        for _ in 0..20_000 {
            let seen = one.sensed(0.3, 0.0);
            assert_eq!(seen, other.sensed(0.3, 0.0));
            squares += (seen.0 - 0.3).powi(2);
        }
        let spread = (squares / 20_000.0_f64).sqrt();
        assert!((spread / 2e-5 - 1.0).abs() < 0.02, "{spread}");
        let ticks: Vec<Tick> = (0..20_000).map(|_| one.tick()).collect();
        let share = |kind| ticks.iter().filter(|&&tick| tick == kind).count() as f64 / 20_000.0;
        assert!((share(Tick::Late) - 0.1).abs() < 0.01 && (share(Tick::Dropped) - 0.05).abs() < 0.01);
    }

    #[test]
    fn forces_add_up_while_they_act_and_a_fault_leaves_its_share() {
        let mut surroundings = Surroundings::calm();
        surroundings.forces = vec![
            TipForce { from: 1.0, until: 2.0, force: [100.0, 0.0, -500.0] },
            TipForce { from: 1.5, until: 3.0, force: [0.0, 0.0, -500.0] },
        ];
        surroundings.faults = vec![ActuatorFault { joint: 1, at: 1.0, share: 0.5 }];
        assert_eq!(surroundings.tip_wrench(0.99), None);
        assert_eq!(surroundings.tip_wrench(1.7).unwrap().force, [100.0, 0.0, -1000.0]);
        assert_eq!(surroundings.tip_wrench(2.0).unwrap().force, [0.0, 0.0, -500.0]);
        assert_eq!(surroundings.exerted(1, 8.0, 0.9), 8.0);
        assert_eq!((surroundings.exerted(1, 8.0, 1.0), surroundings.exerted(0, 8.0, 1.0)), (4.0, 8.0));
    }
}
