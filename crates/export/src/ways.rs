//! The pieces of all tiles, sorted by way.

use std::path::Path;

use corniche_geom::TileId;
use corniche_roads::FunctionalRoadClass;
use corniche_store::{Groups, Sorter};
use corniche_tileset::FilePackage;

use crate::{
    error::ExportError,
    observer::{Observer, Stage, stop_if_asked},
    piece::{Piece, SortedPiece},
    read,
};

/// The pieces of one way after the other.
pub(crate) struct Ways<'a> {
    sorted: Groups<'a, SortedPiece>,
    /// How many pieces there are.
    count: u64,
    /// Where they were sorted.
    folder: &'a Path,
}

impl<'a> Ways<'a> {
    /// Reads tiles and sorts what `keep` leaves of each piece of a road of these classes. `sorter` sorts in `folder`.
    pub(crate) fn read(
        package: &FilePackage,
        tiles: &[TileId],
        classes: &[FunctionalRoadClass],
        (mut sorter, folder): (Sorter<'a, SortedPiece>, &'a Path),
        observer: &dyn Observer,
        keep: impl Fn(Piece) -> Vec<Piece>,
    ) -> Result<Self, ExportError> {
        let failed = |source| ExportError::Sort { folder: folder.to_path_buf(), source };
        let mut count = 0;
        for (done, &id) in tiles.iter().enumerate() {
            stop_if_asked(observer)?;
            observer.done(Stage::Tiles, done as u64, tiles.len() as u64);
            for piece in read::pieces(package, id, classes)?.into_iter().flat_map(&keep) {
                count += 1;
                sorter.push(SortedPiece(piece)).map_err(failed)?;
            }
        }
        observer.done(Stage::Tiles, tiles.len() as u64, tiles.len() as u64);
        Ok(Self { sorted: Groups::of(sorter.finish().map_err(failed)?), count, folder })
    }

    /// How many pieces there are.
    pub(crate) fn count(&self) -> u64 {
        self.count
    }

    /// Hands all pieces of each way to `each`, in ascending order of ids.
    pub(crate) fn for_each<E: From<ExportError>>(
        mut self,
        observer: &dyn Observer,
        mut each: impl FnMut(Vec<Piece>) -> Result<(), E>,
    ) -> Result<(), E> {
        let folder = self.folder;
        let failed = |source| ExportError::Sort { folder: folder.to_path_buf(), source };
        let mut done = 0;
        while let Some(pieces) =
            self.sorted.next_by(|SortedPiece(piece)| piece.key.way_id).map_err(failed)?
        {
            stop_if_asked(observer)?;
            observer.done(Stage::Pieces, done, self.count);
            done += pieces.len() as u64;
            each(pieces.into_iter().map(|SortedPiece(piece)| piece).collect())?;
        }
        Ok(())
    }
}
