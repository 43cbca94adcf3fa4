//! Whatever a policy may do to a joint.

use safezone::{Command, Request};

use super::random::Random;

/// How the velocities of one spell are chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Adversary {
    /// Always the greatest safe velocity, or always the least.
    Sticky(f64),
    /// The greatest and the least in turn.
    Alternating(f64),
    /// The greatest or the least, kept for a random number of steps.
    BangBang(f64),
    /// Uniform actions.
    Uniform,
    /// An end of the range, or its neighbour one ulp inside.
    OneUlp,
    /// The velocity that the joint has, as far as it is safe.
    Hold,
    /// Missing, late, infinite and NaN actions, and actions beyond ±1, among sound ones.
    Faulty,
}

impl Adversary {
    pub(super) fn draw(random: &mut Random) -> Self {
        match random.below(9) {
            0 | 1 => Self::Sticky(random.sign()),
            2 => Self::Alternating(1.0),
            3 => Self::BangBang(1.0),
            4 => Self::Uniform,
            5 | 6 => Self::OneUlp,
            7 => Self::Hold,
            _ => Self::Faulty,
        }
    }

    /// What the policy delivers for the next step.
    #[inline]
    pub(super) fn request(&mut self, random: &mut Random) -> Request {
        Request::Action(match self {
            Self::Sticky(action) => *action,
            Self::Alternating(action) => {
                *action = -*action;
                *action
            }
            Self::BangBang(action) => {
                if random.below(16) == 0 {
                    *action = -*action;
                }
                *action
            }
            Self::Uniform => random.uniform(-1.0, 1.0),
            Self::OneUlp | Self::Hold => 0.0,
            Self::Faulty => match random.below(8) {
                0 => return Request::Missing,
                1 => return Request::Late,
                2 => f64::NAN,
                3 => random.sign() * f64::INFINITY,
                4 => random.sign() * 1e300,
                5 => random.sign() * 1.0_f64.next_up(),
                6 => random.sign() * 1.0_f64.next_down(),
                _ => random.uniform(-1.0, 1.0),
            },
        })
    }

    /// The velocity taken of those that the command's range holds.
    #[inline]
    pub(super) fn velocity(self, velocity: f64, command: &Command, random: &mut Random) -> f64 {
        let range = &command.range;
        match self {
            Self::OneUlp => match random.below(4) {
                0 => range.min,
                1 => range.min.next_up().min(range.max),
                2 => range.max.next_down().max(range.min),
                _ => range.max,
            },
            Self::Hold => velocity.max(range.min).min(range.max),
            _ => command.velocity,
        }
    }
}
