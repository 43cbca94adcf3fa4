//! The one function that `core` lacks, and three that cost less than its own.

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

/// `f64::min` in one instruction; a NaN `b` stays.
#[inline]
pub(crate) fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// `f64::max` in one instruction; a NaN `b` stays.
#[inline]
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The largest integer below `number`, or `number` itself, or the one below it; the second time modulo 2³².
///
/// For numbers of a size below 2⁵¹.
#[inline]
pub(crate) fn floor(number: f64) -> (f64, u32) {
    const SHIFT: f64 = 1.5 / f64::EPSILON; // numbers of its size have no fraction
    let shifted = number - 0.5 + SHIFT;
    (shifted - SHIFT, shifted.to_bits() as u32)
}
