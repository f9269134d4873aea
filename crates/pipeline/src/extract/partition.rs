//! Reads the extract once, or what was kept of it in shares, and keeps, for each tile of each level, the pieces of roads that it needs.
//!
//! ```text
//! extract ─► roads ─► pieces by level and tile ─► sorted by tile and ordinal ─► one artifact for each tile
//!                └──► true lengths ─► one artifact for each block of roads
//!         defects ─► one artifact for each block of defects
//! ```
//!
//! Nothing that grows with the number of roads stays in memory.

use std::{
    path::PathBuf,
    sync::{Mutex, PoisonError},
};

use corniche_areas::AreaTable;
use corniche_geom::{
    GridFrame, LatticeBounds, LatticePoint, LatticeRegion, ProjectError, Projection, TileId,
};
use corniche_osm::{ExtractSummary, ReadOsmError, ReadRequest, read_kept_roads, read_roads};
use corniche_roads::{FunctionalRoadClass, Road};
use corniche_store::{Artifacts, Scratch, SortRecord, Sorter};
use corniche_tileset::pmtiles_order;
use rayon::prelude::*;

pub(crate) use super::defects::replay_defects;
use super::{
    defects::DefectsWriter,
    extract::{kept_in, not_read},
    no_road,
    pieces::{RoadPiece, TilePiecesWriter},
    split::{RoadSplitting, SplitRoad},
    totals::{ExtractCounts, LengthsWriter, RoadTotals},
};
use crate::{
    BuildError, Defect, Observer, RoadSettings, Stage,
    areas::{self, sea::SeaPlace, totals::AreaTotals},
    artifacts::{self, Kind},
    boundaries::{self, totals::BoundaryTotals},
    heights::data_tiles::DataTiles,
    levels::Levels,
    true_lengths::TrueLengths,
};

/// Roads and points of roads that are split at once.
const BATCH_ROADS: usize = 1024;
const BATCH_POINTS: usize = 1 << 16;

/// What is said if the ways of some shares are there, but not ways and nodes of all.
const SOME_SHARES: &str = "not all shares of the steps ways and nodes are in the stores, so the whole extract is read again";

/// What the partition needs.
pub(crate) struct RoadInput<'a> {
    /// Never empty.
    pub(crate) osm: &'a [PathBuf],
    pub(crate) settings: &'a RoadSettings,
    /// Which objects are areas and on which tiles, if any are wanted.
    pub(crate) areas: Option<AreaInput<'a>>,
    /// The tiles on which data can lie, if boundaries are wanted.
    pub(crate) boundaries: Option<DataTiles>,
    pub(crate) projection: &'a (dyn Projection + Sync),
    pub(crate) levels: &'a Levels,
    pub(crate) lengths: &'a TrueLengths<'a>,
    /// The finest tiles on which the data's rectangle lies, all together.
    pub(crate) data_bounds: LatticeBounds,
    /// The data's rectangle: that of all nodes at which data can lie.
    pub(crate) node_bounds: LatticeBounds,
    /// The bounds that were asked for.
    pub(crate) clip: Option<LatticeBounds>,
    /// The polygon that was asked for.
    pub(crate) polygon: Option<&'a LatticeRegion>,
    pub(crate) pool: &'a rayon::ThreadPool,
    /// Memory for sorting.
    pub(crate) memory_bytes: u64,
}

/// What areas need beside the extract.
#[derive(Clone, Copy)]
pub(crate) struct AreaInput<'a> {
    pub(crate) table: &'a AreaTable,
    /// The tiles on which data can lie.
    pub(crate) data: DataTiles,
}

