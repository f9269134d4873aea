//! How large the parts of a payload are, without decoding what they say.

use corniche_areas::ClassedLayer;
use corniche_geom::TileId;
use corniche_roads::FunctionalRoadClass;

use crate::payload::damage::{Damage, DecodeError};
use crate::payload::envelope::SectionSize;
use crate::payload::number_codes::Cursor;
use crate::payload::section_kind::{AREAS, GEO, Kind, SV, TwoKinds};
use crate::payload::source_grid::GRID_BYTES;
use crate::payload::{class_table, envelope};

/// Sizes of the sections of a payload, and of the classes in its road sections.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PayloadSizes {
    /// The terrain section; 0 where absent, as all that follow.
    pub terrain: SectionSize,
    /// The GEO roads section.
    pub roads_geo: SectionSize,
    /// The SV roads section.
    pub roads_sv: SectionSize,
    /// Bytes of the SV roads that the payload ends with; 0 where another section is the last, as in packages of before.
    pub sv_tail: u64,
    /// The road attributes section.
    pub attributes: SectionSize,
    /// The road tags section.
    pub road_tags: SectionSize,
    /// The relief section.
    pub relief: SectionSize,
    /// The photo section.
    pub photo: SectionSize,
    /// The areas section.
    pub areas: SectionSize,
    /// The section of each layer of lines, in order of [`ClassedLayer::ALL`].
    pub lines: [SectionSize; ClassedLayer::ALL.len()],
    /// The spans section.
    pub spans: SectionSize,
    /// Bytes of each class in the GEO section before compression: they determine the class's share of the stored bytes.
    pub geo_class_bytes: [u64; FunctionalRoadClass::COUNT],
    /// The same for the SV section.
    pub sv_class_bytes: [u64; FunctionalRoadClass::COUNT],
}

impl PayloadSizes {
    /// The sizes of sections of which `size` knows the kinds that are there, with the bytes of the classes of GEO and SV roads.
    pub(crate) fn of(
        size: impl Fn(Kind) -> SectionSize,
        sv_tail: u64,
        [geo_class_bytes, sv_class_bytes]: [[u64; FunctionalRoadClass::COUNT]; 2],
    ) -> Self {
        let either = |kinds: TwoKinds| size(kinds.planes).or(size(kinds.coded));
        Self {
            terrain: size(Kind::Terrain),
            roads_geo: either(GEO),
            roads_sv: either(SV),
            sv_tail,
            attributes: size(Kind::Attributes),
            road_tags: size(Kind::RoadTags),
            relief: size(Kind::Relief),
            photo: size(Kind::Photo),
            areas: either(AREAS),
            lines: ClassedLayer::ALL.map(|layer| size(Kind::of_lines(layer))),
            spans: size(Kind::Spans),
            geo_class_bytes,
            sv_class_bytes,
        }
    }
}

/// Sizes of the parts of a payload of tile `id`.
///
/// # Errors
/// When the bytes are not a payload of that tile, or a road section is damaged.
pub fn payload_sizes(bytes: &[u8], id: TileId) -> Result<PayloadSizes, DecodeError> {
    let failed = |part| move |damage| DecodeError { tile: id, part, damage };
    let sections = envelope::open(bytes, id).map_err(failed("header"))?;
    let class_bytes = |roads: TwoKinds| -> Result<[u64; FunctionalRoadClass::COUNT], Damage> {
        let mut sizes = [0; FunctionalRoadClass::COUNT];
        if let Some((raw, is_coded)) = envelope::section_of_two(&sections, roads)? {
            let mut cursor = Cursor::new(&raw);
            cursor.take(if is_coded { GRID_BYTES } else { 0 })?;
            for (class, _, bytes) in class_table::decode(&mut cursor)? {
                sizes[usize::from(class.number())] = bytes.len() as u64;
            }
        }
        Ok(sizes)
    };
    let of_classes = |roads: TwoKinds| class_bytes(roads).map_err(failed(roads.planes.name()));
    let size = |kind| envelope::size(&sections, kind);
    let class_bytes = [of_classes(GEO)?, of_classes(SV)?];
    Ok(PayloadSizes::of(size, envelope::sv_tail_bytes(&sections), class_bytes))
}
