//! [P, § Jerk-Bounded Trajectory Generator]: its equations and algorithms, case by case.

use std::f64::consts::PI;

use jbtg::{
    DetourCase, Direction, Interval, Limits, LimitsSpec, Planner, PlannerSpec, PulseKind, Shape, Timing,
    Trajectory,
};
use nalgebra::{SMatrix, SVector};

use crate::tolerance;

/// The paper's limits of the telescope, in SI units.
const VELOCITY: f64 = 0.15;
const ACCELERATION: f64 = 1.0;
const JERK: f64 = 100.0;

/// What the sine's quintic exceeds its acceleration by, so that the planner plans with that much less: the largest of the
/// quintic's acceleration over its ramp. To six digits.
const SINE_EXCESS: f64 = 4.8924e-4;

const SHAPES: [Shape; 2] = [Shape::Smoothstep, Shape::SineQuintic];
const TIMINGS: [Timing; 2] = [Timing::Stretched, Timing::Fastest];

fn planner(shape: Shape, timing: Timing, period: f64) -> Planner {
    unequal_planner((shape, timing, period), Interval::symmetric(ACCELERATION), Interval::symmetric(JERK))
}

fn unequal_planner(
    (shape, timing, period): (Shape, Timing, f64),
    acceleration: Interval,
    jerk: Interval,
) -> Planner {
    let limits = LimitsSpec {
        position: Interval::new(0.0, 1.0),
        velocity: Interval::symmetric(VELOCITY),
        acceleration,
        jerk,
    };
    let limits = Limits::try_from(limits).expect("limits around zero");
    Planner::try_from(PlannerSpec { limits, shape, timing, period }).expect("a period of many ramps")
}

#[track_caller]
fn check_close(name: &str, found: f64, expected: f64, tolerance: f64) {
    let error = (found - expected).abs();
    assert!(
        error <= tolerance * expected.abs(),
        "{name}: found {found:e}, expected {expected:e}, error {error:e}"
    );
}

#[track_caller]
fn check_durations(step: &Trajectory, expected: &[f64]) {
    let found: Vec<f64> = step.segments().iter().map(jbtg::Segment::duration).collect();
    assert_eq!(found.len(), expected.len(), "durations {found:?}, expected {expected:?}");
    for (found, expected) in found.iter().zip(expected) {
        check_close("duration", *found, *expected, tolerance::CLOSED_FORM);
    }
}

/// b₁ to b₅ of [P, Eq. (eqmat)], each times dt to its power, from the end conditions of a segment.
fn solve_eqmat(dt: f64, d: f64, (v1, a1): (f64, f64), (v2, a2): (f64, f64)) -> SVector<f64, 5> {
    let matrix = SMatrix::<f64, 5, 5>::from_row_slice(&[
        1.0, 1.0, 1.0, 1.0, 1.0, //
        1.0, 0.0, 0.0, 0.0, 0.0, //
        0.0, 2.0, 0.0, 0.0, 0.0, //
        1.0, 2.0, 3.0, 4.0, 5.0, //
        0.0, 2.0, 6.0, 12.0, 20.0,
    ]);
    let right = SVector::<f64, 5>::new(d, v1 * dt, a1 * dt * dt, v2 * dt, a2 * dt * dt);
    matrix.lu().solve(&right).expect("a regular matrix")
}

#[test]
fn coefficients_solve_eqmat() {
    for (shape, timing) in SHAPES.into_iter().flat_map(|shape| TIMINGS.map(|timing| (shape, timing))) {
        for period in [0.02, 0.05, 0.2] {
            let planner = planner(shape, timing, period);
            for (v1, share) in [(0.02, 1.0), (0.02, 0.3), (-0.01, 0.7), (0.0, 0.0), (0.1, 0.1)] {
                let reachable = planner.reachable(v1);
                let step = planner.ramp(0.4, v1, reachable.min + share * reachable.width()).unwrap();
                check_eqmat(&step, shape);
            }
        }
    }
}

