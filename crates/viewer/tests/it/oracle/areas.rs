//! Areas against two references: by the position that the GPU's own depth gives, and by rays at the
//! drawn triangles. Both use whole outlines, without tiles, volumes and stencils.

use corniche_geom::{GridFrame, TileId};
use corniche_styles::{AreaStyle, LayerLook};
use corniche_testing::some_of;
use corniche_viewer::{
    PackageLooks, RoadMethod, RoadOptions,
    camera::{Camera, Orientation},
    for_tests::TileOwner,
    gpu::{TileBuffers, tile_bytes},
};
use glam::{DVec2, DVec3};

use super::{
    ground_rays::Caster,
    support::{
        self, Drawing,
        areas::{
            FOREST, MEADOW, PARK, PlanArea, ROCK, SETTLEMENT, WATER, class_of, flat_looks,
            with_areas,
        },
        country::{self, Country},
        gpu,
        scene::{Scene, Tile},
        scenes::{center, four_tiles, hills, one_tile, style},
    },
};

/// The pictures of these tests are small, because every sample is compared with every outline near
/// it.
const SIZE: [u32; 2] = [280, 210];

/// The number of compared samples and the results.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Found {
    /// Samples compared by the GPU's depth, without those so close to an outline that rounding
    /// decides.
    by_depth: usize,
    /// Samples of these with another class.
    wrong_by_depth: usize,
    /// Samples compared by rays, if all nine rays through the pixel give the same class.
    by_rays: usize,
    /// Samples of these with another class.
    wrong_by_rays: usize,
    /// Samples with any class.
    painted: usize,
}

/// Outlines with their bounding boxes.
struct Outlines<'a>(Vec<(&'a PlanArea, [DVec2; 2])>);

impl<'a> Outlines<'a> {
    fn new(areas: &'a [PlanArea]) -> Self {
        let around = |area: &'a PlanArea| {
            let points = || area.rings.iter().flatten().copied();
            let low = points().reduce(DVec2::min).unwrap();
            (area, [low, points().reduce(DVec2::max).unwrap()])
        };
        Self(areas.iter().map(around).collect())
    }

    /// The areas whose bounding box, enlarged by `by_m`, contains a position.
    fn around(&self, at: DVec2, by_m: f64) -> impl Iterator<Item = &PlanArea> {
        let holds = move |[low, high]: [DVec2; 2]| {
            at.cmpge(low - by_m).all() && at.cmple(high + by_m).all()
        };
        self.0.iter().filter(move |(_, around)| holds(*around)).map(|(area, _)| *area)
    }

    /// The visible class at a position.
    fn topmost(&self, at: DVec2) -> Option<u8> {
        let inside = self.around(at, 0.0).filter(|area| is_inside(area, at));
        inside.map(|area| area.class).min()
    }

    /// Whether an outline is within this distance of a position.
    fn is_near(&self, at: DVec2, by_m: f64) -> bool {
        self.around(at, by_m).flat_map(segments).any(|[a, b]| {
            let along = ((at - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            at.distance(a + (b - a) * along) < by_m
        })
    }
}

/// Whether a position is inside by the even-odd rule: counts the intersections of a line to the
/// east with the outline.
fn is_inside(area: &PlanArea, at: DVec2) -> bool {
    let meets = |[a, b]: [DVec2; 2]| {
        (a.y > at.y) != (b.y > at.y) && at.x < a.x + (b.x - a.x) * (at.y - a.y) / (b.y - a.y)
    };
    segments(area).filter(|ends| meets(*ends)).count() % 2 == 1
}

fn segments(area: &PlanArea) -> impl Iterator<Item = [DVec2; 2]> {
    area.rings
        .iter()
        .flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)).map(|(a, b)| [*a, *b]))
}

