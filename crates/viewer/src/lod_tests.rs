//! Tiles are refined by their errors and cells, as closed forms predict.

use std::collections::BTreeSet;

use glam::DVec3;
use proptest::prelude::*;

use super::*;
use crate::camera::Orientation;

const SIDE_M: f64 = 64_000.0;
const MAX_LEVEL: u8 = 5;
const QUALITY: Quality = Quality::by_error(2.0, 1.0);

/// A complete quadtree over a square, of which some tiles are loaded.
struct Square {
    loaded: Option<BTreeSet<TileId>>,
}

impl TileTree for Square {
    fn node(&self, id: TileId) -> TreeNode {
        let error_m = 10.0 * f64::from(1_u32 << (MAX_LEVEL - id.z()));
        match &self.loaded {
            Some(loaded) if !loaded.contains(&id) => TreeNode::Listed,
            _ => TreeNode::Loaded(Some(GroundSummary {
                geometric_error_m: error_m,
                height_range_m: [0.0, 900.0],
            })),
        }
    }

    fn plan_bounds(&self, id: TileId) -> Bounds {
        let side_m = SIDE_M / f64::from(1_u32 << id.z());
        let (min_x, max_y) = (f64::from(id.x()) * side_m, SIDE_M - f64::from(id.y()) * side_m);
        Bounds { min_x, min_y: max_y - side_m, max_x: min_x + side_m, max_y }
    }

    fn max_level(&self) -> u8 {
        MAX_LEVEL
    }
}

/// The square with a different error for each tile, as in real ground; the error of a tile is still
/// above the errors of its children.
struct Rough(Square);

impl Rough {
    fn error_m(id: TileId) -> f64 {
        let share = (7 * id.x() + 13 * id.y()) % 10;
        10.0 * f64::from(1_u32 << (MAX_LEVEL - id.z())) * (1.0 + f64::from(share) / 11.0)
    }
}

impl TileTree for Rough {
    fn node(&self, id: TileId) -> TreeNode {
        let of_tile = |ground| GroundSummary { geometric_error_m: Self::error_m(id), ..ground };
        match self.0.node(id) {
            TreeNode::Loaded(ground) => TreeNode::Loaded(ground.map(of_tile)),
            other => other,
        }
    }

    fn plan_bounds(&self, id: TileId) -> Bounds {
        self.0.plan_bounds(id)
    }

    fn max_level(&self) -> u8 {
        self.0.max_level()
    }
}

fn camera(x: f64, y: f64, distance_m: f64, heading_deg: f64, pitch_deg: f64) -> Camera {
    let target = DVec3::new(x, y, 100.0);
    Camera::look_at(target, distance_m, Orientation { heading_deg, pitch_deg }, [800, 600])
}

fn ids(selection: &Selection) -> BTreeSet<TileId> {
    selection.drawn.iter().map(|drawn| drawn.id).collect()
}

fn overlap(a: TileId, b: TileId) -> bool {
    a != b && (a.z() <= b.z() && b.ancestor(a.z()) == a || b.z() <= a.z() && a.ancestor(b.z()) == b)
}

#[test]
fn an_unknown_root_is_asked_for_and_nothing_is_drawn() {
    let selection = select(
        &Square { loaded: Some(BTreeSet::new()) },
        &camera(3e4, 3e4, 1e4, 0.0, 0.0),
        QUALITY,
    );
    assert!(selection.drawn.is_empty());
    assert_eq!(selection.requests.len(), 1);
    assert_eq!(selection.requests[0].id, TileId::ROOT);
}

#[test]
fn from_very_far_the_root_is_enough() {
    let selection = select(&Square { loaded: None }, &camera(3.2e4, 3.2e4, 1e8, 0.0, 0.0), QUALITY);
    assert_eq!(ids(&selection), BTreeSet::from([TileId::ROOT]));
    assert!(selection.drawn[0].skirt_depth_m.abs() < 1e-12, "no neighbours");
}

#[test]
fn exaggeration_refines() {
    let (tree, camera) = (Square { loaded: None }, camera(3.2e4, 3.2e4, 2e5, 0.0, 0.0));
    let flat = select(&tree, &camera, QUALITY);
    let steep = select(&tree, &camera, Quality { vertical_scale: 8.0, ..QUALITY });
    let level = |selection: &Selection| selection.drawn.iter().map(|drawn| drawn.id.z()).max();
    assert!(level(&steep) > level(&flat));
}

