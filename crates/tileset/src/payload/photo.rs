//! The photo of a tile: a picture of the ground from above, read and written apart from the rest of the payload. Most readers do not
//! want it, and it can be copied from one payload to another as it is.

mod coverage;
mod decode;
#[cfg(feature = "write")]
mod encode;
mod image;

use corniche_geom::TileId;

use crate::payload::damage::DecodeError;
use crate::payload::envelope;
use crate::payload::section_kind::Kind;

#[cfg(feature = "write")]
pub use encode::{encode_photo, photo_section};
pub use image::{PHOTO_BORDER, Photo};

/// Reads the photo of a tile from the bytes of its payload; `None` if it has none. Memory and work are bounded by
/// [`MAX_PHOTO_LEVELS`](crate::limits::MAX_PHOTO_LEVELS), whatever the bytes say.
///
/// # Errors
/// When the bytes are not a payload of tile `id`, or the photo is damaged.
pub fn decode_photo(bytes: &[u8], id: TileId) -> Result<Option<Photo>, DecodeError> {
    envelope::read_part(bytes, id, Kind::Photo.name(), |sections| {
        let section = envelope::section(sections, Kind::Photo)?;
        section.map(|section| decode::decode(&section)).transpose()
    })
}

#[cfg(test)]
#[path = "photo_tests.rs"]
mod tests;
