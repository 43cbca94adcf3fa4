//! Several joints, one period and one share.

use jbtg::strategies::planners;
use jbtg::{Interval, Planner, PlannerSpec, Shape, Synchronized, SynchronizedError, Timing};
use proptest::prelude::*;

use crate::support::{paper_planner, paper_spec, within};
use crate::tolerance;

/// Three planners of one period; their other numbers differ by orders of magnitude.
fn joints() -> impl Strategy<Value = [Planner; 3]> {
    [planners(), planners(), planners()].prop_filter_map("limits and period out of proportion", |planners| {
        let period = planners[0].period();
        let mut same = planners;
        for planner in &mut same {
            *planner = Planner::try_from(PlannerSpec { period, ..*planner.spec() }).ok()?;
        }
        Some(same)
    })
}

/// The same, stretched and of one shape.
fn courses() -> impl Strategy<Value = Synchronized<3>> {
    (joints(), jbtg::strategies::shapes()).prop_filter_map(
        "ramps out of proportion",
        |(mut planners, shape)| {
            for planner in &mut planners {
                let spec = PlannerSpec { shape, timing: Timing::Stretched, ..*planner.spec() };
                *planner = Planner::try_from(spec).ok()?;
            }
            Synchronized::in_step(planners).ok()
        },
    )
}

fn velocities(planners: &[Planner; 3], shares: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| within(planners[i].velocity(), shares[i]))
}

/// Of its joints' velocity limits; the second velocity may lie a little beyond them.
fn ends() -> impl Strategy<Value = ([f64; 3], [f64; 3])> {
    ([0.0..=1.0, 0.0..=1.0, 0.0..=1.0], [0.0..=1.0, 0.0..=1.0, 0.0..=1.0])
}

