//! Packages on web servers: reads bytes by HTTP range requests, for threads that block.
//!
//! ```text
//!   PackagePlace ── a file ───────────────────────────────────────────► FileSource ──► FilePackage
//!        └───────── an address ─► Web ─► HttpSource ─► blocks ─► ranges ─► HTTP ───────────┘
//!                                          (kept, read ahead)   (checked, tried again)
//! ```
//!
//! Files are read in blocks of 64 KiB, and the most recently used blocks are cached. Sequential
//! reads are read ahead, farther and farther, so that neighbouring ranges become one request.
//! Temporary failures are retried, with growing pauses. Every answer is checked: it must contain
//! the requested range, uncompressed, of the same version of the file. Otherwise the error says
//! what to do, and contains no secret.
//!
//! This crate never writes, stores nothing on disk, and does not know tiles.

mod address;
mod answer;
mod error;
mod package_place;
mod range;
mod requests;
mod secrets;
mod settings;
mod source;
mod web;

pub use address::HttpAddress;
pub use error::{AddressError, HttpError};
pub use package_place::PackagePlace;
pub use requests::ServerRequests;
pub use secrets::without_secrets;
pub use settings::HttpSettings;
pub use source::HttpSource;
pub use web::Web;
