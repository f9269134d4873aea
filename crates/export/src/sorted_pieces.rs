//! The pieces of all tiles, sorted by the object that they belong to.

use std::path::Path;

use corniche_geom::TileId;
use corniche_store::{Groups, SortRecord, Sorter};
use corniche_work::{Observer, Stage, workers::one_by_one};

use crate::error::FeaturesError;

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
        mut pieces: impl FnMut(TileId) -> Result<Vec<P>, FeaturesError>,
    ) -> Result<Self, FeaturesError> {
        let failed = |source| FeaturesError::Sort { folder: folder.to_path_buf(), source };
        let mut count = 0;
        one_by_one((observer, Stage::ExportTiles), tiles, |&id| {
            for piece in pieces(id)? {
                count += 1;
                sorter.push(piece).map_err(failed)?;
            }
            Ok::<(), FeaturesError>(())
        })?;
        Ok(Self { sorted: Groups::of(sorter.finish().map_err(failed)?), count, folder })
    }

    /// Hands all pieces of each object to `each`, in ascending order. The stage is begun; who calls ends it.
    pub(crate) fn for_each<K: PartialEq, E: From<FeaturesError>>(
        mut self,
        observer: &dyn Observer,
        object: impl Fn(&P) -> K,
        mut each: impl FnMut(Vec<P>) -> Result<(), E>,
    ) -> Result<(), E> {
        let folder = self.folder;
        let failed = |source| FeaturesError::Sort { folder: folder.to_path_buf(), source };
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
