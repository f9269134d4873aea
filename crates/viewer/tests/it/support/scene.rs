//! Scenes in f64, the common input of the renderer and the references.

use std::collections::HashMap;

use corniche_geom::{Bounds, GridFrame, TileId};
use corniche_roads::OwnWidth;
use corniche_styles::Style;
use corniche_tileset::{FilePackage, Sections, TilePayload, TileTerrain};
use corniche_tin::{Placement, Surface};
use corniche_viewer::{
    FrameView, Mapping, PackageLooks, RoadOptions,
    camera::Camera,
    for_tests::{GroundLine, PlanLine, PlanScale},
    gpu::{DrawTile, Gpu, Renderer, Targets, TileBuffers},
    tiles::{DeckLine, RoadKind, RoadLook, TileGeometry, TileLines},
};
use glam::{DVec2, DVec3};

use super::{Drawing, network::part_lengths_m};
use crate::support;

/// A segment of a road in plan.
#[derive(Clone, Copy)]
pub(crate) struct PlanSegment {
    pub(crate) class: u8,
    pub(crate) ends: [DVec2; 2],
    /// Working metres across it per true metre.
    pub(crate) factor: f64,
    /// Width from its tags.
    pub(crate) own: OwnWidth,
    pub(crate) look: RoadLook,
    /// Distance of its start along its road, for dashes.
    pub(crate) start_m: f64,
    /// Whether it ends flat at its start and at its end, because another road continues there.
    pub(crate) flat: [bool; 2],
    /// The minimum and maximum length of its part of the network, metres.
    pub(crate) part_m: [f64; 2],
}

/// A tile of a scene.
#[derive(Clone)]
pub(crate) struct Tile {
    pub(crate) geometry: TileGeometry,
    pub(crate) skirt_depth_m: f64,
    /// The ground without skirts.
    pub(crate) triangles: Vec<[DVec3; 3]>,
    /// The SV lines.
    pub(crate) segments: Vec<PlanSegment>,
    /// The GEO lines.
    pub(crate) centers: Vec<GroundLine>,
    /// The SV lines within the width margin of each square of a grid as wide as the margin.
    near: HashMap<[i64; 2], Vec<PlanSegment>>,
    terrain: TileTerrain,
    frame: GridFrame,
    quantum_m: f64,
    lines: TileLines,
}

/// The maximum width of the roads of a tile, and the conversion of true widths to working metres.
#[derive(Clone, Copy)]
pub(crate) struct Widths {
    pub(crate) margin_m: f64,
    pub(crate) scale: PlanScale,
}

/// Tiles and the style of their roads.
#[derive(Clone)]
pub(crate) struct Scene {
    pub(crate) tiles: Vec<Tile>,
    pub(crate) style: Style,
    /// How the layers of the tiles are drawn.
    pub(crate) layers: PackageLooks,
}

