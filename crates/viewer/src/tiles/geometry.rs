//! A decoded tile that is ready for the GPU.

use corniche_geom::{Bounds, GridFrame, MOST_TILE_STEPS, StepBudget, TileId, barycentric};
use corniche_styles::OwnWidths;
use corniche_tileset::{LayerObject, LayerShape, LayerSlot, SpanRun, TilePayload, TileTerrain};
use corniche_tin::Surface;
use serde::{Deserialize, Serialize};

use super::{
    AreaVolumes, BadAreas, BadRoads, DeckLine, DeckPieces, GroundMesh, LineLayers, PhotoImage,
    PlanScale, PointMarks, RoadKind, ShadingSlopes, TileArea, TileLayer, TileLines,
    relief::RoadRelief,
};
use crate::{layer_class::LayerClass, lod::GroundSummary, options::Mapping};

/// A decoded tile, ready to be uploaded: positions are f32 and relative to the tile's reference
/// point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TileGeometry {
    /// Id of the tile.
    pub id: TileId,
    /// The reference point: x and y in the working CRS, true height. All positions are relative to
    /// it.
    pub reference_m: [f64; 3],
    /// Errors and heights; `None` without ground.
    pub summary: Option<GroundSummary>,
    /// The ground and its skirts.
    pub(crate) ground: GroundMesh,
    /// Slopes at all nodes, for shading; `None` if the package has none.
    pub(crate) shading: Option<ShadingSlopes>,
    /// The photo of the ground; `None` if there is none, or it was not read.
    pub photo: Option<PhotoImage>,
    /// The roads on it, with the bridges over it; what was not read is empty.
    pub roads: TileLayer,
    /// The areas on it as volumes; empty if no layers of areas were read.
    pub areas: AreaVolumes,
    /// The points on it; empty if no layers of points were read.
    pub points: PointMarks,
    /// Lines that are not roads.
    pub lines: LineLayers,
    /// Maximum half width of drawn roads, working metres.
    pub width_margin_m: f64,
    /// The largest width factor of the roads: working metres across a road per true metre across
    /// it.
    pub(crate) most_width_factor: f64,
    /// Sides of the tile, east and north.
    pub size_m: [f64; 2],
    /// Ways whose own width a style may cap.
    pub(crate) wide_ways: Vec<WideWay>,
}

/// A way with a width of its own that a style may cap.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct WideWay {
    /// OSM's id of the way.
    pub(crate) way_id: i64,
    /// Kind of the road.
    pub(crate) kind: RoadKind,
}

/// Why a decoded tile could not be transferred between instances.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("a decoded tile was not transferred completely: {reason}")]
pub struct TransferError {
    /// Description of the fault.
    pub reason: String,
}

/// The wide ways of some lines, each once.
fn wide_ways(lines: &TileLines) -> Vec<WideWay> {
    // No style has wider lanes.
    let widest = OwnWidths { lane_m: Some(OwnWidths::WIDEST_LANE_M) };
    let is_wide = |way: &WideWay| {
        widest.asked_m(way.kind.own_width).is_some_and(|asked_m| asked_m > OwnWidths::WIDEST_M)
    };
    let of_ground =
        lines.ground.iter().map(|line| WideWay { way_id: line.way_id, kind: line.kind });
    let in_plan = lines.plan.iter().map(|line| WideWay { way_id: line.way_id, kind: line.kind });
    let mut ways: Vec<WideWay> = of_ground.chain(in_plan).filter(is_wide).collect();
    ways.sort_by_key(|way| (way.way_id, way.kind.class));
    ways.dedup();
    ways
}

impl TileGeometry {
    /// A tile without ground, and so without any contents.
    #[must_use]
    pub fn empty(id: TileId, frame: &GridFrame) -> Self {
        Self::assemble(id, None, &TileLines::default(), frame, 1.0)
    }

    /// Assembles a decoded tile. `quantum_m` is the height of one step of the TIN's heights.
    #[must_use]
    pub fn assemble(
        id: TileId,
        terrain: Option<&TileTerrain>,
        lines: &TileLines,
        frame: &GridFrame,
        quantum_m: f64,
    ) -> Self {
        let has_roads = !lines.ground.is_empty() || !lines.plan.is_empty();
        let surface = terrain.filter(|_| has_roads);
        let surface = surface.map(|terrain| Surface::of_tile(&terrain.tin, frame, id, quantum_m));
        Self::on_surface(
            id,
            terrain,
            surface.as_ref(),
            lines,
            frame,
            quantum_m,
            &StepBudget::unlimited(),
        )
    }

