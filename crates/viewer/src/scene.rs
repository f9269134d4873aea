//! What one picture shows: the tiles of a selection, all loaded, and the pieces of road that connect levels.

mod level_connectors;

use std::slice;

use corniche_roads::FunctionalRoadClass;

use crate::{
    camera::{Camera, WorldBox},
    frame_view::FrameView,
    lod::{self, Drawn, Quality},
    options::RoadMethod,
    tiles::{LoadTileError, TileGeometry, TileStore},
};

pub(crate) use self::level_connectors::{BorderTile, LevelConnector, level_connectors};

/// Loads what `camera` needs, level by level, until nothing is missing, and says what to draw.
///
/// # Errors
/// When a tile cannot be read, or `is_stopped` returned true.
pub fn settle(
    store: &mut TileStore<'_>,
    camera: &Camera,
    quality: Quality,
    is_stopped: &dyn Fn() -> bool,
) -> Result<Vec<Drawn>, SettleError> {
    loop {
        let selection = lod::select(store, camera, quality);
        if selection.requests.is_empty() {
            return Ok(selection.drawn);
        }
        for request in &selection.requests {
            if is_stopped() {
                return Err(SettleError::Stopped);
            }
            store.load(slice::from_ref(request))?;
        }
    }
}

/// Why the tiles of a view cannot be loaded.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
pub enum SettleError {
    #[error(transparent)]
    Load(#[from] LoadTileError),
    #[error("interrupted")]
    Stopped,
}

/// The tiles to draw with the depths of their skirts. Tiles that are not loaded are left out.
pub fn draw_list<'a>(
    store: &'a TileStore<'_>,
    drawn: &'a [Drawn],
) -> impl Iterator<Item = (&'a TileGeometry, f64)> {
    drawn.iter().filter_map(|drawn| Some((store.get(drawn.id)?, drawn.skirt_depth_m)))
}

/// Whether some road of a tile may be wider on the picture than its margin allows. Never false if one is; true for some
/// tiles without such a road.
#[must_use]
pub fn may_be_clamped(tile: &TileGeometry, view: &FrameView<'_>) -> bool {
    let Some(summary) = tile.summary else { return false };
    let ground = WorldBox::new(
        tile.plan_bounds(),
        summary.height_range_m.map(|m| m * view.vertical_scale()),
    );
    let eye = view.camera.eye_in_world();
    let far_m = ground.corners().map(|corner| corner.distance(eye)).fold(0.0, f64::max);
    let scaling = view.roads.width_scaling(view.style);
    FunctionalRoadClass::all()
        .filter(|class| view.roads.classes.contains(*class))
        .filter(|class| match view.roads.method {
            RoadMethod::Geometry => !tile.roads.range_of(*class).is_empty(),
            RoadMethod::ShadowVolumes => !tile.volumes.range_of(*class).is_empty(),
            RoadMethod::None => false,
        })
        .any(|class| {
            let road = &view.style.roads[usize::from(class.number())];
            let width_m = f64::from(road.width_m)
                * tile.most_width_factor
                * scaling.factor(far_m / view.point_scale);
            let pixel_m = view.camera.pixel_at_unit_depth_m() * far_m;
            let least_m = f64::from(road.min_width_px) * pixel_m;
            width_m.max(least_m) / 2.0 > tile.width_margin_m
        })
}
