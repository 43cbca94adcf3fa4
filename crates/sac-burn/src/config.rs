//! Hyperparameters, as written down and as checked.

use serde::{Deserialize, Serialize};

/// Hyperparameters of one agent as written down; not yet checked.
///
/// Every field is needed in a file. [`Config`] is the checked form and documents the values of the paper.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConfigSpec {
    /// Transitions in one gradient update, ≥ 1.
    pub batch_size: usize,
    /// Transitions that the replay memory holds; the oldest is overwritten first.
    pub replay_capacity: usize,
    /// Discount γ per step, in [0, 1).
    pub discount: f64,
    /// Step size of Adam for actor, critics and entropy temperature, > 0.
    pub learning_rate: f64,
    /// Share of the online critics that the target critics take over at every update, in (0, 1].
    pub polyak: f64,
    /// Share of the actor that the deterministic policy takes over at every update, in (0, 1]; 1 is the actor itself.
    pub policy_share: f64,
    /// Steps of uniformly random actions before the policy acts.
    pub random_steps: u64,
    /// Transitions that the replay memory must hold before an update takes place; the batch size if smaller.
    pub update_after: usize,
    /// Gradient updates per environment step, for the caller's loop.
    pub updates_per_step: u32,
    /// Units of each hidden layer of the actor and of both critics, at most 8192; at least one layer, at most 16.
    pub hidden: Vec<usize>,
    /// Entropy temperature α at the start, > 0.
    pub initial_entropy_temperature: f64,
    /// Entropy that the temperature is steered to \[nat\]; `None` is −(action dimensions).
    pub target_entropy: Option<f64>,
    /// Least natural logarithm of the policy's standard deviation.
    pub log_std_min: f64,
    /// Largest natural logarithm of the policy's standard deviation.
    pub log_std_max: f64,
    /// Adam's decay of the first moment, in [0, 1).
    pub adam_beta_1: f64,
    /// Adam's decay of the second moment, in [0, 1).
    pub adam_beta_2: f64,
    /// Adam's ε, added to the root of the second moment, > 0.
    pub adam_epsilon: f64,
}

const MOST_UNITS: usize = 8192;
const MOST_LAYERS: usize = 16;

/// Checked hyperparameters of one agent.
///
/// Invariant: every value lies in the range that [`ConfigSpec`] states, also after rounding to single precision, and
/// the replay memory can hold a batch as well as `update_after` transitions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "ConfigSpec", into = "ConfigSpec")]
pub struct Config {
    spec: ConfigSpec,
}

/// Why hyperparameters were refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ConfigError {
    /// A number is outside its range, or not finite.
    #[error("{field} must be {range}, got {value}")]
    OutOfRange {
        /// Name of the field.
        field: &'static str,
        /// The range, in words.
        range: &'static str,
        /// What was given.
        value: f64,
    },
    /// A number is in its range, but not what the networks' arithmetic makes of it.
    #[error("{field} must be {range} in single precision, where {value:e} becomes {rounded}")]
    SinglePrecision {
        /// Name of the field.
        field: &'static str,
        /// The range, in words.
        range: &'static str,
        /// What was given.
        value: f64,
        /// The nearest number of single precision.
        rounded: f32,
    },
    /// A count is zero.
    #[error("{field} must be at least 1, got 0")]
    Zero {
        /// Name of the field.
        field: &'static str,
    },
    /// A count is beyond what memory could hold.
    #[error("{field} must be at most {most}, got {count}")]
    TooMany {
        /// Name of the field.
        field: &'static str,
        /// Largest count.
        most: usize,
        /// What was given.
        count: usize,
    },
    /// The replay memory is too small for what it is needed for.
    #[error("replay_capacity must be at least {field} = {needed}, got {capacity}")]
    ReplayTooSmall {
        /// Name of the field that needs more.
        field: &'static str,
        /// Transitions that it needs.
        needed: usize,
        /// Transitions that the memory would hold.
        capacity: usize,
    },
    /// The bounds of the standard deviation are the wrong way round.
    #[error("log_std_min must be below log_std_max, got {min} and {max}")]
    StdBounds {
        /// Given lower bound.
        min: f64,
        /// Given upper bound.
        max: f64,
    },
}

