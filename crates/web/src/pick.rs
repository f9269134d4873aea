//! Which road is at a place.

use std::collections::BTreeMap;

use corniche_geom::{LatticePoint, TileId};
use corniche_roads::{FunctionalRoadClass, RoadAttributes};
use corniche_tileset::{Manifest, Sections, decode};
use corniche_viewer::tiles::{LoadTileError, MapPackage as _};

use crate::{loader::Tileset, report::PickedRoad};

/// The road that lies nearest to a place in plan, if it is no farther away than `reach_m`, working metres, beside half its width. `tile` is the tile
/// that is drawn there, `half_width_m` that of a road by its class and attributes, and classes that are hidden do not count.
///
/// # Errors
/// When the tile's roads cannot be read or are damaged.
pub(crate) async fn road_at(
    tiles: &Tileset,
    tile: TileId,
    at_m: [f64; 2],
    reach_m: f64,
    half_width_m: &dyn Fn(FunctionalRoadClass, &RoadAttributes) -> Option<f64>,
    labels: &[String],
) -> Result<Option<PickedRoad>, LoadTileError> {
    let manifest = tiles.package.manifest();
    let Manifest { frame, vertical, .. } = manifest;
    let wanted = Sections::ROADS_SV | Sections::ATTRIBUTES;
    let Some(bytes) = tiles.package.payload_for(tile, wanted).await? else { return Ok(None) };
    let payload = decode(&bytes, tile, frame, vertical.quantum_m, wanted)
        .map_err(|error| LoadTileError { id: tile, source: error.into() })?;
    let position = |point: &LatticePoint| frame.position_m(*point);
    let record_of = |way_id: i64| {
        let found = payload.attributes.binary_search_by_key(&way_id, |record| record.way_id);
        found.ok().map(|at| &payload.attributes[at])
    };
    let unknown = RoadAttributes::default();
    let nearest = payload
        .roads_sv
        .iter()
        .filter_map(|road| {
            let pairs = road.line.points.windows(2);
            let distance_m = pairs
                .map(|pair| distance_m(at_m, position(&pair[0]), position(&pair[1])))
                .fold(f64::INFINITY, f64::min);
            let attributes = record_of(road.way_id).map_or(&unknown, |record| &record.attributes);
            let half_m = half_width_m(road.class, attributes)?;
            let beside_m = (distance_m - half_m).max(0.0);
            (beside_m <= reach_m).then_some((beside_m, road))
        })
        .min_by(|(a, one), (b, other)| a.total_cmp(b).then(one.class.cmp(&other.class)));
    let Some((_, road)) = nearest else { return Ok(None) };
    let record = record_of(road.way_id);
    let class = road.class.number();
    Ok(Some(PickedRoad {
        way: road.way_id,
        class,
        label: labels.get(usize::from(class)).cloned().unwrap_or_default(),
        attributes: record.map(|record| texts(&record.attributes)).unwrap_or_default(),
    }))
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

/// What is known of a road, under OSM's keys.
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
