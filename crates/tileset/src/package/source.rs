//! Sources of a package's bytes: memory, files, and the interface for servers.

use std::future::Future;

/// Why bytes could not be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}", self.text())]
pub struct SourceError {
    /// The name of the source: a path or an address.
    pub name: String,
    /// Offset of the first requested byte.
    pub offset: u64,
    /// Number of requested bytes.
    pub length: usize,
    /// The cause of the error.
    pub reason: String,
    /// Whether the request was valid and only the network, a server or a disk failed, so that the
    /// same read may succeed later.
    pub may_pass: bool,
}

impl SourceError {
    /// If the length is 0, nothing was requested yet: the source could not even be opened.
    fn text(&self) -> String {
        let Self { name, offset, length, reason, may_pass: _ } = self;
        match length {
            0 => format!("cannot open {name:?}: {reason}"),
            _ => format!("cannot read {length} bytes at {offset} of {name:?}: {reason}"),
        }
    }
}

/// A source of the bytes of a package: a file, memory, a server that answers range requests.
///
/// Futures need not be `Send`, so that a browser's futures can be used; adapters that are used from
/// several threads return `Send` futures.
pub trait ByteSource {
    /// Returns the number of bytes of the source.
    fn length(&self) -> impl Future<Output = Result<u64, SourceError>>;

    /// Reads exactly `length` bytes from `offset` on; fewer bytes are an error. The reader requests
    /// at most [`MAX_PAYLOAD_BYTES`](crate::limits::MAX_PAYLOAD_BYTES) at once, and never reads
    /// past [`ByteSource::length`].
    fn read(
        &self,
        offset: u64,
        length: usize,
    ) -> impl Future<Output = Result<Vec<u8>, SourceError>>;
}

/// A package in memory.
#[derive(Debug, Clone)]
pub struct MemorySource {
    bytes: Vec<u8>,
}

impl MemorySource {
    /// Reads from `bytes`.
    #[must_use]
    pub fn new(bytes: Vec<u8>) -> Self {
        Self { bytes }
    }
}

impl ByteSource for MemorySource {
    async fn length(&self) -> Result<u64, SourceError> {
        Ok(self.bytes.len() as u64)
    }

    async fn read(&self, offset: u64, length: usize) -> Result<Vec<u8>, SourceError> {
        let range =
            usize::try_from(offset).ok().and_then(|from| Some(from..from.checked_add(length)?));
        range.and_then(|range| self.bytes.get(range)).map(<[u8]>::to_vec).ok_or_else(|| {
            SourceError {
                name: "memory".to_owned(),
                offset,
                length,
                reason: format!("there are only {} bytes", self.bytes.len()),
                may_pass: false,
            }
        })
    }
}

#[cfg(not(target_arch = "wasm32"))]
pub use file::FileSource;
#[cfg(not(target_arch = "wasm32"))]
pub use waiting::{AnySource, BlockingSource};

#[cfg(not(target_arch = "wasm32"))]
mod waiting {
    use std::{
        fmt::Debug,
        sync::{Arc, OnceLock},
    };

    use super::{ByteSource, SourceError};

    /// A source of the bytes of a package for threads that wait for them: a file, or a server,
    /// which has a crate of its own.
    pub trait BlockingSource: Debug + Send + Sync {
        /// See [`ByteSource::length`].
        ///
        /// # Errors
        /// When the length cannot be determined.
        fn length(&self) -> Result<u64, SourceError>;

        /// See [`ByteSource::read`].
        ///
        /// # Errors
        /// When the bytes cannot be read, or the source has fewer.
        fn read(&self, offset: u64, length: usize) -> Result<Vec<u8>, SourceError>;
    }

    /// Any source, for threads that wait. Clones read from the same source.
    #[derive(Debug, Clone)]
    pub struct AnySource {
        source: Arc<dyn BlockingSource>,
        failure: Arc<OnceLock<SourceError>>,
    }

    impl AnySource {
        /// Reads from `source`.
        #[must_use]
        pub fn new(source: Arc<dyn BlockingSource>) -> Self {
            Self { source, failure: Arc::default() }
        }

        /// The first read that failed, if any. Callers that treat unreadable tiles as damaged use
        /// it to distinguish the two.
        #[must_use]
        pub fn failure(&self) -> Option<&SourceError> {
            self.failure.get()
        }

        fn noted<T>(&self, read: Result<T, SourceError>) -> Result<T, SourceError> {
            read.inspect_err(|error| {
                // Only the first error is kept.
                let _ = self.failure.set(error.clone());
            })
        }
    }

    impl ByteSource for AnySource {
        async fn length(&self) -> Result<u64, SourceError> {
            self.noted(self.source.length())
        }

        async fn read(&self, offset: u64, length: usize) -> Result<Vec<u8>, SourceError> {
            self.noted(self.source.read(offset, length))
        }
    }
}

#[cfg(not(target_arch = "wasm32"))]
mod file {
    use std::{
        fs::{self, File},
        io,
        path::{Path, PathBuf},
    };

    use super::{BlockingSource, SourceError};

    /// A package on disk. Several threads may read from it at once, because reads name their
    /// positions.
    #[derive(Debug)]
    pub struct FileSource {
        file: File,
        path: PathBuf,
    }

    impl FileSource {
        /// Opens a file for reading.
        ///
        /// # Errors
        /// When the file cannot be opened.
        pub fn open(path: &Path) -> Result<Self, SourceError> {
            let failed = |error: io::Error| failure(path, 0, 0, &error);
            // This check comes before opening, which would block forever on a pipe.
            let metadata = fs::metadata(path).map_err(failed)?;
            if metadata.is_dir() {
                return Err(failed(io::ErrorKind::IsADirectory.into()));
            }
            if !metadata.is_file() {
                return Err(failed(io::Error::other(
                    "not a regular file; copy it to a regular file",
                )));
            }
            let file = File::open(path).map_err(failed)?;
            Ok(Self { file, path: path.to_path_buf() })
        }
    }

    fn failure(path: &Path, offset: u64, length: usize, error: &io::Error) -> SourceError {
        SourceError {
            name: path.display().to_string(),
            offset,
            length,
            reason: error.to_string(),
            // An error of a file persists until someone fixes it.
            may_pass: false,
        }
    }

    #[cfg(unix)]
    fn read_exact_at(file: &File, buffer: &mut [u8], offset: u64) -> io::Result<()> {
        std::os::unix::fs::FileExt::read_exact_at(file, buffer, offset)
    }

    #[cfg(windows)]
    fn read_exact_at(file: &File, mut buffer: &mut [u8], mut offset: u64) -> io::Result<()> {
        while !buffer.is_empty() {
            let read = std::os::windows::fs::FileExt::seek_read(file, buffer, offset)?;
            if read == 0 {
                return Err(io::ErrorKind::UnexpectedEof.into());
            }
            buffer = &mut buffer[read..];
            offset += read as u64;
        }
        Ok(())
    }

    impl BlockingSource for FileSource {
        fn length(&self) -> Result<u64, SourceError> {
            self.file
                .metadata()
                .map(|metadata| metadata.len())
                .map_err(|error| failure(&self.path, 0, 0, &error))
        }

        fn read(&self, offset: u64, length: usize) -> Result<Vec<u8>, SourceError> {
            let mut buffer = vec![0; length];
            read_exact_at(&self.file, &mut buffer, offset)
                .map_err(|error| failure(&self.path, offset, length, &error))?;
            Ok(buffer)
        }
    }
}
