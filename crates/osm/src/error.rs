//! Errors that occur while an extract is read.

use std::{io, path::PathBuf};

use crate::kept_error::KeptError;

/// The reason why an extract could not be read.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum ReadOsmError {
    #[error("cannot open OSM extract {path:?}")]
    Open { path: PathBuf, source: io::Error },
    #[error("cannot read OSM extract {path:?}")]
    Read { path: PathBuf, source: io::Error },
    #[error(
        "{path:?} is {found}, not a file; the extract is read several times, so pass a regular file"
    )]
    NotAFile { path: PathBuf, found: &'static str },
    #[error("OSM extract {path:?} is empty (0 bytes); download it again")]
    Empty { path: PathBuf },
    #[error("{path:?} is {found}, not .osm.pbf; {advice}")]
    NotPbf { path: PathBuf, found: &'static str, advice: &'static str },
    #[error(
        "OSM extract {path:?} is truncated: the blob at byte {offset} should end at byte {end}, but the file ends \
         at {len_bytes}; download it again"
    )]
    Truncated { path: PathBuf, offset: u64, end: u64, len_bytes: u64 },
    #[error("OSM extract {path:?} is corrupt at byte {offset}: {reason}; download it again")]
    Damaged { path: PathBuf, offset: u64, reason: String },
    #[error(
        "OSM extract {path:?} is compressed with {method}, which is not supported; \
         rewrite it with: osmium cat IN.osm.pbf -o OUT.osm.pbf -f pbf,pbf_compression=zlib"
    )]
    Compression { path: PathBuf, method: &'static str },
    #[error(
        "OSM extract {path:?} is a history file, a change file or a merge of several, not a snapshot of one point \
         in time: {reason}; for a history file, extract one point in time: \
         osmium time-filter IN.osh.pbf 2026-01-01T00:00:00Z -o OUT.osm.pbf; for a change file, apply it to its extract: \
         osmium apply-changes IN.osm.pbf CHANGES.osc.pbf -o OUT.osm.pbf"
    )]
    History { path: PathBuf, reason: String },
    #[error(
        "OSM extract {path:?} requires the feature {feature:?}, which is not supported; \
         rewrite it with a program that supports this feature: osmium cat IN.osm.pbf -o OUT.osm.pbf"
    )]
    Feature { path: PathBuf, feature: String },
    #[error(
        "OSM extract {path:?} unpacks to more roads than a file of {len_bytes} bytes can plausibly contain: it may be designed \
         to fill memory and disk; if the file is correct, rewrite it without compression: \
         osmium cat IN.osm.pbf -o OUT.osm.pbf -f pbf,pbf_compression=none"
    )]
    TooMuch { path: PathBuf, len_bytes: u64 },
    #[error(
        "cannot write intermediate data of OSM extract {path:?} to disk, or read it back{}",
        corniche_store::LackOfRoom::advice(corniche_store::LackOfRoom::from_io_error(.source))
    )]
    Scratch { path: PathBuf, source: io::Error },
    #[error("cannot read or write the intermediate results of the chunks of OSM extract {path:?}")]
    Kept { path: PathBuf, source: KeptError },
    #[error("{expected} positions were passed to the lattice conversion, but {got} came back")]
    Place { expected: usize, got: usize },
    #[error("reading OSM extract {path:?} was stopped")]
    Stopped { path: PathBuf },
}
