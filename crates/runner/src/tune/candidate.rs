//! Gains as points of a search: where it starts, what lies near, what a law accepts.

use adaptive_ctrl::{Gains, GainsSpec, JointSpec, PdGains, PdGainsSpec, PidGains, PidGainsSpec};
use anyhow::{Context, Result};

use crate::control::TorqueGains;
use crate::track::setup::{Law, LawGains, Stage};

/// Damping per tick of the start where a joint is lightest.
const DAMPING_PER_TICK: f64 = 0.4;

/// Largest rate of the virtual control of the start [1/s].
const RATE: f64 = 80.0;

/// Share of k₁ and k₅ that adaptation reaches, at the start, at an error of a fifth of one.
const ADAPTIVE_SHARE: f64 = 0.1;

/// Speed of both adaptive laws of the start, their leakage being 1 [1/s].
const FORGETTING: f64 = 5.0;

/// Integral gain of the start, as a share of stiffness [1/s].
const INTEGRAL_RATE: f64 = 1.0;

/// The gains that the search starts from, by the rules of `docs/control.md`, "Choosing gains"; `units` are the errors of
/// each joint that count as one.
pub(super) fn start(stage: &Stage, law: Law, units: &[(f64, f64)]) -> Result<LawGains> {
    let rule = |(spec, unit): (&JointSpec, &(f64, f64))| {
        let inertia = spec.inverse_inertia;
        let damping = DAMPING_PER_TICK / (inertia.max() * spec.period);
        let rate = RATE.min(0.9 * damping * inertia.min());
        let (k1, k5) = (2.0 * rate, 2.0 * damping);
        let z1 = 0.2 * unit.0;
        Gains::try_from(GainsSpec {
            k1,
            k2: (2.0 * ADAPTIVE_SHARE * k1).sqrt() / z1,
            k3: FORGETTING,
            k4: 1.0,
            k5,
            k6: (2.0 * ADAPTIVE_SHARE * k5).sqrt() / (rate * z1),
            k7: FORGETTING,
            k8: 1.0,
        })
    };
    let adaptive = stage.specs().iter().zip(units).map(rule).collect::<Result<Vec<_>, _>>()?;
    let plain = || adaptive.iter().map(PdGains::without_adaptation);
    Ok(match law {
        Law::Pd => LawGains::Pd(plain().collect::<Result<_, _>>()?),
        Law::Pid => {
            let gains = plain().map(|gains| {
                let PdGainsSpec { proportional, derivative } = gains?.values();
                let integral = INTEGRAL_RATE * proportional;
                PidGains::try_from(PidGainsSpec { proportional, integral, derivative })
            });
            LawGains::Pid(gains.collect::<Result<_, _>>()?)
        }
        Law::ComputedTorque | Law::ComputedTorqueExact => {
            let gains = adaptive.iter().zip(stage.specs()).map(|(gains, spec)| {
                let GainsSpec { k1, k5, .. } = gains.values();
                let damping = 0.5 * k5 * spec.inverse_inertia.min();
                TorqueGains { stiffness: 0.5 * k1 * damping, damping }
            });
            LawGains::ComputedTorque(gains.collect())
        }
        Law::Adaptive => LawGains::Adaptive(adaptive),
    })
}

/// Every gain multiplied by a factor of its own, and cut to three digits: what is tried is what a file can hold.
pub(super) fn near(gains: &LawGains, factor: &mut dyn FnMut() -> f64) -> LawGains {
    let mut scaled = |gain: f64| three_digits(gain * factor());
    // Products of positive numbers are gains unless they overflow; such a candidate stays where it was.
    match gains {
        LawGains::Adaptive(gains) => LawGains::Adaptive(
            gains
                .iter()
                .map(|&old| {
                    let GainsSpec { k1, k2, k3, k4, k5, k6, k7, k8 } = old.values();
                    let spec = GainsSpec {
                        k1: scaled(k1),
                        k2: scaled(k2),
                        k3: scaled(k3),
                        k4,
                        k5: scaled(k5),
                        k6: scaled(k6),
                        k7: scaled(k7),
                        k8,
                    };
                    Gains::try_from(spec).unwrap_or(old)
                })
                .collect(),
        ),
        LawGains::Pd(gains) => LawGains::Pd(
            gains
                .iter()
                .map(|&old| {
                    let PdGainsSpec { proportional, derivative } = old.values();
                    let spec =
                        PdGainsSpec { proportional: scaled(proportional), derivative: scaled(derivative) };
                    PdGains::try_from(spec).unwrap_or(old)
                })
                .collect(),
        ),
        LawGains::Pid(gains) => LawGains::Pid(
            gains
                .iter()
                .map(|&old| {
                    let PidGainsSpec { proportional, integral, derivative } = old.values();
                    let spec = PidGainsSpec {
                        proportional: scaled(proportional),
                        integral: scaled(integral),
                        derivative: scaled(derivative),
                    };
                    PidGains::try_from(spec).unwrap_or(old)
                })
                .collect(),
        ),
        LawGains::ComputedTorque(gains) => LawGains::ComputedTorque(
            gains
                .iter()
                .map(|old| TorqueGains { stiffness: scaled(old.stiffness), damping: scaled(old.damping) })
                .collect(),
        ),
    }
}

