//! What actions look like, and when the agent learns.

mod common;

use common::{World, agent, small};
use sac_burn::{Agent, AgentError, Config, ConfigSpec, Outcome, Policy, Transition, TransitionError};

#[test]
fn a_policy_read_back_acts_bit_for_bit_like_the_agent() {
    let mut agent = agent(small(), 1);
    World { tick: 0 }.run(&mut agent, 120);
    let policy = Policy::from_bytes(&agent.policy().to_bytes()).unwrap();
    assert_eq!(&policy, agent.policy());
    assert_eq!((policy.observation_dim(), policy.action_dim()), (3, 2));
    for i in 0..100 {
        let observation = [0.1 * i as f32 - 5.0, (i as f32).sin(), 0.5];
        let (mut from_agent, mut from_policy) = ([0.0f32; 2], [0.0f32; 2]);
        agent.act_deterministic(&observation, &mut from_agent);
        policy.act(&observation, &mut from_policy);
        assert_eq!(from_agent.map(f32::to_bits), from_policy.map(f32::to_bits));
    }
}

#[test]
fn the_policy_follows_every_update() {
    let mut agent = agent(small(), 1);
    World { tick: 0 }.run(&mut agent, 63);
    let before = agent.policy().clone();
    World { tick: 63 }.run(&mut agent, 1);
    assert_eq!(agent.updates(), 1);
    assert_ne!(agent.policy(), &before);
}

#[test]
fn random_steps_are_uniform_and_then_the_policy_acts() {
    let spec = ConfigSpec { random_steps: 2000, update_after: 3000, replay_capacity: 3000, ..small() };
    let mut agent = agent(spec, 2);
    let mut histogram = [0u32; 4];
    let transition = Transition {
        observation: &[0.0; 3],
        action: &[0.0; 2],
        reward: 0.0,
        next_observation: &[0.0; 3],
        outcome: Outcome::Continues,
    };
    for _ in 0..2000 {
        assert!(agent.is_warming_up());
        let mut action = [0.0; 2];
        agent.act(&[0.0; 3], &mut action);
        for a in action {
            histogram[((a + 1.0) * 2.0) as usize] += 1;
        }
        agent.remember(&transition).unwrap();
    }
    assert!(!agent.is_warming_up());
    // 4000 numbers in four equal bins: 1000 each, standard deviation 27.
    assert!(histogram.iter().all(|n| n.abs_diff(1000) < 140), "{histogram:?}");
}

#[test]
fn stochastic_actions_scatter_around_the_deterministic_one() {
    let mut agent = agent(ConfigSpec { random_steps: 0, log_std_max: -2.0, ..small() }, 3);
    let mut centre = [0.0; 2];
    agent.act_deterministic(&[0.4, -0.2, 0.9], &mut centre);
    let (mut mean, count) = ([0.0f32; 2], 2000);
    for _ in 0..count {
        let mut action = [0.0; 2];
        agent.act(&[0.4, -0.2, 0.9], &mut action);
        assert!(action.iter().all(|a| a.abs() <= 1.0));
        for (m, a) in mean.iter_mut().zip(action) {
            *m += a / count as f32;
        }
    }
    for (m, c) in mean.iter().zip(centre) {
        // σ ≤ e⁻² = 0.135; five standard deviations of the mean, and the bend of tanh.
        assert!((m - c).abs() < 5.0 * 0.135 / (count as f32).sqrt() + 0.01, "mean {m}, centre {c}");
    }
}

#[test]
fn no_update_before_update_after_transitions() {
    let mut agent = agent(small(), 4);
    World { tick: 0 }.run(&mut agent, 63);
    assert_eq!((agent.updates(), agent.update()), (0, None));
    World { tick: 63 }.run(&mut agent, 1);
    assert_eq!((agent.steps(), agent.updates(), agent.replay_len()), (64, 1, 64));
    agent.clear_replay();
    assert_eq!((agent.replay_len(), agent.update()), (0, None));
}

#[test]
fn a_refused_transition_leaves_no_trace() {
    let mut agent = agent(small(), 5);
    let transition = Transition {
        observation: &[0.0, f32::NAN, 0.0],
        action: &[0.0; 2],
        reward: 0.0,
        next_observation: &[0.0; 3],
        outcome: Outcome::Continues,
    };
    let error = agent.remember(&transition).unwrap_err();
    assert!(matches!(error, TransitionError::NotFinite { part: "observation", index: 1, .. }));
    assert_eq!(error.to_string(), "observation[1] is not finite: NaN");
    assert_eq!((agent.steps(), agent.replay_len()), (0, 0));
}

#[test]
fn refuses_an_agent_without_observation_or_action() {
    let config = || Config::try_from(small()).unwrap();
    let error = Agent::new(config(), 0, 2, 1).unwrap_err();
    assert_eq!(error, AgentError::ZeroDimension { dimension: "observation_dim" });
    let error = Agent::new(config(), 3, 0, 1).unwrap_err();
    assert_eq!(error.to_string(), "action_dim must be at least 1, got 0");
}

#[test]
fn one_hidden_layer_and_three_work_as_well_as_two() {
    for hidden in [vec![16], vec![16, 8, 4]] {
        let mut agent = agent(ConfigSpec { hidden, ..small() }, 6);
        World { tick: 0 }.run(&mut agent, 100);
        assert_eq!(agent.updates(), 37);
    }
}
