//! The reader of packages from any source of bytes: reads the manifest, the list of tiles, and
//! tiles.

use std::{
    collections::BTreeMap,
    sync::{Arc, Mutex, PoisonError},
};

use corniche_geom::TileId;
use serde::{Deserialize, de::IgnoredAny};

use crate::{
    Manifest, Sections, TilePayload,
    limits::{
        MAX_DIRECTORY_BYTES, MAX_DIRECTORY_DEPTH, MAX_KEPT_ENTRIES, MAX_METADATA_BYTES,
        MAX_PAYLOAD_BYTES, MAX_TILES,
    },
    package::{
        directory::{self, Directory, DirectoryEntry},
        error::{OpenError, ReadError},
        header::{ByteSpan, HEADER_BYTES, INITIAL_BYTES, PackageHeader},
        metadata::{FORMAT_VERSION, Metadata},
        source::{ByteSource, SourceError},
        tool_record::ToolRecord,
    },
    tile_order::{pmtiles_order, tile_of_order},
};

/// Leaf directories that were read before, by offset, and the number of their entries.
#[derive(Debug, Default)]
struct Leaves {
    by_offset: BTreeMap<u64, Arc<Directory>>,
    entries: usize,
}

/// A package that is open for reading.
///
/// Reads are range requests: header, root directory and manifest on opening, later a leaf directory
/// from time to time, and one range for each tile. Threads can share a package if they can share
/// its source.
#[derive(Debug)]
pub struct Package<S> {
    source: S,
    header: PackageHeader,
    manifest: Manifest,
    root: Directory,
    leaves: Mutex<Leaves>,
}

impl<S: ByteSource> Package<S> {
    /// Opens a package: reads header, root directory and manifest.
    ///
    /// # Errors
    /// When the source cannot be read, is not a Corniche package of this version, or is truncated
    /// or damaged.
    pub async fn open(source: S) -> Result<Self, OpenError> {
        let length = source.length().await?;
        let initial = source.read(0, length.min(INITIAL_BYTES as u64) as usize).await?;
        let header = PackageHeader::parse(&initial, length)?;
        // The metadata is read before the directory, so that a PMTiles file of another program is
        // reported as such, whatever else is wrong with it.
        let metadata = read_metadata(&source, &header).await?;
        let manifest = Manifest::in_metadata(&metadata)?;
        let root_in_initial = usize::try_from(header.root.offset)
            .ok()
            .filter(|&from| from >= HEADER_BYTES)
            .and_then(|from| initial.get(from..from.checked_add(header.root.length as usize)?));
        let root = match root_in_initial {
            Some(bytes) => Directory::parse(bytes),
            None => Directory::parse(&read_span(&source, header.root).await?),
        };
        let root = root.ok_or(OpenError::Damaged { what: "the root directory" })?;
        Ok(Self { source, header, manifest, root, leaves: Mutex::default() })
    }

    /// The source of the package's bytes.
    #[must_use]
    pub fn source(&self) -> &S {
        &self.source
    }

    /// The manifest.
    #[must_use]
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// Returns the same package with another name for the datum of its heights, as if it had been
    /// built with this `--dem-vertical-crs`. The heights themselves do not change.
    #[must_use]
    pub fn with_datum(self, datum: String, dem_vertical_crs: &str) -> Self {
        let mut package = self;
        package.manifest.vertical.datum = datum;
        package.manifest.settings.dem_vertical_crs = Some(dem_vertical_crs.to_owned());
        package
    }

    /// Returns the metadata, which contains the manifest, as JSON: another instance of this program
    /// reads it with [`Manifest::in_metadata`]. The metadata is read from the file again.
    ///
    /// # Errors
    /// When the metadata cannot be read.
    pub async fn metadata(&self) -> Result<Vec<u8>, OpenError> {
        read_metadata(&self.source, &self.header).await
    }

    /// Returns the fields for PMTiles tools. They are read from the file again.
    ///
    /// # Errors
    /// When header or metadata cannot be read.
    pub async fn tool_record(&self) -> Result<ToolRecord, OpenError> {
        let header = self.source.read(0, HEADER_BYTES).await?;
        ToolRecord::parse(&header, &read_metadata(&self.source, &self.header).await?)
    }