/// Compares each sample of a drawing by its depth, and many by rays.
fn compare(scene: &Scene, areas: &[PlanArea], camera: &Camera, drawing: &Drawing) -> Found {
    let outlines = Outlines::new(areas);
    let mut found = Found::default();
    for (index, pixel) in drawing.pixels() {
        let drawn = drawn_at(drawing, index);
        if matches!(drawing.owners[index], TileOwner::Nobody | TileOwner::Wall(_)) {
            assert_eq!(drawn, None, "painted without ground at {pixel}");
            continue;
        }
        found.painted += usize::from(drawn.is_some());
        let depth_m = camera.depth_m(f64::from(drawing.depth[index]));
        let ground = camera.ray_start_in_world(pixel) + camera.ray_in_world(pixel) * depth_m;
        let far_m = ground.distance(camera.eye_in_world);
        // The depth is an f32, and so are positions relative to the eye. At a pixel's width of a
        // thousandth of the distance, this is a hundredth of a pixel.
        let band_m = 1e-5 * far_m + 0.005;
        let at = ground.truncate();
        if !outlines.is_near(at, band_m) {
            found.by_depth += 1;
            let expected = outlines.topmost(at);
            if expected != drawn && found.wrong_by_depth < 3 {
                println!("by depth at {pixel}: {drawn:?}, not {expected:?}");
            }
            found.wrong_by_depth += usize::from(expected != drawn);
        }
    }
    let caster = Caster::new(scene, camera);
    let seen = |at: DVec2| caster.hit(at).map(|hit| outlines.topmost(hit.at.truncate()));
    for (index, pixel) in some_of(drawing.pixels(), [5, 5, 1]) {
        if !matches!(drawing.owners[index], TileOwner::Ground(_)) {
            continue;
        }
        let expected = seen(pixel);
        let around = (0..9).map(|k| DVec2::new(f64::from(k % 3 - 1), f64::from(k / 3 - 1)) * 0.5);
        if expected.is_some() && around.into_iter().all(|by| seen(pixel + by) == expected) {
            found.by_rays += 1;
            found.wrong_by_rays += usize::from(expected != Some(drawn_at(drawing, index)));
        }
    }
    found
}

/// The class that a sample shows.
fn drawn_at(drawing: &Drawing, index: usize) -> Option<u8> {
    class_of(&drawing.ground[4 * index..4 * index + 4])
}

fn draw(scene: &Scene, camera: &Camera) -> Option<Drawing> {
    Some(scene.draw(&gpu()?, camera, RoadOptions::for_method(RoadMethod::None)))
}

/// Draws a scene from a camera, and checks that both references agree with the drawing and that
/// enough of it is painted.
fn check(name: &str, scene: &Scene, areas: &[PlanArea], camera: &Camera, least_painted: usize) {
    let Some(drawing) = draw(scene, camera) else { return };
    let found = compare(scene, areas, camera, &drawing);
    println!("areas, {name}: {found:?}");
    assert!(found.painted >= least_painted, "{name}: too little is painted for a test");
    assert_eq!([found.wrong_by_depth, found.wrong_by_rays], [0, 0], "{name}");
    assert!(found.by_depth > 1000 && found.by_rays > 1000, "{name}: too little is compared");
}

fn square([west, south]: [f64; 2], side: f64) -> Vec<[f64; 2]> {
    vec![[west, south], [west + side, south], [west + side, south + side], [west, south + side]]
}

fn circle([x, y]: [f64; 2], radius: f64, points: u32) -> Vec<[f64; 2]> {
    let angle = |k: u32| f64::from(k) / f64::from(points) * std::f64::consts::TAU;
    (0..points).map(|k| [x + radius * angle(k).cos(), y + radius * angle(k).sin()]).collect()
}

/// Views from above with parallel rays, with several headings.
#[test]
fn areas_agree_with_both_references_in_a_view_from_above() {
    for heading_deg in [0.0, 33.0] {
        let camera = Camera::from_above(center(), 4.0, heading_deg, [-3000.0, 3000.0], SIZE);
        check("from above", &on_hills(), &areas(), &camera, 1000);
    }
}

/// A star: concave, with sharp points.
fn star([x, y]: [f64; 2], radius: f64) -> Vec<[f64; 2]> {
    let of = |k: usize| if k.is_multiple_of(2) { radius } else { 0.35 * radius };
    circle([0.0; 2], 1.0, 14)
        .iter()
        .enumerate()
        .map(|(k, [east, north])| [x + of(k) * east, y + of(k) * north])
        .collect()
}