impl Tile {
    /// A tile of the tests' frame with roads given in plan by way, class and points.
    pub(crate) fn new(
        id: TileId,
        ground: &TileTerrain,
        roads: &[(i64, u8, Vec<DVec2>)],
        skirt_depth_m: f64,
    ) -> Self {
        let frame = support::frame();
        let margin_m = 8.0 * frame.level_cell(id.z()).shorter_m();
        let bounds = frame.tile_bounds(id);
        let triangles = support::triangles(id, ground);
        let scale = PlanScale::uniform(support::world().scale);
        let mut lines = TileLines { width_margin_m: margin_m, scale, ..TileLines::default() };
        for (way_id, number, points) in roads {
            let class = support::class(*number);
            for pair in points.windows(2) {
                // Where the road continues, the line continues, too.
                if let Some([a, b]) = clip([pair[0], pair[1]], grown(bounds, margin_m)) {
                    let before = lines.plan.last_mut().filter(|line| {
                        line.way_id == *way_id && line.points_m.last() == Some(&a.to_array())
                    });
                    // The height range of the tile is never too narrow.
                    let range_m = ground.height_range_m;
                    match before {
                        Some(line) => {
                            line.points_m.push(b.to_array());
                            line.ground_range_m.push(range_m);
                        }
                        None => lines.plan.push(PlanLine {
                            dashes: None,
                            way_id: *way_id,
                            kind: RoadKind::plain(class),
                            points_m: vec![a.to_array(), b.to_array()],
                            ground_range_m: vec![range_m],
                        }),
                    }
                }
                if let Some([a, b]) = clip([pair[0], pair[1]], bounds) {
                    let points_m = support::lay(a, b, &triangles);
                    let line = support::ground_line(*number, points_m);
                    let before = lines.ground.last_mut().filter(|before| {
                        before.way_id == *way_id && before.points_m.last() == line.points_m.first()
                    });
                    match before {
                        Some(before) => {
                            before.points_m.extend_from_slice(&line.points_m[1..]);
                            before.sources_m.extend_from_slice(&line.sources_m);
                        }
                        None => lines.ground.push(GroundLine { way_id: *way_id, ..line }),
                    }
                }
            }
        }
        Self::of_lines(id, ground, &frame, support::QUANTUM_M, lines, triangles, skirt_depth_m)
    }

    /// The SV lines that may be within the width margin of a position, and some others.
    pub(crate) fn segments_near(&self, at: DVec2) -> &[PlanSegment] {
        self.near.get(&square(at, self.geometry.width_margin_m)).map_or(&[], Vec::as_slice)
    }

    /// A tile of a package on disk, with the widths that the GPU draws for its roads.
    pub(crate) fn of_package(package: &FilePackage, id: TileId, skirt_depth_m: f64) -> Self {
        let manifest = package.manifest();
        let payload = package.payload(id, Sections::ALL).unwrap().unwrap();
        let bounds = manifest.frame.tile_bounds(id);
        let widths = Widths {
            margin_m: manifest.levels[usize::from(id.z())].width_margin_m,
            scale: PlanScale::of_tile(&manifest.coordinates, bounds, manifest.point_scale),
        };
        let quantum_m = manifest.vertical.quantum_m;
        Self::of_payload(&payload, &manifest.frame, quantum_m, widths, skirt_depth_m)
    }

    /// A tile of a payload.
    pub(crate) fn of_payload(
        payload: &TilePayload,
        frame: &GridFrame,
        quantum_m: f64,
        widths: Widths,
        skirt_depth_m: f64,
    ) -> Self {
        let ground = payload.terrain.as_ref().unwrap();
        let placement = Placement::of_tile(frame, payload.id, quantum_m);
        let surface = Surface::new(&ground.tin, placement);
        let centers = payload
            .roads_geo
            .iter()
            .map(|road| GroundLine {
                dashes: None,
                way_id: road.way_id,
                kind: RoadKind {
                    class: road.class,
                    own_width: own_width(payload, road.way_id),
                    look: look(payload, road.way_id),
                },
                points_m: corniche_drape::positions(&road.line, &surface)
                    .unwrap()
                    .into_iter()
                    .map(|[u, v, height_m]| {
                        let [x, y] = frame.position_of_fraction_m([u, v]);
                        [x, y, height_m]
                    })
                    .collect(),
                sources_m: corniche_drape::source_segments(&road.line)
                    .into_iter()
                    .map(|ends| ends.map(|point| frame.position_m(point)))
                    .collect(),
            })
            .collect();
        let plan = payload
            .roads_sv
            .iter()
            .map(|road| PlanLine {
                dashes: None,
                way_id: road.way_id,
                kind: RoadKind {
                    class: road.class,
                    own_width: own_width(payload, road.way_id),
                    look: look(payload, road.way_id),
                },
                points_m: road.line.points.iter().map(|point| frame.position_m(*point)).collect(),
                ground_range_m: road.line.ground_range_m.clone(),
            })
            .collect();
        let Widths { margin_m, scale } = widths;
        let lines = TileLines {
            ground: centers,
            plan,
            width_margin_m: margin_m,
            scale,
            ..TileLines::default()
        };
        let corner = |vertex: u32| {
            let [x, y] = frame.position_m(surface.points()[vertex as usize]);
            DVec3::new(x, y, surface.heights_m()[vertex as usize])
        };
        let triangles = surface.triangles().iter().map(|corners| corners.map(corner)).collect();
        Self::of_lines(payload.id, ground, frame, quantum_m, lines, triangles, skirt_depth_m)
    }

