//! What users of other generators report as failures, asked of this one. Position limits are `safezone`'s business; here
//! it is velocity targets, replanned in every period for hours.

use jbtg::strategies::planners;
use jbtg::{Planner, PlannerSpec, Shape, State, Timing};
use proptest::prelude::*;

use crate::support::{paper_spec, within};
use crate::tolerance;

/// Periods of a long run: 2.8 h at 50 ms.
const LONG: u32 = 200_000;

/// Splitmix64: a share in [0, 1] from a stream that `seed` names.
struct Shares(u64);

impl Shares {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / 9_007_199_254_740_992.0
    }
}

fn every_planner(period: f64) -> Vec<Planner> {
    let shapes = [Shape::Smoothstep, Shape::SineQuintic];
    let timings = [Timing::Stretched, Timing::Fastest];
    let specs = shapes
        .into_iter()
        .flat_map(|shape| timings.map(|timing| PlannerSpec { shape, timing, ..paper_spec(period) }));
    specs.map(|spec| Planner::try_from(spec).expect("a period of some ramps")).collect()
}

/// Plans the next period and checks what must hold in it.
#[track_caller]
fn check_step(planner: &Planner, state: State, v2: f64) -> State {
    let step = planner.ramp(state.position, state.velocity, v2).expect("a reachable velocity");
    let first = step.state_at(0.0);
    assert_eq!((first.position, first.velocity), (state.position, state.velocity), "steps chain bit for bit");
    assert_eq!(step.end().velocity, v2);
    assert_eq!(step.end().position, state.position + planner.displacement(state.velocity, v2));
    assert_eq!((step.end().acceleration, step.end().jerk), (0.0, 0.0));
    let (extrema, limits) = (step.extrema(), planner.limits());
    for (name, found, limit) in [
        ("velocity", extrema.velocity, limits.velocity()),
        ("acceleration", extrema.acceleration, limits.acceleration()),
        ("jerk", extrema.jerk, limits.jerk()),
    ] {
        let excess = (found.max - limit.max).max(limit.min - found.min) / limit.width();
        assert!(excess <= tolerance::LIMIT, "{name} exceeds its limit by {excess:e} of its width");
    }
    step.end()
}

#[test]
fn random_commands_in_every_period_break_no_limit_and_no_chain() {
    for period in [0.02, 0.05] {
        for (stream, planner) in every_planner(period).iter().enumerate() {
            let mut shares = Shares(stream as u64);
            let mut state = State { position: 0.3, ..State::default() };
            for _ in 0..LONG / 4 {
                // Now and then the very ends of what is reachable.
                let share = ((shares.next() * 1.2) - 0.1).clamp(0.0, 1.0);
                state = check_step(planner, state, within(planner.reachable(state.velocity), share));
            }
            assert!(state.position.is_finite());
        }
    }
}

#[test]
fn a_velocity_that_is_held_for_hours_stays_the_very_same() {
    for period in [0.02, 0.05] {
        for planner in every_planner(period) {
            for held in [planner.velocity().max, planner.velocity().min, 0.1, -1.5e-14] {
                let mut state = State::default();
                let mut periods = 0;
                while state.velocity != held {
                    assert!(periods < 100, "{held} takes more than 100 periods");
                    state = check_step(&planner, state, planner.reachable(state.velocity).clamp(held));
                    periods += 1;
                }
                let start = state.position;
                for _ in 0..LONG / 16 {
                    state = check_step(&planner, state, held);
                }
                let expected = held * period * f64::from(LONG / 16);
                let rounding = f64::EPSILON * expected.abs() * f64::from(LONG / 16);
                assert!((state.position - start - expected).abs() <= rounding, "{held}: {state:?}");
            }
        }
    }
}

#[test]
fn a_command_beyond_the_limit_held_for_hours_ends_at_the_limit() {
    for planner in every_planner(0.05) {
        let mut state = State::default();
        for period in 0..LONG / 4 {
            let step = planner.ramp_saturated(state.position, state.velocity, 1e9).unwrap();
            assert!(step.end().velocity >= state.velocity, "it falls in period {period}");
            state = step.end();
        }
        assert_eq!(state.velocity, planner.velocity().max);
    }
}

/// pantor/ruckig computes from the middle of a motion anew in every cycle; an interrupted motion must chain as well.
#[test]
fn tiny_velocities_of_either_sign_are_planned_in_every_period() {
    for planner in every_planner(0.1) {
        for v in [-1.5e-14, 1.5e-14, 5e-324, -5e-324, f64::MIN_POSITIVE, 1e-18, -0.0] {
            let mut state = State { position: 0.5, velocity: v, ..State::default() };
            for period in 0..40 {
                let v2 = if period % 2 == 0 { 0.0 } else { v };
                state = check_step(&planner, state, v2);
                let moved = (state.position - 0.5).abs();
                assert!(moved <= 40.0 * 0.1 * v.abs(), "{moved:e} after {period} periods at {v:e}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn any_planner_replans_a_thousand_periods(planner in planners(), seed in any::<u64>()) {
        let mut shares = Shares(seed);
        let mut state = State::default();
        for _ in 0..1000 {
            let share = ((shares.next() * 1.4) - 0.2).clamp(0.0, 1.0);
            state = check_step(&planner, state, within(planner.reachable(state.velocity), share));
        }
    }
}
