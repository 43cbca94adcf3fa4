//! The agent learns tasks whose optimum is known.

use sac_burn::{Agent, Config, ConfigSpec, Outcome, Policy, Transition};

fn spec() -> ConfigSpec {
    ConfigSpec {
        batch_size: 64,
        replay_capacity: 10_000,
        learning_rate: 3e-3,
        polyak: 0.01,
        random_steps: 200,
        update_after: 200,
        hidden: vec![32, 32],
        initial_entropy_temperature: 0.2,
        discount: 0.95,
        ..Config::table_1().spec().clone()
    }
}

fn agent(spec: ConfigSpec, observation_dim: usize, seed: u64) -> Agent {
    let config = Config::try_from(spec).expect("the specification is valid");
    Agent::new(config, observation_dim, 1, seed).expect("there is memory for the replay")
}

/// Point mass on a line: the action is its velocity, 0.2 per step at most; the episode ends at the origin.
struct PointMass {
    position: f32,
    steps: u32,
}

impl PointMass {
    const LIMIT: u32 = 25;

    fn start(position: f32) -> Self {
        Self { position, steps: 0 }
    }

    fn step(&mut self, action: f32) -> (f32, Outcome) {
        self.position = (self.position + 0.2 * action).clamp(-1.5, 1.5);
        self.steps += 1;
        match () {
            () if self.position.abs() < 0.05 => (1.0, Outcome::Terminal),
            () if self.steps == Self::LIMIT => (-self.position.abs(), Outcome::Truncated),
            () => (-self.position.abs(), Outcome::Continues),
        }
    }

    /// Steps that a policy takes from `position` to the origin; the limit if it does not arrive.
    fn steps_of(policy: &Policy, position: f32) -> u32 {
        let mut world = Self::start(position);
        loop {
            let mut action = [0.0];
            policy.act(&[world.position], &mut action);
            if world.step(action[0]).1 != Outcome::Continues {
                return world.steps;
            }
        }
    }
}

#[test]
fn a_point_mass_learns_to_go_to_the_origin_and_stop_there() {
    let mut agent = agent(spec(), 1, 3);
    let starts: Vec<f32> = (0..41).map(|i| -1.0 + 0.05 * i as f32).filter(|x| x.abs() > 0.06).collect();
    let untrained: u32 = starts.iter().map(|x| PointMass::steps_of(agent.policy(), *x)).sum();
    let mut world = PointMass::start(0.9);
    for step in 0..2500u32 {
        let before = world.position;
        let mut action = [0.0];
        agent.act(&[before], &mut action);
        let (reward, outcome) = world.step(action[0]);
        let transition = Transition {
            observation: &[before],
            action: &action,
            reward,
            next_observation: &[world.position],
            outcome,
        };
        agent.remember(&transition).unwrap();
        if let Some(losses) = agent.update() {
            assert!(losses.is_finite(), "step {step}: {losses:?}");
        }
        if outcome != Outcome::Continues {
            world = PointMass::start(((step as f32) * 0.618_034).fract() * 2.0 - 1.0);
        }
    }
    // With 0.2 per step and a catch radius of 0.05 the optimum is ⌈(|x| − 0.05)/0.2⌉ steps.
    let mut excess = 0;
    for &start in &starts {
        let steps = PointMass::steps_of(agent.policy(), start);
        let least = ((start.abs() - 0.05) / 0.2).ceil() as u32;
        assert!(steps < PointMass::LIMIT, "never arrives from {start}");
        excess += steps - least.min(steps);
    }
    let trained: u32 = starts.iter().map(|x| PointMass::steps_of(agent.policy(), *x)).sum();
    assert!(untrained > 2 * trained, "untrained {untrained} steps, trained {trained}");
    let mean_excess = f64::from(excess) / starts.len() as f64;
    assert!(mean_excess < 1.0, "{mean_excess} steps above the optimum on average");
}

/// One state, reward 1 at every step. The value of the state tells whether the bootstrap was cut.
fn learnt_value(outcome: Outcome) -> f64 {
    let spec = ConfigSpec {
        discount: 0.8,
        polyak: 0.1, // the value creeps up by polyak·(1 − discount) per update
        initial_entropy_temperature: 1e-6,
        target_entropy: Some(-1000.0), // keeps the temperature at nothing
        ..spec()
    };
    let mut agent = agent(spec, 1, 4);
    let mut last = 0.0;
    for _ in 0..1200 {
        let mut action = [0.0];
        agent.act(&[1.0], &mut action);
        let transition = Transition {
            observation: &[1.0],
            action: &action,
            reward: 1.0,
            next_observation: &[1.0],
            outcome,
        };
        agent.remember(&transition).expect("the transition is finite");
        if let Some(losses) = agent.update() {
            last = losses.mean_q;
        }
    }
    last
}

#[test]
fn truncation_bootstraps_and_termination_does_not() {
    // 1/(1 − 0.8) = 5 where the bootstrap goes on, 1 where it is cut.
    let terminal = learnt_value(Outcome::Terminal);
    assert!((terminal - 1.0).abs() < 0.05, "terminal: {terminal}");
    let truncated = learnt_value(Outcome::Truncated);
    assert!((truncated - 5.0).abs() < 0.25, "truncated: {truncated}");
    let continuing = learnt_value(Outcome::Continues);
    assert_eq!(continuing.to_bits(), truncated.to_bits());
}

#[test]
fn a_bandit_settles_at_the_target_entropy_around_the_best_action() {
    // Reward −4(a − 0.4)²; the policy keeps the entropy it was asked for and centres on the best action.
    let spec = ConfigSpec { target_entropy: Some(-1.0), learning_rate: 2e-3, ..spec() };
    let mut agent = agent(spec, 1, 5);
    let (mut entropy, mut count) = (0.0, 0.0);
    for step in 0..4000 {
        let mut action = [0.0];
        agent.act(&[0.0], &mut action);
        let transition = Transition {
            observation: &[0.0],
            action: &action,
            reward: -4.0 * (action[0] - 0.4).powi(2),
            next_observation: &[0.0],
            outcome: Outcome::Terminal,
        };
        agent.remember(&transition).unwrap();
        if let Some(losses) = agent.update()
            && step >= 3500
        {
            entropy += losses.entropy;
            count += 1.0;
        }
    }
    let mut action = [0.0];
    agent.act_deterministic(&[0.0], &mut action);
    assert!((action[0] - 0.4).abs() < 0.1, "centre {}", action[0]);
    assert!((entropy / count + 1.0f64).abs() < 0.2, "entropy {}", entropy / count);
}
