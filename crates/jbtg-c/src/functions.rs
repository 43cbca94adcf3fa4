//! The exported functions.
#![expect(unsafe_code, reason = "an exported name is an unsafe attribute: the linker must not find it twice")]

use core::ffi::{CStr, c_char};
use core::mem::MaybeUninit;

use core::num::NonZeroU32;

use jbtg::{Direction, Origin};
use safezone::{Request, SafeRange, Source};

use crate::joint::{Joint, Sampler, Step};
use crate::status::Status;
use crate::types::{Authority, Command, Extrema, Interval, Limits, Range, Sample, Spec, State};

/// Writes `value`, or says why not.
fn write<T>(out: Option<&mut MaybeUninit<T>>, value: Result<T, Status>) -> Status {
    match (out, value) {
        (None, _) => Status::NullPointer,
        (Some(_), Err(status)) => status,
        (Some(out), Ok(value)) => {
            out.write(value);
            Status::Ok
        }
    }
}

/// What `status` means, in English; never NULL.
#[unsafe(no_mangle)]
pub extern "C" fn jbtg_status_text(status: i32) -> *const c_char {
    const UNKNOWN: &CStr = c"no status of this library";
    Status::from_number(status).map_or(UNKNOWN, Status::text).as_ptr()
}

/// Whether the limits can be those of a joint.
#[unsafe(no_mangle)]
pub extern "C" fn jbtg_check_limits(limits: Option<&Limits>) -> Status {
    let Some(limits) = limits else { return Status::NullPointer };
    jbtg::Limits::try_from(*limits).map_or_else(|status| status, |_| Status::Ok)
}

/// Fills `joint` with the limits, planner and safe zone that `spec` describes. On an error `joint` is left as it
/// was, and no other function may be given it.
#[unsafe(no_mangle)]
pub extern "C" fn jbtg_joint_init(joint: Option<&mut MaybeUninit<Joint>>, spec: Option<&Spec>) -> Status {
    let Some(spec) = spec else { return Status::NullPointer };
    write(joint, Joint::try_from(*spec))
}

/// What one period can do to the velocity upwards (`increasing`) or downwards.
#[unsafe(no_mangle)]
pub extern "C" fn jbtg_authority_of(
    joint: Option<&Joint>,
    increasing: bool,
    out: Option<&mut MaybeUninit<Authority>>,
) -> Status {
    let Some(joint) = joint else { return Status::NullPointer };
    let direction = if increasing { Direction::Increasing } else { Direction::Decreasing };
    let jbtg::Authority { velocity_change, share, .. } = joint.zone.planner().authority(direction);
    write(out, Ok(Authority { velocity_change, share }))
}

/// Velocities that one period can reach from `velocity`, whatever the position.
#[unsafe(no_mangle)]
pub extern "C" fn jbtg_reachable(
    joint: Option<&Joint>,
    velocity: f64,
    out: Option<&mut MaybeUninit<Interval>>,
) -> Status {
    let Some(joint) = joint else { return Status::NullPointer };
    let reachable = joint.zone.planner().reachable(velocity);
    write(out, if velocity.is_finite() { Ok(reachable.into()) } else { Err(Status::NotFinite) })
}

/// Distance that braking in steps of one period travels from `velocity`, in its direction.
#[unsafe(no_mangle)]
pub extern "C" fn jbtg_stopping_distance(
    joint: Option<&Joint>,
    velocity: f64,
    out: Option<&mut MaybeUninit<f64>>,
) -> Status {
    let Some(joint) = joint else { return Status::NullPointer };
    let distance = joint.zone.stopping_distance(velocity);
    write(out, if velocity.is_finite() { Ok(distance) } else { Err(Status::NotFinite) })
}

/// The velocities that are safe to command as the end of the next step. A state that is not finite has a range too,
/// see its status.
#[unsafe(no_mangle)]
pub extern "C" fn jbtg_safe_range(
    joint: Option<&Joint>,
    position: f64,
    velocity: f64,
    out: Option<&mut MaybeUninit<Range>>,
) -> Status {
    let Some(joint) = joint else { return Status::NullPointer };
    write(out, Ok(joint.zone.range(position, velocity).into()))
}

/// The safe velocity nearest to the `wanted` one. A NaN or an infinity brakes.
#[unsafe(no_mangle)]
pub extern "C" fn jbtg_command_velocity(
    joint: Option<&Joint>,
    position: f64,
    velocity: f64,
    wanted: f64,
    out: Option<&mut MaybeUninit<Command>>,
) -> Status {
    let Some(joint) = joint else { return Status::NullPointer };
    let range = joint.zone.range(position, velocity);
    let is_fail_safe = !wanted.is_finite() || range.status == safezone::RangeStatus::Unknown;
    let nearest = if is_fail_safe { range.brake } else { within(&range, wanted) };
    let is_clamped = !is_fail_safe && !range.contains(wanted);
    write(out, Ok(Command { velocity: nearest, range: range.into(), is_fail_safe, is_clamped }))
}

