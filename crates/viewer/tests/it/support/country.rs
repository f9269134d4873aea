//! Mountains of three wavelengths with roads, triangulated and draped when a tile is requested.
//! Some roads have widths of their own, which most styles ignore.

use std::{
    collections::BTreeSet,
    num::{NonZeroU8, NonZeroU32},
};

use corniche_drape::{OwnedBorders, clip, clip_closed, drape, extrude};
use corniche_geom::{GridFrame, HeightGrid, NodeIndex, Polyline, TILE_NODES, TileId};
use corniche_roads::RoadAttributes;
use corniche_tileset::{GeoRoad, RoadRecord, SvRoad, TilePayload, TileTerrain};
use corniche_tin::{Placement, Surface, TinSpec, normals, triangulate};
use corniche_viewer::{
    Mapping,
    for_tests::PlanScale,
    tiles::{LoadTileError, TileCatalog, TileGeometry, TileSource},
};

use super::{class, scene::Widths};

pub(crate) const CELL_M: f64 = 25.0;
pub(crate) const MAX_LEVEL: u8 = 4;
pub(crate) const MAX_ERROR_M: f64 = 4.0;
pub(crate) const QUANTUM_M: f64 = 1.0 / 16.0;

/// Mountains of three wavelengths over 102 km, with roads; tiles are created on request.
pub(crate) struct Country {
    pub(crate) frame: GridFrame,
    pub(crate) roads: Vec<(u8, Polyline)>,
}

/// Amplitude in metres and wave number in 1/m along x and y.
pub(crate) const WAVES: [[f64; 3]; 3] = [
    [700.0, 1.0 / 2400.0, 1.0 / 3100.0],
    [180.0, 1.0 / 700.0, 1.0 / 520.0],
    [25.0, 1.0 / 160.0, 1.0 / 210.0],
];

pub(crate) fn height_m(x: f64, y: f64) -> f64 {
    1000.0
        + WAVES.iter().map(|[height, kx, ky]| height * (x * kx).sin() * (y * ky).cos()).sum::<f64>()
}

/// Error of interpolating `height_m` linearly over right triangles with legs `cell_m`: by Taylor's
/// theorem at most cell² / 8 · (`|f_xx| + 2 |f_xy| + |f_yy|`), and never more than twice the
/// amplitude.
pub(crate) fn interpolation_error_m(cell_m: f64) -> f64 {
    let error = |[height, kx, ky]: [f64; 3]| {
        (height * cell_m * cell_m / 8.0 * (kx + ky).powi(2)).min(2.0 * height)
    };
    WAVES.map(error).iter().sum()
}

/// How far SV lines extend beyond their tile: eight cells of the level.
pub(crate) fn width_margin_m(frame: &GridFrame, level: u8) -> f64 {
    8.0 * frame.level_cell(level).shorter_m()
}

impl Country {
    /// The widths of a tile's roads; working metres are true metres.
    pub(crate) fn widths(&self, id: TileId) -> Widths {
        Widths { margin_m: width_margin_m(&self.frame, id.z()), scale: PlanScale::default() }
    }

    pub(crate) fn new() -> Self {
        let frame = GridFrame::new(
            [0.0; 2],
            super::world().cell(CELL_M),
            NodeIndex { i: 25_600, j: 204_800 },
            MAX_LEVEL,
        )
        .unwrap();
        let [cx, cy] = frame.tile_bounds(TileId::ROOT).center();
        let road = |points: &[[f64; 2]]| {
            let points =
                points.iter().map(|[x, y]| frame.snap([cx + x, cy + y]).unwrap()).collect();
            Polyline::new(points).unwrap()
        };
        let bends: Vec<[f64; 2]> = (0..=80)
            .map(|k| [-8000.0 + 200.0 * f64::from(k), 900.0 * (f64::from(k) / 4.0).sin()])
            .collect();
        let roads = vec![
            (0, road(&[[-20_000.0, -1500.0], [-3000.0, 700.0], [22_000.0, 2600.0]])),
            (3, road(&bends)),
            (6, road(&[[500.0, -9000.0], [0.0, 0.0], [-1200.0, 9000.0]])),
        ];
        Self { frame, roads }
    }

