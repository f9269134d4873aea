//! Reads the extract once, or the stored shares of it, and stores for each tile of each level what
//! the tile needs of each layer.
//!
//! ```text
//! extract ─► objects of a layer ─► parts by level and tile ─► sorted by tile ─► one artifact for each tile
//!                           └────► totals; of roads true lengths ─► one artifact for each block of roads
//!         defects ─► one artifact for each block of defects
//! ```
//!
//! Memory does not grow with the number of objects.

use std::{path::PathBuf, sync::atomic::Ordering};

use corniche_geom::{Bounds, LatticeBounds, LatticeRegion, Projection};
use corniche_layers::{LayerGeometry, LayerTable, LinePlacement};
use corniche_osm::{
    ExtractSummary, LayerReceiver, LayerSink, Layers, ReadOsmError, ReadRequest, read_extract,
    read_kept_roads,
};
use corniche_spec::{
    BuildObserver, Defect, RoadSettings,
    artifacts::{self, ArtifactKind},
    data_tiles::DataTiles,
    extent::{AreaExtent, ExtentOutline, ExtentParts},
    levels::Levels,
    true_lengths::TrueLengths,
};
use corniche_store::{Artifacts, ScratchSpace};
use corniche_tileset::LayerSlot;
use corniche_work::Stage;

use super::{kept::kept_in, no_road, placed_reading::PlacedReading};
use crate::{
    ExtractError,
    areas::layer::AreaSplitting,
    layers::{
        defects::{DefectsWriter, replay_defects},
        layer_writer::{LayerContext, LayerWriter},
        object_layer::ObjectLayer,
        plan_splitting::PlanSplitting,
        tile_section::LayerTotals,
    },
    lines::layer::LineSplitting,
    points::layer::PointSplitting,
    roads::{
        layer::RoadLayer,
        split::RoadSplitting,
        totals::{ExtractCounts, RoadTotals},
    },
};

/// The warning for stores that have the ways of some shares, but not the ways and nodes of all.
const SOME_SHARES: &str = "some chunks of the steps ways and nodes are missing from the stores, so the whole extract is read again";

/// The inputs of the partition.
pub struct ExtractInput<'a> {
    /// The extracts; at least one.
    pub osm: &'a [PathBuf],
    /// How roads are built.
    pub settings: &'a RoadSettings,
    /// The requested layers, in the package's order.
    pub layers: &'a [LayerTable],
    /// The tiles in which there can be data.
    pub data: DataTiles,
    /// WGS84 ⇄ the grid's working CRS.
    pub projection: &'a (dyn Projection + Sync),
    /// Tolerances and margins of levels.
    pub levels: &'a Levels,
    /// Measures roads.
    pub lengths: &'a TrueLengths<'a>,
    /// The data's rectangle, which contains all nodes at which there can be data.
    pub node_bounds: LatticeBounds,
    /// The requested bounds.
    pub clip: Option<LatticeBounds>,
    /// The requested bounds in degrees.
    pub bounds_deg: Option<[f64; 4]>,
    /// The outline of the elevation files, if they do not fill a rectangle.
    pub outline: Option<&'a ExtentOutline>,
    /// The rectangle around all elevation files, degrees.
    pub area_deg: Bounds,
    /// The requested polygon.
    pub polygon: Option<&'a LatticeRegion>,
    /// Threads for reading and splitting.
    pub pool: &'a rayon::ThreadPool,
    /// Memory for sorting.
    pub memory_bytes: u64,
}

/// Stores what tiles need of all layers, the lengths of all roads, the defects of the extract, and
/// finally the totals of roads. If the totals are in the store, everything else is, and nothing is
/// read. In both cases the observer receives the same defects in the same order.
///
/// # Errors
/// See [`ExtractError`].
pub fn partition(
    input: &ExtractInput<'_>,
    store: &dyn Artifacts,
    scratch: &dyn ScratchSpace,
    observer: &dyn BuildObserver,
) -> Result<RoadTotals, ExtractError> {
    if let Some(totals) = artifacts::get(store, ArtifactKind::RoadTotals.item(0))? {
        replay_defects(store, observer)?;
        return Ok(totals);
    }
    let told = LayerContext::begin(input.pool, observer, DefectsWriter::new(store, observer));
    let ((totals, extract), has_others) = read(input, (store, scratch), &told)?;
    if totals.roads == 0 {
        let why = no_road::why(&extract, &input.settings.table);
        if !has_others {
            let why = format!("{}; {}", why.reason, why.advice);
            return Err(ExtractError::NoRoads { osm: input.osm.to_vec(), why });
        }
        let (osm, reason) = (input.osm, why.reason);
        observer
            .warning(&format!("{osm:?} has no road: {reason}; only its other layers are included"));
    }
    let defects = told.end().finish()?;
    let totals = RoadTotals { defects, extract: ExtractCounts::from(&extract), ..totals };
    artifacts::put(store, ArtifactKind::RoadTotals.item(0), &totals)?;
    Ok(totals)
}

