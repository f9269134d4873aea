//! Decks of bridges against a reference that follows the ray of each pixel in small steps, and
//! against drawings with deliberate errors.

use corniche_geom::TileId;
use corniche_roads::OwnWidth;
use corniche_styles::Style;
use corniche_testing::some_of;
use corniche_viewer::{
    PackageLooks, RoadOptions,
    camera::Camera,
    for_tests::class_of,
    tiles::{DeckLine, RoadKind, RoadLook},
};
use glam::{DVec2, DVec3};

use super::{
    agreement::{METHODS, name_of},
    reference::{Look, half_width},
    support::{
        Drawing, bands, class, gpu,
        scene::Scene,
        scenes::{self, camera, center, style},
    },
};
use crate::labels::road_label;

pub(crate) const SIDE: u8 = 1;
pub(crate) const UNDERSIDE: u8 = 2;
/// Heights that differ by less than this count as equal, metres.
const SAME_M: f64 = 0.25;
/// A pixel is skipped if the visible surface changes within this many pixels.
const BAND_PX: f64 = 0.3;

/// A bridge: class and points relative to the middle of the root, with heights.
pub(crate) type Deck = (u8, Vec<[f64; 3]>);

/// Decks of class 5 are slip roads, those of class 6 carriageways.
fn look_of(number: u8) -> RoadLook {
    match number {
        5 => RoadLook::Link,
        6 => RoadLook::Carriageway,
        _ => RoadLook::Plain,
    }
}

fn deck(way_id: i64, (number, points): &Deck) -> DeckLine {
    let middle = center();
    DeckLine {
        way_id,
        kind: RoadKind { look: look_of(*number), ..RoadKind::plain(class(*number)) },
        is_road: true,
        points_m: points.iter().map(|[x, y, z]| [middle.x + x, middle.y + y, *z]).collect(),
        on_ground: [false; 2],
    }
}

fn scene(height_m: impl Fn(f64, f64) -> f64, decks: &[Deck], style: Style) -> Scene {
    let bare = scenes::tile(TileId::ROOT, 8, &height_m, &[], 0.0);
    let decks = (1..).zip(decks).map(|(way_id, of)| deck(way_id, of)).collect();
    Scene { tiles: vec![bare.with_decks(decks)], style, layers: PackageLooks::default() }
}

/// The reference's data of a deck: its points, divided as the manual of the tile format describes,
/// and half its width at each point.
pub(crate) struct Slab {
    class: u8,
    points: Vec<DVec3>,
    half_m: Vec<f64>,
    thick_m: f64,
    /// Maximum height above the deck of ground that is painted as the road; `None`: twice half the
    /// width.
    most_above_m: Option<f64>,
}

/// The point of a deck that is nearest to a position in plan.
struct Nearest {
    /// Distance to the position, as a share of half the width there.
    share: f64,
    half_m: f64,
    height_m: f64,
}

impl Slab {
    pub(crate) fn new((number, points): &Deck, look: Look<'_>) -> Self {
        let at = |[x, y, z]: [f64; 3]| (center() + DVec2::new(x, y)).extend(z);
        let mut divided = vec![at(points[0])];
        for pair in points.windows(2) {
            let [a, b] = [at(pair[0]), at(pair[1])];
            let count = (a.truncate().distance(b.truncate()) / 200.0).ceil().max(1.0);
            divided.extend((1..=count as usize).map(|k| a.lerp(b, k as f64 / count)));
        }
        let thick_m = [1.5, 1.5, 1.5, 1.5, 1.0, 1.0, 1.0, 0.5, 0.5][usize::from(*number)];
        let half_m = divided
            .iter()
            .map(|at| {
                let distance_m = look.camera.seeing_distance_m(*at);
                half_width(look, (*number, OwnWidth::Unknown, look_of(*number)), 1.0, distance_m).0
            })
            .collect();
        Self { class: *number, points: divided, half_m, thick_m, most_above_m: None }
    }

