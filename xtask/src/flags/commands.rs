//! Every command with its flags: what may be written, and what `help` prints.

/// One command: `cargo xtask NAME [flags]`.
#[derive(Debug)]
pub(crate) struct Command {
    pub(crate) name: &'static str,
    pub(crate) summary: &'static str,
    pub(crate) flags: &'static [Flag],
    pub(crate) example: &'static str,
}

/// One flag: `--NAME` or `--NAME VALUE` or `--NAME=VALUE`.
#[derive(Debug)]
pub(crate) struct Flag {
    pub(crate) name: &'static str,
    /// What the value is called in the help; none for a switch.
    pub(crate) value: Option<&'static str>,
    pub(crate) required: bool,
    /// True if it may be given several times.
    pub(crate) repeated: bool,
    pub(crate) help: &'static str,
}

const fn required(name: &'static str, value: &'static str, help: &'static str) -> Flag {
    Flag { name, value: Some(value), required: true, repeated: false, help }
}

const fn optional(name: &'static str, value: &'static str, help: &'static str) -> Flag {
    Flag { name, value: Some(value), required: false, repeated: false, help }
}

const fn repeated(name: &'static str, value: &'static str, help: &'static str) -> Flag {
    Flag { name, value: Some(value), required: false, repeated: true, help }
}

const fn switch(name: &'static str, help: &'static str) -> Flag {
    Flag { name, value: None, required: false, repeated: false, help }
}

/// What `--policy` takes.
const POLICY: &str = "policy: purple, yellow or orange of assets/policies, or a policy's file or checkpoint";

