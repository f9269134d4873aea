//! A decoded tile that is ready for the graphics card.

use corniche_geom::{Bounds, GridFrame, MOST_TILE_STEPS, TileId, Work, barycentric};
use corniche_styles::OwnWidths;
use corniche_tileset::{AreaRecord, SpanRun, Terrain, TilePayload};
use corniche_tin::Surface;
use serde::{Deserialize, Serialize};

use super::{
    AreaVolumes, BadAreas, BadRoads, DeckLine, DeckPieces, GroundMesh, InNet, LineLayers,
    OffGround, PhotoImage, PlanScale, RoadKind, RoadSegments, RoadVolumes, ShadingSlopes,
    TileLines, relief::Relief,
};
use crate::{lod::GroundSummary, options::Mapping};

/// A decoded tile, ready to be uploaded: positions are f32 and relative to the tile's reference point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TileGeometry {
    /// Which tile.
    pub id: TileId,
    /// The reference point: x and y in the working CRS, true height. All positions are relative to it.
    pub reference_m: [f64; 3],
    /// Errors and heights; `None` without ground.
    pub summary: Option<GroundSummary>,
    /// The ground and its skirts.
    pub(crate) ground: GroundMesh,
    /// Slopes at all nodes, for shading; `None` where the package has none.
    pub(crate) shading: Option<ShadingSlopes>,
    /// The photo of the ground; `None` if there is none, or it was not read.
    pub photo: Option<PhotoImage>,
    /// The roads on it as geometry (GEO); empty if that section was not read.
    pub roads: RoadSegments,
    /// The roads on it as volumes (SV); empty if that section was not read.
    pub volumes: RoadVolumes,
    /// Bridges over it; empty if they were not read.
    pub decks: DeckPieces,
    /// The areas on it as volumes; empty if that section was not read.
    pub areas: AreaVolumes,
    /// Lines beside its roads.
    pub lines: LineLayers,
    /// Roads are not drawn beyond this half width, working metres.
    pub width_margin_m: f64,
    /// The largest width factor of its roads: working metres across a road for each true metre across it.
    pub(crate) most_width_factor: f64,
    /// Its sides, east and north.
    pub size_m: [f64; 2],
    /// Ways whose own width some style may cap.
    pub(crate) wide_ways: Vec<WideWay>,
}

/// A way with a width of its own that some style may cap.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct WideWay {
    /// OSM's id of the way.
    pub(crate) way_id: i64,
    /// What it is.
    pub(crate) kind: RoadKind,
}

/// A decoded tile did not come whole from where it was decoded.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("a decoded tile did not come whole: {reason}")]
pub struct TransferError {
    /// What was wrong with it.
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
    /// Puts a decoded tile together. `quantum_m` is the height of one step of the TIN's heights.
    #[must_use]
    pub fn assemble(
        id: TileId,
        terrain: Option<&Terrain>,
        lines: &TileLines,
        frame: &GridFrame,
        quantum_m: f64,
    ) -> Self {
        let has_roads = !lines.ground.is_empty() || !lines.plan.is_empty();
        let surface = terrain.filter(|_| has_roads);
        let surface = surface.map(|terrain| Surface::of_tile(&terrain.tin, frame, id, quantum_m));
        Self::on_surface(
            (id, terrain, surface.as_ref()),
            lines,
            frame,
            quantum_m,
            &Work::unlimited(),
        )
    }

    /// Does the same as [`TileGeometry::assemble`] on the `surface` of the terrain, which is needed only if there are roads. The caller looks in the
    /// end whether it was too much work.
    fn on_surface(
        (id, terrain, surface): (TileId, Option<&Terrain>, Option<&Surface>),
        lines: &TileLines,
        frame: &GridFrame,
        quantum_m: f64,
        work: &Work,
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
        let relief = Relief::new(id, surface, frame, lines.width_margin_m, work);
        let wide = relief.wide(&lines.ground);
        let scale = &lines.scale;
        let sources = lines.ground.iter().flat_map(|line| line.sources_m.iter().copied());
        let segments = lines
            .plan
            .iter()
            .flat_map(|line| line.points_m.windows(2))
            .map(|pair| [pair[0], pair[1]]);
        let most_width_factor =
            sources.chain(segments).map(|ends_m| scale.across(ends_m)).fold(0.0, f64::max);
        let decks = OffGround::new(lines, bounds, work);
        let (on_ground, net) = InNet::all_of(&lines.ground, &decks, 0.0);
        let (in_plan, net_in_plan) = InNet::all_of(&lines.plan, &decks, lines.width_margin_m);
        let mut net = if lines.ground.is_empty() { net_in_plan } else { net };
        let in_tile = (bounds, reference_m);
        let (roads, volumes, decks) = match lines.mapping {
            Mapping::OnTriangles => (
                RoadSegments::of_lines(&on_ground, &decks, reference_m, scale, |piece| {
                    relief.bed(piece, wide.as_ref())
                }),
                RoadVolumes::new(&in_plan, &decks, reference_m, scale, |ends_m| {
                    relief.near(ends_m)
                }),
                DeckPieces::of_decks(&lines.decks, &net, in_tile, scale, work),
            ),
            Mapping::Unmapped => {
                let straight: Vec<DeckLine> = lines.ground.iter().map(DeckLine::unmapped).collect();
                // They are the lines that end there.
                net.ends.clear();
                let ribbons = DeckPieces::of_decks(&straight, &net, in_tile, scale, work);
                (RoadSegments::default(), RoadVolumes::default(), ribbons.as_ribbons())
            }
        };
        Self {
            id,
            reference_m,
            summary,
            ground,
            shading: None,
            photo: None,
            areas: AreaVolumes::default(),
            lines: LineLayers::default(),
            most_width_factor,
            roads,
            volumes,
            decks,
            width_margin_m: lines.width_margin_m,
            size_m: [bounds.width(), bounds.height()],
            wide_ways: wide_ways(lines),
        }
    }

