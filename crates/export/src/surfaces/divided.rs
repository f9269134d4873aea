//! The ground of a tile, divided along the edges of its roads, with the class of each triangle.

use corniche_geom::TileId;
use corniche_roads::FunctionalRoadClass;
use corniche_tileset::{Manifest, Terrain};
use corniche_tin::{Placement, Surface};

use super::{
    cut::{self, Ground},
    ground::GroundMesh,
    lines::{Road, TileLines},
    ribbon::Ribbon,
};
use crate::error::ExportError;

/// A tile's ground, divided along its roads.
pub(crate) struct Divided {
    /// The label of a triangle of a road is the road's place in `roads`, counted from 1.
    pub(crate) mesh: GroundMesh,
    /// The most important first.
    pub(crate) roads: Vec<Road>,
    /// Triangles that were divided.
    pub(crate) package_triangles: u64,
    /// How long it took, seconds.
    pub(crate) cut_s: f64,
}

impl Divided {
    /// Divides the ground of a tile along the roads of `lines`; without them it stays as it is. `None` without ground.
    pub(crate) fn of_tile(
        manifest: &Manifest,
        id: TileId,
        terrain: &Terrain,
        lines: Option<&TileLines<'_>>,
    ) -> Result<Option<Self>, ExportError> {
        let frame = &manifest.frame;
        let placement = Placement::of_tile(frame, id, manifest.vertical.quantum_m);
        let surface = Surface::new(&terrain.tin, placement);
        if surface.triangles().is_empty() {
            return Ok(None);
        }
        let ground = Ground {
            surface: &surface,
            normals: &terrain.normals,
            tile: frame.tile_lattice_bounds(id),
        };
        let roads = lines.map(|lines| lines.around(id)).transpose()?.unwrap_or_default();
        let ribbons: Vec<Ribbon> = roads.iter().map(|road| Ribbon::around(&road.center)).collect();
        let begun = std::time::Instant::now();
        let mesh =
            cut::cut(&ground, &ribbons).map_err(|source| ExportError::Cut { tile: id, source })?;
        let cut_s = begun.elapsed().as_secs_f64();
        let package_triangles = surface.triangles().len() as u64;
        Ok(Some(Self { mesh, roads, package_triangles, cut_s }))
    }

    /// The class of the road that a label names; `None` for ground.
    pub(crate) fn class_of(&self, label: u32) -> Option<FunctionalRoadClass> {
        let road = label.checked_sub(1)?;
        self.roads.get(road as usize).map(|road| road.class)
    }
}
