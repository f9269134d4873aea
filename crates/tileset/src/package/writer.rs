//! The writer of packages, which takes tiles in order.

use std::{
    fs::File,
    io::{self, Seek, Write},
    sync::Arc,
};

use corniche_geom::TileId;
use pmtiles::{Compression, PmTilesStreamWriter, PmTilesWriter, PmtError, TileCoord, TileType};

use crate::{
    Manifest,
    limits::{MAX_METADATA_BYTES, MAX_PAYLOAD_BYTES, MIN_PAYLOAD_BYTES},
    package::{
        close_up::CloseUp,
        metadata::{FORMAT_VERSION, Metadata},
        tool_record::header_bounds,
    },
    tile_order::pmtiles_order,
};

/// Why a package could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The file cannot be created, written or flushed.
    #[error("cannot write the package")]
    Io(#[from] io::Error),
    /// The PMTiles writer failed.
    #[error("cannot write the package")]
    Pmtiles(#[source] PmtError),
    /// The manifest cannot be represented as JSON.
    #[error("the manifest cannot be written: {reason}")]
    Manifest {
        /// The cause of the error.
        reason: String,
    },
    /// Tiles were added in another order than that in which they are stored.
    #[error(
        "tile {tile} comes after {previous}, but tiles must be written in ascending pmtiles_order, each once"
    )]
    Order {
        /// The tile that was added.
        tile: TileId,
        /// The tile that was added before it.
        previous: TileId,
    },
    /// A tile is beyond the finest level, or it has too few or too many bytes for a payload.
    #[error(
        "tile {tile} does not belong to this package: its {bytes} bytes are not a payload, or it is beyond level {max_level}"
    )]
    Tile {
        /// The tile that was added.
        tile: TileId,
        /// Number of its bytes.
        bytes: usize,
        /// The package's finest level.
        max_level: u8,
    },
}

impl From<PmtError> for WriteError {
    fn from(error: PmtError) -> Self {
        match error {
            PmtError::Reading(error) => Self::Io(error),
            other => Self::Pmtiles(other),
        }
    }
}

/// Writes a package: PMTiles version 3 of type "other", with tiles as they are, and directories and
/// metadata as gzip.
///
/// The header is written last: until [`PackageWriter::finish`] the file begins with zeros, and no
/// reader mistakes it for a package.
pub struct PackageWriter<W: Write + Seek> {
    tiles: PmTilesStreamWriter<CloseUp<W>>,
    file: Option<Arc<File>>,
    max_level: u8,
    previous: Option<TileId>,
}

impl PackageWriter<Arc<File>> {
    /// Writes at most `tiles` tiles to an open file that was created for the package. A package of
    /// few tiles is up to 16 KB smaller.
    ///
    /// # Errors
    /// When writing fails, or the manifest is invalid. If there are more tiles than announced,
    /// [`PackageWriter::finish`] may fail.
    pub fn of_file(file: File, manifest: &Manifest, tiles: usize) -> Result<Self, WriteError> {
        let file = Arc::new(file);
        let mut writer = Self::new(Arc::clone(&file), manifest, tiles)?;
        writer.file = Some(file);
        Ok(writer)
    }
}

impl<W: Write + Seek> PackageWriter<W> {
    /// Writes at most `tiles` tiles to `out`, which is empty. A package of few tiles is up to 16 KB
    /// smaller.
    ///
    /// # Errors
    /// When writing fails, or the manifest is invalid. If there are more tiles than announced,
    /// [`PackageWriter::finish`] may fail.
    pub fn new(out: W, manifest: &Manifest, tiles: usize) -> Result<Self, WriteError> {
        let bounds = header_bounds(manifest.wgs84_bounds);
        let [lon, lat] = bounds.center();
        let max_level = manifest.frame.max_level();
        let tiles = PmTilesWriter::new(TileType::Unknown)
            .internal_compression(Compression::Gzip)
            .tile_compression(Compression::None)
            .min_zoom(0)
            .max_zoom(max_level)
            .bounds(bounds.min_x, bounds.min_y, bounds.max_x, bounds.max_y)
            .center(lon, lat)
            .center_zoom(0)
            .metadata(to_json(manifest)?)
            .create(CloseUp::new(out, tiles))?;
        Ok(Self { tiles, file: None, max_level, previous: None })
    }

    /// Adds the payload of a tile. Tiles must be added in ascending [`pmtiles_order`], each once.
    ///
    /// # Errors
    /// When the tiles are in another order, or writing fails.
    pub fn add(&mut self, id: TileId, payload: &[u8]) -> Result<(), WriteError> {
        if let Some(previous) =
            self.previous.filter(|&previous| pmtiles_order(previous) >= pmtiles_order(id))
        {
            return Err(WriteError::Order { tile: id, previous });
        }
        let lengths = MIN_PAYLOAD_BYTES as usize..=MAX_PAYLOAD_BYTES as usize;
        if !lengths.contains(&payload.len()) || id.z() > self.max_level {
            let (bytes, max_level) = (payload.len(), self.max_level);
            return Err(WriteError::Tile { tile: id, bytes, max_level });
        }
        self.tiles.add_tile(TileCoord::new(id.z(), id.x(), id.y())?, payload)?;
        self.previous = Some(id);
        Ok(())
    }

    /// Writes directories and header, and syncs a file to disk.
    ///
    /// # Errors
    /// When writing fails; the file is not a package then.
    pub fn finish(self) -> Result<(), WriteError> {
        self.tiles.finalize()?;
        if let Some(file) = self.file {
            file.sync_all()?;
        }
        Ok(())
    }
}

/// Returns the metadata as JSON, after checking that it reads back as the same manifest: JSON has
/// neither infinity nor NaN.
fn to_json(manifest: &Manifest) -> Result<String, WriteError> {
    if manifest.format_version != FORMAT_VERSION {
        let reason =
            format!("its format version is {}, not {FORMAT_VERSION}", manifest.format_version);
        return Err(WriteError::Manifest { reason });
    }
    manifest.check().map_err(|reason| WriteError::Manifest { reason })?;
    let failed = |error: serde_json::Error| WriteError::Manifest { reason: error.to_string() };
    let json = serde_json::to_string(&Metadata::from_manifest(manifest)).map_err(failed)?;
    let back: Metadata<Manifest> = serde_json::from_str(&json).map_err(failed)?;
    if back.corniche != *manifest {
        return Err(WriteError::Manifest {
            reason: "a number in it is infinite or not a number".to_owned(),
        });
    }
    if json.len() > MAX_METADATA_BYTES {
        let reason = format!("{} bytes are more than readers accept", json.len());
        return Err(WriteError::Manifest { reason });
    }
    Ok(json)
}