    /// Returns all tiles in the order in which they are stored: by level, then along a Hilbert
    /// curve.
    ///
    /// # Errors
    /// When a leaf directory cannot be read or is damaged, or the number of tiles differs from that
    /// in the header.
    pub async fn tile_ids(&self) -> Result<Vec<TileId>, OpenError> {
        const DAMAGED: OpenError = OpenError::Damaged { what: "a directory" };
        let mut ids = Vec::new();
        // Directories that are still to be listed, the next one last.
        let mut open: Vec<(Arc<Directory>, usize)> = vec![(Arc::new(self.root.clone()), 0)];
        let mut last: Option<TileId> = None;
        let mut data_end = 0;
        while let Some((directory, at)) = open.pop() {
            let Some(&entry) = directory.entries.get(at) else { continue };
            open.push((directory, at + 1));
            // Every entry leads to later tiles only, so the listing ends even if a leaf points to
            // another leaf.
            if last.is_some_and(|last| entry.first <= pmtiles_order(last)) || ids.len() >= MAX_TILES
            {
                return Err(DAMAGED);
            }
            if entry.run == 0 {
                let leaf = self.leaf(entry).await?;
                if open.len() >= MAX_DIRECTORY_DEPTH {
                    return Err(DAMAGED);
                }
                open.push((leaf, 0));
                continue;
            }
            let id = tile_of_order(entry.first)
                .filter(|id| id.z() <= self.manifest.frame.max_level())
                .ok_or(DAMAGED)?;
            // Tiles must not share bytes, as within a directory: so a small file cannot list many
            // tiles.
            if entry.offset < data_end {
                return Err(DAMAGED);
            }
            data_end = entry.offset + u64::from(entry.length);
            if data_end > self.header.data.length {
                return Err(DAMAGED);
            }
            ids.push(id);
            last = Some(id);
        }
        if self.header.tiles != 0 && self.header.tiles != ids.len() as u64 {
            return Err(OpenError::Damaged {
                what: "the directories list fewer or more tiles than the header says",
            });
        }
        Ok(ids)
    }

    /// Returns the payload of a tile as bytes; `None` if the package has no such tile.
    ///
    /// # Errors
    /// When the payload cannot be read, or the directory is damaged.
    pub async fn tile(&self, id: TileId) -> Result<Option<Vec<u8>>, ReadError> {
        self.tile_for(id, Sections::ALL).await
    }

    /// Returns the payload like [`Package::tile`], but without the SV roads at its end if `wanted`
    /// does not include them and the manifest lists their number of bytes.
    /// [`decode`](crate::decode) accepts the shortened payload for these sections.
    ///
    /// # Errors
    /// Same as [`Package::tile`].
    pub async fn tile_for(
        &self,
        id: TileId,
        wanted: Sections,
    ) -> Result<Option<Vec<u8>>, ReadError> {
        let damaged = |what| ReadError::Directory { tile: id, source: OpenError::Damaged { what } };
        let order = pmtiles_order(id);
        let mut found = self.root.find(order);
        for _ in 0..MAX_DIRECTORY_DEPTH {
            let Some(entry) = found else { return Ok(None) };
            if entry.run > 0 {
                let ByteSpan { offset, length } = self.header.data;
                let end = entry.offset.checked_add(u64::from(entry.length));
                if end.is_none_or(|end| end > length) || entry.length > MAX_PAYLOAD_BYTES {
                    return Err(damaged("a directory points outside the tiles"));
                }
                let left_out =
                    if wanted.contains(Sections::ROADS_SV) { 0 } else { self.sv_tail_bytes(order) };
                let length = entry.length.saturating_sub(left_out) as usize;
                let bytes = self.source.read(offset + entry.offset, length).await;
                return bytes.map(Some).map_err(|source| ReadError::Source { tile: id, source });
            }
            let leaf = self
                .leaf(entry)
                .await
                .map_err(|source| ReadError::Directory { tile: id, source })?;
            found = leaf.find(order);
        }
        Err(damaged("directories are nested too deep"))
    }

    /// Returns the wanted sections of a tile, decoded; `None` if the package has no such tile.
    ///
    /// # Errors
    /// When the tile cannot be read or is damaged; the error names the tile and the section.
    pub async fn payload(
        &self,
        id: TileId,
        wanted: Sections,
    ) -> Result<Option<TilePayload>, ReadError> {
        let Some(bytes) = self.tile_for(id, wanted).await? else { return Ok(None) };
        Ok(Some(self.manifest.decode(&bytes, id, wanted)?))
    }