/// Keeps the pieces of all tiles, the lengths of all roads, the defects of the extract, and last the totals. If the totals are
/// in the store, all is, and nothing is read. The observer is told of the same defects in the same order either way.
pub(crate) fn partition(
    input: &RoadInput<'_>,
    store: &dyn Artifacts,
    scratch: &dyn Scratch,
    observer: &dyn Observer,
) -> Result<RoadTotals, BuildError> {
    if let Some(totals) = artifacts::get(store, Kind::RoadTotals.item(0))? {
        replay_defects(store, observer)?;
        return Ok(totals);
    }
    let mut defects = DefectsWriter::new(store, observer);
    read_areas(input, (store, scratch), &mut defects, observer)?;
    read_boundaries(input, (store, scratch), &mut defects, observer)?;
    observer.begin(Stage::Roads, None);
    let mut gathered = Gathered::new(input, store, scratch);
    let extract = read(input, (store, scratch), &mut gathered, &mut defects, observer)?;
    gathered.split_batch();
    if let Some(error) = gathered.failed {
        return Err(error);
    }
    if gathered.totals.roads == 0 {
        let why = no_road::why(&extract, &input.settings.table);
        if !has_other_layer(store)? {
            return Err(BuildError::NoRoads { osm: input.osm.to_vec(), why: why.to_string() });
        }
        let (osm, reason) = (input.osm, why.reason);
        observer.warning(&format!(
            "{osm:?} has no road: {reason}; only its areas and boundaries are taken"
        ));
    }
    gathered.lengths.finish()?;
    put_pieces(gathered.pieces, store, observer)?;
    let defects = defects.finish()?;
    let totals = RoadTotals { defects, extract: ExtractCounts::from(&extract), ..gathered.totals };
    artifacts::put(store, Kind::RoadTotals.item(0), &totals)?;
    observer.end(Stage::Roads);
    Ok(totals)
}

/// Whether areas or boundaries were asked for, and the extract has some: then it need not have roads.
fn has_other_layer(store: &dyn Artifacts) -> Result<bool, BuildError> {
    let areas = AreaTotals::get(store)?.is_some_and(|totals| totals.has_any());
    Ok(areas || BoundaryTotals::get(store)?.is_some_and(|totals| totals.has_any()))
}

/// Makes the areas of the extract, if they are wanted. What is wrong with them comes before what is wrong with roads.
fn read_areas(
    input: &RoadInput<'_>,
    (store, scratch): (&dyn Artifacts, &dyn Scratch),
    defects: &mut DefectsWriter<'_>,
    observer: &dyn Observer,
) -> Result<(), BuildError> {
    let Some(AreaInput { table, data }) = input.areas else { return Ok(()) };
    observer.begin(Stage::MapAreas, None);
    let frame = input.levels.frame();
    let splitting = areas::split::AreaSplitting { frame, data, clip: input.clip };
    let (osm, data) = (input.osm, input.data_bounds);
    let sea = SeaPlace { osm, data, frame, projection: input.projection };
    on_extract(input, (scratch, Stage::MapAreas), observer, |request| {
        let mut on_defect = |defect| defects.push(defect);
        areas::partition::partition(
            request,
            table,
            (&splitting, &sea),
            store,
            observer,
            &mut on_defect,
        )
    })?;
    observer.end(Stage::MapAreas);
    Ok(())
}

/// Makes the boundaries of the extract, if they are wanted.
fn read_boundaries(
    input: &RoadInput<'_>,
    (store, scratch): (&dyn Artifacts, &dyn Scratch),
    defects: &mut DefectsWriter<'_>,
    observer: &dyn Observer,
) -> Result<(), BuildError> {
    let Some(data) = input.boundaries else { return Ok(()) };
    observer.begin(Stage::Boundaries, None);
    let splitting =
        boundaries::split::BoundarySplitting { levels: input.levels, data, clip: input.clip };
    on_extract(input, (scratch, Stage::Boundaries), observer, |request| {
        let mut on_defect = |defect| defects.push(defect);
        let how = (&splitting, input.lengths);
        boundaries::partition::partition(request, how, store, observer, &mut on_defect)
    })?;
    observer.end(Stage::Boundaries);
    Ok(())
}

