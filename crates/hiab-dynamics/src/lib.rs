//! Rigid-body dynamics of crane-like manipulators with closed cylinder loops.
#![forbid(unsafe_code)]
