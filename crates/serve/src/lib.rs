//! A small web server for a fixed table of files, which are read by ranges of bytes.
//!
//! ```text
//!   Routes: path ─► bytes in memory, or a file on disk
//!      │
//!      ▼
//!   Server ─► a request ─► host ─► path ─► method ─► conditions ─► whole file, part of it, or why not
//! ```
//!
//! Only what is in the table is answered: a path is looked up as a word, and never joined to the path of a folder. A file on disk is
//! opened anew for each request, so that a new version gets a new `ETag`, and one that is gone is said to be gone.
//!
//! This crate never lists a folder, writes a file or follows a path that a request names, and knows no package and no tile.

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
pub use routes::{Content, Readers, Routes};
pub use server::{Answered, Server, Watch};
