//! Long edges are divided without loss of area, and no inner edge is left open.

use corniche_geom::LatticePoint;

use super::{LabelledMesh, SurfaceVertex};

fn square(side: f64) -> LabelledMesh {
    let mut mesh = LabelledMesh::new(LatticePoint::new(0, 0));
    for at in [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]] {
        let height_m = at[0] * 0.5;
        mesh.vertices.push(SurfaceVertex { at, height_m, normal: [0.0, 0.0, 1.0], on_slab: false });
    }
    mesh.add([0, 1, 2], 0);
    mesh.add([0, 2, 3], 7);
    mesh
}

fn area(mesh: &LabelledMesh, label: u32) -> f64 {
    let of = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|k| mesh.vertices[k as usize].at);
        ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0
    };
    let own = mesh.triangles.iter().zip(&mesh.labels).filter(|(_, own)| **own == label);
    own.map(|(corners, _)| {
        assert!(of(corners) > 0.0, "counter-clockwise");
        of(corners)
    })
    .sum()
}

/// No edge stays too long, no area is lost or changes its label, and every inner edge keeps both
/// its triangles.
#[test]
fn long_edges_are_divided() {
    for limit in [90.0, 40.0, 13.0] {
        let mut mesh = square(100.0);
        mesh.split_long_edges(|[x, y]| x.hypot(y) > limit);
        let mut edges = std::collections::HashMap::<[u32; 2], i32>::new();
        for corners in &mesh.triangles {
            for k in 0..3 {
                let (one, other) = (corners[k], corners[(k + 1) % 3]);
                let [from, to] = [one, other].map(|vertex| mesh.vertices[vertex as usize].at);
                assert!((to[0] - from[0]).hypot(to[1] - from[1]) <= limit);
                *edges.entry([one.min(other), one.max(other)]).or_default() += 1;
            }
        }
        let open = edges.values().filter(|count| **count == 1).count();
        assert!(edges.values().all(|count| *count <= 2) && open.is_multiple_of(4), "{open}");
        assert!((area(&mesh, 0) - 5000.0).abs() < 1e-9 && (area(&mesh, 7) - 5000.0).abs() < 1e-9);
        assert!(
            mesh.vertices
                .iter()
                .all(|vertex| { (vertex.height_m - vertex.at[0] * 0.5).abs() < 1e-12 })
        );
    }
}

#[test]
fn vertices_without_triangles_are_dropped() {
    let mut mesh = square(10.0);
    mesh.triangles.pop();
    mesh.labels.pop();
    mesh.drop_unused();
    assert_eq!(mesh.vertices.len(), 3);
    assert!((area(&mesh, 0) - 50.0).abs() < 1e-12);
}
