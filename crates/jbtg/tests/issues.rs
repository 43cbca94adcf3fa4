//! Inputs that users of Ruckig reported as failures (pantor/ruckig, by issue number), adapted to velocity targets: what
//! moves with an acceleration is stopped, what can start without one is ramped.
//!
//! Of issue 141 we have no input: the archives of issues that we could search do not hold it.

use jbtg::{
    Interval, Limits, LimitsSpec, Planner, PlannerSpec, Quantity, Shape, State, StopStatus, Timing,
    Trajectory,
};

use crate::tolerance;

/// Limits and state of one joint as reported.
#[derive(Clone, Copy, Debug)]
struct Joint {
    velocity: Interval,
    acceleration: f64,
    jerk: f64,
    state: State,
}

fn joint(velocity: f64, acceleration: f64, jerk: f64, state: (f64, f64, f64)) -> Joint {
    let (position, v, a) = state;
    let state = State { position, velocity: v, acceleration: a, jerk: 0.0 };
    Joint { velocity: Interval::symmetric(velocity), acceleration, jerk, state }
}

/// Planners of both shapes and timings for `joint`, with room for every position.
fn planners(joint: &Joint, period: f64) -> Vec<Planner> {
    let limits = LimitsSpec {
        position: Interval::symmetric(1e4),
        velocity: joint.velocity,
        acceleration: Interval::symmetric(joint.acceleration),
        jerk: Interval::symmetric(joint.jerk),
    };
    let limits = Limits::try_from(limits).expect("limits around zero");
    let kinds = [Shape::Smoothstep, Shape::SineQuintic]
        .map(|shape| [(shape, Timing::Stretched), (shape, Timing::Fastest)]);
    let specs =
        kinds.into_iter().flatten().map(|(shape, timing)| PlannerSpec { limits, shape, timing, period });
    specs.map(|spec| Planner::try_from(spec).expect("a period that the limits leave something of")).collect()
}

#[track_caller]
fn check_within(name: &str, found: Interval, limit: Interval) {
    let excess = (found.max - limit.max).max(limit.min - found.min) / limit.width();
    assert!(excess <= tolerance::LIMIT, "{name}: {found:?} exceeds {limit:?} by {excess:e} of its width");
}

#[track_caller]
fn check_limits(planner: &Planner, motion: &Trajectory) {
    let (extrema, limits) = (motion.extrema(), planner.limits());
    check_within("velocity", extrema.velocity, limits.velocity());
    check_within("acceleration", extrema.acceleration, limits.acceleration());
    check_within("jerk", extrema.jerk, limits.jerk());
}

/// `velocity`, at most an ulp beyond the velocities that steps may end at.
fn start(planner: &Planner, velocity: f64) -> f64 {
    let Interval { min, max } = planner.velocity();
    velocity.clamp(min.next_down(), max.next_up())
}

/// Stops the joint right where it is and expects rest without breaking a limit.
#[track_caller]
fn check_stop(joint: Joint, period: f64) {
    for planner in planners(&joint, period) {
        let stop = planner.stop(joint.state).expect("finite numbers");
        assert_eq!(stop.status, StopStatus::WithinLimits, "{joint:?}");
        assert_eq!(stop.trajectory.end().velocity, 0.0);
        check_limits(&planner, &stop.trajectory);
    }
}

/// Ramps the joint from its velocity to `target`, period by period, and expects to get there without breaking a limit.
#[track_caller]
fn check_ramps(joint: Joint, target: f64, period: f64) {
    for planner in planners(&joint, period) {
        let target = planner.velocity().clamp(target);
        let mut state =
            State { velocity: start(&planner, joint.state.velocity), acceleration: 0.0, ..joint.state };
        for _ in 0..10_000 {
            let step =
                planner.ramp_saturated(state.position, state.velocity, target).expect("finite numbers");
            check_limits(&planner, &step);
            state = step.end();
            if state.velocity == target {
                break;
            }
        }
        assert_eq!(state.velocity, target, "{joint:?}");
    }
}

