//! The gains of a machine, by joint name, as a configuration file holds them.

use crate::Gains;
use std::collections::BTreeMap;

/// Version of the form of a [`GainTable`].
pub const GAIN_TABLE_SCHEMA: u32 = 1;

/// A gain file as written down; not yet checked.
#[derive(Clone, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
#[serde(deny_unknown_fields)]
pub struct GainTableSpec<G = Gains> {
    /// Must be [`GAIN_TABLE_SCHEMA`].
    pub schema: u32,
    /// Gains by joint name.
    pub joints: BTreeMap<String, G>,
}

/// Gains by joint name, of the adaptive law unless said otherwise. Invariant: of the schema that this crate knows.
#[derive(Clone, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
#[serde(
    try_from = "GainTableSpec<G>",
    into = "GainTableSpec<G>",
    bound(deserialize = "G: serde::Deserialize<'de>", serialize = "G: Clone + serde::Serialize")
)]
pub struct GainTable<G = Gains>(GainTableSpec<G>);

impl<G: Copy> GainTable<G> {
    /// Gains of the joints named, in that order.
    ///
    /// # Errors
    /// [`GainTableError`] if a joint has no gains, or the table has some for a joint not named: a
    /// misspelt name is never passed over.
    pub fn in_order(&self, joints: &[&str]) -> Result<Vec<G>, GainTableError> {
        let known = || self.0.joints.keys().cloned().collect();
        let gains = |&joint: &&str| {
            let missing = || GainTableError::Missing { joint: joint.to_owned(), known: known() };
            self.0.joints.get(joint).copied().ok_or_else(missing)
        };
        let ordered = joints.iter().map(gains).collect::<Result<Vec<_>, _>>()?;
        match self.0.joints.keys().find(|name| !joints.contains(&name.as_str())) {
            Some(name) => Err(GainTableError::Unused { joint: name.clone() }),
            None => Ok(ordered),
        }
    }
}

impl<G> TryFrom<GainTableSpec<G>> for GainTable<G> {
    type Error = GainTableError;

    fn try_from(spec: GainTableSpec<G>) -> Result<Self, GainTableError> {
        match spec.schema {
            GAIN_TABLE_SCHEMA => Ok(Self(spec)),
            found => Err(GainTableError::Schema { found, expected: GAIN_TABLE_SCHEMA }),
        }
    }
}

impl<G> From<GainTable<G>> for GainTableSpec<G> {
    fn from(table: GainTable<G>) -> Self {
        table.0
    }
}

/// A gain file does not fit its machine.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GainTableError {
    /// Written for another version of this crate.
    #[error("schema of the gains is {found}, must be {expected}")]
    Schema {
        /// The file's.
        found: u32,
        /// [`GAIN_TABLE_SCHEMA`].
        expected: u32,
    },
    /// A joint has no gains.
    #[error("no gains for joint {joint}; there are some for {}", known.join(", "))]
    Missing {
        /// Which joint.
        joint: String,
        /// Those that have.
        known: Vec<String>,
    },
    /// Gains for a joint that the machine does not have.
    #[error("gains for joint {joint}, which the machine does not have")]
    Unused {
        /// Which joint.
        joint: String,
    },
}