#[track_caller]
fn check_eqmat(step: &Trajectory, shape: Shape) {
    // Displacements of the ramps, [P, Alg. 1], step 4: of one that rises from 0, and of one that falls to 0.
    let rising = match shape {
        Shape::Smoothstep => 0.15,
        Shape::SineQuintic => 0.25 - 1.0 / (PI * PI),
    };
    for segment in step.segments() {
        let dt = segment.duration();
        let (start, end) = (segment.state_at(0.0), segment.state_at(dt));
        let (v, a1, a2) = (start.velocity, start.acceleration, end.acceleration);
        let d = v * dt + dt * dt * ((0.5 - rising) * a1 + rising * a2);
        let expected = solve_eqmat(dt, d, (v, a1), (v + 0.5 * dt * (a1 + a2), a2));
        let scale = expected.amax();
        for (k, expected) in expected.iter().enumerate() {
            let found = segment.coefficients()[k + 1] * dt.powi(k as i32 + 1);
            let error = (found - expected).abs();
            assert!(error <= tolerance::EQMAT * scale, "b{}: {found:e} for {expected:e}, {shape:?}", k + 1);
        }
    }
}

#[test]
fn a_ramp_takes_the_time_and_the_distance_of_its_shape() {
    let sine = ACCELERATION / (1.0 + SINE_EXCESS);
    let cases = [
        (Shape::Smoothstep, ACCELERATION, 1.5, 0.15),
        (Shape::SineQuintic, sine, PI / 2.0, 0.25 - 1.0 / (PI * PI)), // [P, Eq. (dtmax)], [P, Alg. 1]
    ];
    for (shape, acceleration, ramp_time, displacement) in cases {
        let planner = planner(shape, Timing::Fastest, 0.1);
        let step = planner.ramp(0.0, 0.0, planner.reachable(0.0).max).unwrap();
        let ramp = step.segments()[0];
        let end = ramp.state_at(ramp.duration());
        check_close("acceleration", end.acceleration, acceleration, tolerance::CLOSED_FORM);
        check_close("ramp time", ramp.duration(), ramp_time * acceleration / JERK, tolerance::CLOSED_FORM);
        let expected = displacement * acceleration * ramp.duration() * ramp.duration();
        check_close("displacement", end.position, expected, tolerance::CLOSED_FORM);
        check_close("velocity", end.velocity, 0.5 * acceleration * ramp.duration(), tolerance::CLOSED_FORM);
    }
}

#[test]
fn the_sine_quintic_is_not_quite_the_sine() {
    let planner = planner(Shape::SineQuintic, Timing::Fastest, 0.05);
    let reachable = planner.reachable(0.0);
    let step = planner.ramp(0.0, 0.0, 0.5 * reachable.max).unwrap();
    let (extrema, ramp) = (step.extrema(), step.segments()[0]);
    let peak = ramp.state_at(ramp.duration()).acceleration;
    check_close(
        "acceleration excess",
        extrema.acceleration.max / peak - 1.0,
        0.000_489,
        tolerance::THREE_DIGITS,
    );
    let jerk = PI * peak / (2.0 * ramp.duration());
    check_close("jerk at the start", ramp.state_at(0.0).jerk / jerk, -0.0505, tolerance::THREE_DIGITS);
    let overshoot = -extrema.velocity.min * jerk / (peak * peak);
    check_close("velocity overshoot", overshoot, 1.28e-5, tolerance::THREE_DIGITS);
    assert!(extrema.acceleration.max <= ACCELERATION && extrema.jerk.max <= JERK);
}

#[test]
fn algorithm_1_ramps_cruises_ramps_and_waits() {
    let a = ACCELERATION / (1.0 + SINE_EXCESS) * (1.0 - 1e-14);
    let dt_max = PI * a / (2.0 * JERK);
    let (dt, change) = (0.2, 0.06);
    assert!(dt > 2.0 * dt_max && change > dt_max * a); // Case 1.1 of [P, Alg. 3]
    for sign in [1.0, -1.0] {
        let v1 = sign * 0.02;
        let v2 = v1 + sign * change;
        let step = planner(Shape::SineQuintic, Timing::Fastest, dt).ramp(0.5, v1, v2).unwrap();
        let half = sign * 0.5 * a * dt_max;
        let (va, vb) = (v1 + half, v2 - half);
        let t2 = (vb - va) / (sign * a);
        check_durations(&step, &[dt_max, t2, dt_max, dt - 2.0 * dt_max - t2]);
        let d1 = sign * a * dt_max * dt_max * (0.25 - 1.0 / (PI * PI)) + v1 * dt_max;
        let d2 = (vb * vb - va * va) / (2.0 * sign * a);
        let d3 = sign * a * dt_max * dt_max * (0.25 + 1.0 / (PI * PI)) + vb * dt_max;
        let mut position = 0.5;
        let points: Vec<_> = step.control_points().collect();
        for (point, (distance, velocity)) in points[1..].iter().zip([(d1, va), (d2, vb), (d3, v2)]) {
            position += distance;
            check_close("position", point.state.position, position, tolerance::CLOSED_FORM);
            check_close("velocity", point.state.velocity, velocity, tolerance::CLOSED_FORM);
        }
    }
}

