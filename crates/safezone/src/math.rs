//! The one function that `core` lacks.

/// Square root, correctly rounded; NaN below zero.
#[cfg(feature = "std")]
pub(crate) fn sqrt(x: f64) -> f64 {
    x.sqrt()
}

/// Square root, correctly rounded; NaN below zero.
#[cfg(all(feature = "libm", not(feature = "std")))]
pub(crate) fn sqrt(x: f64) -> f64 {
    libm::sqrt(x)
}

/// Stands in where neither feature is on; `jbtg` refuses to build then.
#[cfg(not(any(feature = "std", feature = "libm")))]
pub(crate) fn sqrt(x: f64) -> f64 {
    x
}
