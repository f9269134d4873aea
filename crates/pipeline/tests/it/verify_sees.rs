//! `verify` detects each kind of broken promise: a valid package is taken apart, one thing in it is
//! made invalid, and it is reassembled with matching checksums. Then exactly the expected checks
//! fail.

use std::fs;

use crate::support::{
    Options,
    parts::{Against, LAST_NODE, MAX_ERROR_M, Parts, SOUND, assert_broken, report_on, write},
    settings, write_degrees,
};
use corniche_geom::TileId;
use corniche_pipeline::build;
use corniche_tileset::FilePackage;
use corniche_tin::{NO_TWIN, Tin, TinVertex};
use corniche_verify::{CheckId, VerifySettings, verify};
use corniche_work::Silent;

#[test]
fn no_check_is_broken_when_nothing_was_changed() {
    let parts = Parts::sound();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("same.pmtiles");
    parts.write(&path).unwrap();
    // This shows that the failures in the other tests are caused by their one change.
    assert!(
        fs::read(&path).unwrap() == SOUND.bytes,
        "taking the package apart and reassembling it changes bytes"
    );
    let report = assert_broken(report_on(&path, Against::Dem), &[]);
    assert_eq!(report.tiles, parts.tiles.len() as u64);
    // The package has no photos, layers and spans; `verify_photos.rs`, `verify_layers.rs` and
    // `verify_spans.rs` have some.
    let mut others = report.checks.iter().filter(|check| {
        let id = check.id.id();
        let others =
            ["photo.", "areas.", "lines.", "points.", "layers.", "spans.", "P6.structures"];
        !others.iter().any(|start| id.starts_with(start))
    });
    assert!(others.all(|check| check.checked > 0), "{:#?}", report.checks);
}

#[test]
fn a_stored_error_below_the_true_one() {
    let mut parts = Parts::sound();
    let id = parts.worst_finest();
    parts.terrain_mut(id).geometric_error_m /= 2.0;
    // The manifest's figures no longer match either.
    parts.assert_breaks(Against::Dem, &[CheckId::Bound, CheckId::LevelSums, CheckId::Recorded]);
}

#[test]
fn a_border_vertex_that_the_neighbour_has_elsewhere() {
    let mut parts = Parts::sound();
    let on_border = |vertex: &TinVertex, column| {
        vertex.column == column && (1..LAST_NODE).contains(&vertex.row)
    };
    // A vertex inside an eastern border, so that only one neighbour shares it.
    let (id, east, vertex) = parts
        .tiles_above(0)
        .find_map(|tile| {
            let east = tile.id.neighbour(1, 0)?;
            let theirs = parts.terrain(east)?.tin.vertices();
            let own = tile.terrain.as_ref()?.tin.vertices();
            let vertex = own.iter().position(|vertex| {
                let same = TinVertex { column: 0, ..*vertex };
                on_border(vertex, LAST_NODE) && theirs.contains(&same)
            })?;
            Some((tile.id, east, vertex))
        })
        .unwrap();
    parts.lift(id, vertex, 3);
    let report = parts.assert_breaks(Against::Itself, &[CheckId::Seams]);
    let seams = report.checks.iter().find(|check| check.id == CheckId::Seams).unwrap();
    assert_eq!(seams.broken, 1);
    let named = |id: TileId| seams.examples[0].contains(&id.to_string());
    assert!(named(id) && named(east), "{:?}", seams.examples);
}

#[test]
fn a_child_with_a_larger_error_than_its_parent() {
    let mut parts = Parts::sound();
    let id = parts.worst_finest();
    let parent = id.parent().unwrap();
    let above_m = parts.terrain(parent).unwrap().geometric_error_m;
    parts.terrain_mut(id).geometric_error_m = 2.0 * above_m;
    parts.assert_breaks(Against::Itself, &[CheckId::LevelSums, CheckId::Nested]);
}

#[test]
fn a_child_that_reaches_above_its_parent() {
    let mut parts = Parts::sound();
    let id = parts.worst_finest();
    let top_m = parts.terrain(id.parent().unwrap()).unwrap().height_range_m[1];
    parts.terrain_mut(id).height_range_m[1] = top_m + 1.0;
    parts.assert_breaks(Against::Itself, &[CheckId::Nested]);
}

#[test]
fn sums_that_do_not_add_up() {
    let mut roads = Parts::sound();
    roads.manifest.counts.roads_kept += 1;
    roads.assert_breaks(Against::Itself, &[CheckId::RoadSums]);

    let mut samples = Parts::sound();
    samples.manifest.counts.samples.filled += 1;
    samples.assert_breaks(Against::Itself, &[CheckId::SampleSums]);
}