/// Every command, in the order in which a newcomer needs them.
pub(crate) const COMMANDS: &[Command] = &[
    Command {
        name: "tables",
        summary: "Build the braking tables of the crane's joints",
        flags: &[
            switch("check", "change nothing; fail if a table is missing or out of date"),
            optional("config", "FILE", "configuration, instead of assets/config/default.ron"),
        ],
        example: "cargo xtask tables --check",
    },
    Command {
        name: "train",
        summary: "Train one stage of the curriculum, or all of them",
        flags: &[
            optional("stage", "STAGE", "purple, yellow or orange; this or --all"),
            switch("all", "purple, yellow and orange one after another"),
            optional("run", "NAME", "folder of the run under runs/"),
            optional("seed", "N", "seed of everything random, instead of the configuration's"),
            optional("episodes", "N", "stop after so many episodes, instead of the configuration's"),
            optional("config", "FILE", "configuration, instead of assets/config/default.ron"),
            switch("resume", "continue from the run's latest checkpoint"),
            switch(
                "deterministic",
                "the same numbers on every x86-64 machine; always so, the flag changes nothing",
            ),
            switch("quiet", "no progress on standard error"),
            switch("plain", "progress as lines, on a terminal too"),
        ],
        example: "cargo xtask train --stage purple --run first --seed 7",
    },
    Command {
        name: "eval",
        summary: "Evaluate a trained policy, without exploration",
        flags: &[
            optional(
                "run",
                "NAME",
                "folder of the run under runs/: its policy of the stage; this or --policy",
            ),
            optional("policy", "NAME", POLICY),
            required("stage", "STAGE", "purple, yellow or orange: where starts and targets lie"),
            optional("episodes", "N", "number of episodes"),
            optional("seed", "N", "seed of the starts and targets"),
            optional("json", "FILE", "write the result there as JSON as well"),
        ],
        example: "cargo xtask eval --policy orange --stage orange --episodes 200",
    },
    Command {
        name: "play",
        summary: "Play one episode of a trained policy and print it step by step",
        flags: &[
            optional("run", "NAME", "folder of the run under runs/; this, with --stage, or --policy"),
            optional("policy", "NAME", POLICY),
            optional("stage", "STAGE", "where start and target lie, instead of the policy's own stage"),
            optional("episode", "N", "number of the episode, as in an evaluation (default 0)"),
            optional("seed", "N", "seed of start and target, instead of the policy's"),
            optional("json", "FILE", "write the episode there as JSON as well"),
        ],
        example: "cargo xtask play --policy orange --episode 3",
    },
    Command {
        name: "figures",
        summary: "Draw a run: workspace, postures, safe zone, motion, tracking, margins, learning",
        flags: &[
            repeated("run", "NAME", "run under runs/; more of them add to the learning curves"),
            optional("policy", "NAME", "policy that is shown, a name or a file, instead of the first run's"),
            optional("stage", "STAGE", "stage whose policy is shown, instead of the last one trained"),
            optional("episodes", "N", "episodes to play (default 60)"),
            optional(
                "out",
                "DIR",
                "folder for the pictures, instead of runs/NAME/figures, or figures of a policy alone",
            ),
            repeated("figure", "NAME", "figure to draw, instead of all"),
        ],
        example: "cargo xtask figures --run first --figure workspace --out docs/figures",
    },
    Command {
        name: "report",
        summary: "Write a run as one page: results, certificate, figures, configuration, commands",
        flags: &[
            repeated("run", "NAME", "run under runs/; more of them are compared"),
            optional("policy", "NAME", "policy that is shown, a name or a file, instead of the first run's"),
            optional("stage", "STAGE", "stage whose policy is shown, instead of the last one trained"),
            optional("episodes", "N", "episodes to play for the figures (default 60)"),
            optional(
                "out",
                "FILE",
                "the page, instead of runs/NAME/report.html, or report.html of a policy alone",
            ),
            switch("open", "show it in the browser"),
        ],
        example: "cargo xtask report --run first --open",
    },
    Command {
        name: "runs",
        summary: "List the runs: stage, seed, result, age, and the command that goes on with each",
        flags: &[switch("json", "print JSON")],
        example: "cargo xtask runs",
    },
    Command {
        name: "doctor",
        summary: "Say what is missing on this machine, what for, and how to get it",
        flags: &[],
        example: "cargo xtask doctor",
    },
    Command {
        name: "profile",
        summary: "Plan one jerk-bounded velocity change and print it as samples",
        flags: &[
            required("v1", "V", "velocity at the beginning [m/s or rad/s]"),
            required("v2", "V", "velocity at the end [m/s or rad/s]"),
            required("dt", "T", "duration [s]"),
            required("vmax", "V", "velocity limit, both ways [m/s or rad/s]"),
            required("amax", "A", "acceleration limit, both ways [m/s² or rad/s²]"),
            required("jmax", "J", "jerk limit, both ways [m/s³ or rad/s³]"),
            optional("shape", "SHAPE", "smoothstep (default) or sine-quintic"),
            optional("timing", "TIMING", "stretched (default) or fastest"),
            optional("hz", "N", "samples per second (default 10000)"),
        ],
        example: "cargo xtask profile --v1 -0.1 --v2 -0.08 --dt 0.05 --vmax 0.15 --amax 1 --jmax 100",
    },
    Command {
        name: "zone",
        summary: "Print the safe velocity range of one joint",
        flags: &[
            required("joint", "NAME", "joint, as in the crane's URDF (`_joint` may be left out)"),
            required("position", "P", "position now [m or rad]"),
            required("velocity", "V", "velocity now [m/s or rad/s]"),
            optional("config", "FILE", "configuration, instead of assets/config/default.ron"),
            switch("json", "print JSON"),
        ],
        example: "cargo xtask zone --joint lift_joint --position 0.49 --velocity 0.05",
    },
    Command {
        name: "soak",
        summary: "Run adversaries against the safe ranges and count broken limits",
        flags: &[
            required("steps", "N", "number of steps, exactly"),
            required("seed", "S", "seed of everything random"),
            optional("json", "FILE", "write the result there as JSON as well"),
            optional("threads", "N", "number of threads, instead of all"),
            optional("case", "K", "replay this case alone and print what happens in it"),
        ],
        example: "cargo xtask soak --steps 10000000 --seed 1 --json soak.json",
    },
    Command {
        name: "dynamics",
        summary: "Compute the dynamics of given states and print them as JSON",
        flags: &[
            required("states", "FILE", "states, in the form of the golden states.json"),
            optional("config", "FILE", "configuration, instead of assets/config/default.ron"),
        ],
        example: "cargo xtask dynamics --states crates/hiab-dynamics/testdata/golden/states.json",
    },
    Command {
        name: "load-chart",
        summary: "Chart the largest payload over the tip's positions",
        flags: &[
            optional("config", "FILE", "configuration, instead of assets/config/default.ron"),
            optional("json", "FILE", "write the whole chart there as JSON"),
            optional("svg", "FILE", "write its picture there"),
        ],
        example: "cargo xtask load-chart --svg load.svg",
    },
    Command {
        name: "footprint",
        summary: "Measure jbtg and safezone without an operating system, and prove them free of panics",
        flags: &[],
        example: "cargo xtask footprint",
    },
    Command {
        name: "track",
        summary: "Track scenarios with a control law and print how well",
        flags: &[
            required("scenario", "NAME", "file of assets/scenarios without its ending, or all"),
            optional(
                "controller",
                "LAW",
                "adaptive (default), pd, pid, computed-torque or computed-torque-exact",
            ),
            optional("feedforward", "MODEL", "none, nominal (default) or exact; computed torque takes none"),
            optional("json", "FILE", "write the results there as JSON"),
            optional("csv", "FILE", "write the motion of the one scenario there as CSV"),
        ],
        example: "cargo xtask track --scenario policy-payload-200 --controller pid",
    },
    Command {
        name: "tune",
        summary: "Tune the gains of the control laws on assets/scenarios/training",
        flags: &[
            optional("controller", "LAW", "adaptive, pd, pid or computed-torque, instead of all"),
            optional("plant", "PLANT", "electric or light (hydraulic and rigid), instead of both"),
            optional("budget", "N", "rounds of the search per law (default 25)"),
            optional("seed", "N", "seed of the search (default 0)"),
        ],
        example: "cargo xtask tune --controller pd --plant electric",
    },
    Command {
        name: "ablation",
        summary: "Send a policy's recorded actions with and without jerk-bounded motion",
        flags: &[
            optional("json", "FILE", "write the numbers there as JSON"),
            optional("out", "DIR", "draw lift's motion there as ablation.svg and ablation.png"),
        ],
        example: "cargo xtask ablation --out docs/figures",
    },
    Command {
        name: "search",
        summary: "Train and judge the candidates for the default configuration; goes on where it stopped",
        flags: &[
            optional("space", "FILE", "what is tried, instead of assets/search/space.ron"),
            optional("out", "FILE", "write the table there as well, and its rows as JSON beside it"),
            switch("quiet", "no progress on standard error"),
        ],
        example: "cargo xtask search --space assets/search/five-seeds.ron --out docs/five-seeds.md",
    },
    Command {
        name: "record",
        summary: "Record one episode of a trained policy, for scenarios",
        flags: &[
            optional("run", "NAME", "folder of the run under runs/; this, with --stage, or --policy"),
            optional("policy", "NAME", POLICY),
            optional("stage", "STAGE", "purple, yellow or orange: whose policy of the run"),
            required("episode", "N", "number of the episode"),
            required("out", "FILE", "where the actions go"),
            optional("region", "STAGE", "where start and target lie, instead of the stage's region"),
            optional("seed", "N", "seed of start and target, instead of the policy's"),
        ],
        example: "cargo xtask record --run first --stage purple --episode 0 --out episode.ron",
    },
    Command {
        name: "tidy",
        summary: "Check the layering and what else clippy cannot see",
        flags: &[],
        example: "cargo xtask tidy",
    },
    Command {
        name: "help",
        summary: "Print this, or what one command takes: `help COMMAND`",
        flags: &[],
        example: "cargo xtask help train",
    },
];
