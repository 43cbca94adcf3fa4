//! The sampled velocity loops of joints that move each other.

/// Largest damping·A·period of the joints together: the spectral radius of T·D^½·M⁻¹·D^½.
///
/// `inverse_mass_matrix` is M⁻¹ at one configuration, symmetric [1/kg, 1/(kg·m), 1/(kg·m²)];
/// `damping` holds each joint's [`damping`](crate::AdaptiveController::damping) > 0 [N·s/m or
/// N·m·s/rad]; `period` is T_s in seconds. The coupled velocity loop, sampled with effort held, diverges at 2
/// and rings at more than 1, as one joint alone does; with no coupling the result is the largest of
/// the joints' own values, and it is never less than that. A controller checks its own joint only, so
/// a machine checks this at configurations over its workspace.
///
/// Not for the control loop: it finds all eigenvalues (cyclic Jacobi rotations, to rounding). NaN if
/// a number is not finite.
pub fn coupled_damping_per_tick<const N: usize>(
    inverse_mass_matrix: &[[f64; N]; N],
    damping: &[f64; N],
    period: f64,
) -> f64 {
    let mut s: [[f64; N]; N] = core::array::from_fn(|r| {
        core::array::from_fn(|c| {
            let symmetric = 0.5 * (inverse_mass_matrix[r][c] + inverse_mass_matrix[c][r]);
            period * libm::sqrt(damping[r] * damping[c]) * symmetric
        })
    });
    if s.iter().flatten().any(|x| !x.is_finite()) {
        return f64::NAN;
    }
    // Quadratic convergence: seven joints take five sweeps or six.
    for _ in 0..50 {
        let off_diagonal = |r: usize| (0..r).map(move |c| (r, c));
        let size: f64 = (0..N).map(|n| s[n][n].abs()).sum();
        if (0..N).flat_map(off_diagonal).all(|(r, c)| s[r][c].abs() <= f64::EPSILON * size) {
            break;
        }
        for (r, c) in (0..N).flat_map(off_diagonal) {
            rotate(&mut s, r, c);
        }
    }
    (0..N).map(|n| s[n][n].abs()).fold(0.0, f64::max)
}

/// One Jacobi rotation: makes `s[p][q]` zero and keeps the eigenvalues.
fn rotate<const N: usize>(s: &mut [[f64; N]; N], p: usize, q: usize) {
    if s[p][q] == 0.0 {
        return;
    }
    let theta = (s[q][q] - s[p][p]) / (2.0 * s[p][q]);
    let t = libm::copysign(1.0, theta) / (theta.abs() + libm::hypot(theta, 1.0));
    let cos = 1.0 / libm::hypot(t, 1.0);
    let sin = t * cos;
    for row in s.iter_mut() {
        (row[p], row[q]) = (cos * row[p] - sin * row[q], sin * row[p] + cos * row[q]);
    }
    let (row_p, row_q) = (s[p], s[q]);
    s[p] = core::array::from_fn(|n| cos * row_p[n] - sin * row_q[n]);
    s[q] = core::array::from_fn(|n| sin * row_p[n] + cos * row_q[n]);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joints_that_do_not_couple_count_alone() {
        let inverse = [[2.0, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 1.0]];
        let found = coupled_damping_per_tick(&inverse, &[100.0, 600.0, 50.0], 0.001);
        assert!((found - 0.3).abs() < 1e-15, "{found}");
    }

    #[test]
    fn two_joints_have_the_closed_form() {
        let (a, b, c) = (2.0, 1.5, 0.9); // M⁻¹ = [[a, c], [c, b]]
        let (d1, d2, period) = (30.0, 80.0, 0.002);
        let (trace, det) = (a * d1 + b * d2, d1 * d2 * (a * b - c * c));
        let exact = period * 0.5 * (trace + f64::sqrt(trace * trace - 4.0 * det));
        let found = coupled_damping_per_tick(&[[a, c], [c, b]], &[d1, d2], period);
        assert!((found / exact - 1.0).abs() < 1e-14, "{found} against {exact}");
    }

    #[test]
    fn seven_joints_agree_with_the_power_iteration() {
        const N: usize = 7;
        let damping: [f64; N] = core::array::from_fn(|n| 10f64.powi(n as i32));
        // M⁻¹ = diag + v·vᵀ, scaled so that every joint counts.
        let inverse: [[f64; N]; N] = core::array::from_fn(|r| {
            core::array::from_fn(|c| {
                let coupling = 0.3 * (1.0 + r as f64).sin() * (1.0 + c as f64).sin();
                let own = if r == c { 1.0 } else { 0.0 };
                (own + coupling) / (damping[r] * damping[c]).sqrt()
            })
        });
        let mut x = [1.0; N];
        let mut growth = 0.0;
        for _ in 0..2000 {
            let y: [f64; N] = core::array::from_fn(|r| {
                (0..N).map(|c| (damping[r] * damping[c]).sqrt() * inverse[r][c] * x[c]).sum()
            });
            growth = y.iter().map(|v| v * v).sum::<f64>().sqrt();
            x = y.map(|v| v / growth);
        }
        let found = coupled_damping_per_tick(&inverse, &damping, 1.0);
        assert!((found / growth - 1.0).abs() < 1e-12, "{found} against {growth}");
    }

    #[test]
    fn not_a_number_does_not_pass_for_stable() {
        assert!(coupled_damping_per_tick(&[[1.0, f64::NAN], [0.0, 1.0]], &[1.0; 2], 0.001).is_nan());
    }
}
