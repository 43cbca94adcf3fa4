//! Nothing panics, whatever the input.

use jbtg::strategies::planners;
use jbtg::{Interval, Limits, LimitsSpec, Planner, PlannerSpec};
use proptest::num::f64::ANY;
use proptest::prelude::*;
use safezone::{BrakingTable, Knot, RangeStatus, Request, SafeZone, Samples, Side, TableError, TableParts};

/// Any bit pattern: NaN, infinities, zeros and subnormal numbers included, and the largest ones more often than chance.
fn numbers() -> impl Strategy<Value = f64> {
    let special = [0.0, -0.0, f64::MIN_POSITIVE, 5e-324, f64::MAX, f64::MIN, f64::NAN, f64::INFINITY];
    prop_oneof![3 => ANY, 2 => prop::sample::select(special.to_vec()), 3 => -1e3..1e3]
}

fn requests() -> impl Strategy<Value = Request> {
    prop_oneof![6 => numbers().prop_map(Request::Action), 1 => Just(Request::Missing), 1 => Just(Request::Late)]
}

/// Magnitudes over all of double precision's range.
fn magnitudes() -> impl Strategy<Value = f64> {
    let wide = (-320.0..308.3_f64).prop_map(|e| 10_f64.powf(e));
    prop_oneof![3 => wide, 1 => (-9.0..9.0_f64).prop_map(|e| 10_f64.powf(e))]
}

fn any_planner() -> impl Strategy<Value = Option<Planner>> {
    let interval = || (magnitudes(), magnitudes()).prop_map(|(a, b)| Interval::new(-a, b));
    let spec = (interval(), interval(), interval(), interval(), magnitudes());
    (spec, jbtg::strategies::shapes(), jbtg::strategies::timings()).prop_map(
        |((position, velocity, acceleration, jerk, period), shape, timing)| {
            let limits = Limits::try_from(LimitsSpec { position, velocity, acceleration, jerk }).ok()?;
            Planner::try_from(PlannerSpec { limits, shape, timing, period }).ok()
        },
    )
}

/// Whatever a zone is asked, the answer is a range that a step can be planned in.
fn check_total(
    zone: &SafeZone<'_>,
    (position, velocity): (f64, f64),
    request: Request,
) -> Result<(), TestCaseError> {
    let command = zone.command(position, velocity, request);
    let range = command.range;
    prop_assert!(range.min <= range.brake && range.brake <= range.max, "{range:?}");
    prop_assert!(range.contains(command.velocity), "{command:?}");
    prop_assert_eq!(range.status == RangeStatus::Unknown, !(position.is_finite() && velocity.is_finite()));
    if range.status == RangeStatus::Unknown {
        prop_assert!(range.min == range.max && range.narrowed, "{range:?}");
    } else {
        let reachable = zone.planner().reachable(velocity);
        prop_assert!(
            reachable.contains(range.min) && reachable.contains(range.max),
            "{range:?} of {reachable:?}"
        );
        prop_assert_eq!(
            range.narrowed,
            range.min > reachable.min || range.max < reachable.max,
            "{:?}",
            range
        );
    }
    prop_assert!(zone.stopping_distance(velocity) >= 0.0, "{velocity:e}");
    Ok(())
}

fn knots() -> impl Strategy<Value = Vec<Knot>> {
    // Half of them equally spaced and rising, so that the checks beyond the first come into play.
    let spaced = (magnitudes(), prop::collection::vec(0.0..3.0_f64, 1..80)).prop_map(|(spacing, rises)| {
        let mut distance = 0.0;
        let rising = rises.into_iter().enumerate().map(|(i, rise)| {
            distance += spacing * (i as f64 + 0.5 + 0.2 * rise);
            Knot { distance, velocity: (i + 1) as f64 * spacing }
        });
        std::iter::once(Knot { distance: 0.0, velocity: 0.0 }).chain(rising).collect()
    });
    let wild = prop::collection::vec((numbers(), numbers()), 0..6).prop_map(|knots| {
        knots.into_iter().map(|(distance, velocity)| Knot { distance, velocity }).collect()
    });
    prop_oneof![3 => spaced, 1 => wild]
}