#[test]
fn screen_space_error_follows_its_closed_form() {
    let camera = camera(0.0, 0.0, 100.0, 0.0, 0.0);
    let expected = 3.0 * 600.0 / (2.0 * 500.0 * (crate::camera::FOV_Y_RAD / 2.0).tan());
    assert!((screen_space_error_px(3.0, 500.0, &camera) - expected).abs() < 1e-9);
    assert!(screen_space_error_px(3.0, 0.0, &camera).is_infinite());
}

#[test]
fn the_cell_of_a_tile_follows_its_closed_form() {
    let camera = camera(0.0, 0.0, 100.0, 0.0, 0.0);
    let plan = Bounds { min_x: 0.0, min_y: 0.0, max_x: 2560.0, max_y: 5120.0 };
    // The longer side: 20 m, 500 m away.
    let expected = 20.0 * 600.0 / (2.0 * 500.0 * (crate::camera::FOV_Y_RAD / 2.0).tan());
    assert!((cell_side_px(plan, 500.0, &camera) - expected).abs() < 1e-9);
    assert!(cell_side_px(plan, 0.0, &camera).is_infinite());
}

/// A square whose tiles have no error, as on a lake.
struct Flat(Square);

impl TileTree for Flat {
    fn node(&self, id: TileId) -> TreeNode {
        match self.0.node(id) {
            TreeNode::Loaded(Some(ground)) => {
                TreeNode::Loaded(Some(GroundSummary { geometric_error_m: 0.0, ..ground }))
            }
            other => other,
        }
    }

    fn plan_bounds(&self, id: TileId) -> Bounds {
        self.0.plan_bounds(id)
    }

    fn max_level(&self) -> u8 {
        self.0.max_level()
    }
}

#[test]
fn flat_ground_is_refined_by_its_cells_alone() {
    let (tree, camera) = (Flat(Square { loaded: None }), camera(3.1e4, 3.1e4, 2e4, 0.0, 0.0));
    let finest = |cell_px| {
        let selection = select(&tree, &camera, Quality { cell_px, ..QUALITY });
        selection.drawn.iter().map(|drawn| drawn.id.z()).max()
    };
    assert_eq!(finest(f64::INFINITY), Some(0));
    // A pixel shows 27 m of the nearest ground, and a cell of level z has 250 / 2^z m.
    assert_eq!([16.0, 8.0, 4.0, 2.0, 1.0].map(finest), [0, 1, 2, 3, 4].map(Some));
}

fn any_camera() -> impl Strategy<Value = Camera> {
    (0.0..SIDE_M, 0.0..SIDE_M, 500.0..80_000.0_f64, 0.0..360.0_f64, 0.0..80.0_f64).prop_map(
        |(x, y, distance_m, heading_deg, pitch_deg)| {
            camera(x, y, distance_m, heading_deg, pitch_deg)
        },
    )
}

