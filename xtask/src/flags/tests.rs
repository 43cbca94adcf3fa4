use super::*;
use std::ffi::OsString;

fn parse(line: &str) -> Result<Invocation, UsageError> {
    Invocation::parse(line.split_whitespace().map(str::to_owned).collect())
}

#[track_caller]
fn refusal(line: &str) -> String {
    let text = parse(line).expect_err("this command line must be refused").to_string();
    assert_eq!(text.lines().count(), 1, "{text}");
    text
}

/// What cargo is given for a command line.
#[track_caller]
fn cargo_line(line: &str) -> String {
    let call = match parse(line).unwrap() {
        Invocation::Tables(flags) => flags.call(),
        Invocation::Train(flags) => flags.call(),
        Invocation::Eval(flags) => flags.call(),
        Invocation::Play(flags) => flags.call(),
        Invocation::Figures(flags) => flags.call(),
        Invocation::Report(flags) => flags.call(),
        Invocation::Runs(flags) => flags.call(),
        Invocation::Profile(flags) => flags.call(),
        Invocation::Zone(flags) => flags.call(),
        Invocation::Soak(flags) => flags.call(),
        Invocation::Dynamics(flags) => flags.call(),
        Invocation::LoadChart(flags) => flags.call(),
        Invocation::Track(flags) => flags.call(),
        Invocation::Tune(flags) => flags.call(),
        Invocation::Ablation(flags) => flags.call(),
        Invocation::Record(flags) => flags.call(),
        Invocation::Search(flags) => flags.call(),
        Invocation::Help(_) | Invocation::Doctor | Invocation::Footprint | Invocation::Tidy => {
            panic!("{line} runs no child")
        }
    };
    let words = call.cargo_arguments();
    words.iter().map(|word: &OsString| word.to_str().unwrap()).collect::<Vec<_>>().join(" ")
}

const KINEMATICS: &str = "run --quiet --release -p runner --no-default-features --bin kinematics --";
const RUNNER: &str = "run --release -p runner --bin runner --";

#[test]
fn flags_reach_the_child_in_one_form() {
    for (line, child) in [
        ("tables", format!("{KINEMATICS} tables")),
        ("tables --check", format!("{KINEMATICS} tables --check")),
        (
            "train --quiet --seed=7 --stage purple --run a-1 --episodes 20 --resume",
            format!("{RUNNER} train --stage purple --run a-1 --seed 7 --episodes 20 --resume --quiet"),
        ),
        ("train --all --plain", format!("{RUNNER} train --all --plain")),
        (
            "eval --stage=orange --run x --episodes 5 --seed 0",
            format!("{RUNNER} eval --run x --stage orange --episodes 5 --seed 0"),
        ),
        ("eval --policy orange --stage orange", format!("{RUNNER} eval --policy orange --stage orange")),
        ("play --policy yellow --episode 0", format!("{RUNNER} play --policy yellow --episode 0")),
        ("play --run a --stage purple --seed 3", format!("{RUNNER} play --run a --stage purple --seed 3")),
        (
            "record --policy purple --episode 1 --out /x.ron",
            format!("{RUNNER} record --policy purple --episode 1 --out /x.ron"),
        ),
        (
            "figures --run b --stage purple --run=a --episodes 9",
            format!("{RUNNER} figures --run b --run a --stage purple --episodes 9"),
        ),
        ("runs --json", format!("{KINEMATICS} runs --json")),
        (
            "figures --run a --figure safe-zone --figure=posture",
            format!("{RUNNER} figures --run a --figure safe-zone --figure posture"),
        ),
        ("report --open --run a", format!("{RUNNER} report --run a --open")),
        ("report --policy orange", format!("{RUNNER} report --policy orange")),
        (
            "profile --v1=-0.1 --v2 -1e-2 --dt .05 --vmax 0.15 --amax 1 --jmax 1e2 --timing fastest --hz 500",
            format!(
                "{KINEMATICS} profile --v1 -0.1 --v2 -0.01 --dt 0.05 --vmax 0.15 --amax 1 --jmax 100 \
                 --timing fastest --hz 500"
            ),
        ),
        ("load-chart", format!("{KINEMATICS} load-chart")),
        (
            "zone --json --joint lift --position 0.3 --velocity -0.05",
            format!("{KINEMATICS} zone --joint lift_joint --position 0.3 --velocity -0.05 --json"),
        ),
        (
            "track --scenario=policy --controller pid --feedforward none",
            format!("{KINEMATICS} track --scenario policy --controller pid --feedforward none"),
        ),
        ("tune --plant light --budget 7", format!("{KINEMATICS} tune --plant light --budget 7")),
        ("ablation", KINEMATICS.replace("--bin", "--features figures --bin") + " ablation"),
        (
            "soak --seed 0 --steps=10000000 --case 3 --threads 2",
            format!("{KINEMATICS} soak --steps 10000000 --seed 0 --threads 2 --case 3"),
        ),
    ] {
        assert_eq!(cargo_line(line), child);
    }
}

