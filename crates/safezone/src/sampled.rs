//! The largest velocity of [`Timing::Fastest`](jbtg::Timing) from samples: in constant time, without a root.

use jbtg::{Direction, Planner, Timing};

use crate::math::{larger, smaller};
use crate::side::{Braking, Side};
use crate::turns::Turns;

/// Samples per braking step, as many as a table has knots with [`Timing::Fastest`](jbtg::Timing).
const SAMPLES: usize = 16;

/// Knots of the braking steps that are kept; a window of samples starts at one of the first three of them.
const KEPT: usize = 3 * SAMPLES + WINDOW;

/// Knots that a solution looks at, at most.
const WINDOW: usize = SAMPLES + 5;

/// The first knot that is brought among the kept ones.
const FIRST_SHIFTED: i64 = 3 * SAMPLES as i64;

/// Velocities are told apart by their knots below so many.
const MOST_KNOTS: f64 = (1_u32 << 30) as f64;

/// Most knots from sample to sample.
const MOST_STRIDE: f64 = (1_u32 << 20) as f64;

/// Samples 0 to 16 in ascending order of the end velocity, between NaN where there is none.
type Lags = [f64; SAMPLES + 6];

/// Memory for what a [`SafeZone`](crate::SafeZone) samples, about 3 kB.
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

    /// The samples towards `side`, if there are any.
    #[inline]
    pub(crate) fn side(&self, side: Side) -> Option<&Sampled> {
        let [upper, lower] = &self.sides;
        if side == Side::Upper { upper.as_ref() } else { lower.as_ref() }
    }
}

