//! Headers that pass their checksum and still contradict themselves.

use serde_json::{Value, json};

use super::*;
use crate::config::ConfigSpec;

fn spec() -> ConfigSpec {
    let table_1 = Config::table_1().spec().clone();
    ConfigSpec { batch_size: 2, update_after: 2, replay_capacity: 4, hidden: vec![3], ..table_1 }
}

/// A checkpoint of a fresh agent, and its header.
fn checkpoint() -> (Vec<u8>, Value) {
    let agent = Agent::new(Config::try_from(spec()).unwrap(), 2, 1, 1).unwrap();
    let mut bytes = Vec::new();
    agent.save(&mut bytes).unwrap();
    let length = u32::from_le_bytes(bytes[20..24].try_into().unwrap()) as usize;
    let header = serde_json::from_slice(&bytes[24..24 + length]).unwrap();
    (bytes, header)
}

/// The cause that is given for a header with `field` set to `value`, its checksum right and the numbers in place.
fn refusal(field: &str, value: Value) -> CheckpointError {
    let (bytes, mut header) = checkpoint();
    let old_length = u32::from_le_bytes(bytes[20..24].try_into().unwrap()) as usize;
    let numbers: Vec<f32> = bytes[24 + old_length + 4..bytes.len() - 4]
        .chunks_exact(4)
        .map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
        .collect();
    header[field] = value;
    let mut forged = Vec::new();
    let mut frame = Frame::begin(&mut forged, FORMAT, &header, 4 * numbers.len() as u64).unwrap();
    frame.numbers(&numbers).unwrap();
    frame.finish().unwrap();
    Agent::load(&mut forged.as_slice()).expect_err("a header that contradicts itself must be refused")
}

#[test]
fn a_header_written_again_unchanged_is_accepted() {
    let (bytes, header) = checkpoint();
    assert!(Agent::load(&mut bytes.as_slice()).is_ok());
    let error = refusal("steps", json!("many"));
    assert!(matches!(error, CheckpointError::Header(_)), "{error}");
    assert_eq!(header["replay_len"], json!(0));
}

#[test]
fn a_ring_that_cannot_be_is_refused() {
    let error = refusal("replay_len", json!(5)).to_string();
    assert_eq!(error, "inconsistent: replay_len is 5, expected 4");
    let error = refusal("replay_next", json!(1)).to_string();
    assert_eq!(error, "inconsistent: replay_next is 1, expected 0");
}

#[test]
fn a_header_that_asks_for_more_numbers_than_there_are_is_refused_before_anything_is_allocated() {
    for (field, value) in [
        ("replay_len", json!(3)),
        ("observation_dim", json!(usize::MAX)),
        ("action_dim", json!(usize::MAX / 2)),
        ("observation_dim", json!(0)),
    ] {
        let error = refusal(field, value.clone());
        let expected = "length of the numbers [bytes]";
        assert!(
            matches!(error, CheckpointError::Inconsistent { part, .. } if part == expected),
            "{field} = {value}: {error}"
        );
    }
}

#[test]
fn hyperparameters_of_a_checkpoint_pass_the_same_gate_as_those_of_a_file() {
    let mut config = serde_json::to_value(spec()).unwrap();
    config["discount"] = json!(1.5);
    let error = refusal("config", config).to_string();
    assert!(error.starts_with("unusable header: discount must be in [0, 1), got 1.5"), "{error}");
}

#[test]
fn an_unknown_field_is_refused() {
    let error = refusal("colour", json!("orange")).to_string();
    assert!(error.starts_with("unusable header: unknown field `colour`"), "{error}");
}

#[test]
fn an_agent_that_has_diverged_is_neither_saved_nor_read() {
    let mut agent = Agent::new(Config::try_from(spec()).unwrap(), 2, 1, 1).unwrap();
    let (whole, _) = checkpoint();
    agent.critic_optimizer.moments[1][0].second[2] = f32::INFINITY;
    let mut bytes = Vec::new();
    let error = agent.save(&mut bytes).unwrap_err();
    assert_eq!(error.to_string(), "not finite: a number of the moments of Adam is inf");
    assert!(bytes.is_empty(), "{} bytes were written", bytes.len());

    // The same checkpoint with NaN for ln α, its checksum put right.
    let length = u32::from_le_bytes(whole[20..24].try_into().unwrap()) as usize;
    let mut bytes = whole[..whole.len() - 4].to_vec();
    bytes[28 + length..36 + length].copy_from_slice(&f64::NAN.to_le_bytes());
    let sum = crc32fast::hash(&bytes);
    bytes.extend_from_slice(&sum.to_le_bytes());
    let error = Agent::load(&mut bytes.as_slice()).unwrap_err();
    assert_eq!(error.to_string(), "not finite: a number of the entropy temperature is NaN");
}

/// What version 1 of this format wrote: no averaged policy, neither its share nor its weights.
fn version_1(agent: &Agent) -> Vec<u8> {
    let mut bytes = Vec::new();
    agent.save(&mut bytes).unwrap();
    let length = u32::from_le_bytes(bytes[20..24].try_into().unwrap()) as usize;
    let mut header: Value = serde_json::from_slice(&bytes[24..24 + length]).unwrap();
    header["config"].as_object_mut().unwrap().remove("policy_share").unwrap();
    let numbers = &bytes[24 + length + 4..bytes.len() - 4];
    let networks = |network: &crate::network::Network| {
        let mut count = 0;
        network.visit(|values| count += 4 * values.len());
        count
    };
    let actor = networks(&agent.actor);
    let policy = 24 + actor + 2 * networks(&agent.critics);
    let kept = [&numbers[..policy], &numbers[policy + actor..]].concat();
    let mut old = Vec::new();
    let format = Format { version: 1, ..FORMAT };
    let mut frame = Frame::begin(&mut old, format, &header, kept.len() as u64).unwrap();
    for bytes in kept.chunks_exact(4) {
        frame.numbers(&[f32::from_le_bytes(bytes.try_into().unwrap())]).unwrap();
    }
    frame.finish().unwrap();
    old
}

#[test]
fn a_checkpoint_of_version_1_continues_with_its_actor_as_the_policy() {
    let mut agent = Agent::new(Config::try_from(spec()).unwrap(), 2, 1, 1).unwrap();
    for step in 0..6 {
        let transition = crate::Transition {
            observation: &[0.1 * step as f32, 1.0],
            action: &[0.5],
            reward: 1.0,
            next_observation: &[0.2, 0.3],
            outcome: crate::Outcome::Continues,
        };
        agent.remember(&transition).unwrap();
        agent.update();
    }
    let mut resumed = Agent::load(&mut version_1(&agent).as_slice()).unwrap();
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    agent.save(&mut ours).unwrap();
    resumed.save(&mut theirs).unwrap();
    assert!(ours == theirs, "the policy of this configuration is the actor");
    assert_eq!(resumed.update(), agent.update());
    assert_eq!(resumed.policy(), agent.policy());
}