    pub(crate) fn payload(&self, id: TileId) -> TilePayload {
        let (frame, stride) = (&self.frame, self.frame.stride(id.z()));
        let window = frame.tile_window(id).with_halo(1);
        let heights = HeightGrid::from_fn(TILE_NODES + 2, TILE_NODES + 2, |column, row| {
            let node = window.node(column, row);
            height_m(frame.x_m(node.i), frame.y_m(node.j)) as f32
        });
        let max_error_m = MAX_ERROR_M * stride as f64;
        let tin = triangulate(&heights, TinSpec { max_error_m, quantum_m: QUANTUM_M }).unwrap();
        let placement = Placement {
            corner: frame.lattice_of_node(frame.tile_corner(id)),
            node_steps: frame.node_steps(id.z()),
            quantum_m: QUANTUM_M,
        };
        let surface = Surface::new(&tin, placement);
        let (mut roads_geo, mut roads_sv) = (Vec::new(), Vec::new());
        let margin = (width_margin_m(frame, id.z()) / frame.lattice_step_m()) as i64;
        for (way_id, (number, line)) in self.roads.iter().enumerate() {
            let mut parts = 0..;
            for part in clip(line, &frame.tile_lattice_bounds(id), OwnedBorders::of_tile(id)) {
                for line in drape(&part, &surface).lines {
                    roads_geo.push(GeoRoad {
                        way_id: way_id as i64,
                        part: parts.next().unwrap(),
                        class: class(*number),
                        line,
                    });
                }
            }
            let mut parts = 0..;
            for part in clip_closed(line, &frame.tile_lattice_bounds(id).expanded(margin)) {
                for line in extrude(&part, &surface, margin) {
                    roads_sv.push(SvRoad {
                        way_id: way_id as i64,
                        part: parts.next().unwrap(),
                        class: class(*number),
                        line,
                    });
                }
            }
        }
        let terrain = TileTerrain {
            normals: normals(&heights, &tin, frame.level_cell(id.z()), 0),
            tin,
            geometric_error_m: max_error_m
                + interpolation_error_m(frame.level_cell(id.z()).shorter_m()),
            height_range_m: [90.0, 1910.0],
            uncovered_nodes: 0,
        };
        let geo = roads_geo.iter().map(|road| road.way_id);
        let ways: BTreeSet<i64> = geo.chain(roads_sv.iter().map(|road| road.way_id)).collect();
        let attributes = ways.into_iter().map(record).collect();
        TilePayload { id, terrain: Some(terrain), relief: None, roads_geo, roads_sv, attributes }
    }
}

/// Returns the record of a way. Of three ways, one has a width, one has lanes, one has neither.
fn record(way_id: i64) -> RoadRecord {
    let (widths_mm, lanes) = ([2500, 14_000, 33_000, 80_000], [1, 2, 6, 30]);
    let turn = (way_id / 3) as usize % 4;
    let attributes = match way_id % 3 {
        0 => RoadAttributes {
            width_mm: NonZeroU32::new(widths_mm[turn]),
            ..RoadAttributes::default()
        },
        1 => RoadAttributes { lanes: NonZeroU8::new(lanes[turn]), ..RoadAttributes::default() },
        _ => RoadAttributes::default(),
    };
    RoadRecord { way_id, attributes }
}

impl TileCatalog for Country {
    fn frame(&self) -> &GridFrame {
        &self.frame
    }

    fn exists(&self, id: TileId) -> bool {
        id.z() <= MAX_LEVEL
    }
}

impl TileSource for Country {
    fn load(&self, id: TileId) -> Result<TileGeometry, LoadTileError> {
        let margin_m = width_margin_m(&self.frame, id.z());
        TileGeometry::from_payload(
            &self.payload(id),
            None,
            &self.frame,
            QUANTUM_M,
            (margin_m, PlanScale::default()),
            Mapping::OnTriangles,
        )
        .map_err(|error| LoadTileError { id, source: error.into() })
    }
}
