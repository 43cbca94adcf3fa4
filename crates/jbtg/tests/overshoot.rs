//! What the sine's quintic goes against its direction: how far, and that limits are kept for all that.

use jbtg::{Direction, Planner, PlannerSpec, RampError, Shape, Timing};

use crate::support::paper_spec;
use crate::tolerance;

fn sine(timing: Timing, period: f64) -> Planner {
    Planner::try_from(PlannerSpec { shape: Shape::SineQuintic, timing, ..paper_spec(period) })
        .expect("a period of many ramps")
}

/// A stretched pulse scales with its change; a fastest one is worst where its ramps are full and have no cruise.
#[test]
fn the_reverse_travel_is_what_the_worst_step_dips_by() {
    for timing in [Timing::Stretched, Timing::Fastest] {
        let planner = sine(timing, 0.05);
        let authority = planner.authority(Direction::Increasing);
        for share in [0.2, 0.999, 1.0, 1.3] {
            let change = share * authority.ramps_only;
            let dip = -planner.ramp(0.0, 0.0, change).unwrap().extrema().position.min;
            let bound = authority.reverse_travel * change;
            assert!(dip <= bound * (1.0 + 1e-9), "{timing:?}, {share}: {dip:e} beyond {bound:e}");
            let is_worst = timing == Timing::Stretched || share == 1.0;
            assert!(!is_worst || dip >= 0.9 * bound, "{timing:?}, {share}: {dip:e} of {bound:e}");
        }
    }
}

/// In one step from far above the highest velocity to the lowest, which overshoots by more than a step between both.
#[test]
fn a_step_back_from_beyond_one_velocity_limit_keeps_the_other() {
    for timing in [Timing::Stretched, Timing::Fastest] {
        let planner = sine(timing, 0.8);
        let limits = planner.limits().velocity();
        for excess in [1e-6, 0.01, 0.1, 0.3] {
            let reachable = planner.reachable(limits.max + excess);
            let down = planner.ramp(0.0, limits.max + excess, reachable.min).unwrap().extrema().velocity;
            let slack = tolerance::LIMIT * limits.width();
            assert!(down.min >= limits.min - slack, "{timing:?}, {excess}: {down:?}");
            let reachable = planner.reachable(limits.min - excess);
            let up = planner.ramp(0.0, limits.min - excess, reachable.max).unwrap().extrema().velocity;
            assert!(up.max <= limits.max + slack, "{timing:?}, {excess}: {up:?}");
        }
    }
}

#[test]
fn a_refusal_names_its_numbers() {
    let planner = sine(Timing::Stretched, 0.05);
    let refused = planner.ramp(0.0, 0.0, 0.5).unwrap_err();
    let RampError::Unreachable { reachable, .. } = refused else { panic!("{refused:?}") };
    let text = refused.to_string();
    for number in [0.5, reachable.min, reachable.max] {
        assert!(text.contains(&number.to_string()), "{text}");
    }
    assert_eq!(planner.ramp(f64::NAN, 0.0, 0.0).unwrap_err().to_string(), "position must be finite, got NaN");
}
