//! What the writers of all model formats have in common: facts, numbers of corners that tiles
//! share, and bytes that wait in a file without a name.

use std::{
    collections::HashMap,
    fs::File,
    io::{self, BufWriter, Seek as _, SeekFrom, Write},
    path::Path,
};

use corniche_geom::LatticePoint;

use super::model::{Corner, TileMesh};

/// What is said of a model, in order: names and texts.
pub(crate) type Facts = [(&'static str, String)];

/// Makes a file of tiles.
pub(crate) trait MeshWriter {
    fn tile(&mut self, tile: &TileMesh) -> io::Result<()>;
    fn finish(self: Box<Self>, into: &mut dyn Write, facts: &Facts) -> io::Result<()>;
}

/// Gives the corners of all tiles numbers, one to those that tiles share: positions there are the same to the bit.
#[derive(Default)]
pub(crate) struct Welding {
    on_borders: HashMap<LatticePoint, u32>,
}

impl Welding {
    /// The numbers of a tile's corners. `add` is called for those that are new, and tells the number.
    pub(crate) fn numbers<E>(
        &mut self,
        tile: &TileMesh,
        mut add: impl FnMut(&Corner) -> Result<u32, E>,
    ) -> Result<Vec<u32>, E> {
        let mut numbers = Vec::with_capacity(tile.corners.len());
        for corner in &tile.corners {
            let known = corner.shared.and_then(|point| self.on_borders.get(&point));
            let number = match known {
                Some(number) => *number,
                None => add(corner)?,
            };
            if let Some(point) = corner.shared {
                self.on_borders.insert(point, number);
            }
            numbers.push(number);
        }
        Ok(numbers)
    }
}

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

    /// Copies all of it.
    pub(crate) fn copy_to(self, into: &mut impl Write) -> io::Result<()> {
        let mut file = self.file.into_inner().map_err(io::IntoInnerError::into_error)?;
        file.seek(SeekFrom::Start(0))?;
        let copied = io::copy(&mut file, into)?;
        if copied == self.length { Ok(()) } else { Err(io::ErrorKind::UnexpectedEof.into()) }
    }
}

impl Write for Spill {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.file.write(bytes)?;
        self.length += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}
