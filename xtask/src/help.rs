//! The help, from the grammar.

use crate::flags::{COMMANDS, Command, Flag};

/// Help on one command, or the list of all.
pub(crate) fn text(command: Option<&Command>) -> String {
    match command {
        Some(command) => one(command),
        None => all(),
    }
}

fn all() -> String {
    let mut text = String::from("cargo xtask COMMAND [flags]\n\n");
    let width = COMMANDS.iter().map(|command| command.name.len()).max().unwrap_or(0);
    for command in COMMANDS {
        text += &format!("  {:width$}  {}\n", command.name, command.summary);
    }
    text + "\nFlags and an example: cargo xtask help COMMAND, or cargo xtask COMMAND --help.\n\
            Values may be negative: --v1 -0.1 and --v1=-0.1 are the same. Files are relative to where you are.\n"
}

fn one(command: &Command) -> String {
    let mut text = format!("{}.\n\ncargo xtask {}", command.summary, command.name);
    for flag in command.flags {
        let form = form(flag);
        text += &if flag.required { format!(" {form}") } else { format!(" [{form}]") };
        text += if flag.repeated { "…" } else { "" };
    }
    text += "\n";
    if !command.flags.is_empty() {
        text += "\n";
        let width = command.flags.iter().map(|flag| form(flag).len()).max().unwrap_or(0);
        for flag in command.flags {
            text += &format!("  {:width$}  {}\n", form(flag), flag.help);
        }
    }
    text + &format!("\nExample:\n  {}\n", command.example)
}

fn form(flag: &Flag) -> String {
    match flag.value {
        Some(value) => format!("--{} {value}", flag.name),
        None => format!("--{}", flag.name),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flags::Invocation;

    #[test]
    fn the_list_has_a_line_for_every_command() {
        for command in COMMANDS {
            assert!(
                text(None)
                    .lines()
                    .any(|line| line.trim().starts_with(command.name)
                        && line.trim().ends_with(command.summary)),
                "{}",
                command.name
            );
        }
    }

    #[test]
    fn help_on_a_command_has_every_flag_and_an_example_that_parses() {
        for command in COMMANDS {
            let help = text(Some(command));
            for flag in command.flags {
                assert!(
                    help.contains(&form(flag)) && help.contains(flag.help),
                    "{} {}",
                    command.name,
                    flag.name
                );
            }
            assert!(help.contains(command.example));
            let words = command.example.strip_prefix("cargo xtask ").unwrap().split(' ').map(str::to_owned);
            // The example's file is relative to the root, where tests do not run.
            let is_input = |word: &str| word.ends_with(".json") || word.ends_with(".ron");
            let words = words.map(|word| if is_input(&word) { "Cargo.toml".to_owned() } else { word });
            Invocation::parse(words.collect()).unwrap();
        }
    }
}
