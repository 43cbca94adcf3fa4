//! Tick by tick: nothing drifts, and nobody who stops commanding is left in motion.

use std::num::NonZeroU32;

use jbtg::strategies::planners;
use jbtg::{Origin, Planner, RampError, Sampler, State};
use proptest::prelude::*;

use crate::support::{paper_planner, within};

fn sampler(planner: Planner, ticks: u32, position: f64) -> Sampler {
    let ticks = NonZeroU32::new(ticks).expect("some ticks");
    Sampler::at_rest(planner, ticks, position).expect("a finite position")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(5_000))]

    #[test]
    fn the_end_of_every_period_is_the_commanded_state_bit_for_bit(
        planner in planners(),
        ticks in 1_u32..60,
        shares in prop::collection::vec(prop::option::of(0.0..=1.0), 1..12),
    ) {
        let mut sampler = sampler(planner, ticks, 0.25);
        let mut expected = State { position: 0.25, ..State::default() };
        for share in shares {
            let reachable = planner.reachable(expected.velocity);
            let (velocity, origin) = match share {
                Some(share) => {
                    let velocity = within(reachable, share);
                    sampler.command(velocity)?;
                    (velocity, Origin::Command)
                }
                None => (reachable.clamp(0.0), Origin::Brake),
            };
            let step = planner.ramp(expected.position, expected.velocity, velocity)?;
            for tick in 1..=ticks {
                let sample = sampler.advance();
                prop_assert_eq!(sample.origin, origin);
                prop_assert_eq!(sample.is_due, tick == ticks);
                let time = planner.period() * (f64::from(tick) / f64::from(ticks));
                let state = if tick == ticks { step.end() } else { step.state_at(time) };
                prop_assert_eq!(sample.state, state);
            }
            expected = step.end();
            prop_assert_eq!(sampler.state(), expected);
            prop_assert_eq!(sampler.upcoming(), expected);
        }
    }

    #[test]
    fn a_joint_that_nobody_commands_any_more_comes_to_rest_and_stays(planner in planners(), share in 0.0..=1.0) {
        let mut sampler = sampler(planner, 7, 0.0);
        for _ in 0..3 {
            sampler.command(within(planner.reachable(sampler.upcoming().velocity), share))?;
            (0..7).for_each(|_| { sampler.advance(); });
        }
        let mut speed = sampler.state().velocity.abs();
        let change = f64::min(
            planner.authority(jbtg::Direction::Increasing).velocity_change,
            planner.authority(jbtg::Direction::Decreasing).velocity_change,
        );
        let most = (speed / change).ceil() as u64 + 1;
        let mut periods = 0;
        while sampler.state().velocity != 0.0 {
            prop_assert!(periods <= most, "still at {:e} after {periods} periods", sampler.state().velocity);
            (0..7).for_each(|_| { sampler.advance(); });
            prop_assert!(sampler.state().velocity.abs() <= speed);
            speed = sampler.state().velocity.abs();
            periods += 1;
        }
        let rest = sampler.state();
        for _ in 0..20 {
            prop_assert_eq!(sampler.advance().state, rest);
        }
    }
}

#[test]
fn a_refused_command_leaves_the_sampler_as_it_was() {
    let mut sampler = sampler(paper_planner(0.05), 5, 0.3);
    sampler.command(0.02).unwrap();
    assert!(matches!(sampler.command(9.0), Err(RampError::Unreachable { to, .. }) if to == 9.0));
    assert!(matches!(sampler.command(f64::NAN), Err(RampError::NotFinite { .. })));
    assert!(sampler.is_commanded());
    (0..5).for_each(|_| {
        sampler.advance();
    });
    assert_eq!(sampler.state().velocity, 0.02);
    assert_eq!(sampler.ticks().get(), 5);
    sampler.advance();
    assert!(!sampler.is_commanded()); // the period after the commanded one
}

#[test]
fn of_several_commands_in_one_period_the_last_counts() {
    let mut sampler = sampler(paper_planner(0.05), 5, 0.3);
    sampler.command(0.02).unwrap();
    sampler.advance();
    sampler.command(0.03).unwrap(); // in the middle of a period, for the next one
    sampler.command(0.01).unwrap();
    let velocities: Vec<f64> =
        (0..9).map(|_| sampler.advance()).filter(|s| s.is_due).map(|s| s.state.velocity).collect();
    assert_eq!(velocities, [0.02, 0.01]);
}

#[test]
fn a_late_command_takes_effect_one_period_later() {
    let planner = paper_planner(0.05);
    let mut sampler = sampler(planner, 5, 0.3);
    sampler.command(0.03).unwrap();
    (0..5).for_each(|_| {
        sampler.advance();
    });
    assert_eq!(sampler.advance().origin, Origin::Brake); // the command is late by one tick
    let braked = sampler.upcoming().velocity;
    assert_eq!(braked, planner.reachable(0.03).clamp(0.0));
    sampler.command(0.03).unwrap();
    let samples: Vec<_> = (0..9).map(|_| sampler.advance()).collect();
    assert_eq!(samples[3].state.velocity, braked);
    assert_eq!((samples[8].state.velocity, samples[8].origin), (0.03, Origin::Command));
}

#[test]
fn a_saturated_command_says_what_it_took() {
    let planner = paper_planner(0.05);
    let mut sampler = sampler(planner, 5, 0.3);
    assert_eq!(sampler.command_saturated(9.0), Ok(planner.reachable(0.0).max));
    assert!(sampler.command_saturated(f64::INFINITY).is_err());
    assert_eq!(sampler.upcoming().velocity, 0.0);
}

#[test]
fn a_sampler_needs_a_finite_position() {
    let ticks = NonZeroU32::MIN;
    for position in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(matches!(
            Sampler::at_rest(paper_planner(0.05), ticks, position),
            Err(RampError::NotFinite { name: "position", .. })
        ));
    }
}
