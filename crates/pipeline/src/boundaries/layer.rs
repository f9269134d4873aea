//! The boundaries of the extract: for each tile of each level, the section with what comes near it.

use std::collections::BTreeMap;

use corniche_areas::BoundaryClass;
use corniche_geom::{LatticePoint, Polyline, TileId};
use corniche_osm::{Boundary, BoundarySummary};
use corniche_store::{Artifacts, Scratch};
use corniche_tileset::{BoundaryRecord, encode_boundaries};
use corniche_work::Stage;

use super::split::BoundarySplitting;
use crate::{
    BuildError,
    artifacts::{damaged, tile_of},
    layers::{
        SectionLayer,
        layer_totals::BoundaryTotals,
        layer_writer::{LayerContext, TileLayer, TileSplitting},
        parts_by_tile::PartsByTile,
        tile_section::TileSection,
    },
    true_lengths::TrueLengths,
};

/// Parts of a tile are sorted by class and way; those of one way by where they begin, so that their order depends on what they are alone.
type PartOrder = (u8, i64, LatticePoint, u64);

/// How boundaries are split, and measured.
pub(crate) struct MeasuredSplitting<'a> {
    pub(crate) splitting: BoundarySplitting<'a>,
    pub(crate) lengths: &'a TrueLengths<'a>,
}

/// Boundaries as they come in.
pub(crate) struct BoundaryLayer<'a> {
    splitting: MeasuredSplitting<'a>,
    store: &'a dyn Artifacts,
    parts: PartsByTile<'a, PartOrder>,
    /// The true lengths of all ways that were handed out, by class.
    lengths_um: BTreeMap<BoundaryClass, u64>,
}

impl<'a> BoundaryLayer<'a> {
    pub(crate) fn new(
        splitting: MeasuredSplitting<'a>,
        (store, scratch): (&'a dyn Artifacts, &'a dyn Scratch),
        memory_bytes: u64,
    ) -> Self {
        let parts = PartsByTile::new(scratch, memory_bytes);
        Self { splitting, store, parts, lengths_um: BTreeMap::new() }
    }
}

/// A boundary that was split.
pub(crate) struct SplitBoundary {
    class: BoundaryClass,
    length_um: u64,
    parts: Vec<(TileId, PartOrder, Vec<u8>)>,
}

impl TileSplitting for MeasuredSplitting<'_> {
    type Object = Boundary;
    type Split = SplitBoundary;

    fn points(boundary: &Boundary) -> usize {
        boundary.points.len()
    }

    fn split_object(&self, _: u64, boundary: Boundary) -> SplitBoundary {
        let class = boundary.class;
        let Ok(line) = Polyline::new(boundary.points.clone()) else {
            return SplitBoundary { class, length_um: 0, parts: Vec::new() };
        };
        let part = |(number, (id, record)): (u64, (TileId, BoundaryRecord))| {
            let order = (class.number(), record.way_id, record.points[0], number);
            (id, order, points_to_bytes(&record.points))
        };
        SplitBoundary {
            class,
            length_um: self.lengths.segments_um(&line).iter().sum(),
            parts: (0..).zip(self.splitting.split(&boundary)).map(part).collect(),
        }
    }
}

impl<'a> TileLayer for BoundaryLayer<'a> {
    const STAGE: Stage = Stage::Boundaries;
    type Splitting = MeasuredSplitting<'a>;
    type Summary = BoundarySummary;
    type Done = BoundaryTotals;

    fn splitting(&self) -> &MeasuredSplitting<'a> {
        &self.splitting
    }

    fn take(&mut self, split: SplitBoundary) -> Result<(), BuildError> {
        *self.lengths_um.entry(split.class).or_default() += split.length_um;
        split.parts.into_iter().try_for_each(|(id, order, bytes)| self.parts.push(id, order, bytes))
    }

    /// Keeps the sections of all tiles and last the totals.
    fn finish(
        self,
        _: u64,
        summary: BoundarySummary,
        told: &LayerContext<'_>,
    ) -> Result<BoundaryTotals, BuildError> {
        let (splitting, store) = (&self.splitting.splitting, self.store);
        self.parts.for_each_tile(
            told.observer,
            |parts: &mut Vec<BoundaryRecord>, tile, (class, way_id, ..), bytes| {
                let class = BoundaryClass::from_number(class);
                let part = class.zip(points_of_bytes(&bytes)).ok_or_else(|| {
                    let key = SectionLayer::Boundaries.section().item(tile);
                    damaged(key, &"what was read back is no boundary")
                });
                let (class, points) = part?;
                parts.push(BoundaryRecord { way_id, class, points });
                Ok(())
            },
            |tile, parts| put_section(tile, &parts, splitting, store),
        )?;
        let kept = summary.kept.iter().map(|(class, &ways)| {
            let length_um = self.lengths_um.get(class).copied().unwrap_or_default();
            (class.number(), (ways, length_um))
        });
        let totals = BoundaryTotals {
            objects: summary.ways,
            kept: kept.collect(),
            lost: summary.lost.iter().map(|(loss, &n)| (loss.reason().to_owned(), n)).collect(),
        };
        totals.put(SectionLayer::Boundaries, store)?;
        Ok(totals)
    }
}

fn points_to_bytes(points: &[LatticePoint]) -> Vec<u8> {
    // Writing to a list cannot fail, and all of it can be written.
    let written = bincode::serde::encode_to_vec(points, bincode::config::standard());
    debug_assert!(written.is_ok());
    written.unwrap_or_default()
}

fn points_of_bytes(bytes: &[u8]) -> Option<Vec<LatticePoint>> {
    let read = bincode::serde::decode_from_slice(bytes, bincode::config::standard());
    read.ok().map(|(points, _)| points)
}

fn put_section(
    tile: u64,
    boundaries: &[BoundaryRecord],
    splitting: &BoundarySplitting<'_>,
    store: &dyn Artifacts,
) -> Result<(), BuildError> {
    let id: TileId = tile_of(SectionLayer::Boundaries.section().item(tile))?;
    let Some(section) = encode_boundaries(id, splitting.step(id.z()), boundaries)? else {
        return Ok(());
    };
    let kept = TileSection {
        section: section.into_bytes(),
        parts: boundaries.len() as u64,
        points: boundaries.iter().map(|boundary| boundary.points.len() as u64).sum(),
    };
    kept.put(SectionLayer::Boundaries, store, id)
}