/// Issue 86: joints 3 and 6 left their velocity limits without a word. From these states jerk alone carries them beyond.
#[test]
fn a_velocity_limit_that_cannot_be_kept_is_reported_and_one_that_can_is_kept() {
    let (slow, fast) = ((2.58309, 17.3088, 65.0), (3.00197, 20.7345, 82.0));
    let kept = [
        (slow, (1.1456, 0.745_756, -3.71964), 0.86103),
        (slow, (1.32491, 2.18417, 2.04996), 1.72206),
        (fast, (-1.13679, -0.564_599, 6.20144), -0.86103),
        (fast, (-1.31609, -2.00301, 0.431_844), -1.72206),
    ];
    for ((velocity, acceleration, jerk), state, target) in kept {
        let joint = joint(velocity, acceleration, jerk, state);
        check_stop(joint, 0.007_299_41);
        check_ramps(joint, target, 0.007_299_41);
    }
    let lost =
        [(slow, (1.4281, 2.58052, 0.686_652), 2.58209), (fast, (-1.46135, -2.97533, -2.14729), -2.58309)];
    for ((velocity, acceleration, jerk), state, target) in lost {
        let joint = joint(velocity, acceleration, jerk, state);
        for planner in planners(&joint, 0.007_299_41) {
            let stop = planner.stop(joint.state).expect("finite numbers");
            assert_eq!(stop.status, StopStatus::Recovering(Quantity::Velocity));
            // No farther than ending the acceleration as fast as the jerk limit allows.
            let carried = joint.state.velocity.abs() + 0.75 * joint.state.acceleration.powi(2) / jerk;
            let found = stop.trajectory.extrema().velocity;
            assert!(found.max.max(-found.min) <= carried * (1.0 + 1e-12), "{found:?}");
        }
        check_ramps(joint, target, 0.007_299_41);
    }
}

/// Issue 188: a joint that must never move backwards did, without a word. It cannot be helped: braking is so strong that
/// ending it takes 0.095 m/s at least, and there are 0.092. Only saying so can.
#[test]
fn motion_backwards_that_cannot_be_avoided_is_reported() {
    let mut joint = joint(1.0, 1.5, 0.5, (0.0, 0.092_317_526_809_040_51, -0.308_187_085_757_631_4));
    joint.velocity = Interval::new(-1e-3, 1.0);
    for planner in planners(&joint, 0.25) {
        let stop = planner.stop(joint.state).unwrap();
        assert_eq!(stop.status, StopStatus::Recovering(Quantity::Velocity));
        assert_eq!(stop.trajectory.end().velocity, 0.0);
    }
    // With braking that can end in time it never does.
    joint.state.acceleration = -0.2;
    for planner in planners(&joint, 0.25) {
        let stop = planner.stop(joint.state).unwrap();
        assert_eq!(stop.status, StopStatus::WithinLimits);
        assert!(stop.trajectory.extrema().velocity.min >= -1e-15, "{:?}", stop.trajectory.extrema());
    }
}

/// Issue 90: no result for a velocity limit of 2.8e-8 beside an acceleration limit of 134, at one ulp beyond that limit.
#[test]
fn a_velocity_limit_ten_decades_below_the_acceleration_limit_is_kept() {
    let limit = 2.794_826_109_810_866e-8;
    let joint = joint(limit, 133.626_762_504_142_7, 2_087.918_294_622_123, (1.25, limit.next_up(), 0.0));
    for planner in planners(&joint, 0.01) {
        let velocity = start(&planner, joint.state.velocity);
        let reachable = planner.reachable(velocity);
        assert!(reachable.contains(0.0) && reachable.contains(planner.velocity().max));
        let step = planner.ramp(1.25, velocity, 0.0).unwrap();
        check_limits(&planner, &step);
        let stop = planner.stop(joint.state).unwrap();
        check_limits(&planner, &stop.trajectory);
    }
    check_ramps(joint, 0.0, 0.01);
}