/// Reads all requested layers, and stores what tiles need of them. Returns what was found of roads,
/// and whether other layers were requested and the extract has objects of them: then roads are
/// optional.
fn read(
    input: &ExtractInput<'_>,
    places: (&dyn Artifacts, &dyn ScratchSpace),
    told: &LayerContext<'_>,
) -> Result<((RoadTotals, ExtractSummary), bool), ExtractError> {
    let (store, scratch) = places;
    let extent = area_extent(input, told.observer)?;
    let slots = (0..).map_while(LayerSlot::new).zip(input.layers);
    let writer = |of| ObjectWriter::new(input, of, (extent.as_ref(), places), told);
    let mut writers: Vec<ObjectWriter<'_, '_>> =
        slots.map(writer).collect::<Option<_>>().unwrap_or_default();
    let mut roads = LayerWriter::new(road_layer(input, places), told);
    let kept = kept_in(store);
    let of = kept.complete();
    if of.is_none() && kept.has_any() {
        told.observer.warning(SOME_SHARES);
    }
    let (observer, has_failed) = (told.observer, &told.has_failed);
    let should_stop = || observer.is_cancelled() || has_failed.load(Ordering::Relaxed);
    let on_defect = &mut |defect| told.on_defect(Defect::from(defect));
    let receivers = writers.iter_mut().map(ObjectWriter::receiver);
    let layers = Layers {
        layers: input.layers.iter().zip(receivers).collect(),
        // Shares contain roads only.
        roads: of.is_none().then_some(&mut roads as &mut dyn LayerSink<_, _>),
    };
    let read = if of.is_none() || !input.layers.is_empty() {
        on_extract(input, scratch, told, |request| {
            read_extract(request, layers, on_defect, &should_stop)
        })
    } else {
        Ok(())
    };
    // If something could not be stored, reading has ended.
    writers.iter_mut().try_for_each(ObjectWriter::check)?;
    roads.check()?;
    read?;
    let mut has_others = false;
    for writer in writers {
        has_others |= writer.done()?.is_some_and(|totals| totals.has_any());
    }
    if let Some(of) = of {
        let read = on_extract(input, scratch, told, |request| {
            read_kept_roads(request, of, kept, &mut roads, on_defect, &should_stop)
        });
        roads.check()?;
        read?;
    }
    Ok((roads.done()?.ok_or(ExtractError::Interrupted)?, has_others))
}

/// A layer while its objects are read.
enum ObjectWriter<'a, 'b> {
    Areas(LayerWriter<'a, 'b, ObjectLayer<'a, AreaSplitting<'a>>>),
    Lines(LayerWriter<'a, 'b, ObjectLayer<'a, LineSplitting<'a>>>),
    Points(LayerWriter<'a, 'b, ObjectLayer<'a, PointSplitting<'a>>>),
}

