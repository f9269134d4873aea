//! Centre-lines of roads in and around a tile.

use std::{collections::HashMap, sync::Arc};

use corniche_geom::{LatticePoint, Polyline, StepBudget, TileId};
use corniche_roads::{FunctionalRoadClass, RoadAttributes, Structure};
use corniche_styles::Style;
use corniche_tileset::{FilePackage, Manifest};
use corniche_work::Recent;

use super::{
    deck_ends::DeckEnds,
    ribbon::CenterLine,
    stretches::{PlanStretch, stretches},
};
use crate::{error::SurfaceError, read};

/// The error that clients allow: Cesium's for ground, which the example requests.
const ALLOWED_ERROR_PX: f64 = 2.0;
/// The size of the cache of lines: several rows of neighbours along a Hilbert curve in a town.
const KEPT_BYTES: u64 = 32 << 20;
/// The memory of a point of a line, with the height of a deck.
const POINT_BYTES: usize = size_of::<LatticePoint>() + size_of::<f64>();
/// The work for locating the runs of a tile on its lines, in steps; comparing a point with a vertex
/// is one step. Real tiles take some thousand.
const MOST_STEPS: u64 = 1 << 28;

/// Which roads become surfaces, and how wide.
#[derive(Clone, Copy)]
pub(crate) struct SurfaceRoads<'a> {
    pub(crate) classes: &'a [FunctionalRoadClass],
    pub(crate) style: &'a Style,
}

/// The attributes of a way.
#[derive(Clone)]
pub(crate) struct SurfaceWay {
    pub(crate) id: i64,
    pub(crate) class: FunctionalRoadClass,
    pub(crate) attributes: Arc<RoadAttributes>,
}

/// A road in a tile.
pub(crate) struct SurfaceRoad {
    pub(crate) way: SurfaceWay,
    pub(crate) center: CenterLine,
    /// Heights of the deck at the points of its line, if it is a slab rather than on the ground.
    pub(crate) deck_m: Option<Vec<f64>>,
}

/// The part of a way in one tile, on the ground or as a slab.
struct TileLine {
    way: SurfaceWay,
    stretch: PlanStretch,
}

impl TileLine {
    /// The approximate memory of the line; attributes count in full, although stretches share them.
    fn bytes(&self) -> u64 {
        let points = self.stretch.points.len() * POINT_BYTES;
        let attributes = size_of::<RoadAttributes>() + self.way.attributes.text_bytes();
        (size_of::<Self>() + points + attributes) as u64
    }
}

/// The lines of tiles, read once for a tile and its neighbours.
pub(crate) struct SurfaceLines<'a> {
    package: &'a FilePackage,
    look: SurfaceRoads<'a>,
    /// The detail that is visible on each level.
    details: Vec<Detail>,
    recent: Recent<TileId, Vec<TileLine>>,
}

/// The detail of roads that is visible on a level.
///
/// A client that allows two pixels of error draws a tile only where a pixel is at least half its
/// error. Finer detail is not visible on it.
struct Detail {
    /// The requested classes that the style draws at that scale and that are about a pixel wide:
    /// thinner surfaces would break up into dots.
    classes: Vec<FunctionalRoadClass>,
    /// A quarter of such a pixel, lattice steps: the tolerance to which lines are simplified.
    tolerance_steps: f64,
}

impl Detail {
    fn of_level(look: SurfaceRoads<'_>, manifest: &Manifest, level: u8, finest: u8) -> Self {
        let errors_m = manifest.levels[usize::from(level)].errors_m;
        // The finest tiles are drawn however near the eye is, other tiles as near as the smallest
        // error allows.
        let error_m =
            if level == finest { 0.0 } else { errors_m.map_or(0.0, |errors_m| errors_m.min) };
        let pixel_m = error_m / ALLOWED_ERROR_PX;
        let is_seen = |class: &FunctionalRoadClass| {
            let road = look.style.road(*class);
            // The style states the least width of the road in pixels: the larger it is, the longer
            // the road stays visible.
            let width_m = road.width_m.min(road.carriageway_width_m);
            let stays_m = f64::from(width_m * road.min_width_px.max(1.0));
            stays_m >= pixel_m && road.last_pixel_m() > pixel_m
        };
        Self {
            classes: look.classes.iter().copied().filter(is_seen).collect(),
            tolerance_steps: pixel_m / 4.0 * manifest.point_scale / manifest.frame.lattice_step_m(),
        }
    }
}

impl<'a> SurfaceLines<'a> {
    /// Returns the lines of the levels down to `finest`.
    pub(crate) fn new(package: &'a FilePackage, look: SurfaceRoads<'a>, finest: u8) -> Self {
        let detail = |level| Detail::of_level(look, package.manifest(), level, finest);
        let details = (0..=finest).map(detail).collect();
        Self { package, look, details, recent: Recent::new(KEPT_BYTES) }
    }

    fn of_tile(&self, id: TileId) -> Result<Arc<Vec<TileLine>>, SurfaceError> {
        let detail = &self.details[usize::from(id.z())];
        let make = || {
            let mut lines = self.read(id, &detail.classes)?;
            simplify(&mut lines, detail.tolerance_steps);
            Ok(lines)
        };
        let bytes_of = |lines: &Vec<TileLine>| lines.iter().map(TileLine::bytes).sum();
        self.recent.get(id, make, bytes_of)
    }

