//! Reads words by the grammar in `flags`, and checks single values.

use crate::flags::{COMMANDS, Command, JOINTS};
use crate::suggest::nearest;
use std::path::PathBuf;

/// The command line cannot be understood; says what is wrong and where help is.
#[derive(Debug, PartialEq)]
pub(crate) struct UsageError(String);

impl UsageError {
    pub(crate) fn new(message: String) -> Self {
        Self(message)
    }
}

impl std::fmt::Display for UsageError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for UsageError {}

/// Words sorted by the grammar: every flag is known and given once, values are still text.
pub(crate) enum Parsed {
    /// Help was asked for, of one command or of all.
    Help(Option<&'static Command>),
    /// A command with its flags.
    Command(Values),
}

/// A command and the flags it was given.
pub(crate) struct Values {
    pub(crate) command: &'static Command,
    given: Vec<(&'static str, Option<String>)>,
}

impl Parsed {
    pub(crate) fn read(words: Vec<String>) -> Result<Self, UsageError> {
        let mut words = words.into_iter();
        let Some(name) = words.next() else { return Ok(Self::Help(None)) };
        if is_help(&name) {
            return Ok(Self::Help(None));
        }
        let command = find_command(&name)?;
        if command.name == "help" {
            let topic = words.find(|word| !is_help(word));
            return topic.map(|topic| find_command(&topic)).transpose().map(Self::Help);
        }
        let words: Vec<String> = words.collect();
        if words.iter().any(|word| is_help(word)) {
            return Ok(Self::Help(Some(command)));
        }
        let mut values = Values { command, given: Vec::new() };
        values.read_flags(words)?;
        Ok(Self::Command(values))
    }
}

impl Values {
    fn read_flags(&mut self, words: Vec<String>) -> Result<(), UsageError> {
        let mut words = words.into_iter().peekable();
        while let Some(word) = words.next() {
            let Some(text) = word.strip_prefix("--") else {
                return Err(self.error(&format!("unexpected argument `{word}`")));
            };
            let (name, inline) = match text.split_once('=') {
                Some((name, value)) => (name, Some(value.to_owned())),
                None => (text, None),
            };
            let Some(flag) = self.command.flags.iter().find(|flag| flag.name == name) else {
                return Err(self.error(&self.unknown_flag(name)));
            };
            if !flag.repeated && self.given.iter().any(|(given, _)| *given == flag.name) {
                return Err(self.error(&format!("flag `--{name}` is given twice")));
            }
            let value = match (flag.value, inline) {
                (None, None) => None,
                (None, Some(_)) => return Err(self.error(&format!("flag `--{name}` takes no value"))),
                (Some(_), Some(value)) => Some(value),
                // `-0.1` is a value; the next flag is not.
                (Some(kind), None) => match words.next_if(|next| !next.starts_with("--")) {
                    Some(value) => Some(value),
                    None => {
                        return Err(self.error(&format!("flag `--{name}` needs a value: --{name} {kind}")));
                    }
                },
            };
            self.given.push((flag.name, value));
        }
        let missing: Vec<String> = (self.command.flags.iter())
            .filter(|flag| flag.required && self.text(flag.name).is_none())
            .map(|flag| format!("--{} {}", flag.name, flag.value.unwrap_or_default()))
            .collect();
        if missing.is_empty() { Ok(()) } else { Err(self.error(&format!("needs {}", missing.join(", ")))) }
    }

    fn unknown_flag(&self, name: &str) -> String {
        let known: Vec<String> = self.command.flags.iter().map(|flag| format!("--{}", flag.name)).collect();
        let known: Vec<&str> = known.iter().map(String::as_str).collect();
        match known.as_slice() {
            [] => format!("unknown flag `--{name}` (it takes none)"),
            known => unknown("flag", &format!("--{name}"), known),
        }
    }

    /// An error of this command, with the way to its help.
    pub(crate) fn error(&self, message: &str) -> UsageError {
        let name = self.command.name;
        UsageError(format!("{name}: {message}; see `cargo xtask help {name}`"))
    }

    /// True if the flag was given.
    pub(crate) fn switch(&self, flag: &str) -> bool {
        self.given.iter().any(|(name, _)| *name == flag)
    }

    fn text(&self, flag: &str) -> Option<&str> {
        self.given.iter().find(|(name, _)| *name == flag)?.1.as_deref()
    }

    /// The value of a flag that must be there.
    pub(crate) fn given<T>(&self, flag: &str, value: Option<T>) -> Result<T, UsageError> {
        value.ok_or_else(|| self.error(&format!("needs --{flag}")))
    }

    /// A finite number; the flag is required.
    pub(crate) fn number(&self, flag: &str) -> Result<f64, UsageError> {
        let text = self.given(flag, self.text(flag))?;
        match text.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(self.error(&format!("--{flag} must be a finite number, got `{text}`"))),
        }
    }

    /// A whole number of at least `least`.
    pub(crate) fn integer(&self, flag: &str, least: u64) -> Result<Option<u64>, UsageError> {
        let Some(text) = self.text(flag) else { return Ok(None) };
        match text.parse::<u64>() {
            Ok(number) if number >= least => Ok(Some(number)),
            _ => {
                let wanted = format!("a whole number from {least} to {}", u64::MAX);
                Err(self.error(&format!("--{flag} must be {wanted}, got `{text}`")))
            }
        }
    }

