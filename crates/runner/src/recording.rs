//! An episode as it was played, for pictures and for playing it again.

use anyhow::Result;
use jbtg::State;
use safezone::{Command, Request};

use crate::environment::{Ending, Environment, Episode};
use crate::evidence::Evidence;

/// How much of an episode is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// What happens once per policy step.
    Steps,
    /// Every tick of the integration as well: some thousand times a second.
    Ticks,
}

/// An episode as it was played. Lists by joint hold the moving joints, in the order of the actions.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Start and target. Together with the actions they are the episode: playing them again gives it bit for bit.
    pub episode: Episode,
    /// How it ended.
    pub ending: Ending,
    /// Every policy step.
    pub steps: Vec<RecordedStep>,
    /// Every tick, or none.
    pub ticks: Vec<RecordedTick>,
    /// Position of every joint of the crane before each step and after the last [rad or m].
    pub postures: Vec<Vec<f64>>,
    /// Tip in the world before each step and after the last \[m\].
    pub tips: Vec<[f64; 3]>,
    /// What was seen of the limits.
    pub evidence: Evidence,
}

/// What a policy step decides.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedStep {
    /// The action, by joint, as the policy gave it.
    pub action: Vec<f32>,
    /// State of each joint's reference when the step begins.
    pub reference: Vec<State>,
    /// The velocity chosen for the step's end, by joint, and the safe range that it was chosen from.
    pub commands: Vec<Command>,
}

/// Where every joint is and should be.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedTick {
    /// Since the start of the episode \[s\].
    pub time: f64,
    /// The reference, exactly.
    pub reference: Vec<State>,
    /// The actual motion; its jerk is the change of its acceleration from one tick to the next.
    pub actual: Vec<State>,
}

