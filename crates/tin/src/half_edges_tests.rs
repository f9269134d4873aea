//! The mesh remains a Delaunay triangulation of its ground, whatever is inserted.

use std::collections::BTreeSet;

use corniche_geom::HeightGrid;
use proptest::prelude::*;
use spade::{DelaunayTriangulation, Triangulation};

use super::*;
use crate::boundary::stretches;
use crate::fixed_mesh::fixed_mesh;
use crate::node::GridNode;
use crate::tile_raster::TileRaster;

fn vertex([column, row]: [u16; 2]) -> TinVertex {
    TinVertex { row, column, height_q: 0 }
}

fn turn(p: TinVertex, q: TinVertex, r: TinVertex) -> i64 {
    let [p, q, r] = [p, q, r].map(|v| [i64::from(v.column), i64::from(v.row)]);
    (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
}

/// A square of two faces, with `last` as the last column and row.
fn square(last: u16) -> HalfEdges {
    let [a, b, c, d] = [[0, 0], [last, 0], [last, last], [0, last]].map(vertex);
    let faces = vec![
        Face::new([a, b, c], [NO_TWIN, NO_TWIN, 4]),
        Face::new([a, c, d], [2, NO_TWIN, NO_TWIN]),
    ];
    HalfEdges::new(faces, usize::from(last) + 1)
}

/// Inserts `at` if it is allowed: not at a vertex, not off the ground, and not on its boundary.
fn insert(mesh: &mut HalfEdges, at: TinVertex) -> bool {
    let sides =
        |face: &Face| [0, 1, 2].map(|k| turn(face.corners[k], face.corners[(k + 1) % 3], at));
    let Some(face) = mesh.faces().iter().position(|face| sides(face).iter().all(|&side| side >= 0))
    else {
        return false;
    };
    let found = mesh.faces()[face];
    let on_boundary = (0..3).any(|k| sides(&found)[k] == 0 && found.twins[k] == NO_TWIN);
    if on_boundary
        || found.corners.iter().any(|corner| [corner.column, corner.row] == [at.column, at.row])
    {
        return false;
    }
    mesh.insert(face as u32, at);
    true
}

/// Checks all invariants of a mesh; returns twice the area that it covers.
fn check(mesh: &HalfEdges) -> i64 {
    let mut double_area = 0;
    for (index, face) in mesh.faces().iter().enumerate() {
        let [a, b, c] = face.corners;
        assert!(turn(a, b, c) > 0, "face {index} is not counter-clockwise");
        double_area += turn(a, b, c);
        for k in 0..3 {
            if face.twins[k] == NO_TWIN {
                continue;
            }
            let (beyond, there) =
                (&mesh.faces()[face.twins[k] as usize / 4], face.twins[k] as usize % 4);
            assert_eq!(beyond.twins[there], 4 * index as u32 + k as u32, "twins name each other");
            let ends = [beyond.corners[(there + 1) % 3], beyond.corners[there]];
            assert_eq!(
                ends,
                [face.corners[k], face.corners[(k + 1) % 3]],
                "an edge has the same ends"
            );
            let apex = beyond.corners[(there + 2) % 3];
            assert!(circle([a, b, c], apex) <= 0, "the circle of face {index} holds {apex:?}");
        }
    }
    double_area
}

/// Whether the circle of a face contains `at` (more than 0), by absolute coordinates in another
/// form of the determinant.
fn circle(corners: [TinVertex; 3], at: TinVertex) -> i128 {
    let rows = [corners[0], corners[1], corners[2], at].map(|v| {
        let (x, y) = (i128::from(v.column), i128::from(v.row));
        [x, y, x * x + y * y]
    });
    let minor = |skip: usize| {
        let [p, q, r] = match skip {
            0 => [rows[1], rows[2], rows[3]],
            1 => [rows[0], rows[2], rows[3]],
            2 => [rows[0], rows[1], rows[3]],
            _ => [rows[0], rows[1], rows[2]],
        };
        p[0] * (q[1] * r[2] - q[2] * r[1]) - p[1] * (q[0] * r[2] - q[2] * r[0])
            + p[2] * (q[0] * r[1] - q[1] * r[0])
    };
    minor(3) - minor(2) + minor(1) - minor(0)
}

/// Returns the corners of all triangles in a canonical order.
fn triangles(corners: impl Iterator<Item = [[u16; 2]; 3]>) -> BTreeSet<[[u16; 2]; 3]> {
    corners
        .map(|mut corners| {
            corners.sort_unstable();
            corners
        })
        .collect()
}

/// Whether there is only one Delaunay triangulation: no edge has four nodes on one circle.
fn is_unique(mesh: &HalfEdges) -> bool {
    mesh.faces().iter().all(|face| {
        face.twins.iter().filter(|&&twin| twin != NO_TWIN).all(|&twin| {
            let beyond = &mesh.faces()[twin as usize / 4];
            circle(face.corners, beyond.corners[(twin as usize % 4 + 2) % 3]) != 0
        })
    })
}

fn node(last: u16) -> impl Strategy<Value = [u16; 2]> {
    (0..=last, 0..=last).prop_map(|(column, row)| [column, row])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Whatever is inserted, in tiles of all sizes: the mesh keeps its invariants and covers the
    /// square, and if only one triangulation is possible, it equals that of spade.
    #[test]
    fn is_the_delaunay_triangulation(
        (last, nodes) in prop_oneof![Just(6_u16), Just(40), Just(1024), Just(32_767), Just(32_768), Just(65_535)]
            .prop_flat_map(|last| (Just(last), prop::collection::vec(node(last), 0..120))),
    ) {
        let mut mesh = square(last);
        let corners = [[0, 0], [last, 0], [last, last], [0, last]];
        let mut oracle = DelaunayTriangulation::<GridNode>::new();
        for [column, row] in corners {
            oracle.insert(GridNode::new(column, row)).unwrap();
        }
        for at in nodes {
            if insert(&mut mesh, vertex(at)) {
                oracle.insert(GridNode::new(at[0], at[1])).unwrap();
                prop_assert!(mesh.star().iter().all(|&face| mesh.faces()[face as usize].corners[0] == vertex(at)));
            }
        }
        prop_assert_eq!(check(&mesh), 2 * i64::from(last) * i64::from(last));
        if is_unique(&mesh) {
            let found = triangles(mesh.faces().iter().map(|face| face.corners.map(|v| [v.column, v.row])));
            let wanted = triangles(oracle.inner_faces().map(|face| {
                face.vertices().map(|v| [v.data().column(), v.data().row()])
            }));
            prop_assert_eq!(found, wanted);
        }
    }

    /// With voids, the boundary does not change, no edge crosses it, and the area does not change.
    #[test]
    fn boundaries_stay(
        gaps in prop::collection::vec((0_usize..6, 0_usize..6), 0..6),
        nodes in prop::collection::vec(node(35), 1..80),
    ) {
        let heights = HeightGrid::from_fn(38, 38, |c, r| if gaps.contains(&(c / 6, r / 6)) { f32::NAN } else { 1.0 });
        let tile = TileRaster::new(&heights, 1.0 / 32.0);
        let mut mesh = fixed_mesh(&tile, &stretches(&tile, 1.0, 1.0 / 32.0)).unwrap();
        let boundary = |mesh: &HalfEdges| -> BTreeSet<_> {
            let faces = mesh.faces().iter();
            faces.flat_map(|face| (0..3).filter(|&k| face.twins[k] == NO_TWIN).map(|k| {
                [face.corners[k], face.corners[(k + 1) % 3]]
            })).collect()
        };
        let before = boundary(&mesh);
        prop_assert_eq!(check(&mesh), 2 * tile.count_ground_cells() as i64);
        for at in nodes {
            insert(&mut mesh, vertex(at));
        }
        prop_assert_eq!(check(&mesh), 2 * tile.count_ground_cells() as i64);
        prop_assert_eq!(boundary(&mesh), before);
    }

    /// The determinant has the same sign as the one computed in wide integers, for nodes that use
    /// 64 bits and for others.
    #[test]
    fn the_circle_is_exact(nodes in prop_oneof![Just(NARROW as u16 - 1), Just(300), Just(65_535)]
        .prop_flat_map(|last| {
            // The ends of the range are common: there the numbers are largest.
            let place = prop_oneof![Just(0_u16), Just(last), 0..=last];
            prop::array::uniform4((place.clone(), place))
        }),
    ) {
        let [a, b, c, at] = nodes.map(|(column, row)| vertex([column, row]));
        let away = [a, b, c].map(|corner| Away::from_corner(corner, at));
        let is_narrow = nodes.iter().all(|&(column, row)| usize::from(column.max(row)) < NARROW);
        for narrow in [false, is_narrow] {
            prop_assert_eq!(holds_origin(away[0], away[1], away[2], narrow), circle([a, b, c], at) > 0);
        }
    }
}

#[test]
fn a_node_on_an_edge_splits_both_faces() {
    let mut mesh = square(8);
    assert!(insert(&mut mesh, vertex([4, 4])));
    assert_eq!((mesh.faces().len(), mesh.star().len()), (4, 4));
    assert_eq!(check(&mesh), 2 * 8 * 8);
    // Then nodes on the edges between these, which have four nodes on a circle.
    for at in [[2, 2], [6, 2], [2, 6], [6, 6]] {
        assert!(insert(&mut mesh, vertex(at)));
        assert_eq!(check(&mesh), 2 * 8 * 8);
    }
    assert_eq!(mesh.faces().len(), 12);
}
