//! The lookup side does not allocate.

use allocation_counter::measure;
use jbtg::{Shape, Timing};
use safezone::{BrakingTable, Request, SafeZone, Samples, Side, TableParts};

use crate::telescope::{ALL, planner};

#[test]
fn the_counter_sees_an_allocation() {
    let planner = planner(Shape::Smoothstep, Timing::Stretched);
    assert!(measure(|| drop(BrakingTable::build(&planner))).count_total > 0);
}

#[test]
fn nothing_on_the_way_of_a_control_loop_allocates() {
    for (shape, timing) in ALL {
        let planner = planner(shape, timing);
        let table = BrakingTable::build(&planner).unwrap();
        let parts = TableParts {
            built_from: *table.built_from(),
            subdivisions: table.subdivisions(),
            upper: table.knots(Side::Upper),
            lower: table.knots(Side::Lower),
            hash: table.hash(),
        };
        let allocated = measure(|| {
            let table = BrakingTable::try_from(parts).unwrap();
            let mut samples = Samples::default();
            let closed_form = SafeZone::closed_form(planner).unwrap();
            let sampled = SafeZone::sampled(planner, &mut samples).unwrap();
            for zone in [closed_form, SafeZone::new(planner, table).unwrap(), sampled] {
                let (mut position, mut velocity) = (0.3, 0.0);
                for i in 0..100 {
                    let request =
                        if i % 10 == 0 { Request::Missing } else { Request::Action(f64::from(i % 3) - 0.9) };
                    let command = zone.command(position, velocity, request);
                    let step = planner.ramp(position, velocity, command.velocity).unwrap();
                    (position, velocity) = (step.end().position, step.end().velocity);
                    if let Some(table) = zone.table() {
                        let distance = table.distance(Side::Upper, velocity);
                        assert!(table.max_velocity(Side::Upper, distance) <= velocity.max(0.0) + 1e-12);
                    }
                }
            }
        });
        assert_eq!(allocated.count_total, 0, "{shape:?} {timing:?} allocates");
    }
}