/// What a step and braking after it cover, on the safe side of what they do.
///
/// The lag of steps is sampled at the spacing of the table's knots, from above for steps down and from below for steps up.
/// The travel until rest then is linear in the end velocity between the knots of the distance and those of the lag.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sampled {
    /// Velocity from knot to knot [rad/s or m/s].
    spacing: f64,
    per_spacing: f64,
    /// Displacement of one period at the first knot's velocity [rad or m].
    advance: f64,
    /// Displacement of the last braking step if it is the largest one [rad or m].
    last_step: f64,
    /// Largest velocity that a step may end at [rad/s or m/s].
    highest: f64,
    /// Travel until rest after the largest step up from rest [rad or m].
    from_rest: f64,
    /// Travel until rest at the knots from −16 on, in a step without a lag: one period's and the braking distance [rad or m].
    ways: [f64; SAMPLES + KEPT],
    /// Displacements beyond motion at the end velocity: of steps down, from the largest to none [rad or m].
    down: Lags,
    /// Of steps up, every `stride` knots, from none on. More than 0 there, since chords lie above what is sampled [rad or m].
    up: Lags,
    /// Knots from sample to sample of `up`.
    stride: i64,
    per_stride: f64,
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
        let stride = whole_at_least_one(largest / step)?;
        // What rounding may make of sums in which the largest step's displacement cancels.
        let margin = 16.0 * f64::EPSILON * step * period;
        let lift = braking.kink_depth(spacing);
        let mut down = [f64::NAN; SAMPLES + 6];
        let mut up = down;
        for index in 0..SAMPLES {
            down[index + 1] = brake.at((SAMPLES - index) as f64 * spacing) + lift + margin;
        }
        down[SAMPLES + 1] = 0.0;
        let wide = stride as f64 * spacing;
        let sag = climb.sag(wide) + stride as f64 * margin;
        for index in 0..=SAMPLES {
            let change = index as f64 * wide;
            // Beyond what one period can do a tangent, so that the travel goes on growing.
            let done = smaller(change, largest);
            up[index + 1] = sag - (climb.at(done) + (change - done) * climb.slope_at(largest));
        }
        let advance = period * spacing;
        let mut ways = [0.0; SAMPLES + KEPT];
        for (index, way) in ways.iter_mut().enumerate() {
            let knot = index as f64 - SAMPLES as f64;
            let beyond = if index > SAMPLES { braking.distance(knot * spacing) + lift } else { 0.0 };
            *way = knot * advance + beyond;
        }
        Some(Self {
            spacing,
            per_spacing: 1.0 / spacing,
            advance,
            last_step: brake.at(*step),
            highest: braking.velocity,
            from_rest: braking.displacement(0.0, largest) + braking.distance(largest) + lift,
            ways,
            down,
            up,
            stride,
            per_stride: 1.0 / stride as f64,
            turns: Turns::new(braking),
        })
    }

    /// The largest velocity from which braking stops within `room` [rad or m] of the start of the step from `velocity` to it
    /// [rad/s or m/s]; at most the velocity limit.
    ///
    /// Negatively infinite where the largest step down goes too far. Nothing more than that is told of velocities < 0.
    #[inline(never)]
    pub(crate) fn max_velocity(&self, velocity: f64, room: f64) -> f64 {
        if velocity <= 0.0 && room >= self.from_rest {
            return self.highest;
        }
        let knots = velocity * self.per_spacing;
        if !(knots.abs() < MOST_KNOTS) {
            return f64::NEG_INFINITY;
        }
        let (whole, below) = floor(knots);
        let start = State { velocity, whole, share: knots - whole };
        let shift = if below < FIRST_SHIFTED { Shift::NONE } else { self.shift(below) };
        smaller(self.solve(start, below - shift.knots, &shift, room), self.highest)
    }

    /// [`Sampled::max_velocity`] from the kept knot `below` on.
    #[inline]
    fn solve(&self, start: State, below: i64, shift: &Shift, room: f64) -> f64 {
        let rest = room - shift.travel;
        let way = |kept: i64| self.way(kept) + kept as f64 * shift.advance;
        let is_away = below < 0;
        let nearest = below.max(0);
        let (low, high) = (way(nearest), way(nearest + 1));
        let travel = if is_away { 0.0 } else { between(low, high, start.share) };
        let from = Point { velocity: larger(start.velocity, 0.0), travel };
        // As if steps up had no lag, which is more than they travel, but less than what samples make of small ones.
        let next = larger(start.whole + 1.0, 1.0) * self.spacing;
        let steady = if from.travel <= rest {
            from.towards(Point { velocity: next, travel: high }, rest)
        } else {
            f64::NEG_INFINITY
        };
        let (lags, first, offset) = if is_away || from.travel <= rest {
            (&self.up, below, 0.0)
        } else {
            (&self.down, below - SAMPLES as i64, -(SAMPLES as f64))
        };
        if self.stride > 1 && offset == 0.0 {
            return larger(self.between_wide_samples(start, room), steady);
        }
        let within = if shift.advance == 0.0 {
            self.within_window::<false>(lags, start, (first, offset), 0.0, rest)
        } else {
            self.within_window::<true>(lags, start, (first, offset), shift.advance, rest)
        };
        larger(within, steady)
    }

    /// Travel until rest at a kept knot, in a step that has no lag.
    #[inline]
    fn way(&self, kept: i64) -> f64 {
        let index = (kept + SAMPLES as i64).max(0) as usize;
        self.ways.get(index).map_or(f64::INFINITY, |way| *way)
    }

    /// The velocity at which the travel is `rest`, with a sample at every knot from the kept one `first` on, `offset` knots from
    /// the one below the start. `advance` is added from knot to knot if they are `SHIFTED`.
    #[inline]
    fn within_window<const SHIFTED: bool>(
        &self,
        lags: &Lags,
        start: State,
        (first, offset): (i64, f64),
        advance: f64,
        rest: f64,
    ) -> f64 {
        let index = (first + SAMPLES as i64).max(0) as usize;
        let Some(ways) = self.ways.get(index..).and_then(|kept| kept.first_chunk::<WINDOW>()) else {
            return f64::NEG_INFINITY; // There are so many from each that a start needs.
        };
        let added = first as f64 * advance;
        let way = |ways: &[f64], at: usize, index: usize| {
            let way = number(ways, at);
            if SHIFTED { way + (added + index as u32 as f64 * advance) } else { way }
        };
        let is_within = |ways: &[f64], lags: &[f64], at: usize, index: usize| {
            let lag = between(number(lags, at + 1), number(lags, at), start.share);
            usize::from(way(ways, at, index) + lag <= rest)
        };
        // First of every fourth sample, then of the three between two of those.
        let is_fourth_within = |index| is_within(ways, lags, index, index);
        let fourths =
            4 * (is_fourth_within(4) + is_fourth_within(8) + is_fourth_within(12) + is_fourth_within(16));
        let near = ways.get(fourths..).and_then(|ways| ways.first_chunk::<5>());
        let near_lags = lags.get(fourths..).and_then(|lags| lags.first_chunk::<6>());
        let (Some(ways), Some(lags)) = (near, near_lags) else {
            return f64::NEG_INFINITY; // There are so many beyond each fourth.
        };
        let is_next_within = |at| is_within(ways, lags, at, fourths + at);
        let beyond = is_next_within(1) + is_next_within(2) + is_next_within(3);
        let within = fourths + beyond;
        let float = within as u32 as f64;
        let [before, lag, after] = [beyond, beyond + 1, beyond + 2].map(|at| number(lags, at));
        let (low, high) = (way(ways, beyond, within), way(ways, beyond + 1, within + 1));
        let steps = float + offset;
        let knot = (start.whole + steps) * self.spacing;
        let below = Point { velocity: knot, travel: low + between(lag, before, start.share) };
        // A step by a whole number of samples.
        let velocity = start.velocity + steps * self.spacing;
        let middle = Point { velocity, travel: between(low, high, start.share) + lag };
        let above = Point { velocity: knot + self.spacing, travel: high + between(after, lag, start.share) };
        if middle.travel <= rest { middle.towards(above, rest) } else { below.towards(middle, rest) }
    }

    /// The same with `stride` knots from sample to sample of the steps up.
    #[inline(never)]
    fn between_wide_samples(&self, start: State, room: f64) -> f64 {
        let stride = self.stride;
        let below = start.whole as i64;
        let share = start.share * self.per_stride;
        let way = |index: i64| {
            let knot = below + index;
            let shift = if knot < FIRST_SHIFTED { Shift::NONE } else { self.shift(knot) };
            let kept = knot - shift.knots;
            shift.travel + (self.way(kept) + kept as f64 * shift.advance)
        };
        let knot = |index: i64, lag: f64| Point {
            velocity: (below + index) as f64 * self.spacing,
            travel: way(index) + lag,
        };
        let (mut within, mut end) = (0, SAMPLES + 1);
        while end - within > 1 {
            let halfway = within + (end - within) / 2;
            let [before, lag, _] = around(&self.up, halfway);
            if knot(stride * halfway as i64, between(lag, before, share)).travel <= room {
                within = halfway;
            } else {
                end = halfway;
            }
        }
        let [before, lag, after] = around(&self.up, within);
        let corner = stride * within as i64;
        let velocity = start.velocity + corner as f64 * self.spacing;
        let middle = Point { velocity, travel: between(way(corner), way(corner + 1), start.share) + lag };
        if !(middle.travel <= room) {
            return knot(corner, between(lag, before, share)).towards(middle, room);
        }
        let slope = (after - lag) * self.per_stride;
        let knot = |index: i64| knot(corner + index, lag + (index as f64 - start.share) * slope);
        let (mut low, mut high) = (0, stride);
        while high - low > 1 {
            let halfway = low + (high - low) / 2;
            if knot(halfway).travel <= room {
                low = halfway;
            } else {
                high = halfway;
            }
        }
        let from = if low == 0 { middle } else { knot(low) };
        from.towards(knot(low + 1), room)
    }

    /// Whole braking steps by which knot `index` and those that a solution from it looks at are brought among the kept ones.
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

