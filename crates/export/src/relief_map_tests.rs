//! The directions of the ground can be recovered from the texels of normal maps.

use corniche_geom::LatticePoint;

use super::*;
use crate::surfaces::SurfaceVertex;

fn near(one: [f32; 3], other: [f32; 3]) -> bool {
    one.iter().zip(other).all(|(one, other)| (one - other).abs() < 1e-6)
}

#[test]
fn tangents_point_east_along_the_ground() {
    for normal in [[0.0, 0.0, 1.0], [0.6, 0.0, 0.8], [0.0, -0.6, 0.8], [0.48, 0.6, 0.64]] {
        let along = tangent(normal);
        let dot: f32 = along.iter().zip(normal).map(|(a, b)| a * b).sum();
        assert!(dot.abs() < 1e-6 && along[0] > 0.0, "{normal:?} {along:?}");
        // The other axis has no eastern component: it is north along the ground.
        let aside = cross(normal, along);
        assert!(aside[0].abs() < 1e-6 && aside[1] > 0.0, "{normal:?} {aside:?}");
    }
    // On walls, east has no direction along the ground: the tangent is down or up.
    assert!(near(tangent([1.0, 0.0, 0.0]), [0.0, 0.0, -1.0]));
    assert!(near(tangent([-1.0, 0.0, 0.0]), [0.0, 0.0, 1.0]));
}

/// A program recovers the original direction from a texel.
#[test]
fn directions_come_back() {
    for vertex in [[0.0, 0.0, 1.0], unit([0.3, -0.4, 1.0]), unit([-2.0, 1.0, 1.0])] {
        for direction in [[0.0, 0.0, 1.0], unit([0.5, 0.1, 1.0]), unit([-0.2, -0.9, 1.0])] {
            let along = tangent(vertex);
            let aside = cross(vertex, along);
            let [x, y, z] = seen_from(vertex, direction);
            let back = [0, 1, 2].map(|k| x * along[k] + y * aside[k] + z * vertex[k]);
            assert!(near(back, direction), "{vertex:?} {direction:?} {back:?}");
        }
    }
    assert_eq!(texel([0.0, 0.0, 1.0]), [128, 128, 255]);
    assert_eq!(texel([1e-6, -1e-6, 1.0]), [128, 128, 255]);
    // No texel points into the ground.
    let [x, y, z] = texel(unit([-1.0, 0.0, -1.0]));
    assert!(x <= 1 && y == 128 && z >= 128, "{x} {y} {z}");
}

#[test]
fn nodes_lie_in_the_middle_of_their_texels() {
    let side = SIDE as f32;
    for node in [0.0, 1.0, 128.0, 256.0] {
        let [x, y] = ReliefMap::place([node / 256.0, 1.0 - node / 256.0]);
        assert!((x * side - (node + 0.5)).abs() < 1e-4, "{node}: {x}");
        assert!((y * side - (256.5 - node)).abs() < 1e-4, "{node}: {y}");
    }
}

/// Two triangles over the whole tile, whose corners have different normals: at every node, the
/// interpolation of the three corners around it.
#[test]
fn normals_are_mixed_across_triangles() {
    let side = 1 << 10;
    let bounds = LatticeBounds {
        min: LatticePoint::new(500, -300),
        max: LatticePoint::new(500 + 256 * side, 256 * side - 300),
    };
    let mut mesh = LabelledMesh::new(LatticePoint::new(0, 0));
    let normals = [[0.0, 0.0, 1.0], [0.6, 0.0, 0.8], [0.0, 0.6, 0.8], [0.0, -0.6, 0.8]];
    let corners = [
        [bounds.min.u, bounds.min.v],
        [bounds.max.u, bounds.min.v],
        [bounds.max.u, bounds.max.v],
        [bounds.min.u, bounds.max.v],
    ];
    mesh.vertices = corners
        .into_iter()
        .zip(normals)
        .map(|(at, normal)| SurfaceVertex {
            at: at.map(|axis| axis as f64),
            height_m: 0.0,
            normal,
            on_slab: false,
        })
        .collect();
    mesh.add([0, 1, 2], 0);
    mesh.add([0, 2, 3], 7);
    let mixed = mixed_normals(&bounds, &mesh);
    let at = |column: usize, row: usize| mixed[row * SIDE + column];
    // Row 0 is the north.
    for (k, (column, row)) in [(0, 256), (256, 256), (256, 0), (0, 0)].into_iter().enumerate() {
        assert!(near(at(column, row), normals[k]), "{k}");
    }
    let half = |one: [f32; 3], other: [f32; 3]| unit([0, 1, 2].map(|k| one[k] + other[k]));
    assert!(near(at(128, 256), half(normals[0], normals[1])));
    assert!(near(at(128, 128), half(normals[0], normals[2])));
    assert!(near(at(0, 128), half(normals[0], normals[3])));
    // A quarter, a half and a quarter.
    let inside = unit([0, 1, 2].map(|k| normals[0][k] + 2.0 * normals[1][k] + normals[2][k]));
    assert!(near(at(192, 192), inside));
}

#[test]
fn normals_point_up_where_there_is_no_ground() {
    let bounds = LatticeBounds { min: LatticePoint::new(0, 0), max: LatticePoint::new(2560, 2560) };
    let mesh = LabelledMesh::new(LatticePoint::new(0, 0));
    assert!(mixed_normals(&bounds, &mesh).iter().all(|normal| near(*normal, [0.0, 0.0, 1.0])));
}
