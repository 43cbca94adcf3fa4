//! The bounds of the ramp polynomials in exact rational arithmetic, by Bernstein coefficients: a polynomial lies between
//! the least and the greatest of them, on every piece of [0, 1].

use jbtg::{Direction, Interval, Limits, LimitsSpec, Planner, PlannerSpec, Shape, Timing};
use num_rational::BigRational as Rational;

fn exact(value: f64) -> Rational {
    Rational::from_float(value).expect("a finite number")
}

fn ratio(numerator: u32, denominator: u32) -> Rational {
    exact(f64::from(numerator)) / exact(f64::from(denominator))
}

/// Bernstein coefficients on [0, 1] of c₀ + c₁u + …
fn bernstein(coefficients: &[Rational]) -> Vec<Rational> {
    let n = coefficients.len() as u32 - 1;
    let binomial = |n: u32, k: u32| (0..k).fold(ratio(1, 1), |b, i| b * ratio(n - i, i + 1));
    let sum = |i: u32| {
        (0..=i).fold(ratio(0, 1), |sum, k| sum + &coefficients[k as usize] * binomial(i, k) / binomial(n, k))
    };
    (0..=n).map(sum).collect()
}

/// Bernstein coefficients of both halves, by de Casteljau.
fn halves(coefficients: &[Rational]) -> (Vec<Rational>, Vec<Rational>) {
    let (mut row, half) = (coefficients.to_vec(), ratio(1, 2));
    let (mut left, mut right) = (Vec::new(), Vec::new());
    while let (Some(first), Some(last)) = (row.first(), row.last()) {
        left.push(first.clone());
        right.push(last.clone());
        row = row.windows(2).map(|pair| (&pair[0] + &pair[1]) * &half).collect();
    }
    right.reverse();
    (left, right)
}

/// Whether the polynomial is at least `bound` on [0, 1]: proven by the coefficients of ever smaller pieces, refuted by
/// an end of one.
fn is_at_least(coefficients: &[Rational], bound: &Rational, depth: u32) -> bool {
    let (first, last) = (&coefficients[0], &coefficients[coefficients.len() - 1]);
    if first < bound || last < bound {
        return false;
    }
    if coefficients.iter().all(|c| c >= bound) {
        return true;
    }
    assert!(depth > 0, "neither proven nor refuted");
    let (left, right) = halves(coefficients);
    is_at_least(&left, bound, depth - 1) && is_at_least(&right, bound, depth - 1)
}

#[track_caller]
fn check_range(name: &str, coefficients: &[Rational], (min, max): (&Rational, &Rational)) {
    let negative: Vec<Rational> = coefficients.iter().map(|c| -c).collect();
    assert!(is_at_least(&bernstein(coefficients), min, 40), "{name} falls below {min}");
    assert!(is_at_least(&bernstein(&negative), &-max, 40), "{name} exceeds {max}");
}

fn derivative(coefficients: &[Rational]) -> Vec<Rational> {
    (1..).zip(&coefficients[1..]).map(|(k, c)| c * ratio(k, 1)).collect()
}

/// Position, velocity, acceleration and jerk of the ramp with A = T = 1 and displacement 3/20 + e.
fn ramp(e: &Rational) -> [Vec<Rational>; 4] {
    let zero = ratio(0, 1);
    let position = vec![
        zero.clone(),
        zero.clone(),
        zero,
        e * ratio(10, 1),
        ratio(1, 4) - e * ratio(15, 1),
        e * ratio(6, 1) - ratio(1, 10),
    ];
    let velocity = derivative(&position);
    let acceleration = derivative(&velocity);
    let jerk = derivative(&acceleration);
    [position, velocity, acceleration, jerk]
}

/// arctan(1/x) between two partial sums of its alternating series.
fn arctan(x: u32) -> [Rational; 2] {
    let (x, mut power) = (ratio(1, x), ratio(1, x));
    let (mut sum, mut sums) = (ratio(0, 1), [ratio(0, 1), ratio(0, 1)]);
    for k in 0..24 {
        let term = &power / ratio(2 * k + 1, 1);
        sum = if k % 2 == 0 { sum + term } else { sum - term };
        power = power * &x * &x;
        sums[(k % 2 == 0) as usize] = sum.clone();
    }
    sums
}

/// π between two rationals, by Machin's formula.
fn pi() -> [Rational; 2] {
    let ([a_low, a_high], [b_low, b_high]) = (arctan(5), arctan(239));
    let (sixteen, four) = (ratio(16, 1), ratio(4, 1));
    [&sixteen * a_low - &four * b_high, sixteen * a_high - four * b_low]
}

/// e of the sine's ramp, 1/10 − 1/π², between two rationals.
fn sine_excess() -> [Rational; 2] {
    pi().map(|pi| ratio(1, 10) - ratio(1, 1) / (&pi * &pi))
}

#[test]
fn pi_lies_between_its_bounds() {
    let [low, high] = pi();
    assert!(low < high && &high - &low < exact(1e-32));
    let nearest = exact(std::f64::consts::PI);
    assert!(nearest < low && low < nearest + exact(1.3e-16)); // the double is 1.22e-16 too small
}

