//! Changes that must not change a picture.

use corniche_geom::TileId;
use corniche_viewer::{PackageLooks, RoadMethod, RoadOptions};

use super::{
    reference::DepthOracle,
    support::{
        Drawing, World, gpu,
        scene::Scene,
        scenes::{self, Road, camera, hills, one_tile, style, tile},
        within,
    },
};

const SV: RoadMethod = RoadMethod::ShadowVolumes;

fn road() -> Road {
    (3, vec![[-500.0, -310.0], [450.0, 420.0]])
}

fn drawn(scene: &Scene) -> Option<Drawing> {
    Some(scene.draw(&gpu()?, &camera(400.0, 1600.0, 25.0, 45.0), RoadOptions::for_method(SV)))
}

/// The number of pixels whose labels differ between the pictures of two scenes, and the number of
/// pixels with a label.
fn differing(a: &Scene, b: &Scene) -> Option<(usize, usize)> {
    let (a, b) = (drawn(a)?, drawn(b)?);
    let differing = a.labels.iter().zip(&b.labels).filter(|(a, b)| a != b).count();
    Some((differing, a.labels.iter().filter(|label| **label != 0).count()))
}

fn assert_same(a: &Scene, b: &Scene) {
    if let Some((differing, covered)) = differing(a, b) {
        assert!(covered > 1000, "{covered} pixels are no test");
        // Positions are rounded differently to f32: a pixel whose centre is very close to the edge
        // may flip.
        assert!(differing <= covered / 2000, "{differing} of {covered}");
    }
}

#[test]
fn a_segment_split_in_two_looks_the_same() {
    let split: Road = (3, vec![[-500.0, -310.0], [-25.0, 55.0], [450.0, 420.0]]);
    assert_same(
        &one_tile(8, hills, &[road()], style(40.0)),
        &one_tile(8, hills, &[split], style(40.0)),
    );
}

#[test]
fn a_segment_reversed_looks_the_same() {
    let reversed: Road = (3, road().1.into_iter().rev().collect());
    assert_same(
        &one_tile(8, hills, &[road()], style(40.0)),
        &one_tile(8, hills, &[reversed], style(40.0)),
    );
}

#[test]
fn a_tile_split_into_four_looks_the_same() {
    // Level 1 has twice the nodes per metre: every 16th of its nodes is every 8th of the root's.
    let four = scenes::four_tiles([16; 4], hills, &[road()], style(40.0));
    assert_same(&one_tile(8, hills, &[road()], style(40.0)), &four);
}

#[test]
fn the_same_frame_is_the_same_bytes_in_both_methods() {
    let Some(gpu) = gpu() else { return };
    let scene = one_tile(8, hills, &scenes::junction(), corniche_styles::Style::road_atlas());
    let camera = camera(400.0, 2500.0, 25.0, 60.0);
    for method in [RoadMethod::Geometry, SV] {
        let options = RoadOptions::for_method(method);
        let (a, b) = (scene.draw(&gpu, &camera, options), scene.draw(&gpu, &camera, options));
        assert!(a.picture == b.picture && a.labels == b.labels && a.owners == b.owners);
        assert!(a.labels.iter().any(|label| *label != 0));
    }
}

/// The frame of the tests is 512 km east and 5120 km north of the origin, like real ones. Here
/// everything is moved by a thousand kilometres more, as a whole, and by an offset that is not a
/// multiple of half metres, the steps of f32 there.
#[test]
fn a_world_moved_by_a_thousand_kilometres_looks_the_same() {
    let Some(gpu) = gpu() else { return };
    let scene = one_tile(8, hills, &[road()], style(15.0));
    let mut moved = scene.clone();
    let by_m = 1e6 + 0.3;
    for tile in &mut moved.tiles {
        tile.geometry.reference_m[0] += by_m;
        tile.geometry.reference_m[1] += by_m;
    }
    let from = |by_m: f64| {
        let target = scenes::center().extend(400.0) + glam::DVec3::new(by_m, by_m, 0.0);
        let orientation =
            corniche_viewer::camera::Orientation { heading_deg: 25.0, pitch_deg: 45.0 };
        corniche_viewer::camera::Camera::look_at(target, 300.0, orientation, scenes::SIZE)
    };
    let a = scene.draw(&gpu, &from(0.0), RoadOptions::for_method(SV));
    let b = moved.draw(&gpu, &from(by_m), RoadOptions::for_method(SV));
    let differing = a.labels.iter().zip(&b.labels).filter(|(a, b)| a != b).count();
    let covered = a.labels.iter().filter(|label| **label != 0).count();
    assert!(covered > 1000 && differing <= covered / 2000, "{differing} of {covered}");
}