/// Cut, not rounded, so that nothing that a bound allows is carried over it.
fn three_digits(gain: f64) -> f64 {
    let exponent = gain.log10().floor() as i32 - 2;
    let digits = (gain / 10.0_f64.powi(exponent)).floor();
    // By way of its text, so that it is the number that a file's text means.
    format!("{digits}e{exponent}").parse().unwrap_or(gain)
}

/// The gains of `new` where `take` says so, of `old` elsewhere.
pub(super) fn mix(old: &LawGains, new: &LawGains, take: &[bool]) -> LawGains {
    fn each<G: Copy>(old: &[G], new: &[G], take: &[bool]) -> Vec<G> {
        let pairs = old.iter().zip(new).zip(take);
        pairs.map(|((&old, &new), &take)| if take { new } else { old }).collect()
    }
    match (old, new) {
        (LawGains::Adaptive(old), LawGains::Adaptive(new)) => LawGains::Adaptive(each(old, new, take)),
        (LawGains::Pd(old), LawGains::Pd(new)) => LawGains::Pd(each(old, new, take)),
        (LawGains::Pid(old), LawGains::Pid(new)) => LawGains::Pid(each(old, new, take)),
        (LawGains::ComputedTorque(old), LawGains::ComputedTorque(new)) => {
            LawGains::ComputedTorque(each(old, new, take))
        }
        _ => old.clone(),
    }
}

/// `tried`, with the joints that its law refuses as in `best`; none if it refuses them all.
pub(super) fn accepted(stage: &Stage, best: &LawGains, tried: LawGains) -> Option<LawGains> {
    let joints = stage.machine.joints().len();
    let take: Vec<bool> = (0..joints)
        .map(|joint| {
            let only: Vec<bool> = (0..joints).map(|other| other == joint).collect();
            stage.controllers(&mix(best, &tried, &only)).is_ok()
        })
        .collect();
    take.contains(&true).then(|| mix(best, &tried, &take))
}

/// Damping of every one of `JOINTS` joints in its own units; none for a law that decouples the joints by its model.
#[must_use]
pub fn damping<const JOINTS: usize>(gains: &LawGains) -> Option<[f64; JOINTS]> {
    let damping: Vec<f64> = match gains {
        LawGains::Adaptive(gains) => gains.iter().map(|gains| 0.5 * gains.values().k5).collect(),
        LawGains::Pd(gains) => gains.iter().map(|gains| gains.values().derivative).collect(),
        LawGains::Pid(gains) => gains.iter().map(|gains| gains.values().derivative).collect(),
        LawGains::ComputedTorque(_) => return None,
    };
    damping.try_into().ok()
}

/// A law's gains as RON, by joint.
pub(super) fn lines(stage: &Stage, gains: &LawGains) -> Result<String> {
    fn body<G: serde::Serialize>(names: &[&str], gains: &[G]) -> Result<String> {
        let mut text = String::new();
        for (name, gains) in names.iter().zip(gains) {
            let gains = ron::to_string(gains).context("gains have a RON form")?;
            text += &format!("        \"{name}\": {gains},\n");
        }
        Ok(text)
    }
    let names: Vec<&str> = stage.machine.joints().iter().map(|joint| joint.name.as_str()).collect();
    match gains {
        LawGains::Adaptive(gains) => body(&names, gains),
        LawGains::Pd(gains) => body(&names, gains),
        LawGains::Pid(gains) => body(&names, gains),
        LawGains::ComputedTorque(gains) => body(&names, gains),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gains_are_cut_to_what_three_digits_mean() {
        for (gain, cut) in
            [(12.789, 12.7), (2.2899, 2.28), (861_999.0, 861e3), (0.004_567, 0.004_56), (7.0, 7.0)]
        {
            assert_eq!(three_digits(gain), cut);
        }
    }
}
