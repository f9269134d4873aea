//! The package that a window shows, after the checks that need no tile.

use std::sync::Arc;

use corniche_geom::TileId;
use corniche_live::MAX_PITCH_DEG;
use corniche_tileset::Manifest;
use corniche_viewer::{
    gpu::tile_bytes,
    range,
    tiles::{MapExtent, MapPackage, TileCatalog, TileGeometry},
};

use crate::{WindowError, WindowRequest};

/// Checks what can be checked before any tile is loaded.
///
/// # Errors
/// When the request makes no sense or the package has no tile.
pub(crate) fn check(request: &WindowRequest, catalog: &dyn TileCatalog) -> Result<(), WindowError> {
    check_numbers(request)?;
    if !catalog.exists(TileId::ROOT) {
        return Err(WindowError::NoGround { name: request.name.clone() });
    }
    Ok(())
}

/// A package that can be shown. It knows which tiles there are; a [`TileLoader`](corniche_live::TileLoader) loads them.
pub(crate) struct ShownPackage {
    package: Arc<dyn MapPackage>,
    height_range_m: [f64; 2],
    extent: MapExtent,
}

impl ShownPackage {
    /// The package for which [`check`] found nothing wrong, with its root tile and what the first view shows, which the platform
    /// has loaded.
    ///
    /// # Errors
    /// When the root has no ground or does not fit the graphics memory allowed.
    pub(crate) fn of(
        request: &WindowRequest,
        package: Arc<dyn MapPackage>,
        root: &TileGeometry,
        extent: MapExtent,
    ) -> Result<Self, WindowError> {
        let ground = root.summary;
        let ground = ground.ok_or_else(|| WindowError::NoGround { name: request.name.clone() })?;
        let (wanted_bytes, budget_bytes) = (tile_bytes(root), request.budget.gpu_bytes);
        if wanted_bytes > budget_bytes {
            return Err(WindowError::OverBudget { wanted_bytes, budget_bytes });
        }
        Ok(Self { package, height_range_m: ground.height_range_m, extent })
    }

    /// The package's table of contents.
    pub(crate) fn manifest(&self) -> &Manifest {
        self.package.manifest()
    }

    /// Which tiles there are.
    pub(crate) fn catalog(&self) -> Arc<dyn TileCatalog> {
        Arc::<dyn MapPackage>::clone(&self.package)
    }

    /// The true heights between which all ground lies.
    pub(crate) fn height_range_m(&self) -> [f64; 2] {
        self.height_range_m
    }

    /// What the first view shows.
    pub(crate) fn extent(&self) -> MapExtent {
        self.extent
    }

    /// World height of one metre of true height.
    pub(crate) fn vertical_scale(&self, exaggeration: f64) -> f64 {
        exaggeration * self.manifest().point_scale
    }
}

/// Refuses numbers that make no sense.
fn check_numbers(request: &WindowRequest) -> Result<(), WindowError> {
    if request.styles.is_empty() {
        return Err(WindowError::NoStyle);
    }
    range::check_ground(request.screen_space_error_px, request.cell_px, request.exaggeration)?;
    if let Some(samples) = request.samples_per_side {
        range::check_supersampling(samples)?;
    }
    let [width, height] = request.size_px;
    let least = f64::from(width.min(height));
    range::within("a window's side", least, 1.0..=f64::MAX, "at least 1 pixel")?;
    range::check_camera(request.camera)?;
    let pitch_deg = request.camera.orientation().pitch_deg;
    range::within("a pitch", pitch_deg, 0.0..=MAX_PITCH_DEG, "0 (straight down) to 85")?;
    Ok(())
}
