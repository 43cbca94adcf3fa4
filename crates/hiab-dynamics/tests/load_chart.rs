//! Load charts: the payload is exactly the largest, the tip exactly where the chart says.
#![expect(clippy::unwrap_used, reason = "helpers of tests are tests too")]

mod support;

use hiab_dynamics::{Axis, CraneModel, LoadChart, LoadChartSpec};
use support::{crane, excavator};

/// How far an effort may be from its limit, relative.
const AT_LIMIT: f64 = 1e-9;

fn chart(model: &CraneModel, moving: &[&str], posture: Vec<f64>, samples: usize) -> LoadChart {
    let spec = LoadChartSpec {
        x: Axis { from: 0.5, to: 4.5, points: 9 },
        z: Axis { from: -1.5, to: 6.0, points: 11 },
        moving: moving.iter().map(|name| model.actuator_index(name).unwrap()).collect(),
        posture,
        samples,
    };
    model.load_chart(&spec).unwrap()
}

fn charts() -> [(&'static str, CraneModel, LoadChart); 2] {
    let (crane, excavator) = (crane(), excavator());
    let of_crane = chart(&crane, &["lift_joint", "tilt_joint", "telescope_joint"], vec![0.0; 7], 7);
    let of_excavator =
        chart(&excavator, &["boom_cylinder_joint", "arm_cylinder_joint"], vec![0.0, 0.0, 0.0, -1.0], 7);
    [("crane", crane, of_crane), ("excavator", excavator, of_excavator)]
}

/// Largest share of its limit that any actuator needs to hold `payload` at rest, and which one.
fn greatest_share(model: &CraneModel, payload: f64, position: &[f64]) -> (f64, usize) {
    let loaded = model.clone().with_payload(payload).unwrap();
    let mut data = loaded.new_data();
    loaded.update_dynamics(&mut data, position, &vec![0.0; position.len()]).unwrap();
    let efforts = data.gravity_effort().iter().zip(loaded.actuators());
    let shares = efforts.map(|(effort, actuator)| effort.abs() / actuator.effort_limit());
    shares.zip(0..).max_by(|a, b| a.0.total_cmp(&b.0)).unwrap()
}

#[test]
fn at_the_largest_payload_one_actuator_is_at_its_limit_and_one_percent_more_exceeds_it() {
    for (name, model, chart) in charts() {
        let mut seen = 0;
        for point in chart.points.iter().flatten() {
            let (share, actuator) = greatest_share(&model, point.payload, &point.position);
            assert!((share - 1.0).abs() < AT_LIMIT, "{name}: {share} of the limit at {point:?}");
            assert_eq!(actuator, point.limited_by, "{name}: another actuator is at its limit at {point:?}");
            let (share, _) = greatest_share(&model, 1.01 * point.payload, &point.position);
            assert!(share > 1.0, "{name}: 1 % more is held, too, at {point:?}");
            seen += 1;
        }
        assert!(seen >= 15, "{name}: only {seen} positions are in reach");
    }
}

#[test]
fn every_posture_is_within_range_and_has_its_tip_on_the_grid() {
    for (name, model, chart) in charts() {
        for row in 0..chart.z.points {
            for column in 0..chart.x.points {
                let Some(point) = chart.point(column, row) else { continue };
                let mut data = model.new_data();
                model
                    .update_kinematics(&mut data, &point.position, &vec![0.0; point.position.len()])
                    .unwrap();
                let [x, _, z] = model.tip_pose(&data).position;
                let gap = (x - chart.x.value(column)).hypot(z - chart.z.value(row));
                assert!(gap < 1e-9, "{name}: the tip is {gap:e} m beside ({column}, {row})");
                for (actuator, y) in model.actuators().iter().zip(&point.position) {
                    let range = actuator.lower()..=actuator.upper();
                    assert!(range.contains(y), "{name}: {} at {y}, outside {range:?}", actuator.name());
                }
            }
        }
    }
}

#[test]
fn more_samples_of_a_redundant_actuator_never_lower_the_chart() {
    let model = crane();
    let moving = ["lift_joint", "tilt_joint", "telescope_joint"];
    // Seven values contain the four.
    let coarse = chart(&model, &moving, vec![0.0; 7], 4);
    let fine = chart(&model, &moving, vec![0.0; 7], 7);
    let mut raised = 0;
    for (coarse, fine) in coarse.points.iter().zip(&fine.points) {
        let payload = |point: &Option<hiab_dynamics::LoadPoint>| point.as_ref().map_or(0.0, |p| p.payload);
        assert!(payload(fine) >= payload(coarse) * (1.0 - AT_LIMIT), "{fine:?} is below {coarse:?}");
        raised += usize::from(payload(fine) > payload(coarse));
    }
    assert!(raised > 0, "a finer chart raises nothing");
}

#[test]
fn what_the_model_carries_already_does_not_count() {
    let model = excavator();
    let position = [0.0, 0.2, 0.2, -1.0];
    let mut data = model.new_data();
    let bare = model.largest_payload(&mut data, &position).unwrap().unwrap();
    let loaded =
        model.clone().with_payload(150.0).unwrap().largest_payload(&mut data, &position).unwrap().unwrap();
    assert_eq!(bare.1, loaded.1);
    assert!((bare.0 / loaded.0 - 1.0).abs() < AT_LIMIT, "{} and {} kg", bare.0, loaded.0);
}

#[test]
fn a_crane_too_weak_for_itself_holds_nothing_and_one_without_weight_anything() {
    let weak = support::EXCAVATOR_LOOPS.replace("effort: 48300.0", "effort: 3000.0");
    let model = CraneModel::from_urdf(support::EXCAVATOR_URDF, &weak).unwrap();
    let mut data = model.new_data();
    let position = [0.0, 0.2, 0.2, -1.0];
    assert_eq!(model.largest_payload(&mut data, &position).unwrap(), None);
    let weightless = model.with_gravity([0.0; 3]).unwrap();
    let (payload, _) = weightless.largest_payload(&mut data, &position).unwrap().unwrap();
    assert_eq!(payload, f64::INFINITY);
}
