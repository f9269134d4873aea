//! The roads of the extract: the pieces that each tile of each level needs, and the true lengths of
//! all roads.

use corniche_geom::TileId;
use corniche_osm::ExtractSummary;
use corniche_roads::{FunctionalRoadClass, Railway, Road, Structure};
use corniche_spec::artifacts::ArtifactKind;
use corniche_store::{Artifacts, ScratchSpace};
use corniche_work::Stage;

use super::{
    near_spans::{NearRoad, NearRoadsWriter},
    pieces::RoadPiece,
    split::{RoadSplitting, SplitRoad},
    totals::{RoadLength, RoadTotals, lengths_writer},
};
use crate::{
    ExtractError,
    layers::{
        blocks::ListBlockWriter,
        layer_writer::{LayerContext, LayerEncoder, SplitOf, TileSplitting},
        parts_by_tile::{PartsByTile, joined_parts},
    },
};

/// The distance from a node of a bridge or a tunnel, in true metres, within which the directions of
/// roads are considered.
pub const NEAR_M: f64 = 20.0;

/// Receives roads in the order in which they are read.
pub(crate) struct RoadLayer<'a> {
    splitting: RoadSplitting<'a>,
    store: &'a dyn Artifacts,
    totals: RoadTotals,
    lengths: ListBlockWriter<'a, RoadLength>,
    pieces: PartsByTile<'a, u32>,
    /// The roads near bridges and tunnels, if these become spans.
    near_spans: Option<NearRoadsWriter<'a>>,
}

impl<'a> RoadLayer<'a> {
    pub(crate) fn new(
        splitting: RoadSplitting<'a>,
        (store, scratch): (&'a dyn Artifacts, &'a dyn ScratchSpace),
        memory_bytes: u64,
    ) -> Self {
        let spans = splitting.spans;
        Self {
            splitting,
            store,
            totals: RoadTotals {
                classes: vec![(0, 0); FunctionalRoadClass::COUNT],
                ..RoadTotals::default()
            },
            lengths: lengths_writer(store),
            pieces: PartsByTile::new(scratch, memory_bytes / 4 * 3),
            near_spans: spans.then(|| NearRoadsWriter::new(scratch, memory_bytes / 4)),
        }
    }
}

impl TileSplitting for RoadSplitting<'_> {
    type Object = Road;
    type Split = (SplitRoad, Vec<(TileId, u32, Vec<u8>)>);

    fn points(road: &Road) -> usize {
        road.line.points().len()
    }

    fn split_object(&self, number: u64, road: Road) -> Self::Split {
        let number = number as u32;
        let mut road = self.split(number, &road);
        let pieces = std::mem::take(&mut road.pieces).into_iter();
        let piece = |(id, piece): (TileId, RoadPiece)| (id, number, piece.to_bytes(number));
        (road, pieces.map(piece).collect())
    }
}

impl<'a> LayerEncoder for RoadLayer<'a> {
    type Splitting = RoadSplitting<'a>;
    type Summary = ExtractSummary;
    type Done = (RoadTotals, ExtractSummary);
    const STAGE: Stage = Stage::Roads;

    fn splitting(&self) -> &RoadSplitting<'a> {
        &self.splitting
    }

    fn take_carrier(&mut self, road: Road, railway: Option<Railway>) -> Result<(), ExtractError> {
        let Some(near_spans) = &mut self.near_spans else { return Ok(()) };
        let is_reached = self.splitting.reaches(&road);
        // Lines of layers are on this way, too, and refer to positions along it.
        let segments_um = match road.attributes.structure {
            Structure::Ground => Vec::new(),
            _ => self.splitting.lengths.projected_segments_um(&road.line),
        };
        near_spans.push(NearRoad::of_carrier(&road, railway, &segments_um, is_reached))
    }

    fn take(&mut self, (road, pieces): SplitOf<Self>) -> Result<(), ExtractError> {
        self.totals.roads += 1;
        let length_um = road.length.length_um;
        self.totals.length_um += length_um;
        let class = &mut self.totals.classes[usize::from(road.class.number())];
        *class = (class.0 + 1, class.1 + length_um);
        if let Some(own) = road.bounds {
            let bounds = &mut self.totals.bounds;
            *bounds = Some(bounds.map_or(own, |all| all.union(&own)));
        }
        if let Some((near, near_spans)) = road.near.zip(self.near_spans.as_mut()) {
            near_spans.push(near)?;
        }
        self.lengths.push(road.length)?;
        pieces.into_iter().try_for_each(|(id, ordinal, bytes)| self.pieces.push(id, ordinal, bytes))
    }

    /// Stores the last lengths and the pieces of all tiles.
    fn finish(
        self,
        _: u64,
        summary: ExtractSummary,
        told: &LayerContext<'_>,
    ) -> Result<Self::Done, ExtractError> {
        self.lengths.finish()?;
        self.pieces.for_each_tile(told.observer, |tile, pieces| {
            Ok(self.store.put(ArtifactKind::RoadPieces.item(tile), &joined_parts(pieces))?)
        })?;
        if let Some(near_spans) = self.near_spans {
            let reach = self.splitting.levels.steps_of_true(NEAR_M);
            near_spans.finish((self.store, told.observer), reach)?;
        }
        Ok((self.totals, summary))
    }
}
