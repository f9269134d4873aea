//! Grounds of closed form with roads on them.

use std::num::{NonZeroU8, NonZeroU32};

use corniche_geom::TileId;
use corniche_roads::OwnWidth;
use corniche_styles::{OwnWidths, Style, WidthScaling};
use corniche_viewer::{
    PackageLooks,
    camera::{Camera, Orientation},
};
use glam::DVec2;

use super::{
    bands, frame, plain_style,
    scene::{Scene, Tile},
    terrain,
};

pub(crate) const SIZE: [u32; 2] = [480, 360];

/// A scene with its name and its cameras.
pub(crate) struct Named {
    pub(crate) name: &'static str,
    pub(crate) scene: Scene,
    pub(crate) cameras: Vec<Camera>,
}

/// A road by class and points relative to the middle of the root tile, which is 5120 m wide.
pub(crate) type Road = (u8, Vec<[f64; 2]>);

pub(crate) fn center() -> DVec2 {
    DVec2::from_array(frame().tile_bounds(TileId::ROOT).center())
}

pub(crate) fn camera(height_m: f64, distance_m: f64, heading_deg: f64, pitch_deg: f64) -> Camera {
    let orientation = Orientation { heading_deg, pitch_deg };
    Camera::look_at(center().extend(height_m), distance_m, orientation, SIZE)
}

pub(crate) fn style(width_m: f32) -> Style {
    plain_style(width_m)
}

/// Heights by x and y relative to the middle of the root.
pub(crate) fn one_tile(
    step: u16,
    height_m: impl Fn(f64, f64) -> f64,
    roads: &[Road],
    style: Style,
) -> Scene {
    Scene {
        tiles: vec![tile(TileId::ROOT, step, &height_m, roads, 0.0)],
        style,
        layers: PackageLooks::default(),
    }
}

pub(crate) fn tile(
    id: TileId,
    step: u16,
    height_m: &impl Fn(f64, f64) -> f64,
    roads: &[Road],
    skirt_depth_m: f64,
) -> Tile {
    let middle = center();
    let ground = terrain(id, step, |x, y| height_m(x - middle.x, y - middle.y));
    let roads: Vec<_> = roads
        .iter()
        .zip(1..)
        .map(|((class, points), way_id)| {
            let points = points.iter().map(|point| middle + DVec2::from_array(*point)).collect();
            (way_id, *class, points)
        })
        .collect();
    Tile::new(id, &ground, &roads, skirt_depth_m)
}

/// Returns the four tiles of the finer level, some of them coarser than others.
pub(crate) fn four_tiles(
    steps: [u16; 4],
    height_m: impl Fn(f64, f64) -> f64,
    roads: &[Road],
    style: Style,
) -> Scene {
    let tiles = TileId::ROOT
        .children()
        .zip(steps)
        .map(|(id, step)| tile(id, step, &height_m, roads, 0.0))
        .collect();
    Scene { tiles, style, layers: PackageLooks::default() }
}

pub(crate) fn hills(x: f64, y: f64) -> f64 {
    400.0 + 60.0 * (x / 170.0).sin() * (y / 210.0).cos()
}

/// A bend like on a pass road, with legs 60 m apart.
pub(crate) fn hairpin() -> Vec<[f64; 2]> {
    let mut points = vec![[-400.0, -30.0]];
    points.extend((0..=12).map(|k| {
        let angle = (-90.0 + 15.0 * f64::from(k)).to_radians();
        [100.0 + 30.0 * angle.cos(), 30.0 * angle.sin()]
    }));
    points.push([-400.0, 30.0]);
    points
}

pub(crate) fn junction() -> Vec<Road> {
    vec![
        (0, vec![[-600.0, -40.0], [600.0, 60.0]]),
        (2, vec![[0.0, 0.0], [150.0, 500.0]]),
        (4, vec![[0.0, 0.0], [-300.0, -450.0]]),
        (6, vec![[-200.0, 300.0], [-120.0, 0.0], [250.0, -380.0]]),
    ]
}

/// Returns the style with own widths of roads by `width` and `lanes`.
pub(crate) fn by_own_widths(style: &Style) -> Style {
    Style { own_widths: Some(OwnWidths { lane_m: Some(3.25) }), ..style.clone() }
}