/// Around the middle of the root tile: a lake with an island that has a pond; a star of forest that
/// extends into the lake; two forests and an adjacent meadow, with common sides; a park with a pond
/// in a settlement, and a round park across its edge; rock.
fn areas() -> Vec<PlanArea> {
    let area = |class, rings: &[Vec<[f64; 2]>]| PlanArea::new(class, center(), rings);
    vec![
        area(
            WATER,
            &[
                circle([-350.0, 50.0], 260.0, 200),
                circle([-350.0, 50.0], 130.0, 40),
                square([-380.0, 20.0], 70.0),
            ],
        ),
        area(FOREST, &[star([-40.0, 120.0], 300.0)]),
        area(FOREST, &[square([180.0, -320.0], 250.0)]),
        area(FOREST, &[square([180.0, -70.0], 250.0)]),
        area(MEADOW, &[square([430.0, -320.0], 400.0)]),
        area(SETTLEMENT, &[square([-260.0, -520.0], 400.0)]),
        area(PARK, &[square([-160.0, -440.0], 160.0)]),
        area(WATER, &[circle([-80.0, -360.0], 40.0, 30)]),
        area(PARK, &[circle([140.0, -400.0], 70.0, 60)]),
        area(ROCK, &[vec![[-200.0, 480.0], [560.0, 300.0], [700.0, 760.0]]]),
    ]
}

fn on_hills() -> Scene {
    with_areas(&one_tile(8, hills, &[], style(1.0)), &support::frame(), &areas())
}

/// A camera whose eye is at a position.
fn eye_at(
    [x, y]: [f64; 2],
    height_m: f64,
    focus_m: f64,
    [heading_deg, pitch_deg]: [f64; 2],
) -> Camera {
    let eye = (center() + DVec2::new(x, y)).extend(height_m);
    let orientation = Orientation { heading_deg, pitch_deg };
    let backward = Camera::look_at(eye, 1.0, orientation, SIZE).world_from_view.z_axis;
    Camera::look_at(eye - backward * focus_m, focus_m, orientation, SIZE)
}

/// A camera that looks at the middle.
fn looking_at(height_m: f64, distance_m: f64, [heading_deg, pitch_deg]: [f64; 2]) -> Camera {
    let orientation = Orientation { heading_deg, pitch_deg };
    Camera::look_at(center().extend(height_m), distance_m, orientation, SIZE)
}

/// Height above the hills.
fn above([x, y]: [f64; 2], by_m: f64) -> f64 {
    hills(x, y) + by_m
}

#[test]
fn areas_agree_with_both_references_from_outside_and_above() {
    let (scene, areas) = (on_hills(), areas());
    for (heading_deg, pitch_deg, distance_m) in
        [(20.0, 45.0, 1800.0), (200.0, 65.0, 2500.0), (0.0, 0.0, 1500.0), (77.0, 5.0, 6000.0)]
    {
        let camera = looking_at(400.0, distance_m, [heading_deg, pitch_deg]);
        check(&format!("{heading_deg}° {pitch_deg}°"), &scene, &areas, &camera, 1000);
    }
}

#[test]
fn areas_agree_with_both_references_at_a_grazing_angle_and_behind_ridges() {
    let (scene, areas) = (on_hills(), areas());
    for (place, heading_deg, pitch_deg) in [
        ([-1500.0, -900.0], 60.0, 86.0),
        ([900.0, 1300.0], 215.0, 84.0),
        ([0.0, -2200.0], 0.0, 88.0),
    ] {
        // Just above the hilltops, 460 m: most areas are partly behind ridges.
        let camera = eye_at(place, 475.0, 1500.0, [heading_deg, pitch_deg]);
        check(&format!("grazing from {place:?}"), &scene, &areas, &camera, 300);
    }
}

#[test]
#[ignore = "slow: many pictures, each pixel by two references"]
fn areas_agree_with_both_references_with_the_eye_inside_a_volume() {
    let (scene, areas) = (on_hills(), areas());
    let places = [
        ("forest", [300.0, -180.0]),
        ("lake", [-540.0, 50.0]),
        ("settlement", [-230.0, -300.0]),
        ("island", [-350.0, 160.0]),
    ];
    let views = [(0.0, 80.0), (130.0, 60.0), (250.0, 92.0)];
    let all = places.into_iter().flat_map(|place| views.map(|view| (place, view)));
    for ((name, place), (heading_deg, pitch_deg)) in some_of(all, [5, 5, 1]) {
        let height_m = above(place, 4.0);
        let camera = eye_at(place, height_m, 60.0, [heading_deg, pitch_deg]);
        check(&format!("in the {name}, {heading_deg}°"), &scene, &areas, &camera, 1);
    }
}

