//! What a person sees while a stage trains: three lines that stay in place on a terminal, plain lines elsewhere, nothing
//! with `--quiet`.

mod speed;

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use self::speed::{Count, Speedometer};

/// How progress is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Display {
    /// In place on a terminal, a line every ten seconds where the output is no terminal.
    Automatic,
    /// A line every ten seconds, everywhere.
    Lines,
    /// Nothing.
    Quiet,
}

/// What is shown of a training.
#[derive(Clone, Debug, PartialEq)]
pub struct Status {
    /// Episodes finished.
    pub episode: u64,
    /// Environment steps so far.
    pub steps: u64,
    /// Updates of the learner since the program was started.
    pub updates: u64,
    /// Share of successes over the rolling window.
    pub success_rate: f64,
    /// Mean return over the rolling window.
    pub return_: f64,
    /// Means over the last episode's updates, once there are any.
    pub learner: Option<Learner>,
    /// The smallest margin to any limit so far, of the actual motion.
    pub worst: Worst,
}

/// What is shown of the learner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Learner {
    /// Weight of the entropy.
    pub entropy_temperature: f64,
    /// Loss of the critics.
    pub critic_loss: f64,
    /// Loss of the actor.
    pub actor_loss: f64,
}

/// A smallest margin and whose it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Worst {
    /// Share of the limit that is left.
    pub margin: f64,
    /// The joint, and which of its limits.
    pub place: String,
}

/// Shows how far a training is.
#[derive(Debug)]
pub struct Progress {
    mode: Mode,
    speed: Speedometer,
    episodes: u64,
    stage: &'static str,
}

#[derive(Debug)]
enum Mode {
    InPlace(ProgressBar),
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
                let style = ProgressStyle::with_template("{prefix:>7} {bar:24} {pos}/{len} episodes{msg}")
                    .expect("the template is a constant and was seen to parse");
                let bar = ProgressBar::new(episodes).with_style(style).with_prefix(stage);
                Mode::InPlace(bar)
            }
            Display::Automatic | Display::Lines => Mode::Lines { last: None },
        };
        Self { mode, speed: Speedometer::new(), episodes, stage }
    }

    /// Shows the state after an episode.
    pub fn update(&mut self, status: &Status) {
        if matches!(self.mode, Mode::Quiet) {
            return;
        }
        let Status { episode, steps, updates, .. } = *status;
        self.speed.add(now(), Count { episode, steps, updates });
        let [task, learner, speed, left] = self.parts(status);
        match &mut self.mode {
            Mode::InPlace(bar) => {
                bar.set_position(status.episode);
                let indent = " ".repeat(7);
                bar.set_message(format!(", {left}\n{indent} {task}\n{indent} {learner}\n{indent} {speed}"));
            }
            Mode::Lines { last } => {
                if last.is_none_or(|last| last.elapsed() >= LINE_INTERVAL) {
                    *last = Some(now());
                    let (stage, episodes) = (self.stage, self.episodes);
                    eprintln!("{stage} episode {episode}/{episodes}  {task}  {learner}  {speed}  {left}");
                }
            }
            Mode::Quiet => {}
        }
    }

    /// What the task, the learner, the limits and the clock say; each fits into a narrow terminal.
    fn parts(&self, status: &Status) -> [String; 4] {
        let Status { steps, success_rate, return_, worst, .. } = status;
        let task = format!("reached {:3.0} %  return {return_:7.2}  step {steps}", 100.0 * success_rate);
        let learner = match &status.learner {
            None => "the learner waits for its first steps".to_owned(),
            Some(Learner { entropy_temperature, critic_loss, actor_loss }) => format!(
                "temperature {entropy_temperature:.4}  critic loss {critic_loss:.4}  actor loss {actor_loss:.3}"
            ),
        };
        let margin = format!("least margin {:.2} % ({})", 100.0 * worst.margin, worst.place);
        let rate = self.speed.per_second();
        let speed = rate.map_or_else(String::new, |rate| {
            format!("{:.0} steps/s  {:.0} updates/s  ", rate.steps, rate.updates)
        });
        let episodes_left = self.episodes.saturating_sub(status.episode) as f64;
        let left = match rate {
            Some(rate) if rate.episodes > 0.0 => {
                format!("at most {} left", duration(episodes_left / rate.episodes))
            }
            _ => "time left not known yet".to_owned(),
        };
        [task, learner, speed + &margin, left]
    }

    /// The time until now was not spent on training: speeds are taken anew from here on.
    pub fn forget_speed(&mut self) {
        self.speed = Speedometer::new();
    }

    /// Says one thing that stays on the screen.
    pub fn say(&self, line: &str) {
        match &self.mode {
            Mode::InPlace(bar) => bar.suspend(|| eprintln!("{line}")),
            Mode::Lines { .. } => eprintln!("{line}"),
            Mode::Quiet => {}
        }
    }

    /// Ends it; what it last showed stays.
    pub fn finish(self) {
        if let Mode::InPlace(bar) = self.mode {
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
    use super::*;

    #[test]
    fn durations_are_readable() {
        assert_eq!(duration(59.4), "59 s");
        assert_eq!(duration(61.0), "1 min 01 s");
        assert_eq!(duration(3.0 * 3600.0 + 120.0), "3 h 02 min");
    }

    #[test]
    fn everything_that_a_person_wants_to_know_is_shown() {
        let mut progress = Progress::start(Display::Lines, "purple", 100);
        let learner = Some(Learner { entropy_temperature: 0.0231, critic_loss: 0.4, actor_loss: -1.25 });
        let worst = Worst { margin: 0.0123, place: "lift acceleration".to_owned() };
        let status = Status {
            episode: 40,
            steps: 4000,
            updates: 3000,
            success_rate: 0.85,
            return_: -3.5,
            learner,
            worst,
        };
        let later = now() + Duration::from_secs(4);
        progress.speed.add(now(), Count { episode: 0, steps: 0, updates: 0 });
        progress.speed.add(later, Count { episode: 40, steps: 4000, updates: 3000 });
        let shown = progress.parts(&status).join("  ");
        for part in [
            "reached  85 %",
            "return   -3.50",
            "least margin 1.23 % (lift acceleration)",
            "temperature 0.0231",
            "critic loss 0.4000",
            "actor loss -1.250",
            "step 4000",
            "1000 steps/s",
            "750 updates/s",
            "at most 6 s left",
        ] {
            assert!(shown.contains(part), "no '{part}' in: {shown}");
        }
        let waiting = Status { learner: None, ..status };
        assert!(progress.parts(&waiting)[1].contains("waits"));
    }
}
