//! Finds the road at a place.

use std::collections::BTreeMap;

use corniche_geom::{LatticePoint, TileId};
use corniche_roads::{FunctionalRoadClass, RoadAttributes};
use corniche_styles::Style;
use corniche_tileset::{Manifest, Sections, decode};
use corniche_viewer::{ClassSet, tiles::LoadTileError};
use serde_json::{Value, json};

use crate::ground_probe::GroundPoint;

/// A place on the ground where a road is searched.
pub struct PickPlace {
    /// The place.
    pub point: GroundPoint,
    /// The tile that is drawn there.
    pub tile: Option<TileId>,
    /// The largest distance of a road beyond half its width, in working metres.
    pub(crate) reach_m: f64,
    /// The style of the map.
    pub(crate) style: Style,
    /// The shown classes; roads of other classes are ignored.
    pub(crate) classes: ClassSet,
}

/// A road that was picked.
#[derive(Debug, Clone, PartialEq)]
pub struct PickedRoad {
    /// The OSM id of the way.
    pub way_id: i64,
    /// Its class.
    pub class: FunctionalRoadClass,
    /// The known attributes, under OSM's keys.
    pub attributes: BTreeMap<&'static str, String>,
}

impl PickPlace {
    /// The sections of the tile that must be read.
    pub const SECTIONS: Sections = Sections::ROADS_SV.and(Sections::ATTRIBUTES);

    /// The nearest road of a tile's payload.
    ///
    /// # Errors
    /// When the tile's roads are corrupt.
    pub fn road_in(
        &self,
        payload: &[u8],
        tile: TileId,
        manifest: &Manifest,
    ) -> Result<Option<PickedRoad>, LoadTileError> {
        let Manifest { frame, vertical, .. } = manifest;
        let payload = decode(payload, tile, frame, vertical.quantum_m, Self::SECTIONS)
            .map_err(LoadTileError::for_tile(tile))?;
        let [x, y, _] = self.point.at_m;
        let position = |point: &LatticePoint| frame.position_m(*point);
        let record_of = |way_id: i64| {
            let found = payload.attributes.binary_search_by_key(&way_id, |record| record.way_id);
            found.ok().map(|at| &payload.attributes[at])
        };
        let unknown = RoadAttributes::default();
        let nearest = payload
            .roads_sv
            .iter()
            .filter(|road| self.classes.contains(road.class))
            .filter_map(|road| {
                let pairs = road.line.points.windows(2);
                let distance_m = pairs
                    .map(|pair| distance_m([x, y], position(&pair[0]), position(&pair[1])))
                    .fold(f64::INFINITY, f64::min);
                let attributes =
                    record_of(road.way_id).map_or(&unknown, |record| &record.attributes);
                let width_m = f64::from(self.style.width_of_m(road.class, attributes));
                let beside_m = (distance_m - width_m * manifest.point_scale / 2.0).max(0.0);
                (beside_m <= self.reach_m).then_some((beside_m, road))
            })
            .min_by(|(a, one), (b, other)| a.total_cmp(b).then(one.class.cmp(&other.class)));
        let Some((_, road)) = nearest else { return Ok(None) };
        let record = record_of(road.way_id);
        let attributes = record.map(|record| texts(&record.attributes)).unwrap_or_default();
        Ok(Some(PickedRoad { way_id: road.way_id, class: road.class, attributes }))
    }
}

impl PickPlace {
    /// The picked road as JSON for a page; `labels` are the names of the classes.
    #[must_use]
    pub fn record(&self, road: Option<PickedRoad>, labels: &[String]) -> Value {
        let road = road.map(|PickedRoad { way_id, class, attributes }| {
            let class = class.number();
            let label = labels.get(usize::from(class)).map_or("", String::as_str);
            json!({ "way": way_id, "class": class, "label": label, "attributes": attributes })
        });
        let mut record = self.point.record();
        record["road"] = json!(road);
        record
    }
}

/// Distance of a point from a segment.
fn distance_m([x, y]: [f64; 2], [x0, y0]: [f64; 2], [x1, y1]: [f64; 2]) -> f64 {
    let (dx, dy) = (x1 - x0, y1 - y0);
    let squared = dx * dx + dy * dy;
    let share = if squared > 0.0 {
        (((x - x0) * dx + (y - y0) * dy) / squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (x - x0 - share * dx).hypot(y - y0 - share * dy)
}

/// The known attributes of a road, under OSM's keys.
fn texts(road: &RoadAttributes) -> BTreeMap<&'static str, String> {
    let number = |value: Option<u8>| value.map(|value| value.to_string()).unwrap_or_default();
    let all = [
        ("name", road.name.clone()),
        ("ref", road.reference.clone()),
        ("highway", road.highway.clone()),
        ("surface", road.surface.clone()),
        ("lanes", number(road.lanes.map(std::num::NonZeroU8::get))),
        ("width", road.width_m().map(|width_m| format!("{width_m}")).unwrap_or_default()),
        ("maxspeed", road.max_speed.clone()),
        ("sac_scale", road.sac_scale.clone()),
        ("tracktype", road.tracktype.clone()),
    ];
    all.into_iter().filter(|(_, text)| !text.is_empty()).collect()
}