    /// One of the names listed.
    pub(crate) fn one_of(
        &self,
        flag: &str,
        names: &[&'static str],
    ) -> Result<Option<&'static str>, UsageError> {
        let Some(text) = self.text(flag) else { return Ok(None) };
        match names.iter().find(|name| **name == text) {
            Some(name) => Ok(Some(name)),
            None => Err(self.error(&unknown(&format!("value of --{flag}"), text, names))),
        }
    }

    /// Of a flag that may be given several times: each one of the names listed.
    pub(crate) fn all_of(&self, flag: &str, names: &[&'static str]) -> Result<Vec<&'static str>, UsageError> {
        let given =
            self.given.iter().filter(|(name, _)| *name == flag).filter_map(|(_, text)| text.as_deref());
        let known = |text: &str| {
            let found = names.iter().find(|name| **name == text).copied();
            found.ok_or_else(|| self.error(&unknown(flag, text, names)))
        };
        given.map(known).collect()
    }

    /// A joint of the crane; `lift` stands for `lift_joint`. The flag is required. If `config` is given, the crane may
    /// be any, and its own file says whether it has such a joint.
    pub(crate) fn joint(&self, flag: &str, config: &str) -> Result<String, UsageError> {
        let text = self.given(flag, self.text(flag))?;
        if self.text(config).is_some() {
            return Ok(text.to_owned());
        }
        let found = JOINTS.iter().find(|name| **name == text || name.strip_suffix("_joint") == Some(text));
        found.map(|name| (*name).to_owned()).ok_or_else(|| self.error(&unknown("joint", text, JOINTS)))
    }

    /// Name of a run: one folder name, so nothing outside `runs/` can be meant.
    pub(crate) fn run_name(&self, flag: &str) -> Result<Option<String>, UsageError> {
        self.text(flag).map(|text| self.checked_run_name(flag, text)).transpose()
    }

    /// Names of runs, in the order in which they were given.
    pub(crate) fn run_names(&self, flag: &str) -> Result<Vec<String>, UsageError> {
        let given = self.given.iter().filter(|(name, _)| *name == flag);
        given.filter_map(|(_, text)| text.as_deref()).map(|text| self.checked_run_name(flag, text)).collect()
    }

    fn checked_run_name(&self, flag: &str, text: &str) -> Result<String, UsageError> {
        let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
        if !text.is_empty() && text.chars().all(plain) && !text.starts_with(['.', '-']) {
            return Ok(text.to_owned());
        }
        let wanted = "letters, digits, `-`, `_` and `.`, beginning with a letter, a digit or `_`";
        Err(self.error(&format!("--{flag} must be a folder name ({wanted}), got `{text}`")))
    }

    /// A policy: a name, which stands for one that comes with the project, or a path to a file that is there.
    pub(crate) fn policy(&self, flag: &str) -> Result<Option<String>, UsageError> {
        let Some(text) = self.text(flag) else { return Ok(None) };
        if is_policy_name(text) {
            return Ok(Some(text.to_owned()));
        }
        let path = self.existing_file(flag)?.and_then(|path| path.into_os_string().into_string().ok());
        path.map(Some).ok_or_else(|| self.error(&format!("--{flag} `{text}` is not UTF-8")))
    }

    /// A path, made absolute from where the user is.
    pub(crate) fn file(&self, flag: &str) -> Result<Option<PathBuf>, UsageError> {
        let Some(text) = self.text(flag) else { return Ok(None) };
        let absolute = std::path::absolute(text);
        absolute.map(Some).map_err(|error| self.error(&format!("--{flag} `{text}`: {error}")))
    }

    /// A path to a file that is there.
    pub(crate) fn existing_file(&self, flag: &str) -> Result<Option<PathBuf>, UsageError> {
        let Some(path) = self.file(flag)? else { return Ok(None) };
        if path.is_file() {
            return Ok(Some(path));
        }
        let what = if path.exists() { "is not a file" } else { "does not exist" };
        Err(self.error(&format!("--{flag}: {} {what}", path.display())))
    }
}

/// True of a word without folder and ending, which names a policy that comes with the project.
pub(crate) fn is_policy_name(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '-' | '_'))
}

fn is_help(word: &str) -> bool {
    matches!(word, "--help" | "-h")
}

fn find_command(name: &str) -> Result<&'static Command, UsageError> {
    let known: Vec<&str> = COMMANDS.iter().map(|command| command.name).collect();
    let command = COMMANDS.iter().find(|command| command.name == name);
    command.ok_or_else(|| UsageError(unknown("command", name, &known) + "; see `cargo xtask help`"))
}

/// "unknown WHAT `lft`; did you mean `lift`? WHAT is one of …".
pub(crate) fn unknown<N: AsRef<str>>(what: &str, text: &str, names: &[N]) -> String {
    let names: Vec<&str> = names.iter().map(AsRef::as_ref).collect();
    let hint = nearest(text, &names).map(|near| format!("; did you mean `{near}`?")).unwrap_or_default();
    format!("unknown {what} `{text}`{hint} (one of: {})", names.join(", "))
}
