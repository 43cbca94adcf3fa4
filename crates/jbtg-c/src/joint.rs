//! Objects in memory that C provides.

use core::mem::{align_of, size_of};

use jbtg::{Planner, PlannerSpec, Sampler as Ticks, Trajectory};
use safezone::SafeZone;

use crate::status::Status;
use crate::types::Spec;

/// 64-bit words of `jbtg_joint`.
pub const JOINT_WORDS: usize = 320;
/// 64-bit words of `jbtg_step`.
pub const STEP_WORDS: usize = 96;
/// 64-bit words of `jbtg_sampler`.
pub const SAMPLER_WORDS: usize = 448;

/// A joint's limits, its planner and its safe zone.
#[derive(Clone, Debug)]
pub struct Joint {
    pub(crate) zone: SafeZone<'static>,
}

impl TryFrom<Spec> for Joint {
    type Error = Status;

    fn try_from(spec: Spec) -> Result<Self, Status> {
        let planner = Planner::try_from(PlannerSpec::try_from(spec)?)?;
        Ok(Self { zone: SafeZone::closed_form(planner)? })
    }
}

/// One planned step.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    pub(crate) trajectory: Trajectory,
}

/// One joint's states, tick by tick.
#[derive(Clone, Copy, Debug)]
pub struct Sampler {
    pub(crate) ticks: Ticks,
}

// The header promises this much memory, as 64-bit words.
const _: () = assert!(size_of::<Joint>() <= 8 * JOINT_WORDS && align_of::<Joint>() <= align_of::<u64>());
const _: () = assert!(size_of::<Step>() <= 8 * STEP_WORDS && align_of::<Step>() <= align_of::<u64>());
const _: () =
    assert!(size_of::<Sampler>() <= 8 * SAMPLER_WORDS && align_of::<Sampler>() <= align_of::<u64>());
