//! Centre-lines of roads in and around a tile.

use std::{
    collections::{HashMap, VecDeque},
    sync::{Arc, Mutex, PoisonError},
};

use corniche_geom::{LatticePoint, TileId};
use corniche_roads::{FunctionalRoadClass, RoadAttributes, Structure};
use corniche_tileset::FilePackage;

use super::{request::Tiles3dRequest, ribbon::CenterLine};
use crate::{error::ExportError, piece::Piece, read};

/// Tiles whose lines are kept: some rows of neighbours along a Hilbert curve.
const KEPT_TILES: usize = 256;

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
    request: &'a Tiles3dRequest,
    kept: Mutex<VecDeque<(TileId, Arc<Vec<TileLine>>)>>,
}

impl<'a> TileLines<'a> {
    pub(crate) fn new(package: &'a FilePackage, request: &'a Tiles3dRequest) -> Self {
        Self { package, request, kept: Mutex::default() }
    }

    fn of_tile(&self, id: TileId) -> Result<Arc<Vec<TileLine>>, ExportError> {
        let lock = || self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, known)) = lock().iter().find(|(known, _)| *known == id) {
            return Ok(Arc::clone(known));
        }
        let pieces = read::pieces(self.package, id, &self.request.classes)?;
        let lines: Vec<TileLine> = pieces.into_iter().filter_map(TileLine::of_piece).collect();
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
        let width_m =
            f64::from(self.request.style.width_m(line.class, line.attributes.own_width()));
        width_m / 2.0 * manifest.point_scale / manifest.frame.lattice_step_m()
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
