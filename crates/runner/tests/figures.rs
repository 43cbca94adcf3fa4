//! Figures and the report of a small real training: all of them there, sound, and refused where there is nothing to show.

mod support;

use std::process::Command;

use support::learning::small_project;
use support::{Project, check_refusal, check_success};

/// Every figure of a run that trained purple alone.
const FIGURES: [&str; 10] = [
    "architecture",
    "workspace",
    "posture",
    "safe-zone",
    "velocity-profile",
    "motion",
    "tracking",
    "tracking-error",
    "margins",
    "learning-purple",
];

/// A project with two short trainings.
fn trained_project() -> Project {
    let project = small_project();
    for run in ["a", "b --seed 1"] {
        check_success(&runner(&project, &format!("train --quiet --stage purple --episodes 6 --run {run}")));
    }
    project
}

fn runner(project: &Project, arguments: &str) -> std::process::Output {
    project.run(Command::new(env!("CARGO_BIN_EXE_runner")), arguments)
}

#[test]
fn a_run_has_every_figure_and_a_page_that_needs_nothing_else() {
    let project = trained_project();
    let report = check_success(&runner(&project, "figures --run a --run b --episodes 3"));
    for name in FIGURES {
        assert!(report.contains(name), "{name} is not in: {report}");
        let svg = project.text(&format!("runs/a/figures/{name}.svg"));
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n") && !svg.contains("NaN"), "{name}");
        for end in ["", "-dark"] {
            let png = project.bytes(&format!("runs/a/figures/{name}{end}.png"));
            assert!(png.starts_with(b"\x89PNG\r\n") && png.len() > 5_000, "{name}{end}");
        }
    }
    let holds = |name: &str, texts: &[&str]| {
        let svg = project.text(&format!("runs/a/figures/{name}.svg"));
        for text in texts {
            assert!(svg.contains(&format!(">{text}</text>")), "{name} does not say '{text}'");
        }
    };
    holds(
        "motion",
        &["Position [m]", "Velocity [m/s]", "Acceleration [m/s²]", "Jerk [m/s³]", "Time [s]", "max"],
    );
    holds("workspace", &["workspace", "orange", "yellow", "purple", "start", "target", "Reach x [m]"]);
    holds("margins", &["slew", "lift", "telescope", "wrist roll", "reference, exact"]);
    holds("learning-purple", &["lowest to highest of 2 runs", "median", "Environment steps [10³]"]);
    holds("tracking", &["Lift position [m]", "Tilt velocity [m/s]", "Telescope position [m]"]);
    holds("architecture", &["Policy", "Crane", "soft actor-critic, 20 Hz", "7 actuators, 2 kHz"]);
    holds("posture", &["t = 0.00 s", "t = 1.00 s", "target"]);

    check_success(&runner(&project, "report --run a --run b --episodes 3"));
    let page = project.text("runs/a/report.html");
    assert!(page.len() < 5_000_000, "{} bytes", page.len());
    assert_eq!(page.matches("<svg ").count(), FIGURES.len());
    assert_eq!(page.matches("<figure>").count(), FIGURES.len());
    for part in [
        "No limit was exceeded",
        "8 fresh episodes",
        "95 % interval",
        "purple, b",
        "wrist pitch",
        "random_steps: 60",
    ] {
        assert!(page.contains(part), "the page does not say '{part}'");
    }
    for command in ["cargo xtask train --stage purple --run again-b --seed 1", "cargo xtask eval --run a"] {
        assert!(page.contains(command), "the page does not give '{command}'");
    }
    for elsewhere in ["src=", "<script", "@import", "href=\"http", "url(http"] {
        assert!(!page.contains(elsewhere), "the page needs something from elsewhere: {elsewhere}");
    }
    let ids: Vec<&str> = page.split(" id=\"").skip(1).map(|rest| &rest[..rest.find('"').unwrap()]).collect();
    let unique: std::collections::BTreeSet<&str> = ids.iter().copied().collect();
    assert!(ids.len() == unique.len() && !ids.is_empty(), "an id is there twice");

    check_success(&runner(
        &project,
        "figures --policy runs/b/purple/checkpoints/best --episodes 2 --out shown",
    ));
    assert!(
        project.path("shown/workspace.svg").exists() && !project.path("shown/learning-purple.svg").exists()
    );
}

#[test]
fn a_policy_s_file_alone_has_a_page_with_its_results_and_certificate() {
    let project = trained_project();
    let policy = "runs/b/purple/purple.policy";
    check_success(&runner(&project, &format!("report --policy {policy} --episodes 2 --out shown.html")));
    let page = project.text("shown.html");
    for part in
        ["Policy purple", "No limit was exceeded", "4 fresh episodes", "wrist pitch", "random_steps: 60"]
    {
        assert!(page.contains(part), "the page does not say '{part}'");
    }
    assert!(page.contains(&format!("cargo xtask eval --policy {policy} --stage purple --episodes 4")));
    let refused = runner(&project, "report --policy runs/b/purple/checkpoints/best --episodes 2");
    check_refusal(&refused, &["is a checkpoint", "--run NAME"]);
}

#[test]
fn the_same_run_gives_the_same_figures() {
    let project = trained_project();
    for out in ["one", "two"] {
        check_success(&runner(&project, &format!("figures --run a --episodes 3 --out {out}")));
    }
    check_success(&runner(&project, "figures --run a --episodes 3 --figure margins --out three"));
    let files = std::fs::read_dir(project.path("three")).unwrap().count();
    assert_eq!(files, 3, "one figure as .svg, .png and -dark.png");
    assert!(project.bytes("one/margins.svg") == project.bytes("three/margins.svg"));
    for name in FIGURES {
        let file = |out: &str| project.bytes(&format!("{out}/{name}.svg"));
        assert!(file("one") == file("two"), "{name}");
    }
}

#[test]
fn what_cannot_be_shown_is_refused() {
    let project = trained_project();
    check_refusal(&runner(&project, "figures"), &["--run NAME or --policy FILE"]);
    check_refusal(&runner(&project, "figures --run c"), &["'c'", "no trained stage", "cargo xtask train"]);
    check_refusal(
        &runner(&project, "figures --run a --stage orange"),
        &["stage orange", "cargo xtask train"],
    );
    check_refusal(&runner(&project, "figures --run a --episodes 0"), &["--episodes"]);
    check_refusal(
        &runner(&project, "figures --run a --episodes 1 --figure postur"),
        &["'postur'", "did you mean 'posture'", "workspace, posture"],
    );
    check_refusal(&runner(&project, "report --run c"), &["eval.json", "cargo xtask train"]);
    project.write("broken", "no checkpoint at all, but long enough to hold a header");
    check_refusal(&runner(&project, "figures --policy broken"), &["broken", "this is no policy"]);
    project.write("runs/a/purple/metrics.jsonl", "{\"step\": 1}\n");
    check_refusal(&runner(&project, "figures --run a --episodes 1"), &["metrics.jsonl:1", "success_rate"]);
}
