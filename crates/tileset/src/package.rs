//! Packages: PMTiles files that contain payloads and a manifest.

#[cfg(feature = "write")]
mod close_up;
mod directory;
mod error;
#[cfg(not(target_arch = "wasm32"))]
mod file_package;
mod header;
mod metadata;
mod reader;
mod source;
mod tool_record;
#[cfg(feature = "write")]
mod writer;

pub use error::{OpenError, ReadError};
#[cfg(not(target_arch = "wasm32"))]
pub use file_package::FilePackage;
pub use header::telling_ranges;
pub use metadata::FORMAT_VERSION;
pub use reader::Package;
#[cfg(not(target_arch = "wasm32"))]
pub use source::{AnySource, BlockingSource, FileSource};
pub use source::{ByteSource, MemorySource, SourceError};
pub use tool_record::ToolRecord;
#[cfg(feature = "write")]
pub use writer::{PackageWriter, WriteError};
