//! Errors of opening a package and of reading its tiles.

use corniche_geom::TileId;

use crate::DecodeError;
use crate::package::metadata::FORMAT_VERSION;
use crate::package::source::SourceError;

/// Why a package could not be opened or listed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OpenError {
    /// The file's name, around what is wrong with it.
    #[error("cannot use package {path:?}")]
    File {
        /// The file.
        path: std::path::PathBuf,
        /// What is wrong.
        source: Box<OpenError>,
    },
    /// Its bytes cannot be read.
    #[error(transparent)]
    Source(#[from] SourceError),
    /// It is something else.
    #[error("this is not a PMTiles file, so it is not a Corniche package")]
    NotPmtiles,
    /// It is what a failed download leaves.
    #[error("this is {found}, and not a package; {advice}")]
    StandIn {
        /// What it is.
        found: &'static str,
        /// What to do.
        advice: &'static str,
    },
    /// It is of another version of PMTiles.
    #[error("PMTiles version {found} is not supported; Corniche packages are version 3")]
    PmtilesVersion {
        /// The version it says.
        found: u8,
    },
    /// It holds something other than Corniche's tiles.
    #[error(
        "this is an ordinary PMTiles file, not a Corniche package; build one with `corniche build`"
    )]
    OrdinaryPmtiles,
    /// It was written by another version of this program.
    #[error(
        "format version {found} is not supported; this program reads version {FORMAT_VERSION}: build the package again"
    )]
    Version {
        /// The version it says.
        found: u64,
    },
    /// It ends too early.
    #[error(
        "the file is cut off: it needs {needed} bytes and has {actual}; fetch or build it again"
    )]
    Truncated {
        /// Bytes that the header speaks of.
        needed: u64,
        /// Bytes that there are.
        actual: u64,
    },
    /// A part of it makes no sense.
    #[error("the file is damaged: {what}; fetch or build it again")]
    Damaged {
        /// Which part.
        what: &'static str,
    },
    /// The manifest cannot be read.
    #[error(
        "the package's manifest is damaged, or written by another version of Corniche: {reason}; fetch or build it again"
    )]
    Manifest {
        /// What is wrong.
        reason: String,
    },
}

impl OpenError {
    /// What is wrong with a manifest, in no more of its words than are read.
    pub(crate) fn manifest(reason: impl std::fmt::Display) -> Self {
        const MOST_CHARS: usize = 500;
        let mut reason = reason.to_string();
        if let Some((end, _)) = reason.char_indices().nth(MOST_CHARS) {
            reason.truncate(end);
            reason.push_str(" …");
        }
        Self::Manifest { reason }
    }

    /// Whether nothing is known to be wrong with the package: the network or a server failed, and the same may succeed later.
    #[must_use]
    pub fn may_pass(&self) -> bool {
        match self {
            Self::File { source, .. } => source.may_pass(),
            Self::Source(error) => error.may_pass,
            _ => false,
        }
    }
}

/// Why a tile could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// Its bytes cannot be read.
    #[error("tile {tile}: {source}")]
    Source {
        /// Which tile.
        tile: TileId,
        /// Why not.
        source: SourceError,
    },
    /// The directory does not tell where it is.
    #[error("tile {tile}: {source}")]
    Directory {
        /// Which tile.
        tile: TileId,
        /// What is wrong.
        source: OpenError,
    },
    /// Its bytes are damaged.
    #[error(transparent)]
    Decode(#[from] DecodeError),
}

impl ReadError {
    /// See [`OpenError::may_pass`].
    #[must_use]
    pub fn may_pass(&self) -> bool {
        match self {
            Self::Source { source, .. } => source.may_pass,
            Self::Directory { source, .. } => source.may_pass(),
            Self::Decode(_) => false,
        }
    }
}