#[test]
fn on_oblong_cells_what_must_not_change_a_picture_does_not_either() {
    within(World { ratio: 1.5, scale: [1.2, 0.9] }, || {
        a_segment_split_in_two_looks_the_same();
        a_segment_reversed_looks_the_same();
        a_tile_split_into_four_looks_the_same();
        skirts_carry_no_road();
        a_volume_paints_the_ground_of_its_own_tile_only();
    });
}

#[test]
fn skirts_carry_no_road() {
    let Some(gpu) = gpu() else { return };
    // A skirt 60 m deep along the southern edge of the northern tiles, seen from the south, with
    // one road along it and one across. The southern tiles do not exist.
    let roads: [Road; 2] =
        [(3, vec![[-900.0, 5.0], [900.0, 5.0]]), (1, vec![[30.0, -500.0], [-20.0, 500.0]])];
    let tiles = TileId::ROOT
        .children()
        .filter(|id| id.y() == 0)
        .map(|id| tile(id, 16, &|_, _| 300.0, &roads, 60.0))
        .collect();
    let scene = Scene { tiles, style: style(40.0), layers: PackageLooks::default() };
    for method in [RoadMethod::Geometry, SV] {
        let drawing =
            scene.draw(&gpu, &camera(300.0, 900.0, 0.0, 60.0), RoadOptions::for_method(method));
        let is_skirt = |index: &usize| {
            matches!(drawing.owners[*index], corniche_viewer::for_tests::TileOwner::Skirt(_))
        };
        let skirts: Vec<usize> = (0..drawing.labels.len()).filter(is_skirt).collect();
        assert!(skirts.len() > 3000, "{} pixels of skirts are no test", skirts.len());
        assert!(drawing.labels.iter().filter(|label| **label != 0).count() > 1000);
        assert!(skirts.iter().all(|index| drawing.labels[*index] == 0), "{method:?}");
    }
}

#[test]
fn the_edge_of_a_road_does_not_reach_over_the_crest_in_front_of_it() {
    let Some(gpu) = gpu() else { return };
    // A wall from west to east with a wide road far behind it, visible over its top.
    let wall = |_: f64, y: f64| (300.0 - (y + 1000.0).abs() * 2.0).max(0.0);
    let road: Road = (0, vec![[-2000.0, -400.0], [2000.0, -380.0]]);
    let mut style = style(300.0);
    style.outline_px = 2;
    let scene = one_tile(8, wall, &[road], style);
    let orientation = corniche_viewer::camera::Orientation { heading_deg: 0.0, pitch_deg: 70.0 };
    let target = (scenes::center() + glam::DVec2::new(0.0, -1000.0)).extend(300.0);
    let camera = corniche_viewer::camera::Camera::look_at(target, 700.0, orientation, scenes::SIZE);
    let with = scene.draw(&gpu, &camera, RoadOptions::for_method(SV));
    let bare = scene.draw(&gpu, &camera, RoadOptions::for_method(RoadMethod::None));
    let width = scenes::SIZE[0] as usize;
    // Pixels of the wall just below the pixels that show the road behind it.
    let crest: Vec<usize> = (width..with.labels.len())
        .filter(|index| with.labels[*index] == 0 && with.labels[*index - width] != 0)
        .filter(|index| with.depth[*index] > 1.5 * with.depth[*index - width])
        .collect();
    assert!(crest.len() > 100, "{} pixels are no test", crest.len());
    let pixel = |picture: &[u8], index: usize| picture[4 * index..4 * index + 4].to_vec();
    let stained = crest
        .iter()
        .filter(|index| pixel(&with.picture, **index) != pixel(&bare.picture, **index))
        .count();
    assert_eq!(stained, 0, "of {}", crest.len());
}

#[test]
fn a_volume_paints_the_ground_of_its_own_tile_only() {
    let Some(gpu) = gpu() else { return };
    // A road along the border between west and east that only the western tiles know, as if a
    // coarser level had dropped or moved it.
    let roads: [Road; 1] = [(3, vec![[-12.0, -900.0], [-6.0, 900.0]])];
    let tiles = TileId::ROOT
        .children()
        .map(|id| tile(id, 16, &hills, if id.x() == 0 { &roads } else { &[] }, 0.0))
        .collect();
    let scene = Scene { tiles, style: style(60.0), layers: PackageLooks::default() };
    let (view, options) = (camera(400.0, 1200.0, 10.0, 30.0), RoadOptions::for_method(SV));
    let drawing = scene.draw(&gpu, &view, options);
    let oracle =
        DepthOracle { scene: &scene, camera: &view, options, drawing: &drawing, band_px: 0.05 };
    let found = oracle.compare();
    assert!(found.compared > 1000);
    assert_eq!(found.wrong, 0);
}
