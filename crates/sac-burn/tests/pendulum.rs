//! The agent swings up a pendulum, a task that others solve too: Gymnasium's `Pendulum-v1`, written anew.

use sac_burn::{Agent, Config, ConfigSpec, Outcome, Policy, Transition};

/// Environment steps of a training, random ones included.
const STEPS: u32 = 6_000;

/// Steps of an episode; there is no other end.
const EPISODE: u32 = 200;

/// Seeds that must all succeed.
const SEEDS: [u64; 5] = [0, 1, 2, 3, 4];

/// Mean return of 20 episodes that counts as solved.
///
/// The best possible lies near −145 on average over starts: the pendulum first has to swing, which costs. A policy that
/// fails to swing up from anywhere collects −1200 to −1700 there, so that one failure in 20 costs 50 or more.
const SOLVED: f64 = -200.0;

/// A rod of 1 m and 1 kg about its end, g = 10 m/s²; upright at angle 0.
struct Pendulum {
    /// [rad]
    angle: f64,
    /// [rad/s], at most 8.
    speed: f64,
    steps: u32,
}

impl Pendulum {
    /// Anywhere, and no faster than 1 rad/s.
    fn draw(starts: &mut Starts) -> Self {
        Self { angle: std::f64::consts::PI * starts.uniform(), speed: starts.uniform(), steps: 0 }
    }

    /// The sine and cosine of the angle and the speed relative to its limit.
    fn observation(&self) -> [f32; 3] {
        [self.angle.cos(), self.angle.sin(), self.speed / 8.0].map(|x| x as f32)
    }

    /// One step of 0.05 s under a torque of at most 2 N·m; gives the reward.
    fn step(&mut self, action: f32) -> (f64, Outcome) {
        let torque = 2.0 * f64::from(action).clamp(-1.0, 1.0);
        let turn = std::f64::consts::TAU;
        let from_top = (self.angle + 0.5 * turn).rem_euclid(turn) - 0.5 * turn;
        let reward = -(from_top.powi(2) + 0.1 * self.speed.powi(2) + 0.001 * torque.powi(2));
        let acceleration = 1.5 * 10.0 * self.angle.sin() + 3.0 * torque; // 3g/2l·sin θ + 3u/ml²
        self.speed = (self.speed + 0.05 * acceleration).clamp(-8.0, 8.0);
        self.angle += 0.05 * self.speed;
        self.steps += 1;
        (reward, if self.steps == EPISODE { Outcome::Truncated } else { Outcome::Continues })
    }
}

/// Where episodes start: Weyl's sequences of two irrational numbers, which fill the square evenly.
struct Starts {
    drawn: u64,
}

impl Starts {
    /// In [−1, 1).
    fn uniform(&mut self) -> f64 {
        self.drawn += 1;
        let irrational = [2f64, 3.0][(self.drawn % 2) as usize].sqrt();
        2.0 * ((self.drawn / 2) as f64 * irrational).fract() - 1.0
    }
}

fn trained(seed: u64) -> Agent {
    let spec = ConfigSpec {
        batch_size: 64,
        replay_capacity: STEPS as usize,
        learning_rate: 2e-3,
        polyak: 0.01,
        random_steps: 500,
        update_after: 500,
        hidden: vec![64, 64],
        ..Config::table_1().spec().clone()
    };
    let config = Config::try_from(spec).expect("the specification is valid");
    let mut agent = Agent::new(config, 3, 1, seed).expect("there is memory for the replay");
    let mut starts = Starts { drawn: 10_000 * (seed + 1) };
    let mut pendulum = Pendulum::draw(&mut starts);
    for step in 0..STEPS {
        let observation = pendulum.observation();
        let mut action = [0.0];
        agent.act(&observation, &mut action);
        let (reward, outcome) = pendulum.step(action[0]);
        let transition = Transition {
            observation: &observation,
            action: &action,
            reward: reward as f32,
            next_observation: &pendulum.observation(),
            outcome,
        };
        agent.remember(&transition).expect("the transition is finite");
        if let Some(losses) = agent.update() {
            assert!(losses.is_finite(), "seed {seed}, step {step}: {losses:?}");
        }
        if outcome != Outcome::Continues {
            pendulum = Pendulum::draw(&mut starts);
        }
    }
    agent
}

/// Mean return of the policy without exploration over 20 episodes, the same for every policy.
fn mean_return(policy: &Policy) -> f64 {
    let mut starts = Starts { drawn: 1_000_000 };
    let mut sum = 0.0;
    for _ in 0..20 {
        let mut pendulum = Pendulum::draw(&mut starts);
        loop {
            let mut action = [0.0];
            policy.act(&pendulum.observation(), &mut action);
            let (reward, outcome) = pendulum.step(action[0]);
            sum += reward;
            if outcome != Outcome::Continues {
                break;
            }
        }
    }
    sum / 20.0
}

#[test]
fn a_pendulum_is_swung_up_by_five_of_five_seeds_within_six_thousand_steps() {
    let untrained = trained_for_nothing();
    assert!(untrained < 4.0 * SOLVED, "the task is too easy: {untrained} without training");
    let returns: Vec<f64> = std::thread::scope(|scope| {
        let trainings = SEEDS.map(|seed| scope.spawn(move || mean_return(trained(seed).policy())));
        trainings.map(|training| training.join().expect("a training that panics fails the test")).into()
    });
    eprintln!("mean returns {returns:.1?}");
    for (seed, found) in SEEDS.iter().zip(&returns) {
        assert!(*found >= SOLVED, "seed {seed}: mean return {found:.1}; all: {returns:.1?}");
    }
}

/// Mean return of a policy that has learnt nothing.
fn trained_for_nothing() -> f64 {
    let agent = Agent::new(Config::table_1(), 3, 1, 0).expect("there is memory for the replay");
    mean_return(agent.policy())
}

#[test]
fn the_pendulum_is_gymnasium_s() {
    // From (θ, θ̇) = (0.5, −1) with u = 1.5: r = −(0.25 + 0.1 + 0.00225); θ̈ = 15 sin 0.5 + 4.5.
    let mut pendulum = Pendulum { angle: 0.5, speed: -1.0, steps: 0 };
    let (reward, _) = pendulum.step(0.75);
    let speed = -1.0 + 0.05 * (15.0 * 0.5f64.sin() + 4.5);
    assert!((reward + 0.352_25).abs() < 1e-12, "{reward}");
    assert!((pendulum.speed - speed).abs() < 1e-12 && (pendulum.angle - (0.5 + 0.05 * speed)).abs() < 1e-12);
    // The angle counts from the nearest top, and the speed is limited.
    let mut fast = Pendulum { angle: std::f64::consts::TAU + 0.1, speed: 8.0, steps: EPISODE - 1 };
    let (reward, outcome) = fast.step(9.0);
    assert!((reward + 0.01 + 6.4 + 0.004).abs() < 1e-12, "{reward}");
    assert_eq!((fast.speed, outcome), (8.0, Outcome::Truncated));
}
