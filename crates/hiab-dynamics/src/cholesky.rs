//! Cholesky factorisation of small dense matrices, in storage that the caller owns.

/// Writes the lower factor L of the symmetric n × n `matrix` (row by row) to `factor`, with the *inverse* of each
/// pivot on its diagonal.
///
/// # Errors
/// Index and value of the first pivot that is not positive.
pub(crate) fn factorize(n: usize, matrix: &[f64], factor: &mut [f64]) -> Result<(), (usize, f64)> {
    for i in 0..n {
        let (above, row) = factor.split_at_mut(i * n);
        let (row, wanted) = (&mut row[..=i], &matrix[i * n..=i * n + i]);
        for j in 0..i {
            let other = &above[j * n..=j * n + j];
            row[j] = (wanted[j] - dot(&row[..j], &other[..j])) * other[j];
        }
        let sum = wanted[i] - dot(&row[..i], &row[..i]);
        // Not `sum <= 0`: NaN is no pivot either.
        if !(sum > 0.0 && sum < f64::INFINITY) {
            return Err((i, sum));
        }
        row[i] = 1.0 / sum.sqrt();
    }
    Ok(())
}

/// Solves L x = b in place.
pub(crate) fn forward(n: usize, factor: &[f64], x: &mut [f64]) {
    for i in 0..n {
        let row = &factor[i * n..=i * n + i];
        x[i] = (x[i] - dot(&row[..i], &x[..i])) * row[i];
    }
}

/// Solves L Lᵀ x = b in place.
pub(crate) fn solve(n: usize, factor: &[f64], x: &mut [f64]) {
    forward(n, factor, x);
    for i in (0..n).rev() {
        let row = &factor[i * n..=i * n + i];
        let value = x[i] * row[i];
        x[i] = value;
        for (earlier, entry) in x[..i].iter_mut().zip(row) {
            *earlier -= entry * value;
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |sum, (a, b)| sum + a * b)
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
