//! Reads the extract: roads in storage, their true lengths, and the tiles that each of them meets.

use std::{
    cell::RefCell,
    collections::BTreeMap,
    io::{self, ErrorKind::UnexpectedEof},
    sync::{Mutex, PoisonError},
};

use corniche_dem::{DemProjection, GridPlan};
use corniche_drape::OwnedBorders;
use corniche_geom::{Bounds, LatticeBounds, LatticePoint, ProjectError, Projection, TileId};
use corniche_osm::ExtractSummary;
use corniche_roads::{FunctionalRoadClass, Road};
use corniche_store::{Scratch, Span};

use super::{
    by_tile::{RoadTileCursor, RoadTiles},
    lengths::{TrueLengths, pieces_um},
    log::RoadLog,
};
use crate::{
    BuildError, Defect, Observer, RoadSettings, Stage, Storage,
    levels::Levels,
    storage::{self, Kind},
};

/// Tiles whose lists of roads are in memory at once.
pub(crate) const TILES_AT_ONCE: usize = 1024;

/// What later stages need of the roads.
pub(crate) struct ReadRoads<'a> {
    pub(crate) log: RoadLog<'a>,
    pub(crate) by_tile: RoadTileCursor<'a>,
    /// Per road: its true length, micrometres.
    pub(crate) lengths_um: Vec<u64>,
    /// Per road: how much of that lies outside the tiles of the data's rectangle, measured by itself.
    pub(crate) outside_um: Vec<u64>,
    /// Per class: roads and true micrometres.
    pub(crate) classes: Vec<(u64, u64)>,
    /// Counted defects by name.
    pub(crate) defects: BTreeMap<String, u64>,
    /// What the extract held and what of it is no road.
    pub(crate) extract: ExtractSummary,
    /// Where roads lie, on the lattice.
    pub(crate) bounds: Option<LatticeBounds>,
}

/// What the reading needs.
pub(crate) struct RoadInput<'a> {
    pub(crate) osm: &'a std::path::Path,
    pub(crate) settings: &'a RoadSettings,
    pub(crate) projection: &'a DemProjection,
    pub(crate) levels: &'a Levels,
    pub(crate) lengths: &'a TrueLengths<'a>,
    /// The finest tiles on which the data's rectangle lies, all together.
    pub(crate) data_bounds: LatticeBounds,
    pub(crate) pool: &'a rayon::ThreadPool,
    pub(crate) memory_bytes: u64,
}

/// Reads the extract.
pub(crate) fn read<'a>(
    input: &RoadInput<'_>,
    storage: &'a dyn Storage,
    observer: &dyn Observer,
) -> Result<ReadRoads<'a>, BuildError> {
    observer.begin(Stage::Roads, None);
    let mut gathered = Gathered::new(input, storage)?;
    let frame = *input.levels.frame();
    let projection = input.projection;
    let unprojected = Mutex::new(None);
    let place = |positions_deg: &[[f64; 2]]| -> Vec<Option<LatticePoint>> {
        let mut positions = positions_deg.to_vec();
        match projection.working_from_wgs84(&mut positions) {
            Ok(()) => positions.into_iter().map(|position_m| frame.snap(position_m)).collect(),
            // The points are not at fault: the run fails with this error after reading.
            Err(error) => {
                *unprojected.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
                vec![None; positions_deg.len()]
            }
        }
    };
    let defects = RefCell::new(BTreeMap::new());
    let summary = corniche_osm::read_roads(
        &corniche_osm::ReadRequest {
            path: input.osm,
            table: &input.settings.table,
            place: &place,
            pool: input.pool,
            memory_bytes: input.memory_bytes,
            scratch: &ScratchIn { storage, spans: Mutex::default() },
            on_progress: None,
        },
        &mut |road| {
            gathered.add(&road);
            observer.advance(Stage::Roads, 1);
        },
        &mut |defect| {
            let defect = Defect::from(defect);
            *defects.borrow_mut().entry(defect.name()).or_default() += 1;
            observer.defect(&defect);
        },
        &|| observer.is_cancelled(),
    );
    if observer.is_cancelled() {
        return Err(BuildError::Interrupted);
    }
    let summary = summary?;
    if let Some(error) = unprojected.into_inner().unwrap_or_else(PoisonError::into_inner) {
        return Err(BuildError::Project(error));
    }
    if let Some(error) = gathered.failed {
        return Err(error);
    }
    let mut roads = gathered.roads;
    roads.by_tile = gathered.pairs.finish()?;
    roads.defects = defects.into_inner();
    roads.extract = summary;
    observer.end(Stage::Roads);
    if roads.log.len() == 0 {
        return Err(BuildError::NoRoads { osm: input.osm.to_path_buf() });
    }
    Ok(roads)
}

