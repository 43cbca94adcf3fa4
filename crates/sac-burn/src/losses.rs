//! What one gradient update reports.

/// Figures of one gradient update, all taken before the step that they led to.
///
/// With `mean` over the batch: Qᵢ the critics at the remembered actions, Q̃ᵢ at actions ã the policy draws afresh,
/// y the bootstrap target, H̄ the target entropy. `docs/sac.md` lists them with their formulas.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Losses {
    /// ½ Σᵢ mean (Qᵢ − y)².
    pub critic: f64,
    /// mean (α ln π(ã) − minᵢ Q̃ᵢ).
    pub actor: f64,
    /// −ln α · (mean ln π(ã) + H̄).
    pub temperature: f64,
    /// α that this update used.
    pub entropy_temperature: f64,
    /// mean ½(Q₁ + Q₂).
    pub mean_q: f64,
    /// mean y.
    pub mean_target: f64,
    /// −mean ln π(ã) \[nat\].
    pub entropy: f64,
    /// mean reward of the batch.
    pub mean_reward: f64,
}

impl Losses {
    /// Whether every figure is finite; if not, training has diverged and its weights are of no use.
    pub fn is_finite(&self) -> bool {
        [
            self.critic,
            self.actor,
            self.temperature,
            self.entropy_temperature,
            self.mean_q,
            self.mean_target,
            self.entropy,
            self.mean_reward,
        ]
        .iter()
        .all(|x| x.is_finite())
    }
}