#[test]
fn areas_agree_with_both_references_on_the_plane_of_a_wall_and_of_a_cap() {
    let (scene, areas) = (on_hills(), areas());
    // The common side of two forests runs at y = −70, and the sides of both at x = 180 and 430.
    let places = [
        ("along the common side", [-300.0, -70.0], 90.0),
        ("along the western sides", [180.0, -700.0], 0.0),
        ("on a wall", [300.0, -70.0], 90.0),
        ("on an edge", [180.0, -70.0], 45.0),
    ];
    for (name, place, heading_deg) in some_of(places, [4, 2, 1]) {
        // Near the ground most areas are behind hills.
        for (height_m, least) in [(above(place, 5.0), 0), (480.0, 200)] {
            let camera = eye_at(place, height_m, 300.0, [heading_deg, 80.0]);
            check(&format!("{name}, {height_m:.0} m"), &scene, &areas, &camera, least);
        }
    }
    // As high as the tops of volumes, which are 1/8 of a cell of 20 m above the highest ground near
    // them, in f32.
    for volumes in &scene.tiles[0].geometry.areas.classes {
        let reference_m = scene.tiles[0].geometry.reference_m[2];
        let top_m = reference_m + f64::from(volumes.box_in_tile[1][2]);
        let camera = eye_at([-900.0, -700.0], top_m, 900.0, [50.0, 88.0]);
        check(&format!("as high as class {}", volumes.class.class), &scene, &areas, &camera, 100);
    }
}

#[test]
#[ignore = "slow: many pictures, each pixel by two references"]
fn areas_agree_with_both_references_where_the_near_plane_cuts_volumes() {
    let (scene, areas) = (on_hills(), areas());
    // The near plane is at about a thousandth of the focus distance: with a far focus it is far
    // away.
    let places = [([170.0, -200.0], 90.0), ([440.0, -100.0], 270.0), ([-620.0, 60.0], 90.0)];
    for (place, heading_deg) in some_of(places, [3, 3, 1]) {
        for focus_m in [3000.0, 9000.0] {
            let camera = eye_at(place, above(place, 12.0), focus_m, [heading_deg, 75.0]);
            check(&format!("cut from {place:?}, {focus_m} m"), &scene, &areas, &camera, 200);
        }
    }
}

#[test]
fn areas_agree_with_both_references_across_tiles() {
    // The middle of the root is where the four tiles meet.
    let plain = four_tiles([8, 16, 8, 32], hills, &[], style(1.0));
    let areas = areas();
    let scene = with_areas(&plain, &support::frame(), &areas);
    for (heading_deg, pitch_deg, distance_m) in
        [(20.0, 45.0, 1800.0), (300.0, 75.0, 900.0), (0.0, 0.0, 1500.0)]
    {
        let camera = looking_at(400.0, distance_m, [heading_deg, pitch_deg]);
        check(&format!("four tiles, {heading_deg}°"), &scene, &areas, &camera, 1000);
    }
}

/// Coarse tiles in the west, fine ones in the east, and a lake, a forest and a settlement across
/// the border.
fn stepped() -> (Scene, GridFrame, Vec<PlanArea>) {
    let country = Country::new();
    let tiles = [(2, 1, 1), (2, 1, 2), (4, 8, 7), (4, 8, 8)].map(|(z, x, y)| {
        let id = TileId::new(z, x, y).unwrap();
        let (payload, widths) = (country.payload(id), country.widths(id));
        Tile::of_payload(&payload, &country.frame, country::QUANTUM_M, widths, 120.0)
    });
    let scene = Scene { tiles: tiles.to_vec(), style: style(1.0), layers: PackageLooks::default() };
    let middle = DVec2::from_array(country.frame.tile_bounds(TileId::ROOT).center());
    let area = |class, rings: &[Vec<[f64; 2]>]| PlanArea::new(class, middle, rings);
    let areas = vec![
        area(WATER, &[circle([0.0, 300.0], 1500.0, 120), square([-300.0, -200.0], 700.0)]),
        area(FOREST, &[star([200.0, -2500.0], 2200.0)]),
        area(SETTLEMENT, &[square([-1200.0, 1000.0], 3100.0)]),
    ];
    (with_areas(&scene, &country.frame, &areas), country.frame, areas)
}