#[test]
fn a_tile_left_out() {
    let mut parts = Parts::sound();
    let id = parts.finest_without_roads();
    parts.tiles.retain(|tile| tile.id != id);
    parts.assert_breaks(Against::Itself, &[CheckId::LevelSums]);
}

#[test]
fn a_parent_left_out_over_its_children() {
    let mut parts = Parts::sound();
    let parent = parts.worst_finest().parent().unwrap();
    parts.tiles.retain(|tile| tile.id != parent);
    parts.assert_breaks(Against::Itself, &[CheckId::LevelSums, CheckId::Growth]);
}

#[test]
fn a_hole_in_the_ground() {
    let mut parts = Parts::sound();
    let id = parts.finest_without_roads();
    let surface = parts.surface(id);
    let tin = &mut parts.terrain_mut(id).tin;
    let vertices = tin.vertices().to_vec();
    let mut triangles = tin.triangles().to_vec();
    // The largest triangle that is surrounded by others, so that the nodes on its outline keep
    // their ground.
    let (triangle, hole) = triangles
        .iter()
        .map(|corners| corners.map(|corner| vertices[corner as usize]))
        .enumerate()
        .filter(|(k, _)| (3 * k..3 * k + 3).all(|edge| surface.twin(edge as u32) != NO_TWIN))
        .max_by_key(|(_, corners)| doubled_area(corners))
        .unwrap();
    triangles.remove(triangle);
    *tin = Tin::from_canonical(vertices, triangles).unwrap();
    parts.assert_breaks(
        Against::Dem,
        &[CheckId::LevelSums, CheckId::Samples, CheckId::Stray, CheckId::Uncovered],
    );

    // Counting the nodes of the hole as uncovered does not make it valid.
    parts.terrain_mut(id).uncovered_nodes += nodes_inside(&hole);
    parts.assert_breaks(
        Against::Dem,
        &[CheckId::LevelSums, CheckId::Samples, CheckId::Stray, CheckId::Uncovered],
    );
}

/// Twice a triangle's area in cells.
fn doubled_area(corners: &[TinVertex; 3]) -> i64 {
    let [a, b, c] = corners.map(|v| [i64::from(v.column), i64::from(v.row)]);
    ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs()
}

/// Nodes strictly inside a triangle: Pick 1899, area = inside + outline / 2 - 1.
fn nodes_inside(corners: &[TinVertex; 3]) -> u64 {
    let outline: u64 = (0..3)
        .map(|k| {
            let (a, b) = (&corners[k], &corners[(k + 1) % 3]);
            let [mut d, mut e] = [a.column.abs_diff(b.column), a.row.abs_diff(b.row)];
            while e > 0 {
                (d, e) = (e, d % e);
            }
            u64::from(d)
        })
        .sum();
    (doubled_area(corners) as u64 + 2 - outline) / 2
}

#[test]
fn uncovered_nodes_that_are_not_counted() {
    let mut parts = Parts::sound();
    let id = parts
        .tiles_above(0)
        .max_by_key(|tile| tile.terrain.as_ref().map(|terrain| terrain.uncovered_nodes));
    let id = id.unwrap().id;
    let uncovered = &mut parts.terrain_mut(id).uncovered_nodes;
    assert!(*uncovered > 0, "the sample has voids and data edges");
    *uncovered -= 1;
    parts.assert_breaks(Against::Dem, &[CheckId::Uncovered]);
}

#[test]
fn a_finest_tile_off_by_more_than_the_bound() {
    let mut parts = Parts::sound();
    let id = parts.worst_finest();
    let inside = 1..LAST_NODE;
    let vertices = parts.terrain(id).unwrap().tin.vertices();
    let vertex = vertices
        .iter()
        .position(|v| inside.contains(&v.row) && inside.contains(&v.column))
        .unwrap();
    let steps = (3.0 * MAX_ERROR_M / parts.manifest.vertical.quantum_m).ceil() as i32;
    parts.lift(id, vertex, steps);
    parts.assert_breaks(
        Against::Dem,
        &[
            CheckId::Levels,
            CheckId::SvRange,
            CheckId::Bound,
            CheckId::Finest,
            CheckId::Recorded,
            CheckId::Samples,
            CheckId::SampleBound,
            CheckId::Nodes,
        ],
    );

    // Storing the true error does not make the error valid.
    let mut above = Some(id);
    while let Some(ancestor) = above {
        let stored_m = &mut parts.terrain_mut(ancestor).geometric_error_m;
        *stored_m = stored_m.max(4.5 * MAX_ERROR_M);
        above = ancestor.parent();
    }
    parts.assert_breaks(
        Against::Dem,
        &[
            CheckId::SvRange,
            CheckId::LevelSums,
            CheckId::Finest,
            CheckId::Recorded,
            CheckId::Samples,
            CheckId::SampleBound,
            CheckId::Nodes,
        ],
    );
}