/// The root and any tiles whose ancestors are all loaded, as a loader would leave them.
fn any_loaded() -> impl Strategy<Value = BTreeSet<TileId>> {
    prop::collection::vec(any::<u8>(), 1365).prop_map(|dice| {
        let mut loaded = BTreeSet::from([TileId::ROOT]);
        let mut todo = vec![TileId::ROOT];
        let mut dice = dice.into_iter();
        while let Some(id) = todo.pop() {
            for child in id.children().filter(|child| child.z() <= MAX_LEVEL) {
                if dice.next().is_some_and(|die| die < 190) {
                    loaded.insert(child);
                    todo.push(child);
                }
            }
        }
        loaded
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Nothing is drawn twice, whatever is loaded.
    #[test]
    fn drawn_tiles_do_not_overlap(camera in any_camera(), loaded in any_loaded()) {
        let drawn = ids(&select(&Square { loaded: Some(loaded) }, &camera, QUALITY));
        for a in &drawn {
            prop_assert!(drawn.iter().all(|b| !overlap(*a, *b)), "{a} overlaps another");
        }
    }

    /// Every point of the ground in view lies in a drawn tile, whatever is loaded.
    #[test]
    fn drawn_tiles_cover_what_is_in_view(
        camera in any_camera(), loaded in any_loaded(), x in 0.0..SIDE_M, y in 0.0..SIDE_M, z in 0.0..900.0_f64,
    ) {
        let tree = Square { loaded: Some(loaded) };
        let visible = camera.project(DVec3::new(x, y, z)).is_some_and(|(at, _)| {
            (0.0..800.0).contains(&at.x) && (0.0..600.0).contains(&at.y)
        });
        if visible {
            let drawn = ids(&select(&tree, &camera, QUALITY));
            let holds = |id: &TileId| {
                let bounds = tree.plan_bounds(*id);
                (bounds.min_x..=bounds.max_x).contains(&x) && (bounds.min_y..=bounds.max_y).contains(&y)
            };
            prop_assert!(drawn.iter().any(holds));
        }
    }

    /// Every drawn tile is fine enough, or the tiles that would replace it are not loaded. Every
    /// refined tile was too coarse.
    #[test]
    fn errors_decide(camera in any_camera()) {
        let tree = Square { loaded: None };
        let selection = select(&tree, &camera, QUALITY);
        prop_assert!(selection.requests.is_empty());
        let error_px = |id: TileId| {
            let TreeNode::Loaded(Some(ground)) = tree.node(id) else { unreachable!() };
            let distance_m =
                WorldBox::new(tree.plan_bounds(id), ground.height_range_m).distance_m(camera.eye_in_world);
            screen_space_error_px(ground.geometric_error_m, distance_m, &camera)
        };
        for id in ids(&selection) {
            prop_assert!(id.z() == MAX_LEVEL || error_px(id) <= 2.0);
            for z in 0..id.z() {
                prop_assert!(error_px(id.ancestor(z)) > 2.0);
            }
        }
    }

    /// A tile is refined exactly if its error or its cell looks too large.
    #[test]
    fn errors_and_cells_decide(camera in any_camera(), cell_px in 0.5..16.0_f64) {
        let tree = Square { loaded: None };
        let selection = select(&tree, &camera, Quality { cell_px, ..QUALITY });
        let is_fine = |id: TileId| {
            let TreeNode::Loaded(Some(ground)) = tree.node(id) else { unreachable!() };
            let plan = tree.plan_bounds(id);
            let distance_m =
                WorldBox::new(plan, ground.height_range_m).distance_m(camera.eye_in_world);
            screen_space_error_px(ground.geometric_error_m, distance_m, &camera) <= 2.0
                && cell_side_px(plan, distance_m, &camera) <= cell_px
        };
        for id in ids(&selection) {
            prop_assert!(id.z() == MAX_LEVEL || is_fine(id));
            for z in 0..id.z() {
                prop_assert!(!is_fine(id.ancestor(z)));
            }
        }
    }

    /// If every requested tile is loaded, requests end, and the selection is that of a fully loaded
    /// tree.
    #[test]
    fn loading_what_is_asked_for_converges(camera in any_camera()) {
        let mut loaded = BTreeSet::new();
        loop {
            let selection = select(&Square { loaded: Some(loaded.clone()) }, &camera, QUALITY);
            if selection.requests.is_empty() {
                prop_assert_eq!(selection, select(&Square { loaded: None }, &camera, QUALITY));
                break;
            }
            for request in selection.requests {
                prop_assert!(loaded.insert(request.id), "{} requested twice", request.id);
            }
        }
    }

    /// Skirts between levels are as deep as both errors together, on both sides.
    #[test]
    fn skirts_cover_both_errors(camera in any_camera()) {
        let tree = Rough(Square { loaded: None });
        let selection = select(&tree, &camera, QUALITY);
        for a in &selection.drawn {
            for b in selection.drawn.iter().filter(|b| b.id.z() < a.id.z()) {
                let (inner, outer) = (tree.plan_bounds(a.id), tree.plan_bounds(b.id));
                let shared = [
                    inner.max_x.min(outer.max_x) - inner.min_x.max(outer.min_x),
                    inner.max_y.min(outer.max_y) - inner.min_y.max(outer.min_y),
                ];
                // They share a part of their borders, not only a corner.
                if shared[0] >= 0.0 && shared[1] >= 0.0 && shared[0] + shared[1] > 0.0 {
                    let gap_m = Rough::error_m(a.id) + Rough::error_m(b.id);
                    prop_assert!(a.skirt_depth_m >= gap_m && b.skirt_depth_m >= gap_m);
                }
            }
        }
    }
}