impl<'a, 'b> ObjectWriter<'a, 'b> {
    /// Creates the writer of a layer; `None` for a layer of areas without an extent.
    fn new(
        input: &ExtractInput<'a>,
        (slot, table): (LayerSlot, &'a LayerTable),
        (extent, places): (Option<&'a AreaExtent>, (&'a dyn Artifacts, &'a dyn ScratchSpace)),
        told: &'a LayerContext<'b>,
    ) -> Option<Self> {
        let ExtractInput { data, clip, polygon, levels, lengths, projection, .. } = *input;
        let plan = PlanSplitting { table, frame: levels.frame(), data, clip, polygon };
        let memory_bytes = input.memory_bytes;
        Some(match table.geometry() {
            LayerGeometry::Area => {
                let splitting = AreaSplitting { plan, extent: extent?, projection };
                let layer = ObjectLayer::new((slot, splitting), places, memory_bytes);
                Self::Areas(LayerWriter::new(layer, told))
            }
            LayerGeometry::Point => {
                let layer = ObjectLayer::new((slot, PointSplitting { plan }), places, memory_bytes);
                Self::Points(LayerWriter::new(layer, told))
            }
            LayerGeometry::Line => {
                let spans = input.settings.spans && table.form().placement == LinePlacement::Spans;
                let spans = spans.then_some(slot);
                let splitting = LineSplitting { plan, levels, lengths, spans };
                let layer = ObjectLayer::new((slot, splitting), places, memory_bytes);
                Self::Lines(LayerWriter::new(layer, told))
            }
        })
    }

    fn receiver(&mut self) -> LayerReceiver<'_> {
        match self {
            Self::Areas(writer) => LayerReceiver::Areas(writer),
            Self::Lines(writer) => LayerReceiver::Lines(writer),
            Self::Points(writer) => LayerReceiver::Points(writer),
        }
    }

    /// Fails if the layer's result could not be stored.
    fn check(&mut self) -> Result<(), ExtractError> {
        match self {
            Self::Areas(writer) => writer.check(),
            Self::Lines(writer) => writer.check(),
            Self::Points(writer) => writer.check(),
        }
    }

    fn done(self) -> Result<Option<LayerTotals>, ExtractError> {
        match self {
            Self::Areas(writer) => writer.done(),
            Self::Lines(writer) => writer.done(),
            Self::Points(writer) => writer.done(),
        }
    }
}

/// The extent of areas, if areas are requested.
fn area_extent(
    input: &ExtractInput<'_>,
    observer: &dyn BuildObserver,
) -> Result<Option<AreaExtent>, ExtractError> {
    if input.layers.iter().all(|table| table.geometry() != LayerGeometry::Area) {
        return Ok(None);
    }
    let boxes: Result<Option<Vec<[f64; 4]>>, _> =
        input.osm.iter().map(|path| corniche_osm::header_bounds_deg(path)).collect();
    let boxes_deg = boxes.map_err(ExtractError::Osm)?.unwrap_or_default();
    let parts = ExtentParts {
        frame: input.levels.frame(),
        projection: input.projection,
        nodes: input.node_bounds,
        data: input.outline,
        area_deg: input.area_deg,
        bounds_deg: input.bounds_deg,
        boxes_deg: &boxes_deg,
    };
    Ok(Some(AreaExtent::new(&parts).unwrap_or_else(|error| {
        observer.warning(&format!(
            "the sea and areas are clipped to the data's rectangle only: the bounds and the extracts' bounding boxes cannot be overlaid with it ({error})"
        ));
        AreaExtent::of_rectangle(input.node_bounds)
    })))
}

fn road_layer<'a>(
    input: &ExtractInput<'a>,
    places: (&'a dyn Artifacts, &'a dyn ScratchSpace),
) -> RoadLayer<'a> {
    let splitting = RoadSplitting {
        levels: input.levels,
        lengths: input.lengths,
        data_bounds: input.data.bounds(input.levels.frame()),
        node_bounds: input.node_bounds,
        clip: input.clip,
        polygon: input.polygon,
        spans: input.settings.spans,
    };
    RoadLayer::new(splitting, places, input.memory_bytes)
}

/// Reads the extract.
fn on_extract(
    input: &ExtractInput<'_>,
    scratch: &dyn ScratchSpace,
    told: &LayerContext<'_>,
    read: impl FnOnce(&ReadRequest<'_>) -> Result<(), ReadOsmError>,
) -> Result<(), ExtractError> {
    let reading = PlacedReading {
        osm: input.osm,
        table: &input.settings.table,
        frame: input.levels.frame(),
        projection: input.projection,
        node_ids: input.settings.spans,
        pool: input.pool,
        memory_bytes: input.memory_bytes,
    };
    let on_progress = |done, total| told.reached(Stage::Extract, done, total);
    reading.read(scratch, (told.observer, &on_progress), read)
}

#[cfg(test)]
#[path = "partition_tests.rs"]
mod tests;
