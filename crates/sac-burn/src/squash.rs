//! The squashed Gaussian: a = tanh(u), u = μ + σε, ε standard normal.
//!
//! A head row is μ then ln σ, one of each per action dimension. ln σ is clamped, and outside its bounds the loss has
//! no gradient with respect to it. Natural logarithms throughout.

use std::f32::consts::{LN_2, PI};

/// Bounds of ln σ.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StdBounds {
    pub(crate) min: f32,
    pub(crate) max: f32,
}

/// Actions drawn for a batch.
#[derive(Clone, Debug)]
pub(crate) struct Sampled {
    /// [batch, action], each in [−1, 1].
    pub(crate) actions: Vec<f32>,
    /// [batch].
    pub(crate) log_probabilities: Vec<f32>,
}

/// ln(1 − tanh²u) = 2(ln 2 − u − softplus(−2u)).
///
/// Softplus form, because 1 − tanh²(u) is 0 in f32 beyond |u| ≈ 9. Haarnoja et al. 2018, App. C, in the form of
/// TensorFlow Probability's `Tanh` bijector.
pub(crate) fn log_tanh_slope(u: f32) -> f32 {
    2.0 * (LN_2 - u - softplus(-2.0 * u))
}

/// ln(1 + eˣ) without overflow.
fn softplus(x: f32) -> f32 {
    x.max(0.0) + libm::log1pf(libm::expf(-x.abs()))
}

/// Draws one action per row.
///
/// Shapes: head [batch, 2·action], noise [batch, action].
/// ln π(a) = Σ [−ε²/2 − ln σ − ½ ln 2π − ln(1 − tanh²u)].
pub(crate) fn sample(head: &[f32], noise: &[f32], action_dim: usize, bounds: StdBounds) -> Sampled {
    let half_log_two_pi = 0.5 * libm::logf(2.0 * PI);
    let mut actions = Vec::with_capacity(noise.len());
    let mut log_probabilities = Vec::with_capacity(noise.len() / action_dim);
    for (head, noise) in head.chunks_exact(2 * action_dim).zip(noise.chunks_exact(action_dim)) {
        let (mean, log_std) = head.split_at(action_dim);
        let mut log_probability = 0.0;
        for ((mean, log_std), epsilon) in mean.iter().zip(log_std).zip(noise) {
            let log_std = log_std.clamp(bounds.min, bounds.max);
            let u = mean + libm::expf(log_std) * epsilon;
            actions.push(libm::tanhf(u));
            log_probability -= 0.5 * epsilon * epsilon + log_std + half_log_two_pi + log_tanh_slope(u);
        }
        log_probabilities.push(log_probability);
    }
    Sampled { actions, log_probabilities }
}

