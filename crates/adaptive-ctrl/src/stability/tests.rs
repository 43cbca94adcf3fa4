use super::*;
use crate::{Bounds, EffortLimits, InverseInertia};

/// Largest growth per tick of the simulated loop, from its own transition over many ticks.
fn simulated_growth(sampled: DiscreteLoop) -> f64 {
    let DiscreteLoop { damping_per_tick: d, stiffness_per_tick: p, integral_per_tick: i } = sampled;
    let (mut x, mut v, mut integral) = (1.0_f64, 0.3_f64, 0.0_f64); // v in units of 1/T
    let (mut log_growth, ticks) = (0.0, 4000);
    for _ in 0..ticks {
        let u = -(p * x + d * v) - integral;
        integral += i * x;
        x += v + 0.5 * u;
        v += u;
        let norm = x.abs() + v.abs() + integral.abs();
        log_growth += norm.ln();
        (x, v, integral) = (x / norm, v / norm, integral / norm);
    }
    (log_growth / f64::from(ticks)).exp()
}

fn grid() -> impl Iterator<Item = (f64, f64)> {
    let values = [0.003, 0.02, 0.1, 0.35, 0.8, 1.3, 1.95, 2.05, 3.0, 4.5];
    values.into_iter().flat_map(move |d| values.into_iter().map(move |p| (d, p)))
}

#[test]
fn stability_and_spectral_radius_agree_with_the_simulated_loop() {
    for (d, p) in grid() {
        let sampled = DiscreteLoop { damping_per_tick: d, stiffness_per_tick: p, integral_per_tick: 0.0 };
        let (growth, radius) = (simulated_growth(sampled), sampled.spectral_radius());
        assert!((growth / radius - 1.0).abs() < 5e-3, "d {d}, p {p}: grows by {growth}, radius {radius}");
        assert_eq!(sampled.is_stable(), radius < 1.0, "d {d}, p {p}: radius {radius}");
    }
}

#[test]
fn integral_loop_stability_agrees_with_the_simulated_loop() {
    let mut seen = [0, 0];
    for (d, p) in grid() {
        for i in [1e-4, 0.01, 0.05, 0.3, 1.0] {
            let sampled = DiscreteLoop { damping_per_tick: d, stiffness_per_tick: p, integral_per_tick: i };
            let growth = simulated_growth(sampled);
            if (growth - 1.0).abs() < 2e-3 {
                continue; // too close to the border for a simulation of this length
            }
            seen[usize::from(sampled.is_stable())] += 1;
            assert_eq!(sampled.is_stable(), growth < 1.0, "d {d}, p {p}, i {i}: grows by {growth}");
        }
    }
    assert!(seen[0] > 50 && seen[1] > 50, "one side hardly tested: {seen:?}");
}

#[test]
fn not_a_number_is_unstable() {
    for n in 0..3 {
        let mut parts = [0.2, 0.01, 0.0];
        parts[n] = f64::NAN;
        let [damping_per_tick, stiffness_per_tick, integral_per_tick] = parts;
        assert!(!DiscreteLoop { damping_per_tick, stiffness_per_tick, integral_per_tick }.is_stable());
    }
}

/// z = e^s for a pair of s with a damping ratio, and a real z beside it.
fn loop_with(ratio: f64, frequency: f64, real: Option<f64>) -> DiscreteLoop {
    let (decay, angle) = (ratio * frequency, frequency * (1.0 - ratio * ratio).sqrt());
    let (b, c) = (2.0 - 2.0 * (-decay).exp() * angle.cos(), {
        1.0 - 2.0 * (-decay).exp() * angle.cos() + (-2.0 * decay).exp()
    });
    match real {
        // w² + (d + p/2)w + p.
        None => DiscreteLoop { damping_per_tick: b - 0.5 * c, stiffness_per_tick: c, integral_per_tick: 0.0 },
        // (w + 1 − real)(w² + bw + c) = w³ + (d + p/2)w² + (p + i/2)w + i.
        Some(real) => {
            let (sum, mixed, i) = (b + 1.0 - real, c + b * (1.0 - real), c * (1.0 - real));
            let p = mixed - 0.5 * i;
            DiscreteLoop { damping_per_tick: sum - 0.5 * p, stiffness_per_tick: p, integral_per_tick: i }
        }
    }
}

#[test]
fn the_damping_ratio_is_that_of_the_motion_that_is_sampled() {
    for ratio in [0.05, 0.3, 0.5, 0.9] {
        for frequency in [1e-3, 0.05, 0.3, 0.8] {
            for real in [None, Some(0.3), Some(0.9), Some(0.9999)] {
                let found = loop_with(ratio, frequency, real).damping_ratio();
                assert!((found - ratio).abs() < 1e-6, "{found} for {ratio}, {frequency}, {real:?}");
            }
        }
    }
    let calm = DiscreteLoop { damping_per_tick: 0.3, stiffness_per_tick: 0.01, integral_per_tick: 1e-5 };
    assert_eq!(calm.damping_ratio(), 1.0, "three real eigenvalues");
    let (unstable, ringing) = (
        DiscreteLoop { stiffness_per_tick: 0.7, ..calm },
        DiscreteLoop { damping_per_tick: 1.5, stiffness_per_tick: 0.01, integral_per_tick: 0.0 },
    );
    assert!(unstable.damping_ratio() <= 0.0 && ringing.damping_ratio() < 0.5);
    assert!(
        DiscreteLoop { damping_per_tick: f64::NAN, ..calm }.damping_ratio().is_nan() || {
            DiscreteLoop { damping_per_tick: f64::NAN, ..calm }.damping_ratio() <= 0.0
        }
    );
}

