//! Every kind of figure: well-formed, labelled, the same each time, and sensible at the extremes.
//!
//! `FIGURES_TO=FOLDER` writes the samples there, to be looked at.
mod support;

use figures::{
    Axis, Band, Chart, Colour, Course, Figure, FigureError, Limit, Panel, Spacing, SvgTheme, Theme,
};
use support::{samples, series};
use xml::reader::{EventReader, XmlEvent};

/// Parses an SVG; gives the texts in it.
#[track_caller]
fn texts(svg: &str) -> Vec<String> {
    let mut texts = Vec::new();
    for event in EventReader::new(svg.as_bytes()) {
        match event.unwrap_or_else(|error| panic!("not well-formed: {error}\n{svg}")) {
            XmlEvent::Characters(text) | XmlEvent::CData(text) => texts.push(text),
            _ => {}
        }
    }
    texts
}

fn every_form(figure: &Figure) -> Vec<String> {
    [SvgTheme::Reader, SvgTheme::Fixed(Theme::Light), SvgTheme::Fixed(Theme::Dark)]
        .map(|theme| figure.svg(theme))
        .to_vec()
}

#[test]
fn every_figure_is_well_formed_and_shows_its_title() {
    for (name, figure) in samples() {
        let figure = figure.unwrap();
        for svg in every_form(&figure) {
            let texts = texts(&svg);
            // Once for the reader's eyes, once for a screen reader.
            let titles = texts.iter().filter(|text| *text == figure.title()).count();
            assert_eq!(titles, 2, "{name}: {texts:?}");
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name}");
        }
    }
}

#[test]
fn every_axis_shows_its_label_and_unit() {
    for (chart, captions) in [
        (
            support::motion(),
            &["Time [s]", "Position [m]", "Velocity [m/s]", "Acceleration [m/s²]", "Jerk [m/s³]"][..],
        ),
        (support::heat(), &["Reach [m]", "Height [m]", "Tracking error [10⁻⁶ m]"]),
        (support::boxes(), &["Quantity", "Smallest margin of an episode [–]"]),
        (support::histogram(), &["Position error [m]", "Ticks [–]"]),
    ] {
        let texts = texts(&chart.draw().unwrap().svg(SvgTheme::Reader));
        for caption in captions {
            assert!(texts.iter().any(|text| text == caption), "no '{caption}' among {texts:?}");
        }
    }
}

#[test]
fn limits_are_named_and_in_view_though_no_value_comes_near() {
    let chart = Chart {
        panels: vec![Panel {
            limits: Limit::both(-5.0, 5.0),
            ..Panel::new(Axis::new("y", "m"), vec![series(0, "", vec![[0.0, 0.1], [1.0, -0.1]])])
        }],
        ..Chart::new("limits", Axis::new("x", "s"))
    };
    let texts = texts(&chart.draw().unwrap().svg(SvgTheme::Reader));
    for text in ["min", "max", "−5.0", "5.0"] {
        assert!(texts.iter().any(|found| found == text), "no '{text}' among {texts:?}");
    }
}

#[test]
fn the_same_numbers_give_the_same_text_and_pixels() {
    for ((name, first), (_, second)) in samples().into_iter().zip(samples()) {
        let (first, second) = (first.unwrap(), second.unwrap());
        assert_eq!(every_form(&first), every_form(&second), "{name}");
        assert_eq!(first.png(Theme::Light, 1.0).unwrap(), second.png(Theme::Light, 1.0).unwrap(), "{name}");
    }
}

#[test]
fn figures_in_one_page_share_no_id() {
    let ids = |svg: &str| -> Vec<String> {
        svg.split(" id=\"").skip(1).map(|rest| rest[..rest.find('"').unwrap()].to_owned()).collect()
    };
    let mut seen = std::collections::BTreeSet::new();
    for (name, figure) in samples() {
        for id in ids(&figure.unwrap().svg(SvgTheme::Reader)) {
            assert!(seen.insert(id.clone()), "{name} has {id} again");
        }
    }
    assert!(!seen.is_empty());
}

#[test]
fn a_reader_s_theme_holds_both_and_a_fixed_one_only_its_own() {
    let figure = support::lines().draw().unwrap();
    let [both, light, dark] = <[String; 3]>::try_from(every_form(&figure)).unwrap();
    assert!(
        both.contains("prefers-color-scheme:dark") && both.contains("#ffffff") && both.contains("#0d1117")
    );
    assert!(light.contains("#ffffff") && !light.contains("#0d1117"));
    assert!(dark.contains("#0d1117") && !dark.contains("#ffffff"));
}