/// Scratch space in a run's storage: the spans appended there, one after another.
struct ScratchIn<'a> {
    storage: &'a dyn Storage,
    spans: Mutex<Vec<(Span, storage::Span)>>,
}

impl Scratch for ScratchIn<'_> {
    fn append(&self, bytes: &[u8]) -> io::Result<Span> {
        let kept = self.storage.append(Kind::RoadTiles, bytes)?;
        let mut spans = self.spans.lock().unwrap_or_else(PoisonError::into_inner);
        let offset = spans.last().map_or(0, |(last, _)| last.offset + last.length);
        let span = Span { offset, length: bytes.len() as u64 };
        spans.push((span, kept));
        Ok(span)
    }

    fn read(&self, span: Span) -> io::Result<Vec<u8>> {
        let spans = self.spans.lock().unwrap_or_else(PoisonError::into_inner);
        let after = spans.partition_point(|(own, _)| own.offset <= span.offset);
        let (own, kept) = after.checked_sub(1).map(|at| spans[at]).ok_or(UnexpectedEof)?;
        drop(spans);
        if span.offset + span.length > own.offset + own.length {
            return Err(UnexpectedEof.into());
        }
        self.storage.read(Kind::RoadTiles, kept.part(span.offset - own.offset, span.length))
    }
}

/// Roads as they come in.
struct Gathered<'a, 'l> {
    levels: &'l Levels,
    lengths: &'l TrueLengths<'l>,
    data_bounds: LatticeBounds,
    roads: ReadRoads<'a>,
    pairs: RoadTiles<'a>,
    /// The reader's sink cannot fail; the first failure is kept and everything after it ignored.
    failed: Option<BuildError>,
}

impl<'a, 'l> Gathered<'a, 'l> {
    /// Nothing yet.
    fn new(input: &RoadInput<'l>, storage: &'a dyn Storage) -> Result<Self, BuildError> {
        Ok(Self {
            levels: input.levels,
            lengths: input.lengths,
            data_bounds: input.data_bounds,
            roads: ReadRoads {
                log: RoadLog::new(storage),
                // Filled at the end; an empty list of pairs has an empty cursor.
                by_tile: RoadTiles::new(storage, 0).finish()?,
                lengths_um: Vec::new(),
                outside_um: Vec::new(),
                classes: vec![(0, 0); FunctionalRoadClass::COUNT],
                defects: BTreeMap::new(),
                extract: ExtractSummary::default(),
                bounds: None,
            },
            pairs: RoadTiles::new(storage, input.memory_bytes),
            failed: None,
        })
    }
}

impl Gathered<'_, '_> {
    fn add(&mut self, road: &Road) {
        if self.failed.is_none()
            && let Err(error) = self.try_add(road)
        {
            self.failed = Some(error);
        }
    }

    fn try_add(&mut self, road: &Road) -> Result<(), BuildError> {
        let ordinal = self.roads.log.push(road)?;
        let segments_um = self.lengths.segments_um(&road.line);
        let length_um: u64 = segments_um.iter().sum();
        self.roads.lengths_um.push(length_um);
        let class = &mut self.roads.classes[usize::from(road.class.number())];
        *class = (class.0 + 1, class.1 + length_um);
        let all = OwnedBorders::ALL;
        let inside_um: u64 = corniche_drape::clip_parts(&road.line, &self.data_bounds, all)
            .iter()
            .flat_map(|part| pieces_um(&road.line, part, &segments_um))
            .map(|[from, to]| to - from)
            .sum();
        self.roads.outside_um.push(length_um - inside_um);
        for level in self.levels.numbers() {
            if !self.levels.shows(level, road.class) {
                continue;
            }
            let line = corniche_roads::simplify(road, self.levels.simplify_tolerance_steps(level));
            for id in tiles_of(line.points(), level, self.levels) {
                self.pairs.push(id, ordinal)?;
            }
        }
        if let Some(own) = LatticeBounds::of(road.line.points()) {
            let all = self.roads.bounds.get_or_insert(own);
            *all = all.union(&own);
        }
        Ok(())
    }
}

