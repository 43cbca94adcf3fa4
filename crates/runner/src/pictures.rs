//! The figures of a run: what the paper shows of its own, and what one needs to trust it.
//!
//! Everything here makes a [`figures::Figure`] from numbers that other modules found; nothing is simulated or learnt.

mod architecture;
mod joint;
#[cfg(feature = "training")]
mod learning;
mod limits;
mod plane;
mod posture;

use figures::{Axis, Colour, Course, Dash, Layer, Series, Style};

pub use architecture::architecture;
pub use joint::{motion, tracking, tracking_error, velocity_profile, zone};
#[cfg(feature = "training")]
pub use learning::{Curve, CurvePoint, learning};
pub use limits::margins;
pub use plane::workspace;
pub use posture::{Looks, LooksError, postures};

use crate::machine::{Machine, short};
use crate::recording::Recording;

/// A recorded episode with everything that its pictures need.
#[derive(Clone, Copy, Debug)]
pub struct Shown<'a> {
    /// The machine that moved.
    pub machine: &'a Machine,
    /// What its links and joints look like.
    pub looks: &'a Looks,
    /// The episode, with every tick.
    pub recording: &'a Recording,
}

impl Shown<'_> {
    /// Names of the moving joints, in the order of the actions, without the URDF's ending.
    fn names(&self) -> Vec<&str> {
        self.machine.moving().iter().map(|&joint| short(&self.machine.joints()[joint].name)).collect()
    }

    /// Unit of a moving joint's position.
    fn unit(&self, action: usize) -> &'static str {
        self.looks.unit(&self.machine.joints()[self.machine.moving()[action]].name)
    }

    /// Which moving joint's ranges its position limits narrow most often; the one that goes farthest if they narrow none.
    #[must_use]
    pub fn most_confined(&self) -> usize {
        let narrowed = |action: &usize| {
            self.recording.steps.iter().filter(|step| step.commands[*action].range.narrowed).count()
        };
        let most = (0..self.machine.moving().len()).max_by_key(narrowed);
        most.filter(|action| narrowed(action) > 0).unwrap_or_else(|| self.busiest())
    }

    /// Which moving joint goes farthest, as a share of its range.
    #[must_use]
    pub fn busiest(&self) -> usize {
        let travelled = |action: usize| -> f64 {
            let range = self.machine.joints()[self.machine.moving()[action]].limits.position();
            let places = self.recording.steps.iter().map(|step| step.reference[action].position);
            let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), place| {
                (low.min(place), high.max(place))
            });
            (high - low) / range.width()
        };
        (0..self.machine.moving().len())
            .max_by(|&a, &b| travelled(a).total_cmp(&travelled(b)))
            .unwrap_or_default()
    }
}

/// Takes a number out of something that has several.
type Quantity<T> = fn(&T) -> f64;

/// With a capital letter.
pub(crate) fn capitalised(name: &str) -> String {
    let mut letters = name.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

/// The axis of a time.
fn time_axis() -> Axis {
    Axis::new("Time", "s")
}

/// A line.
fn line(name: &str, style: Style, points: impl IntoIterator<Item = [f64; 2]>) -> Layer {
    let points = points.into_iter().collect();
    Layer::Series(Series { name: name.to_owned(), points, course: Course::Straight, style })
}

/// Single points.
fn points(name: &str, style: Style, points: impl IntoIterator<Item = [f64; 2]>) -> Layer {
    let points = points.into_iter().collect();
    Layer::Series(Series { name: name.to_owned(), points, course: Course::Points, style })
}

/// A reference alone.
fn way_style() -> Style {
    Style { width: 2.4, ..Style::nth(0).unmarked() }
}

/// A reference under the actual motion, which hides all but the edges of it: pale and wide.
fn reference_style() -> Style {
    Style { colour: Colour::Sky, dash: Dash::Solid, marker: None, width: 4.5 }
}

/// The actual motion on its reference.
fn actual_style() -> Style {
    Style { colour: Colour::Vermillion, dash: Dash::Solid, marker: None, width: 1.3 }
}
