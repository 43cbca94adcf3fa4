//! Adversaries: whatever a policy may do to a joint, and a joint that suffers it.

use jbtg::{Extrema, Interval, Limits};
use proptest::prelude::*;
use safezone::{RangeStatus, Request, SafeZone, Side};

use crate::tolerance;

/// How the requests of one run are chosen.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Adversary {
    AlwaysMax,
    AlwaysMin,
    /// Max and min in turn.
    Alternating,
    /// Uniform actions.
    Random,
    /// Max or min, kept for a random number of steps.
    BangBang,
    /// Actions within 1e-12 of ±1 and beyond.
    NearBound,
    /// Everything above, mixed with zero, missing, late and non-finite actions.
    Faulty,
}

pub(crate) const ADVERSARIES: [Adversary; 7] = {
    use Adversary::{Alternating, AlwaysMax, AlwaysMin, BangBang, Faulty, NearBound, Random};
    [AlwaysMax, AlwaysMin, Alternating, Random, BangBang, NearBound, Faulty]
};

pub(crate) fn adversaries() -> impl Strategy<Value = Adversary> {
    prop::sample::select(ADVERSARIES.to_vec())
}

/// SplitMix64: deterministic, so that a failing case is its seed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Noise(pub(crate) u64);

impl Noise {
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn sign(&mut self) -> f64 {
        if self.bits() & 1 == 0 { 1.0 } else { -1.0 }
    }
}

impl Adversary {
    fn request(self, step: usize, previous: f64, noise: &mut Noise) -> Request {
        Request::Action(match self {
            Self::AlwaysMax => 1.0,
            Self::AlwaysMin => -1.0,
            Self::Alternating if step.is_multiple_of(2) => 1.0,
            Self::Alternating => -1.0,
            Self::Random => 2.0 * noise.unit() - 1.0,
            Self::BangBang if noise.unit() < 0.05 || previous == 0.0 => noise.sign(),
            Self::BangBang => previous,
            Self::NearBound => noise.sign() * (1.0 + 1e-12 * (noise.unit() - 0.75)),
            Self::Faulty => match noise.bits() % 9 {
                0 => return Request::Missing,
                1 => return Request::Late,
                2 => f64::NAN,
                3 => f64::INFINITY,
                4 => f64::NEG_INFINITY,
                5 => 0.0,
                6 => 2.0 * noise.unit() - 1.0,
                _ => noise.sign(),
            },
        })
    }
}

/// A safe state: position and velocity from which braking stops inside the limits.
///
/// `shares` in [0, 1] place the velocity in its interval and the position in what is safe at that velocity; 0
/// and 1 are the very ends. Where the interval lies so far from 0 that rounding a braking manoeuvre's positions can reach
/// the bar, the ends are those that the zone itself keeps to, its guard away from the limits.
pub(crate) fn safe_state(zone: &SafeZone<'_>, (velocity, position): (f64, f64)) -> (f64, f64) {
    let bounds = zone.planner().velocity();
    let limits = zone.planner().limits().position();
    let is_far = limits.min.abs().max(limits.max.abs()) > 10.0 * limits.width();
    let guard = |side| if is_far { zone.guard(side) } else { 0.0 };
    let limits = Interval::new(limits.min + guard(Side::Lower), limits.max - guard(Side::Upper));
    let mut velocity = bounds.clamp(bounds.min + velocity * bounds.width());
    loop {
        let distance = zone.stopping_distance(velocity);
        let inside = if velocity > 0.0 {
            Interval::new(limits.min, limits.max - distance)
        } else {
            Interval::new(limits.min + distance, limits.max)
        };
        if inside.min <= inside.max {
            return (inside.clamp(inside.min + position * inside.width()), velocity);
        }
        velocity *= 0.5;
    }
}

/// Largest excess over a limit, relative to its interval's width.
pub(crate) fn worst_excess(extrema: &Extrema, limits: &Limits) -> f64 {
    let pairs = [
        (extrema.position, limits.position()),
        (extrema.velocity, limits.velocity()),
        (extrema.acceleration, limits.acceleration()),
        (extrema.jerk, limits.jerk()),
    ];
    let excess = |(found, limit): (Interval, Interval)| {
        (found.max - limit.max).max(limit.min - found.min) / limit.width()
    };
    pairs.into_iter().map(excess).fold(f64::NEG_INFINITY, f64::max)
}

/// Runs `steps` adversarial steps from a safe state and returns the worst relative excess, or what broke.
pub(crate) fn run(
    zone: &SafeZone<'_>,
    (mut position, mut velocity): (f64, f64),
    (adversary, seed): (Adversary, u64),
    steps: usize,
) -> Result<f64, String> {
    let mut noise = Noise(seed);
    let (mut previous, mut worst) = (0.0, f64::NEG_INFINITY);
    for step in 0..steps {
        let request = adversary.request(step, previous, &mut noise);
        if let Request::Action(action) = request {
            previous = action;
        }
        let command = zone.command(position, velocity, request);
        let range = command.range;
        let at = format_args!("step {step} from ({position:e}, {velocity:e})").to_string();
        if range.status != RangeStatus::Safe {
            return Err(format!("{at}: {range:?}"));
        }
        if !(range.min <= range.brake && range.brake <= range.max && range.contains(command.velocity)) {
            return Err(format!("{at}: {command:?}"));
        }
        let brakes = if velocity >= 0.0 { range.brake >= 0.0 } else { range.brake <= 0.0 };
        if !brakes || range.brake.abs() > velocity.abs() {
            return Err(format!("{at}: not braking, {range:?}"));
        }
        let ramp = zone.planner().ramp(position, velocity, command.velocity);
        let ramp = ramp.map_err(|error| format!("{at}: {error}"))?;
        let excess = worst_excess(&ramp.extrema(), zone.planner().limits());
        if excess.is_nan() || excess > tolerance::LIMIT {
            let extrema = ramp.extrema();
            return Err(format!(
                "{at}: limit exceeded by {excess:e} of its interval: {extrema:?}, {command:?}"
            ));
        }
        worst = worst.max(excess);
        (position, velocity) = (ramp.end().position, ramp.end().velocity);
    }
    Ok(worst)
}
