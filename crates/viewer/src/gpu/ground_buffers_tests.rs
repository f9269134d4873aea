//! Edges of the ground are drawn once, and indices are as narrow as possible.

use super::*;

#[test]
fn triangles_that_share_an_edge_have_it_once() {
    assert_eq!(edges(&[0, 1, 2, 2, 1, 3]), [[0, 1], [0, 2], [1, 2], [1, 3], [2, 3]]);
    assert!(edges(&[]).is_empty());
}

/// Returns a flat strip with this many vertices; it has only its first and its last triangle.
fn strip(vertices: u32) -> GroundMesh {
    let vertex =
        |at: u32| GroundVertex { position_in_tile: [at as f32, 0.0, 0.0], normal_skirt: [0; 4] };
    let ends = [0, 1, 2, vertices - 3, vertices - 2, vertices - 1];
    GroundMesh::of_surface((0..vertices).map(vertex).collect(), ends.into_iter())
}

#[test]
fn an_index_takes_two_bytes_as_long_as_the_vertices_allow_it() {
    assert_eq!(index_format(&strip(65_535)), IndexFormat::Uint16);
    assert_eq!(index_format(&strip(65_536)), IndexFormat::Uint32);
}

#[test]
fn indices_are_the_same_in_two_bytes_and_buffers_are_whole_words() {
    let mesh = strip(65_535);
    let bytes = index_bytes(&mesh.indices, IndexFormat::Uint16);
    let back: Vec<u32> =
        bytes.as_chunks().0.iter().map(|at| u32::from(u16::from_ne_bytes(*at))).collect();
    assert_eq!(back, mesh.indices);
    assert_eq!(index_bytes(&[1, 2, 3], IndexFormat::Uint16).len(), 8);
    assert_eq!(GroundBuffers::bytes_of(&mesh), 65_535 * 16 + 12);
}
