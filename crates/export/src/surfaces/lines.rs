//! Centre-lines of roads in and around a tile.

use std::{
    collections::{HashMap, VecDeque},
    sync::{Arc, Mutex, PoisonError},
};

use corniche_geom::{LatticePoint, Polyline, TileId};
use corniche_roads::{Form, FunctionalRoadClass, RoadAttributes, Structure};
use corniche_styles::{RoadStyle, Style};
use corniche_tileset::{FilePackage, Manifest};

use super::ribbon::CenterLine;
use crate::{error::ExportError, piece::Piece, read};

/// The error that clients allow: Cesium's for ground, which the example asks for.
const ALLOWED_ERROR_PX: f64 = 2.0;
/// Tiles whose lines are kept: some rows of neighbours along a Hilbert curve.
const KEPT_TILES: usize = 256;

/// Which roads become surfaces, and how wide.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RoadLook<'a> {
    pub(crate) classes: &'a [FunctionalRoadClass],
    pub(crate) style: &'a Style,
}

/// A road in a tile.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Road {
    pub(crate) way_id: i64,
    pub(crate) class: FunctionalRoadClass,
    pub(crate) attributes: Arc<RoadAttributes>,
    pub(crate) center: CenterLine,
}

/// What one tile has of a way.
#[derive(Debug)]
struct TileLine {
    way_id: i64,
    class: FunctionalRoadClass,
    attributes: Arc<RoadAttributes>,
    points: Vec<LatticePoint>,
    goes_on: [bool; 2],
}

/// The lines of tiles, read once for a tile and its neighbours.
pub(crate) struct TileLines<'a> {
    package: &'a FilePackage,
    look: RoadLook<'a>,
    /// What is drawn on each level.
    details: Vec<Detail>,
    kept: Mutex<VecDeque<(TileId, Arc<Vec<TileLine>>)>>,
}

/// How much of roads is seen on a level.
///
/// A client that allows two pixels of error draws a tile only where a pixel is at least half its error. What is finer than that is not seen on it.
#[derive(Debug, Clone, PartialEq)]
struct Detail {
    /// Classes that were asked for, that the style draws at that scale and that are about a pixel wide: thinner surfaces break
    /// up into dots.
    classes: Vec<FunctionalRoadClass>,
    /// A quarter of such a pixel, lattice steps: lines are simplified by it.
    tolerance_steps: f64,
}

impl Detail {
    fn of_level(look: RoadLook<'_>, manifest: &Manifest, level: u8, finest: u8) -> Self {
        let errors_m = manifest.levels[usize::from(level)].errors_m;
        // The finest tiles are drawn however near the eye is; others as near as the smallest error allows.
        let error_m =
            if level == finest { 0.0 } else { errors_m.map_or(0.0, |errors_m| errors_m.min) };
        let pixel_m = error_m / ALLOWED_ERROR_PX;
        let is_seen = |class: &FunctionalRoadClass| {
            let road = look.style.road(*class);
            // The style says how many pixels of the road it insists on: the more, the longer it stays.
            let stays_m = f64::from(road.width_m * road.min_width_px.max(1.0));
            stays_m >= pixel_m && road.last_pixel_m() > pixel_m
        };
        Self {
            classes: look.classes.iter().copied().filter(is_seen).collect(),
            tolerance_steps: pixel_m / 4.0 * manifest.point_scale / manifest.frame.lattice_step_m(),
        }
    }
}

impl<'a> TileLines<'a> {
    /// Lines of the levels down to `finest`.
    pub(crate) fn new(package: &'a FilePackage, look: RoadLook<'a>, finest: u8) -> Self {
        let detail = |level| Detail::of_level(look, package.manifest(), level, finest);
        Self { package, look, details: (0..=finest).map(detail).collect(), kept: Mutex::default() }
    }

