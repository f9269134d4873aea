//! Errors of opening a package and of reading its tiles.

use corniche_geom::TileId;

use crate::{
    DecodeError,
    package::{metadata::FORMAT_VERSION, source::SourceError},
};

/// Why a package could not be opened or listed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OpenError {
    /// Adds the name of the file to an error.
    #[error("{}", not_usable(.path, .source))]
    File {
        /// The file.
        path: std::path::PathBuf,
        /// The error.
        source: Box<OpenError>,
    },
    /// The bytes of the package cannot be read.
    #[error(transparent)]
    Source(#[from] SourceError),
    /// The file is not a PMTiles file.
    #[error("this is not a PMTiles file, so it is not a Corniche package")]
    NotPmtiles,
    /// The file is the result of a failed download.
    #[error("this is {found}, not a package; {advice}")]
    StandIn {
        /// What the file is.
        found: &'static str,
        /// Advice for the user.
        advice: &'static str,
    },
    /// The file has another version of PMTiles.
    #[error("PMTiles version {found} is not supported; Corniche packages are version 3")]
    PmtilesVersion {
        /// The version of the file.
        found: u8,
    },
    /// The file has other tiles than Corniche's.
    #[error(
        "this is an ordinary PMTiles file, not a Corniche package; build one with `corniche build`"
    )]
    OrdinaryPmtiles,
    /// The package has another version of the format.
    #[error(
        "format version {found} is not supported; this program reads version {FORMAT_VERSION}; build the package again"
    )]
    Version {
        /// The version of the package.
        found: u64,
    },
    /// The file is truncated.
    #[error(
        "the file is truncated: it should have {needed} bytes but has {actual}; download or build it again"
    )]
    Truncated {
        /// Number of bytes according to the header.
        needed: u64,
        /// Number of bytes of the file.
        actual: u64,
    },
    /// A part of the file is invalid.
    #[error("the file is damaged: {what}; download or build it again")]
    Damaged {
        /// The invalid part.
        what: &'static str,
    },
    /// The manifest cannot be read.
    #[error(
        "the package's manifest is damaged, or was written by another version of Corniche: {reason}; download or build the package again"
    )]
    Manifest {
        /// The cause of the error.
        reason: String,
    },
}

impl OpenError {
    /// The error of a manifest, whose text is shortened to a readable length.
    pub(crate) fn manifest(reason: impl std::fmt::Display) -> Self {
        const MOST_CHARS: usize = 500;
        let mut reason = reason.to_string();
        if let Some((end, _)) = reason.char_indices().nth(MOST_CHARS) {
            reason.truncate(end);
            reason.push_str(" …");
        }
        Self::Manifest { reason }
    }

    /// Whether the package may be fine: the network or a server failed, and the same request may
    /// succeed later.
    #[must_use]
    pub fn may_pass(&self) -> bool {
        match self {
            Self::File { source, .. } => source.may_pass(),
            Self::Source(error) => error.may_pass,
            _ => false,
        }
    }
}

/// The error of a file. An error of its source names the file itself.
fn not_usable(path: &std::path::Path, source: &OpenError) -> String {
    match source {
        OpenError::Source(error) => error.to_string(),
        _ => format!("cannot use package {path:?}"),
    }
}

/// Why a tile could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The bytes of the tile cannot be read.
    #[error("tile {tile}: {source}")]
    Source {
        /// The tile.
        tile: TileId,
        /// The error of the source.
        source: SourceError,
    },
    /// The directory does not give the position of the tile.
    #[error("tile {tile}: {source}")]
    Directory {
        /// The tile.
        tile: TileId,
        /// The error of the package.
        source: OpenError,
    },
    /// The bytes of the tile are damaged.
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