impl Config {
    /// The paper's agent: Table I, and the usual values where the paper is silent.
    ///
    /// From the table: batch 128, replay 1 000 000, discount 0.99, learning rate 1e-4, Polyak 0.001, 10 000 random
    /// steps. Ours: the policy is the actor itself; no update during the random steps, then one per step; two hidden
    /// layers of 256; initial entropy
    /// temperature 1 and target entropy −(action dimensions); ln σ in [−20, 2]; Adam's betas 0.9 and 0.999, ε 1e-8.
    ///
    /// Source: [P, Table I]; `docs/sac.md` gives the reasons.
    pub fn table_1() -> Self {
        Self {
            spec: ConfigSpec {
                batch_size: 128,
                replay_capacity: 1_000_000,
                discount: 0.99,
                learning_rate: 1e-4,
                polyak: 0.001,
                policy_share: 1.0,
                random_steps: 10_000,
                update_after: 10_000,
                updates_per_step: 1,
                hidden: vec![256, 256],
                initial_entropy_temperature: 1.0,
                target_entropy: None,
                log_std_min: -20.0,
                log_std_max: 2.0,
                adam_beta_1: 0.9,
                adam_beta_2: 0.999,
                adam_epsilon: 1e-8,
            },
        }
    }

    /// All hyperparameters, to read them or to start a variation.
    pub fn spec(&self) -> &ConfigSpec {
        &self.spec
    }

    /// Entropy that the temperature is steered to \[nat\], for a policy with `action_dim` outputs.
    pub fn target_entropy(&self, action_dim: usize) -> f64 {
        self.spec.target_entropy.unwrap_or(-(action_dim as f64))
    }

    /// Transitions that the replay memory must hold before an update takes place.
    pub fn update_threshold(&self) -> usize {
        self.spec.update_after.max(self.spec.batch_size)
    }
}

impl TryFrom<ConfigSpec> for Config {
    type Error = ConfigError;

    fn try_from(spec: ConfigSpec) -> Result<Self, ConfigError> {
        let counts = [
            ("batch_size", spec.batch_size),
            ("replay_capacity", spec.replay_capacity),
            ("updates_per_step", spec.updates_per_step as usize),
            ("hidden (number of layers)", spec.hidden.len()),
            ("hidden (units of a layer)", spec.hidden.iter().copied().min().unwrap_or(0)),
        ];
        if let Some((field, _)) = counts.into_iter().find(|(_, count)| *count == 0) {
            return Err(ConfigError::Zero { field });
        }
        let limits = [
            ("hidden (number of layers)", MOST_LAYERS, spec.hidden.len()),
            ("hidden (units of a layer)", MOST_UNITS, spec.hidden.iter().copied().max().unwrap_or(0)),
        ];
        if let Some((field, most, count)) = limits.into_iter().find(|(_, most, count)| count > most) {
            return Err(ConfigError::TooMany { field, most, count });
        }
        check("discount", "in [0, 1)", spec.discount, |x| (0.0..1.0).contains(&x))?;
        check("learning_rate", "finite and > 0", spec.learning_rate, |x| x > 0.0)?;
        for (field, share) in [("polyak", spec.polyak), ("policy_share", spec.policy_share)] {
            check(field, "in (0, 1]", share, |x| x > 0.0 && x <= 1.0)?;
        }
        let temperature = spec.initial_entropy_temperature;
        check("initial_entropy_temperature", "finite and > 0", temperature, |x| x > 0.0)?;
        check("target_entropy", "finite", spec.target_entropy.unwrap_or(0.0), |_| true)?;
        check("log_std_min", "finite", spec.log_std_min, |_| true)?;
        check("log_std_max", "finite and at most 80", spec.log_std_max, |x| x <= 80.0)?;
        check("adam_beta_1", "in [0, 1)", spec.adam_beta_1, |x| (0.0..1.0).contains(&x))?;
        check("adam_beta_2", "in [0, 1)", spec.adam_beta_2, |x| (0.0..1.0).contains(&x))?;
        check("adam_epsilon", "finite and > 0", spec.adam_epsilon, |x| x > 0.0)?;
        if spec.log_std_min >= spec.log_std_max {
            return Err(ConfigError::StdBounds { min: spec.log_std_min, max: spec.log_std_max });
        }
        for (field, needed) in [("batch_size", spec.batch_size), ("update_after", spec.update_after)] {
            if needed > spec.replay_capacity {
                return Err(ConfigError::ReplayTooSmall { field, needed, capacity: spec.replay_capacity });
            }
        }
        Ok(Self { spec })
    }
}

