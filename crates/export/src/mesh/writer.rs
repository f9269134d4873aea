//! Common parts of the writers of all model formats: metadata, numbers for corners that tiles
//! share, and bytes that are buffered in an unnamed file.

use std::{
    collections::HashMap,
    fs::File,
    io::{self, BufWriter, Seek as _, Write},
    path::Path,
};

use corniche_geom::LatticePoint;

use super::model::{MeshCorner, TileMesh};

/// The metadata of a model, in order: names and texts.
pub(crate) type Facts = [(&'static str, String)];

/// Writes a file of tiles.
pub(crate) trait MeshWriter {
    fn tile(&mut self, tile: &TileMesh) -> io::Result<()>;
    fn finish(self: Box<Self>, into: &mut dyn Write, facts: &Facts) -> io::Result<()>;
}

/// Assigns numbers to the corners of all tiles; corners that tiles share have one number, because
/// their positions are identical to the bit.
#[derive(Default)]
pub(crate) struct Welding {
    on_borders: HashMap<LatticePoint, u32>,
}

impl Welding {
    /// Returns the numbers of a tile's corners. `add` is called for new corners, and returns their
    /// number.
    pub(crate) fn numbers<E>(
        &mut self,
        tile: &TileMesh,
        mut add: impl FnMut(&MeshCorner) -> Result<u32, E>,
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

/// A buffer for bytes that belong behind others that are not known yet: an unnamed file.
pub(crate) type Spill = BufWriter<File>;

/// Creates an unnamed file in the folder of another file.
pub(crate) fn spill_beside(path: &Path) -> io::Result<Spill> {
    tempfile::tempfile_in(corniche_store::folder_of(path)).map(BufWriter::new)
}

/// Copies all that was written to `spill`.
pub(crate) fn copy_all(spill: Spill, into: &mut dyn Write) -> io::Result<()> {
    let mut file = spill.into_inner().map_err(io::IntoInnerError::into_error)?;
    let length = file.stream_position()?;
    file.rewind()?;
    let copied = io::copy(&mut file, into)?;
    if copied == length { Ok(()) } else { Err(io::ErrorKind::UnexpectedEof.into()) }
}
