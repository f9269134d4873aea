//! The first tiles of a package: those that must be known before the first frame, and those that
//! the first view will need.

use std::{cell::RefCell, collections::BTreeMap};

use corniche_geom::{GridFrame, TileId};
use corniche_viewer::{
    CameraRequest, SightedGround,
    camera::Camera,
    lod::{self, GroundSummary, Quality},
    tiles::{
        CatalogTree, LoadTileError, MapPackage, TileCatalog, TileGeometry, TileSource, TileStore,
    },
};

/// The loaded tiles, for callers that must not wait for others. It notes the missing ones.
pub struct KnownTiles<'a> {
    package: &'a dyn MapPackage,
    there: &'a BTreeMap<TileId, TileGeometry>,
    may_have_roads: bool,
    missing: RefCell<Vec<TileId>>,
}

/// The information about the first view in the known tiles.
pub enum FirstLook {
    /// The ground that sets up the camera; `None` if there is no ground.
    Known(Option<SightedGround>),
    /// These tiles must be loaded first.
    Wanted(Vec<TileId>),
}

impl<'a> KnownTiles<'a> {
    /// Creates the set of loaded tiles of a package. `may_have_roads` says whether some of the
    /// tiles may have roads, with the sections that are read.
    pub fn new(
        package: &'a dyn MapPackage,
        there: &'a BTreeMap<TileId, TileGeometry>,
        may_have_roads: bool,
    ) -> Self {
        Self { package, there, may_have_roads, missing: RefCell::default() }
    }

    /// Returns the ground for the first view, or the tiles it needs. `place` is the position of the
    /// camera, in the working CRS.
    ///
    /// # Errors
    /// When a tile cannot be read.
    pub fn look(
        &self,
        camera: CameraRequest,
        place: Option<[f64; 2]>,
    ) -> Result<FirstLook, LoadTileError> {
        let mut store = TileStore::new(self);
        let mut look = || {
            let Some(ground) = camera.sighted_ground(&mut store, self.package.manifest())? else {
                return Ok(None);
            };
            let at_place_m = match place {
                Some(at) => store.ground_height_m(at)?,
                None => None,
            };
            Ok(Some(SightedGround { at_place_m, ..ground }))
        };
        let found = look();
        let mut wanted = self.missing.take();
        wanted.retain(|id| !self.there.contains_key(id));
        match found {
            Err(_) if !wanted.is_empty() => Ok(FirstLook::Wanted(wanted)),
            found => found.map(FirstLook::Known),
        }
    }
}

impl TileCatalog for KnownTiles<'_> {
    fn frame(&self) -> &GridFrame {
        self.package.frame()
    }

    fn exists(&self, id: TileId) -> bool {
        self.package.exists(id)
    }
}

impl TileSource for KnownTiles<'_> {
    fn load(&self, id: TileId) -> Result<TileGeometry, LoadTileError> {
        self.there.get(&id).cloned().ok_or_else(|| {
            self.missing.borrow_mut().push(id);
            LoadTileError { id, source: "the tile is not loaded yet".into() }
        })
    }

    fn may_have_roads(&self) -> bool {
        self.may_have_roads
    }
}

/// The largest number of predicted tiles, since the prediction may be wrong.
const MOST_TILES: usize = 24;

/// Predicts the tiles that a view will need, coarse ones first. A page requests them all at once:
/// otherwise each level would cost another network round trip, since its tiles are only known after
/// those above have been loaded.
#[must_use]
pub fn foreseen(
    package: &dyn MapPackage,
    heights_m: [f64; 2],
    camera: &Camera,
    quality: Quality,
) -> Vec<TileId> {
    // The prediction assumes the error of the level and the height range of the package for every
    // tile.
    let ground_of = |id: TileId| {
        let level = package.manifest().levels.get(usize::from(id.z()));
        let errors = level.and_then(|level| level.errors_m);
        let geometric_error_m = errors.map_or(0.0, |errors| errors.median);
        let ground = GroundSummary { geometric_error_m, height_range_m: heights_m };
        package.exists(id).then_some(Some(ground))
    };
    let selection = lod::select(&CatalogTree { catalog: package, ground_of }, camera, quality);
    let mut wanted: Vec<TileId> = Vec::new();
    for drawn in selection.drawn {
        wanted.extend(std::iter::successors(Some(drawn.id), |id| id.parent()));
    }
    wanted.sort_unstable();
    wanted.dedup();
    wanted.truncate(MOST_TILES);
    wanted
}
