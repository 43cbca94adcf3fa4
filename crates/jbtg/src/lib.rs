//! Jerk-bounded trajectories from one velocity to another in one period.
#![forbid(unsafe_code)]
