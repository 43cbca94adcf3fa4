//! The largest velocity of [`Timing::Fastest`](jbtg::Timing) from samples: in constant time, without a root.

use jbtg::{Direction, Planner, Timing};

use crate::math::{floor, larger, smaller};
use crate::side::{Braking, Side};
use crate::turns::Turns;

/// Samples per braking step, as many as a table has knots with [`Timing::Fastest`](jbtg::Timing).
const SAMPLES: usize = 16;

/// Samples of a step by at most a braking step down or up, that of none at the middle.
const NEAR: usize = 2 * SAMPLES + 1;

/// Knots before the first one.
const BEFORE: usize = 2 * SAMPLES;

/// The first knot that is brought among the kept ones.
const FIRST_SHIFTED: usize = 5 * SAMPLES;

/// Knots that are kept: so many from [`BEFORE`] on that a start before [`FIRST_SHIFTED`] has all that are near.
const KEPT: usize = BEFORE + FIRST_SHIFTED + SAMPLES;

/// Every so many samples are looked at first, and then those between two of them.
const STRIDE: usize = 4;

/// Velocities are told apart by their knots below so many.
const MOST_KNOTS: f64 = (1_u32 << 30) as f64;

/// Most knots from sample to sample.
const MOST_WIDE: f64 = (1_u32 << 20) as f64;

/// Memory for what a [`SafeZone`](crate::SafeZone) samples, about 6 kB.
///
/// The zone that [`SafeZone::sampled`](crate::SafeZone::sampled) makes borrows it, so that zones without samples stay small.
#[derive(Clone, Debug, Default)]
pub struct Samples {
    sides: [Option<Sampled>; 2],
}

impl Samples {
    /// Fills in the samples of `planner`'s joint; none with [`Timing::Stretched`], which is solved in closed form, and none where
    /// one direction is millions of times as strong as the other.
    pub(crate) fn fill(&mut self, planner: &Planner, upper: &Braking, lower: &Braking) {
        let is_fastest = planner.spec().timing == Timing::Fastest;
        self.sides = [(Side::Upper, upper), (Side::Lower, lower)]
            .map(|(side, braking)| if is_fastest { Sampled::new(planner, side, braking) } else { None });
    }

    /// The samples towards either limit, if there are any.
    pub(crate) const fn sides(&self) -> [Option<&Sampled>; 2] {
        let [upper, lower] = &self.sides;
        [upper.as_ref(), lower.as_ref()]
    }
}

/// What a step and braking after it cover, on the safe side of what they do.
///
/// The travel until rest is sampled at end velocities that differ from the start's by multiples of a sixteenth of a braking step,
/// and is linear between two of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sampled {
    /// Velocity from knot to knot [rad/s or m/s].
    spacing: f64,
    per_spacing: f64,
    /// Displacement of one period at the first knot's velocity [rad or m].
    advance: f64,
    /// Displacement of the last braking step if it is the largest one [rad or m].
    last_step: f64,
    /// Travel until rest at knots from −32 on, in a step without a lag: one period's and the braking distance [rad or m].
    ways: [f64; KEPT],
    /// What they grow by to the next knot [rad or m].
    growths: [f64; KEPT],
    /// Displacement beyond motion at the end velocity, of steps by −16 to 16 knots [rad or m].
    lags: [f64; NEAR],
    /// The same of steps up, every `wide` knots from none on.
    up: [f64; SAMPLES + 1],
    /// Knots from sample to sample of `up`, so that the last one is no less than the largest step.
    wide: i64,
    /// Where steps that change their direction turn.
    pub(crate) turns: Turns,
}