#[test]
fn the_smoothstep_keeps_its_bounds() {
    let (zero, one) = (ratio(0, 1), ratio(1, 1));
    let [position, velocity, acceleration, jerk] = ramp(&zero);
    // Not below 0, so velocity is monotone.
    check_range("acceleration", &acceleration, (&zero, &one));
    check_range("velocity", &velocity, (&zero, &ratio(1, 2)));
    check_range("jerk", &jerk, (&zero, &ratio(3, 2)));
    check_range("position", &position, (&zero, &ratio(3, 20)));
    assert_eq!(position.iter().sum::<Rational>(), ratio(3, 20));
    assert_eq!(velocity.iter().sum::<Rational>(), ratio(1, 2));
    assert_eq!(acceleration.iter().sum::<Rational>(), one);
    // The largest jerk is 3/2 and no less.
    assert!(!is_at_least(&bernstein(&jerk.iter().map(|c| -c).collect::<Vec<_>>()), &-exact(1.499_999), 40));
}

/// Linear in e, so what holds at both ends of its interval holds between.
#[test]
fn the_sine_quintic_leaves_its_ramp_by_no_more_than_the_constants_say() {
    for e in sine_excess() {
        let [position, velocity, acceleration, jerk] = ramp(&e);
        for (name, polynomial, excess, end) in [
            ("acceleration", &acceleration, 4.8924e-4, ratio(1, 1)),
            ("velocity", &velocity, 8.1201e-6, ratio(1, 2)),
            ("travel", &position, 1.7117e-7, ratio(3, 20) + &e),
        ] {
            let bound = exact(excess);
            // Position does not overshoot its end: it grows until then.
            let above = if name == "travel" { end } else { end + &bound };
            check_range(name, polynomial, (&-bound, &above));
            let less = -exact(excess * 0.999);
            assert!(!is_at_least(&bernstein(polynomial), &less, 40), "{name}: the bound is loose");
        }
        let reverse = &e * ratio(60, 1);
        check_range("jerk", &jerk, (&reverse, &(&pi()[0] / ratio(2, 1))));
        assert_eq!((&jerk[0], &jerk.iter().sum::<Rational>()), (&reverse, &reverse));
    }
}

fn planner(shape: Shape, timing: Timing, jerk: Interval) -> Planner {
    let limits = LimitsSpec {
        position: Interval::new(0.14, 0.50),
        velocity: Interval::symmetric(0.15),
        acceleration: Interval::new(-1.0, 0.7),
        jerk,
    };
    let limits = Limits::try_from(limits).expect("limits around zero");
    Planner::try_from(PlannerSpec { limits, shape, timing, period: 0.05 }).expect("a period of some ramps")
}

/// The quintics that a planner makes, their coefficients taken as the exact numbers that they are, keep the acceleration
/// limits without any allowance, and velocity and jerk to within rounding (jerk's coefficients cancel where a sine's ramp
/// ends); the velocity margin and the reverse travel cover what the polynomials do.
#[test]
fn a_planner_s_own_quintics_keep_the_limits_exactly() {
    let kinds = [Shape::Smoothstep, Shape::SineQuintic]
        .into_iter()
        .flat_map(|shape| [Timing::Stretched, Timing::Fastest].map(|timing| (shape, timing)));
    for (shape, timing) in kinds {
        // 1 to 40: the jerk that a sine's ramp begins with, against it, counts too.
        for jerk in [Interval::symmetric(100.0), Interval::new(-50.0, 2000.0), Interval::new(-2000.0, 50.0)] {
            let planner = planner(shape, timing, jerk);
            for v1 in [planner.velocity().min, 0.0, planner.velocity().max] {
                let reachable = planner.reachable(v1);
                for v2 in [reachable.min, 0.5 * (v1 + reachable.max), reachable.max] {
                    check_exactly(&planner, v1, v2);
                }
            }
        }
    }
}

#[track_caller]
fn check_exactly(planner: &Planner, v1: f64, v2: f64) {
    let limits = planner.limits();
    let step = planner.ramp(0.3, v1, v2).expect("a reachable velocity");
    for segment in step.segments() {
        let duration = exact(segment.duration());
        let mut power = ratio(1, 1);
        let mut position = Vec::new();
        for c in segment.coefficients() {
            position.push(exact(c) * &power);
            power *= &duration;
        }
        // In u = t/T a derivative is T times that in t.
        let velocity = derivative(&position);
        let acceleration = derivative(&velocity);
        let jerk = derivative(&acceleration);
        let cases = [
            ("velocity", velocity, limits.velocity(), duration.clone(), 1e-16),
            ("acceleration", acceleration, limits.acceleration(), &duration * &duration, 0.0),
            (
                "jerk",
                jerk,
                limits.jerk(),
                &duration * &duration * &duration,
                16.0 * f64::EPSILON * limits.jerk().width(),
            ),
        ];
        for (name, polynomial, limit, scale, rounding) in cases {
            let (min, max) = (exact(limit.min - rounding) * &scale, exact(limit.max + rounding) * &scale);
            check_range(name, &polynomial, (&min, &max));
        }
    }
    let direction = if v2 > v1 { Direction::Increasing } else { Direction::Decreasing };
    let travel = planner.authority(direction).reverse_travel * (v2 - v1).abs();
    if v1 == 0.0 && v2 != v1 {
        let position = step.extrema().position;
        let reverse = if v2 > v1 { 0.3 - position.min } else { position.max - 0.3 };
        assert!(reverse <= travel + 1e-16, "{reverse:e} backwards, {travel:e} announced");
    }
}
