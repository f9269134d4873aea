//! Object storage that speaks S3: objects are read by ranges of bytes and written as a whole, and a prefix can be a store of sealed parts.
//!
//! ```text
//!  reader ─┐              ┌─ blocks (a bounded cache)
//!  place ──┴─► bucket ◄───┘
//!              │   └─► upload (one request, or many parts and an end)
//!              ▼
//!            object_store ─► watch: counts, conditions, refusals ─► HTTP
//! ```
//!
//! The methods block; a small runtime behind them does the waiting. What fails for a moment (503, a cut connection, a body that is cut off) is
//! tried again, with growing pauses. What then still fails is an error that names the object and says what to do, and holds no secret.
//!
//! This crate never changes an object: an object is written once, as a whole, or replaced as a whole. It renames nothing, because object
//! storage cannot. It knows no tile and no road.

mod address;
mod bucket;
mod error;
mod object_place;
mod reader;
mod settings;
mod upload;
mod watch;

pub use address::ObjectAddress;
pub use bucket::{Bucket, Found, Storage};
pub use corniche_blocks::BlockCache;
pub use error::ObjectError;
pub use object_place::{ObjectPlace, block_cache};
pub use reader::ObjectReader;
pub use settings::{Retries, StorageSettings};
pub use upload::Upload;
pub use watch::Requests;
