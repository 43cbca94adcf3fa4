//! The interface of version 0.1, written out: a caller of it compiles until 0.2.
//!
//! A function that changes its signature, a field or a variant that is added or removed breaks callers, and so this file.
//! Then the version's minor number goes up, here and in the manifest; what is merely new is added below.

use jbtg::{Planner, PlannerSpec};
use safezone::{
    BrakingTable, BuildError, Command, FailSafeReason, Knot, ParseError, RangeStatus, Request, SafeRange,
    SafeZone, Samples, Side, Source, TableError, TableParts, ZoneError,
};

#[test]
fn the_version_is_the_one_whose_interface_this_is() {
    assert!(env!("CARGO_PKG_VERSION").starts_with("0.1."));
}

#[test]
fn functions_keep_their_signatures() {
    type Zone = SafeZone<'static>;
    type Table = BrakingTable<'static>;
    let _: fn(Planner) -> Result<Zone, ZoneError> = SafeZone::closed_form;
    let _: fn(Planner, Table) -> Result<Zone, ZoneError> = SafeZone::new;
    let _: fn(Planner, &'static mut Samples) -> Result<Zone, ZoneError> = SafeZone::sampled;
    let _: Samples = Samples::default();
    let _: fn(&Zone) -> &Planner = Zone::planner;
    let _: fn(&Zone) -> Option<&Table> = Zone::table;
    let _: fn(&Zone, Side) -> f64 = Zone::guard;
    let _: fn(&Zone, f64) -> f64 = Zone::stopping_distance;
    let _: fn(&Zone, f64, f64) -> SafeRange = Zone::range;
    let _: fn(&Zone, f64, f64, Request) -> Command = Zone::command;
    let _: fn(&Zone, f64, f64, f64) -> Command = Zone::command;
    let _: fn(&Zone, f64, f64, Option<f64>) -> Command = Zone::command;
    let _: fn(&SafeRange, f64) -> f64 = SafeRange::map_action;
    let _: fn(&SafeRange, f64) -> bool = SafeRange::contains;
    let _: fn(TableParts<'static>) -> Result<Table, TableError> = Table::try_from;
    let _: fn(&Table) -> &PlannerSpec = Table::built_from;
    let _: fn(&Table) -> u32 = Table::subdivisions;
    let _: fn(&Table) -> u64 = Table::hash;
    let _: fn(&Table, Side) -> &[Knot] = Table::knots;
    let _: [fn(&Table, Side, f64) -> f64; 2] = [Table::distance, Table::max_velocity];
    let _: fn(&Planner) -> Result<Table, BuildError> = BrakingTable::build;
    let _: fn(&Table) -> String = Table::to_ron;
    let _: fn(&str) -> Result<Table, ParseError> = BrakingTable::from_ron;
}

#[test]
fn fields_are_all_there_are() {
    let status = RangeStatus::Safe;
    let range = SafeRange { min: 0.0, max: 0.0, brake: 0.0, narrowed: false, status };
    let Command { velocity: _, source: _, range: _ } =
        Command { velocity: 0.0, source: Source::Policy, range };
    let Knot { distance: _, velocity: _ } = Knot { distance: 0.0, velocity: 0.0 };
    let _ = |parts: TableParts<'_>| {
        let TableParts { built_from: _, subdivisions: _, upper: _, lower: _, hash: _ } = parts;
    };
}

#[test]
fn variants_are_all_there_are() {
    let _ = |side| match side {
        Side::Upper | Side::Lower => (),
    };
    let _ = |status| match status {
        RangeStatus::Safe
        | RangeStatus::VelocityOutside
        | RangeStatus::CannotStop
        | RangeStatus::PositionOutside
        | RangeStatus::Unknown => (),
    };
    let _ = |request| match request {
        Request::Action(_) | Request::Missing | Request::Late => (),
    };
    let _ = |source| match source {
        Source::Policy | Source::PolicyClamped { action: _ } | Source::FailSafe(_) => (),
    };
    let _ = |reason| match reason {
        FailSafeReason::Missing
        | FailSafeReason::Late
        | FailSafeReason::NonFinite
        | FailSafeReason::UnknownState => (),
    };
    let _ = |error| match error {
        ZoneError::Stale { hash: _ }
        | ZoneError::Distance { side: _, velocity: _, distance: _, needed: _ }
        | ZoneError::Spacing { side: _, expected: _, found: _ }
        | ZoneError::Narrow { width: _, guard: _ } => (),
    };
}
