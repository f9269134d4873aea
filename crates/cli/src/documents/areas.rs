//! Areas in the JSON documents of several commands.

use corniche_areas::AreaClass;
use corniche_geom::LatticePoint;
use corniche_tileset::{AreaLevelRecord, AreaRecord, AreasRecord};
use serde::Serialize;

#[cfg(test)]
use crate::documents::record_schemas::AreaLevelDocument;

/// The areas of a package.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct AreasDocument {
    /// Objects of the extract with the tags of an area: those kept and those lost.
    objects: u64,
    /// Those that became areas, by class, wherever they lie.
    kept: Vec<AreaClassDocument>,
    /// Those that became none, by reason.
    lost: Vec<AreaLossDocument>,
    /// For each level that has some, root first.
    #[cfg_attr(test, schemars(with = "Vec<AreaLevelDocument>"))]
    levels: Vec<AreaLevelRecord>,
}

/// Areas of one class.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct AreaClassDocument {
    /// The class: "water", "forest" and so on.
    class: &'static str,
    /// How many.
    areas: u64,
    /// Their true area, square kilometres; where areas overlap, each counts.
    area_km2: f64,
}

/// Objects that became no areas for one reason.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct AreaLossDocument {
    /// Why.
    reason: String,
    /// How many.
    objects: u64,
}

/// The part of an area that lies in a tile.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct TileAreaDocument {
    /// What it was in OSM: "way" or "relation".
    object: &'static str,
    /// OSM's id of it.
    id: i64,
    /// The class: "water", "forest" and so on.
    class: &'static str,
    /// `name`; null without.
    name: Option<String>,
    /// Polygons of rings of positions, x and y: the outer ring counter-clockwise in working metres, then holes, clockwise. The first
    /// position is not repeated.
    polygons: Vec<Vec<Vec<[f64; 2]>>>,
}

impl TileAreaDocument {
    /// `place` makes coordinates from points of the lattice.
    pub(crate) fn of(area: AreaRecord, place: &impl Fn(LatticePoint) -> [f64; 2]) -> Self {
        let (object, id) = area.object.parts();
        let ring = |ring: Vec<_>| ring.into_iter().map(place).collect();
        let polygons = area.polygons.into_iter();
        Self {
            object,
            id,
            class: area.class.name(),
            name: (!area.name.is_empty()).then_some(area.name),
            polygons: polygons
                .map(|polygon| polygon.rings.into_iter().map(ring).collect())
                .collect(),
        }
    }
}

impl From<AreasRecord> for AreasDocument {
    fn from(AreasRecord { counts, levels }: AreasRecord) -> Self {
        let class = |kept: corniche_tileset::AreaClassRecord| AreaClassDocument {
            class: AreaClass::from_number(kept.class).map_or("", AreaClass::name),
            areas: kept.areas,
            area_km2: kept.area_km2,
        };
        Self {
            objects: counts.objects,
            kept: counts.kept.into_iter().map(class).collect(),
            lost: counts
                .lost
                .into_iter()
                .map(|(reason, objects)| AreaLossDocument { reason, objects })
                .collect(),
            levels,
        }
    }
}