#[test]
fn a_png_has_as_many_pixels_as_asked_for() {
    let figure = support::plane().draw().unwrap();
    let png = figure.png(Theme::Dark, 1.5).unwrap();
    let side = |at: usize| f64::from(u32::from_be_bytes(png[at..at + 4].try_into().unwrap()));
    let [width, height] = figure.size();
    assert_eq!((side(16), side(20)), ((width * 1.5).ceil(), (height * 1.5).ceil()));
    for scale in [0.0, -1.0, f64::NAN, 1e9] {
        assert!(matches!(figure.png(Theme::Light, scale), Err(FigureError::Pixels { .. })), "{scale}");
    }
}

fn chart(y: Axis, points: Vec<[f64; 2]>) -> Result<Figure, FigureError> {
    Chart {
        panels: vec![Panel::new(y, vec![series(0, "a", points)])],
        ..Chart::new("extreme", Axis::new("x", "s"))
    }
    .draw()
}

#[test]
fn nothing_to_draw_is_refused_by_name() {
    for points in [vec![], vec![[f64::NAN, 1.0]], vec![[0.0, f64::INFINITY]], vec![[1.0, f64::NAN]; 9]] {
        let error = chart(Axis::new("y", "m"), points).unwrap_err();
        assert_eq!(error, FigureError::NoData { figure: "extreme".into(), axis: "x".into() });
    }
    let given = Chart {
        panels: vec![Panel::new(Axis::new("y", "m").from_to(0.0, 1.0), vec![])],
        ..Chart::new("empty", Axis::new("x", "s").from_to(0.0, 1.0))
    };
    texts(&given.draw().unwrap().svg(SvgTheme::Reader));
}

#[test]
fn an_axis_without_label_or_unit_is_refused() {
    for y in [Axis::new("", "m"), Axis::new("y", " ")] {
        assert!(matches!(chart(y, vec![[0.0, 0.0]]), Err(FigureError::Unlabelled { .. })));
    }
}

