//! [P, Alg. 3]: from one velocity to another in one period, through the largest or smallest peak velocity on the way.
//!
//! Where the paper's text cannot be meant as it stands:
//! - Case 2.1 says that a ramp from v₁ to v₂ in *less* than dt leaves no room for a detour. It is *not less*.
//! - Case 2.2 compares v_max − v₂ with dV_min and leaves open v_max − v₂ = dV_min and dt = dt_limit. Whether the ramp
//!   from v₁ to v_peak is a MSAP depends on v_max − v₁ and dt as well, with a dt_limit of its own: MAP then MSAP is
//!   possible where v₂ < v₁.
//! - Case 2.2b ("a ramp from v₁ to v₂, followed by a pulse from v₂ to v_peak and back") gives the v_peak of the one
//!   ramp from v₁ to v_peak only if that ramp is a MSAP throughout. A MAP to v_peak takes another time than one to v₂
//!   and one from there. Here v_peak solves for the whole time.
//! - Case 2.3a needs the ramp down from v_peak = v_max to v₂ too.
//! - Case 1 with v₂ < v₁ = v_max: the cruise comes before the ramp, or the displacement is not the largest.
//! - The footnote's negations leave v₁ < 0 < v₂ and v₂ = 0 open. Here only the direction counts.

mod ease;
mod family;

pub(crate) use family::Family;

use crate::math::sqrt;
use crate::pulse::{Bounds, Direction, Pulse};
use crate::segment::{Ramp, Segment, State};
use crate::shape::ShapeConstants;
use crate::{Interval, Shape, Trajectory};

/// Excess over the period that shortening all ramps may take back: far below the distance that pulses keep from their
/// bounds.
const OVERTIME: f64 = 2e-15;

/// Time at the peak velocity, as a share of the period, that is not worth a segment: the ramps take it.
const SHORTEST_CRUISE: f64 = 1e-13;

/// Which case of [P, Alg. 3] a motion from v₁ to v₂ is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DetourCase {
    /// Case 1: v₁ ≠ v₂ and no detour, since one of them is the velocity limit or the ramp takes the whole period.
    One,
    /// Case 2: v₁ ≠ v₂ through a velocity beyond both.
    Two,
    /// Case 3: v₁ = v₂, held, since it is the velocity limit.
    Three,
    /// Case 4: v₁ = v₂ through a velocity beyond it.
    Four,
}

/// What one ramp between two velocities is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PulseKind {
    /// Two acceleration ramps with a cruise at the acceleration limit between them, [P, Alg. 1].
    Msap,
    /// Two acceleration ramps alone, [P, Alg. 2].
    Map,
}

/// How [`Planner::waypoint`](crate::Planner::waypoint) gets from one velocity to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detour {
    /// Case of [P, Alg. 3].
    pub case: DetourCase,
    /// v_peak, the velocity between both ramps [rad/s or m/s].
    pub peak: f64,
    /// Ramp from v₁ to v_peak, if they differ.
    pub rise: Option<PulseKind>,
    /// Time at v_peak \[s\].
    pub cruise: f64,
    /// Ramp from v_peak to v₂, if they differ.
    pub fall: Option<PulseKind>,
}

/// All that detours towards one direction need.
#[derive(Clone, Copy, Debug)]
struct Side {
    /// Pulses from v₁ to v_peak.
    rise: Family,
    /// Pulses from v_peak to v₂.
    fall: Family,
}

/// All that a planner's detours need.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DetourLimits {
    /// Velocity bounds, tightened by what the shape's velocity overshoots in the quickest pulses.
    velocity: Interval,
    up: Side,
    down: Side,
}

/// A detour in the frame in which v_peak is the largest velocity.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plan {
    pub(crate) peak: f64,
    rise: Option<Pulse>,
    cruise: f64,
    fall: Option<Pulse>,
    displacement: f64,
}

impl DetourLimits {
    pub(crate) fn new(up: Bounds, down: Bounds, limits: Interval, shape: Shape, period: f64) -> Self {
        let towards = |rise, fall| Side {
            rise: Family::towards_peak(rise, shape, period),
            fall: Family::from_peak(fall, shape, period),
        };
        let (up, down) = (towards(up, down), towards(down, up));
        let margin = [up.rise, up.fall, down.rise, down.fall]
            .iter()
            .map(|family| family.overshoot(limits.width()))
            .fold(0.0, f64::max);
        Self { velocity: Interval::new(limits.min + margin, limits.max - margin), up, down }
    }

