//! A ray hits the nearest triangle and does not pass through any edge.

use corniche_geom::TileId;
use proptest::prelude::*;

use super::*;
use crate::{
    lod::GroundSummary,
    tiles::{DeckLine, DeckPieces, GroundMesh, GroundVertex, TileGeometry, TileLayer},
};

/// A tile of 100 m around (`x`, `y`): a grid of 11 × 11 nodes, whose heights `height_m` gives.
fn tile(x: f64, y: f64, height_m: impl Fn(f64, f64) -> f64) -> TileGeometry {
    let (mut vertices, mut indices) = (Vec::new(), Vec::new());
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for row in 0..11_u32 {
        for column in 0..11_u32 {
            let [dx, dy] = [column, row].map(|step| f64::from(step) * 10.0 - 50.0);
            let z = height_m(x + dx, y + dy);
            (low, high) = (low.min(z), high.max(z));
            vertices.push(GroundVertex {
                position_in_tile: [dx as f32, dy as f32, (z - 500.0) as f32],
                normal_skirt: [0, 0, 127, 0],
            });
            if column < 10 && row < 10 {
                let k = row * 11 + column;
                indices.extend([k, k + 1, k + 11, k + 1, k + 12, k + 11]);
            }
        }
    }
    let summary = GroundSummary { geometric_error_m: 0.0, height_range_m: [low, high] };
    TileGeometry {
        id: TileId::ROOT,
        reference_m: [x, y, 500.0],
        summary: Some(summary),
        ground: GroundMesh::of_surface(vertices, indices.into_iter()),
        shading: None,
        areas: crate::tiles::AreaVolumes::default(),
        points: crate::tiles::PointMarks::default(),
        lines: crate::tiles::LineLayers::default(),
        photo: None,
        roads: TileLayer::default(),
        width_margin_m: 0.0,
        size_m: [100.0; 2],
        most_width_factor: 1.0,
        wide_ways: Vec::new(),
    }
}

#[test]
fn a_plane_is_met_where_its_equation_says() {
    // The ground is z = 480 + 0.3 x. It is drawn with doubled heights: z = 960 + 0.6 x.
    let tiles = [tile(1000.0, 2000.0, |x, _| 480.0 + 0.3 * (x - 1000.0))];
    let check = |eye: DVec3, ray: DVec3, expected_depth: Option<f64>| {
        let hit = ground_at(tiles.iter(), 2.0, eye, ray);
        assert_eq!(hit.is_some(), expected_depth.is_some(), "{eye} {ray}");
        if let (Some(hit), Some(expected)) = (hit, expected_depth) {
            assert!((hit.depth - expected).abs() < 1e-4, "{} {expected}", hit.depth);
            assert!(hit.at_in_world.distance(eye + ray * expected) < 1e-3);
        }
    };
    check(DVec3::new(1010.0, 2003.0, 1200.0), DVec3::NEG_Z, Some(1200.0 - 966.0));
    check(DVec3::new(1010.0, 2003.0, 1200.0), DVec3::new(0.0, 0.0, -10.0), Some(23.4));
    // The eye looks up from below the ground.
    check(DVec3::new(1010.0, 2003.0, 900.0), DVec3::Z, Some(66.0));
    // The eye looks away from the ground, and then down next to it.
    check(DVec3::new(1010.0, 2003.0, 1200.0), DVec3::Z, None);
    check(DVec3::new(1060.0, 2003.0, 1200.0), DVec3::NEG_Z, None);
    // The eye looks down obliquely: 1000 − t = 960 + 0.6 (t − 40) at x = 960 + t.
    check(DVec3::new(960.0, 2003.0, 1000.0), DVec3::new(1.0, 0.0, -1.0), Some(40.0));
}

#[test]
fn the_nearer_of_two_tiles_is_met_whatever_their_order() {
    let near = tile(0.0, 0.0, |_, _| 514.0);
    let far = tile(100.0, 0.0, |_, _| 500.0);
    let eye = DVec3::new(-10.0, 0.0, 530.0);
    let ray = DVec3::new(10.0, 0.0, -8.0);
    // The ray hits the near tile after two steps. It would reach the height of the far tile after
    // six.
    for tiles in [[&near, &far], [&far, &near]] {
        let hit = ground_at(tiles.into_iter(), 1.0, eye, ray).unwrap();
        assert!((hit.depth - 2.0).abs() < 1e-6);
    }
    // A flatter ray passes over the edge of the near tile and hits the far one: 30 m down at 0.25 m
    // per metre.
    let hit = ground_at([&near, &far].into_iter(), 1.0, eye, DVec3::new(10.0, 0.0, -2.5)).unwrap();
    assert!((hit.at_in_world.x - 110.0).abs() < 1e-6 && (hit.at_in_world.z - 500.0).abs() < 1e-6);
}

