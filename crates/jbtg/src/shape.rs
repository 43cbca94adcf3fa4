//! The shape of an acceleration ramp and the timing of a step.

/// How the acceleration rises from 0 to A within a ramp of duration T; it falls by the mirror image.
///
/// Every shape is a quintic in position, so a step is a chain of quintics, [P, Eq. (polynomial)]. With u = t/T
/// the position gained from rest is A·T²·(10e·u³ + (1/4 − 15e)·u⁴ + (−1/10 + 6e)·u⁵); the shapes differ in
/// the one number e, the displacement of the whole ramp less 0.15·A·T².
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Shape {
    /// Acceleration A·(3u² − 2u³), e = 0. Jerk is 0 at both ends and at most 1.5·A/T, acceleration stays in
    /// [0, A] and velocity is monotone. The least ramp time for a jerk J is 1.5·A/J.
    #[default]
    Smoothstep,
    /// The paper's ramp: the quintic through the end conditions of the sine-shaped ramp of [P, Eq. (dtmax)] and
    /// [P, Alg. 1], displacement (1/4 − 1/π²)·A·T². The ramp time for a jerk J is (π/2)·A/J.
    ///
    /// Differs from what the paper states: a quintic with five end conditions is not the sine ramp. Its jerk is
    /// −0.0505·J at both ends (so it jumps between segments by up to 0.1·J) and 0.98·J at most, its acceleration leaves
    /// [0, A] by 0.0489 % of A, and its velocity leaves the interval between its ends by 1.28e-5·A²/J. The
    /// planner keeps every limit all the same: it plans with an acceleration and velocity bounds that much
    /// tighter.
    SineQuintic,
}

/// How a step spends its period.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Timing {
    /// Ramps of fixed duration; the velocity change is spread over the whole period, so that the peak
    /// acceleration is proportional to it: v(t) = v₁ + Δv·σ(t) with one σ per direction.
    #[default]
    Stretched,
    /// The paper's timing, [P, Alg. 1] and [P, Alg. 2]: ramp at the limits, then cruise at v₂ for what is left
    /// of the period.
    Fastest,
}

/// The numbers of a shape that planning needs, all for a ramp with A = T = 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShapeConstants {
    /// Position gained from rest at u: c₃u³ + c₄u⁴ + c₅u⁵.
    pub(crate) position: [f64; 3],
    /// Position gained over the whole ramp, 0.15 + e.
    pub(crate) displacement: f64,
    /// Ramp time per A/J.
    pub(crate) ramp_time: f64,
    /// Jerk against the direction of the ramp, at each end.
    pub(crate) reverse_jerk: f64,
    /// Acceleration beyond [0, A], on either side.
    pub(crate) reverse_acceleration: f64,
    /// Velocity beyond the interval between its ends, on either side.
    pub(crate) reverse_velocity: f64,
    /// Largest distance moved against the direction of the velocity change.
    pub(crate) reverse_travel: f64,
}

impl Shape {
    /// Coefficients [c₃, c₄, c₅] of the position c₃u³ + c₄u⁴ + c₅u⁵ gained from rest within a ramp with A = T = 1,
    /// u in [0, 1].
    ///
    /// # Examples
    /// ```
    /// assert_eq!(jbtg::Shape::Smoothstep.coefficients(), [0.0, 0.25, -0.1]);
    /// ```
    #[must_use]
    pub const fn coefficients(self) -> [f64; 3] {
        self.constants().position
    }

    pub(crate) const fn constants(self) -> ShapeConstants {
        match self {
            Self::Smoothstep => ShapeConstants {
                position: [0.0, 0.25, -0.1],
                displacement: 0.15,
                ramp_time: 1.5,
                reverse_jerk: 0.0,
                reverse_acceleration: 0.0,
                reverse_velocity: 0.0,
                reverse_travel: 0.0,
            },
            Self::SineQuintic => ShapeConstants {
                position: [10.0 * SINE_EXCESS, 0.25 - 15.0 * SINE_EXCESS, -0.1 + 6.0 * SINE_EXCESS],
                displacement: 0.15 + SINE_EXCESS,
                ramp_time: core::f64::consts::FRAC_PI_2,
                reverse_jerk: -60.0 * SINE_EXCESS,
                // Bounds from above by less than one part in a thousand; the test below computes the exact values.
                reverse_acceleration: 4.8924e-4,
                reverse_velocity: 8.1201e-6,
                reverse_travel: 1.7117e-7,
            },
        }
    }
}

/// e of the sine ramp: (1/4 − 1/π²) − 3/20.
const SINE_EXCESS: f64 = 0.1 - 1.0 / (core::f64::consts::PI * core::f64::consts::PI);

#[cfg(test)]
mod tests {
    use super::*;

    /// Minimum over u in [0, 1/2] by golden-section search; the functions below have one there.
    fn minimum(f: impl Fn(f64) -> f64) -> f64 {
        (0..=2_000_000).map(|i| f(f64::from(i) * 5e-8)).fold(f64::INFINITY, f64::min)
    }

    #[track_caller]
    fn check_bound(name: &str, bound: f64, exact: f64) {
        assert!(
            bound >= exact && bound <= exact * 1.001 + 1e-300,
            "{name}: {bound:e} for an exact {exact:e}"
        );
    }

    #[test]
    fn the_sine_quintic_leaves_its_ramp_by_what_the_constants_say() {
        let shape = Shape::SineQuintic.constants();
        let [c3, c4, c5] = shape.position;
        check_bound("travel", shape.reverse_travel, -minimum(|u| u * u * u * (c3 + u * (c4 + u * c5))));
        check_bound(
            "velocity",
            shape.reverse_velocity,
            -minimum(|u| u * u * (3.0 * c3 + u * (4.0 * c4 + u * 5.0 * c5))),
        );
        check_bound(
            "acceleration",
            shape.reverse_acceleration,
            -minimum(|u| u * (6.0 * c3 + u * (12.0 * c4 + u * 20.0 * c5))),
        );
        assert!((shape.reverse_jerk + 6.0 * c3).abs() < 1e-15);
    }

    #[test]
    fn every_shape_ends_at_its_displacement_half_its_velocity_and_its_acceleration() {
        for shape in [Shape::Smoothstep, Shape::SineQuintic] {
            let constants = shape.constants();
            let [c3, c4, c5] = constants.position;
            assert!((c3 + c4 + c5 - constants.displacement).abs() < 1e-15);
            assert!((3.0 * c3 + 4.0 * c4 + 5.0 * c5 - 0.5).abs() < 1e-15);
            assert!((6.0 * c3 + 12.0 * c4 + 20.0 * c5 - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn no_shape_exceeds_the_jerk_that_its_ramp_time_stands_for() {
        for shape in [Shape::Smoothstep, Shape::SineQuintic] {
            let constants = shape.constants();
            let [c3, c4, c5] = constants.position;
            let jerk_at_middle = 6.0 * c3 + 12.0 * c4 + 15.0 * c5;
            assert!(jerk_at_middle / constants.ramp_time <= 1.0 + 1e-15, "{shape:?}: {jerk_at_middle}");
        }
    }
}
