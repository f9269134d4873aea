//! A tile is encoded as a payload: all its sections, with their sizes.

use corniche_areas::ClassedLayer;
use corniche_geom::{GridFrame, LatticePoint};
use corniche_roads::FunctionalRoadClass;
use corniche_tin::Surface;

use crate::manifest::Manifest;
use crate::payload::context::Context;
use crate::payload::damage::EncodeError;
use crate::payload::envelope::{Content, SectionSize, StoredSection};
use crate::payload::section_kind::{GEO, Kind, SV, TwoKinds};
use crate::payload::sizes::PayloadSizes;
use crate::payload::source_grid::SourceGrid;
use crate::payload::tile_payload::TilePayload;
use crate::payload::{attributes, envelope, road_tags, roads_geo, roads_sv, terrain};

/// The grid and the height step that give positions and heights their meaning; the package's manifest records them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PayloadContext {
    /// The package's grid.
    pub frame: GridFrame,
    /// One step of `height_q`, metres; a power of two.
    pub quantum_m: f64,
    /// Working metres of one unit of the package's CRS, east and north; 1, or some 100 000 where it is in degrees.
    pub metres_per_unit: [f64; 2],
}

impl PayloadContext {
    /// The context of a package.
    #[must_use]
    pub fn of(manifest: &Manifest) -> Self {
        Self {
            frame: manifest.frame,
            quantum_m: manifest.vertical.quantum_m,
            metres_per_unit: manifest.metres_per_unit,
        }
    }
}

/// A payload as bytes, and the sizes of its parts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EncodedTile {
    /// The payload.
    pub bytes: Vec<u8>,
    /// The sizes of its parts.
    pub sizes: PayloadSizes,
}

/// Writes a payload. Empty sections are left out. Equal payloads make equal bytes.
///
/// # Errors
/// When the payload holds something that cannot be encoded: unsorted roads, lines off the TIN, points far from the tile,
/// or more than a reader accepts.
pub fn encode(payload: &TilePayload, context: &PayloadContext) -> Result<EncodedTile, EncodeError> {
    encode_sections(payload, context, None)
}

/// Does the same as [`encode`] for a payload whose ground was decoded from `earlier`, a payload of the same tile in the same context: its terrain
/// section is taken as it is stored there, which saves the time to compress it. The bytes are those of [`encode`] if it was
/// stored by this version.
///
/// # Errors
/// As [`encode`], and when `earlier` is no payload of the tile or has no ground.
pub fn encode_with_ground_of(
    earlier: &[u8],
    payload: &TilePayload,
    context: &PayloadContext,
) -> Result<EncodedTile, EncodeError> {
    let tile = payload.id;
    let opened = envelope::open(earlier, tile).ok();
    let ground = opened.and_then(|sections| envelope::find(&sections, Kind::Terrain));
    let ground = ground.ok_or(EncodeError::Unencodable {
        tile,
        section: Kind::Terrain.name(),
        what: "an earlier payload without ground",
    })?;
    encode_sections(payload, context, Some(ground))
}

