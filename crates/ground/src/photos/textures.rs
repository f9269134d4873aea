//! The photo of a tile as it is stored in the payload.

use corniche_geom::{GridFrame, TileId};
use corniche_photo::{PhotoReader, Texels};
use corniche_spec::{artifacts::ArtifactKind, data_tiles::DataTiles};
use corniche_store::Artifacts;
use corniche_tileset::{PHOTO_BORDER, Photo, Section, encode_photo, photo_section};

use super::{
    rasters,
    source::{OpenedPhotos, PhotoSource},
};
use crate::{GroundError, TerrainError, terrain::ground::GroundSource};

/// The sources of textures, and the store for them.
#[derive(Clone, Copy)]
pub struct TextureStore<'a> {
    /// The store for textures.
    pub store: &'a dyn Artifacts,
    /// The package's grid.
    pub frame: &'a GridFrame,
    /// The finest tiles that can have data.
    pub data: DataTiles,
    /// The source of the ground.
    pub source: &'a GroundSource,
    /// The source of photos.
    pub photo: &'a PhotoSource,
}

/// Reads the photo of a finest tile, and stores its texture and its raster.
///
/// # Errors
/// See [`GroundError`].
pub fn make_finest(
    textures: TextureStore<'_>,
    photos: &OpenedPhotos,
    reader: &mut PhotoReader<'_>,
    id: TileId,
) -> Result<(), GroundError> {
    let store = textures.store;
    let key = ArtifactKind::PhotoTexture.of_tile(id);
    let none = || {
        store.put(key, &[])?;
        rasters::put(store, id, &Texels::empty(0, 0))
    };
    // The rectangle includes the border, which is less than 8 of 256 texels on each side.
    let tile = textures.frame.tile_bounds(id);
    let bounds = tile.expanded([tile.width() / 32.0, tile.height() / 32.0]);
    if !photos.grid.touches(&bounds) {
        return none();
    }
    let texels = reader.window(photos.grid.texels().tile(id, PHOTO_BORDER))?;
    let levels = photos.levels();
    let raster = rasters::of_texels(&texels, levels);
    match encode(id, levels, texels, photos.quality)? {
        Some(section) => store.put(key, section.bytes())?,
        None => return none(),
    }
    // The raster marks the tile as done, so it is stored last.
    rasters::put(store, id, &raster)
}

/// The photo of a tile; `None` if it has none. `earlier` is its payload in the package that
/// provides the terrain.
///
/// # Errors
/// See [`GroundError`].
pub fn of_tile(
    textures: TextureStore<'_>,
    id: TileId,
    earlier: Option<&[u8]>,
) -> Result<Option<Section>, GroundError> {
    match textures.photo {
        PhotoSource::Nothing => Ok(None),
        PhotoSource::Files(photos) => of_files(textures, photos, id),
        PhotoSource::Package(_) => {
            let section = earlier.map(|payload| photo_section(payload, id)).transpose();
            let section = section.map_err(|source| TerrainError::Tile {
                path: textures
                    .source
                    .package()
                    .map(|package| package.path().into())
                    .unwrap_or_default(),
                source: source.into(),
            })?;
            Ok(section.flatten())
        }
    }
}

fn of_files(
    textures: TextureStore<'_>,
    photos: &OpenedPhotos,
    id: TileId,
) -> Result<Option<Section>, GroundError> {
    let store = textures.store;
    if id.z() == textures.frame.max_level() {
        let bytes = store.get(ArtifactKind::PhotoTexture.of_tile(id))?;
        let bytes = bytes.ok_or_else(|| rasters::missing(id))?;
        return Ok((!bytes.is_empty()).then(|| Section::of_photo(bytes)));
    }
    let levels = photos.record().levels_on(id.z(), textures.frame.max_level());
    // Texels of children are half a cell wide.
    let border = PHOTO_BORDER << (1 - levels);
    let Some(texels) = rasters::of_children(store, &textures.data, id, border)? else {
        return Ok(None);
    };
    let texels = if levels == 0 { texels.halved() } else { texels };
    encode(id, levels, texels, photos.quality)
}

fn encode(
    id: TileId,
    levels: u8,
    texels: Texels,
    quality: u8,
) -> Result<Option<Section>, GroundError> {
    let photo = Photo { levels, rgba: texels.into_rgba() };
    Ok(encode_photo(id, &photo, quality)?)
}