impl Sampled {
    /// The samples for `braking` towards `side`, as `planner` has it; none if they would be too far apart for steps up.
    fn new(planner: &Planner, side: Side, braking: &Braking) -> Option<Self> {
        let towards = match side {
            Side::Upper => Direction::Increasing,
            Side::Lower => Direction::Decreasing,
        };
        let Braking { step, period, brake, climb, .. } = braking;
        let spacing = step / SAMPLES as f64;
        let largest = planner.authority(towards).velocity_change;
        let wide = whole_at_least_one(largest / step)?;
        // What rounding may make of sums in which the largest step's displacement cancels.
        let margin = 16.0 * f64::EPSILON * step * period;
        let lift = braking.chord_depth(spacing);
        let mut lags = [0.0; NEAR];
        let (down, up) = lags.split_at_mut(SAMPLES);
        for (index, lag) in down.iter_mut().enumerate() {
            *lag = brake.at((SAMPLES - index) as f64 * spacing) + lift + margin;
        }
        let steps_up = |every: f64, lags: &mut [f64]| {
            let lift = climb.sag(every * spacing) + every * margin;
            for (index, lag) in lags.iter_mut().enumerate().skip(1) {
                let change = index as f64 * (every * spacing);
                // Beyond what one period can do a tangent, so that the travel goes on growing.
                let done = smaller(change, largest);
                *lag = lift - (climb.at(done) + (change - done) * climb.slope_at(largest));
            }
            // What grows from zero without a slope is not below a chord that falls from there.
            if let Some(first) = lags.get_mut(1) {
                *first = larger(*first, 0.0);
            }
        };
        steps_up(1.0, up);
        let mut up = [0.0; SAMPLES + 1];
        steps_up(wide as f64, &mut up);
        let advance = period * spacing;
        let way = |index: usize| {
            let knot = index as f64 - BEFORE as f64;
            let beyond = if index > BEFORE { braking.distance(knot * spacing) + lift } else { 0.0 };
            knot * advance + beyond
        };
        let (mut ways, mut growths) = ([0.0; KEPT], [0.0; KEPT]);
        for (index, (kept, growth)) in ways.iter_mut().zip(&mut growths).enumerate() {
            *kept = way(index);
            *growth = way(index + 1) - *kept;
        }
        Some(Self {
            spacing,
            per_spacing: 1.0 / spacing,
            advance,
            last_step: brake.at(*step),
            ways,
            growths,
            lags,
            up,
            wide,
            turns: Turns::new(braking),
        })
    }

    /// The largest velocity from which braking stops within `room` [rad or m] of the start of the step from `velocity` to it
    /// [rad/s or m/s]; no less than the largest reachable one if that does.
    ///
    /// Less than the largest step down reaches where that goes too far. Nothing more than that is told of velocities < 0.
    #[inline]
    pub(crate) fn max_velocity(&self, velocity: f64, room: f64) -> f64 {
        let knots = velocity * self.per_spacing;
        if !(-(SAMPLES as f64) < knots && knots < FIRST_SHIFTED as f64) {
            return self.far_max_velocity(velocity, room);
        }
        let (whole, index) = floor(knots);
        let window = Window::<false> {
            start: Start { velocity, whole, share: knots - whole, room },
            first: index.wrapping_add(SAMPLES as u32) as usize,
            rest: room,
            advance: 0.0,
        };
        self.solve(&window)
    }

    /// [`Sampled::max_velocity`] from a velocity whose neighbours are not among the kept knots.
    #[inline(never)]
    fn far_max_velocity(&self, velocity: f64, room: f64) -> f64 {
        let knots = velocity * self.per_spacing;
        if !(knots.abs() < MOST_KNOTS) {
            return f64::NEG_INFINITY;
        }
        let (whole, index) = floor(knots);
        let below = i64::from(index as i32);
        let start = Start { velocity, whole, share: knots - whole, room };
        if below < 0 {
            return self.between_wide_samples(start);
        }
        let shift = self.shift(below);
        let kept = below - shift.knots;
        let first = kept - SAMPLES as i64;
        let window = Window::<true> {
            start,
            first: (first + BEFORE as i64) as usize,
            rest: room - shift.travel - (first as f64 + start.share) * shift.advance,
            advance: shift.advance,
        };
        self.solve(&window)
    }

    /// The velocity at which the travel is what is left for it, among the samples near the start.
    #[inline]
    fn solve<const SHIFTED: bool>(&self, window: &Window<SHIFTED>) -> f64 {
        let ways = self.ways.get(window.first..).and_then(|kept| kept.first_chunk::<NEAR>());
        let growths = self.growths.get(window.first..).and_then(|kept| kept.first_chunk::<NEAR>());
        let (Some(ways), Some(growths)) = (ways, growths) else {
            return f64::NEG_INFINITY; // There are so many from each that a start needs.
        };
        let mut fourths = 0;
        for at in [4, 8, 12, 16, 20, 24, 28] {
            if window.travel((ways, growths, &self.lags), at) <= window.rest {
                fourths = at;
            }
        }
        let near = |numbers: &[f64]| {
            numbers.get(fourths..).and_then(|numbers| numbers.first_chunk::<{ STRIDE + 1 }>()).copied()
        };
        let (Some(ways), Some(growths), Some(lags)) = (near(ways), near(growths), near(&self.lags)) else {
            return f64::NEG_INFINITY; // There are so many from each fourth on.
        };
        let travels: [f64; STRIDE + 1] =
            core::array::from_fn(|at| window.travel((&ways, &growths, &lags), at));
        let rest = if SHIFTED { window.rest - fourths as f64 * window.advance } else { window.rest };
        let mut within = 0;
        for at in 1..STRIDE {
            if number(&travels, at) <= rest {
                within = at;
            }
        }
        let (low, high) = (number(&travels, within), number(&travels, within + 1));
        let start = window.start;
        if self.wide > 1 && high <= rest {
            return larger(start.velocity + SAMPLES as f64 * self.spacing, self.between_wide_samples(start));
        }
        // From the end that is nearer to the start, so that a small change is not the difference of two large ones.
        let nearer = within + usize::from(fourths + within < SAMPLES);
        let steps = f64::from((fourths + nearer) as i32 - SAMPLES as i32);
        let share = (rest - number(&travels, nearer)) / (high - low);
        start.velocity + (steps + smaller(share, 1.0)) * self.spacing
    }

