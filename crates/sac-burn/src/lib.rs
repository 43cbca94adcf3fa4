//! Soft actor-critic on burn.
#![forbid(unsafe_code)]
