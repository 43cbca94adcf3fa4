//! The interface of version 0.1, written out: a caller of it compiles until 0.2.
//!
//! A function that changes its signature, a field or a variant that is added or removed breaks callers, and so this file.
//! Then the version's minor number goes up, here and in the manifest; what is merely new is added below.
#![expect(clippy::type_complexity, reason = "signatures are written out so that they can be compared")]

use std::num::NonZeroU32;

use jbtg::{
    Authority, ControlPoint, Detour, DetourCase, Direction, Extrema, Interval, Limits, LimitsError,
    LimitsSpec, Origin, Planner, PlannerError, PlannerSpec, PulseKind, Quantity, RampError, Sample, Sampler,
    Segment, Shape, State, Stop, StopError, StopStatus, SymmetricLimits, Synchronized, SynchronizedError,
    SynchronizedStep, Timing, Trajectory,
};

type Ramp = Result<Trajectory, RampError>;

#[test]
fn the_version_is_the_one_whose_interface_this_is() {
    assert!(env!("CARGO_PKG_VERSION").starts_with("0.1."));
}

#[test]
fn functions_keep_their_signatures() {
    let _: fn(f64, f64) -> Interval = Interval::new;
    let _: fn(f64) -> Interval = Interval::symmetric;
    let _: fn(Interval) -> f64 = Interval::width;
    let _: [fn(Interval, f64) -> f64; 1] = [Interval::clamp];
    let _: fn(Interval, f64) -> bool = Interval::contains;
    let _: fn(Interval, f64) -> Interval = Interval::including;
    let _: fn(Interval, Interval) -> Interval = Interval::union;
    let _: fn(Interval) -> Interval = Interval::mirrored;
    let _: [fn(&Limits) -> Interval; 4] =
        [Limits::position, Limits::velocity, Limits::acceleration, Limits::jerk];
    let _: fn(LimitsSpec) -> Result<Limits, LimitsError> = Limits::try_from;
    let _: fn(SymmetricLimits) -> Result<Limits, LimitsError> = Limits::try_from;
    let _: [fn(SymmetricLimits) -> LimitsSpec; 1] = [LimitsSpec::from];
    let _: [fn(Limits) -> LimitsSpec; 1] = [LimitsSpec::from];
    let _: fn(PlannerSpec) -> Result<Planner, PlannerError> = Planner::try_from;
    let _: fn(&Planner) -> &PlannerSpec = Planner::spec;
    let _: fn(&Planner) -> &Limits = Planner::limits;
    let _: fn(&Planner) -> f64 = Planner::period;
    let _: fn(&Planner) -> Interval = Planner::velocity;
    let _: fn(&Planner, Direction) -> Authority = Planner::authority;
    let _: fn(&Planner) -> bool = Planner::is_period_short;
    let _: fn(&Planner, f64) -> Interval = Planner::reachable;
    let _: fn(&Planner, f64, f64) -> f64 = Planner::displacement;
    let _: [fn(&Planner, f64, f64, f64) -> Ramp; 4] =
        [Planner::ramp, Planner::ramp_saturated, Planner::waypoint, Planner::waypoint_saturated];
    let _: [fn(&Planner, f64, f64, f64, Direction) -> Ramp; 2] =
        [Planner::waypoint_towards, Planner::farthest];
    let _: fn(&Planner, f64, f64, Direction) -> Result<Detour, RampError> = Planner::detour;
    let _: fn(&Planner, State) -> Result<Stop, StopError> = Planner::stop;
    let _: fn(&Planner, &Trajectory, f64) -> Result<Stop, StopError> = Planner::interrupt;
    let _: fn(&Trajectory, f64) -> State = Trajectory::state_at;
    let _: fn(&Trajectory) -> f64 = Trajectory::duration;
    let _: fn(&Trajectory) -> State = Trajectory::end;
    let _: fn(&Trajectory) -> &[Segment] = Trajectory::segments;
    let _: fn(&Trajectory) -> Extrema = Trajectory::extrema;
    let _: fn(&Trajectory) -> Option<ControlPoint> = Trajectory::standstill;
    let _: fn(&Trajectory) -> Vec<ControlPoint> = |trajectory| trajectory.control_points().collect();
    let _: [fn(&Segment) -> f64; 2] = [Segment::start, Segment::duration];
    let _: fn(&Segment) -> [f64; 6] = Segment::coefficients;
    let _: fn(&Segment, f64) -> State = Segment::state_at;
    let _: fn(State) -> Extrema = Extrema::at;
    let _: fn(Extrema, Extrema) -> Extrema = Extrema::union;
    let _: fn(Shape) -> [f64; 3] = Shape::coefficients;
}

