//! Damaged, truncated and foreign files are refused with their cause; nothing panics.

mod common;

use std::io::{self, Write};

use common::{World, agent, saved, small};
use sac_burn::{Agent, CheckpointError, ConfigSpec, Policy};

fn checkpoint() -> Vec<u8> {
    let mut agent = agent(ConfigSpec { hidden: vec![4], ..small() }, 1);
    World { tick: 0 }.run(&mut agent, 70);
    saved(&agent)
}

#[test]
fn every_truncation_is_refused_as_one() {
    let bytes = checkpoint();
    for length in 0..bytes.len() {
        let error = Agent::load(&mut &bytes[..length]).expect_err("a part of a file must be refused");
        assert!(matches!(error, CheckpointError::Truncated { .. }), "{length} bytes: {error}");
    }
}

#[test]
fn every_flipped_byte_is_refused() {
    let bytes = checkpoint();
    for at in 0..bytes.len() {
        let mut damaged = bytes.clone();
        damaged[at] ^= 0x10;
        assert!(Agent::load(&mut damaged.as_slice()).is_err(), "a flipped bit in byte {at} went unnoticed");
    }
}

#[test]
fn the_cause_is_named() {
    let bytes = checkpoint();
    let load = |bytes: &[u8]| Agent::load(&mut &*bytes).unwrap_err().to_string();
    let foreign = load(b"a photograph of a crane, perhaps");
    assert_eq!(foreign, "not a file of kind \"agent checkpoint\": it begins with \"a photog\"");
    let mut version = bytes.clone();
    version[8] = 9;
    assert_eq!(load(&version), "format version 9 is not supported, this program reads versions 1 to 2");
    let mut number = bytes.clone();
    let at = bytes.len() - 100;
    number[at] ^= 1;
    assert!(load(&number).starts_with("corrupted: the checksum of the file is"), "{}", load(&number));
    let mut header = bytes.clone();
    header[40] ^= 1;
    assert!(load(&header).starts_with("corrupted: the checksum of the header is"), "{}", load(&header));
    assert!(load(&bytes[..bytes.len() - 1]).starts_with("truncated: the stream ends inside"));
}

#[test]
fn a_policy_is_no_checkpoint_and_a_checkpoint_no_policy() {
    let agent = agent(small(), 1);
    let policy = agent.policy().to_bytes();
    let error = Agent::load(&mut policy.as_slice()).unwrap_err();
    assert!(matches!(error, CheckpointError::WrongMagic { .. }), "{error}");
    let error = Policy::from_bytes(&saved(&agent)).unwrap_err();
    assert!(matches!(error, CheckpointError::WrongMagic { .. }), "{error}");
}

#[test]
fn a_damaged_truncated_or_extended_policy_is_refused() {
    let bytes = agent(ConfigSpec { hidden: vec![4], ..small() }, 1).policy().to_bytes();
    for at in 0..bytes.len() {
        let mut damaged = bytes.clone();
        damaged[at] ^= 0x01;
        assert!(Policy::from_bytes(&damaged).is_err(), "a flipped bit in byte {at} went unnoticed");
        assert!(Policy::from_bytes(&bytes[..at]).is_err(), "{at} bytes were taken for a policy");
    }
    let longer = [bytes.as_slice(), &[0]].concat();
    let error = Policy::from_bytes(&longer).unwrap_err();
    assert!(matches!(error, CheckpointError::Inconsistent { found: 1, .. }), "{error}");
}

#[test]
fn loading_stops_right_behind_the_checkpoint() {
    let mut bytes = checkpoint();
    bytes.extend_from_slice(b"curriculum");
    let mut rest = bytes.as_slice();
    Agent::load(&mut rest).unwrap();
    assert_eq!(rest, b"curriculum");
}

/// A disk with room for so many bytes.
struct Disk(usize);

impl Write for Disk {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if bytes.len() > self.0 {
            return Err(io::ErrorKind::StorageFull.into());
        }
        self.0 -= bytes.len();
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_full_disk_is_an_error_of_the_stream_and_the_agent_goes_on() {
    let mut agent = agent(small(), 1);
    World { tick: 0 }.run(&mut agent, 70);
    let whole = saved(&agent);
    for room in [0, 20, 1000, whole.len() - 1] {
        let error = agent.save(&mut Disk(room)).unwrap_err();
        assert!(
            matches!(&error, CheckpointError::Io(cause) if cause.kind() == io::ErrorKind::StorageFull),
            "{room} bytes of room: {error}"
        );
    }
    assert!(agent.save(&mut Disk(whole.len())).is_ok());
    assert!(saved(&agent) == whole, "a failed save changed the agent");
}
