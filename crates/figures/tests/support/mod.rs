//! One sample of every kind of figure.
#![allow(dead_code, unreachable_pub, reason = "every test file takes what it needs")]

use figures::{
    Arrow, Axis, Band, Boxes, Chart, Colour, Course, Dash, Diagram, Distribution, Figure, FigureError, Heat,
    Histogram, Layer, Limit, Node, Outline, Panel, Part, Picture, Proportion, Region, Series, Spacing, Strip,
    Style,
};

/// Name and figure of every sample.
pub fn samples() -> Vec<(&'static str, Result<Figure, FigureError>)> {
    vec![
        ("lines", lines().draw()),
        ("motion", motion().draw()),
        ("plane", plane().draw()),
        ("heat", heat().draw()),
        ("boxes", boxes().draw()),
        ("histogram", histogram().draw()),
        ("strip", strip().draw()),
        ("diagram", diagram().draw()),
    ]
}

pub fn series(n: usize, name: &str, points: Vec<[f64; 2]>) -> Layer {
    Layer::Series(Series { name: name.into(), points, course: Course::Straight, style: Style::nth(n) })
}

/// Six series with bands, over a long axis.
pub fn lines() -> Chart {
    let mut layers = Vec::new();
    let curve = |k: usize, x: f64| 1.0 / (1.0 + (-(x - 4.0 - 0.6 * k as f64)).exp());
    let xs: Vec<f64> = (0..=240).map(|n| f64::from(n) * 0.05).collect();
    let points = xs.iter().map(|&x| [x, curve(0, x) - 0.07, (curve(0, x) + 0.05).min(1.0)]).collect();
    layers.push(Layer::Band(Band {
        name: "smallest to largest of 5 runs".into(),
        points,
        course: Course::Straight,
        colour: Colour::Blue,
    }));
    for k in 0..6 {
        layers.push(series(
            k,
            &format!("seed {k}, learning rate 3·10⁻⁴"),
            xs.iter().map(|&x| [x, curve(k, x)]).collect(),
        ));
    }
    Chart {
        panels: vec![Panel { height: 280.0, ..Panel::new(Axis::new("Success", "–"), layers) }],
        ..Chart::new("Share of episodes that reached their target", Axis::new("Environment steps", "10³"))
    }
}

/// Four panels with limits.
pub fn motion() -> Chart {
    let ts: Vec<f64> = (0..=2000).map(|n| f64::from(n) * 0.002).collect();
    let panel = |label: &str, unit: &str, limit: f64, f: &dyn Fn(f64) -> f64| Panel {
        limits: Limit::both(-limit, limit),
        height: 110.0,
        ..Panel::new(
            Axis::new(label, unit),
            vec![
                series(0, "reference", ts.iter().map(|&t| [t, f(t)]).collect()),
                series(1, "actual", ts.iter().map(|&t| [t, f(t - 0.02)]).collect()),
            ],
        )
    };
    let steps = (0..80).map(|k| [f64::from(k) * 0.05, 0.12 * (f64::from(k) * 0.1).sin()]);
    let band: Vec<[f64; 3]> =
        steps.clone().map(|[t, v]| [t, (v - 0.03).max(-0.15), (v + 0.03).min(0.15)]).collect();
    let mut velocity = panel("Velocity", "m/s", 0.15, &|t| 0.12 * (2.0 * t).sin());
    velocity.layers.insert(
        0,
        Layer::Band(Band {
            name: "safe range".into(),
            points: band,
            course: Course::Steps,
            colour: Colour::Sky,
        }),
    );
    velocity.layers.push(Layer::Series(Series {
        name: "chosen".into(),
        points: steps.collect(),
        course: Course::Steps,
        style: Style::nth(2).unmarked(),
    }));
    Chart {
        panels: vec![
            panel("Position", "m", 0.0821, &|t| 0.06 * (1.0 - (2.0 * t).cos())),
            velocity,
            panel("Acceleration", "m/s²", 1.0, &|t| 0.24 * (2.0 * t).cos()),
            panel("Jerk", "m/s³", 100.0, &|t| -0.48 * (2.0 * t).sin() * 150.0),
        ],
        ..Chart::new("Motion of the lift cylinder", Axis::new("Time", "s"))
    }
}

pub fn plane() -> Chart {
    let region = |name: &str, half: f64, colour, dash| {
        Layer::Region(Region {
            name: name.into(),
            vertices: vec![
                [3.0 - half, 2.0 - 1.3 * half],
                [3.0 + half, 2.0 - half],
                [3.0 + half, 2.0 + half],
                [3.0 - half, 2.0 + 1.2 * half],
            ],
            colour,
            dash,
        })
    };
    let path =
        (0..60).map(|k| [2.9 + 0.01 * f64::from(k), 1.7 + 0.3 * (f64::from(k) * 0.05).sin()]).collect();
    Chart {
        panels: vec![Panel::new(
            Axis::new("Height z", "m"),
            vec![
                region("workspace", 1.3, Colour::Blue, Dash::Solid),
                region("orange", 0.9, Colour::Orange, Dash::LongDash),
                region("yellow", 0.6, Colour::Yellow, Dash::DashDot),
                region("purple", 0.35, Colour::Purple, Dash::Dashed),
                series(6, "tip", path),
            ],
        )],
        width: 520.0,
        proportion: Proportion::Equal,
        ..Chart::new("Regions", Axis::new("Reach x", "m"))
    }
}

