//! Intermediate results of a run: pyramid levels, TINs and payloads, kept outside memory.

use std::{
    fs::File,
    io,
    path::Path,
    sync::{Mutex, PoisonError},
};

/// What a span holds; each kind is kept apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Blocks of heights, all levels.
    Heights,
    /// Triangulated tiles.
    Tins,
    /// Encoded payloads.
    Payloads,
}

const KINDS: usize = 3;

/// Where something was put.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Span {
    offset: u64,
    length: u64,
}

impl Span {
    /// How many bytes it has.
    #[must_use]
    pub(crate) fn length(self) -> u64 {
        self.length
    }

    /// The part of this span that starts `from` bytes in and is `length` long, cut at its end.
    #[must_use]
    pub(crate) fn part(self, from: u64, length: u64) -> Self {
        let from = from.min(self.length);
        Self { offset: self.offset + from, length: length.min(self.length - from) }
    }
}

/// Where stages keep intermediate results: bytes are appended and read back.
///
/// Nothing is changed or removed during a run, so readers never wait for writers.
pub(crate) trait Storage: Send + Sync {
    /// Keeps `bytes`.
    ///
    /// # Errors
    /// When there is no room or the device fails.
    fn append(&self, kind: Kind, bytes: &[u8]) -> io::Result<Span>;

    /// Reads back what `append` kept.
    ///
    /// # Errors
    /// When the device fails or the span was never written.
    fn read(&self, kind: Kind, span: Span) -> io::Result<Vec<u8>>;
}

/// One file per kind in a folder.
#[derive(Debug)]
pub(crate) struct DiskStorage {
    files: [(File, Mutex<u64>); KINDS],
}

impl DiskStorage {
    /// Creates the files in `folder`, which must exist.
    ///
    /// # Errors
    /// When a file cannot be created.
    pub(crate) fn create(folder: &Path) -> io::Result<Self> {
        let open = |name: &str| -> io::Result<(File, Mutex<u64>)> {
            let file = File::options()
                .read(true)
                .write(true)
                .create(true)
                .truncate(true)
                .open(folder.join(name))?;
            Ok((file, Mutex::new(0)))
        };
        let files = [open("heights")?, open("tins")?, open("payloads")?];
        Ok(Self { files })
    }
}

impl Storage for DiskStorage {
    fn append(&self, kind: Kind, bytes: &[u8]) -> io::Result<Span> {
        let (file, end) = &self.files[kind as usize];
        let length = bytes.len() as u64;
        // Reserve first, write outside the lock: writers of one kind do not wait for each other's disk.
        let offset = {
            let mut end = end.lock().unwrap_or_else(PoisonError::into_inner);
            let offset = *end;
            *end += length;
            offset
        };
        write_all_at(file, bytes, offset)?;
        Ok(Span { offset, length })
    }

    fn read(&self, kind: Kind, span: Span) -> io::Result<Vec<u8>> {
        let mut bytes = vec![0; span.length as usize];
        read_exact_at(&self.files[kind as usize].0, &mut bytes, span.offset)?;
        Ok(bytes)
    }
}

#[cfg(unix)]
fn write_all_at(file: &File, bytes: &[u8], offset: u64) -> io::Result<()> {
    std::os::unix::fs::FileExt::write_all_at(file, bytes, offset)
}

#[cfg(unix)]
fn read_exact_at(file: &File, bytes: &mut [u8], offset: u64) -> io::Result<()> {
    std::os::unix::fs::FileExt::read_exact_at(file, bytes, offset)
}

#[cfg(windows)]
fn write_all_at(file: &File, mut bytes: &[u8], mut offset: u64) -> io::Result<()> {
    while !bytes.is_empty() {
        let written = std::os::windows::fs::FileExt::seek_write(file, bytes, offset)?;
        if written == 0 {
            return Err(io::ErrorKind::WriteZero.into());
        }
        bytes = &bytes[written..];
        offset += written as u64;
    }
    Ok(())
}

#[cfg(windows)]
fn read_exact_at(file: &File, mut bytes: &mut [u8], mut offset: u64) -> io::Result<()> {
    while !bytes.is_empty() {
        let read = std::os::windows::fs::FileExt::seek_read(file, bytes, offset)?;
        if read == 0 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        bytes = &mut bytes[read..];
        offset += read as u64;
    }
    Ok(())
}

/// Keeps everything in memory.
#[cfg(test)]
#[derive(Debug, Default)]
pub(crate) struct MemoryStorage {
    files: [Mutex<Vec<u8>>; KINDS],
}

#[cfg(test)]
impl Storage for MemoryStorage {
    fn append(&self, kind: Kind, bytes: &[u8]) -> io::Result<Span> {
        let mut file = self.files[kind as usize].lock().unwrap_or_else(PoisonError::into_inner);
        let offset = file.len() as u64;
        file.extend_from_slice(bytes);
        Ok(Span { offset, length: bytes.len() as u64 })
    }

    fn read(&self, kind: Kind, span: Span) -> io::Result<Vec<u8>> {
        let file = self.files[kind as usize].lock().unwrap_or_else(PoisonError::into_inner);
        let range = span.offset as usize..(span.offset + span.length) as usize;
        file.get(range).map(<[u8]>::to_vec).ok_or_else(|| io::ErrorKind::UnexpectedEof.into())
    }
}

#[cfg(test)]
#[path = "storage_tests.rs"]
mod tests;
