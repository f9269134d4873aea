//! Packages on web servers: bytes by HTTP range requests, for threads that wait.
//!
//! ```text
//!   PackagePlace ── a file ───────────────────────────────────────────► FileSource ──► FilePackage
//!        └───────── an address ─► Web ─► HttpSource ─► blocks ─► ranges ─► HTTP ───────────┘
//!                                          (kept, read ahead)   (checked, tried again)
//! ```
//!
//! What is read comes in blocks of 64 KiB, and those that were used last are kept. Where reads follow each other, more and more is read
//! ahead, so that neighbouring ranges become one request. What fails for a moment is tried again, with growing pauses. Every answer is
//! checked: the range that was asked for, of the same version of the same file, as it is. What is not so is an error that says what to do,
//! and holds no secret.
//!
//! This crate never writes, keeps nothing on disk, and knows no tile.

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
pub use requests::Requests;
pub use secrets::without_secrets;
pub use settings::HttpSettings;
pub use source::HttpSource;
pub use web::Web;
