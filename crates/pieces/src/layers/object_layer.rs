//! Layers of areas, lines and points: each tile of each level gets a section with the objects in or
//! near it.

use std::collections::BTreeMap;

use corniche_areas::OutlineError;
use corniche_geom::{LatticePoint, TileId};
use corniche_layers::{AttributeValue, OsmObject};
use corniche_osm::{AreaLoss, ExtractDefect};
use corniche_spec::{Defect, artifacts::damaged};
use corniche_store::{Artifacts, ScratchSpace, append_record, record_bytes, take_record};
use corniche_tileset::{LayerCoding, LayerObject, LayerShape, LayerSlot, encode_layer};
use corniche_work::Stage;

use super::{
    SectionLayer,
    layer_writer::{LayerContext, LayerEncoder, TileSplitting},
    parts_by_tile::{PartsByTile, joined_parts},
    plan_splitting::PlanSplitting,
    span_pieces,
    tile_section::{LayerTotals, ObjectMeasure, TileSection},
};
use crate::ExtractError;

/// How the objects of one geometry are split by tile.
pub(crate) trait ObjectSplitting: TileSplitting<Split = SplitObject> {
    /// The counts of the reader.
    type Summary: Into<LayerTotals>;

    /// The tiles and levels for which objects are split.
    fn plan(&self) -> &PlanSplitting<'_>;

    /// Whether objects may be on bridges and in tunnels.
    fn has_spans(&self) -> bool {
        false
    }

    /// Creates the object that follows from all others, such as the sea, and counts it.
    fn last_object(
        &self,
        _summary: &mut Self::Summary,
        _on_defect: &mut dyn FnMut(ExtractDefect),
    ) -> Option<Self::Object> {
        None
    }
}

/// The order of a tile's parts: by class and object, and parts of one object by their start, so
/// that the order depends on the parts alone.
type PartOrder = (u8, OsmObject, LatticePoint, u64);

/// The order of a tile's parts on bridges and in tunnels: by way and position.
type SpanOrder = (i64, LatticePoint, u64);
/// A part on a bridge or in a tunnel: its tile, its order there, and its bytes.
type EncodedSpan = (TileId, SpanOrder, Vec<u8>);

/// An object that has been split.
pub(crate) struct SplitObject {
    class: u8,
    object: OsmObject,
    measure: ObjectMeasure,
    parts: Result<Vec<(TileId, PartOrder, Vec<u8>)>, OutlineError>,
    /// The parts on bridges and in tunnels.
    spans: Vec<EncodedSpan>,
}

impl SplitObject {
    /// Encodes the parts of an object.
    pub(crate) fn new(
        (class, object): (u8, OsmObject),
        values: &[Option<AttributeValue>],
        measure: ObjectMeasure,
        shapes: Result<Vec<(TileId, LayerShape)>, OutlineError>,
    ) -> Self {
        // The fields of a `LayerObject`, in their order.
        let head = record_bytes((class, object, values));
        let part = |(number, (id, shape)): (u64, (TileId, LayerShape))| {
            let start = shape.points().next().copied().unwrap_or(LatticePoint::new(0, 0));
            let mut bytes = head.clone();
            append_record(&mut bytes, shape);
            (id, (class, object, start, number), bytes)
        };
        let parts = shapes.map(|shapes| (0..).zip(shapes).map(part).collect());
        Self { class, object, measure, parts, spans: Vec::new() }
    }

    /// Returns the same object with its parts on bridges and in tunnels.
    pub(crate) fn with_spans(self, spans: Vec<EncodedSpan>) -> Self {
        Self { spans, ..self }
    }
}

/// Receives the objects of a layer in the order in which they are read.
pub(crate) struct ObjectLayer<'a, S> {
    splitting: S,
    slot: LayerSlot,
    coding: LayerCoding,
    store: &'a dyn Artifacts,
    parts: PartsByTile<'a, PartOrder>,
    /// The parts on bridges and in tunnels; `None` if the layer has none.
    spans: Option<PartsByTile<'a, SpanOrder>>,
    /// The sizes of all objects that were read and split, by class.
    measures: BTreeMap<u8, ObjectMeasure>,
    /// Objects that were too complex to split.
    intricate: Vec<(u8, OsmObject)>,
}

