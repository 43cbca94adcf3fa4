//! Integration tests: every file in this folder is a module of this one program.

mod adversary;
mod paper;
mod properties;
mod recovery;
mod table_file;
mod telescope;
mod tolerance;
