//! Integration tests: every file in this folder is a module of this one program.

mod paper;
mod properties;
mod serde_form;
mod tolerance;
mod totality;
