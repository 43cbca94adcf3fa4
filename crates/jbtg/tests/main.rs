//! Integration tests: every file in this folder is a module of this one program.

mod api;
mod bernstein;
mod braking;
mod interruption;
mod issues;
mod no_allocation;
mod optimum;
mod overshoot;
mod paper;
mod peers;
mod properties;
mod refusals;
mod sampler;
mod serde_form;
mod standstill;
mod stop;
mod support;
mod synchronized;
mod tolerance;
mod totality;
mod waypoint;