/// The velocity at the start of a step, the knot below, and the share of the way to the next one.
#[derive(Clone, Copy, Debug)]
struct State {
    velocity: f64,
    whole: f64,
    share: f64,
}

/// Sample `index` and its neighbours; NaN where there is none.
#[inline]
fn around(lags: &Lags, index: usize) -> [f64; 3] {
    match lags.get(index..index.wrapping_add(3)) {
        Some(&[before, lag, after]) => [before, lag, after],
        _ => [f64::NAN; 3],
    }
}

/// An end velocity and the travel from the start of the step until rest.
#[derive(Clone, Copy, Debug)]
struct Point {
    velocity: f64,
    travel: f64,
}

impl Point {
    /// The velocity whose travel is `room`, on the line to a point with more; that point's if either is unknown.
    #[inline]
    fn towards(self, to: Self, room: f64) -> f64 {
        let share = (room - self.travel) / (to.travel - self.travel);
        self.velocity + (to.velocity - self.velocity) * smaller(share, 1.0)
    }
}

/// Number `index`; NaN where there is none.
#[inline]
fn number(numbers: &[f64], index: usize) -> f64 {
    numbers.get(index).map_or(f64::NAN, |number| *number)
}

#[inline]
fn between(low: f64, high: f64, share: f64) -> f64 {
    low + share * (high - low)
}

/// The largest integer below `number`, or `number` itself, or the one below it, as a number and an index.
#[inline]
fn floor(number: f64) -> (f64, i64) {
    const SHIFT: f64 = 1.5 / f64::EPSILON; // numbers of its size have no fraction
    let shifted = number - 0.5 + SHIFT;
    (shifted - SHIFT, i64::from(shifted.to_bits() as i32))
}

/// The least integer that is no less than `number` ≥ 0, and at least 1; none beyond [`MOST_STRIDE`].
fn whole_at_least_one(number: f64) -> Option<i64> {
    if !(number <= MOST_STRIDE) {
        return None;
    }
    let below = number as i64;
    Some((below + i64::from((below as f64) < number)).max(1))
}
