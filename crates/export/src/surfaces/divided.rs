//! The ground of a tile, divided along the edges of its roads, and the slabs of its bridges, with
//! the class of each triangle.

use corniche_geom::TileId;
use corniche_roads::{FunctionalRoadClass, slab_thickness_m};
use corniche_tileset::{FilePackage, Sections, TilePayload};

use super::{
    cut::{self, UncutGround},
    ground::LabelledMesh,
    lines::{SurfaceLines, SurfaceRoad},
    ribbon::Ribbon,
    slab::{Slab, SlabLabels},
};
use crate::{error::SurfaceError, gltf::SLAB_NAME};

/// The kind of surface to which a triangle belongs.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum SurfaceKind {
    Ground,
    /// A road, on the ground or on a bridge.
    Road(FunctionalRoadClass),
    /// The sides, the underside and the ends of a bridge.
    Slab(FunctionalRoadClass),
}

impl SurfaceKind {
    /// The class of the road.
    pub(crate) fn class(self) -> Option<FunctionalRoadClass> {
        match self {
            Self::Ground => None,
            Self::Road(class) | Self::Slab(class) => Some(class),
        }
    }

    /// The name of its material. Slabs of all classes share one.
    pub(crate) fn name(self) -> String {
        match self {
            Self::Ground => "terrain".to_owned(),
            Self::Road(class) => format!("roads FRC {}", class.number()),
            Self::Slab(_) => SLAB_NAME.to_owned(),
        }
    }
}

/// A tile's ground, divided along its roads, and the slabs of its bridges.
pub(crate) struct Divided {
    /// The mesh; [`Divided::kind_of`] and [`Divided::road_of`] return the meaning of a triangle's
    /// label.
    pub(crate) mesh: LabelledMesh,
    /// The roads, the most important first.
    roads: Vec<SurfaceRoad>,
    /// Triangles that were divided.
    pub(crate) package_triangles: u64,
    /// The duration of the cut, seconds.
    pub(crate) cut_s: f64,
}

impl Divided {
    /// Reads the `wanted` sections of a tile, and divides its ground along the roads of `lines`;
    /// without them the ground is unchanged. Returns `None` without ground.
    pub(crate) fn of_tile(
        package: &FilePackage,
        id: TileId,
        wanted: Sections,
        lines: Option<&SurfaceLines<'_>>,
    ) -> Result<Option<(TilePayload, Self)>, SurfaceError> {
        let Some(payload) = package.payload(id, wanted)? else { return Ok(None) };
        let Some(terrain) = &payload.terrain else { return Ok(None) };
        let manifest = package.manifest();
        let frame = &manifest.frame;
        let surface = manifest.surface(id, &terrain.tin);
        if surface.triangles().is_empty() {
            return Ok(None);
        }
        let ground = UncutGround {
            surface: &surface,
            normals: &terrain.normals,
            tile: frame.tile_lattice_bounds(id),
        };
        let roads = lines.map(|lines| lines.around(id)).transpose()?.unwrap_or_default();
        // The ground beneath a slab is unchanged.
        let ribbon = |road: &SurfaceRoad| match road.deck_m {
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
                let thickness_m = slab_thickness_m(road.way.class);
                let slab = Slab { center: &road.center, deck_m, thickness_m, steps_per_m };
                slab.add_to(&mut mesh, SlabLabels { road: label, others: all + label });
            }
        }
        Ok(Some((payload, Self { mesh, roads, package_triangles, cut_s })))
    }

    /// Returns the road that a label refers to; `None` for ground. Label 0 is ground; then there is
    /// one label for the surface of each road, then one for the rest of its slab.
    pub(crate) fn road_of(&self, label: u32) -> Option<&SurfaceRoad> {
        let number = label.checked_sub(1)? as usize;
        self.roads.get(number).or_else(|| self.roads.get(number - self.roads.len()))
    }

    /// Returns the kind of surface of a label's triangles.
    pub(crate) fn kind_of(&self, label: u32) -> SurfaceKind {
        match self.road_of(label) {
            None => SurfaceKind::Ground,
            Some(road) if label as usize <= self.roads.len() => SurfaceKind::Road(road.way.class),
            Some(road) => SurfaceKind::Slab(road.way.class),
        }
    }
}