#[track_caller]
fn check_within(name: &str, found: Interval, limit: Interval) -> Result<(), TestCaseError> {
    let excess = (found.max - limit.max).max(limit.min - found.min) / limit.width();
    prop_assert!(
        excess <= tolerance::LIMIT,
        "{name}: {found:?} exceeds {limit:?} by {excess:e} of its width"
    );
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { max_global_rejects: u32::MAX, ..ProptestConfig::with_cases(2_000) })]

    #[test]
    fn joints_in_step_move_on_a_straight_line_of_velocities(joints in courses(), ends in ends()) {
        let (v1, v2) = (velocities(joints.planners(), ends.0), velocities(joints.planners(), ends.1));
        let step = joints.ramp([0.0; 3], v1, v2)?;
        for i in 1..32 {
            let time = joints.period() * f64::from(i) / 32.0;
            let done: [f64; 3] = std::array::from_fn(|j| step.trajectories[j].state_at(time).velocity - v1[j]);
            for (j, k) in [(0, 1), (1, 2), (2, 0)] {
                let (a, b) = (v2[j] - v1[j], v2[k] - v1[k]);
                // How far off the line, over the rounding of a velocity of its own size.
                let rounding = (v1[j].abs() + a.abs()) * b.abs() + (v1[k].abs() + b.abs()) * a.abs();
                let off = (done[j] * b - done[k] * a).abs();
                prop_assert!(
                    off <= tolerance::LINE_ULPS * f64::EPSILON * rounding,
                    "joints {j} and {k} at {time} s: {:e} off the line", off / rounding
                );
            }
        }
    }

    #[test]
    fn joints_in_step_keep_their_limits(joints in courses(), ends in ends()) {
        let (v1, v2) = (velocities(joints.planners(), ends.0), velocities(joints.planners(), ends.1));
        let step = joints.ramp([0.3; 3], v1, v2)?;
        for (planner, trajectory) in joints.planners().iter().zip(step.trajectories) {
            let (extrema, limits) = (trajectory.extrema(), planner.limits());
            check_within("velocity", extrema.velocity, limits.velocity())?;
            check_within("acceleration", extrema.acceleration, limits.acceleration())?;
            check_within("jerk", extrema.jerk, limits.jerk())?;
        }
    }

    #[test]
    fn the_share_is_one_that_all_reach_and_a_larger_one_they_do_not(planners in joints(), ends in ends()) {
        let joints = Synchronized::new(planners)?;
        let (v1, v2) = (velocities(&planners, ends.0), velocities(&planners, ends.1));
        let step = joints.ramp([0.0; 3], v1, v2)?;
        prop_assert!((0.0..=1.0).contains(&step.share));
        for (j, trajectory) in step.trajectories.iter().enumerate() {
            let end = trajectory.end().velocity;
            prop_assert!(planners[j].reachable(v1[j]).contains(end));
            let expected = v1[j] + step.share * (v2[j] - v1[j]);
            let rounding = tolerance::LINE_ULPS * f64::EPSILON * (v1[j].abs() + v2[j].abs());
            prop_assert!((end - expected).abs() <= rounding, "joint {j}: {end:e} for {expected:e}");
            if step.share == 1.0 {
                prop_assert_eq!(end, v2[j]);
            }
        }
        if step.share < 1.0 {
            let larger = step.share * (1.0 + 1e-9) + 1e-9;
            let beyond = (0..3).any(|j| {
                !planners[j].reachable(v1[j]).contains(v1[j] + larger * (v2[j] - v1[j]))
            });
            prop_assert!(beyond, "all joints reach a share of {larger}, {} was taken", step.share);
        }
    }

    #[test]
    fn a_change_takes_as_many_periods_as_foretold(planners in joints(), ends in ends()) {
        let joints = Synchronized::new(planners)?;
        let (mut velocity, v2) = (velocities(&planners, ends.0), velocities(&planners, ends.1));
        let foretold = joints.periods(&velocity, &v2)?;
        prop_assume!(foretold < 2_000);
        let mut taken = 0;
        while velocity != v2 {
            prop_assert!(taken <= foretold, "foretold {foretold}, still at {velocity:?} on the way to {v2:?}");
            let step = joints.ramp([0.0; 3], velocity, v2)?;
            velocity = step.trajectories.map(|trajectory| trajectory.end().velocity);
            taken += 1;
        }
        prop_assert!(taken == foretold || taken == foretold + 1, "foretold {foretold}, taken {taken}");
    }
}

#[test]
fn joints_of_different_periods_are_refused_by_name() {
    assert_eq!(Synchronized::new([paper_planner(0.05); 3]).unwrap().period(), 0.05);
    let planners = [paper_planner(0.05), paper_planner(0.05), paper_planner(0.02)];
    let error = Synchronized::new(planners).unwrap_err();
    assert_eq!(error, SynchronizedError::Period { joint: 2, period: 0.02, expected: 0.05 });
    assert_eq!(error.to_string(), "joint 2 has a period of 0.02 s, the first one of 0.05 s");
}

#[test]
fn joints_without_a_common_course_are_refused_by_name() {
    let fastest = PlannerSpec { timing: Timing::Fastest, ..paper_spec(0.05) };
    let sine = PlannerSpec { shape: Shape::SineQuintic, ..paper_spec(0.05) };
    for other in [fastest, sine] {
        let planners = [paper_planner(0.05), Planner::try_from(other).unwrap()];
        assert_eq!(Synchronized::in_step(planners).unwrap_err(), SynchronizedError::Course { joint: 1 });
        assert!(Synchronized::new(planners).is_ok());
    }
}

#[test]
fn a_velocity_beyond_its_limits_is_refused_by_name() {
    let joints = Synchronized::new([paper_planner(0.05); 2]).unwrap();
    let outside = joints.ramp([0.3; 2], [0.0, 0.2], [0.0; 2]).unwrap_err();
    assert!(matches!(outside, SynchronizedError::Outside { joint: 1, .. }));
    assert!(matches!(
        joints.periods(&[0.0; 2], &[0.2, 0.0]),
        Err(SynchronizedError::Outside { joint: 0, .. })
    ));
    let nan = joints.ramp([0.3, f64::NAN], [0.0; 2], [0.0; 2]).unwrap_err();
    assert!(matches!(nan, SynchronizedError::NotFinite { joint: 1, name: "position", .. }));
}

