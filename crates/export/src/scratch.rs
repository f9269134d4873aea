//! Scratch space in a file without a name, for sorting during an export.

use std::{
    fs::File,
    io::{self, Read as _, Seek as _, SeekFrom, Write as _},
    path::Path,
    sync::{Mutex, PoisonError},
};

use corniche_store::{Scratch, Span};

/// Scratch space in a file without a name, which is gone when the program ends, however it ends.
#[derive(Debug)]
pub(crate) struct FileScratch {
    /// The file and its length.
    file: Mutex<(File, u64)>,
}

impl FileScratch {
    pub(crate) fn create(folder: &Path) -> io::Result<Self> {
        Ok(Self { file: Mutex::new((tempfile::tempfile_in(folder)?, 0)) })
    }
}

impl Scratch for FileScratch {
    fn append(&self, bytes: &[u8]) -> io::Result<Span> {
        let mut locked = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        let (file, end) = &mut *locked;
        let span = Span { offset: *end, length: bytes.len() as u64 };
        file.seek(SeekFrom::Start(span.offset))?;
        file.write_all(bytes)?;
        *end += span.length;
        Ok(span)
    }

    fn read(&self, span: Span) -> io::Result<Vec<u8>> {
        let mut locked = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        let (file, end) = &mut *locked;
        if span.offset.checked_add(span.length).is_none_or(|last| last > *end) {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        let mut bytes = vec![0; usize::try_from(span.length).map_err(io::Error::other)?];
        file.seek(SeekFrom::Start(span.offset))?;
        file.read_exact(&mut bytes)?;
        Ok(bytes)
    }
}
