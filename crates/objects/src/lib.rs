//! Access to S3 object storage: reads objects by byte ranges, writes whole objects, and stores
//! sealed parts under a prefix.
//!
//! ```text
//!  reader ─┐              ┌─ blocks (a bounded cache)
//!  place ──┴─► bucket ◄───┘
//!              │   └─► upload (one request, or many parts and an end)
//!              ▼
//!            object_store ─► watch: counts, conditions, refusals ─► HTTP
//! ```
//!
//! The methods block; a small runtime behind them waits for the network. Temporary failures (503, a
//! broken connection, a truncated body) are retried, with growing pauses. After the last try, the
//! error names the object, says what to do, and contains no secret.
//!
//! This crate never modifies an object: it writes an object once as a whole, or replaces it as a
//! whole. It renames nothing, because object storage cannot rename. It knows neither tiles nor
//! roads.

mod address;
mod bucket;
mod error;
mod object_place;
mod reader;
mod settings;
mod upload;
mod watch;

pub use address::ObjectAddress;
pub use bucket::{Bucket, ObjectInfo, Storage};
pub use corniche_blocks::BlockCache;
pub use error::ObjectError;
pub use object_place::{ObjectPlace, block_cache};
pub use reader::ObjectReader;
pub use settings::{Retries, StorageSettings};
pub use upload::Upload;
pub use watch::StorageRequests;
