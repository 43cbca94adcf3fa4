//! The plants in `assets/hiab/plants.ron`, and the friction law.
#![expect(clippy::unwrap_used, reason = "helpers of tests are tests too")]

mod support;

use hiab_dynamics::{CraneModel, PlantFile};
use support::{PLANTS, crane, max_abs, position_at, tolerance, velocity_at};

const CYLINDERS: [&str; 3] = ["lift_joint", "tilt_joint", "telescope_joint"];

fn crane_with(plant: &str) -> CraneModel {
    let plants = PlantFile::from_ron(PLANTS).unwrap();
    crane().with_plant(plants.plant(plant).unwrap()).unwrap()
}

/// Friction at one velocity of every actuator.
fn friction(model: &CraneModel, velocity: f64) -> Vec<f64> {
    let mut effort = vec![0.0; model.actuators().len()];
    model.friction_effort(&[velocity; 7], &mut effort).unwrap();
    effort
}

#[test]
fn the_file_lists_the_bare_crane_and_both_drives() {
    let plants = PlantFile::from_ron(PLANTS).unwrap();
    assert!(plants.plants.keys().eq(["electric", "hydraulic", "rigid"]));
}

#[test]
fn every_plant_has_the_armature_and_friction_of_the_design() {
    // armature, Coulomb, viscous of each cylinder; the other joints have none
    for (plant, armature, coulomb, viscous) in
        [("rigid", 0.0, 0.0, 0.0), ("electric", 1000.0, 1000.0, 3000.0), ("hydraulic", 0.0, 4000.0, 3000.0)]
    {
        let model = crane_with(plant);
        let fast = friction(&model, 1.0);
        for (k, actuator) in model.actuators().iter().enumerate() {
            let share = if CYLINDERS.contains(&actuator.name()) { 1.0 } else { 0.0 };
            let name = actuator.name();
            assert_eq!(model.armature()[k], share * armature, "{plant}, {name}: armature");
            let expected = share * (coulomb + viscous); // at 1 m/s dry friction is whole
            assert!((fast[k] - expected).abs() <= 1e-9 * expected, "{plant}, {name}: friction {}", fast[k]);
        }
    }
}

#[test]
fn friction_is_odd_and_never_falls_with_velocity() {
    let model = crane_with("hydraulic");
    let mut last = friction(&model, -1.0);
    for i in -999..=1000 {
        let velocity = f64::from(i) * 1e-3;
        let (now, mirror) = (friction(&model, velocity), friction(&model, -velocity));
        for k in 0..7 {
            assert!(now[k] >= last[k], "friction of {k} falls at {velocity}");
            assert_eq!(now[k], -mirror[k], "friction of {k} is not odd at {velocity}");
        }
        last = now;
    }
}

#[test]
fn a_plant_adds_its_armature_and_friction_to_the_bare_crane() {
    let (rigid, electric) = (crane_with("rigid"), crane_with("electric"));
    let (mut data, mut bare, mut driven) = (rigid.new_data(), [0.0; 7], [0.0; 7]);
    let (y, v) = (position_at(&rigid, &[0.6; 7]), velocity_at(&rigid, &[0.3; 7]));
    let a = [0.5; 7];
    rigid.inverse_dynamics(&mut data, &y, &v, &a, None, &mut bare).unwrap();
    electric.inverse_dynamics(&mut data, &y, &v, &a, None, &mut driven).unwrap();
    let mut friction = [0.0; 7];
    electric.friction_effort(&v, &mut friction).unwrap();
    for k in 0..7 {
        let expected = bare[k] + electric.armature()[k] * a[k] + friction[k];
        assert!((driven[k] - expected).abs() < tolerance::ROUNDING * max_abs(&driven), "effort {k}");
    }
}

#[test]
fn a_later_plant_replaces_an_earlier_one() {
    let plants = PlantFile::from_ron(PLANTS).unwrap();
    let model = crane_with("electric").with_plant(plants.plant("rigid").unwrap()).unwrap();
    assert_eq!(max_abs(model.armature()), 0.0);
    assert_eq!(max_abs(&friction(&model, 1.0)), 0.0);
}
