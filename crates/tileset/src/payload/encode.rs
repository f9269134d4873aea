//! Encodes a tile as a payload: all its sections, with their sizes.

use corniche_geom::{GridFrame, LatticePoint};
use corniche_roads::FunctionalRoadClass;
use corniche_tin::Surface;

use crate::{
    manifest::Manifest,
    payload::{
        attributes,
        builder::{EncodedTile, PayloadBuilder, Section},
        context::CodingContext,
        damage::EncodeError,
        envelope, road_tags, roads_geo, roads_sv,
        section_kind::{GEO, SV, SectionKind, TwoKinds},
        source_grid::SourceGrid,
        terrain,
        tile_payload::TilePayload,
    },
};

/// The grid and the height step to which positions and heights refer; the package's manifest
/// records them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PayloadContext {
    /// The package's grid.
    pub frame: GridFrame,
    /// One step of `height_q` in metres; a power of two.
    pub quantum_m: f64,
    /// Working metres per unit of the package's CRS, east and north; 1, or about 100 000 if the CRS
    /// is in degrees.
    pub metres_per_unit: [f64; 2],
}

impl PayloadContext {
    /// Returns the context of a package.
    #[must_use]
    pub fn from_manifest(manifest: &Manifest) -> Self {
        Self {
            frame: manifest.frame,
            quantum_m: manifest.vertical.quantum_m,
            metres_per_unit: manifest.metres_per_unit,
        }
    }
}

/// Encodes a payload. Empty sections are omitted. Equal payloads result in equal bytes.
///
/// # Errors
/// When the payload contains something that cannot be encoded: unsorted roads, lines off the TIN,
/// points far from the tile, or more than readers accept.
pub fn encode(payload: &TilePayload, context: &PayloadContext) -> Result<EncodedTile, EncodeError> {
    encode_sections(payload, context, None)?.seal()
}

/// Encodes the sections of a payload, to which other sections may be added before it is sealed.
///
/// If the payload's ground was decoded from `earlier`, a payload of the same tile in the same
/// context, its terrain section is copied as it is stored there, which saves the time to compress
/// it. If it was stored by this version, the bytes are those of [`encode`].
///
/// # Errors
/// Same as [`encode`], and when `earlier` is not a payload of the tile or has no ground.
pub fn encode_sections<'a>(
    payload: &TilePayload,
    context: &PayloadContext,
    earlier: Option<&'a [u8]>,
) -> Result<PayloadBuilder<'a>, EncodeError> {
    let tile = payload.id;
    let quantum_m = context.quantum_m;
    let inside = |kind: SectionKind| kind.refused(tile);
    let CodingContext { corner, placement, scale } =
        CodingContext::new(tile, &context.frame, quantum_m).map_err(|_| {
            inside(SectionKind::Terrain)(
                "a tile beyond the package's finest level, or a height quantum of 0",
            )
        })?;

    let mut builder = PayloadBuilder::new(tile);
    let stored = earlier.map(|earlier| {
        let opened = envelope::open(earlier, tile).ok();
        let ground = opened.and_then(|sections| envelope::find(&sections, SectionKind::Terrain));
        ground.ok_or_else(|| inside(SectionKind::Terrain)("an earlier payload without ground"))
    });
    match (&payload.terrain, stored.transpose()?) {
        (Some(_), Some(stored)) => builder.add_stored(SectionKind::Terrain, stored),
        (Some(terrain), None) => {
            let bytes = terrain::encode(terrain, scale).map_err(inside(SectionKind::Terrain))?;
            builder.add(Section { kind: SectionKind::Terrain, bytes })?;
        }
        (None, _) => {}
    }
    if !payload.roads_geo.is_empty() {
        let inside = inside(SectionKind::RoadsGeo);
        let ground = payload.terrain.as_ref().ok_or_else(|| inside("roads without ground"))?;
        let surface = Surface::new(&ground.tin, placement);
        let encode = |grid| roads_geo::encode(&payload.roads_geo, grid, corner, &surface);
        let points = payload.roads_geo.iter().flat_map(|road| roads_geo::points_of(&road.line));
        let (section, class_bytes) = coded_or_raw(GEO, encode, context, points).map_err(inside)?;
        builder.class_bytes[0] = class_bytes;
        builder.add(section)?;
    }
    if !payload.roads_sv.is_empty() {
        let encode = |grid| roads_sv::encode(&payload.roads_sv, grid, corner, quantum_m);
        let points = payload.roads_sv.iter().flat_map(|road| road.line.points.iter().copied());
        let (section, class_bytes) =
            coded_or_raw(SV, encode, context, points).map_err(inside(SectionKind::RoadsSv))?;
        builder.class_bytes[1] = class_bytes;
        builder.add(section)?;
    }
    if !payload.attributes.is_empty() {
        let bytes =
            attributes::encode(&payload.attributes).map_err(inside(SectionKind::Attributes))?;
        builder.add(Section { kind: SectionKind::Attributes, bytes })?;
        if let Some(bytes) = road_tags::encode(&payload.attributes) {
            builder.add(Section { kind: SectionKind::RoadTags, bytes })?;
        }
    }
    if let Some(relief) = &payload.relief {
        builder.add(Section { kind: SectionKind::Relief, bytes: relief.coded().to_vec() })?;
    }
    Ok(builder)
}

/// The bytes of a section before compression, and the number of them for each class; an error
/// describes what cannot be encoded.
type Encoded = Result<(Vec<u8>, [u64; FunctionalRoadClass::COUNT]), &'static str>;

/// Encodes roads as range-coded bits if their points are on OSM's grid and all numbers have codes;
/// else as planes for zstd.
fn coded_or_raw<'f>(
    kinds: TwoKinds,
    encode: impl Fn(Option<SourceGrid<'f>>) -> Encoded,
    context: &'f PayloadContext,
    points: impl Iterator<Item = LatticePoint>,
) -> Result<(Section, [u64; FunctionalRoadClass::COUNT]), &'static str> {
    let grid = SourceGrid::of_osm(&context.frame, context.metres_per_unit, points);
    let (kind, (bytes, class_bytes)) = match grid.map(|grid| encode(Some(grid))) {
        Some(Ok(coded)) => (kinds.coded, coded),
        _ => (kinds.planes, encode(None)?),
    };
    Ok((Section { kind, bytes }, class_bytes))
}