/// The velocity that an `action` in [-1, 1] stands for: -1 is the least safe one, 1 the greatest. A NaN or an infinity
/// brakes.
#[unsafe(no_mangle)]
pub extern "C" fn jbtg_command_action(
    joint: Option<&Joint>,
    position: f64,
    velocity: f64,
    action: f64,
    out: Option<&mut MaybeUninit<Command>>,
) -> Status {
    let Some(joint) = joint else { return Status::NullPointer };
    let command = joint.zone.command(position, velocity, Request::Action(action));
    let command = Command {
        velocity: command.velocity,
        range: command.range.into(),
        is_fail_safe: matches!(command.source, Source::FailSafe(_)),
        is_clamped: matches!(command.source, Source::PolicyClamped { .. }),
    };
    write(out, Ok(command))
}

/// Plans the step from `position` and `from` to the velocity `to` in exactly one period.
#[unsafe(no_mangle)]
pub extern "C" fn jbtg_plan(
    joint: Option<&Joint>,
    position: f64,
    from: f64,
    to: f64,
    step: Option<&mut MaybeUninit<Step>>,
) -> Status {
    let Some(joint) = joint else { return Status::NullPointer };
    let planned = joint.zone.planner().ramp(position, from, to);
    write(step, planned.map(|trajectory| Step { trajectory }).map_err(Status::from))
}

/// Plans the motion from `position` and `from` to the velocity `to` in exactly one period through the greatest peak
/// velocity on the way, or the least one for motion downwards.
#[unsafe(no_mangle)]
pub extern "C" fn jbtg_plan_waypoint(
    joint: Option<&Joint>,
    position: f64,
    from: f64,
    to: f64,
    step: Option<&mut MaybeUninit<Step>>,
) -> Status {
    let Some(joint) = joint else { return Status::NullPointer };
    let planned = joint.zone.planner().waypoint(position, from, to);
    write(step, planned.map(|trajectory| Step { trajectory }).map_err(Status::from))
}

/// State `time` seconds after the start of the step; before it the first state, after it the last.
#[unsafe(no_mangle)]
pub extern "C" fn jbtg_step_state_at(
    step: Option<&Step>,
    time: f64,
    out: Option<&mut MaybeUninit<State>>,
) -> Status {
    let Some(step) = step else { return Status::NullPointer };
    write(out, Ok(step.trajectory.state_at(time).into()))
}

/// Exact extrema of position, velocity, acceleration and jerk over the step.
#[unsafe(no_mangle)]
pub extern "C" fn jbtg_step_extrema(step: Option<&Step>, out: Option<&mut MaybeUninit<Extrema>>) -> Status {
    let Some(step) = step else { return Status::NullPointer };
    write(out, Ok(step.trajectory.extrema().into()))
}

/// Plans the quickest way to rest from any state, acceleration included. `is_recovering` is set if the state is beyond
/// a velocity, acceleration or jerk limit; it may be NULL. Position limits are not heeded.
#[unsafe(no_mangle)]
pub extern "C" fn jbtg_plan_stop(
    joint: Option<&Joint>,
    from: Option<&State>,
    step: Option<&mut MaybeUninit<Step>>,
    is_recovering: Option<&mut MaybeUninit<bool>>,
) -> Status {
    let (Some(joint), Some(from)) = (joint, from) else { return Status::NullPointer };
    let stop = joint.zone.planner().stop((*from).into());
    if let (Ok(stop), Some(flag)) = (&stop, is_recovering) {
        flag.write(stop.status != jbtg::StopStatus::WithinLimits);
    }
    write(step, stop.map(|stop| Step { trajectory: stop.trajectory }).map_err(Status::from))
}

/// Plans the stop of a `running` step from `time` seconds after its start on. It travels no farther, in either
/// direction, than finishing the step and braking then, so it keeps the position limits if the step was a safe one.
/// Follow the running step until `begin` seconds after its start, then `stop`. `is_recovering` is as for
/// jbtg_plan_stop; it may be NULL.
#[unsafe(no_mangle)]
pub extern "C" fn jbtg_plan_interrupt(
    joint: Option<&Joint>,
    running: Option<&Step>,
    time: f64,
    stop: Option<&mut MaybeUninit<Step>>,
    begin: Option<&mut MaybeUninit<f64>>,
    is_recovering: Option<&mut MaybeUninit<bool>>,
) -> Status {
    let (Some(joint), Some(running), Some(begin)) = (joint, running, begin) else {
        return Status::NullPointer;
    };
    let planned = joint.zone.planner().interrupt(&running.trajectory, time);
    if let Ok(planned) = &planned {
        begin.write(planned.begin);
        if let Some(flag) = is_recovering {
            flag.write(planned.status != jbtg::StopStatus::WithinLimits);
        }
    }
    write(stop, planned.map(|stop| Step { trajectory: stop.trajectory }).map_err(Status::from))
}