pub fn heat() -> Chart {
    let edges = |n: i32| (0..=n).map(|k| f64::from(k) / f64::from(n) * 4.0).collect::<Vec<f64>>();
    let values = (0..40 * 60)
        .map(|k| {
            let (x, y) = (f64::from(k % 60) / 15.0 - 2.0, f64::from(k / 60) / 10.0 - 2.0);
            if x * x + y * y > 4.0 { f64::NAN } else { 1e-5 * (x * y + (3.0 * x).sin()) }
        })
        .collect();
    let quantity = Axis::new("Tracking error", "m");
    let heat = Heat { quantity, x_edges: edges(60), y_edges: edges(40), values };
    Chart {
        panels: vec![Panel::new(Axis::new("Height", "m"), vec![Layer::Heat(heat)])],
        width: 560.0,
        proportion: Proportion::Equal,
        ..Chart::new("A value over the plane", Axis::new("Reach", "m"))
    }
}

pub fn boxes() -> Chart {
    let names = ["position", "velocity", "acceleration", "jerk"];
    let found = |shift: f64| {
        (0..4)
            .map(|k| {
                let values: Vec<f64> = (0..50)
                    .map(|n| (0.03 * f64::from(k) + 0.02 * f64::from(n).sqrt() + shift).min(1.0))
                    .collect();
                Distribution::of(&values)
            })
            .collect()
    };
    let layer = |name: &str, shift, colour, offset| {
        Layer::Boxes(Boxes { name: name.into(), distributions: found(shift), colour, offset, thickness: 0.3 })
    };
    let y = Axis { categories: names.map(str::to_owned).to_vec(), ..Axis::new("Quantity", "–") };
    Chart {
        panels: vec![Panel::new(
            y,
            vec![
                layer("reference", 0.2, Colour::Blue, 0.18),
                layer("actual", 0.1, Colour::Vermillion, -0.18),
            ],
        )],
        ..Chart::new(
            "Margins to the limits",
            Axis::new("Smallest margin of an episode", "–").from_to(0.0, 1.0),
        )
    }
}

pub fn histogram() -> Chart {
    let edges: Vec<f64> = (0..=24).map(|k| 10f64.powf(-7.0 + f64::from(k) * 0.2)).collect();
    let heights = (0..24).map(|k| (300.0 * (-(f64::from(k) - 12.0).powi(2) / 20.0).exp()).round()).collect();
    let layer = Histogram { name: "lift".into(), edges, heights, colour: Colour::Green };
    Chart {
        panels: vec![Panel::new(Axis::new("Ticks", "–"), vec![Layer::Histogram(layer)])],
        ..Chart::new(
            "Tracking errors",
            Axis { spacing: Spacing::Logarithmic, ..Axis::new("Position error", "m") },
        )
    }
}

pub fn strip() -> Strip {
    let arm = |angle: f64| {
        let (sin, cos) = angle.sin_cos();
        let bar = |from: f64, to: f64, half: f64, colour| Part {
            vertices: [[from, half], [to, half], [to, -half], [from, -half]]
                .map(|[u, v]| [u * cos - v * sin, 1.0 + u * sin + v * cos])
                .to_vec(),
            colour,
        };
        Layer::Outline(Outline {
            parts: vec![bar(0.0, 1.2, 0.1, Colour::Blue), bar(0.9, 2.0, 0.05, Colour::Orange)],
        })
    };
    let picture = |k: u32| Picture {
        caption: format!("t = {:.1} s", 0.5 * f64::from(k)),
        layers: vec![
            arm(0.25 * f64::from(k) - 0.3),
            Layer::Series(Series {
                name: "target".into(),
                points: vec![[1.1, 2.2]],
                course: Course::Points,
                style: Style::nth(4),
            }),
        ],
    };
    Strip {
        title: "An arm at several times".into(),
        x: Axis::new("Reach", "m"),
        y: Axis::new("Height", "m"),
        pictures: (0..5).map(picture).collect(),
        columns: 5,
        width: 900.0,
    }
}

pub fn diagram() -> Diagram {
    let node = |column, row, name: &str, line: &str, colour| Node {
        column,
        row,
        name: name.into(),
        lines: vec![line.into()],
        colour,
    };
    let arrow = |from, to, label: &str, shift| Arrow { from, to, lines: vec![label.into()], shift };
    Diagram {
        title: "A loop".into(),
        nodes: vec![
            node(0, 0, "Policy", "20 Hz", Colour::Purple),
            node(1, 0, "Safe range", "never empty", Colour::Green),
            node(1, 1, "Plant", "2 kHz", Colour::Blue),
            node(0, 1, "Observation", "32 numbers", Colour::Grey),
        ],
        arrows: vec![
            arrow(0, 1, "a ∈ [−1, 1]³", 0.0),
            arrow(1, 2, "velocity", 0.0),
            arrow(2, 3, "state", -10.0),
            arrow(3, 2, "reset", 10.0),
            arrow(3, 0, "s", 0.0),
        ],
    }
}