    /// Reads the lines of a tile; none of a tunnel, which is not on the ground.
    fn read(
        &self,
        id: TileId,
        classes: &[FunctionalRoadClass],
    ) -> Result<Vec<TileLine>, SurfaceError> {
        let runs = read::span_runs(self.package, id)?;
        let quantum_m = self.package.manifest().vertical.quantum_m;
        let work = StepBudget::new(MOST_STEPS);
        let failed = |source| SurfaceError::TooManyBridges { tile: id, source };
        let mut lines = Vec::new();
        for piece in read::pieces(self.package, id, classes, false)? {
            if piece.attributes.structure == Structure::Tunnel {
                continue;
            }
            let own = runs.get(&piece.key.way_id).map_or(&[][..], Vec::as_slice);
            let stretches = stretches(&piece, own, quantum_m, &work).map_err(failed)?;
            let attributes = Arc::new(piece.attributes);
            let way = SurfaceWay { id: piece.key.way_id, class: piece.class, attributes };
            let line = |stretch| TileLine { way: way.clone(), stretch };
            lines.extend(stretches.into_iter().map(line));
        }
        Ok(lines)
    }

    /// Returns the roads in a tile and in the tiles around it, and the slabs in the tile, the most
    /// important first. Lines that continue across a border have the point beyond it.
    pub(crate) fn around(&self, id: TileId) -> Result<Vec<SurfaceRoad>, SurfaceError> {
        let mut tiles = Vec::new();
        for dy in -1..=1 {
            for dx in -1..=1 {
                if let Some(near) = id.neighbour(dx, dy) {
                    tiles.push((near, self.of_tile(near)?));
                }
            }
        }
        let lines: Vec<(TileId, &TileLine)> = tiles
            .iter()
            .flat_map(|(near, tile)| tile.iter().map(move |line| (*near, line)))
            .collect();
        // Lines of a way that end at a point, and lines that begin there.
        let mut across: HashMap<(i64, LatticePoint), [Vec<usize>; 2]> = HashMap::new();
        let mut meetings: HashMap<LatticePoint, u32> = HashMap::new();
        for (number, (_, line)) in lines.iter().enumerate() {
            for (end, point) in line.stretch.ends().into_iter().enumerate() {
                if line.stretch.goes_on[end] {
                    across.entry((line.way.id, point)).or_default()[1 - end].push(number);
                }
            }
            for point in &line.stretch.points {
                *meetings.entry(*point).or_default() += 1;
            }
        }
        let decks = DeckEnds::from_stretches(lines.iter().map(|(_, line)| &line.stretch));
        // A point on a border belongs to two lines of one way.
        let is_met = |point: LatticePoint| meetings[&point] > 1;
        let joined = |way_id: i64, point: LatticePoint| {
            across.get(&(way_id, point)).and_then(|found| match found {
                [ending, beginning] if ending.len() == 1 && beginning.len() == 1 => {
                    Some([ending[0], beginning[0]].map(|number| &lines[number].1.stretch.points))
                }
                _ => None,
            })
        };
        let center = |line: &TileLine| {
            let PlanStretch { points, deck_m, goes_on } = &line.stretch;
            let [first, last] = line.stretch.ends();
            let mut beyond = [
                joined(line.way.id, first)
                    .filter(|_| goes_on[0])
                    .map(|[ending, _]| ending[ending.len() - 2]),
                joined(line.way.id, last).filter(|_| goes_on[1]).map(|[_, beginning]| beginning[1]),
            ];
            if deck_m.is_some() {
                // Bridges of several ways.
                let other = [0, 1].map(|end| decks.beyond(&line.stretch, end));
                beyond = [0, 1].map(|end| beyond[end].or(other[end]));
            }
            CenterLine {
                points: points.clone(),
                beyond,
                is_met: [is_met(first), is_met(last)],
                half_width: self.half_width(line),
            }
        };
        let mut roads: Vec<SurfaceRoad> = lines
            .iter()
            // Each tile has only its own slabs.
            .filter(|(near, line)| *near == id || line.stretch.deck_m.is_none())
            .map(|(_, line)| SurfaceRoad {
                way: line.way.clone(),
                center: center(line),
                deck_m: line.stretch.deck_m.clone(),
            })
            .collect();
        roads.sort_by(|one, other| {
            let key = |road: &SurfaceRoad| (road.way.class.number(), road.way.id);
            key(one).cmp(&key(other)).then_with(|| one.center.points.cmp(&other.center.points))
        });
        Ok(roads)
    }

    /// Half the width of a road, lattice steps.
    fn half_width(&self, line: &TileLine) -> f64 {
        let manifest = self.package.manifest();
        let width_m = self.look.style.width_of_m(line.way.class, &line.way.attributes);
        f64::from(width_m) / 2.0 * manifest.point_scale / manifest.frame.lattice_step_m()
    }
}

/// Removes points of lines whose absence is not visible. Points that lines share are kept, so that
/// roads still meet. A tile and its neighbours use the same lines of each tile, so they simplify
/// them in the same way.
fn simplify(lines: &mut [TileLine], tolerance_steps: f64) {
    let mut uses: HashMap<LatticePoint, u32> = HashMap::new();
    for line in lines.iter() {
        for point in &line.stretch.points {
            *uses.entry(*point).or_default() += 1;
        }
    }
    for line in lines.iter_mut().filter(|line| line.stretch.deck_m.is_none()) {
        let Ok(whole) = Polyline::new(line.stretch.points.clone()) else { continue };
        let fixed = |(_, point): &(u32, &LatticePoint)| uses[*point] > 1;
        let points = (0..).zip(whole.points());
        let fixed: Vec<u32> = points.filter(fixed).map(|(at, _)| at).collect();
        let thin = corniche_roads::simplify(&whole, &fixed, tolerance_steps);
        line.stretch.points = thin.into_points();
    }
}
