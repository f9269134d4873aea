//! Bytes wait in a file without a name until what must stand before them is known.

use std::{
    fs::File,
    io::{self, BufWriter, Seek as _, SeekFrom, Write},
    path::Path,
};

/// Bytes that come before others are known which must stand ahead of them: in a file without a name.
pub(crate) struct Spill {
    file: BufWriter<File>,
    length: u64,
}

impl Spill {
    /// A file without a name in the folder of another file.
    pub(crate) fn beside(path: &Path) -> io::Result<Self> {
        let file = tempfile::tempfile_in(corniche_store::folder_of(path))?;
        Ok(Self { file: BufWriter::new(file), length: 0 })
    }

    /// How many bytes there are.
    pub(crate) fn length(&self) -> u64 {
        self.length
    }

    /// Appends bytes.
    pub(crate) fn push(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.length += bytes.len() as u64;
        self.file.write_all(bytes)
    }

    /// Copies all of it.
    pub(crate) fn copy_to(self, into: &mut impl Write) -> io::Result<()> {
        let mut file = self.file.into_inner().map_err(io::IntoInnerError::into_error)?;
        file.seek(SeekFrom::Start(0))?;
        let copied = io::copy(&mut file, into)?;
        if copied == self.length { Ok(()) } else { Err(io::ErrorKind::UnexpectedEof.into()) }
    }
}
