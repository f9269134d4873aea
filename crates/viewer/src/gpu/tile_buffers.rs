use corniche_geom::TileId;

use super::{
    Gpu,
    drawables::{geo_roads, sv_roads},
    ground_buffers::GroundBuffers,
    road_instances::RoadBuffers,
    uniforms::TileUniforms,
};
use crate::{
    options::{RoadMethod, RoadOptions},
    scene::BorderTile,
    tiles::TileGeometry,
};

/// A tile on the graphics card.
pub struct TileBuffers {
    id: TileId,
    pub(crate) reference_m: [f64; 3],
    size_m: [f64; 2],
    /// `None` without ground.
    pub(crate) ground: Option<GroundBuffers>,
    segments: RoadBuffers,
    volumes: RoadBuffers,
    width_margin_m: f64,
    triangles: u64,
}

/// A tile to draw in this frame.
pub struct DrawTile<'a> {
    /// The tile.
    pub buffers: &'a TileBuffers,
    /// How far its skirt hangs down, true metres.
    pub skirt_depth_m: f64,
}

/// Bytes that a tile will take on the graphics card, known before it is uploaded. Its wireframe is not counted: it is made
/// when it is first shown.
#[must_use]
pub fn tile_bytes(tile: &TileGeometry) -> u64 {
    GroundBuffers::bytes_of(&tile.ground, tile.photo.as_ref())
        + geo_roads::bytes_of(&tile.roads)
        + sv_roads::bytes_of(&tile.volumes)
}

impl TileBuffers {
    /// Uploads a tile.
    #[must_use]
    pub fn new(gpu: &Gpu, tile: &TileGeometry) -> Self {
        Self {
            id: tile.id,
            reference_m: tile.reference_m,
            size_m: tile.size_m,
            ground: GroundBuffers::new(gpu, &tile.ground, tile.photo.as_ref()),
            segments: geo_roads::upload(gpu, &tile.roads),
            volumes: sv_roads::upload(gpu, &tile.volumes),
            width_margin_m: tile.width_margin_m,
            triangles: (tile.ground.surface_indices / 3) as u64,
        }
    }

    /// Triangles of its ground, without those of its skirts.
    #[must_use]
    pub fn triangles(&self) -> u64 {
        self.triangles
    }

    /// How many segments or volumes of its roads are drawn with these options.
    #[must_use]
    pub fn road_segments(&self, roads: RoadOptions) -> u64 {
        let drawn =
            self.roads(roads.method).into_iter().flat_map(|drawn| drawn.runs(roads.classes));
        drawn.map(|range| u64::from(range.end - range.start)).sum()
    }

    /// Bytes of its buffers on the graphics card; its wireframe counts once it has been shown.
    #[must_use]
    pub fn gpu_bytes(&self) -> u64 {
        let ground_bytes = self.ground.as_ref().map_or(0, GroundBuffers::gpu_bytes);
        ground_bytes + self.segments.gpu_bytes() + self.volumes.gpu_bytes()
    }

    /// Its roads as a method draws them.
    pub(crate) fn roads(&self, method: RoadMethod) -> Option<&RoadBuffers> {
        match method {
            RoadMethod::Geometry => Some(&self.segments),
            RoadMethod::ShadowVolumes => Some(&self.volumes),
            RoadMethod::None => None,
        }
    }
}

impl DrawTile<'_> {
    /// Where the roads that a method draws meet its border.
    pub(crate) fn border(&self, method: RoadMethod) -> BorderTile<'_> {
        let TileBuffers { id, size_m: [east_m, north_m], .. } = *self.buffers;
        BorderTile {
            id,
            side_m: east_m.min(north_m),
            skirt_depth_m: self.skirt_depth_m,
            ends: self.buffers.roads(method).map_or(&[], |roads| &roads.ends),
        }
    }

    /// What shaders are told of it.
    pub(crate) fn uniforms(&self) -> TileUniforms {
        let TileBuffers { reference_m, size_m, width_margin_m, .. } = *self.buffers;
        TileUniforms { reference_m, size_m, width_margin_m, skirt_depth_m: self.skirt_depth_m }
    }
}