#[test]
fn algorithm_1_reduces_v2_when_asked_by_name() {
    let planner = planner(Shape::SineQuintic, Timing::Fastest, 0.05);
    assert!(planner.ramp(0.0, 0.0, 0.14).is_err());
    let step = planner.ramp_saturated(0.0, 0.0, 0.14).unwrap();
    assert_eq!(step.end().velocity, planner.reachable(0.0).max);
    check_close(
        "period",
        step.segments().iter().map(jbtg::Segment::duration).sum(),
        0.05,
        tolerance::CLOSED_FORM,
    );
}

#[test]
fn algorithm_2_with_too_little_time_uses_all_of_it() {
    let dt = 0.02;
    let dt_max = PI * ACCELERATION / (2.0 * JERK);
    assert!(dt < 2.0 * dt_max);
    let planner = planner(Shape::SineQuintic, Timing::Fastest, dt);
    for v2 in [planner.reachable(0.0).max, planner.reachable(0.0).min] {
        let step = planner.ramp(0.5, 0.0, v2).unwrap();
        check_durations(&step, &[0.5 * dt, 0.5 * dt]);
        let a_peak = v2.signum() * 2.0 * JERK * (0.5 * dt) / PI; // [P, Eq. (apeak)]
        check_close("a_peak", step.segments()[1].state_at(0.0).acceleration, a_peak, tolerance::CLOSED_FORM);
    }
}

#[test]
fn algorithm_2_with_too_small_a_change_shrinks_the_pulse() {
    let (dt, change) = (0.05, 0.004);
    let dt_max = PI * ACCELERATION / (2.0 * JERK);
    assert!(dt > 2.0 * dt_max && change < dt_max * ACCELERATION); // Case 1.2 of [P, Alg. 3], [P, Eq. (dvmin)]
    let planner = planner(Shape::SineQuintic, Timing::Fastest, dt);
    for v2 in [change, -change] {
        let step = planner.ramp(0.5, 0.0, v2).unwrap();
        let dt_peak = (PI * change / (2.0 * JERK)).sqrt(); // [P, Eq. (apeak time)]
        check_durations(&step, &[dt_peak, dt_peak, dt - 2.0 * dt_peak]);
        let a_peak = v2.signum() * 2.0 * JERK * dt_peak / PI;
        check_close("a_peak", step.segments()[1].state_at(0.0).acceleration, a_peak, tolerance::CLOSED_FORM);
    }
}

#[test]
fn algorithm_3_case_3_is_a_cruise() {
    for (shape, timing) in SHAPES.into_iter().flat_map(|shape| TIMINGS.map(|timing| (shape, timing))) {
        for v in [0.1, -0.1, 0.0] {
            let step = planner(shape, timing, 0.05).ramp(0.5, v, v).unwrap();
            check_durations(&step, &[0.05]);
            assert_eq!(step.end().position, 0.5 + v * 0.05);
            assert_eq!(step.extrema().acceleration, Interval::new(0.0, 0.0));
        }
    }
}