    /// The detour from `v1` to `v2` through the velocity that lies farthest in `direction`; all in the frame in which
    /// that is upwards. `None` where only the direct step will do.
    #[inline]
    pub(crate) fn plan(&self, (v1, v2): (f64, f64), direction: Direction, period: f64) -> Option<Plan> {
        let (side, velocity) = match direction {
            Direction::Increasing => (&self.up, self.velocity),
            Direction::Decreasing => (&self.down, self.velocity.mirrored()),
        };
        if !(velocity.contains(v1) && velocity.contains(v2)) {
            return None;
        }
        let peak = side.peak((v1, v2), velocity.max, period)?;
        Some(side.through(peak, (v1, v2), period))
    }

    /// The same with the largest displacement in `direction`, whichever its peak velocity.
    pub(crate) fn plan_farthest(&self, ends: (f64, f64), direction: Direction, period: f64) -> Option<Plan> {
        let plan = self.plan(ends, direction, period)?;
        let (side, highest) = match direction {
            Direction::Increasing => (&self.up, self.velocity.max),
            Direction::Decreasing => (&self.down, -self.velocity.min),
        };
        let eased = side.eased(ends, highest, period).and_then(|side| {
            let peak = side.peak(ends, highest, period)?;
            Some(side.through(peak, ends, period))
        });
        Some(eased.filter(|eased| eased.displacement > plan.displacement).unwrap_or(plan))
    }
}

impl Side {
    /// Least time from `v1` to `v2` through `peak` \[s\].
    #[inline]
    fn time(&self, (v1, v2): (f64, f64), peak: f64) -> f64 {
        self.rise.time(peak - v1) + self.fall.time(peak - v2)
    }

    /// The largest velocity up to `highest` that leaves time for `v2`. `None` if there is not even time to get there
    /// directly.
    ///
    /// The time grows with v_peak: linearly where a pulse has an acceleration cruise, with the square root where it has
    /// none. So v_peak is the root of an equation of first or second degree.
    #[inline]
    fn peak(&self, ends: (f64, f64), highest: f64, period: f64) -> Option<f64> {
        if self.time(ends, highest) <= period {
            return Some(highest); // Cases 2.2a-i, 2.3a and their like in case 4.
        }
        let latest = period * (1.0 + OVERTIME);
        let mut peak = self.peak_in_time(ends, period).min(highest);
        for _ in 0..4 {
            if self.time(ends, peak) <= latest {
                return Some(peak.max(ends.0.max(ends.1)));
            }
            peak = peak.next_down(); // v_peak is rounded to an ulp of v₁ and v₂, which may be much in time.
        }
        let direct = ends.0.max(ends.1);
        (self.time(ends, direct) <= latest).then_some(direct)
    }

    /// The v_peak that takes exactly `period`, up to rounding.
    #[inline]
    fn peak_in_time(&self, ends: (f64, f64), period: f64) -> f64 {
        let Self { rise, fall } = self;
        let (v1, v2) = ends;
        let higher = v1.max(v2);
        // The comparison of dt with dt_limit, once for each ramp.
        let is_msap = |limit: f64| limit <= higher || self.time(ends, limit) <= period;
        let (rise_limit, fall_limit) = (v1 + rise.full_from, v2 + fall.full_from);
        let full = |family: &Family| 0.5 * (family.ramp_up + family.ramp_down);
        match (is_msap(rise_limit), is_msap(fall_limit)) {
            (true, true) => {
                let direct = full(rise)
                    + full(fall)
                    + (higher - v1) / rise.acceleration
                    + (higher - v2) / fall.acceleration;
                higher + (period - direct) / (1.0 / rise.acceleration + 1.0 / fall.acceleration)
            }
            (true, false) => {
                let time = period - full(rise) - (v2 - v1) / rise.acceleration;
                v2 + mixed(time, rise.acceleration, fall.slowness)
            }
            (false, true) => {
                let time = period - full(fall) - (v1 - v2) / fall.acceleration;
                v1 + mixed(time, fall.acceleration, rise.slowness)
            }
            (false, false) if v1 >= v2 => {
                v1 + both_maps(0.5 * period, (rise.slowness, fall.slowness), v1 - v2)
            }
            (false, false) => v2 + both_maps(0.5 * period, (fall.slowness, rise.slowness), v2 - v1),
        }
    }

