//! The photo of a tile as an image of the ground.

use corniche_geom::TileId;
use corniche_styles::{Rgb, Style};
use corniche_tileset::{FilePackage, PHOTO_BORDER, Photo, ReadError, decode_photo};
use jpeg_encoder::{ColorType, Encoder};

use crate::error::SurfaceError;

/// An image that covers a tile and a margin around it.
pub(crate) struct Texture {
    pub(crate) jpeg: Vec<u8>,
    /// The share of its side that is outside the tile, on each side.
    border: f32,
}

impl Texture {
    /// Returns the photo of a tile, at the strength that the style sets, over `ground` where there
    /// is none; `None` if the tile has no photo or the style shows none.
    pub(crate) fn of_tile(
        package: &FilePackage,
        id: TileId,
        style: &Style,
        ground: Rgb,
    ) -> Result<Option<Self>, SurfaceError> {
        let strength = style.photo;
        let Some(record) = package.manifest().settings.photo.filter(|_| strength > 0.0) else {
            return Ok(None);
        };
        let Some(bytes) = package.tile(id)? else { return Ok(None) };
        let Some(photo) = decode_photo(&bytes, id).map_err(ReadError::from)? else {
            return Ok(None);
        };
        let side = photo.side();
        let rgb = mixed(&photo, strength, ground);
        let mut jpeg = Vec::new();
        // Sides of photos have a few thousand texels at most.
        let texels = side as u16;
        Encoder::new(&mut jpeg, record.quality)
            .encode(&rgb, texels, texels, ColorType::Rgb)
            .map_err(|source| SurfaceError::Picture { tile: id, source: Box::new(source) })?;
        Ok(Some(Self { jpeg, border: PHOTO_BORDER as f32 / side as f32 }))
    }

    /// Returns the texture coordinates of a place of the tile, given as shares of the tile from the
    /// west and from the north.
    pub(crate) fn place(&self, across: [f32; 2]) -> [f32; 2] {
        across.map(|share| self.border + share * (1.0 - 2.0 * self.border))
    }
}

/// Blends a photo over ground of one colour.
fn mixed(photo: &Photo, strength: f32, ground: Rgb) -> Vec<u8> {
    let texels = photo.rgba.as_chunks::<4>().0;
    texels
        .iter()
        .flat_map(|&[red, green, blue, alpha]| {
            let share = strength * f32::from(alpha) / 255.0;
            [red, green, blue].into_iter().zip(ground).map(move |(of_photo, of_ground)| {
                let mixed = of_ground * 255.0 + share * (f32::from(of_photo) - of_ground * 255.0);
                mixed.round() as u8
            })
        })
        .collect()
}