    /// The same among the samples of steps up that are `wide` knots apart.
    #[inline(never)]
    fn between_wide_samples(&self, start: Start) -> f64 {
        let below = start.whole as i64;
        let travel =
            |index: usize| self.way(below + index as i64 * self.wide, start.share) + number(&self.up, index);
        let is_within = |index: usize| usize::from(travel(index) <= start.room);
        let fourths = STRIDE * (is_within(4) + is_within(8) + is_within(12));
        let within = fourths + is_within(fourths + 1) + is_within(fourths + 2) + is_within(fourths + 3);
        let (low, high) = (travel(within), travel(within + 1));
        let steps = within as u32 as f64 + smaller((start.room - low) / (high - low), 1.0);
        start.velocity + steps * (self.wide as f64 * self.spacing)
    }

    /// Travel until rest between knot `index` and the next one, in a step that has no lag.
    #[inline]
    fn way(&self, index: i64, share: f64) -> f64 {
        if index < 0 {
            return (index as f64 + share) * self.advance;
        }
        let shift = if index < FIRST_SHIFTED as i64 { Shift::NONE } else { self.shift(index) };
        let kept = index - shift.knots;
        let at = kept as usize + BEFORE;
        let way = number(&self.ways, at) + share * number(&self.growths, at);
        shift.travel + (kept as f64 + share) * shift.advance + way
    }

    /// Whole braking steps by which knot `index` and those that a solution from it looks at are brought among the kept ones.
    #[inline]
    fn shift(&self, index: i64) -> Shift {
        let per_step = SAMPLES as i64;
        let steps = index / per_step - 2;
        let float = steps as f64;
        let step = self.advance * SAMPLES as f64;
        Shift {
            knots: steps * per_step,
            travel: float * (step + self.last_step + 0.5 * (float - 1.0) * step),
            advance: float * self.advance,
        }
    }
}

/// What n braking steps before those at kept knots add, as [`Braking::distance`] has it.
#[derive(Clone, Copy, Debug)]
struct Shift {
    knots: i64,
    /// Travel that they add to knot 0 [rad or m].
    travel: f64,
    /// And from knot to knot [rad or m].
    advance: f64,
}

impl Shift {
    const NONE: Self = Self { knots: 0, travel: 0.0, advance: 0.0 };
}

/// A velocity at the start of a step: the knot below, the share of the way to the next one, and the room that is left.
#[derive(Clone, Copy, Debug)]
struct Start {
    velocity: f64,
    whole: f64,
    share: f64,
    room: f64,
}

/// The kept knots near a start: from `first` on, the start's own at the middle.
///
/// If they are `SHIFTED`, `advance` is added from knot to knot, and what is left for the others is `rest`.
#[derive(Clone, Copy, Debug)]
struct Window<const SHIFTED: bool> {
    start: Start,
    first: usize,
    rest: f64,
    advance: f64,
}

impl<const SHIFTED: bool> Window<SHIFTED> {
    /// Travel until rest at number `at` of `samples`, ways, their growths, and lags; from the first of them on if they are `SHIFTED`.
    #[inline]
    fn travel(&self, (ways, growths, lags): (&[f64], &[f64], &[f64]), at: usize) -> f64 {
        let lagged = number(ways, at) + number(lags, at);
        let shifted = if SHIFTED { lagged + at as f64 * self.advance } else { lagged };
        shifted + self.start.share * number(growths, at)
    }
}

/// Number `index`; NaN where there is none.
#[inline]
fn number(numbers: &[f64], index: usize) -> f64 {
    numbers.get(index).map_or(f64::NAN, |number| *number)
}

/// The least integer that is no less than `number` ≥ 0, and at least 1; none beyond [`MOST_WIDE`].
fn whole_at_least_one(number: f64) -> Option<i64> {
    if !(number <= MOST_WIDE) {
        return None;
    }
    let below = number as i64;
    Some((below + i64::from((below as f64) < number)).max(1))
}
