//! The stages of the curriculum.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// A stage of the curriculum [P, § IV, Fig. workspace]; each region contains the one before.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Stage {
    /// The easiest: short ways.
    Purple,
    /// Longer ways.
    Yellow,
    /// The target area of the final operation.
    Orange,
}

impl Stage {
    /// All stages in the order in which they are trained.
    pub const ALL: [Self; 3] = [Self::Purple, Self::Yellow, Self::Orange];

    /// The name as in commands and folders.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Purple => "purple",
            Self::Yellow => "yellow",
            Self::Orange => "orange",
        }
    }

    /// The stage whose best checkpoint this one starts from.
    #[must_use]
    pub fn before(self) -> Option<Self> {
        match self {
            Self::Purple => None,
            Self::Yellow => Some(Self::Purple),
            Self::Orange => Some(Self::Yellow),
        }
    }
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A name that is no stage.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no stage is called '{0}'; the stages are purple, yellow and orange")]
pub struct UnknownStage(String);

impl FromStr for Stage {
    type Err = UnknownStage;

    fn from_str(name: &str) -> Result<Self, UnknownStage> {
        Self::ALL.into_iter().find(|stage| stage.name() == name).ok_or_else(|| UnknownStage(name.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_stage_is_answered_with_the_known_ones() {
        let message = "purpel".parse::<Stage>().unwrap_err().to_string();
        assert!(message.contains("'purpel'") && message.contains("purple, yellow and orange"), "{message}");
    }

    #[test]
    fn names_and_order_agree() {
        for stage in Stage::ALL {
            assert_eq!(stage.name().parse(), Ok(stage));
        }
        assert_eq!(Stage::Orange.before().and_then(Stage::before), Some(Stage::Purple));
    }
}
