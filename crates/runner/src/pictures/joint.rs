//! One joint over an episode: its zone, its velocity profile, its motion, its tracking.

use figures::{
    Axis, Band, Chart, Colour, Course, Dash, Figure, FigureError, Layer, Limit, Marker, Panel, Region,
    Series, Style,
};
use jbtg::{Interval, State};
use safezone::SafeZone;

use super::{
    Quantity, Shown, actual_style, capitalised, line, points, reference_style, time_axis, way_style,
};
use crate::recording::RecordedTick;

/// Points along each curved edge of a zone.
const EDGE_POINTS: u32 = 60;

/// The velocities that are safe at each position of a joint, and the way that the policy took through them
/// [P, Fig. safezone].
///
/// # Errors
/// The recording has no step.
pub fn zone(shown: &Shown<'_>, action: usize) -> Result<Figure, FigureError> {
    let (name, unit) = (shown.names()[action], shown.unit(action));
    let joint = &shown.machine.joints()[shown.machine.moving()[action]];
    let steps = &shown.recording.steps;
    let at = |state: &State| [state.position, state.velocity];
    let way: Vec<[f64; 2]> = shown.recording.ticks.iter().map(|tick| at(&tick.reference[action])).collect();
    let limits = joint.zone.planner().limits();
    let (position, velocity) = (limits.position(), limits.velocity());
    let room = 0.03 * position.width();
    Chart {
        panels: vec![Panel {
            limits: Limit::both(velocity.min, velocity.max),
            height: 300.0,
            ..Panel::new(
                Axis::new("Velocity", &format!("{unit}/s")),
                vec![
                    Layer::Region(Region {
                        name: "safe: it can stop before the limit".to_owned(),
                        vertices: safe_states(&joint.zone),
                        colour: Colour::Green,
                        dash: Dash::Solid,
                    }),
                    line("the policy's way", way_style(), way),
                    points(
                        "policy steps",
                        Style { marker: Some(Marker::Ring), ..way_style() },
                        steps.iter().map(|step| at(&step.reference[action])),
                    ),
                    points(
                        "start",
                        Style { marker: Some(Marker::Square), ..Style::nth(6) },
                        steps.first().map(|step| at(&step.reference[action])),
                    ),
                ],
            )
        }],
        ..Chart::new(
            &format!("Safe velocities of the {name} joint, and the way through them"),
            Axis::new("Position", unit).from_to(position.min - room, position.max + room),
        )
    }
    .draw()
}

/// Outline of the states from which stepwise braking stops before the position limit.
fn safe_states(zone: &SafeZone<'_>) -> Vec<[f64; 2]> {
    let limits = zone.planner().limits();
    let (position, velocity) = (limits.position(), limits.velocity());
    let share = |k: u32| f64::from(k) / f64::from(EDGE_POINTS);
    let mut outline = vec![[position.min, 0.0], [position.min, velocity.max]];
    for k in 0..=EDGE_POINTS {
        let speed = velocity.max * (1.0 - share(k));
        outline.push([position.max - zone.stopping_distance(speed), speed]);
    }
    outline.push([position.max, velocity.min]);
    for k in 0..=EDGE_POINTS {
        let speed = velocity.min * (1.0 - share(k));
        outline.push([position.min + zone.stopping_distance(speed), speed]);
    }
    outline
}

/// For every moving joint the range at each policy step, the velocity chosen in it, and the jerk-bounded curve that
/// leads there [P, Fig. velocity profile, Fig. reaching profile].
///
/// # Errors
/// The recording has no step.
pub fn velocity_profile(shown: &Shown<'_>) -> Result<Figure, FigureError> {
    let period = shown.machine.rates().policy_period();
    let panel = |action: usize| {
        let steps = || shown.recording.steps.iter().enumerate();
        let range = steps().map(|(k, step)| {
            let range = step.commands[action].range;
            [k as f64 * period, range.min, range.max]
        });
        let chosen = steps().map(|(k, step)| [(k + 1) as f64 * period, step.commands[action].velocity]);
        let ticks = shown.recording.ticks.iter();
        let curve = ticks.map(|tick| [tick.time, tick.reference[action].velocity]);
        let limits = shown.machine.joints()[shown.machine.moving()[action]].limits.velocity();
        let label = format!("{} velocity", capitalised(shown.names()[action]));
        Panel {
            limits: Limit::both(limits.min, limits.max),
            height: 150.0,
            ..Panel::new(
                Axis::new(&label, &format!("{}/s", shown.unit(action))),
                vec![
                    Layer::Band(Band {
                        name: "safe range of the velocity at the step's end".to_owned(),
                        points: range.collect(),
                        course: Course::Steps,
                        colour: Colour::Green,
                    }),
                    line("jerk-bounded curve", way_style(), curve),
                    points("chosen", Style { marker: Some(Marker::Disc), ..Style::nth(1) }, chosen),
                ],
            )
        }
    };
    Chart {
        panels: (0..shown.machine.moving().len()).map(panel).collect(),
        ..Chart::new("What the policy may choose, what it chooses, and the way there", time_of(shown))
    }
    .draw()
}

