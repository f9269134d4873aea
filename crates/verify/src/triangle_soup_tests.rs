//! Heights and edges of plain triangles are those of closed forms.

use corniche_testing::Random;
use corniche_tin::TinVertex;

use super::*;

fn roof() -> Tin {
    // A roof: the ridge of height 8 is along column 128, the eaves are at 0.
    let node = |row, column, height_q| TinVertex { row, column, height_q };
    let vertices = vec![
        node(0, 0, 0),
        node(0, 128, 8),
        node(0, 256, 0),
        node(256, 0, 0),
        node(256, 128, 8),
        node(256, 256, 0),
    ];
    Tin::new(vertices, &[[0, 3, 1], [1, 3, 4], [1, 4, 2], [2, 4, 5]]).unwrap()
}

#[test]
fn heights_of_a_roof() {
    let roof = roof();
    let ground = TriangleSoup::new(&roof, 0.5, [1.0; 2]);
    for column in 0..=256_u16 {
        let expected = (128.0 - (f64::from(column) - 128.0).abs()) / 128.0 * 4.0;
        let height_m = ground.height_m([f64::from(column), 37.25]).unwrap();
        assert!((height_m - expected).abs() < 1e-9);
    }
    assert_eq!(ground.height_m([257.0, 3.0]), None);
}

#[test]
fn an_edge_over_the_ridge_is_on_no_triangle_and_one_in_the_air_has_its_gap() {
    let roof = roof();
    let ground = TriangleSoup::new(&roof, 0.5, [1.0; 2]);
    assert_eq!(ground.edge_gap_m([100.0, 10.0, 3.125], [150.0, 10.0, 3.3125]), None);
    let gap_m = ground.edge_gap_m([0.0, 3.0, 0.25], [1.0, 3.0, 4.0 / 128.0]).unwrap();
    assert!((gap_m - 0.25).abs() < 1e-9);
}

#[test]
fn the_range_around_a_segment_holds_the_ridge_only_where_it_reaches_it() {
    let roof = roof();
    // Cells of 3 by 2 steps.
    let ground = TriangleSoup::new(&roof, 0.5, [3.0, 2.0]);
    let along = [[100.0, 10.0], [100.0, 40.0]];
    // 20 cells east: 60 steps.
    let [low_m, high_m] = ground.range_near(along, 60.0, &StepBudget::unlimited()).unwrap();
    assert!((low_m - 80.0 / 32.0).abs() < 1e-9 && (high_m - 120.0 / 32.0).abs() < 1e-9);
    assert_eq!(ground.range_near(along, 90.0, &StepBudget::unlimited()).unwrap()[1], 4.0);
    assert!(
        ground.range_near([[300.0, 0.0], [310.0, 0.0]], 100.0, &StepBudget::unlimited()).is_none()
    );
}

#[test]
fn a_line_meets_ground_where_it_runs_inside_it() {
    let roof = roof();
    let ground = TriangleSoup::new(&roof, 0.5, [1000.0, 1000.0]);
    assert!(ground.meets([[-5.0, 20.0], [3.0, 20.0]], &StepBudget::unlimited()));
    assert!(!ground.meets([[-5.0, 20.0], [0.005, 20.0]], &StepBudget::unlimited()));
    assert!(
        !ground.meets([[0.0, 3.0], [0.0, 200.0]], &StepBudget::unlimited()),
        "along the boundary"
    );
}

#[test]
fn a_raster_has_the_heights_of_its_nodes() {
    let roof = roof();
    let ground = TriangleSoup::new(&roof, 0.5, [1.0; 2]);
    let heights = ground.raster([250.0, 100.0], 0.5, 20);
    for (k, height_m) in heights.into_iter().enumerate() {
        let at = [250.0 + 0.5 * (k % 20) as f64, 100.0 + 0.5 * (k / 20) as f64];
        match ground.height_m(at) {
            Some(expected_m) => assert!((height_m - expected_m).abs() < 1e-9, "{at:?}"),
            None => assert!(height_m.is_nan(), "{at:?}"),
        }
    }
}

/// Every triangle with a corner or its middle in the strip is returned once, and on fine ground
/// only triangles around the segment.
#[test]
fn what_lies_near_a_segment_is_found_once_and_little_else() {
    let mut random = Random::new(38);
    let fine = corniche_testing::package::full_tin();
    for tin in [&fine, &roof()] {
        let ground = TriangleSoup::new(tin, 0.5, [1.0; 2]);
        for _ in 0..60 {
            let mut place = || [0, 1].map(|_| random.below(400) as f64 / 1.25 - 30.0);
            let ends = [place(), place()];
            let reach = [0, 1].map(|_| random.below(9) as f64 / 2.0);
            let given: Vec<*const Corners> = ground
                .near(Strip { ends, reach })
                .flat_map(|(_, triangles)| triangles)
                .map(std::ptr::from_ref)
                .collect();
            let once: std::collections::BTreeSet<_> = given.iter().copied().collect();
            assert_eq!(once.len(), given.len(), "twice near {ends:?}");
            let [a, b] = ends;
            let is_near = |at: [f64; 2]| {
                (0..=2000).any(|k| {
                    let share = f64::from(k) / 2000.0;
                    (0..2).all(|axis| {
                        let on = a[axis] + share * (b[axis] - a[axis]);
                        (at[axis] - on).abs() <= reach[axis]
                    })
                })
            };
            for corners in ground.triangles.iter().step_by(97) {
                let middle = [0, 1].map(|axis| corners.iter().map(|c| c[axis]).sum::<f64>() / 3.0);
                let is_wanted =
                    is_near(middle) || corners.iter().any(|&corner| is_near(flat(corner)));
                assert!(
                    !is_wanted || once.contains(&std::ptr::from_ref(corners)),
                    "{corners:?} near {ends:?}"
                );
            }
            assert!(given.len() < 64 * 9 * 32 + 4, "{} near {ends:?}, {reach:?}", given.len());
        }
    }
}
