//! What the commands about motion alone compute: braking tables, profiles, safe ranges, adversarial runs, dynamics,
//! tracking; and what runs there are.
//!
//! Each function returns the text that its command prints.

mod ablation;
mod dynamics;
mod load_chart;
mod profile;
mod runs;
pub mod soak;
mod tables;
mod track;
mod tune;
mod zone;

pub use ablation::{AblationRequest, ablation};
pub use dynamics::dynamics;
pub use load_chart::{LoadChartFiles, load_chart};
pub use profile::{ProfileRequest, profile};
pub use runs::{RunsFormat, runs};
pub use tables::{Tables, tables};
pub use track::{TrackRequest, track};
pub use tune::{TuneRequest, tune};
pub use zone::{ZoneFormat, zone};
