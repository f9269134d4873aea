//! Reads the extract once, or what was kept of it in shares, and keeps, for each tile of each level, what it needs of each layer.
//!
//! ```text
//! extract ─► objects of a layer ─► parts by level and tile ─► sorted by tile ─► one artifact for each tile
//!                           └────► totals; of roads true lengths ─► one artifact for each block of roads
//!         defects ─► one artifact for each block of defects
//! ```
//!
//! Nothing that grows with the number of objects stays in memory.

use std::{path::PathBuf, sync::atomic::Ordering};

use corniche_areas::{AreaTable, ClassedLayer};
use corniche_geom::{Bounds, LatticeBounds, LatticeRegion, Projection};
use corniche_osm::{
    ExtractSummary, LayerSink, Layers, ReadOsmError, ReadRequest, read_extract, read_kept_roads,
};
use corniche_spec::{
    Defect, Observer, RoadSettings,
    artifacts::{self, Kind},
    data_tiles::DataTiles,
    extent::{AreaExtent, ExtentParts, Outline},
    levels::Levels,
    true_lengths::TrueLengths,
};
use corniche_store::{Artifacts, Scratch};
use corniche_work::Stage;

use super::{kept::kept_in, no_road, placed_reading::PlacedReading};
use crate::{
    ExtractError,
    areas::{
        layer::{AreaLayer, AreaSplitting},
        sea::SeaPlace,
    },
    layers::{
        defects::{DefectsWriter, replay_defects},
        layer_writer::{LayerContext, LayerWriter},
        plan_splitting::PlanSplitting,
    },
    lines::layer::{LineSplitting, LinesLayer, MeasuredSplitting},
    roads::{
        layer::RoadLayer,
        split::RoadSplitting,
        totals::{ExtractCounts, RoadTotals},
    },
};

/// What is said if the ways of some shares are there, but not ways and nodes of all.
const SOME_SHARES: &str = "not all shares of the steps ways and nodes are in the stores, so the whole extract is read again";

/// What the partition needs.
pub struct ExtractInput<'a> {
    /// Never empty.
    pub osm: &'a [PathBuf],
    /// How roads are made.
    pub settings: &'a RoadSettings,
    /// Which objects are areas, if any are wanted.
    pub areas: Option<&'a AreaTable>,
    /// The layers of lines that are wanted.
    pub lines: &'a [ClassedLayer],
    /// The tiles on which data can lie.
    pub data: DataTiles,
    /// WGS84 ⇄ the grid's working CRS.
    pub projection: &'a (dyn Projection + Sync),
    /// Tolerances and margins of levels.
    pub levels: &'a Levels,
    /// How roads are measured.
    pub lengths: &'a TrueLengths<'a>,
    /// The data's rectangle: that of all nodes at which data can lie.
    pub node_bounds: LatticeBounds,
    /// The bounds that were asked for.
    pub clip: Option<LatticeBounds>,
    /// The same in degrees.
    pub bounds_deg: Option<[f64; 4]>,
    /// The outline of the elevation files, where they fill no rectangle.
    pub outline: Option<&'a Outline>,
    /// The rectangle around all elevation files, degrees.
    pub area_deg: Bounds,
    /// The polygon that was asked for.
    pub polygon: Option<&'a LatticeRegion>,
    /// Threads for reading and splitting.
    pub pool: &'a rayon::ThreadPool,
    /// Memory for sorting.
    pub memory_bytes: u64,
}

/// Keeps what tiles need of all layers, the lengths of all roads, the defects of the extract, and last the totals of roads. If these are
/// in the store, all is, and nothing is read. The observer is told of the same defects in the same order either way.
///
/// # Errors
/// See [`ExtractError`].
pub fn partition(
    input: &ExtractInput<'_>,
    store: &dyn Artifacts,
    scratch: &dyn Scratch,
    observer: &dyn Observer,
) -> Result<RoadTotals, ExtractError> {
    if let Some(totals) = artifacts::get(store, Kind::RoadTotals.item(0))? {
        replay_defects(store, observer)?;
        return Ok(totals);
    }
    let told = LayerContext::begin(input.pool, observer, DefectsWriter::new(store, observer));
    let found = read(input, (store, scratch), &told)?;
    let (totals, extract) = found.roads;
    if totals.roads == 0 {
        let why = no_road::why(&extract, &input.settings.table);
        if !found.has_others {
            return Err(ExtractError::NoRoads { osm: input.osm.to_vec(), why: why.to_string() });
        }
        let (osm, reason) = (input.osm, why.reason);
        observer.warning(&format!(
            "{osm:?} has no road: {reason}; only its areas and boundaries are taken"
        ));
    }
    let defects = told.end().finish()?;
    let totals = RoadTotals { defects, extract: ExtractCounts::from(&extract), ..totals };
    artifacts::put(store, Kind::RoadTotals.item(0), &totals)?;
    Ok(totals)
}

