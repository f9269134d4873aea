//! From the extract to roads by tile and level, and what each of them is to weigh.

use std::{
    cell::RefCell,
    collections::BTreeMap,
    sync::{Mutex, PoisonError},
};

use corniche_dem::Dem;
use corniche_geom::{Bounds, LatticeBounds, LatticePoint, Projection, TileId};
use corniche_osm::ExtractSummary;
use corniche_roads::{FunctionalRoadClass, Road};

use super::{
    levels::Levels,
    road_log::{RoadLog, RoadTileCursor, RoadTiles},
};
use crate::{BuildError, Defect, Observer, RoadSettings, Stage, Storage};

/// Vertices of one class on one level, before clipping.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct LineCounts {
    pub(crate) source_vertices: u64,
    pub(crate) simplified_vertices: u64,
}

/// All that later stages need to know of the roads.
pub(crate) struct ReadRoads<'a> {
    pub(crate) log: RoadLog<'a>,
    pub(crate) by_tile: RoadTileCursor<'a>,
    /// Per road: its length in lattice steps.
    pub(crate) lengths_steps: Vec<f64>,
    /// Per level and class.
    pub(crate) line_counts: BTreeMap<(u8, u8), LineCounts>,
    /// Per class: roads and lattice steps.
    pub(crate) classes: Vec<(u64, f64)>,
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
    pub(crate) dem: &'a Dem,
    pub(crate) plan: &'a corniche_dem::GridPlan,
    pub(crate) levels: &'a Levels,
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
    let mut gathered = Gathered {
        levels: input.levels,
        roads: ReadRoads {
            log: RoadLog::new(storage),
            // Filled at the end; an empty list of pairs has an empty cursor.
            by_tile: RoadTiles::new(storage, 0).finish()?,
            lengths_steps: Vec::new(),
            line_counts: BTreeMap::new(),
            classes: vec![(0, 0.0); FunctionalRoadClass::COUNT],
            defects: BTreeMap::new(),
            extract: ExtractSummary::default(),
            bounds: None,
        },
        pairs: RoadTiles::new(storage, input.memory_bytes),
        failed: None,
    };
    let frame = *input.levels.frame();
    // A projection is dear to make and serves one thread at a time: idle ones wait here.
    let idle = Mutex::new(vec![input.dem.projection(input.plan)?]);
    let lock = || idle.lock().unwrap_or_else(PoisonError::into_inner);
    let place = |positions_deg: &[[f64; 2]]| -> Vec<Option<LatticePoint>> {
        let waiting = lock().pop();
        let Some(projection) = waiting.or_else(|| input.dem.projection(input.plan).ok()) else {
            // Without a projection no point has a place; the reader counts each as a defect.
            return vec![None; positions_deg.len()];
        };
        let mut positions = positions_deg.to_vec();
        let projected = projection.working_from_wgs84(&mut positions);
        lock().push(projection);
        match projected {
            Ok(()) => positions.into_iter().map(|position_m| frame.snap(position_m)).collect(),
            Err(_) => vec![None; positions_deg.len()],
        }
    };
    let defects = RefCell::new(BTreeMap::new());
    let summary = corniche_osm::read_roads(
        &corniche_osm::ReadRequest {
            path: input.osm,
            table: &input.settings.table,
            place: &place,
            pool: input.pool,
        },
        &mut |road| {
            gathered.add(&road);
            observer.advance(Stage::Roads, 1);
        },
        &mut |defect| *defects.borrow_mut().entry(Defect::from(&defect).name()).or_default() += 1,
        &|| observer.is_cancelled(),
    );
    if observer.is_cancelled() {
        return Err(BuildError::Interrupted);
    }
    let summary = summary?;
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

/// Roads as they come in.
struct Gathered<'a, 'l> {
    levels: &'l Levels,
    roads: ReadRoads<'a>,
    pairs: RoadTiles<'a>,
    /// The reader's sink cannot fail; the first failure is kept and everything after it ignored.
    failed: Option<BuildError>,
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
        let length_steps = road.line.length_steps();
        self.roads.lengths_steps.push(length_steps);
        let class = &mut self.roads.classes[usize::from(road.class.number())];
        *class = (class.0 + 1, class.1 + length_steps);
        for level in self.levels.numbers() {
            let counts = self.roads.line_counts.entry((level, road.class.number())).or_default();
            counts.source_vertices += road.line.points().len() as u64;
            if !self.levels.shows(level, road.class) {
                continue;
            }
            let line = corniche_roads::simplify(road, self.levels.simplify_tolerance_steps(level));
            counts.simplified_vertices += line.points().len() as u64;
            for id in tiles_of(line.points(), level, self.levels) {
                self.pairs.push(id, ordinal)?;
            }
        }
        if let Some(own) = LatticeBounds::of(road.line.points()) {
            let all = self.roads.bounds.get_or_insert(own);
            *all = LatticeBounds {
                min: LatticePoint::new(all.min.u.min(own.min.u), all.min.v.min(own.min.v)),
                max: LatticePoint::new(all.max.u.max(own.max.u), all.max.v.max(own.max.v)),
            };
        }
        Ok(())
    }
}

/// The tiles of `level` whose margin the line's segments may meet: by each segment's bounding box, so a long
/// diagonal names a few tiles too many, which clipping finds empty.
fn tiles_of(points: &[LatticePoint], level: u8, levels: &Levels) -> Vec<TileId> {
    let margin = levels.margin_steps(level);
    let last = (1_i64 << level) - 1;
    let mut tiles = Vec::new();
    for pair in points.windows(2) {
        let Some(bounds) = LatticeBounds::of(pair) else { continue };
        let bounds = bounds.expanded(margin);
        let [west, south] = levels.frame().tile_column_row(level, bounds.min);
        let [east, north] = levels.frame().tile_column_row(level, bounds.max);
        for y in north.max(0)..=south.min(last) {
            for x in west.max(0)..=east.min(last) {
                tiles.extend(TileId::new(level, x as u32, y as u32).ok());
            }
        }
    }
    tiles.sort_unstable();
    tiles.dedup();
    tiles
}

/// Fails when no road lies on the elevation data's rectangle.
pub(crate) fn check_overlap(
    roads: &ReadRoads<'_>,
    input: &RoadInput<'_>,
    data_bounds: &Bounds,
    wgs84_bounds: &Bounds,
) -> Result<(), BuildError> {
    let Some(bounds) = roads.bounds else { return Ok(()) };
    let frame = input.levels.frame();
    let [min, max] = [frame.position_m(bounds.min), frame.position_m(bounds.max)];
    let roads_m = Bounds { min_x: min[0], min_y: min[1], max_x: max[0], max_y: max[1] };
    if roads_m.intersects(data_bounds) {
        return Ok(());
    }
    let mut corners = [min, max];
    let projected = input.dem.projection(input.plan)?.wgs84_from_working(&mut corners);
    let roads_deg = if projected.is_ok() {
        [corners[0][0], corners[0][1], corners[1][0], corners[1][1]]
    } else {
        [f64::NAN; 4]
    };
    Err(BuildError::NoOverlap {
        osm: input.osm.to_path_buf(),
        roads_deg,
        heights_deg: wgs84_bounds.to_array(),
    })
}