    fn of_tile(&self, id: TileId) -> Result<Arc<Vec<TileLine>>, ExportError> {
        let lock = || self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, known)) = lock().iter().find(|(known, _)| *known == id) {
            return Ok(Arc::clone(known));
        }
        let detail = &self.details[usize::from(id.z())];
        let pieces = read::pieces(self.package, id, &detail.classes)?;
        let mut lines: Vec<TileLine> = pieces.into_iter().filter_map(TileLine::of_piece).collect();
        simplify(&mut lines, detail.tolerance_steps);
        let lines = Arc::new(lines);
        let mut kept = lock();
        kept.push_back((id, Arc::clone(&lines)));
        if kept.len() > KEPT_TILES {
            kept.pop_front();
        }
        Ok(lines)
    }

    /// The roads in a tile and in those around it, the most important first. Lines that go on across a border know the point beyond it.
    pub(crate) fn around(&self, id: TileId) -> Result<Vec<Road>, ExportError> {
        let mut tiles = Vec::new();
        for dy in -1..=1 {
            for dx in -1..=1 {
                if let Some(near) = id.neighbour(dx, dy) {
                    tiles.push(self.of_tile(near)?);
                }
            }
        }
        let lines: Vec<&TileLine> = tiles.iter().flat_map(|tile| tile.iter()).collect();
        // Lines of a way that end at a point, and those that begin there.
        let mut across: HashMap<(i64, LatticePoint), [Vec<usize>; 2]> = HashMap::new();
        let mut meetings: HashMap<LatticePoint, u32> = HashMap::new();
        for (number, line) in lines.iter().enumerate() {
            let ends = [line.points[0], line.points[line.points.len() - 1]];
            for (end, point) in ends.into_iter().enumerate() {
                if line.goes_on[end] {
                    across.entry((line.way_id, point)).or_default()[1 - end].push(number);
                }
            }
            for point in &line.points {
                *meetings.entry(*point).or_default() += 1;
            }
        }
        // Across a border the same point is that of two lines of one way.
        let is_met = |point: &LatticePoint| meetings[point] > 1;
        let joined = |way_id: i64, point: LatticePoint| {
            across.get(&(way_id, point)).and_then(|found| match found {
                [ending, beginning] if ending.len() == 1 && beginning.len() == 1 => {
                    Some([lines[ending[0]], lines[beginning[0]]])
                }
                _ => None,
            })
        };
        let center = |line: &TileLine| {
            let [first, last] = [line.points[0], line.points[line.points.len() - 1]];
            let before = joined(line.way_id, first)
                .filter(|_| line.goes_on[0])
                .map(|[ending, _]| ending.points[ending.points.len() - 2]);
            let after = joined(line.way_id, last)
                .filter(|_| line.goes_on[1])
                .map(|[_, beginning]| beginning.points[1]);
            CenterLine {
                points: line.points.clone(),
                beyond: [before, after],
                is_met: [is_met(&first), is_met(&last)],
                half_width: self.half_width(line),
            }
        };
        let mut roads: Vec<Road> = lines
            .iter()
            .map(|line| Road {
                way_id: line.way_id,
                class: line.class,
                attributes: Arc::clone(&line.attributes),
                center: center(line),
            })
            .collect();
        roads.sort_by(|one, other| {
            let key = |road: &Road| (road.class.number(), road.way_id);
            key(one).cmp(&key(other)).then_with(|| one.center.points.cmp(&other.center.points))
        });
        Ok(roads)
    }

    /// Half the width of a road, lattice steps.
    fn half_width(&self, line: &TileLine) -> f64 {
        let manifest = self.package.manifest();
        let RoadAttributes { form, highway, .. } = &*line.attributes;
        // As the viewer draws them.
        let is_narrow = *form == Form::Link || highway == "service";
        let share = if is_narrow { RoadStyle::NARROW_WIDTH_SHARE } else { 1.0 };
        let width_m = self.look.style.width_m(line.class, line.attributes.own_width());
        f64::from(width_m * share) / 2.0 * manifest.point_scale / manifest.frame.lattice_step_m()
    }
}

impl TileLine {
    /// The plan of a piece; `None` for a tunnel, which is not on the ground, and for one without length.
    fn of_piece(piece: Piece) -> Option<Self> {
        if piece.attributes.structure == Structure::Tunnel {
            return None;
        }
        // A line that ends where the ground ends has no point of its own there.
        let last = piece.vertices.len() - 1;
        let own = piece.vertices.iter().enumerate();
        let own = own.filter(|(at, vertex)| vertex.is_source || *at == 0 || *at == last);
        let mut points: Vec<LatticePoint> = own
            .map(|(_, vertex)| {
                LatticePoint::new(vertex.at[0].round() as i64, vertex.at[1].round() as i64)
            })
            .collect();
        points.dedup();
        (points.len() > 1).then(|| Self {
            way_id: piece.key.way_id,
            class: piece.class,
            attributes: Arc::new(piece.attributes),
            points,
            goes_on: piece.goes_on,
        })
    }
}

/// Leaves out points of lines that nobody sees. Points that lines share stay, so that roads still meet; a tile and its neighbours see the same lines of
/// each tile, so they simplify them the same way.
fn simplify(lines: &mut [TileLine], tolerance_steps: f64) {
    let mut uses: HashMap<LatticePoint, u32> = HashMap::new();
    for line in lines.iter() {
        for point in &line.points {
            *uses.entry(*point).or_default() += 1;
        }
    }
    for line in lines {
        let Ok(whole) = Polyline::new(line.points.clone()) else { continue };
        let fixed = |(_, point): &(u32, &LatticePoint)| uses[*point] > 1;
        let fixed = (0..).zip(whole.points()).filter(fixed).map(|(at, _)| at).collect();
        let road = corniche_roads::Road {
            way_id: line.way_id,
            class: line.class,
            attributes: (*line.attributes).clone(),
            line: whole,
            fixed,
            node_ids: Vec::new(),
            same_places: Vec::new(),
        };
        line.points = corniche_roads::simplify(&road, tolerance_steps).into_points();
    }
}
