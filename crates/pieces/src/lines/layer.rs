//! A layer of lines of the extract: for each tile of each level, the section with what comes near it.

use std::collections::BTreeMap;

use corniche_areas::{ClassedLayer, LineClass, line_text};
use corniche_geom::{LatticePoint, Polyline, TileId};
use corniche_osm::{ClassedLine, LineSummary};
use corniche_spec::{artifacts::damaged, true_lengths::TrueLengths};
use corniche_store::{Artifacts, Scratch};
use corniche_tileset::{LineRecord, encode_lines};
use corniche_work::Stage;

use super::split::LineSplitting;
use crate::{
    ExtractError,
    layers::{
        SectionLayer,
        layer_totals::LineTotals,
        layer_writer::{LayerContext, TileLayer, TileSplitting},
        parts_by_tile::{PartsByTile, part_bytes, part_of_bytes},
        tile_section::TileSection,
    },
};

/// Parts of a tile are sorted by class and way; those of one way by where they begin, so that their order depends on what they are alone.
type PartOrder = (u8, i64, LatticePoint, u64);

/// How lines are split, and measured.
pub(crate) struct MeasuredSplitting<'a> {
    pub(crate) splitting: LineSplitting<'a>,
    pub lengths: &'a TrueLengths<'a>,
}

/// Lines of a layer as they come in.
pub(crate) struct LinesLayer<'a> {
    layer: ClassedLayer,
    splitting: MeasuredSplitting<'a>,
    store: &'a dyn Artifacts,
    parts: PartsByTile<'a, PartOrder>,
    /// The true lengths of all ways that were handed out, by class.
    lengths_um: BTreeMap<LineClass, u64>,
}

impl<'a> LinesLayer<'a> {
    pub(crate) fn new(
        layer: ClassedLayer,
        splitting: MeasuredSplitting<'a>,
        (store, scratch): (&'a dyn Artifacts, &'a dyn Scratch),
        memory_bytes: u64,
    ) -> Self {
        let parts = PartsByTile::new(scratch, memory_bytes);
        Self { layer, splitting, store, parts, lengths_um: BTreeMap::new() }
    }
}

/// A line that was split.
pub(crate) struct SplitLine {
    class: LineClass,
    length_um: u64,
    parts: Vec<(TileId, PartOrder, Vec<u8>)>,
}

impl TileSplitting for MeasuredSplitting<'_> {
    type Object = ClassedLine;
    type Split = SplitLine;

    fn points(line: &ClassedLine) -> usize {
        line.points.len()
    }

    fn split_object(&self, _: u64, object: ClassedLine) -> SplitLine {
        let class = object.class;
        let Ok(line) = Polyline::new(object.points.clone()) else {
            return SplitLine { class, length_um: 0, parts: Vec::new() };
        };
        let part = |(number, (id, record)): (u64, (TileId, LineRecord))| {
            let order = (class.number(), record.way_id, record.points[0], number);
            (id, order, part_bytes(&record.points))
        };
        SplitLine {
            class,
            length_um: self.lengths.segments_um(&line).iter().sum(),
            parts: (0..).zip(self.splitting.split(&object)).map(part).collect(),
        }
    }
}

impl<'a> TileLayer for LinesLayer<'a> {
    type Splitting = MeasuredSplitting<'a>;
    type Summary = LineSummary;
    type Done = LineTotals;

    fn stage(&self) -> Stage {
        SectionLayer::Lines(self.layer).stage()
    }

    fn splitting(&self) -> &MeasuredSplitting<'a> {
        &self.splitting
    }

    fn take(&mut self, split: SplitLine) -> Result<(), ExtractError> {
        *self.lengths_um.entry(split.class).or_default() += split.length_um;
        split.parts.into_iter().try_for_each(|(id, order, bytes)| self.parts.push(id, order, bytes))
    }

    /// Keeps the sections of all tiles and last the totals.
    fn finish(
        self,
        _: u64,
        summary: LineSummary,
        told: &LayerContext<'_>,
    ) -> Result<LineTotals, ExtractError> {
        let (splitting, store) = (&self.splitting.splitting.plan, self.store);
        let (own, layer) = (self.layer, SectionLayer::Lines(self.layer));
        self.parts.for_each_tile(
            told.observer,
            |parts: &mut Vec<LineRecord>, tile, (class, way_id, ..), bytes| {
                let class = own.class(class);
                let part = class.zip(part_of_bytes(&bytes)).ok_or_else(|| {
                    let key = layer.section().item(tile);
                    damaged(key, &line_text!(own, "what was read back is no " one))
                });
                let (class, points) = part?;
                parts.push(LineRecord { way_id, class, points });
                Ok(())
            },
            |tile, parts| {
                let points = parts.iter().map(|line| line.points.len() as u64).sum();
                let counts = [parts.len() as u64, points];
                TileSection::put((layer, tile), store, counts, |id| {
                    encode_lines(id, own, splitting.step(id.z()), &parts)
                })
            },
        )?;
        let kept = summary.kept.iter().map(|(class, &ways)| {
            let length_um = self.lengths_um.get(class).copied().unwrap_or_default();
            (class.number(), (ways, length_um))
        });
        let totals = LineTotals {
            objects: summary.ways,
            kept: kept.collect(),
            lost: summary.lost.iter().map(|(loss, &n)| (loss.reason(own).to_owned(), n)).collect(),
        };
        totals.put(layer, store)?;
        Ok(totals)
    }
}
