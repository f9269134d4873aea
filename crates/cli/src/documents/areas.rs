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
    /// Number of objects in the extract with the tags of an area, converted or not.
    objects: u64,
    /// Number of converted areas per class, also outside the package's extent.
    kept: Vec<AreaClassDocument>,
    /// Number of objects that became no areas, by reason.
    lost: Vec<AreaLossDocument>,
    /// Areas of each level that has some, root first.
    #[cfg_attr(test, schemars(with = "Vec<AreaLevelDocument>"))]
    levels: Vec<AreaLevelRecord>,
}

/// The areas of one class.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct AreaClassDocument {
    /// The class: "water", "forest" and so on.
    class: &'static str,
    /// Number of areas.
    areas: u64,
    /// True area, square kilometres; overlapping areas are all counted in full.
    area_km2: f64,
}

/// The objects that became no areas for one reason.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct AreaLossDocument {
    /// The reason.
    reason: String,
    /// Number of objects.
    objects: u64,
}

/// The part of an area in a tile.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct TileAreaDocument {
    /// The type of the OSM object: "way" or "relation".
    object: &'static str,
    /// OSM id of the object.
    id: i64,
    /// The class: "water", "forest" and so on.
    class: &'static str,
    /// OSM's `name`; null if untagged.
    name: Option<String>,
    /// Polygons of rings of positions, x and y: first the outer ring, counter-clockwise in working
    /// metres, then holes, clockwise. The first position is not repeated.
    polygons: Vec<Vec<Vec<[f64; 2]>>>,
}

impl TileAreaDocument {
    /// Converts a record; `place` converts lattice points to coordinates.
    pub(crate) fn from_record(area: AreaRecord, place: &impl Fn(LatticePoint) -> [f64; 2]) -> Self {
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