    /// Returns the same road as a thin ribbon, which ground hides.
    pub(crate) fn into_ribbon(self) -> Self {
        Self { thick_m: 0.05, most_above_m: Some(0.25), ..self }
    }

    fn nearest(&self, at: DVec2) -> Nearest {
        let mut best: Option<(f64, Nearest)> = None;
        for k in 0..self.points.len() - 1 {
            let [a, b] = [self.points[k], self.points[k + 1]];
            let way = (b - a).truncate();
            let share = ((at - a.truncate()).dot(way) / way.length_squared()).clamp(0.0, 1.0);
            let from_m = at.distance(a.truncate() + way * share);
            let half_m = self.half_m[k] + share * (self.half_m[k + 1] - self.half_m[k]);
            if best.as_ref().is_none_or(|(least_m, _)| from_m < *least_m) {
                let height_m = a.z + share * (b.z - a.z);
                best = Some((from_m, Nearest { share: from_m / half_m, half_m, height_m }));
            }
        }
        best.unwrap().1
    }

    fn holds(&self, at: DVec3) -> bool {
        let near = self.nearest(at.truncate());
        near.share <= 1.0 && (near.height_m - self.thick_m..=near.height_m).contains(&at.z)
    }

    /// The point where a ray first enters the deck, before a depth.
    fn entry(&self, start: DVec3, way: DVec3, most: f64) -> Option<f64> {
        let mut first: Option<f64> = None;
        for k in 0..self.points.len() - 1 {
            let [a, b] = [self.points[k], self.points[k + 1]];
            let around = DVec3::splat(self.half_m[k].max(self.half_m[k + 1])).with_z(0.0);
            let low = a.min(b) - around - DVec3::Z * self.thick_m;
            let high = a.max(b) + around;
            let mut range = [0.0, most.min(first.unwrap_or(most))];
            for axis in 0..3 {
                let ends = [low[axis], high[axis]].map(|end| (end - start[axis]) / way[axis]);
                range = [range[0].max(ends[0].min(ends[1])), range[1].min(ends[0].max(ends[1]))];
            }
            if range[0] > range[1] {
                continue;
            }
            let steps = 300;
            let depth = |k: i32| range[0] + (range[1] - range[0]) * f64::from(k) / f64::from(steps);
            // A part thinner than a step is found where the ray reaches its other side.
            let height_m = |depth: f64| {
                let at = start + way * depth;
                at.z - self.nearest(at.truncate()).height_m
            };
            let through = |k: i32| {
                let mut ends = [depth(k - 1), depth(k)];
                let from_above = height_m(ends[0]) > 0.0;
                if from_above == (height_m(ends[1]) > 0.0) {
                    return None;
                }
                for _ in 0..50 {
                    let middle = f64::midpoint(ends[0], ends[1]);
                    ends[usize::from((height_m(middle) > 0.0) != from_above)] = middle;
                }
                let below = ends[usize::from(from_above)];
                self.holds(start + way * below).then_some(below)
            };
            let inside = (0..=steps).find_map(|k| {
                let held = self.holds(start + way * depth(k)).then(|| depth(k));
                Some((k, held.or_else(|| if k > 0 { through(k) } else { None })?))
            });
            if let Some((k, mut within)) = inside {
                let mut before = depth((k - 1).max(0));
                if k == 0 {
                    before = (within - (range[1] - range[0]) * 1e-3).max(0.0);
                }
                for _ in 0..50 {
                    let middle = f64::midpoint(before, within);
                    if self.holds(start + way * middle) {
                        within = middle;
                    } else {
                        before = middle;
                    }
                }
                first = Some(first.map_or(within, |first| first.min(within)));
            }
        }
        first
    }
}

/// The reference for one drawing.
pub(crate) struct DeckOracle<'a> {
    pub(crate) slabs: Vec<Slab>,
    pub(crate) style: &'a Style,
    pub(crate) camera: &'a Camera,
    pub(crate) drawing: &'a Drawing,
}