#[test]
fn a_tile_with_a_flipped_bit() {
    let parts = Parts::sound();
    let id = parts.finest_without_roads();
    let mut tiles = parts.encoded().unwrap();
    let (_, bytes) = tiles.iter_mut().find(|(tile, _)| *tile == id).unwrap();
    *bytes.last_mut().unwrap() ^= 1;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("damaged.pmtiles");
    write(&path, &parts.manifest, &tiles).unwrap();
    assert_broken(report_on(&path, Against::Itself), &[CheckId::Whole, CheckId::LevelSums]);
}

#[test]
fn tolerances_that_were_loosened() {
    let mut settings = Parts::sound();
    settings.manifest.settings.max_error_m *= 100.0;
    settings.assert_breaks(Against::Itself, &[CheckId::LevelRecords, CheckId::SettingsHash]);

    let mut level = Parts::sound();
    level.manifest.levels[0].max_error_m *= 100.0;
    level.assert_breaks(Against::Itself, &[CheckId::LevelRecords]);
}

#[test]
fn ground_that_was_taken_away_with_its_count() {
    let mut parts = Parts::sound();
    let id = parts.finest_without_roads();
    parts.tiles.retain(|tile| tile.id != id);
    let level = parts.manifest.levels.last_mut().unwrap();
    level.tiles -= 1;
    parts.assert_breaks(
        Against::Dem,
        &[
            CheckId::LevelSums,
            CheckId::Recorded,
            CheckId::Samples,
            CheckId::Stray,
            CheckId::Uncovered,
        ],
    );
}

#[test]
fn a_height_range_that_leaves_nodes_out() {
    let mut parts = Parts::sound();
    let id = parts.finest_without_roads();
    let range_m = &mut parts.terrain_mut(id).height_range_m;
    range_m[1] = range_m[0];
    parts.assert_breaks(Against::Dem, &[CheckId::Vertices, CheckId::Ranges]);
}

/// The recorded scales are those at the files' corners, which the check of every 7th sample need
/// not reach.
#[test]
fn a_package_of_every_seventh_sample_keeps_its_promises() {
    let folder = tempfile::tempdir().unwrap();
    let (dem, output) = (folder.path().join("dem.tif"), folder.path().join("built.pmtiles"));
    let height_m = |[lon, lat]: [f64; 2]| 500.0 + 300.0 * (lon * 200.0).sin() * (lat * 150.0).cos();
    // The cell is three arc seconds.
    write_degrees(&dem, 361, [9.0, 47.3], 1.0 / 1200.0, height_m);
    let mut settings = settings(dem.clone(), None, output.clone(), Options::plain(MAX_ERROR_M));
    settings.plan.terrain.plan.cell_every = Some(7);
    build(&settings, &Silent).unwrap();
    let settings =
        VerifySettings { dem: vec![dem], photo: Vec::new(), osm: None, threads: 2, polygon: None };
    assert_broken(verify(&FilePackage::open(&output).unwrap(), &settings, &Silent).unwrap(), &[]);
}

#[test]
fn heights_of_the_package_that_are_not_the_root_tiles() {
    let mut parts = Parts::sound();
    parts.manifest.vertical.range_m[1] += 1.0;
    parts.assert_breaks(Against::Itself, &[CheckId::RootHeights]);
}

/// If the grid does not match the elevation files, checks that were not run do not count as passed.
#[test]
fn checks_that_could_not_be_made_do_not_hold() {
    let mut parts = Parts::sound();
    parts.manifest.settings.cell_every = Some(2);
    let report = parts.assert_breaks(Against::Dem, &[CheckId::SettingsHash, CheckId::DemPlan]);
    for check in report.checks {
        match check.id {
            CheckId::Bound | CheckId::Nodes | CheckId::Samples => {
                assert_eq!(check.verdict(), None, "{check:?}");
            }
            CheckId::DemInputs => assert_eq!(check.verdict(), Some(true)),
            CheckId::DemPlan => assert_eq!(check.verdict(), Some(false)),
            _ => {}
        }
    }
}