#[test]
#[ignore = "slow: many pictures, each pixel by two references"]
fn areas_agree_with_both_references_over_the_border_of_two_levels_and_on_its_skirts() {
    let (scene, frame, areas) = stepped();
    let [x, y] = frame.tile_bounds(TileId::ROOT).center();
    let mut skirts = 0;
    let views = [(90.0, 60.0, 6000.0), (270.0, 75.0, 4000.0), (45.0, 30.0, 12_000.0)];
    for (heading_deg, pitch_deg, distance_m) in some_of(views, [2, 2, 1]) {
        let target = DVec3::new(x, y, country::height_m(x, y));
        let orientation = Orientation { heading_deg, pitch_deg };
        let camera = Camera::look_at(target, distance_m, orientation, SIZE);
        check(&format!("levels, {heading_deg}°"), &scene, &areas, &camera, 700);
        let Some(drawing) = draw(&scene, &camera) else { return };
        skirts += drawing
            .pixels()
            .filter(|(index, _)| {
                matches!(drawing.owners[*index], TileOwner::Skirt(_))
                    && drawn_at(&drawing, *index).is_some()
            })
            .count();
    }
    println!("areas on skirts: {skirts} samples");
    assert!(skirts > 10, "no skirt is painted");
}

/// The number of wrong samples in a drawing of a scene that was changed.
fn wrong(scene: &Scene, camera: &Camera) -> Option<usize> {
    let drawing = draw(scene, camera)?;
    Some(compare(scene, &areas(), camera, &drawing).wrong_by_depth)
}

/// Cameras outside of all volumes, and inside one.
fn two_cameras() -> [Camera; 2] {
    let outside = looking_at(400.0, 1800.0, [20.0, 45.0]);
    [outside, eye_at([300.0, -180.0], above([300.0, -180.0], 4.0), 60.0, [130.0, 80.0])]
}

fn check_fails(what: &str, camera: usize, change: impl Fn(&mut Scene)) {
    let mut scene = on_hills();
    let camera = two_cameras()[camera];
    let Some(right) = wrong(&scene, &camera) else { return };
    assert_eq!(right, 0, "the true scene passes");
    change(&mut scene);
    let found = wrong(&scene, &camera).unwrap_or_default();
    println!("areas must fail, {what}: {found} wrong");
    assert!(found > 40, "{what}: {found}");
}

#[test]
fn faces_counted_in_front_of_the_ground_with_the_eye_inside_fail() {
    check_fails("the eye treated as outside", 1, |scene| {
        // Far away from the eye.
        scene.tiles[0].geometry.areas.box_in_tile = Some([[-2e4; 3], [-1e4; 3]]);
    });
}

#[test]
fn volumes_without_caps_fail() {
    for camera in [0, 1] {
        check_fails("caps omitted", camera, |scene| {
            for volumes in &mut scene.tiles[0].geometry.areas.classes {
                volumes.triangles = 0..0;
            }
        });
    }
}

#[test]
fn walls_that_face_inwards_fail() {
    check_fails("walls turned", 0, |scene| {
        for wall in &mut scene.tiles[0].geometry.areas.walls {
            (wall.start_in_tile, wall.end_in_tile) = (wall.end_in_tile, wall.start_in_tile);
        }
    });
}

#[test]
fn a_wall_left_out_fails() {
    check_fails("a wall omitted", 0, |scene| {
        let areas = &mut scene.tiles[0].geometry.areas;
        let forest = areas.classes.iter().find(|volumes| volumes.class.class == FOREST);
        let first = forest.unwrap().walls.start as usize;
        areas.walls[first] = areas.walls[first + 1];
    });
}

#[test]
fn outlines_shifted_by_three_tenths_of_a_pixel_fail() {
    let camera = two_cameras()[0];
    let by_m = 0.3 * camera.pixel_at_unit_depth_m() * 1800.0;
    let mut scene = on_hills();
    let areas = &mut scene.tiles[0].geometry.areas;
    for wall in &mut areas.walls {
        wall.start_in_tile[0] += by_m as f32;
        wall.end_in_tile[0] += by_m as f32;
    }
    for corner in &mut areas.corners {
        corner.place_in_tile[0] += by_m as f32;
    }
    let Some(found) = wrong(&scene, &camera) else { return };
    println!("areas must fail, shifted by 0.3 px: {found} wrong");
    assert!(found > 50, "{found}");
}

