//! What acts on what, and how often [P, Fig. Architecture].

use figures::{Arrow, Colour, Diagram, Figure, FigureError, Node};

use crate::machine::Machine;

/// The loop as a block diagram, with this machine's rates and numbers.
///
/// # Errors
/// Never for a loaded machine.
pub fn architecture(machine: &Machine) -> Result<Figure, FigureError> {
    let rates = machine.rates();
    let hertz = |divider: u32| {
        let rate = f64::from(rates.integration_hz) / f64::from(divider);
        if rate >= 1000.0 { format!("{} kHz", rate / 1000.0) } else { format!("{rate} Hz") }
    };
    let (actions, joints) = (machine.moving().len(), machine.joints().len());
    let node = |column, row, name: &str, lines: &[&str], colour| Node {
        column,
        row,
        name: name.to_owned(),
        lines: lines.iter().map(|&line| line.to_owned()).collect(),
        colour,
    };
    let arrow = |from, to, lines: &[&str], shift| Arrow {
        from,
        to,
        lines: lines.iter().map(|&line| line.to_owned()).collect(),
        shift,
    };
    let policy = format!("soft actor-critic, {}", hertz(rates.policy_divider));
    let reference = format!("jerk-bounded quintics, {}", hertz(rates.reference_divider));
    let control = format!("adaptive law per joint, {}", hertz(rates.controller_divider));
    let crane = format!("{joints} actuators, {}", hertz(1));
    Diagram {
        title: "From the policy to the crane and back".to_owned(),
        nodes: vec![
            node(0, 0, "Policy", &[&policy], Colour::Purple),
            node(1, 0, "Safe velocity range", &["keeps every limit,", "now and for ever"], Colour::Green),
            node(2, 0, "Trajectory generator", &[&reference], Colour::Green),
            node(2, 1, "Controller", &[&control, "and the model's effort"], Colour::Orange),
            node(1, 1, "Crane", &[&crane, "with closed cylinder loops"], Colour::Blue),
            node(0, 1, "Task", &["observation, reward,", "end of the episode"], Colour::Grey),
        ],
        arrows: vec![
            arrow(0, 1, &[&format!("{actions} actions"), "in [−1, 1]"], 0.0),
            arrow(1, 2, &["next", "velocity"], -12.0),
            arrow(2, 1, &["where it", "ends"], 12.0),
            arrow(2, 3, &["position, velocity,", "acceleration"], 0.0),
            arrow(3, 4, &["effort"], -12.0),
            arrow(4, 3, &["measured", "state"], 12.0),
            arrow(4, 5, &["measured", "state"], 0.0),
            arrow(5, 0, &["observation"], 0.0),
        ],
    }
    .draw()
}
