//! The photo of a tile: an image of the ground from above. It is read and written separately from
//! the rest of the payload: most readers do not need it, and it can be copied from one payload to
//! another unchanged.

mod coverage;
mod decode;
#[cfg(feature = "write")]
mod encode;
mod image;

use corniche_geom::TileId;

use crate::payload::{damage::DecodeError, envelope, section_kind::SectionKind};

#[cfg(feature = "write")]
pub use encode::{encode_photo, photo_section};
pub use image::{PHOTO_BORDER, Photo};

/// Reads the photo of a tile from the bytes of its payload; `None` if it has none. Memory and work
/// are limited by [`MAX_PHOTO_LEVELS`](crate::limits::MAX_PHOTO_LEVELS), whatever the bytes say.
///
/// # Errors
/// When the bytes are not a payload of tile `id`, or the photo is damaged.
pub fn decode_photo(bytes: &[u8], id: TileId) -> Result<Option<Photo>, DecodeError> {
    envelope::read_part(bytes, id, SectionKind::Photo, |sections| {
        let section = envelope::section(sections, SectionKind::Photo)?;
        section.map(|section| decode::decode(&section)).transpose()
    })
}

#[cfg(test)]
#[path = "photo_tests.rs"]
mod tests;
