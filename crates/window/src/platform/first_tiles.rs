//! The first tiles of a package, which must be known before the first frame. The thread waits for
//! them.

use std::sync::Arc;

use corniche_geom::TileId;
use corniche_viewer::{
    SightedGround,
    gpu::tile_bytes,
    tiles::{BlockingPackage, TileStore},
};

use crate::{WindowError, WindowRequest};

/// A package that can be shown, its tiles for threads that wait for them, and the ground for its
/// first view.
pub(crate) struct OpenedPackage {
    pub(crate) tiles: Arc<dyn BlockingPackage + Send + Sync>,
    ground: SightedGround,
}

impl OpenedPackage {
    /// Checks the request and loads the package's root tile. This needs no window, and no window
    /// may open if it fails.
    ///
    /// # Errors
    /// When the request is invalid, or the package cannot be read, has no ground or exceeds the
    /// graphics memory allowed.
    pub(crate) fn new(
        request: &WindowRequest,
        tiles: Arc<dyn BlockingPackage + Send + Sync>,
    ) -> Result<Self, WindowError> {
        request.check()?;
        let no_ground = || WindowError::NoGround { name: request.name.clone() };
        let mut store = TileStore::new(tiles.as_ref());
        let ground = request.camera.sighted_ground(&mut store, tiles.manifest())?;
        let ground = ground.ok_or_else(no_ground)?;
        store.load(TileId::ROOT)?;
        let root = store.get(TileId::ROOT).ok_or_else(no_ground)?;
        let heights_m = root.summary.ok_or_else(no_ground)?.height_range_m;
        let (wanted_bytes, budget_bytes) = (tile_bytes(root), request.budget.gpu_bytes);
        if wanted_bytes > budget_bytes {
            return Err(WindowError::OverBudget { wanted_bytes, budget_bytes });
        }
        Ok(Self { tiles, ground: SightedGround { heights_m, ..ground } })
    }

    /// The ground that sets up the first camera, with its height at the place that the camera looks
    /// at.
    ///
    /// # Errors
    /// When the place is too far away from the package, or a tile there cannot be read.
    pub(crate) fn ground(&self, request: &WindowRequest) -> Result<SightedGround, WindowError> {
        let at_place_m = match request.camera.place(self.tiles.manifest())? {
            Some(at) => TileStore::new(self.tiles.as_ref()).ground_height_m(at)?,
            None => None,
        };
        Ok(SightedGround { at_place_m, ..self.ground })
    }
}