#[derive(Debug, Default)]
pub(crate) struct Found {
    pub(crate) compared: usize,
    pub(crate) wrong: usize,
    in_band: usize,
    sides: usize,
    undersides: usize,
}

impl DeckOracle<'_> {
    /// The visible label at a position of the picture, over ground at a depth.
    fn label(&self, at: DVec2, ground: Option<f64>) -> u8 {
        let (start, way) = (self.camera.ray_start_in_world(at), self.camera.ray_in_world(at));
        // By depth: whether a road is visible, and its label.
        let mut seen: Vec<(f64, bool, u8)> = Vec::new();
        for slab in &self.slabs {
            let road = |share: f64| {
                let style = &self.style.roads[usize::from(slab.class)];
                let bands = style.bands.all();
                let within = bands.iter().filter(|band| share <= f64::from(band.width_share));
                road_label(slab.class, (within.count().max(1) - 1) as u8)
            };
            let most = ground.unwrap_or(1e6);
            if let Some(depth) = slab.entry(start, way, most) {
                let place = start + way * depth;
                let near = slab.nearest(place.truncate());
                let slack_m = 1e-6 * depth + 1e-6;
                if place.z >= near.height_m - slack_m {
                    seen.push((depth, true, road(near.share)));
                } else if place.z <= near.height_m - slab.thick_m + slack_m {
                    seen.push((depth, false, UNDERSIDE));
                } else {
                    seen.push((depth, false, SIDE));
                }
            } else if let Some(depth) = ground {
                let place = start + way * depth;
                let near = slab.nearest(place.truncate());
                let above_m = place.z - near.height_m;
                let most_m = slab.most_above_m.unwrap_or(2.0 * near.half_m);
                if near.share <= 1.0 && above_m >= -slab.thick_m && above_m <= most_m {
                    seen.push((depth, true, road(near.share)));
                }
            }
        }
        let Some(&(front, _, label)) = seen.iter().min_by(|a, b| a.0.total_cmp(&b.0)) else {
            return 0;
        };
        let apart = SAME_M / way.z.abs().max(0.1 * way.length());
        let roads = seen.iter().filter(|(depth, is_road, _)| *is_road && *depth <= front + apart);
        roads.map(|(.., label)| *label).max().unwrap_or(label)
    }

    pub(crate) fn compare(&self) -> Found {
        let labels = self.drawing.decks.as_ref().expect("decks were drawn");
        let mut found = Found::default();
        for (index, at) in self.drawing.pixels() {
            let stored = f64::from(self.drawing.depth[index]);
            let ground = (stored > 0.0).then(|| self.camera.depth_m(stored));
            let label = self.label(at, ground);
            let drawn = labels[index];
            if label == 0 && drawn == 0 {
                continue;
            }
            let offsets =
                [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0], [0.7, 0.7], [-0.7, -0.7]];
            let is_sure = offsets
                .into_iter()
                .all(|by| self.label(at + DVec2::from_array(by) * BAND_PX, ground) == label)
                && [1.0 - 1e-5, 1.0 + 1e-5]
                    .into_iter()
                    .all(|by| self.label(at, ground.map(|depth| depth * by)) == label);
            if !is_sure {
                found.in_band += 1;
                continue;
            }
            found.compared += 1;
            found.sides += usize::from(drawn == SIDE);
            found.undersides += usize::from(drawn == UNDERSIDE);
            found.wrong += usize::from(drawn != label);
        }
        found
    }
}

/// A scene with the decks that its picture should show.
struct Case {
    name: &'static str,
    ground: fn(f64, f64) -> f64,
    decks: Vec<Deck>,
    style: Style,
    cameras: Vec<Camera>,
}

/// A V-shaped valley along y.
fn valley(x: f64, _: f64) -> f64 {
    (100.0 + 0.4 * (x.abs() - 150.0)).max(40.0)
}