/// What [`LinearLaw::check`] leans on: no joint within its range is less damped than at one of the ends.
#[test]
fn within_a_range_of_inertia_nothing_is_less_damped_than_at_its_ends() {
    let geometric = |from: f64, to: f64, count: i32| {
        (0..=count).map(move |n| from * (to / from).powf(f64::from(n) / f64::from(count)))
    };
    let mut counted = 0;
    for stiffness in geometric(1e-4, 1.0, 24) {
        for integral in [0.0].into_iter().chain(geometric(1e-8, 1e-2, 24)) {
            for (least, most) in [(0.02, 0.1), (0.05, 0.5), (0.2, 0.5), (0.02, 0.5)] {
                let ratio = |damping: f64| {
                    DiscreteLoop {
                        damping_per_tick: damping,
                        stiffness_per_tick: stiffness * damping,
                        integral_per_tick: integral * damping,
                    }
                    .damping_ratio()
                };
                let ends = ratio(least).min(ratio(most));
                if ends < MIN_DAMPING_RATIO {
                    continue;
                }
                counted += 1;
                for damping in geometric(least, most, 20) {
                    let found = ratio(damping);
                    assert!(
                        found >= MIN_DAMPING_RATIO - 1e-9,
                        "{found} at {damping}: {stiffness} {integral}"
                    );
                }
            }
        }
    }
    assert!(counted > 300, "only {counted} loops are damped at both ends");
}

#[test]
fn an_underdamped_law_is_refused_where_the_joint_is_heaviest() {
    // P ≤ D²·A_min / (1 + ½D·A_min·T) = 50/1.0025.
    let law = |stiffness, integral| LinearLaw { stiffness, damping: 10.0, integral };
    assert!(law(49.8, 0.0).check(&joint(0.001)).is_ok());
    for law in [law(50.0, 0.0), law(49.8, 5.0)] {
        let error = law.check(&joint(0.001)).unwrap_err();
        assert!(
            matches!(error, StabilityError::Underdamped { inverse_inertia, damping_ratio, .. }
                if inverse_inertia == 0.5 && damping_ratio < 0.5 && damping_ratio > 0.45),
            "{error}"
        );
    }
}

fn joint(period: f64) -> JointSpec {
    JointSpec {
        period,
        inverse_inertia: InverseInertia::try_from(Bounds { lower: 0.5, upper: 2.0 }).unwrap(),
        effort_limits: EffortLimits::symmetric(10.0).unwrap(),
    }
}

#[test]
fn damping_is_judged_where_the_joint_is_lightest() {
    let law = |damping| LinearLaw { stiffness: 1.0, damping, integral: 0.0 };
    assert!(law(250.0).check(&joint(0.001)).is_ok()); // 250·2·0.001 = 0.5
    let error = law(251.0).check(&joint(0.001)).unwrap_err();
    assert!(
        matches!(error, StabilityError::DampingTooStrong { inverse_inertia, damping_per_tick, .. }
            if inverse_inertia == 2.0 && (damping_per_tick - 0.502).abs() < 1e-12),
        "{error}"
    );
    assert!(matches!(law(f64::INFINITY).check(&joint(0.001)), Err(StabilityError::DampingTooStrong { .. })));
}

#[test]
fn stiffness_without_damping_is_unstable() {
    let law = LinearLaw { stiffness: 1e3, damping: 1e-3, integral: 0.0 };
    let error = law.check(&joint(0.01)).unwrap_err();
    assert!(matches!(error, StabilityError::Unstable { .. }), "{error}");
}

#[test]
fn integral_is_judged_where_the_joint_is_heaviest() {
    let law = |integral| LinearLaw { stiffness: 40.0, damping: 10.0, integral };
    assert!(law(25.0).check(&joint(0.001)).is_ok());
    let error = law(250.0) // K < P·D·A = 200 at A = 0.5
        .check(&joint(0.001))
        .unwrap_err();
    assert!(
        matches!(error, StabilityError::Unstable { inverse_inertia, .. } if inverse_inertia == 0.5),
        "{error}"
    );
}

#[test]
fn refuses_a_period_that_is_not_positive() {
    for period in [0.0, -0.001, f64::NAN, f64::INFINITY] {
        let law = LinearLaw { stiffness: 1.0, damping: 1.0, integral: 0.0 };
        assert!(matches!(law.check(&joint(period)), Err(StabilityError::Limits(_))), "{period}");
    }
}