    /// Does the same as [`TileGeometry::assemble`] on the `surface` of the terrain, which is needed
    /// only if there are roads. The caller must check the work budget at the end.
    fn on_surface(
        id: TileId,
        terrain: Option<&TileTerrain>,
        surface: Option<&Surface>,
        lines: &TileLines,
        frame: &GridFrame,
        quantum_m: f64,
        work: &StepBudget,
    ) -> Self {
        let bounds = frame.tile_bounds(id);
        let [x, y] = bounds.center();
        let [low_m, high_m] = terrain.map_or([0.0; 2], |terrain| terrain.height_range_m);
        let reference_m = [x, y, f64::midpoint(low_m, high_m)];
        let ground = terrain.map_or_else(GroundMesh::default, |terrain| {
            GroundMesh::new(id, &terrain.tin, &terrain.normals, frame, quantum_m, reference_m)
        });
        let summary = terrain.map(|terrain| GroundSummary {
            geometric_error_m: terrain.geometric_error_m,
            height_range_m: terrain.height_range_m,
        });
        let relief = RoadRelief::new(id, surface, frame, lines.width_margin_m, work);
        let scale = &lines.scale;
        let sources = lines.ground.iter().flat_map(|line| line.sources_m.iter().copied());
        let segments = lines
            .plan
            .iter()
            .flat_map(|line| line.points_m.windows(2))
            .map(|pair| [pair[0], pair[1]]);
        let most_width_factor =
            sources.chain(segments).map(|ends_m| scale.across(ends_m)).fold(0.0, f64::max);
        let in_tile = (bounds, reference_m);
        let (mut roads, mut net) = TileLayer::of_lines(lines, &relief, in_tile, work);
        if lines.mapping == Mapping::Unmapped {
            let straight: Vec<DeckLine> = lines.ground.iter().map(DeckLine::unmapped).collect();
            // The decks are these lines themselves, so their ends must not count twice.
            net.ends.clear();
            roads.decks = DeckPieces::of_decks(&straight, &net, in_tile, scale, work).as_ribbons();
        }
        Self {
            id,
            reference_m,
            summary,
            ground,
            shading: None,
            photo: None,
            areas: AreaVolumes::default(),
            points: PointMarks::default(),
            lines: LineLayers::default(),
            most_width_factor,
            roads,
            width_margin_m: lines.width_margin_m,
            size_m: [bounds.width(), bounds.height()],
            wide_ways: wide_ways(lines),
        }
    }

    /// Decodes a tile's payload: its terrain, the sections of roads that were read, and these spans
    /// (bridges and tunnels) of the tile; `None` if the package has no data about spans.
    /// `width_margin_m` belongs to the tile's level, `scale` to the tile. Unmapped roads ignore
    /// spans.
    ///
    /// # Errors
    /// When a road does not fit the ground, or placing roads takes too much work.
    pub fn from_payload(
        payload: &TilePayload,
        spans: Option<&[SpanRun]>,
        frame: &GridFrame,
        quantum_m: f64,
        (width_margin_m, scale): (f64, PlanScale),
        mapping: Mapping,
    ) -> Result<Self, BadRoads> {
        let (id, terrain) = (payload.id, payload.terrain.as_ref());
        let spans = spans.filter(|_| mapping == Mapping::OnTriangles);
        let has_roads = !payload.roads_geo.is_empty() || !payload.roads_sv.is_empty();
        let surface = terrain.filter(|_| has_roads);
        let surface = surface.map(|terrain| Surface::of_tile(&terrain.tin, frame, id, quantum_m));
        let lines = TileLines::of_payload(
            payload,
            spans,
            surface.as_ref(),
            (frame, quantum_m),
            width_margin_m,
        )?;
        let lines = TileLines { scale, mapping, ..lines };
        let shading = payload.relief.as_ref().filter(|_| terrain.is_some());
        let shading = shading.map(|relief| ShadingSlopes::new(relief, frame.level_cell(id.z())));
        let work = StepBudget::new(MOST_TILE_STEPS);
        let surface = surface.as_ref();
        let tile = Self::on_surface(id, terrain, surface, &lines, frame, quantum_m, &work);
        work.check()?;
        let spans = spans.unwrap_or_default();
        let summary = tile.summary.map(|ground| ground.with_bridges(spans, quantum_m));
        Ok(Self { summary, shading, ..tile })
    }

