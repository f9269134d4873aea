//! Roads without connections: short parts of the network become thin and disappear, identically in
//! both methods.

use corniche_styles::Style;
use corniche_viewer::{RoadOptions, camera::Camera};

use super::{
    agreement::{METHODS, check, name_of},
    reference::DepthOracle,
    support::{
        gpu,
        scene::Scene,
        scenes::{Named, Road, camera, hills, one_tile, style},
    },
};

/// Roads in pieces of 100 to 500 m, alone and next to a road that leaves the tile, seen at a slant.
fn short_parts() -> (Scene, Camera) {
    let mut roads: Vec<Road> = vec![
        (1, vec![[-2000.0, 620.0], [2000.0, 620.0]]),
        // It ends at the road that leaves the tile; so does the next one, via this one.
        (3, vec![[-300.0, 620.0], [-300.0, 500.0]]),
        (4, vec![[-300.0, 500.0], [-200.0, 450.0]]),
        // Alone until the less important road next to it is drawn.
        (3, vec![[300.0, 560.0], [300.0, 430.0]]),
        (5, vec![[300.0, 560.0], [300.0, 620.0]]),
    ];
    for row in 0..6_u8 {
        for column in 0..6_u8 {
            let at = [f64::from(column) * 260.0 - 700.0, f64::from(row) * 180.0 - 620.0];
            let length_m = 60.0 + 18.0 * f64::from(row);
            let class = 2 + (row + column) % 5;
            roads.push((class, vec![at, [at[0] + length_m, at[1] + 30.0]]));
            if column % 2 == 0 {
                roads.push((class, vec![at, [at[0] - 20.0, at[1] + length_m / 2.0]]));
            }
        }
    }
    let style = Style { shortest_part_px: 70.0, ..style(12.0) };
    (one_tile(8, hills, &roads, style), camera(400.0, 1300.0, 30.0, 55.0))
}

#[test]
fn both_methods_agree_with_the_references_on_short_parts() {
    let (scene, camera) = short_parts();
    check(&Named { name: "short parts", scene, cameras: vec![camera] });
}

/// The same gate fails if all roads are drawn, or if other lengths are used.
#[test]
fn other_lengths_fail() {
    let Some(gpu) = gpu() else { return };
    let (scene, camera) = short_parts();
    for method in METHODS {
        let options = RoadOptions::for_method(method);
        let wrong_with = |shortest_part_px| {
            let style = Style { shortest_part_px, ..scene.style.clone() };
            let drawing = Scene { style, ..scene.clone() }.draw(&gpu, &camera, options);
            let (scene, drawing) = (&scene, &drawing);
            DepthOracle { scene, camera: &camera, options, drawing, band_px: 0.05 }.compare().wrong
        };
        let [all, shorter] = [0.0, 63.0].map(wrong_with);
        println!("{}: {all}, {shorter}", name_of(method));
        assert!(all > 200 && shorter > 50, "{}: {all}, {shorter}", name_of(method));
    }
}