    /// Returns the tile with other ids for its ways, both in GEO and SV lines.
    pub(crate) fn with_ways_renumbered(&self, by: i64) -> Self {
        let mut lines = self.lines.clone();
        lines.ground.iter_mut().for_each(|line| line.way_id += by);
        lines.plan.iter_mut().for_each(|line| line.way_id += by);
        self.with_lines(lines)
    }

    /// Returns the tile with own widths for its ways, both in GEO and SV lines.
    pub(crate) fn with_own_widths(&self, of_way: impl Fn(i64) -> OwnWidth) -> Self {
        let mut lines = self.lines.clone();
        lines.ground.iter_mut().for_each(|line| line.kind.own_width = of_way(line.way_id));
        lines.plan.iter_mut().for_each(|line| line.kind.own_width = of_way(line.way_id));
        self.with_lines(lines)
    }

    /// Returns the tile with these looks for its ways, both in GEO and SV lines.
    pub(crate) fn with_looks(&self, of_way: impl Fn(i64) -> RoadLook) -> Self {
        let mut lines = self.lines.clone();
        lines.ground.iter_mut().for_each(|line| line.kind.look = of_way(line.way_id));
        lines.plan.iter_mut().for_each(|line| line.kind.look = of_way(line.way_id));
        self.with_lines(lines)
    }

    /// Returns the tile with these bridges; its roads on the ground end where bridges begin.
    pub(crate) fn with_decks(&self, decks: Vec<DeckLine>) -> Self {
        self.with_lines(TileLines { decks, ..self.lines.clone() })
    }

    /// Returns the tile with undraped roads.
    pub(crate) fn unmapped(&self) -> Self {
        self.with_lines(TileLines { mapping: Mapping::Unmapped, ..self.lines.clone() })
    }

    fn with_lines(&self, lines: TileLines) -> Self {
        let (id, triangles) = (self.geometry.id, self.triangles.clone());
        let Self { terrain, frame, quantum_m, skirt_depth_m, .. } = self;
        Self::of_lines(id, terrain, frame, *quantum_m, lines, triangles, *skirt_depth_m)
    }

    pub(crate) fn of_lines(
        id: TileId,
        ground: &TileTerrain,
        frame: &GridFrame,
        quantum_m: f64,
        lines: TileLines,
        triangles: Vec<[DVec3; 3]>,
        skirt_depth_m: f64,
    ) -> Self {
        let parts_m = part_lengths_m(&lines.plan, frame.tile_bounds(id), lines.width_margin_m);
        let segments: Vec<PlanSegment> = lines
            .plan
            .iter()
            .zip(&parts_m)
            .flat_map(|(line, part_m)| {
                line.points_m.windows(2).enumerate().map(|(number, pair)| PlanSegment {
                    start_m: start_m(&line.points_m, number, frame.tile_bounds(id)),
                    flat: [
                        number == 0
                            && is_flat(&lines.plan, line, End::First, frame.tile_bounds(id)),
                        number + 2 == line.points_m.len()
                            && is_flat(&lines.plan, line, End::Last, frame.tile_bounds(id)),
                    ],
                    part_m: *part_m,
                    class: line.kind.class.number(),
                    ends: [pair[0], pair[1]].map(DVec2::from_array),
                    factor: lines.scale.across([pair[0], pair[1]]),
                    own: line.kind.own_width,
                    look: line.kind.look,
                })
            })
            .collect();
        let mut near: HashMap<_, Vec<PlanSegment>> = HashMap::new();
        for segment in &segments {
            let [a, b] = segment.ends;
            let [low, high] = [a.min(b), a.max(b)].map(|at| square(at, lines.width_margin_m));
            for column in low[0] - 1..=high[0] + 1 {
                for row in low[1] - 1..=high[1] + 1 {
                    near.entry([column, row]).or_default().push(*segment);
                }
            }
        }
        Self {
            near,
            geometry: TileGeometry::assemble(id, Some(ground), &lines, frame, quantum_m),
            skirt_depth_m,
            triangles,
            segments,
            centers: lines.ground.clone(),
            terrain: ground.clone(),
            frame: *frame,
            quantum_m,
            lines,
        }
    }
}

