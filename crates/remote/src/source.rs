//! The bytes of a file on a web server, for readers that wait for them.

use std::sync::{Mutex, OnceLock, PoisonError};

use bytes::Bytes;
use corniche_blocks::{BlockCache, Limits};
use corniche_tileset::{BlockingSource, SourceError};

use crate::{HttpAddress, HttpError, Requests, answer::Version, range::Ranges};

/// Bytes of a block; the last one of a file has fewer.
///
/// The first one holds header, root directory and manifest of most packages, so one request opens them. In the packages that were measured
/// a tile has 10 to 350 kB. With smaller blocks a picture takes more requests, with larger ones more bytes (`docs/lab/remote.md`).
const BLOCK_BYTES: u64 = 64 << 10;
/// A request has 4 MiB at most, a second at 32 Mbit/s.
const LIMITS: Limits = Limits { block_bytes: BLOCK_BYTES, kept_bytes: 64 << 20, most_blocks: 64 };
/// The one file of its cache.
const FILE: u64 = 0;

/// The bytes of a file on a web server. Threads wait for them, and many may do so at once.
///
/// All bytes are of the version of the file that the first answer had. If that changes, all further reads fail.
#[derive(Debug)]
pub struct HttpSource {
    ranges: Ranges,
    blocks: BlockCache,
    version: OnceLock<Version>,
    /// Held by the one that asks first.
    first: Mutex<()>,
    /// The file is another one now.
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

    /// Where it is.
    #[must_use]
    pub fn address(&self) -> &HttpAddress {
        self.ranges.address()
    }

    /// What was asked of the server so far.
    #[must_use]
    pub fn requests(&self) -> Requests {
        self.ranges.counter.so_far()
    }

    /// How many bytes the file has, if that is known already.
    #[must_use]
    pub fn known_length(&self) -> Option<u64> {
        self.version.get().map(|version| version.length)
    }

    /// The version of the file: of the first block, which is kept.
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
        // The first block can only be there if it was fetched here.
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
                    // Another thread may have seen it first.
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
            .map_err(|error| error.of_source(self.address().shown(), 0, 0))
    }

    fn read(&self, offset: u64, length: usize) -> Result<Vec<u8>, SourceError> {
        self.bytes(offset, length)
            .map_err(|error| error.of_source(self.address().shown(), offset, length))
    }
}