/// Position, velocity, acceleration and jerk of one joint, reference and actual, with the actuator's limits.
///
/// # Errors
/// The recording has no tick.
pub fn motion(shown: &Shown<'_>, action: usize) -> Result<Figure, FigureError> {
    let (name, unit) = (shown.names()[action], shown.unit(action));
    let limits = shown.machine.joints()[shown.machine.moving()[action]].limits;
    let quantities: [(&str, String, Interval, Quantity<State>); 4] = [
        ("Position", unit.to_owned(), limits.position(), |state| state.position),
        ("Velocity", format!("{unit}/s"), limits.velocity(), |state| state.velocity),
        ("Acceleration", format!("{unit}/s²"), limits.acceleration(), |state| state.acceleration),
        ("Jerk", format!("{unit}/s³"), limits.jerk(), |state| state.jerk),
    ];
    let panel = |(label, unit, limit, of): &(&str, String, Interval, Quantity<State>)| Panel {
        limits: Limit::both(limit.min, limit.max),
        height: 130.0,
        ..Panel::new(
            Axis::new(label, unit),
            vec![
                course("reference", reference_style(), shown, |tick| of(&tick.reference[action])),
                course("actual", actual_style(), shown, |tick| of(&tick.actual[action])),
            ],
        )
    };
    Chart {
        panels: quantities.iter().map(panel).collect(),
        ..Chart::new(&format!("Motion of the {name} joint and its limits"), time_of(shown))
    }
    .draw()
}

/// Position and velocity of every moving joint, reference and actual [P, Fig. tracking].
///
/// # Errors
/// The recording has no tick.
pub fn tracking(shown: &Shown<'_>) -> Result<Figure, FigureError> {
    let mut panels = Vec::new();
    for (action, name) in shown.names().into_iter().enumerate() {
        let (name, unit) = (capitalised(name), shown.unit(action));
        let quantities: [(&str, String, Quantity<State>); 2] = [
            ("position", unit.to_owned(), |state| state.position),
            ("velocity", format!("{unit}/s"), |state| state.velocity),
        ];
        for (quantity, unit, of) in quantities {
            panels.push(Panel {
                height: 165.0,
                ..Panel::new(
                    Axis::new(&format!("{name} {quantity}"), &unit),
                    vec![
                        course("reference", reference_style(), shown, |tick| of(&tick.reference[action])),
                        course("actual", actual_style(), shown, |tick| of(&tick.actual[action])),
                    ],
                )
            });
        }
    }
    Chart { panels, ..Chart::new("How the moving joints follow their references", time_of(shown)) }.draw()
}

/// Errors of position and velocity of every moving joint.
///
/// # Errors
/// The recording has no tick.
pub fn tracking_error(shown: &Shown<'_>) -> Result<Figure, FigureError> {
    let quantities: [(&str, &str, Quantity<State>); 2] =
        [("Position error", "", |state| state.position), ("Velocity error", "/s", |state| state.velocity)];
    let names = shown.names();
    let panel = |(label, per, of): &(&str, &str, Quantity<State>)| {
        let layer = |(action, name): (usize, &&str)| {
            let style = Style { width: 1.3, ..Style::nth(action) };
            course(name, style, shown, |tick| of(&tick.actual[action]) - of(&tick.reference[action]))
        };
        let layers = names.iter().enumerate().map(layer).collect();
        Panel { height: 170.0, ..Panel::new(Axis::new(label, &format!("{}{per}", shown.unit(0))), layers) }
    };
    Chart {
        panels: quantities.iter().map(panel).collect(),
        ..Chart::new("Actual motion less reference", time_of(shown))
    }
    .draw()
}

/// A quantity at every tick.
fn course(name: &str, style: Style, shown: &Shown<'_>, of: impl Fn(&RecordedTick) -> f64) -> Layer {
    let points = shown.recording.ticks.iter().map(|tick| [tick.time, of(tick)]).collect();
    Layer::Series(Series { name: name.to_owned(), points, course: Course::Straight, style })
}

/// The time from the episode's start to its end.
fn time_of(shown: &Shown<'_>) -> Axis {
    let end = shown.recording.steps.len() as f64 * shown.machine.rates().policy_period();
    time_axis().from_to(0.0, end)
}
