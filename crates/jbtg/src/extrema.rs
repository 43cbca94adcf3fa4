//! Exact extrema of quintic segments.

use crate::Interval;
use crate::roots::{self, Roots};
use crate::segment::{Segment, State};

/// Least and greatest value of each quantity over a trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Extrema {
    /// Position [rad or m].
    pub position: Interval,
    /// Velocity [rad/s or m/s].
    pub velocity: Interval,
    /// Acceleration [rad/s² or m/s²].
    pub acceleration: Interval,
    /// Jerk [rad/s³ or m/s³].
    pub jerk: Interval,
}

impl Extrema {
    /// The extrema of a single state.
    #[must_use]
    pub const fn at(state: State) -> Self {
        Self {
            position: Interval::new(state.position, state.position),
            velocity: Interval::new(state.velocity, state.velocity),
            acceleration: Interval::new(state.acceleration, state.acceleration),
            jerk: Interval::new(state.jerk, state.jerk),
        }
    }

    /// The extrema of both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            position: self.position.union(other.position),
            velocity: self.velocity.union(other.velocity),
            acceleration: self.acceleration.union(other.acceleration),
            jerk: self.jerk.union(other.jerk),
        }
    }

    fn widen(&mut self, state: State) {
        widen(&mut self.position, state.position);
        widen(&mut self.velocity, state.velocity);
        widen(&mut self.acceleration, state.acceleration);
        widen(&mut self.jerk, state.jerk);
    }
}

/// `Interval::including` for an interval that holds no NaN: one instruction per end.
#[inline]
fn widen(interval: &mut Interval, value: f64) {
    interval.min = if value < interval.min { value } else { interval.min };
    interval.max = if value > interval.max { value } else { interval.max };
}

/// Widens `extrema` by everything that happens within `segment`, its ends included.
///
/// Judges the coefficients alone and assumes no ramp behind them. From jerk down to velocity, the roots of one
/// polynomial part the segment into pieces on which the next is monotone. Where the Bernstein coefficients of a
/// polynomial have one sign it has no roots, so that most segments need none computed.
#[inline]
pub(crate) fn include_segment(extrema: &mut Extrema, segment: &Segment) {
    let [b0, b1, b2, b3, b4, b5] = segment.coefficients;
    let duration = segment.duration;
    let end = segment.state_at(duration);
    extrema.widen(State { position: b0, velocity: b1, acceleration: 2.0 * b2, jerk: 6.0 * b3 });
    extrema.widen(end);
    let at = |u: f64| segment.state_at(u * duration);

    // The derivatives in u = t/T, each with coefficients in its primitive's unit over T.
    let (d2, d3) = (duration * duration, duration * duration * duration);
    let (b2, b3, b4, b5) = (b2 * duration, b3 * d2, b4 * d3, b5 * d3 * duration);
    let mut turns = Roots::NONE; // of the velocity
    if b3 != 0.0 || b4 != 0.0 || b5 != 0.0 {
        let vertex = -b4 / (5.0 * b5);
        if vertex > 0.0 && vertex < 1.0 {
            widen(&mut extrema.jerk, at(vertex).jerk);
        }
        let jerk = Roots::of_quadratic([6.0 * b3, 24.0 * b4, 60.0 * b5]);
        for u in jerk.iter() {
            widen(&mut extrema.acceleration, at(u).acceleration);
        }
        let acceleration = [2.0 * b2, 6.0 * b3, 12.0 * b4, 20.0 * b5];
        if !roots::has_one_sign(acceleration) {
            turns = Roots::of_cubic(&jerk, acceleration);
            for u in turns.iter() {
                widen(&mut extrema.velocity, at(u).velocity);
            }
        }
    } else if (b2 > 0.0 && b1 < 0.0 && end.velocity > 0.0) || (b2 < 0.0 && b1 > 0.0 && end.velocity < 0.0) {
        widen(&mut extrema.position, at(-b1 / (2.0 * b2)).position);
        return;
    } else {
        return; // constant acceleration without a turn
    }
    let velocity = [b1, 2.0 * b2, 3.0 * b3, 4.0 * b4, 5.0 * b5];
    let one_way = if turns.is_empty() {
        !(b1 < 0.0 && end.velocity > 0.0 || b1 > 0.0 && end.velocity < 0.0)
    } else {
        roots::has_one_sign(velocity)
    };
    if !one_way {
        for u in Roots::between(&turns, velocity).iter() {
            widen(&mut extrema.position, at(u).position);
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Any quintic on [0, T]: terms of any size relative to each other, or none, as no planner would make them.
    fn segments() -> impl Strategy<Value = Segment> {
        let term = prop_oneof![
            1 => Just(0.0),
            4 => -1.0..1.0,
            2 => (-9.0..0.0_f64, any::<bool>())
                .prop_map(|(exponent, flip)| if flip { -10_f64.powf(exponent) } else { 10_f64.powf(exponent) }),
        ];
        (prop::array::uniform6(term), 1e-3..1e3).prop_map(|(terms, duration): ([f64; 6], f64)| {
            let coefficients = std::array::from_fn(|k| terms[k] / duration.powi(k as i32));
            Segment { start: 0.0, duration, coefficients }
        })
    }

    fn quantities(extrema: &Extrema, duration: f64) -> [Interval; 4] {
        let scaled = |interval: Interval, power| {
            let scale = duration.powi(power);
            Interval::new(interval.min * scale, interval.max * scale)
        };
        [
            extrema.position,
            scaled(extrema.velocity, 1),
            scaled(extrema.acceleration, 2),
            scaled(extrema.jerk, 3),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn samples_of_any_quintic_reach_its_extrema_and_no_further(segment in segments()) {
            const SAMPLES: u32 = 256;
            let duration = segment.duration;
            let mut exact = Extrema::at(segment.state_at(0.0));
            include_segment(&mut exact, &segment);
            let mut sampled = Extrema::at(segment.state_at(0.0));
            for i in 1..=SAMPLES {
                sampled.widen(segment.state_at(duration * f64::from(i) / f64::from(SAMPLES)));
            }
            // In u = t/T every term is at most 1, so that derivatives are at most (5!/1!)·6 and rounding is absolute.
            let size = (0..6).map(|k| segment.coefficients[k].abs() * duration.powi(k as i32)).fold(0.0, f64::max);
            let gap = 720.0 * size / f64::from(SAMPLES * SAMPLES) / 8.0;
            let rounding = 120.0 * 32.0 * f64::EPSILON * size;
            for (exact, sampled) in quantities(&exact, duration).into_iter().zip(quantities(&sampled, duration)) {
                prop_assert!(exact.min <= sampled.min + rounding && exact.max >= sampled.max - rounding,
                    "{exact:?} misses {sampled:?}");
                prop_assert!(exact.min >= sampled.min - gap - rounding && exact.max <= sampled.max + gap + rounding,
                    "{exact:?} is wider than {sampled:?}");
            }
        }
    }
}