/// Hands all roads of the extract to `gathered` and its defects to `defects`; returns what it held.
fn read(
    input: &RoadInput<'_>,
    (store, scratch): (&dyn Artifacts, &dyn Scratch),
    gathered: &mut Gathered<'_>,
    defects: &mut DefectsWriter<'_>,
    observer: &dyn Observer,
) -> Result<ExtractSummary, BuildError> {
    let mut sink = |road| gathered.add(road);
    let mut on_defect = |defect| defects.push(Defect::from(defect));
    let should_stop = || observer.is_cancelled();
    let kept = kept_in(store);
    let extract = on_extract(input, (scratch, Stage::Roads), observer, |request| {
        Ok(if let Some(of) = kept.complete() {
            read_kept_roads(request, of, kept, &mut sink, &mut on_defect, &should_stop)
        } else {
            if kept.has_any() {
                observer.warning(SOME_SHARES);
            }
            read_roads(request, &mut sink, &mut on_defect, &should_stop)
        })
    })?;
    Ok(extract.unwrap_or_default())
}

/// What `read` makes of the extract; `None` without one. Points that cannot be projected make it fail.
fn on_extract<T>(
    input: &RoadInput<'_>,
    (scratch, stage): (&dyn Scratch, Stage),
    observer: &dyn Observer,
    read: impl FnOnce(&ReadRequest<'_>) -> Result<Result<T, ReadOsmError>, BuildError>,
) -> Result<Option<T>, BuildError> {
    let unprojected = Mutex::new(None);
    let place = |positions_deg: &[[f64; 2]]| {
        place(positions_deg, input.levels.frame(), input.projection).unwrap_or_else(|error| {
            // The points are not at fault: the run fails with this error after reading.
            *unprojected.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
            vec![None; positions_deg.len()]
        })
    };
    let Some((path, others)) = input.osm.split_first() else { return Ok(None) };
    let done = read(&ReadRequest {
        path,
        others,
        table: &input.settings.table,
        place: &place,
        seam: input.projection.seam().map(|seam| seam.on_lattice(input.levels.frame())),
        pool: input.pool,
        memory_bytes: input.memory_bytes,
        scratch,
        on_progress: Some(&|done, total| observer.reached(stage, done, total)),
    });
    observer.check()?;
    let done = done?.map_err(not_read)?;
    if let Some(error) = unprojected.into_inner().unwrap_or_else(PoisonError::into_inner) {
        return Err(BuildError::Project(error));
    }
    Ok(Some(done))
}

fn place(
    positions_deg: &[[f64; 2]],
    frame: &GridFrame,
    projection: &dyn Projection,
) -> Result<Vec<Option<LatticePoint>>, ProjectError> {
    let mut positions = positions_deg.to_vec();
    projection.working_from_wgs84(&mut positions)?;
    Ok(positions.into_iter().map(|position_m| frame.snap(position_m)).collect())
}

/// Roads as they come in.
struct Gathered<'a> {
    splitting: RoadSplitting<'a>,
    pool: &'a rayon::ThreadPool,
    batch: Vec<Road>,
    batch_points: usize,
    totals: RoadTotals,
    lengths: LengthsWriter<'a>,
    pieces: Sorter<'a, PieceRecord>,
    /// The reader's sink cannot fail; the first failure is kept and everything after it ignored.
    failed: Option<BuildError>,
}

impl<'a> Gathered<'a> {
    /// Nothing yet.
    fn new(input: &RoadInput<'a>, store: &'a dyn Artifacts, scratch: &'a dyn Scratch) -> Self {
        Self {
            splitting: RoadSplitting {
                levels: input.levels,
                lengths: input.lengths,
                data_bounds: input.data_bounds,
                node_bounds: input.node_bounds,
                clip: input.clip,
                polygon: input.polygon,
            },
            pool: input.pool,
            batch: Vec::new(),
            batch_points: 0,
            totals: RoadTotals {
                classes: vec![(0, 0); FunctionalRoadClass::COUNT],
                ..RoadTotals::default()
            },
            lengths: LengthsWriter::new(store),
            // The reader keeps a third of its memory while it hands out roads.
            pieces: Sorter::new(scratch, input.memory_bytes / 3 * 2),
            failed: None,
        }
    }

    fn add(&mut self, road: Road) {
        self.batch_points += road.line.points().len();
        self.batch.push(road);
        if self.batch.len() >= BATCH_ROADS || self.batch_points >= BATCH_POINTS {
            self.split_batch();
        }
    }

