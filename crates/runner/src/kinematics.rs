//! What the commands about motion alone compute: braking tables, profiles, safe ranges, adversarial runs, dynamics.
//!
//! Each function returns the text that its command prints.

mod dynamics;
mod load_chart;
mod profile;
pub mod soak;
mod tables;
mod zone;

pub use dynamics::dynamics;
pub use load_chart::{LoadChartFiles, load_chart};
pub use profile::{ProfileRequest, profile};
pub use tables::{Tables, tables};
pub use zone::{ZoneFormat, zone};
