//! Vertices are relative to the reference point, and skirts hang only from the borders.

use corniche_geom::NodeIndex;
use corniche_tin::TinVertex;

use super::*;

/// Two triangles that cover a whole tile with cells of 10 m. The eastern vertices are 256 steps
/// high.
fn square() -> GroundMesh {
    let vertex = |row, column, height_q| TinVertex { row, column, height_q };
    let corners =
        vec![vertex(0, 0, 0), vertex(0, 256, 256), vertex(256, 0, 0), vertex(256, 256, 256)];
    let tin = Tin::new(corners, &[[0, 2, 1], [1, 2, 3]]).unwrap();
    let frame = GridFrame::new([0.0; 2], 10.0, NodeIndex { i: 0, j: 256 }, 0).unwrap();
    GroundMesh::new(TileId::ROOT, &tin, &[[0, 0]; 4], &frame, 0.5, [1280.0, 1280.0, 64.0])
}

#[test]
fn vertices_are_relative_to_the_reference_point() {
    let mesh = square();
    assert_eq!(mesh.vertices[0].position_in_tile, [-1280.0, 1280.0, -64.0], "north-west");
    assert_eq!(mesh.vertices[3].position_in_tile, [1280.0, -1280.0, 64.0], "south-east");
    assert_eq!(mesh.vertices[0].normal_skirt, [0, 0, 127, 0]);
}

#[test]
fn skirts_hang_from_the_four_borders_and_not_from_the_diagonal() {
    let mesh = square();
    assert_eq!(mesh.surface_indices, 6);
    assert_eq!(mesh.indices.len(), 6 + 4 * 6);
    assert_eq!(mesh.vertices.len(), 4 + 4 * 2);
    assert!(mesh.vertices[4..].iter().all(|vertex| vertex.normal_skirt[3] == 127));
}
