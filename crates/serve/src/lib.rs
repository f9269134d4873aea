//! A small web server for a fixed table of files, with range requests.
//!
//! ```text
//!   Routes: path ─► bytes in memory, or a file on disk
//!      │
//!      ▼
//!   Server ─► a request ─► host ─► path ─► method ─► conditions ─► whole file, part of it, or error
//! ```
//!
//! Only the files in the table are served: a path is looked up as a key, and never joined to
//! the path of a folder. A file on disk is reopened for each request, so that a new version gets a
//! new `ETag`, and a missing file is reported.
//!
//! This crate never lists a folder, writes a file or follows a path in a request, and has no
//! knowledge of packages and tiles.

mod answer;
mod body;
mod conditions;
mod connections;
mod error;
mod host;
mod media_type;
mod on_disk;
mod packed;
mod patience;
mod policy;
mod refusal;
mod routes;
mod server;

pub use error::ServeError;
pub use on_disk::OnDisk;
pub use routes::{FileContent, Readers, Routes};
pub use server::{Answered, Server, ServerWatch};
