//! The ground of a tile, divided along the edges of its roads, and the slabs of its bridges, with the class of each triangle.

use corniche_geom::TileId;
use corniche_roads::{FunctionalRoadClass, slab_thickness_m};
use corniche_tileset::{Manifest, Terrain};

use super::{
    cut::{self, Ground},
    ground::GroundMesh,
    lines::{Road, TileLines},
    ribbon::Ribbon,
    slab::{Slab, SlabLabels},
};
use crate::error::SurfaceError;

/// What a triangle is a surface of.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum SurfaceKind {
    Ground,
    /// A road, on the ground or on a bridge.
    Road(FunctionalRoadClass),
    /// The sides, the underside and the ends of a bridge.
    Slab(FunctionalRoadClass),
}

/// A tile's ground, divided along its roads, and the slabs of its bridges.
pub(crate) struct Divided {
    /// What the label of a triangle names is told by [`Divided::kind_of`] and [`Divided::road_of`].
    pub(crate) mesh: GroundMesh,
    /// The most important first.
    roads: Vec<Road>,
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
    ) -> Result<Option<Self>, SurfaceError> {
        let frame = &manifest.frame;
        let surface = manifest.surface(id, &terrain.tin);
        if surface.triangles().is_empty() {
            return Ok(None);
        }
        let ground = Ground {
            surface: &surface,
            normals: &terrain.normals,
            tile: frame.tile_lattice_bounds(id),
        };
        let roads = lines.map(|lines| lines.around(id)).transpose()?.unwrap_or_default();
        // Beneath a slab the ground stays as it is.
        let ribbon = |road: &Road| match road.deck_m {
            Some(_) => Ribbon::default(),
            None => Ribbon::around(&road.center),
        };
        let ribbons: Vec<Ribbon> = roads.iter().map(ribbon).collect();
        let begun = std::time::Instant::now();
        let mut mesh =
            cut::cut(&ground, &ribbons).map_err(|source| SurfaceError::Cut { tile: id, source })?;
        let cut_s = begun.elapsed().as_secs_f64();
        let package_triangles = surface.triangles().len() as u64;
        let steps_per_m = manifest.point_scale / frame.lattice_step_m();
        let all = roads.len() as u32;
        for (label, road) in (1..).zip(&roads) {
            if let Some(deck_m) = &road.deck_m {
                let thickness_m = slab_thickness_m(road.class);
                let slab = Slab { center: &road.center, deck_m, thickness_m, steps_per_m };
                slab.add_to(&mut mesh, SlabLabels { road: label, others: all + label });
            }
        }
        Ok(Some(Self { mesh, roads, package_triangles, cut_s }))
    }

    /// The road that a label names; `None` for ground. Labels are 0 for ground, then there is one for the surface of each road, then one for the rest of its
    /// slab.
    pub(crate) fn road_of(&self, label: u32) -> Option<&Road> {
        let number = label.checked_sub(1)? as usize;
        self.roads.get(number).or_else(|| self.roads.get(number - self.roads.len()))
    }

    /// What the triangles of a label are.
    pub(crate) fn kind_of(&self, label: u32) -> SurfaceKind {
        match self.road_of(label) {
            None => SurfaceKind::Ground,
            Some(road) if label as usize <= self.roads.len() => SurfaceKind::Road(road.class),
            Some(road) => SurfaceKind::Slab(road.class),
        }
    }
}
