//! Encodes the photo of a tile as a section: a JPEG, and a mask of the texels without a photo.

use corniche_geom::TileId;
use jpeg_encoder::{ColorType, Encoder, SamplingFactor};

use super::{
    coverage,
    decode::{self, JPEG},
    image::Photo,
};
use crate::{
    limits::MAX_PHOTO_LEVELS,
    payload::{
        builder::Section,
        damage::{DecodeError, EncodeError},
        envelope,
        section_kind::SectionKind,
    },
};

/// The side of JPEG's blocks in texels.
const BLOCK: usize = 8;

impl Section {
    /// Returns the photo section of a tile with these bytes, which came from [`Section::bytes`].
    #[must_use]
    pub fn of_photo(bytes: Vec<u8>) -> Self {
        Self { kind: SectionKind::Photo, bytes }
    }

    /// Returns the photo in this section as readers will see it.
    ///
    /// # Errors
    /// When the bytes are damaged.
    pub fn photo(&self, tile: TileId) -> Result<Photo, DecodeError> {
        decode::decode(&self.bytes).map_err(SectionKind::Photo.damaged(tile))
    }
}

/// Encodes the photo of a tile; `None` if no texel has a photo. Equal photos result in equal bytes
/// on every processor, because all arithmetic is on integers. `quality` is JPEG's, from 1 to 100.
///
/// Each colour is stored at full resolution: for aerial photos, half the resolution would save few
/// bytes at the same error.
///
/// # Errors
/// When the number of texels does not match the levels, or the quality is out of its range.
pub fn encode_photo(
    tile: TileId,
    photo: &Photo,
    quality: u8,
) -> Result<Option<Section>, EncodeError> {
    let refused = SectionKind::Photo.refused(tile);
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
    // The image gets its own Huffman tables; the pixels stay the same.
    encoder.set_optimized_huffman_tables(true);
    // A side has at most 4112 texels.
    let encoded = encoder.encode(&filled(photo), side as u16, side as u16, ColorType::Rgb);
    encoded.map_err(|error| EncodeError::Compress {
        tile,
        section: SectionKind::Photo.name(),
        reason: error.to_string(),
    })?;
    Ok(Some(Section::of_photo(bytes)))
}

/// Returns the colours of all texels. Texels without a photo get the mean of their JPEG block, or
/// the mean of the whole photo if their block has no photo: an edge inside a block would cost
/// bytes, and would cause ringing on the visible side.
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

/// Returns the mean colour of the texels that have a photo, if there are any.
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

/// Returns the photo of a payload as it is stored there; `None` if it has none.
///
/// # Errors
/// When the bytes are not a payload of the tile, or the section is damaged.
pub fn photo_section(payload: &[u8], tile: TileId) -> Result<Option<Section>, DecodeError> {
    let sections = envelope::open(payload, tile).map_err(|damage| damage.in_header(tile))?;
    let bytes = envelope::section(&sections, SectionKind::Photo)
        .map_err(SectionKind::Photo.damaged(tile))?;
    Ok(bytes.map(Section::of_photo))
}