/// Returns the scene with these widths for its ways 1, 2 …, in turn.
pub(crate) fn with_own_widths(scene: &Scene, widths: &[OwnWidth]) -> Scene {
    let of_way = |way_id: i64| widths[(way_id - 1) as usize % widths.len()];
    Scene {
        tiles: scene.tiles.iter().map(|tile| tile.with_own_widths(of_way)).collect(),
        style: by_own_widths(&scene.style),
        ..scene.clone()
    }
}

/// A tagged width in millimetres.
pub(crate) fn tagged(mm: u32) -> OwnWidth {
    NonZeroU32::new(mm).map_or(OwnWidth::Unknown, OwnWidth::Millimetres)
}

/// A number of lanes.
pub(crate) fn lanes(count: u8) -> OwnWidth {
    NonZeroU8::new(count).map_or(OwnWidth::Unknown, OwnWidth::Lanes)
}

/// The road atlas, with roads that grow from a shorter distance on.
fn far_atlas() -> Style {
    Style {
        width_scaling: WidthScaling { threshold_m: 800.0, exponent: 0.75, constant: 1.0 },
        ..Style::road_atlas()
    }
}

/// Scenes with own widths of roads.
fn of_own_widths() -> Vec<Named> {
    vec![
        Named {
            name: "junction of own widths",
            scene: with_own_widths(
                &one_tile(16, hills, &junction(), style(26.0)),
                &[tagged(12_000), lanes(6), tagged(90_000), OwnWidth::Unknown],
            ),
            cameras: vec![camera(400.0, 1200.0, 0.0, 20.0), camera(400.0, 1800.0, 100.0, 55.0)],
        },
        Named {
            name: "own widths, atlas style, far",
            scene: with_own_widths(
                &one_tile(16, hills, &junction(), far_atlas()),
                &[lanes(3), tagged(2_500), OwnWidth::Unknown, tagged(45_000)],
            ),
            cameras: vec![camera(400.0, 6000.0, 0.0, 35.0), camera(400.0, 9000.0, 60.0, 78.0)],
        },
    ]
}

/// Scenes with roads of many bands, and with roads that continue as other ones.
fn of_bands_and_flat_ends() -> Vec<Named> {
    // Minimum widths, too, so that the second rule gives thin roads bands; crossing classes have
    // different ones.
    let many_bands = {
        let mut style = far_atlas();
        style.roads[0].bands = bands(&[1.0, 0.85, 0.7, 0.5, 0.3, 0.1]);
        let most: Vec<f32> = (0..16_u8).map(|k| 1.0 - f32::from(k) / 17.0).collect();
        style.roads[2].bands = bands(&most);
        style.roads[4].bands = bands(&[1.0, 0.9, 0.4]);
        for (road, width_px) in style.roads.iter_mut().zip([60.0, 40.0, 50.0, 30.0, 24.0]) {
            (road.min_width_px, road.max_width_px) = (width_px, Some(2.0 * width_px));
        }
        style
    };
    vec![
        Named {
            name: "junction of many bands",
            scene: one_tile(16, hills, &junction(), many_bands),
            cameras: vec![camera(400.0, 1500.0, 0.0, 35.0), camera(400.0, 9000.0, 60.0, 78.0)],
        },
        Named {
            name: "roads that go on as others",
            scene: one_tile(
                16,
                hills,
                &[
                    (1, vec![[-500.0, -100.0], [-150.0, 0.0], [20.0, 30.0]]),
                    (4, vec![[420.0, 20.0], [20.0, 30.0]]),
                    (2, vec![[420.0, 20.0], [600.0, -50.0]]),
                    (3, vec![[-100.0, 420.0], [-120.0, 200.0]]),
                    (6, vec![[-120.0, 200.0], [-230.0, -350.0]]),
                    (5, vec![[-100.0, 420.0], [200.0, 400.0]]),
                ],
                style(44.0),
            ),
            cameras: vec![camera(400.0, 1000.0, 0.0, 10.0), camera(400.0, 1700.0, 70.0, 60.0)],
        },
    ]
}

