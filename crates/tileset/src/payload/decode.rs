//! Decodes the sections of a payload that the caller wants.

use corniche_geom::{GridFrame, TileId};
use corniche_tin::Surface;

use crate::payload::{
    attributes,
    context::CodingContext,
    damage::{Damage, DecodeError, Result},
    envelope::{self, StoredSection},
    relief::Relief,
    road_tags, roads_geo, roads_sv,
    section_kind::{GEO, SV, SectionKind, Sections, TwoKinds},
    spans, terrain,
    tile_payload::{GeoRoad, TilePayload, TileTerrain},
};

/// Decodes the wanted sections of a payload; sections that are absent or not wanted are empty or
/// `None`.
///
/// `frame` and `quantum_m` are those of the package's manifest. Memory and work stay within the
/// [`limits`](crate::limits), whatever the bytes say. Sections that are not wanted are not
/// inspected, so damage in them is not detected; [`Sections::ALL`] also checks sections that this
/// version cannot decode. If SV roads are not wanted, `bytes` may be the shortened payload that
/// [`Package::tile_for`](crate::Package::tile_for) reads.
///
/// # Errors
/// When the bytes are not a payload of tile `id`, or a wanted section is damaged; the error names
/// both.
pub fn decode(
    bytes: &[u8],
    id: TileId,
    frame: &GridFrame,
    quantum_m: f64,
    wanted: Sections,
) -> Result<TilePayload, DecodeError> {
    let (context, sections) = CodingContext::open(bytes, id, frame, quantum_m)?;
    if wanted == Sections::ALL {
        let part = "section of an unknown kind".into();
        let checked = envelope::check_unknown(&sections);
        checked.map_err(|damage| DecodeError { tile: id, part, damage })?;
    }
    let reader = SectionReader { sections: &sections, wanted, tile: id };
    let roads_geo = reader.roads(GEO, Sections::ROADS_GEO)?;
    let spans = reader.read(SectionKind::Spans, Sections::SPANS, Ok)?;
    let needs_terrain =
        wanted.contains(Sections::TERRAIN) || roads_geo.is_some() || spans.is_some();
    let ground = if needs_terrain {
        // The terrain is decoded even if it is only needed for another section.
        let decode = |bytes: Vec<u8>| terrain::decode(&bytes, context.scale);
        reader.read(SectionKind::Terrain, Sections::NONE, decode)?
    } else {
        None
    };
    if let Some(bytes) = spans {
        let damaged = SectionKind::Spans.damaged(id);
        let ground = ground.as_ref().ok_or(spans::WITHOUT_GROUND).map_err(damaged)?;
        let triangles = ground.tin.triangles().len();
        spans::decode(&bytes, context.corner, triangles).map_err(damaged)?;
    }
    let relief =
        reader.read(SectionKind::Relief, Sections::RELIEF, |bytes| Relief::decode(&bytes))?;
    let roads_geo = roads_geo
        .map(|(bytes, is_coded)| {
            decode_geo(&bytes, is_coded.then_some(frame), ground.as_ref(), &context)
        })
        .transpose()
        .map_err(SectionKind::RoadsGeo.damaged(id))?;
    let roads_sv = reader
        .roads(SV, Sections::ROADS_SV)?
        .map(|(bytes, is_coded)| {
            roads_sv::decode(&bytes, is_coded.then_some(frame), context.corner, quantum_m)
        })
        .transpose()
        .map_err(SectionKind::RoadsSv.damaged(id))?;
    let records = reader
        .read(SectionKind::Attributes, Sections::ATTRIBUTES, |bytes| attributes::decode(&bytes))?;
    let mut records = records.unwrap_or_default();
    reader.read(SectionKind::RoadTags, Sections::ATTRIBUTES, |bytes| {
        road_tags::decode(&bytes, &mut records)
    })?;
    // The image itself is only decoded on request.
    reader.read(SectionKind::Photo, Sections::PHOTO, Ok)?;
    // Objects of layers are only decoded with the tables of the layers.
    for kind in sections.iter().filter_map(StoredSection::known_kind) {
        if let SectionKind::Layer(_) = kind {
            reader.read(kind, Sections::LAYERS, Ok)?;
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

/// Reads the wanted sections, and names the damaged section in errors.
struct SectionReader<'a> {
    sections: &'a [StoredSection<'a>],
    wanted: Sections,
    tile: TileId,
}

impl SectionReader<'_> {
    /// Returns a section decoded by `decode`; `None` if it is absent or not wanted.
    fn read<T>(
        &self,
        kind: SectionKind,
        section: Sections,
        decode: impl FnOnce(Vec<u8>) -> Result<T>,
    ) -> Result<Option<T>, DecodeError> {
        if !self.wanted.contains(section) {
            return Ok(None);
        }
        let found = envelope::section(self.sections, kind);
        let read = found.and_then(|bytes| bytes.map(decode).transpose());
        read.map_err(kind.damaged(self.tile))
    }

    /// Returns the bytes of the roads of one method, and whether they are range-coded bits.
    fn roads(
        &self,
        roads: TwoKinds,
        section: Sections,
    ) -> Result<Option<(Vec<u8>, bool)>, DecodeError> {
        if !self.wanted.contains(section) {
            return Ok(None);
        }
        let found = envelope::section_of_two(self.sections, roads);
        found.map_err(roads.planes.damaged(self.tile))
    }
}

/// Decodes the GEO roads, which need the ground beneath them.
fn decode_geo(
    bytes: &[u8],
    coded_in: Option<&GridFrame>,
    ground: Option<&TileTerrain>,
    context: &CodingContext,
) -> Result<Vec<GeoRoad>> {
    let Some(ground) = ground else {
        return Err(Damage::Invalid("roads in a tile without ground"));
    };
    let surface = Surface::new(&ground.tin, context.placement);
    roads_geo::decode(bytes, coded_in, context.corner, &surface)
}
