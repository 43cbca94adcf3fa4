//! Cholesky factorisation of small dense matrices, in storage that the caller owns.

/// Writes the lower factor L of the symmetric n × n `matrix` (row by row) to `factor`, with the *inverse* of each
/// pivot on its diagonal.
///
/// # Errors
/// Index and value of the first pivot that is not positive.
pub(crate) fn factorize(n: usize, matrix: &[f64], factor: &mut [f64]) -> Result<(), (usize, f64)> {
    for i in 0..n {
        for j in 0..=i {
            let mut sum = matrix[i * n + j];
            for k in 0..j {
                sum -= factor[i * n + k] * factor[j * n + k];
            }
            if i == j {
                // Not `sum <= 0`: NaN is no pivot either.
                if !(sum > 0.0 && sum.is_finite()) {
                    return Err((i, sum));
                }
                factor[i * n + i] = 1.0 / sum.sqrt();
            } else {
                factor[i * n + j] = sum * factor[j * n + j];
            }
        }
    }
    Ok(())
}

/// Solves L x = b in place.
pub(crate) fn forward(n: usize, factor: &[f64], x: &mut [f64]) {
    for i in 0..n {
        let mut sum = x[i];
        for k in 0..i {
            sum -= factor[i * n + k] * x[k];
        }
        x[i] = sum * factor[i * n + i];
    }
}

/// Solves L Lᵀ x = b in place.
pub(crate) fn solve(n: usize, factor: &[f64], x: &mut [f64]) {
    forward(n, factor, x);
    for i in (0..n).rev() {
        let mut sum = x[i];
        for k in i + 1..n {
            sum -= factor[k * n + i] * x[k];
        }
        x[i] = sum * factor[i * n + i];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solving_undoes_multiplying() {
        let matrix = [4.0, 1.0, -2.0, 1.0, 3.0, 0.5, -2.0, 0.5, 5.0];
        let expected = [0.7, -1.3, 2.1];
        let mut x: Vec<f64> =
            matrix.chunks(3).map(|row| row.iter().zip(expected).map(|(m, e)| m * e).sum()).collect();
        let mut factor = [0.0; 9];
        factorize(3, &matrix, &mut factor).unwrap();
        solve(3, &factor, &mut x);
        for (value, expected) in x.iter().zip(expected) {
            assert!((value - expected).abs() < 1e-14, "{value} is not {expected}");
        }
    }

    #[test]
    fn refuses_an_indefinite_matrix_at_its_pivot() {
        let mut factor = [0.0; 4];
        assert_eq!(factorize(2, &[1.0, 2.0, 2.0, 1.0], &mut factor), Err((1, -3.0)));
        assert!(factorize(2, &[f64::NAN, 0.0, 0.0, 1.0], &mut factor).is_err());
    }
}