impl From<Config> for ConfigSpec {
    fn from(config: Config) -> Self {
        config.spec
    }
}

fn check(
    field: &'static str,
    range: &'static str,
    value: f64,
    holds: impl Fn(f64) -> bool,
) -> Result<(), ConfigError> {
    if !value.is_finite() || !holds(value) {
        return Err(ConfigError::OutOfRange { field, range, value });
    }
    let rounded = value as f32;
    if !rounded.is_finite() || !holds(f64::from(rounded)) {
        return Err(ConfigError::SinglePrecision { field, range, value, rounded });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check_refused(change: impl Fn(&mut ConfigSpec), message: &str) {
        let mut spec = Config::table_1().spec().clone();
        change(&mut spec);
        let error = Config::try_from(spec).expect_err("the specification must be refused");
        assert_eq!(error.to_string(), message);
    }

    #[test]
    fn table_1_passes_its_own_checks() {
        let config = Config::table_1();
        assert_eq!(Config::try_from(config.spec().clone()), Ok(config.clone()));
        assert_eq!(config.target_entropy(3).to_bits(), (-3.0f64).to_bits());
    }

    #[test]
    fn refuses_values_outside_their_range_and_names_them() {
        check_refused(|s| s.discount = 1.0, "discount must be in [0, 1), got 1");
        check_refused(|s| s.learning_rate = 0.0, "learning_rate must be finite and > 0, got 0");
        check_refused(|s| s.polyak = f64::NAN, "polyak must be in (0, 1], got NaN");
        check_refused(|s| s.target_entropy = Some(f64::INFINITY), "target_entropy must be finite, got inf");
        check_refused(|s| s.batch_size = 0, "batch_size must be at least 1, got 0");
        check_refused(|s| s.hidden.clear(), "hidden (number of layers) must be at least 1, got 0");
        check_refused(|s| s.hidden = vec![64, 0], "hidden (units of a layer) must be at least 1, got 0");
        check_refused(
            |s| s.replay_capacity = 100,
            "replay_capacity must be at least batch_size = 128, got 100",
        );
        check_refused(|s| s.log_std_max = -20.0, "log_std_min must be below log_std_max, got -20 and -20");
    }

    #[test]
    fn refuses_values_that_single_precision_takes_out_of_their_range() {
        check_refused(
            |s| s.adam_epsilon = 1e-60,
            "adam_epsilon must be finite and > 0 in single precision, where 1e-60 becomes 0",
        );
        check_refused(
            |s| s.learning_rate = 1e50,
            "learning_rate must be finite and > 0 in single precision, where 1e50 becomes inf",
        );
        check_refused(
            |s| s.adam_beta_2 = 1.0 - 1e-10,
            "adam_beta_2 must be in [0, 1) in single precision, where 9.999999999e-1 becomes 1",
        );
    }

    #[test]
    fn refuses_networks_beyond_all_memory() {
        check_refused(
            |s| s.hidden = vec![256, 1 << 40],
            "hidden (units of a layer) must be at most 8192, got 1099511627776",
        );
        check_refused(|s| s.hidden = vec![2; 17], "hidden (number of layers) must be at most 16, got 17");
    }

    #[test]
    fn a_file_passes_the_same_gate_and_unknown_fields_are_refused() {
        let text = ron::to_string(&Config::table_1()).unwrap();
        assert_eq!(ron::from_str::<Config>(&text).unwrap(), Config::table_1());
        let bad = text.replace("polyak:0.001", "polyak:2.0");
        assert!(ron::from_str::<Config>(&bad).unwrap_err().to_string().contains("polyak must be in (0, 1]"));
        let unknown = text.replace("polyak:0.001", "polyak:0.001,tau:0.1");
        assert!(ron::from_str::<Config>(&unknown).unwrap_err().to_string().contains("tau"));
    }
}
