//! The photo of a tile is encoded as a section: a JPEG, and a mask of the texels without a photo.

use corniche_geom::TileId;
use jpeg_encoder::{ColorType, Encoder, SamplingFactor};

use super::{
    coverage,
    decode::{self, JPEG},
    image::Photo,
};
use crate::limits::MAX_PHOTO_LEVELS;
use crate::payload::builder::Section;
use crate::payload::damage::{DecodeError, EncodeError};
use crate::payload::envelope;
use crate::payload::section_kind::Kind;

/// Texels along a side of JPEG's blocks.
const BLOCK: usize = 8;

impl Section {
    /// The photo of a tile with these bytes, which [`Section::bytes`] gave.
    #[must_use]
    pub fn of_photo(bytes: Vec<u8>) -> Self {
        Self { kind: Kind::Photo, bytes }
    }

    /// What readers will see of the photo that it holds.
    ///
    /// # Errors
    /// When the bytes are damaged.
    pub fn photo(&self, tile: TileId) -> Result<Photo, DecodeError> {
        let part = Kind::Photo.name();
        decode::decode(&self.bytes).map_err(|damage| DecodeError { tile, part, damage })
    }
}

/// Encodes the photo of a tile; `None` if no texel has a photo. Equal photos make equal bytes on every processor: all arithmetic is in whole
/// numbers. `quality` is JPEG's, from 1 to 100.
///
/// Each colour is stored at full resolution: of photos from above, halved colours save few bytes at the same error.
///
/// # Errors
/// When levels and the number of texels do not fit, or the quality is out of its range.
pub fn encode_photo(
    tile: TileId,
    photo: &Photo,
    quality: u8,
) -> Result<Option<Section>, EncodeError> {
    let refused = |what| EncodeError::Unencodable { tile, section: Kind::Photo.name(), what };
    if photo.levels > MAX_PHOTO_LEVELS || photo.rgba.len() != photo.side() * photo.side() * 4 {
        return Err(refused("a photo of another size"));
    }
    if !(1..=100).contains(&quality) {
        return Err(refused("a quality that is not from 1 to 100"));
    }
    let has_photo = || photo.rgba.chunks_exact(4).map(|texel| texel[3] != 0);
    if !has_photo().any(|has_photo| has_photo) {
        return Ok(None);
    }
    let mut bytes = vec![JPEG, photo.levels];
    coverage::encode(has_photo(), &mut bytes);
    let side = photo.side();
    let mut encoder = Encoder::new(&mut bytes, quality);
    encoder.set_sampling_factor(SamplingFactor::F_1_1);
    // Tables of the picture's own; the pixels stay the same.
    encoder.set_optimized_huffman_tables(true);
    // A side is at most 4112.
    let encoded = encoder.encode(&filled(photo), side as u16, side as u16, ColorType::Rgb);
    encoded.map_err(|error| EncodeError::Compress {
        tile,
        section: Kind::Photo.name(),
        reason: error.to_string(),
    })?;
    Ok(Some(Section::of_photo(bytes)))
}

/// The colours of all texels. Those without a photo get the mean of the block of JPEG that they are in, or of the whole photo where
/// their block has none: an edge inside a block would cost bytes, and would ring on the side that is seen.
fn filled(photo: &Photo) -> Vec<u8> {
    let side = photo.side();
    let mut rgb: Vec<u8> =
        photo.rgba.chunks_exact(4).flat_map(|texel| [texel[0], texel[1], texel[2]]).collect();
    let texel = |at: usize| &photo.rgba[at * 4..at * 4 + 4];
    if (0..side * side).all(|at| texel(at)[3] != 0) {
        return rgb;
    }
    let of_all = mean((0..side * side).map(texel)).unwrap_or_default();
    for top in (0..side).step_by(BLOCK) {
        for left in (0..side).step_by(BLOCK) {
            // Sides are whole numbers of blocks.
            let places = || {
                (top..top + BLOCK)
                    .flat_map(|row| (left..left + BLOCK).map(move |column| row * side + column))
            };
            let colour = mean(places().map(texel)).unwrap_or(of_all);
            for at in places().filter(|&at| texel(at)[3] == 0) {
                rgb[at * 3..at * 3 + 3].copy_from_slice(&colour);
            }
        }
    }
    rgb
}

/// The mean colour of the texels that have a photo, if any has.
fn mean<'a>(texels: impl Iterator<Item = &'a [u8]>) -> Option<[u8; 3]> {
    let (mut sums, mut count) = ([0_u64; 3], 0);
    for texel in texels.filter(|texel| texel[3] != 0) {
        count += 1;
        for (sum, value) in sums.iter_mut().zip(texel) {
            *sum += u64::from(*value);
        }
    }
    (count > 0).then(|| sums.map(|sum| ((sum + count / 2) / count) as u8))
}

/// The photo of a payload as it is stored there; `None` if it has none.
///
/// # Errors
/// When the bytes are not a payload of the tile, or the section is damaged.
pub fn photo_section(payload: &[u8], tile: TileId) -> Result<Option<Section>, DecodeError> {
    let failed = |part| move |damage| DecodeError { tile, part, damage };
    let sections = envelope::open(payload, tile).map_err(failed("header"))?;
    let bytes = envelope::section(&sections, Kind::Photo).map_err(failed(Kind::Photo.name()))?;
    Ok(bytes.map(Section::of_photo))
}