/// What was found in the extract.
struct Found {
    roads: (RoadTotals, ExtractSummary),
    /// Whether other layers were asked for, and there are some: then there need not be roads.
    has_others: bool,
}

/// Reads all layers that are wanted, and keeps what tiles need of them.
fn read(
    input: &ExtractInput<'_>,
    places: (&dyn Artifacts, &dyn Scratch),
    told: &LayerContext<'_>,
) -> Result<Found, ExtractError> {
    let (store, scratch) = places;
    let extent = area_extent(input, told.observer)?;
    let mut areas = input
        .areas
        .zip(extent.as_ref())
        .map(|(table, extent)| (table, LayerWriter::new(area_layer(input, extent, places), told)));
    let writer = |&layer| (layer, LayerWriter::new(lines_layer(input, layer, places), told));
    let mut lines: Vec<_> = input.lines.iter().map(writer).collect();
    let mut roads = LayerWriter::new(road_layer(input, places), told);
    let kept = kept_in(store);
    let of = kept.complete();
    if of.is_none() && kept.has_any() {
        told.observer.warning(SOME_SHARES);
    }
    let (observer, has_failed) = (told.observer, &told.has_failed);
    let should_stop = || observer.is_cancelled() || has_failed.load(Ordering::Relaxed);
    let on_defect = &mut |defect| told.on_defect(Defect::from(defect));
    let layers = Layers {
        areas: areas.as_mut().map(|(table, sink)| (*table, sink as &mut dyn LayerSink<_, _>)),
        lines: lines.iter_mut().map(|(layer, sink)| (*layer, sink as &mut _)).collect(),
        line_names: None,
        // Shares keep roads alone.
        roads: of.is_none().then_some(&mut roads as &mut dyn LayerSink<_, _>),
    };
    let read = if of.is_none() || input.areas.is_some() || !input.lines.is_empty() {
        on_extract(input, scratch, told, |request| {
            read_extract(request, layers, on_defect, &should_stop)
        })
    } else {
        Ok(())
    };
    // What could not be kept ended the reading.
    if let Some((_, areas)) = &mut areas {
        areas.check()?;
    }
    lines.iter_mut().try_for_each(|(_, writer)| writer.check())?;
    roads.check()?;
    read?;
    let has_areas = areas.map_or(Ok(None), |(_, writer)| writer.done())?;
    let mut has_others = has_areas.is_some_and(|totals| totals.has_any());
    for (_, writer) in lines {
        has_others |= writer.done()?.is_some_and(|totals| totals.has_any());
    }
    if let Some(of) = of {
        let read = on_extract(input, scratch, told, |request| {
            read_kept_roads(request, of, kept, &mut roads, on_defect, &should_stop)
        });
        roads.check()?;
        read?;
    }
    let roads = roads.done()?.ok_or(ExtractError::Interrupted)?;
    Ok(Found { roads, has_others })
}

fn plan_splitting<'a>(input: &ExtractInput<'a>) -> PlanSplitting<'a> {
    let ExtractInput { data, clip, polygon, .. } = *input;
    PlanSplitting { frame: input.levels.frame(), data, clip, polygon }
}

/// Where areas can lie, if any are wanted.
fn area_extent(
    input: &ExtractInput<'_>,
    observer: &dyn Observer,
) -> Result<Option<AreaExtent>, ExtractError> {
    if input.areas.is_none() {
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
            "the sea and areas go to the edges of the data's rectangle: bounds and boxes of the extracts cannot be overlaid with it ({error})"
        ));
        AreaExtent::of_rectangle(input.node_bounds)
    })))
}

fn area_layer<'a>(
    input: &ExtractInput<'a>,
    extent: &'a AreaExtent,
    places: (&'a dyn Artifacts, &'a dyn Scratch),
) -> AreaLayer<'a> {
    let frame = input.levels.frame();
    let splitting = AreaSplitting { plan: plan_splitting(input), extent };
    let sea = SeaPlace { extent, frame, projection: input.projection };
    AreaLayer::new((splitting, sea), places, input.memory_bytes)
}

fn road_layer<'a>(
    input: &ExtractInput<'a>,
    places: (&'a dyn Artifacts, &'a dyn Scratch),
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

fn lines_layer<'a>(
    input: &ExtractInput<'a>,
    layer: ClassedLayer,
    places: (&'a dyn Artifacts, &'a dyn Scratch),
) -> LinesLayer<'a> {
    let splitting = LineSplitting { plan: plan_splitting(input), levels: input.levels };
    let splitting = MeasuredSplitting { splitting, lengths: input.lengths };
    LinesLayer::new(layer, splitting, places, input.memory_bytes)
}

/// Reads the extract.
fn on_extract(
    input: &ExtractInput<'_>,
    scratch: &dyn Scratch,
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
