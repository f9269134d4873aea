//! What must be known of a package's first tiles before there is a frame. The thread waits for them.

use std::sync::Arc;

use corniche_geom::TileId;
use corniche_viewer::{
    CameraRequest,
    lod::Request,
    tiles::{BlockingPackage, MapExtent, MapPackage, TileStore},
};

use crate::{
    WindowError, WindowRequest,
    app::{self, ShownPackage},
};

/// A package that can be shown, and its tiles for threads that wait for them.
pub(crate) struct OpenedPackage {
    pub(crate) shown: ShownPackage,
    pub(crate) tiles: Arc<dyn BlockingPackage + Send + Sync>,
}

impl OpenedPackage {
    /// Checks the request and loads the package's root. This needs no window, and no window must open where it fails.
    ///
    /// # Errors
    /// When the request makes no sense, or the package cannot be read, has no ground or does not fit the graphics memory
    /// allowed.
    pub(crate) fn new(
        request: &WindowRequest,
        tiles: Arc<dyn BlockingPackage + Send + Sync>,
    ) -> Result<Self, WindowError> {
        app::check(request, tiles.as_ref())?;
        let no_ground = || WindowError::NoGround { name: request.name.clone() };
        let mut store = TileStore::new(tiles.as_ref());
        let ground = store.coarsest_ground()?.ok_or_else(no_ground)?;
        let data = tiles.manifest().data_bounds;
        let extent = if request.camera.is_overview() {
            store.map_extent(data)?.ok_or_else(no_ground)?
        } else {
            MapExtent::of_data(data, ground.height_range_m)
        };
        store.load(&[Request { id: TileId::ROOT, coarseness: f64::INFINITY }])?;
        let root = store.get(TileId::ROOT).ok_or_else(no_ground)?;
        let package: Arc<dyn MapPackage> = Arc::<dyn BlockingPackage + Send + Sync>::clone(&tiles);
        let shown = ShownPackage::of(request, package, root, extent)?;
        Ok(Self { shown, tiles })
    }

    /// True height of the ground at the place that the camera looks at first. `None` without ground there, and where it looks
    /// at the whole package.
    ///
    /// # Errors
    /// When the place is too far away from the package, or a tile there cannot be read.
    pub(crate) fn place_height_m(&self, camera: CameraRequest) -> Result<Option<f64>, WindowError> {
        let Some(at) = camera.place(self.tiles.manifest())? else { return Ok(None) };
        Ok(TileStore::new(self.tiles.as_ref()).ground_height_m(at)?)
    }
}
