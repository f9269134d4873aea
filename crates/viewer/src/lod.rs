//! Which tiles to draw and which to request: a pure function of the tile tree and the camera.
//!
//! Refinement by replacement: a tile is drawn, or its children are, never both. A parent stays
//! until every child that can be in view is loaded, so there is never a hole.
//!
//! Three rules refine a tile. Its *error* must look small, or the shape of the ground is wrong. Its
//! *cell*, a 256th of its side, must look small even on flat ground: data that a tile stores by
//! cells (relief, photo) and by level (which classes of roads) is as fine as its cells, and would
//! be blurred or missing otherwise. And the tile must have all roads that the picture shows there
//! ([`LevelScales`]); with the usual settings a tile with small cells has them.
//!
//! Source: Cozzi & Ring, *3D Engine Design for Virtual Globes* (2011), ch. 12.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

use corniche_geom::{Bounds, TILE_CELLS, TileId};
use corniche_roads::Structure;
use corniche_styles::Style;
use corniche_tileset::{Manifest, SpanHeight, SpanRun};

use crate::{
    camera::{Camera, WorldBox},
    class_scale::LevelScales,
    options::RoadOptions,
};

/// Geometric error and heights of a tile's ground.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct GroundSummary {
    /// Error of drawing this tile instead of the full-resolution DEM; never below the errors of its
    /// children.
    pub geometric_error_m: f64,
    /// Lowest and highest ground in the tile, children included; the highest bridge of the tile
    /// counts, too.
    pub height_range_m: [f64; 2],
}

impl GroundSummary {
    /// Extends the heights by the heights of the tile's bridges.
    pub(crate) fn with_bridges(self, spans: &[SpanRun], quantum_m: f64) -> Self {
        let bridges = spans.iter().filter(|run| run.structure == Structure::Bridge);
        let steps = bridges.flat_map(|run| &run.points).filter_map(|point| match point.height {
            SpanHeight::Steps(steps) => Some(steps),
            SpanHeight::Ground { .. } => None,
        });
        let [low_m, high_m] = self.height_range_m;
        let highest_m = steps.max().map_or(high_m, |steps| high_m.max(steps as f64 * quantum_m));
        Self { height_range_m: [low_m, highest_m], ..self }
    }
}

/// State of a tile in the tile tree.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TreeNode {
    /// Neither the tile nor any descendant exists.
    Absent,
    /// The tile or a descendant exists and is not loaded.
    Listed,
    /// The tile is loaded. `None` if it has no ground itself, though its children may have some.
    Loaded(Option<GroundSummary>),
}

/// The tile tree of a package, as far as it is loaded.
pub trait TileTree {
    /// State of a tile.
    fn node(&self, id: TileId) -> TreeNode;
    /// Plan rectangle of a tile in the working CRS.
    fn plan_bounds(&self, id: TileId) -> Bounds;
    /// The finest level.
    fn max_level(&self) -> u8;
}

/// Limits that decide how fine to draw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quality {
    /// A tile is refined while its error looks larger than this, in pixels.
    pub screen_space_error_px: f64,
    /// A tile is refined while its cell looks larger than this, in pixels, at its nearest point.
    /// Infinity ignores cells.
    pub cell_px: f64,
    /// For each level, how fine pixels may be so that its tiles have all roads that are shown.
    pub scales: LevelScales,
    /// World metres per true metre in plan.
    pub point_scale: f64,
    /// World height of one metre of true height: point scale times exaggeration.
    pub vertical_scale: f64,
}

/// How fine the user wants the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fineness {
    /// A tile is refined while its error looks larger than this, pixels.
    pub screen_space_error_px: f64,
    /// A tile is refined while one of its cells looks larger than this, pixels; may be infinite.
    pub cell_px: f64,
}

impl Quality {
    /// The quality for a package with this manifest, with these roads and with heights multiplied
    /// by `exaggeration`.
    #[must_use]
    pub fn of_package(
        manifest: &Manifest,
        fineness: Fineness,
        style: &Style,
        roads: RoadOptions,
        exaggeration: f64,
    ) -> Self {
        let Fineness { screen_space_error_px, cell_px } = fineness;
        Self {
            screen_space_error_px,
            cell_px,
            scales: LevelScales::of_roads(&manifest.levels, style, roads),
            point_scale: manifest.point_scale,
            vertical_scale: exaggeration * manifest.point_scale,
        }
    }