    /// The motion through `peak`, which there is time for.
    #[inline]
    fn through(&self, peak: f64, (v1, v2): (f64, f64), period: f64) -> Plan {
        let time = self.time((v1, v2), peak);
        let spare = period - time;
        let (stretch, cruise) =
            if spare > SHORTEST_CRUISE * period || time == 0.0 { (1.0, spare) } else { (period / time, 0.0) };
        let pulse = |family: &Family, change: f64| (change > 0.0).then(|| family.pulse(change, stretch));
        let (rise, fall) = (pulse(&self.rise, peak - v1), pulse(&self.fall, peak - v2));
        let lag = rise.map_or(0.0, |pulse| self.rise.lag(&pulse));
        let lead = fall.map_or(0.0, |pulse| self.fall.lead(&pulse));
        Plan { peak, rise, cruise, fall, displacement: peak * period - (lag + lead) }
    }
}

/// The y² that solves y²/a + 2y·√s = `time`: a MAP's velocity change beside a MSAP at acceleration `a`.
#[inline]
fn mixed(time: f64, a: f64, s: f64) -> f64 {
    let time = time.max(0.0);
    let root = time / (sqrt(s) + sqrt(s + time / a));
    root * root
}

/// The y² that solves √s·y + √(r·(y² + d)) = `half`, d ≥ 0: the smaller velocity change of two MAPs that differ by d.
#[inline]
fn both_maps(half: f64, (s, r): (f64, f64), d: f64) -> f64 {
    let square = half * half;
    let rest = (square - r * d).max(0.0);
    let root = rest / (half * sqrt(s) + sqrt((r * (square + (s - r) * d)).max(0.0)));
    root * root
}

impl Plan {
    pub(crate) fn detour(&self, (v1, v2): (f64, f64)) -> Detour {
        let is_direct = self.peak <= v1.max(v2);
        let case = match (v1 == v2, is_direct) {
            (false, true) => DetourCase::One,
            (false, false) => DetourCase::Two,
            (true, true) => DetourCase::Three,
            (true, false) => DetourCase::Four,
        };
        let kind = |pulse: Pulse| if pulse.cruise > 0.0 { PulseKind::Msap } else { PulseKind::Map };
        Detour {
            case,
            peak: self.peak,
            rise: self.rise.map(kind),
            cruise: self.cruise,
            fall: self.fall.map(kind),
        }
    }

    /// The motion, from (position, v1) to v2.
    pub(crate) fn trajectory(
        &self,
        position: f64,
        (v1, v2): (f64, f64),
        period: f64,
        shape: &ShapeConstants,
    ) -> Trajectory {
        let end =
            State { position: position + self.displacement, velocity: v2, acceleration: 0.0, jerk: 0.0 };
        let mut chain = Chain { trajectory: Trajectory::unfilled(period, end), time: 0.0, position, shape };
        if let Some(pulse) = self.rise {
            chain.pulse(v1, &pulse, 1.0);
        }
        if self.cruise > 0.0 {
            chain.cruise(self.peak, 0.0, self.cruise);
        }
        if let Some(pulse) = self.fall {
            chain.pulse(self.peak, &pulse, -1.0);
        }
        chain.trajectory
    }
}

/// A trajectory that grows segment by segment.
struct Chain<'a> {
    trajectory: Trajectory,
    time: f64,
    position: f64,
    shape: &'a ShapeConstants,
}

impl Chain<'_> {
    fn pulse(&mut self, velocity: f64, pulse: &Pulse, sign: f64) {
        let Pulse { ramp_up, cruise, ramp_down, .. } = *pulse;
        let a = sign * pulse.acceleration;
        let displacement = self.shape.displacement;
        self.push(velocity, (Ramp::Rising, a), ramp_up);
        self.position += ramp_up * (velocity + displacement * a * ramp_up);
        let mut velocity = velocity + 0.5 * a * ramp_up;
        if cruise > 0.0 {
            self.cruise(velocity, a, cruise);
            velocity += a * cruise;
        }
        self.push(velocity, (Ramp::Falling, a), ramp_down);
        self.position += ramp_down * (velocity + (0.5 - displacement) * a * ramp_down);
    }

    fn cruise(&mut self, velocity: f64, acceleration: f64, duration: f64) {
        self.push(velocity, (Ramp::Constant, acceleration), duration);
        self.position += duration * (velocity + 0.5 * acceleration * duration);
    }

    fn push(&mut self, velocity: f64, ramp: (Ramp, f64), duration: f64) {
        let segment = Segment::new(self.time, duration, (self.position, velocity), ramp, self.shape);
        self.trajectory.push(segment);
        self.time += duration;
    }
}