#[test]
fn files_become_absolute_from_where_the_user_is() {
    let here = std::env::current_dir().unwrap();
    let states = format!("{KINEMATICS} dynamics --states {}", here.join("Cargo.toml").display());
    assert_eq!(cargo_line("dynamics --states Cargo.toml"), states);
    let json = here.join("out/eval.json");
    let line = cargo_line("eval --run x --stage purple --json out/eval.json");
    assert!(line.ends_with(&format!("--json {}", json.display())), "{line}");
    assert!(cargo_line("train --all --config src/main.rs").contains(here.to_str().unwrap()));
}

#[test]
fn a_file_to_read_must_be_there() {
    assert!(refusal("dynamics --states no/such.json").contains("no/such.json does not exist"));
    assert!(refusal("train --all --config src").contains("is not a file"));
}

#[test]
fn numbers_survive_unchanged() {
    for number in [0.1 + 0.2, 1e-300, -f64::MAX, f64::MIN_POSITIVE / 4.0, -0.0] {
        let line = format!("zone --joint lift --position {number:?} --velocity={number:e}");
        let Invocation::Zone(zone) = parse(&line).unwrap() else { panic!("not a zone") };
        assert_eq!((zone.position.to_bits(), zone.velocity.to_bits()), (number.to_bits(), number.to_bits()));
        assert!(cargo_line(&line).contains(&format!("--position {number}")));
    }
}

#[test]
fn an_unknown_stage_lists_the_three() {
    let text = refusal("train --stage purpel");
    assert!(text.contains("`purpel`; did you mean `purple`?"), "{text}");
    assert!(text.contains("purple, yellow, orange") && text.contains("cargo xtask help train"), "{text}");
    assert!(refusal("eval --run x --stage green").contains("purple, yellow, orange"));
}

#[test]
fn unknown_names_get_a_suggestion() {
    assert!(refusal("trian --all").contains("did you mean `train`?"));
    assert!(refusal("help tidi").contains("did you mean `tidy`?"));
    let text = refusal("train --al");
    assert!(text.contains("did you mean `--all`?") && text.contains("--stage, --all, --run"), "{text}");
    assert!(refusal("figures --run a --figure workspce").contains("did you mean `workspace`?"));
    assert!(refusal("tidy --fix").contains("takes none"));
    let text = refusal("zone --joint telescop_joint --position 0 --velocity 0");
    assert!(text.contains("did you mean `telescope_joint`?") && text.contains("wrist_roll_joint"), "{text}");
    let text = refusal("profile --shape sine --v1 0 --v2 0 --dt 1 --vmax 1 --amax 1 --jmax 1");
    assert!(text.contains("did you mean `sine-quintic`?"), "{text}");
}

