//! Errors of reading an extract.

use std::{io, path::PathBuf};

use crate::kept_error::KeptError;

/// Why an extract could not be read.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum ReadOsmError {
    #[error("cannot open OSM extract {path:?}")]
    Open { path: PathBuf, source: io::Error },
    #[error("cannot read OSM extract {path:?}")]
    Read { path: PathBuf, source: io::Error },
    #[error("{path:?} is {found}, not a file; it is read more than once, so give it as a file")]
    NotAFile { path: PathBuf, found: &'static str },
    #[error("OSM extract {path:?} is empty (0 bytes); fetch it again")]
    Empty { path: PathBuf },
    #[error("{path:?} is {found}, not .osm.pbf; {advice}")]
    NotPbf { path: PathBuf, found: &'static str, advice: &'static str },
    #[error(
        "OSM extract {path:?} is cut off: its part at byte {offset} should reach byte {end}, the file ends at {len_bytes}; \
         fetch it again"
    )]
    Truncated { path: PathBuf, offset: u64, end: u64, len_bytes: u64 },
    #[error(
        "OSM extract {path:?} is damaged in its part at byte {offset}: {reason}; fetch it again"
    )]
    Damaged { path: PathBuf, offset: u64, reason: String },
    #[error(
        "OSM extract {path:?} is compressed with {method}, which is not supported; \
         rewrite it with: osmium cat IN.osm.pbf -o OUT.osm.pbf -f pbf,pbf_compression=zlib"
    )]
    Compression { path: PathBuf, method: &'static str },
    #[error(
        "OSM extract {path:?} is a history or change file, or one of several merged, not one point in time: {reason}; of a \
         history take one point in time: osmium time-filter IN.osh.pbf 2026-01-01T00:00:00Z -o OUT.osm.pbf; apply changes to \
         the extract that they belong to: osmium apply-changes IN.osm.pbf CHANGES.osc.pbf -o OUT.osm.pbf"
    )]
    History { path: PathBuf, reason: String },
    #[error(
        "OSM extract {path:?} requires the feature {feature:?}, which is not supported; \
         rewrite it with a program that knows it: osmium cat IN.osm.pbf -o OUT.osm.pbf"
    )]
    Feature { path: PathBuf, feature: String },
    #[error(
        "OSM extract {path:?} unpacks to more roads than a file of {len_bytes} bytes can plausibly hold: it may be made to \
         fill memory and disk; if the file is correct, rewrite it without compression: \
         osmium cat IN.osm.pbf -o OUT.osm.pbf -f pbf,pbf_compression=none"
    )]
    TooMuch { path: PathBuf, len_bytes: u64 },
    #[error(
        "cannot keep on disk what is read of OSM extract {path:?}, or read it back{}",
        corniche_store::LackOfRoom::advice(corniche_store::LackOfRoom::of(.source))
    )]
    Scratch { path: PathBuf, source: io::Error },
    #[error("what is kept of OSM extract {path:?} in shares cannot be read or written")]
    Kept { path: PathBuf, source: KeptError },
    #[error("{expected} positions were given to be placed on the lattice, but {got} came back")]
    Place { expected: usize, got: usize },
    #[error("reading OSM extract {path:?} was stopped")]
    Stopped { path: PathBuf },
}