proptest! {
    #![proptest_config(ProptestConfig { max_global_rejects: u32::MAX, ..ProptestConfig::with_cases(2000) })]

    #[test]
    fn every_state_and_request_has_a_command(
        planner in planners(), state in (numbers(), numbers()), request in requests(),
    ) {
        let Ok(zone) = SafeZone::closed_form(planner) else { return Ok(()) };
        check_total(&zone, state, request)?;
        if let Ok(table) = BrakingTable::build(&planner) {
            check_total(&SafeZone::new(planner, table).expect("its own table"), state, request)?;
        }
        let mut samples = Samples::default();
        check_total(&SafeZone::sampled(planner, &mut samples).expect("room to move"), state, request)?;
    }

    #[test]
    fn limits_of_any_size_have_a_zone_or_are_refused(
        planner in any_planner(), state in (numbers(), numbers()), share in 0.0..=1.0, request in requests(),
    ) {
        let Some(planner) = planner else { return Ok(()) };
        let mut samples = Samples::default();
        let limits = planner.limits().position();
        for zone in [SafeZone::closed_form(planner), SafeZone::sampled(planner, &mut samples)] {
            let Ok(zone) = zone else { continue };
            check_total(&zone, state, request)?;
            check_total(&zone, (limits.min + share * limits.width(), state.1), request)?;
        }
    }

    #[test]
    fn hostile_tables_are_refused_or_answer_in_order(
        planner in planners(),
        (upper, lower) in (knots(), knots()),
        subdivisions in prop_oneof![Just(1_u32), Just(16), Just(0), Just(u32::MAX), 1..20_u32],
        (period, speed, distance) in (numbers(), numbers(), numbers()),
    ) {
        let built_from = PlannerSpec { period, ..*planner.spec() };
        let mut parts = TableParts { built_from, subdivisions, upper: &upper, lower: &lower, hash: 0 };
        if let Err(TableError::Corrupted { found, .. }) = BrakingTable::try_from(parts) {
            parts.hash = found;
        }
        let Ok(table) = BrakingTable::try_from(parts) else { return Ok(()) };
        for side in [Side::Upper, Side::Lower] {
            prop_assert!(table.distance(side, speed) >= 0.0);
            let last = table.knots(side)[table.knots(side).len() - 1];
            let found = table.max_velocity(side, distance);
            prop_assert!((0.0..=last.velocity).contains(&found), "{found:e} for {distance:e}");
            for i in 0..=20 {
                let distance = last.distance * (f64::from(i) / 20.0);
                let back = table.distance(side, table.max_velocity(side, distance));
                prop_assert!((back - distance).abs() <= 1e-12 * last.distance, "{back:e} for {distance:e}");
            }
        }
        prop_assert!(SafeZone::new(planner, table).is_err(), "a hostile table was taken");
    }
}

/// A negative period made a parabola that leads back, and a lookup that was a step off.
#[test]
fn a_table_of_no_period_is_refused() {
    let one = Interval::symmetric(1.0);
    let limits = LimitsSpec { position: one, velocity: one, acceleration: one, jerk: one };
    let limits = Limits::try_from(limits).expect("limits around zero");
    let (shape, timing) = (jbtg::Shape::Smoothstep, jbtg::Timing::Stretched);
    let spec = PlannerSpec { limits, shape, timing, period: -5.5e65 };
    let knots = [(0.0, 0.0), (0.5, 1.0), (2.0, 2.0)].map(|(distance, velocity)| Knot { distance, velocity });
    let mut parts =
        TableParts { built_from: spec, subdivisions: 1, upper: &knots, lower: &knots[..2], hash: 0 };
    let Err(TableError::Corrupted { found, .. }) = BrakingTable::try_from(parts) else {
        panic!("a hash of 0")
    };
    parts.hash = found;
    let refused = BrakingTable::try_from(parts);
    assert_eq!(refused, Err(TableError::Malformed { side: Side::Upper, index: 0 }));
}