/// A deck 20 m above the ground, from (−40, 0) to (40, 0), drawn with doubled heights.
#[test]
fn a_bridge_is_met_before_the_ground_beneath() {
    let ground = tile(0.0, 0.0, |_, _| 500.0);
    let deck = DeckLine {
        way_id: 1,
        kind: crate::tiles::RoadKind::plain(corniche_roads::FunctionalRoadClass::new(3).unwrap()),
        is_road: true,
        points_m: vec![[-40.0, 0.0, 520.0], [40.0, 0.0, 520.0]],
        on_ground: [false; 2],
    };
    let decks = DeckPieces::of_decks(
        &[deck],
        &crate::tiles::GroundNet::default(),
        (ground.plan_bounds(), ground.reference_m),
        &crate::tiles::PlanScale::default(),
        &corniche_geom::StepBudget::unlimited(),
    );
    let summary = ground.summary.map(|of| GroundSummary { height_range_m: [500.0, 520.0], ..of });
    let roads = TileLayer { decks, ..TileLayer::default() };
    let tiles = [TileGeometry { summary, roads, ..ground }];
    let met_m = |x: f64, y: f64, ray: DVec3| {
        ground_at(tiles.iter(), 2.0, DVec3::new(x, y, 1200.0), ray).map(|hit| hit.at_in_world.z)
    };
    assert_eq!(met_m(0.0, 4.9, DVec3::NEG_Z), Some(1040.0));
    assert_eq!(met_m(0.0, 5.1, DVec3::NEG_Z), Some(1000.0), "beside it");
    assert_eq!(met_m(41.0, 0.0, DVec3::NEG_Z), Some(1000.0), "beyond it");
    assert_eq!(met_m(-60.0, 0.0, DVec3::new(0.5, 0.0, -1.0)), Some(1040.0), "obliquely");
}

proptest! {
    /// A ray down on a tile always hits a triangle, even exactly on an edge or a corner of
    /// triangles.
    #[test]
    fn no_ray_slips_through(x in -50.0..50.0_f64, y in -50.0..50.0_f64, on_grid in 0..3_u8, slant in -0.5..0.5_f64) {
        let tiles = [tile(0.0, 0.0, |x, y| 500.0 + (x / 7.0).sin() * 9.0 + (y / 5.0).cos() * 6.0)];
        let snap = |value: f64, wanted: bool| if wanted { (value / 10.0).round() * 10.0 } else { value };
        let target = DVec3::new(snap(x, on_grid > 0) * 0.999_999, snap(y, on_grid > 1) * 0.999_999, 500.0);
        // The ray starts 100 m above the target, which is at 500 m, and stays over the tile.
        let ray = DVec3::new(slant * -target.x.signum(), slant * -target.y.signum(), -1.0) * 0.2;
        let eye = target - ray * 500.0;
        prop_assume!((target + ray * 80.0).truncate().abs().max_element() < 50.0);
        prop_assume!((target - ray * 80.0).truncate().abs().max_element() < 50.0);
        prop_assert!(ground_at(tiles.iter(), 1.0, eye, ray).is_some());
    }

    /// For any ray and any ground, the hit is the nearest among all triangles.
    #[test]
    fn the_grid_of_triangles_finds_what_a_look_at_all_triangles_finds(
        eye in prop::array::uniform3(-90.0..90.0_f64),
        target in prop::array::uniform3(-55.0..55.0_f64),
        level in 0..3_u8,
        vertical_scale in 0.2..4.0_f64,
    ) {
        let tile = tile(0.0, 0.0, |x, y| 500.0 + (x / 7.0).sin() * 9.0 + (y / 5.0).cos() * 6.0);
        let flat = |value: f64, of: u8| if level == of { 0.0 } else { value };
        let target = DVec3::new(target[0], target[1], target[2] / 4.0);
        let eye = DVec3::from(eye);
        // Some rays run along the columns, some are level, some do neither.
        let way = DVec3::new(flat(target.x - eye.x, 1), target.y - eye.y, flat(target.z - eye.z, 2));
        let reference = DVec3::new(0.0, 0.0, 500.0 * vertical_scale);
        let found = ground_at(std::iter::once(&tile), vertical_scale, eye + reference, way);
        let ray = Ray { eye, way, enters: 0.0, leaves: f64::INFINITY };
        let all = (0..tile.ground.surface_indices as u32 / 3).filter_map(|triangle| {
            ray.hit(tile.ground.corners(triangle).map(|[x, y, z]| DVec3::new(x, y, z * vertical_scale)))
        });
        let expected = all.reduce(f64::min);
        // The two depths are rounded differently, because one was computed in world space.
        let is_same = match (found, expected) {
            (Some(found), Some(expected)) => (found.depth - expected).abs() < 1e-9,
            (None, None) => true,
            _ => false,
        };
        prop_assert!(is_same, "{found:?} {expected:?}");
    }
}
