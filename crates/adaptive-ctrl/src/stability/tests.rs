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
    assert!(law(150.0).check(&joint(0.001)).is_ok()); // K < P·D·A = 200 at A = 0.5
    let error = law(250.0).check(&joint(0.001)).unwrap_err();
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
