//! Tables that are built: for which joints, how far they reach, how near to the closed form, and what of them a zone takes.

use jbtg::strategies::planners;
use jbtg::{Direction, Interval, Limits, Planner, PlannerSpec, Shape, SymmetricLimits, Timing};
use proptest::prelude::*;
use safezone::{
    BrakingTable, BuildError, Knot, MAX_KNOTS, SafeZone, Side, TableError, TableParts, ZoneError,
};

use crate::telescope;

/// Either side with the direction that brakes towards it.
const SIDES: [(Side, Direction, f64); 2] =
    [(Side::Upper, Direction::Decreasing, 1.0), (Side::Lower, Direction::Increasing, -1.0)];

proptest! {
    #![proptest_config(ProptestConfig { max_global_rejects: u32::MAX, ..ProptestConfig::with_cases(500) })]

    #[test]
    fn a_zone_takes_the_table_that_is_built_for_it(planner in planners()) {
        let table = match BrakingTable::build(&planner) {
            Err(BuildError::TooManyKnots { .. }) => return Ok(()),
            built => built?,
        };
        let closed_form = SafeZone::closed_form(planner);
        prop_assert_eq!(SafeZone::new(planner, table).err(), closed_form.err());
    }

    /// To the velocity limit, or to the first knot from which the whole interval does not suffice.
    #[test]
    fn a_table_reaches_as_far_as_the_interval(planner in planners()) {
        let Ok(table) = BrakingTable::build(&planner) else { return Ok(()) };
        let width = planner.limits().position().width();
        for (side, _, sign) in SIDES {
            let largest = (sign * planner.velocity().max).max(sign * planner.velocity().min);
            let knots = table.knots(side);
            let [.., before, last] = *knots else { unreachable!("two knots at least") };
            prop_assert!(last.velocity >= largest || last.distance > width);
            prop_assert!(before.velocity < largest && before.distance <= width, "{} knots", knots.len());
        }
    }

    /// On the safe side everywhere, and where a chord cuts a bulge off, no farther than the bulge asks for.
    #[test]
    fn a_table_is_never_short_of_the_closed_form(planner in planners(), shares in prop::collection::vec(0.0..=1.0, 16)) {
        let Ok(table) = BrakingTable::build(&planner) else { return Ok(()) };
        let Ok(zone) = SafeZone::closed_form(planner) else { return Ok(()) };
        for (side, braking, sign) in SIDES {
            let spare = |speed: f64| {
                let distance = zone.stopping_distance(sign * speed);
                (table.distance(side, speed) - distance) / distance
            };
            let knots = table.knots(side);
            let last = knots[knots.len() - 1].velocity;
            for speed in shares.iter().map(|share| share * last).filter(|speed| *speed > 0.0) {
                prop_assert!(spare(speed) >= -1e-14, "{:e} at {speed:e}", spare(speed));
            }
            let kink = planner.authority(braking).ramps_only;
            if kink <= last && planner.spec().timing == Timing::Fastest {
                let least = spare(kink).min(spare(knots[1].velocity)).abs();
                prop_assert!(least <= 1e-14, "{least:e} at the kink or a knot");
            }
        }
    }
}

#[test]
fn braking_takes_more_knots_than_a_table_holds() {
    let position = Interval::new(0.0, 1e9);
    let step = telescope::planner(Shape::Smoothstep, Timing::Stretched)
        .authority(Direction::Decreasing)
        .velocity_change;
    let build = |velocity: f64| {
        let limits = SymmetricLimits { position, velocity, acceleration: 1.0, jerk: 100.0 };
        let limits = Limits::try_from(limits).unwrap();
        let (shape, timing) = (Shape::Smoothstep, Timing::Stretched);
        BrakingTable::build(&Planner::try_from(PlannerSpec { limits, shape, timing, period: 0.05 }).unwrap())
    };
    let most = MAX_KNOTS as f64 - 1.0;
    assert_eq!(build((most - 0.5) * step).map(|table| table.knots(Side::Lower).len()), Ok(MAX_KNOTS));
    let error = build((most + 0.5) * step).unwrap_err();
    assert_eq!(error, BuildError::TooManyKnots { side: Side::Upper, limit: MAX_KNOTS });
}

/// A knot from which just the whole interval suffices is not the last.
#[test]
fn a_table_goes_on_from_a_knot_that_needs_the_whole_interval() {
    let telescope = telescope::planner(Shape::Smoothstep, Timing::Stretched);
    let knot = BrakingTable::build(&telescope).unwrap().knots(Side::Upper)[3];
    let position = Interval::new(0.0, knot.distance);
    let limits = SymmetricLimits { position, velocity: 0.15, acceleration: 1.0, jerk: 100.0 };
    let limits = Limits::try_from(limits).unwrap();
    let planner = Planner::try_from(PlannerSpec { limits, ..*telescope.spec() }).unwrap();
    let table = BrakingTable::build(&planner).unwrap();
    assert_eq!((table.knots(Side::Upper)[3], table.knots(Side::Upper).len()), (knot, 5));
}

/// The telescope's table with the upper knots forged, and its zone.
fn forged(forge: impl Fn(&mut Vec<Knot>)) -> Result<SafeZone<'static>, ZoneError> {
    let planner = telescope::planner(Shape::Smoothstep, Timing::Stretched);
    let honest = BrakingTable::build(&planner).expect("a table");
    let (mut upper, lower) = (honest.knots(Side::Upper).to_vec(), honest.knots(Side::Lower));
    forge(&mut upper);
    let upper: &'static [Knot] = upper.leak();
    let lower: &'static [Knot] = lower.to_vec().leak();
    let mut parts =
        TableParts { built_from: *planner.spec(), subdivisions: 1, upper, lower, hash: honest.hash() };
    if let Err(TableError::Corrupted { found, .. }) = BrakingTable::try_from(parts) {
        parts.hash = found;
    }
    SafeZone::new(planner, BrakingTable::try_from(parts).expect("knots in order"))
}

/// A knot may be off by its rounding, and by no more.
#[test]
fn a_knot_s_last_digits_may_differ_and_no_others() {
    assert!(forged(|knots| knots[3].distance = knots[3].distance.next_up().next_up()).is_ok());
    for factor in [1.0 - 1e-13, 1.0 + 1e-13] {
        let distance = forged(|knots| knots[3].distance *= factor).unwrap_err();
        assert!(matches!(distance, ZoneError::Distance { side: Side::Upper, .. }), "{distance}");
        let spacing = forged(|knots| {
            let spacing = knots[1].velocity * factor;
            (0..).zip(knots).for_each(|(i, knot)| knot.velocity = f64::from(i) * spacing);
        })
        .unwrap_err();
        assert!(matches!(spacing, ZoneError::Spacing { side: Side::Upper, .. }), "{spacing}");
    }
}
