//! Roads over the step between tiles of different levels.

use corniche_geom::TileId;
use corniche_roads::OwnWidth;
use corniche_styles::Style;
use corniche_viewer::{
    PackageLooks, RoadOptions,
    camera::{Camera, Orientation},
    tiles::RoadLook,
};
use glam::DVec3;

use super::{
    agreement::{METHODS, name_of},
    ground_rays::Caster,
    measures::{self, CenterLines, Line},
    support::{
        country::{Country, QUANTUM_M},
        gpu,
        scene::{Scene, Tile},
        scenes,
    },
};

/// The lines between the ends of a way in two tiles of different levels: straight over the step.
fn steps(scene: &Scene) -> Vec<Line> {
    let ends: Vec<(u8, i64, DVec3, u8)> = scene
        .tiles
        .iter()
        .flat_map(|tile| {
            tile.centers.iter().flat_map(move |line| {
                [line.points_m.first(), line.points_m.last()].into_iter().flatten().map(
                    move |point| {
                        let at = DVec3::from_array(*point);
                        (tile.geometry.id.z(), line.way_id, at, line.kind.class.number())
                    },
                )
            })
        })
        .collect();
    let mut steps = Vec::new();
    for (k, a) in ends.iter().enumerate() {
        for b in &ends[k + 1..] {
            if a.0 != b.0 && a.1 == b.1 && a.2.truncate().distance(b.2.truncate()) < 0.01 {
                steps.push(((a.3, OwnWidth::Unknown, RoadLook::Plain), vec![a.2, b.2]));
            }
        }
    }
    steps
}

/// Coarse tiles in the west, fine ones in the east, two levels apart: the ground steps up or down
/// where they meet.
fn stepped(country: &Country) -> Scene {
    let ids = [(2, 1, 1), (2, 1, 2), (4, 8, 7), (4, 8, 8)];
    let tiles = ids
        .map(|(z, x, y)| {
            let id = TileId::new(z, x, y).unwrap();
            let (payload, widths) = (country.payload(id), country.widths(id));
            Tile::of_payload(&payload, &country.frame, QUANTUM_M, widths, 120.0)
        })
        .to_vec();
    Scene { tiles, style: Style::road_atlas(), layers: PackageLooks::default() }
}

#[test]
fn connectors_close_the_step_between_levels_and_without_them_it_gapes() {
    let Some(gpu) = gpu() else { return };
    let country = Country::new();
    let with = stepped(&country);
    // With another way id in each tile, the roads count as unconnected.
    let mut without = with.clone();
    for (tile, k) in without.tiles.iter_mut().zip(1..) {
        *tile = tile.with_ways_renumbered(k * 1000);
    }
    let steps = steps(&with);
    for ((class, ..), step) in &steps {
        println!("a step of {:.1} m under a road of class {class}", step[0].distance(step[1]));
    }
    let mut sums = [[CenterLines::default(); 2]; 2];
    for heading_deg in [75.0, 285.0] {
        for (_, step) in steps.iter().filter(|(_, step)| step[0].distance(step[1]) > 1.0) {
            let orientation = Orientation { heading_deg, pitch_deg: 50.0 };
            let camera = Camera::look_at(step[0], 150.0, orientation, scenes::SIZE);
            let caster = Caster::new(&with, &camera);
            for (method, sums) in METHODS.into_iter().zip(&mut sums) {
                for (scene, sum) in [&with, &without].into_iter().zip(sums) {
                    let drawing = scene.draw(&gpu, &camera, RoadOptions::for_method(method));
                    let found = measures::walk(&steps, &with, &caster, &camera, &drawing);
                    sum.seen_px += found.seen_px;
                    // A step is a silhouette along its whole length.
                    sum.missing_px += found.missing_px + found.missing_at_jumps_px;
                }
            }
        }
    }
    for (method, [with, without]) in METHODS.into_iter().zip(sums) {
        println!(
            "{}: over steps between levels {:.1} of {:.1} px of centre-line missing, {:.1} px without connectors",
            name_of(method),
            with.missing_px,
            with.seen_px,
            without.missing_px
        );
        assert!(with.seen_px > 20.0, "{with:?} is no test");
        assert!(without.missing_px > 0.3 * without.seen_px, "{without:?}");
        assert!(with.missing_px < 0.02 * with.seen_px, "{with:?}");
    }
}
