//! What a function says about its call.

use core::ffi::CStr;

use jbtg::{LimitsError, PlannerError, RampError, StopError};
use safezone::ZoneError;

/// What became of a call. Negative: nothing was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub enum Status {
    /// Done.
    Ok = 0,
    /// A pointer is NULL.
    NullPointer = -1,
    /// A limit, a width between two or an argument is NaN or infinite.
    NotFinite = -2,
    /// The position interval is empty or a single point.
    EmptyPosition = -3,
    /// An interval of velocity, acceleration or jerk does not hold 0 in its interior.
    ZeroNotInside = -4,
    /// The shape or the timing is none of the constants, or there are no ticks in a period.
    UnknownChoice = -5,
    /// The period is not finite and positive.
    BadPeriod = -6,
    /// The period leaves next to nothing of the acceleration limit.
    PeriodTooShort = -7,
    /// Limits and period are too many orders of magnitude apart for double precision.
    OutOfScale = -8,
    /// The position interval leaves no room to move.
    Narrow = -9,
    /// One period does not suffice for the velocity, or it is beyond its limit.
    Unreachable = -10,
}

impl Status {
    const ALL: [Self; 11] = [
        Self::Ok,
        Self::NullPointer,
        Self::NotFinite,
        Self::EmptyPosition,
        Self::ZeroNotInside,
        Self::UnknownChoice,
        Self::BadPeriod,
        Self::PeriodTooShort,
        Self::OutOfScale,
        Self::Narrow,
        Self::Unreachable,
    ];

    pub(crate) const fn text(self) -> &'static CStr {
        match self {
            Self::Ok => c"done",
            Self::NullPointer => c"a pointer is NULL",
            Self::NotFinite => c"a limit, a width between two or an argument is not finite",
            Self::EmptyPosition => c"the position interval is empty or a single point",
            Self::ZeroNotInside => c"an interval of velocity, acceleration or jerk does not hold 0 inside",
            Self::UnknownChoice => c"the shape or the timing is none of the constants, or there are no ticks",
            Self::BadPeriod => c"the period must be finite and positive",
            Self::PeriodTooShort => c"the period leaves next to nothing of the acceleration limit",
            Self::OutOfScale => c"limits and period are too many orders of magnitude apart",
            Self::Narrow => c"the position interval leaves no room to move",
            Self::Unreachable => c"the velocity cannot be reached in one period, or is beyond its limit",
        }
    }

    /// The status that C holds as a number, if it is one.
    pub(crate) fn from_number(number: i32) -> Option<Self> {
        Self::ALL.into_iter().find(|status| *status as i32 == number)
    }
}

impl From<LimitsError> for Status {
    fn from(error: LimitsError) -> Self {
        match error {
            LimitsError::NotFinite { .. } => Self::NotFinite,
            LimitsError::EmptyPosition { .. } => Self::EmptyPosition,
            LimitsError::ZeroNotInside { .. } => Self::ZeroNotInside,
        }
    }
}

impl From<PlannerError> for Status {
    fn from(error: PlannerError) -> Self {
        match error {
            PlannerError::Period { .. } => Self::BadPeriod,
            PlannerError::PeriodTooShort { .. } => Self::PeriodTooShort,
            PlannerError::OutOfScale { .. } => Self::OutOfScale,
        }
    }
}

impl From<ZoneError> for Status {
    fn from(error: ZoneError) -> Self {
        match error {
            ZoneError::Narrow { .. } => Self::Narrow,
            // The others are about tables, and there is none.
            _ => Self::OutOfScale,
        }
    }
}

impl From<RampError> for Status {
    fn from(error: RampError) -> Self {
        match error {
            RampError::NotFinite { .. } => Self::NotFinite,
            RampError::Unreachable { .. } => Self::Unreachable,
        }
    }
}

impl From<StopError> for Status {
    fn from(error: StopError) -> Self {
        match error {
            StopError::NotFinite { .. } => Self::NotFinite,
            StopError::OutOfScale => Self::OutOfScale,
        }
    }
}

/// What a safe range can promise, given where it starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub enum RangeStatus {
    /// Every limit is kept, now and for ever.
    Safe = 0,
    /// The velocity is beyond its limit. The range leads back inside; position limits are kept.
    VelocityOutside = 1,
    /// Inside, but no braking stops the joint there. The range holds nothing that goes further out than braking.
    CannotStop = 2,
    /// The position is outside its limits. The range leads back.
    PositionOutside = 3,
    /// Position or velocity is NaN or infinite. The range is the one braking velocity.
    Unknown = 4,
}

impl From<safezone::RangeStatus> for RangeStatus {
    fn from(status: safezone::RangeStatus) -> Self {
        match status {
            safezone::RangeStatus::Safe => Self::Safe,
            safezone::RangeStatus::VelocityOutside => Self::VelocityOutside,
            safezone::RangeStatus::CannotStop => Self::CannotStop,
            safezone::RangeStatus::PositionOutside => Self::PositionOutside,
            safezone::RangeStatus::Unknown => Self::Unknown,
        }
    }
}