/// All scenes except those with several levels.
pub(crate) fn all() -> Vec<Named> {
    let two_colours = {
        let mut style = style(26.0);
        style.roads[0].bands = bands(&[1.0, 0.3]);
        style
    };
    let ridge = |_: f64, y: f64| (400.0 - y.abs() * 0.5).max(0.0);
    let cliff = |x: f64, y: f64| 200.0 + 40.0 * ((x + 0.3 * y) / 120.0).floor();
    let straight = vec![(3, vec![[-700.0, -310.0], [650.0, 420.0]])];
    let mut all = of_own_widths();
    all.extend(of_bands_and_flat_ends());
    all.extend(vec![
        Named {
            name: "plane",
            scene: one_tile(256, |_, _| 512.0, &straight, style(40.0)),
            cameras: vec![
                camera(512.0, 1500.0, 0.0, 0.0),
                camera(512.0, 1200.0, 45.0, 60.0),
                camera(512.0, 3500.0, 200.0, 80.0),
            ],
        },
        Named {
            name: "plane at 45°",
            scene: one_tile(64, |x, _| 3000.0 + x, &straight, style(40.0)),
            cameras: vec![camera(3000.0, 1500.0, 20.0, 30.0), camera(3000.0, 2500.0, 60.0, 60.0)],
        },
        Named {
            name: "ridge",
            scene: one_tile(8, ridge, &[(0, vec![[100.0, -900.0], [-200.0, 900.0]])], style(40.0)),
            cameras: vec![camera(300.0, 1500.0, 0.0, 80.0), camera(300.0, 2500.0, 30.0, 60.0)],
        },
        Named {
            name: "staircase cliff",
            scene: one_tile(4, cliff, &straight, style(40.0)),
            cameras: vec![camera(300.0, 1800.0, 200.0, 35.0)],
        },
        Named {
            name: "sine hills, four tiles",
            scene: four_tiles(
                [8, 8, 16, 16],
                hills,
                &[
                    (1, vec![[-900.0, -700.0], [800.0, 600.0]]),
                    (4, vec![[-800.0, 500.0], [900.0, -300.0]]),
                    (5, vec![[-20.0, -900.0], [14.0, 900.0]]),
                ],
                style(40.0),
            ),
            cameras: vec![camera(400.0, 1500.0, 25.0, 0.0), camera(400.0, 2500.0, 25.0, 45.0)],
        },
        Named {
            name: "junction of 4 classes",
            scene: one_tile(16, hills, &junction(), two_colours),
            cameras: vec![camera(400.0, 1200.0, 0.0, 20.0), camera(400.0, 1800.0, 100.0, 55.0)],
        },
        Named {
            name: "junction, atlas style, far",
            scene: one_tile(16, hills, &junction(), far_atlas()),
            cameras: vec![camera(400.0, 6000.0, 0.0, 35.0), camera(400.0, 9000.0, 60.0, 78.0)],
        },
        Named {
            name: "hairpin and points",
            scene: one_tile(
                8,
                hills,
                &[(3, hairpin()), (5, vec![[-300.0, 200.0], [-299.999, 200.0]])],
                style(16.0),
            ),
            cameras: vec![camera(400.0, 900.0, 0.0, 30.0)],
        },
        Named {
            name: "along an edge, through vertices",
            scene: one_tile(
                16,
                hills,
                &[
                    (3, vec![[-640.0, 0.0], [640.0, 0.0]]),
                    (3, vec![[-640.0, -640.0], [640.0, 640.0]]),
                ],
                style(30.0),
            ),
            cameras: vec![camera(400.0, 1700.0, 10.0, 40.0)],
        },
        Named {
            name: "eye inside a box",
            scene: one_tile(
                64,
                |x, _| if x.abs() < 400.0 { 100.0 } else { 900.0 },
                &[(3, vec![[-2000.0, -30.0], [2000.0, 40.0]])],
                style(120.0),
            ),
            cameras: vec![camera(100.0, 300.0, 80.0, 60.0)],
        },
        Named {
            name: "as wide as its margin",
            // The margin is 80 m.
            scene: four_tiles([64; 4], |_, _| 300.0, &straight, style(159.0)),
            cameras: vec![camera(300.0, 5500.0, 15.0, 30.0)],
        },
    ]);
    all
}
