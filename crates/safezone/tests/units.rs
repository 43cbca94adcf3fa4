//! What no choice of units and no choice of sign may change.

use jbtg::strategies::planners;
use jbtg::{Interval, Limits, LimitsSpec, Planner, PlannerSpec};
use proptest::prelude::*;
use safezone::{BrakingTable, SafeRange, SafeZone};

use crate::adversary::safe_state;
use crate::telescope;

/// Most knots of a table that is built here.
const FEW: f64 = 2000.0;

/// The planner of the same joint, with lengths `length` and times `time` times as large.
fn in_units(planner: &Planner, length: f64, time: f64) -> Planner {
    let PlannerSpec { limits, shape, timing, period } = *planner.spec();
    let scaled =
        |interval: Interval, factor: f64| Interval::new(interval.min * factor, interval.max * factor);
    let limits = Limits::try_from(LimitsSpec {
        position: scaled(limits.position(), length),
        velocity: scaled(limits.velocity(), length / time),
        acceleration: scaled(limits.acceleration(), length / time.powi(2)),
        jerk: scaled(limits.jerk(), length / time.powi(3)),
    })
    .expect("limits");
    Planner::try_from(PlannerSpec { limits, shape, timing, period: period * time })
        .expect("a planner as before")
}

fn mirrored(planner: &Planner) -> Planner {
    let PlannerSpec { limits, .. } = *planner.spec();
    let limits = Limits::try_from(LimitsSpec {
        position: limits.position().mirrored(),
        velocity: limits.velocity().mirrored(),
        acceleration: limits.acceleration().mirrored(),
        jerk: limits.jerk().mirrored(),
    })
    .expect("limits");
    Planner::try_from(PlannerSpec { limits, ..*planner.spec() }).expect("a planner as before")
}

/// The zones of a planner: in closed form and, where that is small, with a table.
fn zones(planner: Planner) -> Vec<SafeZone<'static>> {
    let step = planner.authority(jbtg::Direction::Decreasing).velocity_change;
    let is_small = planner.velocity().max < FEW / 16.0 * step;
    let table = BrakingTable::build(&planner).ok().filter(|_| is_small);
    let with_table = table.and_then(|table| SafeZone::new(planner, table).ok());
    SafeZone::closed_form(planner).ok().into_iter().chain(with_table).collect()
}

/// Shares of the position interval and of the velocity interval, inside, at an end and beyond.
fn starts() -> impl Strategy<Value = Vec<(f64, f64)>> {
    let share = || prop_oneof![Just(0.0), Just(1.0), 0.0..=1.0, 0.9..1.1, -0.1..0.1, -3.0..4.0];
    prop::collection::vec((share(), share()), 16)
}

fn state(planner: &Planner, (position, velocity): (f64, f64)) -> (f64, f64) {
    let (limits, bounds) = (planner.limits().position(), planner.velocity());
    (limits.min + position * limits.width(), bounds.min + velocity * bounds.width())
}

/// By powers of four square roots are as exact as products: every bit of the range stays.
fn check_scaled(
    (zone, other): (&SafeZone<'_>, &SafeZone<'_>),
    (position, velocity): (f64, f64),
    (length, time): (f64, f64),
) -> Result<(), TestCaseError> {
    let found = other.range(position * length, velocity * (length / time));
    let SafeRange { min, max, brake, narrowed, status } = zone.range(position, velocity);
    let [min, max, brake] = [min, max, brake].map(|v| v * (length / time));
    prop_assert_eq!(found, SafeRange { min, max, brake, narrowed, status });
    Ok(())
}

/// Low speeds near the limit, where the interior of a step matters.
#[test]
fn how_a_step_turns_does_not_depend_on_the_units() {
    for (shape, timing) in telescope::ALL {
        let planner = telescope::planner(shape, timing);
        let zone = SafeZone::closed_form(planner).unwrap();
        for units in [(4_f64.powi(10), 4_f64.powi(5)), (4_f64.powi(-10), 4_f64.powi(-5))] {
            let other = SafeZone::closed_form(in_units(&planner, units.0, units.1)).unwrap();
            for (i, j) in (0..=40).flat_map(|i| (0..=40).map(move |j| (f64::from(i), f64::from(j)))) {
                let state = safe_state(&zone, (0.4 + 0.005 * i, 0.9 + 0.0025 * j));
                check_scaled((&zone, &other), state, units).unwrap();
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { max_global_rejects: u32::MAX, ..ProptestConfig::with_cases(300) })]

    #[test]
    fn a_range_does_not_depend_on_the_units(
        planner in planners(),
        starts in starts(),
        (length, time) in (-6_i32..=6, -6_i32..=6),
    ) {
        let (length, time) = (4_f64.powi(length), 4_f64.powi(time));
        for (zone, other) in zones(planner).iter().zip(&zones(in_units(&planner, length, time))) {
            for start in &starts {
                let (position, velocity) = state(&planner, *start);
                check_scaled((zone, other), (position, velocity), (length, time))?;
            }
        }
    }

    #[test]
    fn a_mirrored_joint_has_mirrored_ranges(planner in planners(), starts in starts()) {
        for (zone, other) in zones(planner).iter().zip(&zones(mirrored(&planner))) {
            for start in &starts {
                let (position, velocity) = state(&planner, *start);
                let found = other.range(-position, -velocity);
                let SafeRange { min, max, brake, narrowed, status } = zone.range(position, velocity);
                prop_assert_eq!(found, SafeRange { min: -max, max: -min, brake: -brake, narrowed, status });
            }
        }
    }
}
