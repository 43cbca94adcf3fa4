//! Adam's hyperparameters, and the coefficients of its n-th step.

use crate::config::ConfigSpec;
use crate::lanes::AdamStep;

/// Adam (Kingma and Ba 2015, Alg. 1), ε outside the root as in the paper and in PyTorch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Adam {
    learning_rate: f64,
    beta_1: f64,
    beta_2: f64,
    epsilon: f64,
}

impl Adam {
    pub(crate) fn new(spec: &ConfigSpec) -> Self {
        Self {
            learning_rate: spec.learning_rate,
            beta_1: spec.adam_beta_1,
            beta_2: spec.adam_beta_2,
            epsilon: spec.adam_epsilon,
        }
    }

    /// Coefficients of step `count`, the first being 1.
    pub(crate) fn step(&self, count: u64) -> AdamStep {
        let (first, second) = self.corrections(count);
        AdamStep {
            beta_1: self.beta_1 as f32,
            beta_2: self.beta_2 as f32,
            step_size: (self.learning_rate / first) as f32,
            second_scale: (1.0 / second.sqrt()) as f32,
            epsilon: self.epsilon as f32,
        }
    }

    /// One step of a single parameter in double precision.
    pub(crate) fn step_scalar(&self, count: u64, value: &mut f64, moments: &mut [f64; 2], gradient: f64) {
        let (first, second) = self.corrections(count);
        moments[0] = self.beta_1 * moments[0] + (1.0 - self.beta_1) * gradient;
        moments[1] = self.beta_2 * moments[1] + (1.0 - self.beta_2) * gradient * gradient;
        *value -= self.learning_rate * (moments[0] / first) / ((moments[1] / second).sqrt() + self.epsilon);
    }

    /// 1 − β₁ᵗ and 1 − β₂ᵗ.
    fn corrections(&self, count: u64) -> (f64, f64) {
        (1.0 - libm::pow(self.beta_1, count as f64), 1.0 - libm::pow(self.beta_2, count as f64))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;
    use crate::lanes::{Moments, adam};

    fn optimizer() -> Adam {
        let spec = ConfigSpec {
            learning_rate: 0.1,
            adam_beta_1: 0.8,
            adam_beta_2: 0.96,
            ..Config::table_1().spec().clone()
        };
        Adam::new(&spec)
    }

    #[test]
    fn two_steps_agree_with_the_same_steps_by_hand() {
        // Step 1, g = 0.5: m = 0.1, v = 0.01, m̂ = 0.5, v̂ = 0.25; p = 1 − 0.1·0.5/0.5 = 0.9.
        // Step 2, g = −1: m = 0.08 − 0.2 = −0.12, v = 0.0096 + 0.04 = 0.0496, m̂ = −0.12/0.36 = −1/3,
        // v̂ = 0.0496/0.0784 = 0.632653; p = 0.9 + 0.1·0.333333/0.795395 = 0.941908.
        let mut parameter = [1.0f32];
        let mut moments = Moments::zero(1);
        adam(optimizer().step(1), &mut parameter, &mut moments, &[0.5]);
        assert!((parameter[0] - 0.9).abs() < 1e-6, "{parameter:?}");
        adam(optimizer().step(2), &mut parameter, &mut moments, &[-1.0]);
        assert!((parameter[0] - 0.941_908).abs() < 1e-6, "{parameter:?}");
        assert!((moments.first[0] + 0.12).abs() < 1e-7 && (moments.second[0] - 0.0496).abs() < 1e-7);
    }

    #[test]
    fn the_scalar_form_agrees_with_the_array_form() {
        let (mut array, mut moments) = ([0.3f32; 37], Moments::zero(37));
        let (mut scalar, mut scalar_moments) = (0.3f64, [0.0; 2]);
        for count in 1..50 {
            let gradient = (count as f32).sin();
            adam(optimizer().step(count), &mut array, &mut moments, &[gradient; 37]);
            optimizer().step_scalar(count, &mut scalar, &mut scalar_moments, f64::from(gradient));
            for value in array {
                let error = (f64::from(value) - scalar).abs();
                assert!(error < 1e-5, "step {count}: {value} against {scalar}");
            }
        }
    }

    #[test]
    fn the_first_step_has_the_length_of_the_learning_rate_whatever_the_gradient() {
        for gradient in [1e-3, 1.0, 1e6] {
            let mut parameter = [0.0f32];
            adam(optimizer().step(1), &mut parameter, &mut Moments::zero(1), &[gradient]);
            assert!((parameter[0] + 0.1).abs() < 1e-5, "gradient {gradient}: moved by {parameter:?}");
        }
    }

    #[test]
    fn moments_of_a_parameter_without_gradient_fade_to_exactly_zero_and_never_become_subnormal() {
        let (mut parameters, mut moments) = ([0.3f32; 20], Moments::zero(20));
        adam(optimizer().step(1), &mut parameters, &mut moments, &[0.5; 20]);
        for count in 2..4000 {
            adam(optimizer().step(count), &mut parameters, &mut moments, &[0.0; 20]);
            for moment in moments.first.iter().chain(&moments.second) {
                assert!(!moment.is_subnormal(), "step {count}: {moment:e}");
            }
        }
        assert_eq!(moments, Moments::zero(20));
    }
}
