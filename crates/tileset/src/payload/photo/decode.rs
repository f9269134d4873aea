//! Decodes the photo section: a JPEG, and a mask of the texels without a photo.

use zune_core::bytestream::ZCursor;
use zune_core::colorspace::ColorSpace;
use zune_core::options::DecoderOptions;
use zune_jpeg::JpegDecoder;

use super::{
    coverage,
    image::{Photo, side},
};
use crate::{
    limits::MAX_PHOTO_LEVELS,
    payload::{
        damage::{Damage, Result},
        number_codes::Cursor,
    },
};

/// The code for colours as JPEG.
pub(crate) const JPEG: u8 = 1;

/// The last marker of a JPEG.
const END_OF_IMAGE: [u8; 2] = [0xff, 0xd9];

/// Decodes the photo from a section's bytes.
pub(crate) fn decode(bytes: &[u8]) -> Result<Photo> {
    let mut cursor = Cursor::new(bytes);
    Damage::invalid_if(cursor.byte()? != JPEG, "an unknown coding of colours")?;
    let levels = cursor.byte()?;
    Damage::limit("levels of a photo", levels.into(), MAX_PHOTO_LEVELS.into())?;
    let count = side(levels) * side(levels);
    let mut without = Vec::new();
    coverage::decode(&mut cursor, count, |has_photo, run| {
        if !has_photo {
            without.push(run);
        }
    })?;
    let mut rgba = colours(cursor.take(cursor.left())?, side(levels))?;
    for texel in without.into_iter().flatten() {
        rgba[texel * 4 + 3] = 0;
    }
    Ok(Photo { levels, rgba })
}

/// Decodes a JPEG of three colours and of known size.
fn colours(jpeg: &[u8], side: usize) -> Result<Vec<u8>> {
    const NOT_FITTING: Damage = Damage::Invalid("an image of another size or kind");
    // A JPEG may have a scan for each colour, and the decoder does not notice a truncated scan.
    if !jpeg.ends_with(&END_OF_IMAGE) {
        return Err(Damage::TooShort);
    }
    let failed = |error: &dyn std::fmt::Display| Damage::Decompress { reason: error.to_string() };
    let options = DecoderOptions::default()
        .set_strict_mode(true)
        .set_max_width(side)
        .set_max_height(side)
        .jpeg_set_out_colorspace(ColorSpace::RGBA);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(jpeg), options);
    decoder.decode_headers().map_err(|error| failed(&error))?;
    let info = decoder.info().ok_or(NOT_FITTING)?;
    let fits = usize::from(info.width) == side
        && usize::from(info.height) == side
        && info.components == 3
        && decoder.output_buffer_size() == Some(side * side * 4);
    if !fits {
        return Err(NOT_FITTING);
    }
    let rgba = decoder.decode().map_err(|error| failed(&error))?;
    if rgba.len() == side * side * 4 { Ok(rgba) } else { Err(NOT_FITTING) }
}