/// ∂loss/∂head for loss = mean over the batch of α·ln π(a) − Q(a), with ε held fixed.
///
/// Shapes: head [batch, 2·action]; noise, actions and `value_slope` = ∂Q/∂a [batch, action] → [batch, 2·action].
/// ∂ln π/∂u = 2 tanh u, ∂a/∂u = 1 − a², ∂u/∂μ = 1, ∂u/∂ln σ = σε, and ln π has −ln σ on its own.
pub(crate) fn head_gradient(
    head: &[f32],
    noise: &[f32],
    actions: &[f32],
    value_slope: &[f32],
    entropy_temperature: f32,
    action_dim: usize,
    bounds: StdBounds,
) -> Vec<f32> {
    let scale = action_dim as f32 / noise.len() as f32;
    let mut gradient = vec![0.0; head.len()];
    for (row, head) in head.chunks_exact(2 * action_dim).enumerate() {
        for j in 0..action_dim {
            let at = row * action_dim + j;
            let a = actions[at];
            let by_u = scale * (entropy_temperature * 2.0 * a - (1.0 - a * a) * value_slope[at]);
            gradient[row * 2 * action_dim + j] = by_u;
            let log_std = head[action_dim + j];
            if (bounds.min..=bounds.max).contains(&log_std) {
                gradient[row * 2 * action_dim + action_dim + j] =
                    by_u * libm::expf(log_std) * noise[at] - scale * entropy_temperature;
            }
        }
    }
    gradient
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOUNDS: StdBounds = StdBounds { min: -20.0, max: 2.0 };

    #[test]
    fn tanh_correction_agrees_with_the_closed_form_in_double_precision() {
        for i in -600..=600 {
            let u = f64::from(i) / 20.0;
            let cosh = u.cosh();
            let expected = -2.0 * cosh.ln();
            let found = f64::from(log_tanh_slope(u as f32));
            let allowed = 4e-7 * (1.0 + expected.abs());
            assert!((found - expected).abs() < allowed, "u = {u}: {found} against {expected}");
        }
    }

    #[test]
    fn tanh_correction_stays_finite_where_the_plain_form_does_not() {
        assert_eq!(1.0 - 10.0f32.tanh().powi(2), 0.0);
        for u in [-80.0, -10.0, 10.0, 80.0] {
            let expected = 2.0 * (LN_2 - f32::abs(u));
            assert!((log_tanh_slope(u) - expected).abs() < 1e-5 * expected.abs(), "u = {u}");
        }
    }

    #[test]
    fn density_of_the_actions_integrates_to_one() {
        // Over a ∈ (−1, 1) for one dimension: the midpoint rule in u, da = (1 − tanh²u) du.
        for (mean, log_std) in [(0.0, -1.0), (0.7, 0.0), (-1.5, 0.5)] {
            let step = 1e-3;
            let mut integral = 0.0;
            for i in -12_000..12_000 {
                let u = (f64::from(i) + 0.5) * step;
                let epsilon = (u - f64::from(mean)) / f64::from(log_std).exp();
                let sampled = sample(&[mean, log_std], &[epsilon as f32], 1, BOUNDS);
                let slope = 1.0 / (u.cosh() * u.cosh());
                integral += f64::from(sampled.log_probabilities[0]).exp() * slope * step;
            }
            assert!((integral - 1.0).abs() < 1e-4, "mean {mean}, ln σ {log_std}: {integral}");
        }
    }

    #[test]
    fn log_probability_agrees_with_the_closed_form_in_double_precision() {
        // ln N(u; μ, σ) − ln(1 − tanh²u), the correction as −2 ln cosh u, also where 1 − tanh²u is 0 in f32.
        for (mean, log_std, epsilon) in [
            (0.0f32, 0.0f32, 0.0f32),
            (0.7, -1.5, 1.2),
            (-2.0, 0.5, -2.5),
            (12.0, -3.0, 0.4),
            (-9.0, 1.5, -1.0),
        ] {
            let found = f64::from(sample(&[mean, log_std], &[epsilon], 1, BOUNDS).log_probabilities[0]);
            let [mean, log_std, epsilon] = [mean, log_std, epsilon].map(f64::from);
            let u = mean + log_std.exp() * epsilon;
            let normal = -0.5 * epsilon * epsilon - log_std - 0.5 * std::f64::consts::TAU.ln();
            let expected = normal + 2.0 * u.cosh().ln();
            assert!(
                (found - expected).abs() < 2e-6 * (1.0 + expected.abs()),
                "u = {u}: {found} against {expected}"
            );
        }
    }

    #[test]
    fn probabilities_of_independent_dimensions_multiply() {
        let both = sample(&[0.3, -0.4, -1.0, 0.2], &[0.5, -0.8], 2, BOUNDS).log_probabilities[0];
        let first = sample(&[0.3, -1.0], &[0.5], 1, BOUNDS).log_probabilities[0];
        let second = sample(&[-0.4, 0.2], &[-0.8], 1, BOUNDS).log_probabilities[0];
        assert!((both - first - second).abs() < 1e-6);
    }

    #[test]
    fn log_std_is_clamped_and_has_no_gradient_outside_its_bounds() {
        let wide = sample(&[0.0, 5.0], &[0.3], 1, BOUNDS);
        let edge = sample(&[0.0, 2.0], &[0.3], 1, BOUNDS);
        assert_eq!(wide.actions, edge.actions);
        assert_eq!(wide.log_probabilities, edge.log_probabilities);
        let outside = head_gradient(&[0.0, 5.0], &[0.3], &wide.actions, &[1.0], 0.2, 1, BOUNDS);
        let inside = head_gradient(&[0.0, 1.0], &[0.3], &wide.actions, &[1.0], 0.2, 1, BOUNDS);
        assert_eq!(outside[1], 0.0);
        assert_ne!(inside[1], 0.0);
    }

    #[test]
    fn head_gradient_agrees_with_finite_differences() {
        // Q(a) = Σ cᵢ aᵢ, whose slope is c; loss in double precision from f32 parts.
        let head = [0.3f32, -0.8, -0.5, 0.4, -1.2, 0.6, 0.1, -1.0];
        let (noise, slope) = ([0.7f32, -1.1, 0.2, 1.6], [1.5f32, -0.5, 0.8, 2.0]);
        let alpha = 0.35f32;
        let loss = |head: &[f32]| {
            let s = sample(head, &noise, 2, BOUNDS);
            let value: f64 = s.actions.iter().zip(slope).map(|(a, c)| f64::from(a * c)).sum();
            let log: f64 = s.log_probabilities.iter().map(|&l| f64::from(l)).sum();
            (f64::from(alpha) * log - value) / 2.0
        };
        let actions = sample(&head, &noise, 2, BOUNDS).actions;
        let gradient = head_gradient(&head, &noise, &actions, &slope, alpha, 2, BOUNDS);
        for i in 0..head.len() {
            let (mut up, mut down) = (head, head);
            up[i] += 1e-2;
            down[i] -= 1e-2;
            let expected = (loss(&up) - loss(&down)) / f64::from(up[i] - down[i]);
            let error = (f64::from(gradient[i]) - expected).abs();
            assert!(error < 2e-4, "component {i}: {} against {expected}", gradient[i]);
        }
    }
}
