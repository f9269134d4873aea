//! The pieces of all tiles, sorted by object, with an unnamed temporary file.

use std::{
    fs::File,
    io::{self, Read as _, Seek as _, SeekFrom, Write as _},
    path::{Path, PathBuf},
    sync::Mutex,
};

use corniche_geom::TileId;
use corniche_store::{Groups, ScratchRange, ScratchSpace, SortRecord, Sorter};
use corniche_work::{Observer, Stage, locked, workers::one_by_one};

use crate::error::FeaturesError;

/// A temporary file without a name, which disappears when the program ends for any reason.
pub(crate) struct FileScratch {
    file: Mutex<File>,
    folder: PathBuf,
}

impl FileScratch {
    /// Creates the file in a folder with space for it.
    pub(crate) fn create(folder: &Path) -> Result<Self, FeaturesError> {
        let folder = folder.to_path_buf();
        match tempfile::tempfile_in(&folder) {
            Ok(file) => Ok(Self { file: Mutex::new(file), folder }),
            Err(source) => Err(FeaturesError::Sort { folder, source }),
        }
    }

    fn failed(&self, source: io::Error) -> FeaturesError {
        FeaturesError::Sort { folder: self.folder.clone(), source }
    }
}

impl ScratchSpace for FileScratch {
    fn append(&self, bytes: &[u8]) -> io::Result<ScratchRange> {
        let mut file = locked(&self.file);
        let offset = file.seek(SeekFrom::End(0))?;
        file.write_all(bytes)?;
        Ok(ScratchRange { offset, length: bytes.len() as u64 })
    }

    fn read(&self, span: ScratchRange) -> io::Result<Vec<u8>> {
        let mut file = locked(&self.file);
        let mut bytes = vec![0; usize::try_from(span.length).map_err(io::Error::other)?];
        file.seek(SeekFrom::Start(span.offset))?;
        file.read_exact(&mut bytes)?;
        Ok(bytes)
    }
}

/// The pieces of one object after the other: of a way, or of an area.
pub(crate) struct SortedPieces<'a, P: SortRecord> {
    sorted: Groups<'a, P>,
    /// How many pieces there are.
    count: u64,
    /// The temporary file in which they were sorted.
    scratch: &'a FileScratch,
}

impl<'a, P: SortRecord> SortedPieces<'a, P> {
    /// Reads tiles and sorts the pieces that `pieces` returns for each, with `memory_bytes` of
    /// memory.
    pub(crate) fn read(
        tiles: &[TileId],
        (scratch, memory_bytes): (&'a FileScratch, u64),
        observer: &dyn Observer,
        mut pieces: impl FnMut(TileId) -> Result<Vec<P>, FeaturesError>,
    ) -> Result<Self, FeaturesError> {
        let failed = |source| scratch.failed(source);
        let mut sorter = Sorter::new(scratch, memory_bytes);
        let mut count = 0;
        one_by_one((observer, Stage::ExportTiles), tiles, |&id| {
            for piece in pieces(id)? {
                count += 1;
                sorter.push(piece).map_err(failed)?;
            }
            Ok::<(), FeaturesError>(())
        })?;
        Ok(Self { sorted: Groups::from_sorted(sorter.finish().map_err(failed)?), count, scratch })
    }

    /// Calls `each` with all pieces of each object, in ascending order.
    pub(crate) fn for_each<K: PartialEq, E: From<FeaturesError>>(
        mut self,
        observer: &dyn Observer,
        object: impl Fn(&P) -> K,
        mut each: impl FnMut(Vec<P>) -> Result<(), E>,
    ) -> Result<(), E> {
        let failed = |source| self.scratch.failed(source);
        observer.begin(Stage::ExportFeatures, Some(self.count));
        while let Some(pieces) = self.sorted.next_by(&object).map_err(failed)? {
            observer.check().map_err(FeaturesError::from)?;
            let count = pieces.len() as u64;
            each(pieces)?;
            observer.advance(Stage::ExportFeatures, count);
        }
        Ok(())
    }
}
