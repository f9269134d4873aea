//! Delivers points and their defects in the order of the objects: nodes, ways, relations.

use corniche_areas::inside_point;
use corniche_geom::LatticePoint;
use corniche_layers::LayerTable;
use corniche_store::take_record;

use super::{
    isolation::NodeIsolations,
    layer_point::{LayerPoint, PointSummary},
};
use crate::{
    AreaLoss, ExtractDefect,
    areas::{AreaSummary, LayerArea, hand_out_areas},
    failed::Failed,
    layer_sink::LayerSink,
    location::{self, Location, degrees},
    outlines::{
        found::OutlineObjects,
        located_ways::LocatedWays,
        number_objects::NumberedObjects,
        records::{ObjectRecord, take_values},
    },
    reading::ExtractReading,
};

/// The number of nodes that are placed at a time.
const NODES_PER_BATCH: usize = 1 << 12;

/// Delivers the points of a layer and their defects.
pub(crate) fn hand_out_points<'a>(
    reading: &ExtractReading<'a>,
    table: &LayerTable,
    (mut objects, located): (OutlineObjects<'a>, LocatedWays<'a>),
    sink: &mut dyn LayerSink<LayerPoint, PointSummary>,
    on_defect: &mut dyn FnMut(ExtractDefect),
) -> Result<(), Failed> {
    sink.begin();
    let mut summary = PointSummary::default();
    if let Some(mut nodes) = objects.nodes.take() {
        let [known, none] = nodes.known;
        let (known, isolations) =
            NodeIsolations::measure(reading, table, (known, objects.held_bytes))?;
        nodes.known = [known, none];
        hand_out_nodes(reading, (nodes, isolations), &mut summary, sink, on_defect)?;
    }
    let mut areas = InsideAreas { sink, summary };
    hand_out_areas(reading, (objects, located), &mut areas, on_defect)?;
    let InsideAreas { sink, summary } = areas;
    sink.end(summary);
    Ok(())
}

fn hand_out_nodes(
    reading: &ExtractReading<'_>,
    (nodes, mut isolations): (NumberedObjects<'_>, Option<NodeIsolations>),
    summary: &mut PointSummary,
    sink: &mut dyn LayerSink<LayerPoint, PointSummary>,
    on_defect: &mut dyn FnMut(ExtractDefect),
) -> Result<(), Failed> {
    let NumberedObjects { known: [known, _], counts: [all, _], duplicates, unread, .. } = nodes;
    (summary.objects, summary.unread) = (all + duplicates, unread);
    if duplicates > 0 {
        summary.lost.insert(AreaLoss::Duplicate, duplicates);
    }
    let mut known = known.read();
    let mut done = 0;
    loop {
        reading.check_stop()?;
        let mut batch: Vec<ObjectRecord> = Vec::new();
        while batch.len() < NODES_PER_BATCH
            && let Some(node) = known.next(take_record)?
        {
            batch.push(node);
        }
        if batch.is_empty() {
            return Ok(());
        }
        done += batch.len() as u64;
        let at = |node: &ObjectRecord| node.at.unwrap_or(location::MISSING);
        let positions_deg: Vec<[f64; 2]> =
            batch.iter().map(|node| degrees(at(node)).unwrap_or_default()).collect();
        let placed = (reading.request.place)(&positions_deg);
        for (node, placed) in batch.into_iter().zip(placed) {
            let object = node.object;
            let mut values = take_values(&node.values)?;
            if let Some(isolations) = &mut isolations {
                isolations.set_next(&mut values);
            }
            match (node.class, place_of(at(&node), placed)) {
                (Some(class), Ok(at)) => {
                    *summary.kept.entry(class).or_default() += 1;
                    sink.take(LayerPoint { object, class, values, at });
                }
                (_, found) => {
                    let loss = found.err().unwrap_or(AreaLoss::OutOfRange);
                    *summary.lost.entry(loss).or_default() += 1;
                    on_defect(ExtractDefect::LostArea { object, loss });
                }
            }
        }
        sink.reached(done, all);
    }
}

/// Returns the place of a node, or why it has none.
fn place_of(at: Location, placed: Option<LatticePoint>) -> Result<LatticePoint, AreaLoss> {
    degrees(at).ok_or(AreaLoss::OutOfRange)?;
    placed.ok_or(AreaLoss::OutsideProjection)
}

/// Turns areas into points inside them.
struct InsideAreas<'s> {
    sink: &'s mut dyn LayerSink<LayerPoint, PointSummary>,
    summary: PointSummary,
}

impl LayerSink<LayerArea, AreaSummary> for InsideAreas<'_> {
    fn take(&mut self, area: LayerArea) {
        let LayerArea { object, class, values, polygons, .. } = area;
        if let Some(at) = inside_point(&polygons) {
            self.sink.take(LayerPoint { object, class, values, at });
        }
    }

    fn reached(&mut self, done: u64, all: u64) {
        self.sink.reached(done, all);
    }

    fn end(&mut self, areas: AreaSummary) {
        self.summary.objects += areas.objects;
        for (class, kept) in areas.kept {
            *self.summary.kept.entry(class).or_default() += kept.areas;
        }
        for (loss, objects) in areas.lost {
            *self.summary.lost.entry(loss).or_default() += objects;
        }
        for (key, values) in areas.unread {
            *self.summary.unread.entry(key).or_default() += values;
        }
    }
}
