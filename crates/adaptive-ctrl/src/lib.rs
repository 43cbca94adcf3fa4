//! Adaptive robust joint control, with PD and PID baselines.
#![forbid(unsafe_code)]