fn flat(_: f64, _: f64) -> f64 {
    0.0
}

fn cases() -> Vec<Case> {
    let mut wide = style(24.0);
    wide.roads[6].carriageway_width_m = 10.0;
    let mut many = style(30.0);
    for road in &mut many.roads {
        road.bands = bands(&[1.0, 0.6, 0.3]);
    }
    let views = |height_m: f64| {
        vec![
            camera(height_m, 500.0, 20.0, 50.0),
            camera(height_m, 700.0, 75.0, 85.0),
            camera(height_m, 900.0, 200.0, 0.0),
            camera(height_m, 4000.0, 320.0, 65.0),
        ]
    };
    vec![
        Case {
            name: "straight",
            ground: flat,
            decks: vec![(4, vec![[-150.0, -20.0, 30.0], [160.0, 40.0, 45.0]])],
            style: wide.clone(),
            cameras: views(35.0),
        },
        Case {
            name: "bends, many bands",
            ground: flat,
            decks: vec![(
                2,
                vec![
                    [-300.0, -120.0, 20.0],
                    [-100.0, -100.0, 28.0],
                    [20.0, 30.0, 33.0],
                    [60.0, 220.0, 30.0],
                    [300.0, 230.0, 26.0],
                ],
            )],
            style: many,
            cameras: views(30.0),
        },
        Case {
            name: "stacked",
            ground: flat,
            decks: vec![
                (0, vec![[-200.0, 0.0, 20.0], [200.0, 0.0, 20.0]]),
                (5, vec![[0.0, -200.0, 26.0], [10.0, 200.0, 27.0]]),
                (6, vec![[-150.0, -150.0, 34.0], [150.0, 150.0, 32.0]]),
                (3, vec![[-200.0, 60.0, 20.2], [200.0, 60.0, 20.2]]),
            ],
            style: wide.clone(),
            cameras: views(25.0),
        },
        Case {
            name: "over a valley, ends in the ground",
            ground: valley,
            decks: vec![(3, vec![[-150.0, 0.0, 100.0], [0.0, 0.0, 101.0], [150.0, 0.0, 100.0]])],
            style: wide,
            cameras: views(90.0),
        },
    ]
}

impl Case {
    fn compare(&self, drawing: &Drawing, camera: &Camera, options: RoadOptions) -> Found {
        let look = Look { style: &self.style, options, camera };
        let slabs = self.decks.iter().map(|deck| Slab::new(deck, look)).collect();
        DeckOracle { slabs, style: &self.style, camera, drawing }.compare()
    }
}

#[test]
fn decks_agree_with_the_reference_in_both_methods() {
    let Some(gpu) = gpu() else { return };
    for case in cases() {
        let scene = scene(case.ground, &case.decks, case.style.clone());
        let mut compared = 0;
        for camera in some_of(case.cameras.clone(), [4, 2, 1]) {
            let drawings =
                METHODS.map(|method| scene.draw(&gpu, &camera, RoadOptions::for_method(method)));
            assert_eq!(drawings[0].decks, drawings[1].decks, "{}: both methods", case.name);
            let found = case.compare(&drawings[0], &camera, RoadOptions::for_method(METHODS[0]));
            println!("{:34} {} {found:?}", case.name, name_of(METHODS[0]));
            assert_eq!(found.wrong, 0, "{}: {found:?}", case.name);
            compared += found.compared;
        }
        assert!(compared > 50, "{}: {compared} pixels are no test", case.name);
    }
}

