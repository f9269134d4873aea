//! A payload is decoded: the sections that the caller wants.

use corniche_areas::ClassedLayer;
use corniche_geom::{GridFrame, TileId};
use corniche_tin::Surface;

use crate::payload::context::Context;
use crate::payload::damage::{Damage, DecodeError};
use crate::payload::relief::Relief;
use crate::payload::section_kind::{GEO, Kind, SV, Sections, TwoKinds};
use crate::payload::tile_payload::{GeoRoad, Terrain, TilePayload};
use crate::payload::{
    areas, attributes, envelope, lines, road_tags, roads_geo, roads_sv, spans, terrain,
};

/// Reads the wanted sections of a payload; sections that are absent or not wanted are empty or `None`.
///
/// `frame` and `quantum_m` are those of the package's manifest. Memory and work are bounded by the
/// [`limits`](crate::limits), whatever the bytes say. Sections that are not wanted are not looked into, so damage in
/// them goes unnoticed; [`Sections::ALL`] also checks those that this version cannot decode. Without SV roads, `bytes` may be what
/// [`Package::tile_for`](crate::Package::tile_for) reads.
///
/// # Errors
/// When the bytes are not a payload of tile `id`, or a wanted section is damaged; the error names both.
pub fn decode(
    bytes: &[u8],
    id: TileId,
    frame: &GridFrame,
    quantum_m: f64,
    wanted: Sections,
) -> Result<TilePayload, DecodeError> {
    let (context, sections) = Context::open(bytes, id, frame, quantum_m)?;
    let failed = |part| move |damage| DecodeError { tile: id, part, damage };
    if wanted == Sections::ALL {
        envelope::check_unknown(&sections).map_err(failed("section of an unknown kind"))?;
    }
    let inside = |kind: Kind| failed(kind.name());
    let read = |kind: Kind, section: Sections| {
        if !wanted.contains(section) {
            return Ok(None);
        }
        envelope::section(&sections, kind).map_err(inside(kind))
    };
    let read_roads = |roads: TwoKinds, section: Sections| {
        if !wanted.contains(section) {
            return Ok(None);
        }
        let found = envelope::section_of_two(&sections, roads).map_err(inside(roads.planes))?;
        Ok(found.map(|(bytes, is_coded)| (bytes, is_coded.then_some(frame))))
    };
    let roads_geo = read_roads(GEO, Sections::ROADS_GEO)?;
    let spans = read(Kind::Spans, Sections::SPANS)?;
    let needs_terrain =
        wanted.contains(Sections::TERRAIN) || roads_geo.is_some() || spans.is_some();
    let ground = if needs_terrain {
        let bytes = envelope::section(&sections, Kind::Terrain).map_err(inside(Kind::Terrain))?;
        bytes
            .map(|bytes| terrain::decode(&bytes, context.scale))
            .transpose()
            .map_err(inside(Kind::Terrain))?
    } else {
        None
    };
    if let Some(bytes) = spans {
        let ground = ground.as_ref().ok_or(spans::WITHOUT_GROUND).map_err(inside(Kind::Spans))?;
        let triangles = ground.tin.triangles().len();
        spans::decode(&bytes, context.corner, triangles).map_err(inside(Kind::Spans))?;
    }
    let relief = read(Kind::Relief, Sections::RELIEF)?
        .map(|bytes| Relief::decode(&bytes))
        .transpose()
        .map_err(inside(Kind::Relief))?;
    let roads_geo = roads_geo
        .map(|(bytes, coded_in)| decode_geo(&bytes, coded_in, ground.as_ref(), &context))
        .transpose()
        .map_err(inside(Kind::RoadsGeo))?;
    let roads_sv = read_roads(SV, Sections::ROADS_SV)?
        .map(|(bytes, coded_in)| roads_sv::decode(&bytes, coded_in, context.corner, quantum_m))
        .transpose()
        .map_err(inside(Kind::RoadsSv))?;
    let mut records = read(Kind::Attributes, Sections::ATTRIBUTES)?
        .map(|bytes| attributes::decode(&bytes))
        .transpose()
        .map_err(inside(Kind::Attributes))?
        .unwrap_or_default();
    if let Some(bytes) = read(Kind::RoadTags, Sections::ATTRIBUTES)? {
        road_tags::decode(&bytes, &mut records).map_err(inside(Kind::RoadTags))?;
    }
    // The picture itself is decoded for those who ask for it.
    let _checked = read(Kind::Photo, Sections::PHOTO)?;
    if wanted.contains(Sections::AREAS) {
        areas::decode_in(&sections, frame.tile_lattice_bounds(id)).map_err(inside(Kind::Areas))?;
    }
    for layer in ClassedLayer::ALL {
        if wanted.contains(Sections::lines(layer)) {
            lines::decode_in(&sections, layer).map_err(inside(Kind::of_lines(layer)))?;
        }
    }
    Ok(TilePayload {
        id,
        terrain: ground,
        relief,
        roads_geo: roads_geo.unwrap_or_default(),
        roads_sv: roads_sv.unwrap_or_default(),
        attributes: records,
    })
}

/// Decodes the GEO roads, which need the ground that they lie on.
fn decode_geo(
    bytes: &[u8],
    coded_in: Option<&GridFrame>,
    ground: Option<&Terrain>,
    context: &Context,
) -> Result<Vec<GeoRoad>, Damage> {
    let Some(ground) = ground else {
        return Err(Damage::Invalid("roads without the ground they lie on"));
    };
    let surface = Surface::new(&ground.tin, context.placement);
    roads_geo::decode(bytes, coded_in, context.corner, &surface)
}