    /// Returns the number of bytes of the SV roads at the end of the tile at a position, or 0 if
    /// the manifest does not list the tile.
    fn sv_tail_bytes(&self, order: u64) -> u32 {
        let tails = &self.manifest.sv_tails;
        let place = tails.binary_search_by_key(&order, |tail| pmtiles_order(tail.tile));
        place.map_or(0, |place| tails[place].bytes)
    }

    /// Returns a leaf directory, which is read once and cached for a while.
    async fn leaf(&self, entry: DirectoryEntry) -> Result<Arc<Directory>, OpenError> {
        const DAMAGED: OpenError = OpenError::Damaged { what: "a leaf directory" };
        // Without this check, listing and searching could disagree about the content of a leaf.
        let begins =
            |leaf: &Directory| leaf.entries.first().is_some_and(|first| first.first == entry.first);
        // A poisoned lock only means that another thread panicked between two whole directories.
        let kept = self
            .leaves
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .by_offset
            .get(&entry.offset)
            .cloned();
        if let Some(leaf) = kept {
            return if begins(&leaf) { Ok(leaf) } else { Err(DAMAGED) };
        }
        let ByteSpan { offset, length } = self.header.leaves;
        let end = entry.offset.checked_add(u64::from(entry.length));
        if end.is_none_or(|end| end > length) || entry.length > MAX_DIRECTORY_BYTES as u32 {
            return Err(OpenError::Damaged {
                what: "a directory points outside the leaf directories",
            });
        }
        let bytes = self.source.read(offset + entry.offset, entry.length as usize).await?;
        let leaf = Directory::parse(&bytes).filter(begins).ok_or(DAMAGED)?;
        let leaf = Arc::new(leaf);
        let mut leaves = self.leaves.lock().unwrap_or_else(PoisonError::into_inner);
        if leaves.entries + leaf.entries.len() > MAX_KEPT_ENTRIES {
            *leaves = Leaves::default();
        }
        if leaves.by_offset.insert(entry.offset, Arc::clone(&leaf)).is_none() {
            leaves.entries += leaf.entries.len();
        }
        Ok(leaf)
    }
}

async fn read_span(source: &impl ByteSource, span: ByteSpan) -> Result<Vec<u8>, SourceError> {
    // The header's limits keep lengths far below the range of a usize.
    source.read(span.offset, span.length as usize).await
}

/// Reads the metadata and decompresses its JSON.
async fn read_metadata(
    source: &impl ByteSource,
    header: &PackageHeader,
) -> Result<Vec<u8>, OpenError> {
    directory::gunzip(&read_span(source, header.metadata).await?, MAX_METADATA_BYTES)
        .ok_or(OpenError::Damaged { what: "the metadata" })
}

impl Manifest {
    /// Reads the manifest from the [metadata](Package::metadata) of a package.
    ///
    /// # Errors
    /// When there is no manifest, or it has another version, or it is invalid.
    pub fn in_metadata(metadata: &[u8]) -> Result<Self, OpenError> {
        let failed = |error: serde_json::Error| OpenError::manifest(error);
        // The text is parsed three times, each time with more of its fields, and never into a tree
        // of JSON values: the tree can take a hundred times the memory of the text.
        let object: Metadata<Option<IgnoredAny>> = parse(metadata).map_err(|error| {
            // An ordinary PMTiles file may have any object as metadata; the metadata of a package
            // has the key `corniche`.
            if error.is_data() { OpenError::OrdinaryPmtiles } else { failed(error) }
        })?;
        if object.corniche.is_none() {
            return Err(OpenError::OrdinaryPmtiles);
        }
        let version: Metadata<Version> = parse(metadata).map_err(failed)?;
        if version.corniche.format_version != u64::from(FORMAT_VERSION) {
            return Err(OpenError::Version { found: version.corniche.format_version });
        }
        let metadata: Metadata<Self> = parse(metadata).map_err(failed)?;
        metadata.corniche.check().map_err(OpenError::manifest)?;
        Ok(metadata.corniche)
    }
}

fn parse<'a, T: Deserialize<'a>>(metadata: &'a [u8]) -> Result<Metadata<T>, serde_json::Error> {
    serde_json::from_slice(metadata)
}

/// The fields that are read before the rest of the manifest, which may have another version.
#[derive(Deserialize)]
struct Version {
    format_version: u64,
}