    /// Returns the tile with the areas and points of these layers. Points without ground under them
    /// are omitted.
    ///
    /// # Errors
    /// When an outline crosses itself, or placing areas on the ground takes too much work.
    pub fn with_layers(
        self,
        layers: Vec<(LayerSlot, Vec<LayerObject>)>,
        frame: &GridFrame,
    ) -> Result<Self, BadAreas> {
        let (mut areas, mut points) = (Vec::new(), Vec::new());
        for (layer, objects) in layers {
            for LayerObject { class, object, shape, .. } in objects {
                let class = LayerClass { layer, class };
                match shape {
                    LayerShape::Area(polygons) => areas.push(TileArea { class, object, polygons }),
                    LayerShape::Point(point) => {
                        let [x, y] = frame.position_m(point);
                        let height_m = self.ground_height_m([x, y]);
                        points.extend(height_m.map(|height_m| (class, [x, y, height_m])));
                    }
                    LayerShape::Line(_) => {}
                }
            }
        }
        let areas = AreaVolumes::new(&areas, self.id, frame, &self.ground, self.reference_m)?;
        let points = PointMarks::new(points, self.reference_m);
        Ok(Self { areas, points, ..self })
    }

    /// Serializes the tile for another instance of this program, of the same version: a worker of a
    /// web page decodes tiles, and the page draws them.
    ///
    /// # Errors
    /// When memory runs out.
    pub fn to_bytes(&self) -> Result<Vec<u8>, TransferError> {
        bincode::serde::encode_to_vec(self, bincode::config::legacy())
            .map_err(|error| TransferError { reason: error.to_string() })
    }

    /// Deserializes the bytes of [`TileGeometry::to_bytes`].
    ///
    /// # Errors
    /// When the bytes are incomplete or invalid.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, TransferError> {
        let failed = |reason: String| TransferError { reason };
        match bincode::serde::decode_from_slice(bytes, bincode::config::legacy()) {
            Ok((tile, read)) if read == bytes.len() => Ok(tile),
            Ok(_) => Err(failed("there are extra bytes after the tile".to_owned())),
            Err(error) => Err(failed(error.to_string())),
        }
    }

    /// Returns the tile without its roads, layers, slopes and photo: enough for rays and
    /// heights.
    #[must_use]
    pub fn without_roads(self) -> Self {
        Self {
            shading: None,
            roads: TileLayer::default(),
            areas: AreaVolumes::default(),
            points: PointMarks::default(),
            lines: LineLayers::default(),
            photo: None,
            ..self
        }
    }

    /// Plan rectangle of the tile in the working CRS.
    #[must_use]
    pub(crate) fn plan_bounds(&self) -> Bounds {
        plan_around(self.reference_m, self.size_m)
    }

    /// True height of the ground at a position in the working CRS; `None` where this tile has no
    /// ground.
    #[must_use]
    pub fn ground_height_m(&self, [x, y]: [f64; 2]) -> Option<f64> {
        let at = [x - self.reference_m[0], y - self.reference_m[1]];
        self.ground.triangle_grid.at(at).iter().find_map(|triangle| {
            let [a, b, c] = self.ground.corners(*triangle);
            let weights = barycentric(at, [a[0], a[1]], [b[0], b[1]], [c[0], c[1]]);
            // Positions were rounded to f32. With a tolerance of a millionth no position falls
            // between two triangles.
            weights.iter().all(|weight| *weight >= -1e-6).then(|| {
                self.reference_m[2] + weights[0] * a[2] + weights[1] * b[2] + weights[2] * c[2]
            })
        })
    }
}

/// Plan rectangle of a tile in the working CRS: its reference point is in the middle.
pub(crate) fn plan_around([x, y, _]: [f64; 3], size_m: [f64; 2]) -> Bounds {
    let [east_m, north_m] = size_m.map(|side_m| side_m / 2.0);
    Bounds { min_x: x - east_m, min_y: y - north_m, max_x: x + east_m, max_y: y + north_m }
}
