//! Integration tests: every file in this folder is a module of this one program.

mod adversary;
mod api;
mod braking;
mod lowering;
mod narrow;
mod no_allocation;
mod oracle;
mod outside;
mod paper;
mod peers;
mod properties;
mod recovery;
mod rounding;
mod sampled;
mod table_file;
mod tables;
mod telescope;
mod tolerance;
mod totality;
mod units;