#[test]
fn unequal_limits_give_each_ramp_its_own_time() {
    let (acceleration, jerk) = (Interval::new(-0.5, 1.0), Interval::new(-50.0, 100.0));
    let planner = unequal_planner((Shape::Smoothstep, Timing::Fastest, 0.2), acceleration, jerk);
    let up = planner.ramp(0.5, 0.0, 0.06).unwrap(); // rises at +J, falls at −J
    check_durations(&up, &[0.015, 0.06 - 0.5 * 0.045, 0.03, 0.2 - 0.045 - 0.06 + 0.5 * 0.045]);
    let down = planner.ramp(0.5, 0.0, -0.06).unwrap(); // rises at −J, falls at +J
    check_durations(&down, &[0.015, 0.12 - 0.5 * 0.0225, 0.0075, 0.2 - 0.0225 - 0.12 + 0.5 * 0.0225]);
}

#[test]
fn stretched_steps_cover_the_mean_velocity() {
    for shape in SHAPES {
        let planner = planner(shape, Timing::Stretched, 0.05);
        for (v1, v2) in [(0.02, 0.05), (0.05, 0.02), (-0.01, 0.01), (0.1, 0.11)] {
            let displacement = planner.displacement(v1, v2);
            assert!(
                (displacement - 0.05 * 0.5 * (v1 + v2)).abs() <= tolerance::CLOSED_FORM * 0.05 * VELOCITY
            );
        }
    }
}

#[test]
fn zero_acceleration_at_every_step_leaves_70_percent_at_50_ms_and_33_at_20_ms() {
    for (period, share) in [(0.05, 0.7), (0.02, 1.0 / 3.0)] {
        let planner = planner(Shape::Smoothstep, Timing::Stretched, period);
        for direction in [Direction::Increasing, Direction::Decreasing] {
            let authority = planner.authority(direction);
            check_close("share", authority.share, share, tolerance::CLOSED_FORM);
            check_close("velocity change", authority.velocity_change, share * period, tolerance::CLOSED_FORM);
        }
    }
    assert!(planner(Shape::Smoothstep, Timing::Stretched, 0.02).is_period_short());
    assert!(!planner(Shape::Smoothstep, Timing::Stretched, 0.05).is_period_short());
}

/// Peak acceleration of the planner's sine ramps: what the limit leaves beside the quintic's excess and the guard.
const SINE_PEAK: f64 = ACCELERATION / (1.0 + SINE_EXCESS) * (1.0 - 1e-14);

/// The time of a speed ramp by `change` and its kind, [P, Alg. 1] or [P, Alg. 2].
fn speed_ramp(change: f64) -> (f64, PulseKind) {
    let dt_max = PI * SINE_PEAK / (2.0 * JERK);
    if change > dt_max * SINE_PEAK {
        (2.0 * dt_max + (change - dt_max * SINE_PEAK) / SINE_PEAK, PulseKind::Msap)
    } else {
        (2.0 * (PI * change / (2.0 * JERK)).sqrt(), PulseKind::Map)
    }
}

/// A detour in the positive direction: its case and kinds, that both ramps and the cruise take exactly dt by the paper's
/// own times, and that it leads there.
#[track_caller]
fn check_detour(
    (dt, v1, v2): (f64, f64, f64),
    (case, rise, fall): (DetourCase, Option<PulseKind>, Option<PulseKind>),
    has_cruise: bool,
) {
    let planner = planner(Shape::SineQuintic, Timing::Fastest, dt);
    let detour = planner.detour(v1, v2, Direction::Increasing).expect("a reachable velocity");
    assert_eq!((detour.case, detour.rise, detour.fall), (case, rise, fall), "{detour:?}");
    assert_eq!(detour.cruise > 0.0, has_cruise, "{detour:?}");
    assert_eq!(has_cruise, detour.peak > 0.999 * VELOCITY, "a cruise is at v_max: {detour:?}");
    let (up, down) = (speed_ramp(detour.peak - v1), speed_ramp(detour.peak - v2));
    check_close("dt", up.0 + detour.cruise + down.0, dt, tolerance::CLOSED_FORM);
    assert!(rise.is_none_or(|kind| kind == up.1) && fall.is_none_or(|kind| kind == down.1));
    let step = planner.waypoint(0.3, v1, v2).expect("a reachable velocity");
    assert_eq!((step.end().velocity, step.duration()), (v2, dt));
    // With equal limits a ramp covers the mean of its velocities.
    let peak = detour.peak;
    let distance = 0.5 * (v1 + peak) * up.0 + peak * detour.cruise + 0.5 * (peak + v2) * down.0;
    check_close("displacement", step.end().position - 0.3, distance, tolerance::CLOSED_FORM * 0.5 / distance);
}

