//! Integration tests: every file in this folder is a module of this one program.

mod adversary;
mod properties;
mod tolerance;