/// Plays an episode to its end, `act` giving each action from what it sees of the environment.
///
/// # Errors
/// The crane cannot rest where the episode starts, or the simulation left its range.
pub fn play(
    environment: &mut Environment,
    episode: &Episode,
    detail: Detail,
    mut act: impl FnMut(&Environment, &mut [f32]),
) -> Result<Recording> {
    environment.take_evidence();
    environment.start(episode)?;
    let joints = environment.motion().machine().moving().to_vec();
    let rates = environment.motion().machine().rates();
    let mut recording = Recording {
        episode: episode.clone(),
        ending: Ending::TimeOut,
        steps: Vec::new(),
        ticks: Vec::new(),
        postures: vec![environment.motion().position().to_vec()],
        tips: vec![environment.tip()],
        evidence: Evidence::none(environment.motion().machine().joints().len()),
    };
    let mut action = vec![0.0; joints.len()];
    let mut acceleration = vec![0.0; joints.len()];
    loop {
        act(environment, &mut action);
        let motion = environment.motion();
        let reference: Vec<State> = joints.iter().map(|&joint| motion.reference()[joint]).collect();
        let zones = joints.iter().map(|&joint| &motion.machine().joints()[joint].zone);
        let begin = zones.zip(&reference).zip(&action);
        let planned: Vec<_> = begin
            .map(|((zone, state), &action)| {
                let request = Request::Action(f64::from(action));
                let command = zone.command(state.position, state.velocity, request);
                let way = zone.planner().ramp(state.position, state.velocity, command.velocity);
                way.map(|way| (command, way))
            })
            .collect::<Result<_, _>>()?;
        let first_tick = recording.steps.len() as u64 * u64::from(rates.policy_divider);
        let mut tick = 0;
        let ticks = &mut recording.ticks;
        let step = environment.step_seen(&action, |motion| {
            tick += 1;
            if detail == Detail::Steps {
                return;
            }
            let since = f64::from(tick) * rates.tick_period();
            let at_end = tick == rates.policy_divider;
            let reference =
                planned.iter().map(|(_, way)| if at_end { way.end() } else { way.state_at(since) });
            let actual = joints.iter().zip(&mut acceleration).map(|(&joint, before)| {
                let now = motion.acceleration()[joint];
                let jerk = (now - std::mem::replace(before, now)) / rates.tick_period();
                let (position, velocity) = (motion.position()[joint], motion.velocity()[joint]);
                State { position, velocity, acceleration: now, jerk }
            });
            ticks.push(RecordedTick {
                time: (first_tick + u64::from(tick)) as f64 * rates.tick_period(),
                reference: reference.collect(),
                actual: actual.collect(),
            });
        })?;
        let commands = planned.iter().map(|(command, _)| *command).collect();
        recording.steps.push(RecordedStep { action: action.clone(), reference, commands });
        recording.postures.push(environment.motion().position().to_vec());
        recording.tips.push(environment.tip());
        if let Some(ending) = step.ending {
            recording.ending = ending;
            recording.evidence = environment.take_evidence();
            return Ok(recording);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::sync::Arc;

    use super::*;
    use crate::config::ConfigSpec;
    use crate::draw::{Purpose, Stream};
    use crate::machine::Machine;
    use crate::stage::Stage;

    const STEPS: u32 = 8;

    /// A short episode of the real crane under actions that differ from step to step and joint to joint.
    fn recorded(detail: Detail) -> (Arc<Machine>, Recording) {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let mut config = ConfigSpec::read(&root.join(crate::config::DEFAULT)).unwrap();
        config.task.max_steps = STEPS;
        for path in [
            &mut config.crane.urdf,
            &mut config.crane.loops,
            &mut config.crane.plants,
            &mut config.crane.gains,
            &mut config.crane.tables,
            &mut config.crane.regions,
        ] {
            *path = root.join(&*path);
        }
        let machine = Arc::new(Machine::load(&config).unwrap());
        let mut environment = Environment::new(Arc::clone(&machine), false);
        let mut stream = Stream::of_episode(1, Purpose::Evaluation, Stage::Purple, 0);
        let episode = environment.draw(machine.regions().of(Stage::Purple), &mut stream).unwrap();
        let recording = play(&mut environment, &episode, detail, |environment, action| {
            for (joint, value) in action.iter_mut().enumerate() {
                *value = ((environment.steps() as f32 + 1.0) * (joint as f32 + 0.7)).sin();
            }
        });
        (machine, recording.unwrap())
    }

    #[test]
    fn a_recording_has_every_step_and_tick_and_joins_them() {
        let (machine, recording) = recorded(Detail::Ticks);
        let ticks = machine.rates().policy_divider as usize;
        assert_eq!(recording.steps.len(), STEPS as usize);
        assert_eq!(recording.ticks.len(), STEPS as usize * ticks);
        assert_eq!(
            (recording.postures.len(), recording.tips.len()),
            (STEPS as usize + 1, STEPS as usize + 1)
        );
        for (index, step) in recording.steps.iter().enumerate() {
            let end = &recording.ticks[(index + 1) * ticks - 1];
            for (joint, command) in step.commands.iter().enumerate() {
                assert!(command.range.contains(command.velocity));
                assert_eq!(end.reference[joint].velocity, command.velocity, "step {index}, joint {joint}");
                if let Some(next) = recording.steps.get(index + 1) {
                    assert_eq!(end.reference[joint], next.reference[joint], "step {index}, joint {joint}");
                }
                let error = end.reference[joint].position - end.actual[joint].position;
                assert!(error != 0.0 && error.abs() < 1e-3, "step {index}, joint {joint}: {error}");
            }
        }
        let last = recording.ticks.last().unwrap();
        for (joint, &index) in machine.moving().iter().enumerate() {
            assert_eq!(last.actual[joint].position, recording.postures[STEPS as usize][index]);
        }
    }

    #[test]
    fn detail_changes_nothing_but_what_is_kept() {
        let (_, ticks) = recorded(Detail::Ticks);
        let (_, steps) = recorded(Detail::Steps);
        assert!(steps.ticks.is_empty());
        assert_eq!(steps, Recording { ticks: Vec::new(), ..ticks });
    }

    #[test]
    fn the_evidence_is_of_this_episode() {
        let (machine, recording) = recorded(Detail::Steps);
        assert_eq!(recording.evidence.ranges, u64::from(STEPS) * machine.moving().len() as u64);
        assert_eq!(recording.evidence.reference_violations, 0);
    }
}