    /// Decodes a tile's payload: its terrain, the sections of roads that were read, and these spans of it; `None` if the
    /// package tells nothing of bridges and tunnels. `width_margin_m` is that of the
    /// tile's level, `scale` that of the tile. Roads that are not mapped take no notice of bridges and tunnels.
    ///
    /// # Errors
    /// When a road does not fit the ground, or placing them takes too much work.
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
        let work = Work::new(MOST_TILE_STEPS);
        let ground = (id, terrain, surface.as_ref());
        let tile = Self::on_surface(ground, &lines, frame, quantum_m, &work);
        work.check()?;
        let spans = spans.unwrap_or_default();
        let summary = tile.summary.map(|ground| ground.with_bridges(spans, quantum_m));
        Ok(Self { summary, shading, ..tile })
    }

    /// The same tile with these areas of it.
    ///
    /// # Errors
    /// When an outline crosses itself, or laying them on the ground takes too much work.
    pub fn with_areas(self, areas: &[AreaRecord], frame: &GridFrame) -> Result<Self, BadAreas> {
        let areas = AreaVolumes::new(areas, self.id, frame, &self.ground, self.reference_m)?;
        Ok(Self { areas, ..self })
    }

    /// The tile as bytes for another instance of this program, of the same version: a worker of a page decodes tiles, and the page draws
    /// them.
    ///
    /// # Errors
    /// When memory runs out.
    pub fn to_bytes(&self) -> Result<Vec<u8>, TransferError> {
        bincode::serde::encode_to_vec(self, bincode::config::legacy())
            .map_err(|error| TransferError { reason: error.to_string() })
    }

    /// The tile of [`TileGeometry::to_bytes`].
    ///
    /// # Errors
    /// When the bytes are not whole.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, TransferError> {
        let failed = |reason: String| TransferError { reason };
        match bincode::serde::decode_from_slice(bytes, bincode::config::legacy()) {
            Ok((tile, read)) if read == bytes.len() => Ok(tile),
            Ok(_) => Err(failed("there are bytes after it".to_owned())),
            Err(error) => Err(failed(error.to_string())),
        }
    }

    /// The same tile without its roads, lines, areas, slopes and photo: enough for rays and heights.
    #[must_use]
    pub fn without_roads(self) -> Self {
        Self {
            shading: None,
            roads: RoadSegments::default(),
            volumes: RoadVolumes::default(),
            decks: DeckPieces::default(),
            areas: AreaVolumes::default(),
            lines: LineLayers::default(),
            photo: None,
            ..self
        }
    }

    /// The rectangle that it covers in the working CRS.
    #[must_use]
    pub(crate) fn plan_bounds(&self) -> Bounds {
        plan_around(self.reference_m, self.size_m)
    }

    /// True height of the ground at a position in the working CRS; `None` where this tile has no ground.
    #[must_use]
    pub fn ground_height_m(&self, [x, y]: [f64; 2]) -> Option<f64> {
        let at = [x - self.reference_m[0], y - self.reference_m[1]];
        self.ground.triangle_grid.at(at).iter().find_map(|triangle| {
            let [a, b, c] = self.ground.corners(*triangle);
            let weights = barycentric(at, [a[0], a[1]], [b[0], b[1]], [c[0], c[1]]);
            // Positions were rounded to f32. With a slack of a millionth no position falls between two triangles.
            weights.iter().all(|weight| *weight >= -1e-6).then(|| {
                self.reference_m[2] + weights[0] * a[2] + weights[1] * b[2] + weights[2] * c[2]
            })
        })
    }
}

/// The rectangle of a tile in the working CRS: its reference point lies in its middle.
pub(crate) fn plan_around([x, y, _]: [f64; 3], size_m: [f64; 2]) -> Bounds {
    let [east_m, north_m] = size_m.map(|side_m| side_m / 2.0);
    Bounds { min_x: x - east_m, min_y: y - north_m, max_x: x + east_m, max_y: y + north_m }
}