    /// A quality that refines tiles by their errors alone.
    #[must_use]
    pub const fn by_error(screen_space_error_px: f64, vertical_scale: f64) -> Self {
        Self {
            screen_space_error_px,
            cell_px: f64::INFINITY,
            scales: LevelScales::ANY,
            point_scale: 1.0,
            vertical_scale,
        }
    }
}

/// A tile to draw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrawnTile {
    /// Id of the tile.
    pub id: TileId,
    /// Depth that the skirt of the tile needs to reach the drawn neighbours, true metres, before
    /// exaggeration.
    pub skirt_depth_m: f64,
}

/// A tile to load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Request {
    /// Id of the tile.
    pub id: TileId,
    /// How many times too coarse the tile is that is drawn in its place; infinite for the root.
    pub coarseness: f64,
}

/// The tiles to draw and to load for the next picture.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Selection {
    /// Tiles to draw, in order of id. No two overlap.
    pub drawn: Vec<DrawnTile>,
    /// Tiles to load, most urgent first.
    pub requests: Vec<Request>,
}

/// Screen-space error of a tile, in pixels: how large its geometric error looks from `camera`.
///
/// `distance_m` is the distance from the eye to the nearest point of the tile. At 0 the result is
/// infinite, so the tile that contains the eye is always refined. An error of 0 looks like 0 from
/// anywhere.
///
/// Source: Cozzi & Ring, *3D Engine Design for Virtual Globes* (2011), ch. 12.
#[must_use]
pub fn screen_space_error_px(geometric_error_m: f64, distance_m: f64, camera: &Camera) -> f64 {
    if geometric_error_m <= 0.0 {
        0.0
    } else {
        geometric_error_m / (distance_m * camera.pixel_at_unit_depth_m())
    }
}

/// Maximum size on the picture of a cell of a tile, pixels: the longer side of the cell of a tile
/// that covers `plan`, at `distance_m` from the eye and seen from straight above.
///
/// Both lengths are world metres; `distance_m` is the distance from the eye to the nearest point of
/// the tile. At 0 the result is infinite. A cell that is seen at a slant looks shorter along the
/// line of view, but not across it.
#[must_use]
pub fn cell_side_px(plan: Bounds, distance_m: f64, camera: &Camera) -> f64 {
    let cell_m = plan.width().max(plan.height()) / TILE_CELLS as f64;
    cell_m / (distance_m * camera.pixel_at_unit_depth_m())
}

/// Chooses tiles for `camera`.
#[must_use]
pub fn select(tree: &dyn TileTree, camera: &Camera, quality: Quality) -> Selection {
    let mut walk = Walk {
        tree,
        camera,
        quality,
        frustum: camera.frustum(),
        errors_m: BTreeMap::new(),
        requests: Vec::new(),
    };
    match tree.node(TileId::ROOT) {
        TreeNode::Absent => {}
        TreeNode::Listed => walk.request(TileId::ROOT, f64::INFINITY),
        TreeNode::Loaded(ground) => {
            let range_m =
                ground.map_or([f64::NEG_INFINITY, f64::INFINITY], |ground| ground.height_range_m);
            walk.visit(TileId::ROOT, ground, range_m);
        }
    }
    walk.requests.sort_by(|a, b| b.coarseness.total_cmp(&a.coarseness).then(a.id.cmp(&b.id)));
    let skirts = skirt_depths_m(&walk.errors_m);
    let drawn =
        skirts.into_iter().map(|(id, skirt_depth_m)| DrawnTile { id, skirt_depth_m }).collect();
    Selection { drawn, requests: walk.requests }
}

struct Walk<'a> {
    tree: &'a dyn TileTree,
    camera: &'a Camera,
    quality: Quality,
    frustum: crate::camera::Frustum,
    /// Geometric errors of the tiles to draw.
    errors_m: BTreeMap<TileId, f64>,
    requests: Vec<Request>,
}