/// Issue 129: no result from velocities around 0.66 with the acceleration exactly at its limit. The report's jerk limits
/// are tried from one times to a thousand times the acceleration's.
#[test]
fn a_state_exactly_at_its_acceleration_limit_is_stopped() {
    let limit = 4.363_323_129_985_824;
    let states = [
        (1.635_923_973_038_584, 0.599_700_246_053_994_9, -2.111_156_774_102_785),
        (-0.026_645_776_031_590_74, 0.657_823_987_334_049, -limit),
        (1.398_772_409_994_243, 0.654_448_869_837_034_2, -3.853_477_374_887_802),
        (0.720_435_912_921_588_9, 0.653_466_743_757_556_9, -4.320_290_863_627_76),
        (-0.352_718_178_940_473_6, 0.657_823_987_334_048_6, -limit),
    ];
    for state in states {
        for jerk in [1.0, 10.0, 100.0, 1000.0] {
            check_stop(joint(3.926_990_816_987_241, limit, jerk * limit, state), 0.004);
        }
        check_ramps(joint(3.926_990_816_987_241, limit, 100.0 * limit, state), 0.0, 0.04);
    }
}

/// Issue 160: errors now and then from states that are at rest but for rounding.
#[test]
fn a_state_at_rest_but_for_rounding_is_stopped() {
    let states = [
        (-0.048_958_832_585_726_08, 1.425_883_388_427_091e-14, -2.370_282_711_878_416e-12),
        (0.199_263_793_920_802_5, -9.520_201_039_439_915e-20, 0.0),
        (-0.291_466_063_014_201_8, -9.656_571_194_417_352e-20, 3.469_446_951_953_614e-18),
        (0.209_348_365_675_663_4, 1.924_174_584_908_152e-18, -3.608_224_830_031_759e-16),
        (0.031_894_667_284_322_98, -1.542_564_246_001_646e-20, 0.0),
    ];
    for state in states {
        let joint = joint(5.0, 10.0, 150.0, state);
        check_stop(joint, 0.01);
        check_ramps(joint, 0.0, 0.01);
        let stop = planners(&joint, 0.01)[0].stop(joint.state).unwrap().trajectory;
        assert!(stop.duration() < 1e-6 && (stop.end().position - state.0).abs() <= 1e-16);
    }
}

/// Issues 60 and 108: a stop with the velocity interface that failed on the target or by rounding.
#[test]
fn stops_that_failed_with_the_velocity_interface_succeed() {
    check_stop(joint(1752.0, 17_520.0, 175_204.0, (357.23, -1244.0, 11_816.0)), 0.2);
    check_stop(joint(1593.0, 17_520.0, 175_204.0, (406.96, -1228.0, 11_298.0)), 0.2);
    check_stop(joint(131.0, 1738.0, 17_383.0, (-8.38, -17.01, 0.0)), 0.2);
    let joints = [
        (6.457_718_232_379_019, 26.895_523_773_232_62, 224.222_449_003_711_5),
        (5.410_520_681_182_422, 22.532_200_643_246_8, 187.849_787_392_149_7),
        (7.155_849_933_176_751, 29.810_224_234_063_15, 248.465_072_139_912_7),
    ];
    let states = [
        (0.048_990_899_889_844_85, 0.111_947_749_753_670_3, -2.943_871_184_141_059),
        (-0.373_662_395_706_242_9, -0.005_706_738_140_158_095, 0.163_858_883_292_587_8),
        (-0.007_154_243_077_742_151, 0.001_348_657_044_096_806, -0.038_329_187_796_166_04),
    ];
    for ((velocity, acceleration, jerk), state) in joints.into_iter().zip(states) {
        check_stop(joint(velocity, acceleration, jerk, state), 0.008);
    }
}
