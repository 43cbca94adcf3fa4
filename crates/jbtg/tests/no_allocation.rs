//! Nothing on the way of a control loop allocates, the planners' construction included.

use std::num::NonZeroU32;

use allocation_counter::measure;
use jbtg::{Direction, Planner, PlannerSpec, Sampler, Shape, Synchronized, Timing};

use crate::support::{paper_spec, within};

#[track_caller]
fn check_no_allocation(operation: &str, run: impl FnOnce()) {
    let count = measure(run).count_total;
    assert_eq!(count, 0, "{operation} allocates");
}

#[test]
fn the_counter_sees_an_allocation() {
    assert!(measure(|| drop(std::hint::black_box(vec![0.0; 8]))).count_total > 0);
}

#[test]
fn no_plan_no_state_and_no_refusal_allocates() {
    for (shape, timing) in [
        (Shape::Smoothstep, Timing::Stretched),
        (Shape::Smoothstep, Timing::Fastest),
        (Shape::SineQuintic, Timing::Stretched),
        (Shape::SineQuintic, Timing::Fastest),
    ] {
        check_no_allocation("a planner and its steps", || {
            let planner = Planner::try_from(PlannerSpec { shape, timing, ..paper_spec(0.05) }).unwrap();
            assert!(planner.authority(Direction::Increasing).share > 0.5);
            for i in 0..100 {
                let v1 = within(planner.velocity(), f64::from(i) / 99.0);
                let reachable = planner.reachable(v1);
                for v2 in [reachable.min, 0.5 * v1, reachable.max] {
                    let v2 = reachable.clamp(v2);
                    let step = planner.ramp(0.3, v1, v2).unwrap();
                    let extrema = step.extrema();
                    assert!(step.control_points().count() == step.segments().len() + 1);
                    assert!(extrema.velocity.contains(step.state_at(0.02).velocity));
                }
                assert!(planner.ramp(0.3, v1, 1.0).is_err() && planner.ramp(f64::NAN, v1, v1).is_err());
                assert!(planner.ramp_saturated(0.3, v1, 1.0).is_ok());
                assert!(planner.displacement(v1, v1).is_finite());
            }
        });
    }
}

#[test]
fn no_sampler_and_no_synchronized_step_allocates() {
    check_no_allocation("a sampler", || {
        let planner = Planner::try_from(paper_spec(0.05)).unwrap();
        let mut sampler = Sampler::at_rest(planner, NonZeroU32::new(50).unwrap(), 0.3).unwrap();
        for i in 0..1000 {
            if i % 70 == 0 {
                sampler.command_saturated(0.1).unwrap();
                assert!(sampler.command(1.0).is_err());
            }
            assert!(sampler.advance().state.position.is_finite());
        }
    });
    check_no_allocation("synchronized steps", || {
        let planner = Planner::try_from(paper_spec(0.05)).unwrap();
        let joints = Synchronized::in_step([planner; 3]).unwrap();
        let step = joints.ramp([0.3; 3], [0.0; 3], [0.1, 0.05, -0.1]).unwrap();
        assert!(step.share < 1.0 && joints.periods(&[0.0; 3], &[0.1; 3]).unwrap() > 1);
        assert!(joints.ramp([0.3; 3], [1.0; 3], [0.0; 3]).is_err());
    });
}