impl Walk<'_> {
    /// Draws `id` or its descendants. `range_m` bounds the heights if the tile itself does not.
    fn visit(&mut self, id: TileId, ground: Option<GroundSummary>, range_m: [f64; 2]) {
        let range_m = ground.map_or(range_m, |ground| ground.height_range_m);
        if !self.may_see(id, range_m) {
            return;
        }
        let coarseness =
            ground.map_or(f64::INFINITY, |ground| self.coarseness(id, ground, range_m));
        let too_coarse = coarseness > 1.0 && id.z() < self.tree.max_level();
        let mut children: Vec<(TileId, TreeNode)> = Vec::new();
        if too_coarse {
            children.extend(id.children().map(|child| (child, self.tree.node(child))));
            children.retain(|(_, node)| *node != TreeNode::Absent);
        }
        let is_leaf = children.is_empty();
        // The heights of a child that is not loaded yet are within the range of its parent.
        children.retain(|(child, _)| self.may_see(*child, range_m));
        let missing: Vec<TileId> = children
            .iter()
            .filter(|(_, node)| *node == TreeNode::Listed)
            .map(|(child, _)| *child)
            .collect();
        for id in &missing {
            self.request(*id, coarseness);
        }
        if let Some(ground) = ground
            && (is_leaf || !missing.is_empty())
        {
            self.errors_m.insert(id, ground.geometric_error_m);
            return;
        }
        for (child, node) in children {
            if let TreeNode::Loaded(ground) = node {
                self.visit(child, ground, range_m);
            }
        }
    }

    /// How many times too coarse a tile looks: by its error or its cell, whichever is worse.
    fn coarseness(&self, id: TileId, ground: GroundSummary, range_m: [f64; 2]) -> f64 {
        let Quality { screen_space_error_px: most_error_px, cell_px, vertical_scale, .. } =
            self.quality;
        let world_box = self.world_box(id, range_m);
        let distance_m = self.camera.seeing_distance_of_box_m(&world_box);
        let error_m = ground.geometric_error_m * vertical_scale;
        let by_error = screen_space_error_px(error_m, distance_m, self.camera) / most_error_px;
        // Infinity divided by infinity is NaN, which `max` ignores.
        let by_cell = cell_side_px(self.tree.plan_bounds(id), distance_m, self.camera) / cell_px;
        let pixel_m = distance_m * self.camera.pixel_at_unit_depth_m() / self.quality.point_scale;
        // If no roads are missing, 0 divided by 0 is NaN, too.
        let by_roads = self.quality.scales.least_pixel_m(id.z()) / pixel_m;
        by_error.max(by_cell).max(by_roads)
    }

    fn request(&mut self, id: TileId, coarseness: f64) {
        self.requests.push(Request { id, coarseness });
    }

    fn world_box(&self, id: TileId, range_m: [f64; 2]) -> WorldBox {
        WorldBox::new(
            self.tree.plan_bounds(id),
            range_m.map(|height_m| height_m * self.quality.vertical_scale),
        )
    }

    fn may_see(&self, id: TileId, range_m: [f64; 2]) -> bool {
        // Without a range of heights it is unknown whether the tile is in view: it counts as in
        // view.
        range_m.iter().any(|height_m| height_m.is_infinite())
            || self.frustum.may_see(&self.world_box(id, range_m))
    }
}

/// How deep each drawn tile's skirt must be so that no crack shows.
///
/// Along a border between different levels both TINs are within their own error of the DEM, and so
/// within the sum of both errors of each other. Tiles of one level share their border vertices and
/// need no skirt there.
fn skirt_depths_m(errors_m: &BTreeMap<TileId, f64>) -> BTreeMap<TileId, f64> {
    let mut depths_m: BTreeMap<TileId, f64> = errors_m.keys().map(|&id| (id, 0.0)).collect();
    let mut deepen = |id: TileId, depth_m: f64| {
        depths_m.entry(id).and_modify(|known| *known = f64::max(*known, depth_m));
    };
    for (&id, &error_m) in errors_m {
        // Each pair of neighbours of different levels is found once, from its finer side.
        for (dx, dy) in [(1, 0), (-1, 0), (0, 1), (0, -1)] {
            let Some(beside) = id.neighbour(dx, dy) else { continue };
            let coarser =
                (0..id.z()).rev().map(|z| beside.ancestor(z)).find(|id| errors_m.contains_key(id));
            if let Some(coarser) = coarser {
                let gap_m = error_m + errors_m[&coarser];
                deepen(id, gap_m);
                deepen(coarser, gap_m);
            }
        }
    }
    depths_m
}

#[cfg(test)]
#[path = "lod_tests.rs"]
mod tests;