#[test]
fn what_is_missing_is_named() {
    let text = refusal("profile --v1 0 --v2 0 --dt 1 --vmax 1");
    assert!(text.contains("needs --amax A, --jmax J"), "{text}");
    assert!(refusal("train").contains("--stage STAGE (purple, yellow, orange) or --all"));
    assert!(refusal("train --stage purple --all").contains("not both"));
    assert!(refusal("eval --stage purple").contains("needs --run NAME"));
    assert!(refusal("soak --json x").contains("needs --steps N, --seed S"));
    assert!(refusal("play --run a").contains("needs --stage STAGE with --run"));
    assert!(refusal("play --run a --policy b").contains("not both"));
    assert!(refusal("play --policy gone.policy").contains("gone.policy does not exist"));
    assert!(refusal("figures --out x").contains("needs --run NAME or --policy NAME"));
    assert!(refusal("report --open").contains("needs --run NAME"));
    assert!(refusal("train --stage --run x").contains("`--stage` needs a value: --stage STAGE"));
    assert!(refusal("train --all --run").contains("needs a value"));
}

#[test]
fn bad_values_are_refused() {
    for (line, part) in [
        ("zone --joint lift --position NaN --velocity 0", "--position must be a finite number, got `NaN`"),
        ("zone --joint lift --position 1 --velocity inf", "--velocity must be a finite number"),
        ("zone --joint lift --position 1,5 --velocity 0", "got `1,5`"),
        ("train --all --seed -1", "--seed must be a whole number from 0"),
        ("track --scenario policy --controller pidd", "did you mean `pid`"),
        ("track --scenario ../policy", "--scenario must be a folder name"),
        ("tune --plant hydraulic", "electric, light"),
        ("record --run a --stage purple --out x", "needs --episode N"),
        ("soak --seed 1 --steps 0", "--steps must be a whole number from 1"),
        ("train --all --episodes 0", "--episodes must be a whole number from 1"),
        ("train --all --run ../x", "--run must be a folder name"),
        ("train --all --run .hidden", "--run must be a folder name"),
        ("train --all --run=", "--run must be a folder name"),
        ("train --all --all", "given twice"),
        ("figures --run a --run ../b", "--run must be a folder name"),
        ("figures --run a --stage purple --stage orange", "given twice"),
        ("tables --check=yes", "takes no value"),
        ("tables now", "unexpected argument `now`"),
        ("tidy -x", "unexpected argument `-x`"),
    ] {
        let text = refusal(line);
        assert!(text.contains(part), "{line}: {text}");
    }
}

#[test]
fn help_is_found_everywhere() {
    for line in ["", "help", "--help", "-h", "help --help"] {
        assert!(matches!(parse(line), Ok(Invocation::Help(None))), "{line}");
    }
    for line in ["help train", "help --help train", "train --help", "train -h", "train --stage --help"] {
        let Ok(Invocation::Help(Some(command))) = parse(line) else { panic!("{line}") };
        assert_eq!(command.name, "train");
    }
}

#[test]
fn joint_names_are_the_crane_s() {
    let crane = include_str!("../../../assets/hiab/hiab.ron");
    let actuators = &crane[crane.find("actuators:").unwrap()..];
    let names: Vec<&str> =
        actuators.split("joint: \"").skip(1).map(|rest| &rest[..rest.find('"').unwrap()]).collect();
    assert_eq!(names, JOINTS);
}

#[test]
fn a_load_chart_builds_with_pictures_only_if_one_is_asked_for() {
    let line = cargo_line("load-chart --svg /tmp/load.svg --json /tmp/load.json");
    assert!(line.contains("--no-default-features --features figures --bin kinematics"), "{line}");
    assert!(line.ends_with("load-chart --json /tmp/load.json --svg /tmp/load.svg"), "{line}");
    assert!(!cargo_line("load-chart --json /tmp/load.json").contains("figures"));
}

#[test]
fn another_crane_has_other_joints() {
    let config = concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/config/excavator.ron");
    let line = format!("zone --joint bucket_joint --position 0 --velocity 0 --config {config}");
    assert!(cargo_line(&line).contains("--joint bucket_joint"));
    assert!(refusal("zone --joint bucket_joint --position 0 --velocity 0").contains("bucket_joint"));
}