#[test]
fn a_range_that_is_none_is_refused() {
    for (min, max) in [(1.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (0.0, f64::INFINITY), (-f64::MAX, f64::MAX)] {
        let error = chart(Axis::new("y", "m").from_to(min, max), vec![[0.0, 0.0]]).unwrap_err();
        assert!(matches!(error, FigureError::Range { .. }), "{min} to {max}: {error}");
    }
    let logarithmic = Axis { spacing: Spacing::Logarithmic, ..Axis::new("y", "m").from_to(0.0, 1.0) };
    assert!(matches!(chart(logarithmic, vec![[0.0, 0.5]]), Err(FigureError::Range { .. })));
}

#[test]
fn extreme_numbers_give_a_picture() {
    for points in [
        vec![[0.0, 0.0]],
        vec![[3.0, 7.0]],
        vec![[0.0, 1e300], [1.0, -1e300]],
        vec![[0.0, 1e-300], [1e-300, -1e-300]],
        vec![[0.0, 1.0], [1.0, 1.0 + f64::EPSILON]],
        vec![[0.0, 1.0], [f64::NAN, f64::NAN], [1.0, f64::NEG_INFINITY], [2.0, 3.0], [3.0, 2.0]],
        vec![[1e15, 0.0], [1e15 + 8.0, 1.0]],
    ] {
        let figure = chart(Axis::new("y", "m"), points.clone()).unwrap();
        let svg = figure.svg(SvgTheme::Reader);
        texts(&svg);
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{points:?}");
        assert!(svg.len() < 20_000, "{points:?} gives {} bytes", svg.len());
        figure.png(Theme::Light, 1.0).unwrap();
    }
}

#[test]
fn a_name_that_several_panels_share_stands_there_once() {
    let texts = texts(&support::motion().draw().unwrap().svg(SvgTheme::Reader));
    for name in ["reference", "actual", "safe range", "chosen"] {
        assert_eq!(texts.iter().filter(|text| *text == name).count(), 1, "{name}");
    }
}

#[test]
fn a_single_point_can_be_seen() {
    let svg = chart(Axis::new("y", "m"), vec![[3.0, 7.0]]).unwrap().svg(SvgTheme::Reader);
    assert!(svg.matches("<circle").count() >= 2, "one in the legend, one in the panel");
}

#[test]
fn a_gap_parts_a_line_and_a_band() {
    let gap = [f64::NAN; 2];
    let svg = |points| chart(Axis::new("y", "m"), points).unwrap().svg(SvgTheme::Reader);
    let line = |svg: &str| {
        svg.lines()
            .filter(|l| l.contains("clip-path") && l.contains("M"))
            .map(|l| l.matches('M').count())
            .max()
    };
    assert_eq!(line(&svg(vec![[0.0, 0.0], [1.0, 1.0], [2.0, 0.0], [3.0, 1.0]])), Some(1));
    assert_eq!(line(&svg(vec![[0.0, 0.0], [1.0, 1.0], gap, [2.0, 0.0], [3.0, 1.0]])), Some(2));
    let band = figures::Layer::Band(Band {
        name: String::new(),
        points: vec![
            [0.0, 0.0, 1.0],
            [1.0, 0.0, 1.0],
            [2.0, f64::NAN, 1.0],
            [3.0, 0.0, 1.0],
            [4.0, 0.0, 1.0],
        ],
        course: Course::Straight,
        colour: Colour::Blue,
    });
    let figure = Chart {
        panels: vec![Panel::new(Axis::new("y", "m"), vec![band])],
        ..Chart::new("band", Axis::new("x", "s"))
    };
    let svg = figure.draw().unwrap().svg(SvgTheme::Reader);
    assert_eq!(svg.matches("fill-opacity=\"0.2\"").count(), 2);
}

#[test]
fn a_long_record_stays_small() {
    let points = (0..200_000).map(|k| [f64::from(k), (f64::from(k) * 0.37).sin()]).collect();
    let svg = chart(Axis::new("y", "m"), points).unwrap().svg(SvgTheme::Reader);
    assert!(svg.len() < 80_000, "{} bytes", svg.len());
}

#[test]
fn lists_that_do_not_fit_together_are_refused() {
    let mut chart = support::heat();
    let figures::Layer::Heat(heat) = &mut chart.panels[0].layers[0] else { panic!("a heat map") };
    heat.values.pop();
    assert!(matches!(chart.draw(), Err(FigureError::Length { expected: 2400, found: 2399, .. })));
}

#[test]
fn a_diagram_that_names_a_box_that_is_not_there_is_refused() {
    let mut diagram = support::diagram();
    diagram.arrows[0].to = 4;
    assert!(matches!(diagram.draw(), Err(FigureError::Length { expected: 5, found: 4, .. })));
    diagram.arrows.clear();
    diagram.nodes.clear();
    assert!(matches!(diagram.draw(), Err(FigureError::NoData { .. })));
}

#[test]
fn a_diagram_shows_every_name_and_label() {
    let texts = texts(&support::diagram().draw().unwrap().svg(SvgTheme::Reader));
    for text in ["Policy", "20 Hz", "a ∈ [−1, 1]³", "state", "reset"] {
        assert!(texts.iter().any(|found| found == text), "no '{text}'");
    }
}

#[test]
fn a_strip_names_its_axes_and_layers_once_and_every_picture() {
    let texts = texts(&support::strip().draw().unwrap().svg(SvgTheme::Reader));
    let count = |text: &str| texts.iter().filter(|found| *found == text).count();
    assert_eq!((count("Height [m]"), count("target"), count("t = 1.5 s")), (1, 1, 1));
    assert_eq!(count("Reach [m]"), 5, "under each picture of the last row");
}

#[test]
fn samples_can_be_looked_at() {
    let Some(folder) = std::env::var_os("FIGURES_TO") else { return };
    let folder = std::path::PathBuf::from(folder);
    std::fs::create_dir_all(&folder).unwrap();
    for (name, figure) in samples() {
        let figure = figure.unwrap();
        std::fs::write(folder.join(format!("{name}.svg")), figure.svg(SvgTheme::Reader)).unwrap();
        for (theme, end) in [(Theme::Light, "light"), (Theme::Dark, "dark")] {
            std::fs::write(folder.join(format!("{name}-{end}.png")), figure.png(theme, 1.5).unwrap())
                .unwrap();
        }
    }
}
