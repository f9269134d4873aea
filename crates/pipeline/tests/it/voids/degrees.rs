//! Data in degrees in a projected grid: the data end between nodes.

use corniche_testing::check_tin;
use corniche_tin::Tin;

use super::support::{Options, build_files, extract, write_degrees};

/// A square of degrees in a projected grid: its edges run across cells, and nodes are between
/// samples.
#[test]
fn a_square_of_degrees_ends_where_its_samples_end() {
    const SAMPLES: usize = 360;
    const STEP_DEG: f64 = 1.0 / 1200.0;
    let [west_deg, north_deg] = [10.9, 60.2];
    let height_m = |[lon_deg, lat_deg]: [f64; 2]| {
        300.0 + 150.0 * (lon_deg * 90.0).sin() + 150.0 * (lat_deg * 120.0).cos()
    };
    let folder = tempfile::tempdir().unwrap();
    let dem = folder.path().join("square.tif");
    write_degrees(&dem, SAMPLES, [west_deg, north_deg], STEP_DEG, height_m);
    let options = Options { crs: Some("utm"), ..Options::plain(5.0) };
    let built = build_files(&dem, None, options).unwrap();
    let frame = built.frame();
    let mut vertices = 0;
    for (id, ground) in built.grounds() {
        check_tin(&ground.tin);
        let nodes = built.nodes(id, &ground.tin);
        let positions: Vec<[f64; 2]> =
            nodes.iter().map(|node| [frame.x_m(node.i), frame.y_m(node.j)]).collect();
        let degrees = extract::utm_to_degrees(&positions);
        for (vertex, at) in ground.tin.vertices().iter().zip(degrees) {
            let from_edge = [at[0] - west_deg, north_deg - at[1]].map(|deg| deg / STEP_DEG);
            let last = (SAMPLES - 1) as f64;
            // There is no ground beyond the outermost samples; a thousandth of a sample allows for
            // the projection back from the grid.
            assert!(
                from_edge.iter().all(|at| (-1e-3..=last + 1e-3).contains(at)),
                "{id} {from_edge:?}"
            );
            // The height is within the range of the four surrounding samples: a wave of this length
            // bends by less than 1 m between two.
            let off_m = (f64::from(vertex.height_q) * built.quantum_m() - height_m(at)).abs();
            assert!(off_m < 1.0, "{id}: a vertex {off_m} m off at {at:?}");
            vertices += 1;
        }
    }
    assert!(vertices > 1000);
    // The whole square is ground, except for cells that its edge cuts: one cell all around.
    let finest = built.grounds().filter(|(id, _)| id.z() == frame.max_level());
    let doubled: i64 = finest.map(|(_, ground)| doubled_area(&ground.tin)).sum();
    let ground_m2 = doubled as f64 / 2.0 * frame.cell().east_m * frame.cell().north_m;
    let side_m = (SAMPLES - 1) as f64 * STEP_DEG * 111_400.0;
    let square_m2 = side_m * side_m * f64::to_radians(60.05).cos();
    let rim_m2 = 4.0 * side_m * 2.0 * frame.cell().shorter_m();
    assert!(
        (square_m2 - rim_m2..square_m2 * 1.01).contains(&ground_m2),
        "{ground_m2} of {square_m2} m²"
    );
}

/// Twice the area of a TIN in cells of its level.
fn doubled_area(tin: &Tin) -> i64 {
    let at = |vertex: u32| {
        let vertex = tin.vertices()[vertex as usize];
        [i64::from(vertex.column), i64::from(vertex.row)]
    };
    let areas = tin.triangles().iter().map(|corners| {
        let [a, b, c] = corners.map(at);
        ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs()
    });
    areas.sum()
}