#[test]
fn a_joint_with_quick_ramps_waits_for_the_others() {
    let slow = PlannerSpec {
        limits: jbtg::Limits::try_from(jbtg::SymmetricLimits {
            position: Interval::new(-1.0, 1.0),
            velocity: 0.15,
            acceleration: 1.0,
            jerk: 75.0, // ramps of 20 ms instead of 15 ms
        })
        .unwrap(),
        ..paper_spec(0.05)
    };
    let joints = Synchronized::in_step([paper_planner(0.05), Planner::try_from(slow).unwrap()]).unwrap();
    for planner in joints.planners() {
        let authority = planner.authority(jbtg::Direction::Increasing);
        assert!((authority.ramp_up - 0.02).abs() < 1e-15 && (authority.ramp_down - 0.02).abs() < 1e-15);
        assert!((authority.share - 0.6).abs() < 1e-13, "{}", authority.share);
    }
}

/// 35 mm/s per period: 150 mm/s are 4.3 periods, and no change takes none.
#[test]
fn a_change_takes_whole_periods() {
    let joints = Synchronized::new([paper_planner(0.05); 2]).unwrap();
    assert_eq!(joints.periods(&[0.0, 0.1], &[0.15, 0.1]), Ok(5));
    assert_eq!(joints.periods(&[0.0, 0.1], &[0.0, 0.08]), Ok(1));
    assert_eq!(joints.periods(&[0.02, -0.1], &[0.02, -0.1]), Ok(0));
}

/// 30 ms and 15 ms up, 15 ms and 30 ms down, in a period of 50 ms: both directions give way alike.
#[test]
fn common_ramps_that_do_not_fit_share_the_period() {
    let joint = |jerk| {
        let limits = jbtg::LimitsSpec {
            position: Interval::symmetric(1.0),
            velocity: Interval::symmetric(0.15),
            acceleration: Interval::symmetric(1.0),
            jerk,
        };
        let limits = jbtg::Limits::try_from(limits).unwrap();
        Planner::try_from(PlannerSpec { limits, ..paper_spec(0.05) }).unwrap()
    };
    let joints =
        Synchronized::in_step([joint(Interval::new(-100.0, 50.0)), joint(Interval::new(-50.0, 100.0))])
            .unwrap();
    for planner in joints.planners() {
        for direction in [jbtg::Direction::Increasing, jbtg::Direction::Decreasing] {
            let authority = planner.authority(direction);
            assert!((authority.ramp_up - 0.025).abs() < 1e-15, "{authority:?}");
            assert!((authority.ramp_down - 0.025).abs() < 1e-15, "{authority:?}");
        }
    }
}

/// The quick joint's velocity overshoots by more once its ramps are as long as the slow one's.
#[test]
fn joints_in_step_keep_the_room_that_common_ramps_need() {
    let joint = |jerk| {
        let limits = jbtg::SymmetricLimits {
            position: Interval::symmetric(1.0),
            velocity: 0.15,
            acceleration: 1.0,
            jerk,
        };
        let limits = jbtg::Limits::try_from(limits).unwrap();
        Planner::try_from(PlannerSpec { limits, shape: Shape::SineQuintic, ..paper_spec(0.8) }).unwrap()
    };
    let joints = Synchronized::in_step([joint(1e4), joint(10.0)]).unwrap();
    let Interval { min, max } = joints.planners()[0].velocity();
    let step = joints.ramp([0.0; 2], [max, 0.0], [min, 0.0]).unwrap();
    assert_eq!(step.share, 1.0);
    let (found, limit) = (step.trajectories[0].extrema().velocity, joints.planners()[0].limits().velocity());
    check_within("velocity", found, limit).unwrap();
}