/// The picture and the ground of a scene.
fn bytes(scene: &Scene, camera: &Camera) -> Option<[Vec<u8>; 2]> {
    let drawing = scene.draw(&gpu()?, camera, RoadOptions::for_method(RoadMethod::ShadowVolumes));
    Some([drawing.picture, drawing.ground])
}

#[test]
fn areas_that_are_not_drawn_change_no_byte_and_all_bytes_are_counted() {
    let Some(gpu) = gpu() else { return };
    let camera = two_cameras()[0];
    let plain = one_tile(8, hills, &crate::support::scenes::junction(), style(20.0));
    let with = with_areas(&plain, &support::frame(), &areas());
    let without = |scene: &Scene| Scene {
        style: with.style.clone(),
        layers: flat_looks(0.0),
        tiles: scene.tiles.clone(),
    };
    assert_eq!(bytes(&without(&with), &camera), bytes(&without(&plain), &camera));
    let drawn = Scene { tiles: plain.tiles.clone(), ..with.clone() };
    assert_eq!(bytes(&drawn, &camera), bytes(&without(&plain), &camera), "a package without areas");
    assert_ne!(bytes(&with, &camera), bytes(&drawn, &camera));

    let on_card = |scene: &Scene| {
        let tile = &scene.tiles[0].geometry;
        (TileBuffers::new(&gpu, tile, None).gpu_bytes(), tile_bytes(tile))
    };
    let [(with_bytes, with_told), (plain_bytes, plain_told)] = [&with, &plain].map(on_card);
    assert_eq!((with_bytes, plain_bytes), (with_told, plain_told));
    let areas = &with.tiles[0].geometry.areas;
    let (walls, corners) = (areas.walls.len() as u64, areas.corners.len() as u64);
    let boxes = areas.classes.len() as u64 * 24;
    let triangles = areas.triangles.len() as u64 * 4;
    assert_eq!(with_bytes - plain_bytes, walls * 24 + corners * 16 + triangles + boxes);
}

/// Water is painted where the triangle that a ray hits is gentle, and not where it is steep. Slopes
/// between the two, and pixels with another triangle near them, are not checked.
#[test]
fn steep_ground_is_not_painted() {
    let mut scene = on_hills();
    let classes = scene.layers.all().map(|(of, look)| match look {
        LayerLook::Area(area) if of.class == WATER => {
            LayerLook::Area(AreaStyle { steepest_deg: Some(14.0), ..area })
        }
        other => other,
    });
    scene.layers = PackageLooks::from_looks(vec![classes.collect()]);
    let (areas, steepest) = (areas(), 14_f64.to_radians().tan());
    let outlines = Outlines::new(&areas);
    for camera in [two_cameras()[0], Camera::from_above(center(), 4.0, 0.0, [-3e3, 3e3], SIZE)] {
        let Some(gpu) = gpu() else { return };
        let drawing = scene.draw(&gpu, &camera, RoadOptions::for_method(RoadMethod::None));
        let caster = Caster::new(&scene, &camera);
        let (mut found, mut wrong) = ([0; 2], 0);
        for (index, pixel) in some_of(drawing.pixels(), [2, 2, 1]) {
            let is_steep = |at: DVec2| {
                let hit = caster.hit(at)?;
                let is_water = outlines.topmost(hit.at.truncate()) == Some(WATER);
                let slope = hit.normal.truncate().length() / hit.normal.z.abs();
                let is_clear = !(0.69..1.01).contains(&(slope / steepest));
                (is_water && is_clear).then_some((slope > steepest, hit.normal.to_array()))
            };
            let around = (0..9).map(|k| DVec2::new(f64::from(k % 3 - 1), f64::from(k / 3 - 1)));
            let Some((steep, normal)) = is_steep(pixel) else { continue };
            if around.into_iter().all(|by| is_steep(pixel + by) == Some((steep, normal))) {
                found[usize::from(steep)] += 1;
                let blue = drawing.ground[4 * index + 2];
                wrong += usize::from(blue != if steep { 0 } else { 255 });
            }
        }
        println!("water on gentle and on steep ground: {found:?}, {wrong} wrong");
        assert!(found.iter().all(|count| *count > 100), "{found:?}");
        assert_eq!(wrong, 0);
    }
}
