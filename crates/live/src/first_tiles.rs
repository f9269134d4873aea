//! What must be known of a package's first tiles before there is a frame, and which tiles the first
//! view will need.

use std::{cell::RefCell, collections::BTreeMap};

use corniche_geom::{Bounds, GridFrame, TileId};
use corniche_tileset::Manifest;
use corniche_viewer::{
    CameraRequest, SightedGround,
    camera::Camera,
    lod::{self, GroundSummary, Node, Quality, TileTree},
    tiles::{
        LoadTileError, MapExtent, MapPackage, TileCatalog, TileGeometry, TileSource, TileStore,
    },
};

/// The ground that the camera of a first view is set up by, but for the height at its place; `None`
/// where there is no ground.
///
/// # Errors
/// When a tile cannot be read.
pub fn sighted_ground<S: TileSource + ?Sized>(
    store: &mut TileStore<'_, S>,
    manifest: &Manifest,
    camera: CameraRequest,
) -> Result<Option<SightedGround>, LoadTileError> {
    let data = manifest.data_bounds;
    let Some(coarsest) = store.coarsest_ground()? else { return Ok(None) };
    let heights_m = coarsest.height_range_m;
    let extent = if camera.is_overview() { store.map_extent(data)? } else { None };
    let extent = extent.unwrap_or_else(|| MapExtent::of_data(data, heights_m));
    Ok(Some(SightedGround { extent, heights_m, at_place_m: None }))
}

/// Tiles that are there, for those who must not wait for others. It notes those that are not.
pub struct KnownTiles<'a> {
    /// The package.
    pub package: &'a dyn MapPackage,
    /// The tiles.
    pub there: &'a BTreeMap<TileId, TileGeometry>,
    /// Whether some of its tiles may have roads, as they are read.
    pub may_have_roads: bool,
}

/// What known tiles say of the first view.
pub enum FirstLook {
    /// The ground by which its camera is set up; `None` where there is no ground.
    Known(Option<SightedGround>),
    /// These tiles must be there for that.
    Wanted(Vec<TileId>),
}

/// [`KnownTiles`], and those that were asked for and are not there.
struct NotingTiles<'a> {
    known: &'a KnownTiles<'a>,
    missing: RefCell<Vec<TileId>>,
}

impl KnownTiles<'_> {
    /// What is known of the ground for the first view. `place` is that of the camera, in the
    /// working CRS.
    ///
    /// # Errors
    /// When a tile cannot be read.
    pub fn look(
        &self,
        camera: CameraRequest,
        place: Option<[f64; 2]>,
    ) -> Result<FirstLook, LoadTileError> {
        let noting = NotingTiles { known: self, missing: RefCell::default() };
        let mut store = TileStore::new(&noting);
        let mut look = || {
            let Some(ground) = sighted_ground(&mut store, self.package.manifest(), camera)? else {
                return Ok(None);
            };
            let at_place_m = match place {
                Some(at) => store.ground_height_m(at)?,
                None => None,
            };
            Ok(Some(SightedGround { at_place_m, ..ground }))
        };
        let found = look();
        let mut wanted = noting.missing.take();
        wanted.retain(|id| !self.there.contains_key(id));
        match found {
            Err(_) if !wanted.is_empty() => Ok(FirstLook::Wanted(wanted)),
            found => found.map(FirstLook::Known),
        }
    }
}

impl TileCatalog for NotingTiles<'_> {
    fn frame(&self) -> &GridFrame {
        self.known.package.frame()
    }

    fn exists(&self, id: TileId) -> bool {
        self.known.package.exists(id)
    }
}

impl TileSource for NotingTiles<'_> {
    fn load(&self, id: TileId) -> Result<TileGeometry, LoadTileError> {
        self.known.there.get(&id).cloned().ok_or_else(|| {
            self.missing.borrow_mut().push(id);
            LoadTileError { id, source: "it is not loaded yet".into() }
        })
    }

    fn may_have_roads(&self) -> bool {
        self.known.may_have_roads
    }
}

/// More tiles than these are not foreseen: the guess may be wrong.
const MOST_TILES: usize = 24;

/// A tree in which each tile has the usual error of its level.
struct Guessed<'a> {
    package: &'a dyn MapPackage,
    heights_m: [f64; 2],
}

impl TileTree for Guessed<'_> {
    fn node(&self, id: TileId) -> Node {
        if !self.package.exists(id) {
            return Node::Absent;
        }
        let level = self.package.manifest().levels.get(usize::from(id.z()));
        let errors = level.and_then(|level| level.errors_m);
        let geometric_error_m = errors.map_or(0.0, |errors| errors.median);
        Node::Loaded(Some(GroundSummary { geometric_error_m, height_range_m: self.heights_m }))
    }

    fn plan_bounds(&self, id: TileId) -> Bounds {
        self.package.frame().tile_bounds(id)
    }

    fn max_level(&self) -> u8 {
        self.package.frame().max_level()
    }
}

/// The tiles that a view will probably need, coarse ones first. A page asks for them at once: else it would learn of each level's tiles only when those
/// above have come, one round of the network after the other.
#[must_use]
pub fn foreseen(
    package: &dyn MapPackage,
    heights_m: [f64; 2],
    camera: &Camera,
    quality: Quality,
) -> Vec<TileId> {
    let selection = lod::select(&Guessed { package, heights_m }, camera, quality);
    let mut wanted: Vec<TileId> = Vec::new();
    for drawn in selection.drawn {
        wanted.extend(std::iter::successors(Some(drawn.id), |id| id.parent()));
    }
    wanted.sort_unstable();
    wanted.dedup();
    wanted.truncate(MOST_TILES);
    wanted
}