#[test]
fn functions_of_several_ticks_and_joints_keep_their_signatures() {
    let _: fn(Planner, NonZeroU32, f64) -> Result<Sampler, RampError> = Sampler::at_rest;
    let _: fn(&mut Sampler, f64) -> Result<(), RampError> = Sampler::command;
    let _: fn(&mut Sampler, f64) -> Result<f64, RampError> = Sampler::command_saturated;
    let _: fn(&mut Sampler) -> Sample = Sampler::advance;
    let _: [fn(&Sampler) -> State; 2] = [Sampler::state, Sampler::upcoming];
    let _: [fn(&Sampler) -> bool; 2] = [Sampler::is_due, Sampler::is_commanded];
    let _: fn(&Sampler) -> &Planner = Sampler::planner;
    let _: fn(&Sampler) -> NonZeroU32 = Sampler::ticks;
    type Several = Synchronized<3>;
    let _: [fn([Planner; 3]) -> Result<Several, SynchronizedError>; 2] = [Several::new, Several::in_step];
    let _: fn(&Several) -> &[Planner; 3] = Several::planners;
    let _: fn(&Several) -> f64 = Several::period;
    let _: fn(&Several, &[f64; 3], &[f64; 3]) -> Result<f64, SynchronizedError> = Several::share;
    let _: fn(&Several, &[f64; 3], &[f64; 3]) -> Result<u64, SynchronizedError> = Several::periods;
    type Step = Result<SynchronizedStep<3>, SynchronizedError>;
    let _: fn(&Several, [f64; 3], [f64; 3], [f64; 3]) -> Step = Several::ramp;
}

#[test]
fn fields_are_all_there_are() {
    let interval = Interval { min: -1.0, max: 1.0 };
    let spec = LimitsSpec { position: interval, velocity: interval, acceleration: interval, jerk: interval };
    let LimitsSpec { position, velocity: _, acceleration: _, jerk: _ } = spec;
    let _ = SymmetricLimits { position, velocity: 1.0, acceleration: 1.0, jerk: 1.0 };
    let limits = Limits::try_from(spec).unwrap();
    let (shape, timing) = (Shape::default(), Timing::default());
    let planner = Planner::try_from(PlannerSpec { limits, shape, timing, period: 3.0 }).unwrap();
    let Authority {
        velocity_change: _,
        share: _,
        ramps_only: _,
        ramp_up: _,
        ramp_down: _,
        reverse_travel: _,
    } = planner.authority(Direction::Increasing);
    let step = planner.ramp(0.0, 0.0, 0.1).unwrap();
    let State { position: _, velocity: _, acceleration: _, jerk: _ } = step.end();
    let Extrema { position: _, velocity: _, acceleration: _, jerk: _ } = step.extrema();
    for ControlPoint { time: _, state: _ } in step.control_points() {}
    let Detour { case: _, peak: _, rise: _, cruise: _, fall: _ } =
        planner.detour(0.0, 0.1, Direction::Increasing).unwrap();
    let Stop { trajectory: _, begin: _, status: _ } = planner.stop(step.end()).unwrap();
    let mut sampler = Sampler::at_rest(planner, NonZeroU32::MIN, 0.0).unwrap();
    let Sample { state: _, origin: _, is_due: _ } = sampler.advance();
}

#[test]
fn variants_are_all_there_are() {
    let _ = |shape| match shape {
        Shape::Smoothstep | Shape::SineQuintic => (),
    };
    let _ = |timing| match timing {
        Timing::Stretched | Timing::Fastest => (),
    };
    let _ = |direction| match direction {
        Direction::Increasing | Direction::Decreasing => (),
    };
    let _ = |quantity| match quantity {
        Quantity::Position | Quantity::Velocity | Quantity::Acceleration | Quantity::Jerk => (),
    };
    let _ = |case| match case {
        DetourCase::One | DetourCase::Two | DetourCase::Three | DetourCase::Four => (),
    };
    let _ = |kind| match kind {
        PulseKind::Msap | PulseKind::Map => (),
    };
    let _ = |origin| match origin {
        Origin::Command | Origin::Brake => (),
    };
    let _ = |status| match status {
        StopStatus::WithinLimits | StopStatus::Recovering(Quantity::Position | _) => (),
    };
    let _ = |error| match error {
        LimitsError::NotFinite { quantity: _, value: _ }
        | LimitsError::EmptyPosition { min: _, max: _ }
        | LimitsError::ZeroNotInside { quantity: _, min: _, max: _ } => (),
    };
    let _ = |error| match error {
        PlannerError::Period { period: _ }
        | PlannerError::PeriodTooShort { period: _, share: _ }
        | PlannerError::OutOfScale { name: _, value: _ } => (),
    };
    let _ = |error| match error {
        RampError::NotFinite { name: _, value: _ }
        | RampError::Unreachable { from: _, to: _, reachable: _ } => (),
    };
    let _ = |error| match error {
        StopError::NotFinite { name: _, value: _ } | StopError::OutOfScale => (),
    };
}
