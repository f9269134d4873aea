//! The contents of one picture: the tiles of a selection, all loaded, and the pieces of road that
//! connect levels.

mod level_connectors;

use std::collections::BTreeSet;

use corniche_roads::FunctionalRoadClass;

use crate::{
    camera::{Camera, WorldBox},
    class_scale,
    frame_view::FrameView,
    lod::{self, DrawnTile, Quality},
    options::RoadMethod,
    tiles::{LoadTileError, RoadKind, TileGeometry, TileLayer, TileSource, TileStore, WideWay},
};

pub(crate) use self::level_connectors::{BorderTile, LevelConnector, level_connectors};

/// Selects the tiles to draw for `camera`, level by level, and loads them. Of their ancestors only
/// errors, heights and slopes are read; finer tiles are shaded with these slopes.
///
/// # Errors
/// When a tile cannot be read, or `check`, which is called for each tile, fails.
pub fn settle<S: TileSource + Sync + ?Sized, E: From<LoadTileError> + Send>(
    store: &mut TileStore<'_, S>,
    camera: &Camera,
    quality: Quality,
    check: impl Fn() -> Result<(), E>,
) -> Result<Vec<DrawnTile>, E> {
    loop {
        let selection = lod::select(&store.tree(), camera, quality);
        for request in &selection.requests {
            check()?;
            store.pass(request.id)?;
        }
        if selection.requests.is_empty() {
            store.load_drawn(&selection.drawn, check)?;
            return Ok(selection.drawn);
        }
    }
}

/// The tiles to draw with the depths of their skirts. Tiles that are not loaded are omitted.
pub fn draw_list<'a, S: TileSource + ?Sized>(
    store: &'a TileStore<'_, S>,
    drawn: &'a [DrawnTile],
) -> impl Iterator<Item = (&'a TileGeometry, f64)> {
    drawn.iter().filter_map(|drawn| Some((store.get(drawn.id)?, drawn.skirt_depth_m)))
}

/// Whether a road of a tile may be wider on the picture than its margin allows. It is never false
/// if there is such a road, but true for some tiles without one.
#[must_use]
pub fn may_be_clamped(tile: &TileGeometry, view: &FrameView<'_>) -> bool {
    let Some(summary) = tile.summary else { return false };
    let ground = WorldBox::new(
        tile.plan_bounds(),
        summary.height_range_m.map(|m| m * view.vertical_scale()),
    );
    let far_m =
        ground.corners().map(|corner| view.camera.seeing_distance_m(corner)).fold(0.0, f64::max);
    FunctionalRoadClass::all()
        .filter(|class| view.roads.classes.contains(*class))
        .filter_map(|class| Some((class, widest_m(tile, view, class)?)))
        .any(|(class, widest_m)| {
            let road = &view.style.roads[usize::from(class.number())];
            let scaling = view.roads.width_scaling(view.style, road);
            let near_m = f64::from(widest_m) * tile.most_width_factor;
            let grown_m = near_m * scaling.factor(far_m / view.point_scale);
            let limit_m = 2.0
                * far_m
                * class_scale::half_width_limit(road, view.roads.width_growth, view.camera);
            let width_m = grown_m.min(limit_m.max(near_m));
            let pixel_m = view.camera.pixel_at_unit_depth_m() * far_m;
            let least_m = f64::from(road.min_width_px) * pixel_m;
            width_m.max(least_m) / 2.0 > tile.width_margin_m
        })
}

/// The maximum width near the eye of the roads of a class in a tile; `None` if there are none.
fn widest_m(tile: &TileGeometry, view: &FrameView<'_>, class: FunctionalRoadClass) -> Option<f32> {
    let width_m = |kind: RoadKind| view.style.width_m(class, kind.own_width);
    let widest = |kinds: &mut dyn Iterator<Item = RoadKind>| kinds.map(width_m).reduce(f32::max);
    let TileLayer { segments, volumes, decks } = &tile.roads;
    let decks = decks.kinds_of(class);
    match view.roads.method {
        RoadMethod::Geometry => widest(&mut segments.kinds_of(class).chain(decks)),
        RoadMethod::ShadowVolumes => widest(&mut volumes.kinds_of(class).chain(decks)),
        RoadMethod::None => None,
    }
}

/// The number of ways that the style draws narrower than their tags request, because the tags
/// exceed [`OwnWidths::WIDEST_M`](corniche_styles::OwnWidths::WIDEST_M).
#[must_use]
pub fn capped_ways<'a>(tiles: impl Iterator<Item = &'a TileGeometry>, view: &FrameView<'_>) -> u64 {
    let is_capped = |way: &&WideWay| {
        let RoadKind { class, own_width, .. } = way.kind;
        view.roads.classes.contains(class) && view.style.is_capped(own_width)
    };
    let ways = tiles.flat_map(|tile| tile.wide_ways.iter().filter(is_capped));
    let ids: BTreeSet<i64> = ways.map(|way| way.way_id).collect();
    if view.roads.method == RoadMethod::None { 0 } else { ids.len() as u64 }
}
