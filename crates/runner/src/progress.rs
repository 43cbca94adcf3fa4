//! What a person sees while a stage trains: a bar on a terminal, plain lines elsewhere, nothing with `--quiet`.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// How progress is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Display {
    /// A bar on a terminal, a line every ten seconds where the output is no terminal.
    Automatic,
    /// A line every ten seconds, everywhere.
    Lines,
    /// Nothing.
    Quiet,
}

/// What is shown of a training.
#[derive(Clone, Copy, Debug)]
pub struct Status {
    /// Episodes finished.
    pub episode: u64,
    /// Environment steps so far.
    pub steps: u64,
    /// Share of successes over the rolling window.
    pub success_rate: f64,
    /// Mean return over the rolling window.
    pub return_: f64,
}

/// Shows how far a training is.
#[derive(Debug)]
pub struct Progress {
    mode: Mode,
    started: Instant,
    first_steps: Option<u64>,
    first_episode: u64,
    episodes: u64,
    stage: &'static str,
}

#[derive(Debug)]
enum Mode {
    Bar(ProgressBar),
    Lines { last: Option<Instant> },
    Quiet,
}

/// Time between two lines where the output is no terminal.
const LINE_INTERVAL: Duration = Duration::from_secs(10);

impl Progress {
    /// Starts showing a stage that ends after `episodes` at the latest.
    #[must_use]
    pub fn start(display: Display, stage: &'static str, episodes: u64) -> Self {
        let mode = match display {
            Display::Quiet => Mode::Quiet,
            Display::Automatic if std::io::stderr().is_terminal() => {
                let style = ProgressStyle::with_template("{prefix:>7} {bar:28} {pos}/{len} {msg}")
                    .expect("the template is a constant and was seen to parse");
                let bar = ProgressBar::new(episodes).with_style(style).with_prefix(stage);
                Mode::Bar(bar)
            }
            Display::Automatic | Display::Lines => Mode::Lines { last: None },
        };
        Self { mode, started: now(), first_steps: None, first_episode: 0, episodes, stage }
    }

    /// Shows the state after an episode.
    pub fn update(&mut self, status: Status) {
        if matches!(self.mode, Mode::Quiet) {
            return;
        }
        let first_steps = *self.first_steps.get_or_insert_with(|| {
            self.first_episode = status.episode;
            status.steps
        });
        let seconds = self.started.elapsed().as_secs_f64().max(1e-9);
        let steps_per_second = (status.steps - first_steps) as f64 / seconds;
        let episodes_per_second = (status.episode - self.first_episode) as f64 / seconds;
        let left = self.episodes.saturating_sub(status.episode) as f64;
        let eta = if episodes_per_second > 0.0 { duration(left / episodes_per_second) } else { "?".into() };
        let message = format!(
            "success {:3.0} %  return {:7.2}  step {:6}  {:5.0} steps/s  ETA at most {eta}",
            100.0 * status.success_rate,
            status.return_,
            status.steps,
            steps_per_second
        );
        match &mut self.mode {
            Mode::Bar(bar) => {
                bar.set_position(status.episode);
                bar.set_message(message);
            }
            Mode::Lines { last } => {
                if last.is_none_or(|last| last.elapsed() >= LINE_INTERVAL) {
                    *last = Some(now());
                    eprintln!("{} episode {}/{}  {message}", self.stage, status.episode, self.episodes);
                }
            }
            Mode::Quiet => {}
        }
    }

    /// Says one thing that stays on the screen.
    pub fn say(&self, line: &str) {
        match &self.mode {
            Mode::Bar(bar) => bar.suspend(|| eprintln!("{line}")),
            Mode::Lines { .. } => eprintln!("{line}"),
            Mode::Quiet => {}
        }
    }

    /// Ends the bar; what it last showed stays.
    pub fn finish(self) {
        if let Mode::Bar(bar) = self.mode {
            bar.abandon();
        }
    }
}

#[expect(clippy::disallowed_methods, reason = "the speed and the remaining time are for a person to see")]
fn now() -> Instant {
    Instant::now()
}

fn duration(seconds: f64) -> String {
    let seconds = seconds.round() as u64;
    match (seconds / 3600, seconds / 60 % 60, seconds % 60) {
        (0, 0, s) => format!("{s} s"),
        (0, m, s) => format!("{m} min {s:02} s"),
        (h, m, _) => format!("{h} h {m:02} min"),
    }
}

#[cfg(test)]
mod tests {
    use super::duration;

    #[test]
    fn durations_are_readable() {
        assert_eq!(duration(59.4), "59 s");
        assert_eq!(duration(61.0), "1 min 01 s");
        assert_eq!(duration(3.0 * 3600.0 + 120.0), "3 h 02 min");
    }
}
