//! The safe velocity range of one joint.

use anyhow::{Result, anyhow, ensure};
use hiab_dynamics::Actuator;
use safezone::RangeStatus;
use serde::Serialize;

use crate::config::ConfigSpec;
use crate::machine;

/// How a range is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ZoneFormat {
    /// A line for a reader.
    Text,
    /// `{"min": …, "max": …}`.
    Json,
}

#[derive(Serialize)]
struct Range {
    min: f64,
    max: f64,
}

/// The velocities [rad/s or m/s] that the joint may have one policy period after `position` and `velocity`.
///
/// # Errors
/// The joint is not known, a number is not finite, or the joint's braking table is missing or stale.
pub fn zone(
    config: &ConfigSpec,
    joint: &str,
    position: f64,
    velocity: f64,
    format: ZoneFormat,
) -> Result<String> {
    let number = |name: &str, value: f64| {
        ensure!(value.is_finite(), "--{name} must be finite, got {value}");
        Ok(())
    };
    number("position", position)?;
    number("velocity", velocity)?;
    let model = machine::load_model(config)?;
    let index = model.actuator_index(joint).ok_or_else(|| {
        let known = model.actuators().iter().map(Actuator::name).collect::<Vec<_>>().join(", ");
        anyhow!("no joint is called '{joint}'; there are {known}")
    })?;
    let zone = machine::load_zone(config, &model.actuators()[index])?;
    let range = zone.range(position, velocity);
    match range.status {
        RangeStatus::Safe => {}
        RangeStatus::PositionOutside => {
            tracing::warn!(joint, position, "outside its position limits: the way back")
        }
        RangeStatus::VelocityOutside => {
            tracing::warn!(joint, velocity, "beyond its velocity limit: the way back")
        }
        RangeStatus::CannotStop => {
            tracing::warn!(joint, position, velocity, "too fast to stop inside its limits")
        }
        RangeStatus::Unknown => unreachable!("position and velocity are finite"),
    }
    let (min, max) = (range.min, range.max);
    Ok(match format {
        ZoneFormat::Json => serde_json::to_string(&Range { min, max })? + "\n",
        ZoneFormat::Text => format!("{joint}: safe velocity from {min} to {max}\n"),
    })
}
