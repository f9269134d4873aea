//! The reader of packages from any source of bytes: manifest, list of tiles, tiles.

use std::{
    collections::BTreeMap,
    sync::{Arc, Mutex, PoisonError},
};

use corniche_geom::TileId;
use serde::{Deserialize, de::IgnoredAny};

use crate::package::directory::{self, Directory, Entry};
use crate::package::error::{OpenError, ReadError};
use crate::package::header::{HEADER_BYTES, Header, INITIAL_BYTES, Span};
use crate::package::metadata::{FORMAT_VERSION, Metadata};
use crate::package::source::{ByteSource, SourceError};
use crate::package::tool_record::ToolRecord;
use crate::tile_order::{pmtiles_order, tile_of_order};
use crate::{
    Manifest, Sections, TilePayload,
    limits::{
        MAX_DIRECTORY_BYTES, MAX_DIRECTORY_DEPTH, MAX_KEPT_ENTRIES, MAX_METADATA_BYTES,
        MAX_PAYLOAD_BYTES, MAX_TILES,
    },
};

/// Leaf directories read before, by offset, and how many entries they have.
#[derive(Debug, Default)]
struct Leaves {
    by_offset: BTreeMap<u64, Arc<Directory>>,
    entries: usize,
}

/// A package open for reading.
///
/// Reads are range requests: header, root directory and manifest when it is opened, then a leaf directory now and
/// then and one range for each tile. It can be shared between threads when its source can.
#[derive(Debug)]
pub struct Package<S> {
    source: S,
    header: Header,
    manifest: Manifest,
    root: Directory,
    leaves: Mutex<Leaves>,
}

impl<S: ByteSource> Package<S> {
    /// Reads header, root directory and manifest.
    ///
    /// # Errors
    /// When the source cannot be read, is no Corniche package of this version, is cut off or damaged.
    pub async fn open(source: S) -> Result<Self, OpenError> {
        let length = source.length().await?;
        let initial = source.read(0, length.min(INITIAL_BYTES as u64) as usize).await?;
        let header = Header::parse(&initial, length)?;
        // Before the directory, so that a PMTiles file of another program is reported as such, whatever else is wrong
        // with it.
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

    /// Where its bytes come from.
    #[must_use]
    pub fn source(&self) -> &S {
        &self.source
    }

    /// The table of contents.
    #[must_use]
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// The same package, whose heights are said to be those of another datum, as if it had been built with this `--dem-vertical-crs`. The heights
    /// themselves stay as they are.
    #[must_use]
    pub fn with_datum(self, datum: String, dem_vertical_crs: &str) -> Self {
        let mut package = self;
        package.manifest.vertical.datum = datum;
        package.manifest.settings.dem_vertical_crs = Some(dem_vertical_crs.to_owned());
        package
    }

    /// The metadata in which the manifest is, as JSON: another instance of this program reads it with [`Manifest::in_metadata`]. It is read from the
    /// file again.
    ///
    /// # Errors
    /// When it cannot be read.
    pub async fn metadata(&self) -> Result<Vec<u8>, OpenError> {
        read_metadata(&self.source, &self.header).await
    }

    /// What the file says for PMTiles tools. It is read from the file again.
    ///
    /// # Errors
    /// When header or metadata cannot be read.
    pub async fn tool_record(&self) -> Result<ToolRecord, OpenError> {
        let header = self.source.read(0, HEADER_BYTES).await?;
        ToolRecord::parse(&header, &read_metadata(&self.source, &self.header).await?)
    }

    /// All tiles, in the order in which they are stored: by level, then along a Hilbert curve.
    ///
    /// # Errors
    /// When a leaf directory cannot be read or is damaged, or there are fewer or more tiles than the header says.
    pub async fn tile_ids(&self) -> Result<Vec<TileId>, OpenError> {
        const DAMAGED: OpenError = OpenError::Damaged { what: "a directory" };
        let mut ids = Vec::new();
        // Directories still to be listed, the next one last.
        let mut open: Vec<(Arc<Directory>, usize)> = vec![(Arc::new(self.root.clone()), 0)];
        let mut last: Option<TileId> = None;
        let mut data_end = 0;
        while let Some((directory, at)) = open.pop() {
            let Some(&entry) = directory.entries.get(at) else { continue };
            open.push((directory, at + 1));
            // Every entry leads to later tiles only, so the listing ends, also if a leaf points to another leaf.
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
            // As within a directory, tiles share no bytes: so a small file cannot list many tiles.
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

    /// The payload of a tile as bytes; `None` when the package has no such tile.
    ///
    /// # Errors
    /// When it cannot be read, or the directory is damaged.
    pub async fn tile(&self, id: TileId) -> Result<Option<Vec<u8>>, ReadError> {
        self.tile_for(id, Sections::ALL).await
    }

    /// The same, without SV roads at its end where they are not wanted and the manifest tells how many bytes they are. [`decode`](crate::decode) takes it for these
    /// sections.
    ///
    /// # Errors
    /// As [`Package::tile`].
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
                let Span { offset, length } = self.header.data;
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

    /// The wanted sections of a tile, decoded; `None` when the package has no such tile.
    ///
    /// # Errors
    /// When it cannot be read or is damaged; the error names the tile and the section.
    pub async fn payload(
        &self,
        id: TileId,
        wanted: Sections,
    ) -> Result<Option<TilePayload>, ReadError> {
        let Some(bytes) = self.tile_for(id, wanted).await? else { return Ok(None) };
        Ok(Some(self.manifest.decode(&bytes, id, wanted)?))
    }

    /// How many bytes the SV roads at the end of the tile at a place take, where the manifest tells.
    fn sv_tail_bytes(&self, order: u64) -> u32 {
        let tails = &self.manifest.sv_tails;
        let place = tails.binary_search_by_key(&order, |tail| pmtiles_order(tail.tile));
        place.map_or(0, |place| tails[place].bytes)
    }

    /// A leaf directory, read once and kept for a while.
    async fn leaf(&self, entry: Entry) -> Result<Arc<Directory>, OpenError> {
        const DAMAGED: OpenError = OpenError::Damaged { what: "a leaf directory" };
        // Otherwise listing and searching could give different answers about what is in it.
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
        let Span { offset, length } = self.header.leaves;
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

async fn read_span(source: &impl ByteSource, span: Span) -> Result<Vec<u8>, SourceError> {
    // The header's limits keep lengths far below what a usize holds.
    source.read(span.offset, span.length as usize).await
}

/// The metadata's JSON.
async fn read_metadata(source: &impl ByteSource, header: &Header) -> Result<Vec<u8>, OpenError> {
    directory::gunzip(&read_span(source, header.metadata).await?, MAX_METADATA_BYTES)
        .ok_or(OpenError::Damaged { what: "the metadata" })
}

impl Manifest {
    /// The manifest in the [metadata](Package::metadata) of a package.
    ///
    /// # Errors
    /// When there is none, or one of another version, or it makes no sense.
    pub fn in_metadata(metadata: &[u8]) -> Result<Self, OpenError> {
        let failed = |error: serde_json::Error| OpenError::manifest(error);
        // The text is read three times, each time with more of its fields, and never into a tree of JSON values: such a tree
        // can take a hundred times the memory of the text.
        let object: Metadata<Option<IgnoredAny>> = parse(metadata).map_err(|error| {
            // An ordinary file may have any object; a package has one with the key `corniche`.
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

/// What is read before the rest of the manifest, which may be of another version.
#[derive(Deserialize)]
struct Version {
    format_version: u64,
}
