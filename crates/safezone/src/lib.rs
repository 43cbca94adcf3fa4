//! Safe velocity ranges that keep a joint inside its position limits for ever.
#![forbid(unsafe_code)]