    /// Splits the roads of the batch side by side, and takes them in their order.
    fn split_batch(&mut self) {
        let batch = std::mem::take(&mut self.batch);
        self.batch_points = 0;
        if self.failed.is_some() {
            return;
        }
        let splitting = &self.splitting;
        let first = self.totals.roads as u32;
        // Roads are dropped where they are split, not by the one thread that takes the pieces.
        let split = |(index, road): (usize, Road)| {
            let mut road = splitting.split(&road);
            let pieces = std::mem::take(&mut road.pieces).into_iter();
            let ordinal = first + index as u32;
            let record = |(id, piece): (TileId, RoadPiece)| PieceRecord {
                tile: pmtiles_order(id),
                ordinal,
                bytes: piece.to_bytes(),
            };
            (road, pieces.map(record).collect())
        };
        let roads: Vec<(SplitRoad, Vec<PieceRecord>)> =
            self.pool.install(|| batch.into_par_iter().enumerate().map(split).collect());
        for (road, pieces) in roads {
            if let Err(error) = self.take(&road, pieces) {
                self.failed = Some(error);
                return;
            }
        }
    }

    /// Takes the road with the next ordinal.
    fn take(&mut self, road: &SplitRoad, pieces: Vec<PieceRecord>) -> Result<(), BuildError> {
        self.totals.roads += 1;
        let length_um = road.length.length_um;
        self.totals.length_um += length_um;
        let class = &mut self.totals.classes[usize::from(road.class.number())];
        *class = (class.0 + 1, class.1 + length_um);
        if let Some(own) = road.bounds {
            let all =
                self.totals.bounds.map_or(own, |[min, max]| own.union(&LatticeBounds { min, max }));
            self.totals.bounds = Some([all.min, all.max]);
        }
        self.lengths.push(road.length)?;
        for piece in pieces {
            self.pieces.push(piece).map_err(BuildError::Storage)?;
        }
        Ok(())
    }
}

/// The piece of a road on its way to its tile. No two have the same tile and ordinal.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct PieceRecord {
    /// The tile's place in the order of the package.
    tile: u64,
    ordinal: u32,
    bytes: Vec<u8>,
}

impl SortRecord for PieceRecord {
    fn encode(&self, bytes: &mut Vec<u8>) {
        bytes.extend(self.tile.to_le_bytes());
        bytes.extend(self.ordinal.to_le_bytes());
        bytes.extend((self.bytes.len() as u32).to_le_bytes());
        bytes.extend(&self.bytes);
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        let (tile, rest) = bytes.split_first_chunk()?;
        let (ordinal, rest) = rest.split_first_chunk()?;
        let (length, rest) = rest.split_first_chunk()?;
        let (piece, rest) = rest.split_at_checked(u32::from_le_bytes(*length) as usize)?;
        *bytes = rest;
        Some(Self {
            tile: u64::from_le_bytes(*tile),
            ordinal: u32::from_le_bytes(*ordinal),
            bytes: piece.to_vec(),
        })
    }

    fn extra_bytes(&self) -> usize {
        self.bytes.capacity()
    }
}

/// Puts one artifact for each tile, in the order of the package.
fn put_pieces(
    pieces: Sorter<'_, PieceRecord>,
    store: &dyn Artifacts,
    observer: &dyn Observer,
) -> Result<(), BuildError> {
    let put = |tile: u64, pieces: TilePiecesWriter| {
        observer.check()?;
        Ok(store.put(Kind::RoadPieces.item(tile), &pieces.into_bytes())?)
    };
    let mut current: Option<(u64, TilePiecesWriter)> = None;
    for record in pieces.finish().map_err(BuildError::Storage)? {
        let PieceRecord { tile, ordinal, bytes } = record.map_err(BuildError::Storage)?;
        if let Some((before, done)) = current.take_if(|(current, _)| *current != tile) {
            put(before, done)?;
        }
        current.get_or_insert_with(|| (tile, TilePiecesWriter::default())).1.push(ordinal, &bytes);
    }
    current.map_or(Ok(()), |(tile, pieces)| put(tile, pieces))
}

#[cfg(test)]
#[path = "partition_tests.rs"]
mod tests;
