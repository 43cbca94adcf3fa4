//! `--flag value` arguments of one command.

use std::collections::BTreeMap;
use std::str::FromStr;

use anyhow::{Result, anyhow, bail, ensure};

/// The flags that were given; each is taken out once, and what is left over is an error.
#[derive(Debug)]
pub struct Arguments {
    values: BTreeMap<String, Vec<Option<String>>>,
}

impl Arguments {
    /// Splits `--flag value`, `--flag=value` and `--switch`, where `switches` names those without a value.
    ///
    /// # Errors
    /// A word that is no flag, or a flag without its value.
    pub fn parse(words: impl IntoIterator<Item = String>, switches: &[&str]) -> Result<Self> {
        let mut values = BTreeMap::new();
        let mut words = words.into_iter();
        while let Some(word) = words.next() {
            let Some(flag) = word.strip_prefix("--") else { bail!("'{word}' is no flag") };
            let (name, value) = if let Some((name, value)) = flag.split_once('=') {
                (name, Some(value.to_owned()))
            } else if switches.contains(&flag) {
                (flag, None)
            } else {
                let value = words.next().ok_or_else(|| anyhow!("--{flag} needs a value"))?;
                (flag, Some(value))
            };
            values.entry(name.to_owned()).or_insert_with(Vec::new).push(value);
        }
        Ok(Self { values })
    }

    /// Value of a flag, if it was given.
    ///
    /// # Errors
    /// The flag is given twice, or its value does not parse.
    pub fn optional<T: FromStr<Err: std::fmt::Display>>(&mut self, name: &str) -> Result<Option<T>> {
        let mut values = self.all(name)?;
        ensure!(values.len() < 2, "--{name} is given twice");
        Ok(values.pop())
    }

    /// Values of a flag that may be given several times, in that order.
    ///
    /// # Errors
    /// A value does not parse.
    pub fn all<T: FromStr<Err: std::fmt::Display>>(&mut self, name: &str) -> Result<Vec<T>> {
        let given = self.values.remove(name).unwrap_or_default().into_iter();
        given
            .map(|value| {
                let value = value.ok_or_else(|| anyhow!("--{name} needs a value"))?;
                value.parse().map_err(|error| anyhow!("--{name} {value}: {error}"))
            })
            .collect()
    }

    /// Value of a flag that must be given.
    ///
    /// # Errors
    /// The flag is missing, or [`Arguments::optional`] refuses it.
    pub fn required<T: FromStr<Err: std::fmt::Display>>(&mut self, name: &str) -> Result<T> {
        self.optional(name)?.ok_or_else(|| anyhow!("--{name} is missing"))
    }

    /// True if a switch was given.
    ///
    /// # Errors
    /// The switch was given a value, or twice.
    pub fn switch(&mut self, name: &str) -> Result<bool> {
        match self.values.remove(name).as_deref() {
            None => Ok(false),
            Some([None]) => Ok(true),
            Some([Some(value)]) => bail!("--{name} takes no value, got '{value}'"),
            Some(_) => bail!("--{name} is given twice"),
        }
    }

    /// Refuses flags that no one took.
    ///
    /// # Errors
    /// A flag is left over.
    pub fn finish(self) -> Result<()> {
        match self.values.keys().next() {
            None => Ok(()),
            Some(name) => bail!("no flag is called --{name} here"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(line: &str) -> Result<Arguments> {
        Arguments::parse(line.split_whitespace().map(str::to_owned), &["check"])
    }

    #[test]
    fn values_may_be_negative_and_written_either_way() {
        let mut arguments = parse("--v1 -0.1 --v2=-1e-3 --check").unwrap();
        assert_eq!(arguments.required::<f64>("v1").unwrap(), -0.1);
        assert_eq!(arguments.required::<f64>("v2").unwrap(), -1e-3);
        assert!(arguments.switch("check").unwrap());
        arguments.finish().unwrap();
    }

    #[test]
    fn a_flag_may_have_several_values_where_they_are_asked_for() {
        let mut arguments = parse("--run a --v1 1 --run=b").unwrap();
        assert_eq!(arguments.all::<String>("run").unwrap(), ["a", "b"]);
        assert_eq!(arguments.all::<String>("config").unwrap(), [""; 0]);
        assert!(parse("--check --check").unwrap().switch("check").is_err());
    }

    #[test]
    fn every_mistake_is_named() {
        let message = |line: &str| {
            let parsed = parse(line).and_then(|mut arguments| {
                arguments.required::<f64>("v1")?;
                arguments.finish()
            });
            format!("{:#}", parsed.unwrap_err())
        };
        assert_eq!(message("v1 2"), "'v1' is no flag");
        assert_eq!(message("--v1"), "--v1 needs a value");
        assert_eq!(message("--v2 1"), "--v1 is missing");
        assert_eq!(message("--v1 x"), "--v1 x: invalid float literal");
        assert_eq!(message("--v1 1 --v1 2"), "--v1 is given twice");
        assert_eq!(message("--v1 1 --w 2"), "no flag is called --w here");
    }
}
