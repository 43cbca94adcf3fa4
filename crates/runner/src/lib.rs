//! The multi-rate loop, the task, training, evaluation and recording.
#![forbid(unsafe_code)]
