//! The pieces of all tiles, sorted by the object that they belong to.

use std::path::Path;

use corniche_geom::TileId;
use corniche_store::{Groups, SortRecord, Sorter};

use crate::{
    error::ExportError,
    observer::{Observer, Stage, stop_if_asked},
};

/// The pieces of one object after the other: of a way, or of an area.
pub(crate) struct SortedPieces<'a, P: SortRecord> {
    sorted: Groups<'a, P>,
    /// How many pieces there are.
    count: u64,
    /// Where they were sorted.
    folder: &'a Path,
}

impl<'a, P: SortRecord> SortedPieces<'a, P> {
    /// Reads tiles and sorts the pieces that `pieces` finds in each. `sorter` sorts in `folder`.
    pub(crate) fn read(
        tiles: &[TileId],
        (mut sorter, folder): (Sorter<'a, P>, &'a Path),
        observer: &dyn Observer,
        pieces: impl Fn(TileId) -> Result<Vec<P>, ExportError>,
    ) -> Result<Self, ExportError> {
        let failed = |source| ExportError::Sort { folder: folder.to_path_buf(), source };
        let mut count = 0;
        for (done, &id) in tiles.iter().enumerate() {
            stop_if_asked(observer)?;
            observer.done(Stage::Tiles, done as u64, tiles.len() as u64);
            for piece in pieces(id)? {
                count += 1;
                sorter.push(piece).map_err(failed)?;
            }
        }
        observer.done(Stage::Tiles, tiles.len() as u64, tiles.len() as u64);
        Ok(Self { sorted: Groups::of(sorter.finish().map_err(failed)?), count, folder })
    }

    /// How many pieces there are.
    pub(crate) fn count(&self) -> u64 {
        self.count
    }

    /// Hands all pieces of each object to `each`, in ascending order.
    pub(crate) fn for_each<K: PartialEq, E: From<ExportError>>(
        mut self,
        observer: &dyn Observer,
        object: impl Fn(&P) -> K,
        mut each: impl FnMut(Vec<P>) -> Result<(), E>,
    ) -> Result<(), E> {
        let folder = self.folder;
        let failed = |source| ExportError::Sort { folder: folder.to_path_buf(), source };
        let mut done = 0;
        while let Some(pieces) = self.sorted.next_by(&object).map_err(failed)? {
            stop_if_asked(observer)?;
            observer.done(Stage::Pieces, done, self.count);
            done += pieces.len() as u64;
            each(pieces)?;
        }
        Ok(())
    }
}
