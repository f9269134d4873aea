//! Each point is in one tile of each level that shows it, beside its own place by at most half a
//! step.

use corniche_geom::{GridFrame, LatticeBounds, NodeIndex};
use corniche_presets::parse_layer_table;
use corniche_spec::data_tiles::DataTiles;
use proptest::prelude::*;

use super::*;

/// Three levels of tiles with cells of 10, 20 and 40 m.
fn frame() -> GridFrame {
    GridFrame::new([0.0, 0.0], 10.0, NodeIndex { i: -512, j: 512 }, 2).unwrap()
}

const TABLE: &str = r#"
id = "trees"
geometry = "point"
[[class]]
id = "old"
tags = { natural = "tree", denotation = "landmark" }
[[class]]
id = "any"
scale = 40000
tags = { natural = "tree" }
"#;

proptest! {
    #[test]
    fn a_point_is_in_one_tile_of_each_level(
        // Metres; every other point is on a line between tiles.
        place in [-5200_i64..5200, -5200_i64..5200],
        is_on_line in any::<bool>(),
    ) {
        let (frame, table) = (frame(), parse_layer_table(TABLE).unwrap());
        let [south_west, north_east] = [[-512, -512], [511, 511]].map(|[i, j]| NodeIndex { i, j });
        let data = DataTiles::between(&frame, south_west, north_east);
        let plan = PlanSplitting { table: &table, frame: &frame, data, clip: None, polygon: None };
        let splitting = PointSplitting { plan };
        let metre = (1.0 / frame.lattice_step_m()) as i64;
        let [u, v] = place.map(|along| along * metre);
        let middle = frame.tile_lattice_bounds(TileId::new(1, 0, 0).unwrap()).max.u;
        let at = LatticePoint::new(if is_on_line { middle } else { u }, v);
        let root = frame.tile_lattice_bounds(TileId::ROOT);
        let found = splitting.split(0, at);
        let half = |level| splitting.plan.step(level) / 2;
        if root.expanded(-half(0)).contains(at) {
            let levels: Vec<u8> = found.iter().map(|(id, _)| id.z()).collect();
            prop_assert_eq!(levels, [0, 1, 2]);
        }
        for (id, on_level) in &found {
            let (step, half) = (splitting.plan.step(id.z()), half(id.z()));
            prop_assert!(frame.tile_lattice_bounds(*id).contains(*on_level));
            prop_assert!(on_level.u % step == 0 && on_level.v % step == 0);
            prop_assert!((on_level.u - at.u).abs() <= half && (on_level.v - at.v).abs() <= half);
            // The neighbour in the east or south has the points of the border.
            let bounds = frame.tile_lattice_bounds(*id);
            prop_assert!(on_level.u < bounds.max.u || bounds.max.u == root.max.u);
            prop_assert!(on_level.v > bounds.min.v || bounds.min.v == root.min.v);
        }
        // Cells of 21 m are two pixels at 1:40 000.
        prop_assert!(splitting.split(1, at).iter().all(|(id, _)| id.z() > 0));
    }
}

#[test]
fn points_outside_the_bounds_are_in_no_tile() {
    let (frame, table) = (frame(), parse_layer_table(TABLE).unwrap());
    let data =
        DataTiles::between(&frame, NodeIndex { i: -512, j: -512 }, NodeIndex { i: 511, j: 511 });
    let clip =
        Some(LatticeBounds::around(&[LatticePoint::new(0, 0), LatticePoint::new(9, 9)])).flatten();
    let plan = PlanSplitting { table: &table, frame: &frame, data, clip, polygon: None };
    let splitting = PointSplitting { plan };
    assert_eq!(splitting.split(0, LatticePoint::new(9, 0)).len(), 3);
    assert_eq!(splitting.split(0, LatticePoint::new(10, 0)), []);
}
