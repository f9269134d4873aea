//! Pieces of roads in order of their class, so that each class is one range.

use serde::{Deserialize, Serialize};
use std::ops::Range;

use corniche_roads::FunctionalRoadClass;

use super::{
    super::blocks::{Recorded, records},
    RoadEnd, RoadKind,
};

/// A piece of a road, or of a line that is drawn as a road.
pub(crate) trait Classed {
    fn kind(&self) -> RoadKind;
}

/// All pieces of the roads of a tile for one method, in order of class.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(bound = "T: Recorded")]
pub struct RoadList<T> {
    #[serde(with = "records")]
    pieces: Vec<T>,
    pub(crate) ranges: [Range<u32>; FunctionalRoadClass::COUNT],
    ends: Vec<RoadEnd>,
}

impl<T> RoadList<T> {
    /// Sorts pieces by class.
    pub(crate) fn sorted(mut pieces: Vec<T>, ends: Vec<RoadEnd>) -> Self
    where
        T: Classed,
    {
        let class_of = |piece: &T| piece.kind().class;
        pieces.sort_by_key(class_of);
        let mut ranges = [const { 0..0 }; FunctionalRoadClass::COUNT];
        for (class, range) in FunctionalRoadClass::all().zip(&mut ranges) {
            let start = pieces.partition_point(|piece| class_of(piece) < class);
            let end = pieces.partition_point(|piece| class_of(piece) <= class);
            *range = start as u32..end as u32;
        }
        Self { pieces, ranges, ends }
    }

    /// Merges the pieces and ends of several lists of one tile.
    pub(crate) fn joined<'a>(lists: impl Iterator<Item = &'a Self> + Clone) -> Self
    where
        T: Classed + Clone + 'a,
    {
        let pieces = lists.clone().flat_map(|list| list.pieces.iter().cloned()).collect();
        let ends = lists.flat_map(|list| list.ends.iter().copied()).collect();
        Self::sorted(pieces, ends)
    }

    /// The pieces, most important class first.
    #[must_use]
    pub fn all(&self) -> &[T] {
        &self.pieces
    }

    /// The range of the pieces of a class.
    pub(crate) fn range_of(&self, class: FunctionalRoadClass) -> Range<u32> {
        self.ranges[usize::from(class.number())].clone()
    }

    /// The kinds of the roads of a class.
    pub(crate) fn kinds_of(&self, class: FunctionalRoadClass) -> impl Iterator<Item = RoadKind>
    where
        T: Classed,
    {
        let range = self.range_of(class);
        self.pieces[range.start as usize..range.end as usize].iter().map(T::kind)
    }

    /// Points where the roads meet the tile's border.
    pub(crate) fn ends(&self) -> &[RoadEnd] {
        &self.ends
    }
}

impl<T> Default for RoadList<T> {
    fn default() -> Self {
        Self { pieces: Vec::new(), ranges: Default::default(), ends: Vec::new() }
    }
}
