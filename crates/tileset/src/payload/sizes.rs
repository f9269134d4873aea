//! The sizes of the parts of a payload, without decoding their content.

use corniche_geom::TileId;
use corniche_layers::MAX_LAYERS;
use corniche_roads::FunctionalRoadClass;

use crate::{
    layer_slot::LayerSlot,
    payload::{
        class_table,
        damage::{DecodeError, Result},
        envelope::{self, SectionSize},
        number_codes::Cursor,
        section_kind::{GEO, SV, SectionKind, TwoKinds},
        source_grid::GRID_BYTES,
    },
};

/// Sizes of the sections of a payload, and of the classes in its road sections.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PayloadSizes {
    /// The terrain section; all sizes are 0 if the section is absent.
    pub terrain: SectionSize,
    /// The GEO roads section.
    pub roads_geo: SectionSize,
    /// The SV roads section.
    pub roads_sv: SectionSize,
    /// Bytes of the SV roads at the end of the payload; 0 if another section is the last, as in
    /// packages of older versions.
    pub sv_tail: u64,
    /// The road attributes section.
    pub attributes: SectionSize,
    /// The road tags section.
    pub road_tags: SectionSize,
    /// The relief section.
    pub relief: SectionSize,
    /// The photo section.
    pub photo: SectionSize,
    /// The spans section.
    pub spans: SectionSize,
    /// The section of each layer, by its position.
    pub layers: [SectionSize; MAX_LAYERS],
    /// Bytes of each class in the GEO section before compression: the stored bytes are distributed
    /// to classes in proportion to them.
    pub geo_class_bytes: [u64; FunctionalRoadClass::COUNT],
    /// Bytes of each class in the SV section before compression.
    pub sv_class_bytes: [u64; FunctionalRoadClass::COUNT],
}

impl PayloadSizes {
    /// Returns the sizes of sections, which `size` gives for each kind, with the bytes of the
    /// classes of GEO and SV roads.
    pub(crate) fn from_sections(
        size: impl Fn(SectionKind) -> SectionSize,
        sv_tail: u64,
        [geo_class_bytes, sv_class_bytes]: [[u64; FunctionalRoadClass::COUNT]; 2],
    ) -> Self {
        let either = |kinds: TwoKinds| size(kinds.planes).or(size(kinds.coded));
        Self {
            terrain: size(SectionKind::Terrain),
            roads_geo: either(GEO),
            roads_sv: either(SV),
            sv_tail,
            attributes: size(SectionKind::Attributes),
            road_tags: size(SectionKind::RoadTags),
            relief: size(SectionKind::Relief),
            photo: size(SectionKind::Photo),
            spans: size(SectionKind::Spans),
            layers: std::array::from_fn(|index| {
                let kind = LayerSlot::new(index).map(SectionKind::Layer);
                kind.map(&size).unwrap_or_default()
            }),
            geo_class_bytes,
            sv_class_bytes,
        }
    }
}

/// Returns the sizes of the parts of a payload of tile `id`.
///
/// # Errors
/// When the bytes are not a payload of that tile, or a road section is damaged.
pub fn payload_sizes(bytes: &[u8], id: TileId) -> Result<PayloadSizes, DecodeError> {
    let sections = envelope::open(bytes, id).map_err(|damage| damage.in_header(id))?;
    let class_bytes = |roads: TwoKinds| -> Result<[u64; FunctionalRoadClass::COUNT]> {
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
    let of_classes = |roads: TwoKinds| class_bytes(roads).map_err(roads.planes.damaged(id));
    let size = |kind| envelope::size(&sections, kind);
    let class_bytes = [of_classes(GEO)?, of_classes(SV)?];
    Ok(PayloadSizes::from_sections(size, envelope::sv_tail_bytes(&sections), class_bytes))
}