/// Each wrong drawing has pixels that the reference rejects.
#[test]
fn decks_drawn_wrong_fail() {
    let Some(gpu) = gpu() else { return };
    let all = cases();
    let [straight, stacked] =
        ["straight", "stacked"].map(|name| all.iter().find(|case| case.name == name).unwrap());
    let options = RoadOptions::for_method(METHODS[1]);
    let refuse = |what: &str, case: &Case, decks: &[Deck], least: usize| {
        let camera = &case.cameras[0];
        let drawing = scene(case.ground, decks, case.style.clone()).draw(&gpu, camera, options);
        let found = case.compare(&drawing, camera, options);
        println!("must fail, {what}: {found:?}");
        assert!(found.wrong > least, "{what}: {found:?}");
    };
    let moved = |by: &dyn Fn(usize, [f64; 3]) -> [f64; 3], decks: &[Deck]| -> Vec<Deck> {
        let of = |(number, points): &Deck| {
            (*number, points.iter().enumerate().map(|(k, at)| by(k, *at)).collect())
        };
        decks.iter().map(of).collect()
    };
    let on_ground = moved(&|_, [x, y, _]| [x, y, 0.1], &straight.decks);
    refuse("on the ground", straight, &on_ground, 1000);
    let one_lower =
        moved(&|k, [x, y, z]| [x, y, if k == 0 { z - 1.0 } else { z }], &straight.decks);
    refuse("an end off by 1 m", straight, &one_lower, 20);
    let upside_down = moved(&|_, [x, y, z]| [x, y, 60.0 - z], &stacked.decks);
    refuse("order reversed", stacked, &upside_down, 200);
    let by_class = moved(&|_, [x, y, _]| [x, y, 26.0], &stacked.decks);
    refuse("ordered by class", stacked, &by_class, 200);
}

#[test]
fn decks_without_undersides_fail() {
    let Some(gpu) = gpu() else { return };
    let all = cases();
    let case = all.iter().find(|case| case.name == "over a valley, ends in the ground").unwrap();
    let options = RoadOptions::for_method(METHODS[1]);
    // A view from the bottom of the valley.
    let camera = camera(99.0, 60.0, 30.0, 110.0);
    let scene = scene(case.ground, &case.decks, case.style.clone());
    let mut drawing = scene.draw(&gpu, &camera, options);
    let found = case.compare(&drawing, &camera, options);
    println!("from below: {found:?}");
    assert_eq!(found.wrong, 0, "{found:?}");
    assert!(found.undersides > 1000, "{found:?}");
    for label in drawing.decks.as_mut().unwrap() {
        *label = if *label == UNDERSIDE { 0 } else { *label };
    }
    assert!(case.compare(&drawing, &camera, options).wrong > 1000);
}

/// A bridge replaces its road: the road on the ground ends where the bridge begins, in both
/// methods.
#[test]
fn no_road_lies_under_its_own_bridge() {
    let Some(gpu) = gpu() else { return };
    let road = vec![[-600.0, 0.0], [-150.0, 0.0], [150.0, 0.0], [600.0, 30.0]];
    let whole = scenes::one_tile(8, valley, &[(3, road)], style(24.0));
    let own = deck(1, &(3, vec![[-150.0, 0.0, 100.0], [150.0, 0.0, 100.0]]));
    let scene = Scene { tiles: vec![whole.tiles[0].with_decks(vec![own])], ..whole.clone() };
    let view = camera(90.0, 1500.0, 0.0, 0.0);
    for method in METHODS {
        let drawing = scene.draw(&gpu, &view, RoadOptions::for_method(method));
        let before = whole.draw(&gpu, &view, RoadOptions::for_method(method));
        let labels = drawing.decks.as_ref().unwrap();
        let mut seen = [0; 2];
        for (index, _) in drawing.pixels() {
            let was = class_of(before.labels[index]);
            // From above, the road and its bridge cover the same pixels as the road alone.
            let is = class_of(drawing.labels[index])
                .or(class_of(labels[index]).filter(|_| labels[index] > UNDERSIDE));
            if was != is {
                seen[1] += 1;
            }
            seen[0] += usize::from(drawing.labels[index] != 0 && labels[index] != 0);
        }
        println!("{}: {seen:?} pixels of road under the bridge, and changed", name_of(method));
        assert_eq!(seen, [0, 0]);
    }
}
