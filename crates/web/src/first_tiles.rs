//! What must be known of a package's first tiles before there is a frame.

use std::{cell::RefCell, collections::BTreeMap};

use corniche_geom::{GridFrame, TileId};
use corniche_tileset::Manifest;
use corniche_viewer::{
    CameraRequest, SightedGround,
    tiles::{
        LoadTileError, MapExtent, MapPackage as _, TileCatalog, TileGeometry, TileSource,
        TileStore, may_have_roads,
    },
};
use futures_util::future::join_all;

use crate::{decoders::Reading, loader::Tileset, problem::Problem};

/// Tiles that are there. It notes those that are not, for a loader that must not wait.
struct Noting<'a> {
    tiles: &'a Tileset,
    there: &'a BTreeMap<TileId, TileGeometry>,
    reading: &'a Reading,
    missing: RefCell<Vec<TileId>>,
}

/// A tile that is not there yet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct NotYet;

impl std::fmt::Display for NotYet {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("it is not loaded yet")
    }
}

impl std::error::Error for NotYet {}

impl TileCatalog for Noting<'_> {
    fn frame(&self) -> &GridFrame {
        self.tiles.package.frame()
    }

    fn exists(&self, id: TileId) -> bool {
        self.tiles.package.exists(id)
    }
}

impl TileSource for Noting<'_> {
    fn load(&self, id: TileId) -> Result<TileGeometry, LoadTileError> {
        self.there.get(&id).cloned().ok_or_else(|| {
            self.missing.borrow_mut().push(id);
            LoadTileError { id, source: Box::new(NotYet) }
        })
    }

    fn may_have_roads(&self) -> bool {
        may_have_roads(self.tiles.package.manifest(), self.reading.sections)
    }
}

/// The tiles of the first view that had to be looked at, and the ground that its camera is set up by.
pub(crate) struct FirstTiles {
    pub(crate) tiles: BTreeMap<TileId, TileGeometry>,
    pub(crate) ground: SightedGround,
}

/// Loads what the camera of the first view needs.
///
/// # Errors
/// When there is no ground, or a tile cannot be read.
pub(crate) async fn first_tiles(
    tileset: &Tileset,
    camera: CameraRequest,
    reading: &Reading,
) -> Result<FirstTiles, Problem> {
    let manifest = tileset.package.manifest();
    let place = camera.place(manifest).map_err(|error| off_ground(&error))?;
    let mut there = BTreeMap::new();
    // All tiles above the place are needed, and asked for at once; else each would wait for the one above it.
    let mut wanted = place.map_or_else(|| vec![TileId::ROOT], |at| tileset.package.tiles_at(at));
    loop {
        let loads = wanted.iter().map(|id| tileset.load(*id, reading));
        for tile in join_all(loads).await {
            let tile = tile.map_err(|error| tileset.problem_of(&error))?;
            there.insert(tile.id, tile);
        }
        let missing = RefCell::default();
        let noting = Noting { tiles: tileset, there: &there, reading, missing };
        let found = looked(&noting, manifest, camera, place);
        wanted = noting.missing.into_inner();
        wanted.retain(|id| !there.contains_key(id));
        match found {
            Err(_) if !wanted.is_empty() => {}
            found => {
                let none = || {
                    Problem::new(
                        "no-ground",
                        "The package has no ground to show.",
                        "Build it from a DEM that has heights.",
                    )
                };
                let ground = found.map_err(|error| Problem::other(&error))?.ok_or_else(none)?;
                return Ok(FirstTiles { tiles: there, ground });
            }
        }
    }
}

/// A place without ground, in words.
pub(crate) fn off_ground(error: &corniche_viewer::OffGround) -> Problem {
    Problem::new(
        "off-ground",
        error.to_string(),
        "Leave the place out, or name one that the package covers.",
    )
}

fn looked(
    source: &Noting<'_>,
    manifest: &Manifest,
    camera: CameraRequest,
    place: Option<[f64; 2]>,
) -> Result<Option<SightedGround>, LoadTileError> {
    let data = manifest.data_bounds;
    let mut store = TileStore::new(source);
    let Some(coarsest) = store.coarsest_ground()? else { return Ok(None) };
    let heights_m = coarsest.height_range_m;
    let extent = if camera.is_overview() { store.map_extent(data)? } else { None };
    let extent = extent.unwrap_or_else(|| MapExtent::of_data(data, heights_m));
    let at_place_m = match place {
        Some(at) => store.ground_height_m(at)?,
        None => None,
    };
    Ok(Some(SightedGround { extent, heights_m, at_place_m }))
}