/// The tiles of `level` whose margin the line's segments may meet. Row by row of tiles, so that one endless
/// segment (a misplaced node) names the tiles along it and not all those of its bounding box.
fn tiles_of(points: &[LatticePoint], level: u8, levels: &Levels) -> Vec<TileId> {
    let frame = levels.frame();
    let margin = levels.margin_steps(level);
    let last = (1_i64 << level) - 1;
    let mut tiles = Vec::new();
    for pair in points.windows(2) {
        let Some(bounds) = LatticeBounds::of(pair) else { continue };
        let bounds = bounds.expanded(margin);
        let [_, south] = frame.tile_column_row(level, bounds.min);
        let [_, north] = frame.tile_column_row(level, bounds.max);
        for y in north.max(0)..=south.min(last) {
            let Ok(row) = TileId::new(level, 0, y as u32) else { continue };
            let row = frame.tile_lattice_bounds(row);
            // The stretch of the segment between the row's borders, margins and a step of rounding included.
            let reach = [row.min.v - margin - 1, row.max.v + margin + 1];
            let [low, high] = stretch_u([pair[0], pair[1]], reach);
            let west =
                frame.tile_column_row(level, LatticePoint::new(low - margin - 1, row.min.v))[0];
            let east =
                frame.tile_column_row(level, LatticePoint::new(high + margin + 1, row.min.v))[0];
            for x in west.max(0)..=east.min(last) {
                tiles.extend(TileId::new(level, x as u32, y as u32).ok());
            }
        }
    }
    tiles.sort_unstable();
    tiles.dedup();
    tiles
}

/// Smallest and largest u of the part of a segment whose v lies within `reach`, rounded outwards.
fn stretch_u([a, b]: [LatticePoint; 2], reach: [i64; 2]) -> [i64; 2] {
    if a.v == b.v {
        return [a.u.min(b.u), a.u.max(b.u)];
    }
    let at = |v: i64| {
        let v = v.clamp(a.v.min(b.v), a.v.max(b.v));
        let share = (v - a.v) as f64 / (b.v - a.v) as f64;
        a.u as f64 + share * (b.u - a.u) as f64
    };
    let [one, other] = reach.map(at);
    // f64 holds lattice coordinates to 2^53; a step of slack per 2^50 covers what it rounds away.
    let slack = (one.abs().max(other.abs()) / (1_i64 << 50) as f64).ceil() + 1.0;
    [(one.min(other) - slack) as i64, (one.max(other) + slack) as i64]
}

/// Fails when no road lies on the elevation data's rectangle.
pub(crate) fn check_overlap(
    roads: &ReadRoads<'_>,
    input: &RoadInput<'_>,
    plan: &GridPlan,
) -> Result<(), BuildError> {
    let (data_m, data_deg) = (&plan.data_bounds, &plan.wgs84_bounds);
    let Some(bounds) = roads.bounds else { return Ok(()) };
    let frame = input.levels.frame();
    let [min, max] = [frame.position_m(bounds.min), frame.position_m(bounds.max)];
    let roads_m = Bounds { min_x: min[0], min_y: min[1], max_x: max[0], max_y: max[1] };
    if roads_m.intersects(data_m) {
        return Ok(());
    }
    let roads_deg = bounds_deg(roads_m, input.projection);
    Err(BuildError::NoOverlap {
        osm: input.osm.to_path_buf(),
        roads_deg: roads_deg.map_err(BuildError::Project)?.to_array(),
        heights_deg: data_deg.to_array(),
    })
}

/// A rectangle of the working CRS by its corners in degrees, where it is turned: two of them would not do.
fn bounds_deg(bounds_m: Bounds, projection: &impl Projection) -> Result<Bounds, ProjectError> {
    let Bounds { min_x, min_y, max_x, max_y } = bounds_m;
    let mut corners = [[min_x, min_y], [max_x, max_y], [min_x, max_y], [max_x, min_y]];
    projection.wgs84_from_working(&mut corners)?;
    let mut bounds_deg = Bounds::EMPTY;
    for corner in corners {
        bounds_deg.include(corner);
    }
    Ok(bounds_deg)
}

#[cfg(test)]
#[path = "read_tests.rs"]
mod tests;
