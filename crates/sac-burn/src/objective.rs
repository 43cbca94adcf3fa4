//! The objective: targets, losses and their slopes with respect to the networks' outputs.
//!
//! Everything here is arithmetic on a few hundred host numbers; the networks turn the slopes into gradients.

use crate::replay::Batch;

/// y = r + γ·(1 − terminal)·(min(Q′₁, Q′₂) − α ln π′).
///
/// `next_q` is [2, batch], of the target critics at the next observation and an action π′ drew there. A terminal
/// step takes nothing from the next observation, not even a NaN. Haarnoja et al. 2018, Eqs. (3) and (5), with the
/// smaller of two critics.
pub(crate) fn targets(
    batch: &Batch,
    next_q: &[f32],
    next_log_probabilities: &[f32],
    discount: f32,
    entropy_temperature: f32,
) -> Vec<f32> {
    let (first, second) = next_q.split_at(next_q.len() / 2);
    let rewards = batch.rewards.iter().zip(&batch.continuations);
    rewards
        .zip(first.iter().zip(second))
        .zip(next_log_probabilities)
        .map(|(((reward, &continuation), (q1, q2)), log_probability)| {
            if continuation == 0.0 {
                *reward
            } else {
                reward + discount * (q1.min(*q2) - entropy_temperature * log_probability)
            }
        })
        .collect()
}

/// ½ Σᵢ mean (Qᵢ − y)² and its slope (Qᵢ − y)/batch, for `q` [2, batch] and y [batch].
pub(crate) fn critic_loss(q: &[f32], targets: &[f32]) -> (f64, Vec<f32>) {
    let scale = 1.0 / targets.len() as f32;
    let mut loss = 0.0;
    let mut slope = Vec::with_capacity(q.len());
    for q in q.chunks_exact(targets.len()) {
        for (q, y) in q.iter().zip(targets) {
            let error = q - y;
            loss += 0.5 * f64::from(error) * f64::from(error);
            slope.push(scale * error);
        }
    }
    (loss / targets.len() as f64, slope)
}

/// Selects the smaller of the two critics: its values [batch], and the mask [2, batch] that picks it; a tie goes to
/// the first.
pub(crate) fn smaller(q: &[f32]) -> (Vec<f32>, Vec<f32>) {
    let (first, second) = q.split_at(q.len() / 2);
    let values = first.iter().zip(second).map(|(a, b)| a.min(*b)).collect();
    let from_first = first.iter().zip(second).map(|(a, b)| if a <= b { 1.0 } else { 0.0 });
    let from_second = first.iter().zip(second).map(|(a, b)| if a <= b { 0.0 } else { 1.0 });
    (values, from_first.chain(from_second).collect())
}

/// Mean in double precision; the slice must not be empty.
pub(crate) fn mean(values: &[f32]) -> f64 {
    values.iter().map(|&x| f64::from(x)).sum::<f64>() / values.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn batch(continuations: [f32; 3]) -> Batch {
        Batch { rewards: vec![1.0, -2.0, 0.5], continuations: continuations.to_vec(), ..Batch::default() }
    }

    #[test]
    fn target_is_reward_plus_discounted_soft_value_of_the_worse_critic() {
        let y = targets(&batch([1.0; 3]), &[4.0, 1.0, -1.0, 3.0, 2.0, -5.0], &[0.5, -1.0, 2.0], 0.9, 0.2);
        let expected = [1.0 + 0.9 * (3.0 - 0.1), -2.0 + 0.9 * (1.0 + 0.2), 0.5 + 0.9 * (-5.0 - 0.4)];
        for (y, expected) in y.iter().zip(expected) {
            assert!((y - expected).abs() < 1e-6, "{y} against {expected}");
        }
    }

    #[test]
    fn a_terminal_step_takes_its_reward_alone() {
        let y = targets(&batch([1.0, 0.0, 1.0]), &[4.0, f32::NAN, 1.0, 4.0, 9.0, 1.0], &[0.0; 3], 0.9, 0.2);
        assert_eq!(y[1], -2.0);
        assert!((y[0] - 4.6).abs() < 1e-6);
    }

    #[test]
    fn critic_slope_is_the_derivative_of_the_critic_loss() {
        let (q, y) = ([0.5f32, -1.0, 2.0, 3.0], [1.0f32, 0.25]);
        let (loss, slope) = critic_loss(&q, &y);
        assert!((loss - 0.5 * (0.25 + 1.5625 + 1.0 + 7.5625) / 2.0).abs() < 1e-6);
        for i in 0..q.len() {
            let (mut up, mut down) = (q, q);
            up[i] += 0.125;
            down[i] -= 0.125;
            let expected = (critic_loss(&up, &y).0 - critic_loss(&down, &y).0) / 0.25;
            assert!((f64::from(slope[i]) - expected).abs() < 1e-6);
        }
    }

    #[test]
    fn the_mask_picks_exactly_one_critic_per_row() {
        let (values, mask) = smaller(&[1.0, 5.0, 2.0, 3.0, 4.0, 2.0]);
        assert_eq!(values, [1.0, 4.0, 2.0]);
        assert_eq!(mask, [1.0, 0.0, 1.0, 0.0, 1.0, 0.0]);
    }
}