#[test]
fn algorithm_3_case_1_is_one_speed_ramp() {
    let top = planner(Shape::SineQuintic, Timing::Fastest, 0.2).velocity().max;
    let (msap, map) = (Some(PulseKind::Msap), Some(PulseKind::Map));
    check_detour((0.2, 0.05, top), (DetourCase::One, msap, None), true);
    check_detour((0.2, top - 0.01, top), (DetourCase::One, map, None), true);
    check_detour((0.2, top, 0.05), (DetourCase::One, None, msap), true); // cruises first
    check_detour((0.2, top, top), (DetourCase::Three, None, None), true);
}

#[test]
fn algorithm_3_case_2_goes_through_a_peak() {
    let (msap, map) = (Some(PulseKind::Msap), Some(PulseKind::Map));
    check_detour((0.3, 0.02, 0.05), (DetourCase::Two, msap, msap), true); // 2.2a-i
    check_detour((0.15, 0.02, 0.05), (DetourCase::Two, msap, msap), false); // 2.2a-ii
    check_detour((0.07, 0.02, 0.05), (DetourCase::Two, msap, map), false); // 2.2b
    check_detour((0.07, 0.05, 0.02), (DetourCase::Two, map, msap), false); // not in the paper: v₂ < v₁
    check_detour((0.03, 0.02, 0.021), (DetourCase::Two, map, map), false); // 2.2b, too
    check_detour((0.3, 0.02, 0.14), (DetourCase::Two, msap, map), true); // 2.3a
    check_detour((0.16, 0.02, 0.145), (DetourCase::Two, msap, map), false); // 2.3b
    check_detour((0.3, -0.05, 0.02), (DetourCase::Two, msap, msap), false); // v₁ < 0 ≤ v₂
}

#[test]
fn algorithm_3_case_4_is_symmetric() {
    let (msap, map) = (Some(PulseKind::Msap), Some(PulseKind::Map));
    check_detour((0.4, 0.05, 0.05), (DetourCase::Four, msap, msap), true);
    check_detour((0.1, 0.05, 0.05), (DetourCase::Four, msap, msap), false);
    check_detour((0.04, 0.05, 0.05), (DetourCase::Four, map, map), false);
    check_detour((0.1, 0.14, 0.14), (DetourCase::Four, map, map), true);
    let step = planner(Shape::Smoothstep, Timing::Fastest, 0.1).waypoint(0.3, 0.05, 0.05).unwrap();
    let peak = step.state_at(0.05).velocity;
    for i in 0..50 {
        let (before, after) = (step.state_at(f64::from(i) * 1e-3), step.state_at(0.1 - f64::from(i) * 1e-3));
        assert!((before.velocity - after.velocity).abs() <= 1e-15, "at {i} ms");
    }
    // Four ramps of 1.5·A/J and two acceleration cruises.
    check_close("v_peak", peak, 0.05 + ACCELERATION * (0.05 - 0.015), tolerance::CLOSED_FORM);
}

#[test]
fn algorithm_3_turns_towards_v_min_for_a_negative_end() {
    let planner = planner(Shape::SineQuintic, Timing::Fastest, 0.15);
    for (v1, v2) in [(0.02, -0.03), (-0.02, -0.05), (-0.05, -0.05)] {
        let (down, up) = (planner.waypoint(0.0, v1, v2).unwrap(), planner.waypoint(0.0, -v1, -v2).unwrap());
        assert_eq!(down.end().position, -up.end().position);
        assert_eq!(down.extrema().velocity, up.extrema().velocity.mirrored());
        assert!(down.extrema().velocity.min < v2);
    }
}

/// Eight control points, seven quintics.
#[test]
fn algorithm_3_takes_up_to_eight_control_points() {
    let planner = planner(Shape::SineQuintic, Timing::Fastest, 0.4);
    let step = planner.waypoint(0.3, 0.02, 0.05).unwrap();
    assert_eq!(step.control_points().count(), 8);
    assert_eq!(step.segments().len(), jbtg::MAX_SEGMENTS);
    check_eqmat(&step, Shape::SineQuintic);
}
