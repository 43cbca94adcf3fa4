//! Whatever C hands over, the answer is a status.
#![expect(clippy::unwrap_used, reason = "helpers of tests: a broken fixture must fail them")]

use std::mem::MaybeUninit;

use jbtg_c::{
    Interval, JBTG_FASTEST, JBTG_SMOOTHSTEP, Joint, Limits, Spec, State, Status, jbtg_authority_of,
    jbtg_check_limits, jbtg_command_action, jbtg_command_velocity, jbtg_joint_init, jbtg_plan,
    jbtg_plan_interrupt, jbtg_plan_stop, jbtg_plan_waypoint, jbtg_reachable, jbtg_safe_range,
    jbtg_sampler_advance, jbtg_sampler_command, jbtg_sampler_init, jbtg_sampler_upcoming, jbtg_status_text,
    jbtg_step_extrema, jbtg_step_state_at, jbtg_stopping_distance,
};

const fn interval(min: f64, max: f64) -> Interval {
    Interval { min, max }
}

const SPEC: Spec = Spec {
    limits: Limits {
        position: interval(0.14, 0.50),
        velocity: interval(-0.15, 0.15),
        acceleration: interval(-1.0, 1.0),
        jerk: interval(-100.0, 100.0),
    },
    period: 0.05,
    shape: JBTG_SMOOTHSTEP,
    timing: JBTG_FASTEST,
};

/// A joint as the crates have it; what C holds is the same in its own memory.
fn joint() -> Joint {
    Joint::try_from(SPEC).unwrap()
}

fn init(spec: &Spec) -> Status {
    jbtg_joint_init(Some(&mut MaybeUninit::uninit()), Some(spec))
}

#[test]
fn every_pointer_may_be_null() {
    let joint = joint();
    let null = Status::NullPointer;
    assert_eq!(jbtg_check_limits(None), null);
    assert_eq!(jbtg_joint_init(None, Some(&SPEC)), null);
    assert_eq!(jbtg_joint_init(Some(&mut MaybeUninit::uninit()), None), null);
    assert_eq!(jbtg_authority_of(None, true, Some(&mut MaybeUninit::uninit())), null);
    assert_eq!(jbtg_authority_of(Some(&joint), true, None), null);
    assert_eq!(jbtg_reachable(None, 0.0, None), null);
    assert_eq!(jbtg_reachable(Some(&joint), 0.0, None), null);
    assert_eq!(jbtg_stopping_distance(Some(&joint), 0.0, None), null);
    assert_eq!(jbtg_safe_range(Some(&joint), 0.3, 0.0, None), null);
    assert_eq!(jbtg_command_velocity(Some(&joint), 0.3, 0.0, 0.1, None), null);
    assert_eq!(jbtg_command_action(None, 0.3, 0.0, 0.1, Some(&mut MaybeUninit::uninit())), null);
    assert_eq!(jbtg_plan(Some(&joint), 0.3, 0.0, 0.01, None), null);
    assert_eq!(jbtg_plan_waypoint(None, 0.3, 0.0, 0.01, Some(&mut MaybeUninit::uninit())), null);
    assert_eq!(jbtg_step_state_at(None, 0.0, Some(&mut MaybeUninit::uninit())), null);
    assert_eq!(jbtg_step_extrema(None, None), null);
    assert_eq!(jbtg_plan_stop(Some(&joint), None, Some(&mut MaybeUninit::uninit()), None), null);
    assert_eq!(jbtg_plan_interrupt(Some(&joint), None, 0.0, None, None, None), null);
    assert_eq!(jbtg_sampler_init(None, Some(&joint), 50, 0.3), null);
    assert_eq!(jbtg_sampler_command(None, 0.0), null);
    assert_eq!(jbtg_sampler_upcoming(None, None), null);
    assert_eq!(jbtg_sampler_advance(None, Some(&mut MaybeUninit::uninit())), null);
}

#[test]
fn every_refusal_has_its_status() {
    let limits = SPEC.limits;
    for (spec, status) in [
        (SPEC, Status::Ok),
        (Spec { shape: 2, ..SPEC }, Status::UnknownChoice),
        (Spec { timing: 77, ..SPEC }, Status::UnknownChoice),
        (Spec { period: f64::NAN, ..SPEC }, Status::BadPeriod),
        (Spec { period: 1e-9, ..SPEC }, Status::PeriodTooShort),
        (Spec { limits: Limits { jerk: interval(-1e-3, f64::NAN), ..limits }, ..SPEC }, Status::NotFinite),
        (Spec { limits: Limits { position: interval(0.5, 0.5), ..limits }, ..SPEC }, Status::EmptyPosition),
        (Spec { limits: Limits { velocity: interval(0.0, 0.5), ..limits }, ..SPEC }, Status::ZeroNotInside),
        (Spec { limits: Limits { position: interval(1e9, 1e9 + 1e-6), ..limits }, ..SPEC }, Status::Narrow),
    ] {
        assert_eq!(init(&spec), status, "{spec:?}");
    }
    assert_eq!(jbtg_check_limits(Some(&limits)), Status::Ok);
    let mut step = MaybeUninit::uninit();
    assert_eq!(jbtg_plan(Some(&joint()), 0.3, 0.0, 0.2, Some(&mut step)), Status::Unreachable);
    assert_eq!(jbtg_plan(Some(&joint()), 0.3, f64::NAN, 0.0, Some(&mut step)), Status::NotFinite);
    let no_ticks = jbtg_sampler_init(Some(&mut MaybeUninit::uninit()), Some(&joint()), 0, 0.3);
    assert_eq!(no_ticks, Status::UnknownChoice);
    let nowhere = jbtg_sampler_init(Some(&mut MaybeUninit::uninit()), Some(&joint()), 50, f64::NAN);
    assert_eq!(nowhere, Status::NotFinite);
    let lost = State { position: 0.3, velocity: f64::INFINITY, acceleration: 0.0, jerk: 0.0 };
    let stop = jbtg_plan_stop(Some(&joint()), Some(&lost), Some(&mut MaybeUninit::uninit()), None);
    assert_eq!(stop, Status::NotFinite);
    let mut reachable = MaybeUninit::uninit();
    assert_eq!(jbtg_reachable(Some(&joint()), f64::INFINITY, Some(&mut reachable)), Status::NotFinite);
}

#[test]
fn every_status_has_a_text_of_its_own() {
    let mut texts = std::collections::BTreeSet::new();
    for number in -11..=1 {
        let text = jbtg_status_text(number);
        assert!(!text.is_null());
        texts.insert(text as usize);
    }
    // Eleven statuses, and one text for every number that is none.
    assert_eq!(texts.len(), 12);
    assert_eq!(jbtg_status_text(i32::MIN), jbtg_status_text(1));
}
