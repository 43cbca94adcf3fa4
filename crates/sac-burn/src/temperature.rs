//! The learned entropy temperature α.

use crate::adam::Adam;

/// ln α with its Adam state, in double precision.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Temperature {
    pub(crate) log: f64,
    /// First and second moment.
    pub(crate) moments: [f64; 2],
    /// Adam steps taken.
    pub(crate) steps: u64,
}

impl Temperature {
    pub(crate) fn new(initial: f64) -> Self {
        Self { log: libm::log(initial), moments: [0.0; 2], steps: 0 }
    }

    /// α.
    pub(crate) fn value(&self) -> f64 {
        libm::exp(self.log)
    }

    /// One Adam step on J = −ln α·(mean ln π + target entropy); returns J before the step.
    ///
    /// The gradient with respect to ln α is closed: −(mean ln π + target entropy). Haarnoja et al. 2018, Eq. (18),
    /// has α in place of ln α; with ln α the pull does not fade as α becomes small.
    pub(crate) fn step(&mut self, adam: &Adam, mean_log_probability: f64, target_entropy: f64) -> f64 {
        let gradient = -(mean_log_probability + target_entropy);
        let loss = self.log * gradient;
        self.steps += 1;
        adam.step_scalar(self.steps, &mut self.log, &mut self.moments, gradient);
        loss
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;

    #[test]
    fn rises_while_the_policy_is_surer_than_wanted_and_falls_while_it_is_not() {
        let adam = Adam::new(Config::table_1().spec());
        let mut temperature = Temperature::new(0.5);
        temperature.step(&adam, 4.0, -3.0); // entropy −4 below the target −3
        assert!(temperature.value() > 0.5);
        let mut temperature = Temperature::new(0.5);
        temperature.step(&adam, -1.0, -3.0); // entropy 1 above the target
        assert!(temperature.value() < 0.5);
    }

    #[test]
    fn gradient_is_the_derivative_of_the_loss() {
        let adam = Adam::new(Config::table_1().spec());
        let loss = |log: f64| Temperature { log, moments: [0.0; 2], steps: 0 }.step(&adam, 1.7, -3.0);
        let mut temperature = Temperature::new(0.2);
        let h = 1e-4;
        let expected = (loss(temperature.log + h) - loss(temperature.log - h)) / (2.0 * h);
        temperature.step(&adam, 1.7, -3.0);
        let gradient = temperature.moments[0] / (1.0 - 0.9); // first moment of the first step is (1 − β₁)g
        assert!((gradient - expected).abs() < 1e-9, "{gradient} against {expected}");
    }
}
