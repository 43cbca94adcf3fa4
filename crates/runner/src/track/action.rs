//! Actions for wanted velocities.

use safezone::SafeRange;

/// The action in [-1, 1] that [P, Eq. (mapping)] maps to `velocity`, or to the nearest safe one.
#[must_use]
pub fn action_for(range: &SafeRange, velocity: f64) -> f64 {
    let width = range.max - range.min;
    if width <= 0.0 { 0.0 } else { (2.0 * (velocity - range.min) / width - 1.0).clamp(-1.0, 1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use safezone::RangeStatus;

    #[test]
    fn the_action_maps_back_to_its_velocity() {
        let range =
            SafeRange { min: -0.02, max: 0.05, brake: 0.0, narrowed: false, status: RangeStatus::Safe };
        for velocity in [-0.02, 0.0, 0.013, 0.05] {
            assert!((range.map_action(action_for(&range, velocity)) - velocity).abs() < 1e-15);
        }
        assert_eq!(range.map_action(action_for(&range, 1.0)), 0.05);
    }
}