/// Fills `sampler` for a joint at rest at `position`, with `ticks` samples in every period.
#[unsafe(no_mangle)]
pub extern "C" fn jbtg_sampler_init(
    sampler: Option<&mut MaybeUninit<Sampler>>,
    joint: Option<&Joint>,
    ticks: u32,
    position: f64,
) -> Status {
    let Some(joint) = joint else { return Status::NullPointer };
    let Some(ticks) = NonZeroU32::new(ticks) else { return Status::UnknownChoice };
    let made = jbtg::Sampler::at_rest(*joint.zone.planner(), ticks, position);
    write(sampler, made.map(|ticks| Sampler { ticks }).map_err(Status::from))
}

/// Where the running period ends: the state that the next command starts from.
#[unsafe(no_mangle)]
pub extern "C" fn jbtg_sampler_upcoming(
    sampler: Option<&Sampler>,
    out: Option<&mut MaybeUninit<State>>,
) -> Status {
    let Some(sampler) = sampler else { return Status::NullPointer };
    write(out, Ok(sampler.ticks.upcoming().into()))
}

/// Commands the velocity at which the next period ends. On an error the sampler is as it was.
#[unsafe(no_mangle)]
pub extern "C" fn jbtg_sampler_command(sampler: Option<&mut Sampler>, velocity: f64) -> Status {
    let Some(sampler) = sampler else { return Status::NullPointer };
    sampler.ticks.command(velocity).map_or_else(Status::from, |()| Status::Ok)
}

/// Goes to the next tick. Where no velocity was commanded for a period, the joint brakes in it.
#[unsafe(no_mangle)]
pub extern "C" fn jbtg_sampler_advance(
    sampler: Option<&mut Sampler>,
    out: Option<&mut MaybeUninit<Sample>>,
) -> Status {
    let (Some(sampler), Some(out)) = (sampler, out) else { return Status::NullPointer };
    let jbtg::Sample { state, origin, is_due } = sampler.ticks.advance();
    out.write(Sample { state: state.into(), is_braking: origin == Origin::Brake, is_due });
    Status::Ok
}

fn within(range: &SafeRange, velocity: f64) -> f64 {
    velocity.max(range.min).min(range.max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::types::{JBTG_SMOOTHSTEP, JBTG_STRETCHED};

    #[test]
    fn an_interrupted_step_says_where_its_stop_begins() {
        let interval = |bound: f64| Interval { min: -bound, max: bound };
        let limits = Limits {
            position: interval(0.5),
            velocity: interval(0.15),
            acceleration: interval(1.0),
            jerk: interval(100.0),
        };
        let spec = Spec { limits, period: 0.05, shape: JBTG_SMOOTHSTEP, timing: JBTG_STRETCHED };
        let joint = Joint::try_from(spec).unwrap_or_else(|status| panic!("{status:?}"));
        let planner = joint.zone.planner();
        let trajectory = planner.ramp(0.3, 0.01, -0.02).unwrap_or_else(|error| panic!("{error}"));
        let mut postponed = 0;
        for tick in 0..50 {
            let time = 0.001 * f64::from(tick);
            let (mut stop, mut begin) = (MaybeUninit::uninit(), MaybeUninit::new(f64::NAN));
            let mut is_recovering = MaybeUninit::new(true);
            let status = jbtg_plan_interrupt(
                Some(&joint),
                Some(&Step { trajectory }),
                time,
                Some(&mut stop),
                Some(&mut begin),
                Some(&mut is_recovering),
            );
            assert_eq!(status, Status::Ok);
            // SAFETY: the status says that all three are written.
            let (stop, begin, is_recovering) =
                unsafe { (stop.assume_init(), begin.assume_init(), is_recovering.assume_init()) };
            let expected = planner.interrupt(&trajectory, time).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!((begin, stop.trajectory), (expected.begin, expected.trajectory));
            assert!(!is_recovering);
            postponed += u32::from(begin > time);
        }
        assert!(0 < postponed && postponed < 50, "{postponed} of 50 stops wait for a later quintic");
        let again = jbtg_plan_interrupt(Some(&joint), Some(&Step { trajectory }), 0.0, None, None, None);
        assert_eq!(again, Status::NullPointer);
    }
}
