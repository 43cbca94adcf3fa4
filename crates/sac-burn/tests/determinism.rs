//! Equal seeds, equal runs; a resumed run is the run that was never interrupted.

mod common;

use common::{World, agent, saved, small};
use sac_burn::{Agent, Config, ConfigSpec, ReplayStart};

#[test]
fn equal_seeds_give_bit_identical_runs_and_different_seeds_do_not() {
    let run = |seed| {
        let mut agent = agent(small(), seed);
        let trace = World { tick: 0 }.run(&mut agent, 200);
        (trace, saved(&agent))
    };
    let first = run(5);
    assert!(first == run(5), "two runs with one seed differ");
    assert!(first.0 != run(6).0, "two seeds give one run");
}

#[test]
fn a_run_resumed_from_a_checkpoint_equals_the_uninterrupted_one_bit_for_bit() {
    // Before the first update, between updates, and after the ring of 300 has wrapped.
    for interruption in [0, 30, 150, 333, 500] {
        let (mut whole, mut world) = (agent(small(), 8), World { tick: 0 });
        world.run(&mut whole, interruption);
        let bytes = saved(&whole);
        let mut resumed = Agent::load(&mut bytes.as_slice()).unwrap();
        assert_eq!(saved(&resumed), bytes, "loading and saving at once changes the checkpoint");
        let mut other = World { tick: world.tick };
        let expected = world.run(&mut whole, 120);
        let found = other.run(&mut resumed, 120);
        assert!(found == expected, "the run resumed at step {interruption} goes another way");
        assert!(saved(&resumed) == saved(&whole), "the states differ after a resumption at {interruption}");
    }
}

#[test]
fn wide_layers_are_deterministic_too() {
    // Products large enough to be split over threads, if there were any.
    let spec = ConfigSpec { hidden: vec![256, 256], batch_size: 64, ..small() };
    let run = || {
        let mut agent = agent(spec.clone(), 2);
        World { tick: 0 }.run(&mut agent, 80)
    };
    assert!(run() == run());
}

#[test]
fn deterministic_actions_draw_nothing() {
    let (mut quiet, mut asked) = (agent(small(), 3), agent(small(), 3));
    let mut action = [0.0; 2];
    asked.act_deterministic(&[0.1, 0.2, 0.3], &mut action);
    assert!(World { tick: 0 }.run(&mut quiet, 100) == World { tick: 0 }.run(&mut asked, 100));
}

#[test]
fn a_new_stage_continues_networks_optimisers_temperature_and_counters() {
    let mut first = agent(small(), 4);
    World { tick: 0 }.run(&mut first, 200);
    let (policy, temperature) = (first.policy().clone(), first.entropy_temperature());
    let later = Config::try_from(ConfigSpec { learning_rate: 1e-4, ..small() }).unwrap();
    let mut second = Agent::start_from(first, later.clone(), ReplayStart::Clear).unwrap();
    assert_eq!(second.policy(), &policy);
    assert_eq!(second.entropy_temperature().to_bits(), temperature.to_bits());
    assert_eq!((second.steps(), second.updates(), second.replay_len()), (200, 137, 0));
    assert!(!second.is_warming_up());
    assert_eq!(second.config(), &later);
    assert_eq!(second.update(), None);
    World { tick: 0 }.run(&mut second, 64);
    assert_eq!(second.updates(), 138);
}

#[test]
fn a_new_stage_may_keep_the_replay_in_another_capacity_but_not_change_the_networks() {
    let mut first = agent(small(), 4);
    World { tick: 0 }.run(&mut first, 350);
    let smaller = Config::try_from(ConfigSpec { replay_capacity: 100, ..small() }).unwrap();
    let second = Agent::start_from(first, smaller, ReplayStart::Keep).unwrap();
    assert_eq!(second.replay_len(), 100);
    let wider = Config::try_from(ConfigSpec { hidden: vec![64, 32], ..small() }).unwrap();
    let error = Agent::start_from(second, wider, ReplayStart::Keep).unwrap_err();
    let message =
        "hidden layers cannot change between stages: they are [32, 32], the new stage asks for [64, 32]";
    assert_eq!(error.to_string(), message);
}
