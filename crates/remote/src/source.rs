//! The bytes of a file on a web server, for readers that block.

use std::sync::{Mutex, OnceLock, PoisonError};

use bytes::Bytes;
use corniche_blocks::{BlockCache, CacheLimits};
use corniche_tileset::{BlockingSource, SourceError};

use crate::{HttpAddress, HttpError, ServerRequests, answer::Version, range::Ranges};

/// Bytes per block; the last block of a file has fewer.
///
/// The first block contains header, root directory and manifest of most packages, so that one
/// request opens them. In the measured packages, a tile has 10 to 350 kB. With smaller blocks an
/// image takes more requests, with larger ones more bytes (`docs/lab/remote.md`).
const BLOCK_BYTES: u64 = 64 << 10;
/// A request has at most 4 MiB, which takes a second at 32 Mbit/s.
const LIMITS: CacheLimits =
    CacheLimits { block_bytes: BLOCK_BYTES, kept_bytes: 64 << 20, most_blocks: 64 };
/// The number of the only file in its cache.
const FILE: u64 = 0;

/// The bytes of a file on a web server. Reads block, and many threads can read at once.
///
/// All bytes belong to the version of the file in the first answer. If the version changes, all
/// further reads fail.
#[derive(Debug)]
pub struct HttpSource {
    ranges: Ranges,
    blocks: BlockCache,
    version: OnceLock<Version>,
    /// The lock for the first request.
    first: Mutex<()>,
    /// The error after the file has changed.
    changed: OnceLock<HttpError>,
}

impl HttpSource {
    pub(crate) fn new(ranges: Ranges) -> Self {
        Self {
            ranges,
            blocks: BlockCache::new(LIMITS),
            version: OnceLock::new(),
            first: Mutex::default(),
            changed: OnceLock::new(),
        }
    }

    /// The address of the file.
    #[must_use]
    pub fn address(&self) -> &HttpAddress {
        &self.ranges.address
    }

    /// The traffic of the server so far.
    #[must_use]
    pub fn requests(&self) -> ServerRequests {
        *self.ranges.requests()
    }

    /// The length of the file in bytes, if it is already known.
    #[must_use]
    pub fn known_length(&self) -> Option<u64> {
        self.version.get().map(|version| version.length)
    }

    /// The version of the file, from its first block, which is cached.
    fn version(&self) -> Result<&Version, HttpError> {
        if let Some(version) = self.version.get() {
            return Ok(version);
        }
        let _first = self.first.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(version) = self.version.get() {
            return Ok(version);
        }
        let mut found = None;
        self.blocks.get((FILE, 0), 1, 1, |_| {
            let (version, bytes) = self.ranges.get(&(0..BLOCK_BYTES), None)?;
            found = Some(version);
            Ok::<Bytes, HttpError>(bytes)
        })?;
        // The first block can only be cached if it was fetched here.
        let version =
            found.ok_or_else(|| HttpError::Setup { what: "no first block".to_owned() })?;
        Ok(self.version.get_or_init(|| version))
    }

    fn bytes(&self, offset: u64, length: usize) -> Result<Vec<u8>, HttpError> {
        let version = self.version()?;
        if offset.checked_add(length as u64).is_none_or(|end| end > version.length) {
            return Err(HttpError::Beyond { length: version.length });
        }
        let mut read = vec![0; length];
        self.blocks.read((FILE, version.length), &mut read, offset, |asked| {
            if let Some(changed) = self.changed.get() {
                return Err(changed.clone());
            }
            let got = self.ranges.get(&asked, Some(version)).inspect_err(|error| {
                if matches!(error, HttpError::Changed { .. }) {
                    // Another thread may have noticed the change first.
                    let _ = self.changed.set(error.clone());
                }
            });
            got.map(|(_, bytes)| bytes)
        })?;
        Ok(read)
    }
}

impl BlockingSource for HttpSource {
    fn length(&self) -> Result<u64, SourceError> {
        let version = self.version();
        version
            .map(|version| version.length)
            .map_err(|error| error.of_source(&self.address().shown, 0, 0))
    }

    fn read(&self, offset: u64, length: usize) -> Result<Vec<u8>, SourceError> {
        self.bytes(offset, length)
            .map_err(|error| error.of_source(&self.address().shown, offset, length))
    }
}
