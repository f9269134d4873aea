//! The photo of a tile as a picture of the ground.

use corniche_geom::TileId;
use corniche_styles::{Rgb, Style};
use corniche_tileset::{FilePackage, PHOTO_BORDER, Photo, ReadError, decode_photo};
use jpeg_encoder::{ColorType, Encoder};

use crate::error::SurfaceError;

/// A picture that covers a tile and a little beyond.
#[derive(Clone)]
pub(crate) struct Texture {
    pub(crate) jpeg: Vec<u8>,
    /// The share of its side that lies beyond the tile, on each side.
    border: f32,
}

impl Texture {
    /// The photo of a tile, as strong as the style says, over `ground` where there is none; `None` where the tile has no photo or the style shows none.
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
        // Sides of photos are a few thousand texels at most.
        let sides = [side as u16; 2];
        Encoder::new(&mut jpeg, record.quality)
            .encode(&rgb, sides[0], sides[1], ColorType::Rgb)
            .map_err(|source| SurfaceError::Picture { tile: id, source: Box::new(source) })?;
        Ok(Some(Self { jpeg, border: PHOTO_BORDER as f32 / side as f32 }))
    }

    /// Where on the picture a place of the tile is, given as shares of the tile from the west and from the north.
    pub(crate) fn place(&self, across: [f32; 2]) -> [f32; 2] {
        across.map(|share| self.border + share * (1.0 - 2.0 * self.border))
    }
}

/// A photo over ground of one colour.
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