/// `ground` is the terrain section as it was stored before.
fn encode_sections(
    payload: &TilePayload,
    context: &PayloadContext,
    ground: Option<StoredSection<'_>>,
) -> Result<EncodedTile, EncodeError> {
    let tile = payload.id;
    let quantum_m = context.quantum_m;
    let inside =
        |kind: Kind| move |what| EncodeError::Unencodable { tile, section: kind.name(), what };
    let Context { corner, placement, scale } = Context::new(tile, &context.frame, quantum_m)
        .map_err(|_| {
            inside(Kind::Terrain)(
                "a tile beyond the package's finest level or a height quantum of nothing",
            )
        })?;

    let mut sections = Vec::new();
    if let Some(terrain) = &payload.terrain {
        let content = if let Some(stored) = ground {
            Content::Stored(stored)
        } else {
            let coded = terrain::encode(terrain, scale).map_err(inside(Kind::Terrain))?;
            Content::Packed(coded.into())
        };
        sections.push((Kind::Terrain, content));
    }
    let mut geo_class_bytes = [0; FunctionalRoadClass::COUNT];
    if !payload.roads_geo.is_empty() {
        let inside = inside(Kind::RoadsGeo);
        let ground = payload.terrain.as_ref().ok_or_else(|| inside("roads without ground"))?;
        let surface = Surface::new(&ground.tin, placement);
        let encode = |grid| roads_geo::encode(&payload.roads_geo, grid, corner, &surface);
        let points = payload.roads_geo.iter().flat_map(|road| roads_geo::points_of(&road.line));
        let (section, class_bytes) = coded_or_raw(GEO, encode, context, points).map_err(inside)?;
        geo_class_bytes = class_bytes;
        sections.push(section);
    }
    let mut sv_class_bytes = [0; FunctionalRoadClass::COUNT];
    if !payload.roads_sv.is_empty() {
        let encode = |grid| roads_sv::encode(&payload.roads_sv, grid, corner, quantum_m);
        let points = payload.roads_sv.iter().flat_map(|road| road.line.points.iter().copied());
        let (section, class_bytes) =
            coded_or_raw(SV, encode, context, points).map_err(inside(Kind::RoadsSv))?;
        sv_class_bytes = class_bytes;
        sections.push(section);
    }
    if !payload.attributes.is_empty() {
        let bytes = attributes::encode(&payload.attributes).map_err(inside(Kind::Attributes))?;
        sections.push((Kind::Attributes, Content::Raw(bytes)));
        if let Some(bytes) = road_tags::encode(&payload.attributes) {
            sections.push((Kind::RoadTags, Content::Raw(bytes)));
        }
    }

    if let Some(relief) = &payload.relief {
        sections.push((Kind::Relief, Content::Raw(relief.coded().to_vec())));
    }

    let (bytes, sealed) = envelope::seal(tile, &sections)?;
    let size = |kind: Kind| {
        sections
            .iter()
            .zip(&sealed)
            .find(|((of, _), _)| *of == kind)
            .map_or_else(SectionSize::default, |(_, size)| *size)
    };
    let roads_sv = size(Kind::RoadsSv).or(size(Kind::CodedSv));
    let sizes = PayloadSizes {
        terrain: size(Kind::Terrain),
        roads_geo: size(Kind::RoadsGeo).or(size(Kind::CodedGeo)),
        roads_sv,
        sv_tail: roads_sv.stored,
        attributes: size(Kind::Attributes),
        road_tags: size(Kind::RoadTags),
        relief: size(Kind::Relief),
        photo: SectionSize::default(),
        areas: SectionSize::default(),
        lines: [SectionSize::default(); ClassedLayer::ALL.len()],
        spans: SectionSize::default(),
        geo_class_bytes,
        sv_class_bytes,
    };
    Ok(EncodedTile { bytes, sizes })
}

/// A section's bytes before compression, and how many of them each class takes; or what cannot be encoded.
type Encoded = Result<(Vec<u8>, [u64; FunctionalRoadClass::COUNT]), &'static str>;

/// A section of roads as range-coded bits, if its points lie on OSM's grid and all its numbers have codes; else as planes for zstd.
fn coded_or_raw<'f>(
    kinds: TwoKinds,
    encode: impl Fn(Option<SourceGrid<'f>>) -> Encoded,
    context: &'f PayloadContext,
    points: impl Iterator<Item = LatticePoint>,
) -> Result<((Kind, Content<'static>), [u64; FunctionalRoadClass::COUNT]), &'static str> {
    let grid = SourceGrid::of_osm(&context.frame, context.metres_per_unit, points);
    if let Some(Ok((bytes, class_bytes))) = grid.map(|grid| encode(Some(grid))) {
        return Ok(((kinds.coded, Content::Packed(bytes.into())), class_bytes));
    }
    encode(None).map(|(bytes, class_bytes)| ((kinds.planes, Content::Raw(bytes)), class_bytes))
}