impl Scene {
    pub(crate) fn view<'a>(
        camera: &'a Camera,
        style: &'a Style,
        roads: RoadOptions,
    ) -> FrameView<'a> {
        FrameView {
            camera,
            style,
            layers: PackageLooks::NONE,
            roads,
            exaggeration: 1.0,
            point_scale: 1.0,
            height_range_m: [0.0, 2000.0],
            wall_m: 0.0,
            cell_px: f64::INFINITY,
            latitude_deg: 47.0,
            is_wireframe: false,
        }
    }

    pub(crate) fn draw(&self, gpu: &Gpu, camera: &Camera, options: RoadOptions) -> Drawing {
        let view = FrameView { layers: &self.layers, ..Self::view(camera, &self.style, options) };
        let targets = self.draw_view(gpu, &view, 1);
        Drawing::read(gpu, &targets)
    }

    pub(crate) fn draw_view(
        &self,
        gpu: &Gpu,
        view: &FrameView<'_>,
        samples_per_side: u32,
    ) -> Targets {
        let buffers: Vec<TileBuffers> =
            self.tiles.iter().map(|tile| TileBuffers::new(gpu, &tile.geometry, None)).collect();
        let tiles: Vec<DrawTile<'_>> = buffers
            .iter()
            .zip(&self.tiles)
            .map(|(buffers, tile)| DrawTile { buffers, skirt_depth_m: tile.skirt_depth_m })
            .collect();
        let targets = Targets::new(gpu, view.camera.size_px, samples_per_side).unwrap();
        Renderer::new(gpu).draw(gpu, view, &tiles, &targets);
        targets
    }
}

/// The distance of a segment's start along its line: from the first of the preceding vertices that
/// are in the tile without a break; for a segment that enters the tile, from its end; for a segment
/// with neither end in the tile, from the zero of the CRS along it.
fn start_m(points_m: &[[f64; 2]], segment: usize, tile: Bounds) -> f64 {
    let at = |k: usize| DVec2::from_array(points_m[k]);
    let [low, high] = [DVec2::new(tile.min_x, tile.min_y), DVec2::new(tile.max_x, tile.max_y)];
    let is_inside = |k: usize| at(k).cmpge(low - 1e-6).all() && at(k).cmple(high + 1e-6).all();
    if is_inside(segment) {
        let run = (0..=segment).rev().take_while(|k| is_inside(*k));
        return run.skip(1).map(|k| at(k).distance(at(k + 1))).sum();
    }
    let [a, b] = [at(segment), at(segment + 1)];
    if is_inside(segment + 1) { -a.distance(b) } else { a.dot((b - a).normalize_or_zero()) }
}

/// An end of a line.
#[derive(Clone, Copy, PartialEq)]
enum End {
    First,
    Last,
}

/// The end of a line, and the direction in which it would continue.
fn end_of(line: &PlanLine, end: End) -> (DVec2, DVec2) {
    let mut points: Vec<DVec2> = line.points_m.iter().copied().map(DVec2::from_array).collect();
    if end == End::First {
        points.reverse();
    }
    let [before, last] = [points[points.len() - 2], points[points.len() - 1]];
    (last, (last - before).normalize_or_zero())
}

