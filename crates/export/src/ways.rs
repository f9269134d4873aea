//! The pieces of all tiles, sorted by way.

use std::path::Path;

use corniche_geom::TileId;
use corniche_roads::FunctionalRoadClass;
use corniche_store::{Groups, Sorter};
use corniche_tileset::FilePackage;
use corniche_work::{Observer, Stage, workers::one_by_one};

use crate::{
    error::ExportError,
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
        one_by_one((observer, Stage::ExportTiles), tiles, |&id| {
            for piece in read::pieces(package, id, classes)?.into_iter().flat_map(&keep) {
                count += 1;
                sorter.push(SortedPiece(piece)).map_err(failed)?;
            }
            Ok::<(), ExportError>(())
        })?;
        Ok(Self { sorted: Groups::of(sorter.finish().map_err(failed)?), count, folder })
    }

    /// Hands all pieces of each way to `each`, in ascending order of ids. The stage is begun; who calls ends it.
    pub(crate) fn for_each<E: From<ExportError>>(
        mut self,
        observer: &dyn Observer,
        mut each: impl FnMut(Vec<Piece>) -> Result<(), E>,
    ) -> Result<(), E> {
        let folder = self.folder;
        let failed = |source| ExportError::Sort { folder: folder.to_path_buf(), source };
        observer.begin(Stage::ExportFeatures, Some(self.count));
        while let Some(pieces) =
            self.sorted.next_by(|SortedPiece(piece)| piece.key.way_id).map_err(failed)?
        {
            observer.check().map_err(ExportError::from)?;
            let count = pieces.len() as u64;
            each(pieces.into_iter().map(|SortedPiece(piece)| piece).collect())?;
            observer.advance(Stage::ExportFeatures, count);
        }
        Ok(())
    }
}