impl<'a, S: ObjectSplitting> ObjectLayer<'a, S> {
    pub(crate) fn new(
        (slot, splitting): (LayerSlot, S),
        (store, scratch): (&'a dyn Artifacts, &'a dyn ScratchSpace),
        memory_bytes: u64,
    ) -> Self {
        let coding = LayerCoding::from_table(splitting.plan().table.form());
        let has_spans = splitting.has_spans();
        let part_bytes = if has_spans { memory_bytes / 4 * 3 } else { memory_bytes };
        let parts = PartsByTile::new(scratch, part_bytes);
        let spans = has_spans.then(|| PartsByTile::new(scratch, memory_bytes / 4));
        let (measures, intricate) = (BTreeMap::new(), Vec::new());
        Self { splitting, slot, coding, store, parts, spans, measures, intricate }
    }
}

impl<S: ObjectSplitting> LayerEncoder for ObjectLayer<'_, S> {
    type Splitting = S;
    type Summary = S::Summary;
    type Done = LayerTotals;
    const STAGE: Stage = Stage::Layers;

    fn splitting(&self) -> &S {
        &self.splitting
    }

    fn take(&mut self, split: SplitObject) -> Result<(), ExtractError> {
        let SplitObject { class, object, measure, parts, spans } = split;
        let Ok(parts) = parts else {
            self.intricate.push((class, object));
            return Ok(());
        };
        self.measures.entry(class).or_default().add(measure);
        if let Some(all) = &mut self.spans {
            spans.into_iter().try_for_each(|(id, order, bytes)| all.push(id, order, bytes))?;
        }
        parts.into_iter().try_for_each(|(id, order, bytes)| self.parts.push(id, order, bytes))
    }

    /// Stores the sections of all tiles and finally the totals.
    fn finish(
        mut self,
        count: u64,
        mut summary: S::Summary,
        told: &LayerContext<'_>,
    ) -> Result<LayerTotals, ExtractError> {
        let on_defect = &mut |defect| told.on_defect(Defect::from(defect));
        if let Some(last) = self.splitting.last_object(&mut summary, on_defect) {
            let split = self.splitting.split_object(count, last);
            self.take(split)?;
        }
        let mut totals: LayerTotals = summary.into();
        let loss = AreaLoss::TooIntricate;
        for &(class, object) in &self.intricate {
            if let Some(kept) = totals.kept.get_mut(&class) {
                kept.objects -= 1;
            }
            *totals.lost.entry(loss.reason().to_owned()).or_default() += 1;
            on_defect(ExtractDefect::LostArea { object, loss });
        }
        for (class, kept) in &mut totals.kept {
            kept.measure = self.measures.get(class).copied().unwrap_or_default();
        }
        let (plan, store) = (self.splitting.plan(), self.store);
        let (slot, layer) = (self.slot, SectionLayer::Extract(self.slot));
        self.parts.for_each_tile(told.observer, |tile, parts| {
            let objects = parts.into_iter().map(|bytes| take_record(&mut &bytes[..]));
            let objects: Vec<LayerObject> = objects.collect::<Option<_>>().ok_or_else(|| {
                let key = layer.section_key(tile);
                damaged(key, &"the record read back is not an object of a layer")
            })?;
            let points = objects.iter().map(|object| object.shape.points().count() as u64);
            let counts = [objects.len() as u64, points.sum()];
            TileSection::put((layer, tile), store, counts, |id| {
                encode_layer(id, plan.frame, slot, &self.coding, plan.step(id.z()), &objects)
            })
        })?;
        if let Some(spans) = self.spans {
            spans.for_each_tile(told.observer, |tile, pieces| {
                Ok(store.put(span_pieces::key(slot, tile), &joined_parts(pieces))?)
            })?;
        }
        totals.put(layer, store)?;
        Ok(totals)
    }
}

/// The memory of an object's values, in points of a line.
pub(crate) fn value_points(values: &[Option<AttributeValue>]) -> usize {
    let of_value = |value: &AttributeValue| match value {
        AttributeValue::Names(names) => 8 * names.len(),
        _ => 1,
    };
    values.iter().flatten().map(of_value).sum()
}