/// Whether a line ends flat: another line that is drawn below it begins there and turns by at most
/// 30°, and all lines that end there are drawn below it.
fn is_flat(lines: &[PlanLine], line: &PlanLine, end: End, tile: Bounds) -> bool {
    let above = |line: &PlanLine| {
        let layer = ["Tunnel", "Service", "Ground"].len()
            - match line.kind.look {
                RoadLook::Plain | RoadLook::Link | RoadLook::Carriageway => 1,
                RoadLook::Service => 2,
                _ => 3,
            };
        let narrow = match line.kind.look {
            RoadLook::Link => 0,
            RoadLook::Carriageway | RoadLook::CarriagewayTunnel => 1,
            _ => 2,
        };
        (layer, 9 - line.kind.class.number(), narrow)
    };
    let (at, outward) = end_of(line, end);
    let inside = at.x > tile.min_x && at.x < tile.max_x && at.y > tile.min_y && at.y < tile.max_y;
    let others: Vec<(&PlanLine, DVec2)> = lines
        .iter()
        .flat_map(|other| [End::First, End::Last].map(|which| (other, which)))
        .filter(|(other, which)| !(std::ptr::eq(*other, line) && *which == end))
        .filter_map(|(other, which)| {
            let (there, direction) = end_of(other, which);
            (there == at && direction != DVec2::ZERO).then_some((other, direction))
        })
        .collect();
    inside
        && outward != DVec2::ZERO
        && others.iter().all(|(other, _)| above(other) < above(line))
        && others.iter().any(|(_, direction)| outward.dot(-*direction) >= 0.866)
}

/// The own width of a way, from the payload's list.
fn own_width(payload: &TilePayload, way_id: i64) -> OwnWidth {
    let found = payload.attributes.iter().find(|record| record.way_id == way_id);
    found.map_or(OwnWidth::Unknown, |record| record.attributes.own_width())
}

/// The look of a way, from the payload's list.
fn look(payload: &TilePayload, way_id: i64) -> RoadLook {
    let found = payload.attributes.iter().find(|record| record.way_id == way_id);
    found.map_or(RoadLook::Plain, |record| RoadLook::from_attributes(&record.attributes))
}

/// The square of a grid that contains a position.
fn square(at: DVec2, side_m: f64) -> [i64; 2] {
    (at / side_m).floor().to_array().map(|k| k as i64)
}

fn grown(bounds: Bounds, margin_m: f64) -> Bounds {
    Bounds {
        min_x: bounds.min_x - margin_m,
        min_y: bounds.min_y - margin_m,
        max_x: bounds.max_x + margin_m,
        max_y: bounds.max_y + margin_m,
    }
}

/// The part of a segment in a rectangle; `None` if it has no length there, unless the segment
/// itself has none.
///
/// Source: Liang & Barsky 1984, *A New Concept and Method for Line Clipping*.
fn clip([a, b]: [DVec2; 2], bounds: Bounds) -> Option<[DVec2; 2]> {
    let d = b - a;
    let mut range = [0.0_f64, 1.0_f64];
    for (p, q) in [
        (-d.x, a.x - bounds.min_x),
        (d.x, bounds.max_x - a.x),
        (-d.y, a.y - bounds.min_y),
        (d.y, bounds.max_y - a.y),
    ] {
        if p < 0.0 {
            range[0] = range[0].max(q / p);
        } else if p > 0.0 {
            range[1] = range[1].min(q / p);
        } else if q < 0.0 {
            return None;
        }
    }
    let at = |share: f64| match share {
        0.0 => a,
        1.0 => b,
        _ => (a + d * share)
            .clamp(DVec2::new(bounds.min_x, bounds.min_y), DVec2::new(bounds.max_x, bounds.max_y)),
    };
    (range[0] < range[1]).then(|| range.map(at))
}
