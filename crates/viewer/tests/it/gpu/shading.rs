//! Shading from reliefs: independent of the triangles, without steps between tiles, and the same on
//! every level.

use corniche_geom::{HeightGrid, TileId};
use corniche_styles::Style;
use corniche_tileset::{Relief, TilePayload};
use corniche_viewer::{
    FrameView, Mapping, PackageLooks, RoadMethod, RoadOptions,
    for_tests::PlanScale,
    gpu::{DrawTile, Gpu, Renderer, SlopeChain, Targets, TileBuffers},
    tiles::TileGeometry,
};

use super::{
    camera,
    support::{Drawing, QUANTUM_M, WIDTH_MARGIN_M, frame, gpu, terrain},
};

/// Smooth ground, with slopes up to a quarter.
fn hills(x: f64, y: f64) -> f64 {
    400.0 + 100.0 * (x / 520.0).sin() * (y / 610.0).cos()
}

/// A tile with a vertex every `step` nodes. Beyond the tile's border, its relief has the heights
/// `beyond`.
fn tile(
    id: TileId,
    step: u16,
    height_m: &dyn Fn(f64, f64) -> f64,
    beyond: Option<f64>,
) -> TilePayload {
    let window = frame().tile_window(id);
    let (first, second) = (window.node(0, 0), window.node(1, 1));
    let (di, dj) = (second.i - first.i, second.j - first.j);
    let raster = HeightGrid::from_fn(259, 259, |column, row| {
        let (i, j) = (column as i64 - 1, row as i64 - 1);
        let inside = [i, j].iter().all(|at| (0..=256).contains(at));
        let (x, y) = (frame().x_m(first.i + di * i), frame().y_m(first.j + dj * j));
        beyond.filter(|_| !inside).unwrap_or_else(|| height_m(x, y)) as f32
    });
    let cell = frame().level_cell(id.z());
    TilePayload {
        id,
        terrain: Some(terrain(id, step, height_m)),
        relief: Some(Relief::of_heights(&raster, &raster, cell, QUANTUM_M).unwrap()),
        roads_geo: vec![],
        roads_sv: vec![],
        attributes: vec![],
    }
}

/// The four tiles of the finest level.
fn finest(step: u16, height_m: &dyn Fn(f64, f64) -> f64) -> Vec<TilePayload> {
    TileId::ROOT.children().map(|id| tile(id, step, height_m, None)).collect()
}

fn without_relief(tiles: Vec<TilePayload>) -> Vec<TilePayload> {
    tiles.into_iter().map(|tile| TilePayload { relief: None, ..tile }).collect()
}

/// How tiles are drawn.
#[derive(Clone, Copy)]
struct Look {
    exaggeration: f64,
    /// Same as in styles.
    gentle: f32,
    /// Maximum size of a cell on the picture, pixels.
    cell_px: f64,
    /// Distance from the eye to the middle of the ground.
    distance_m: f64,
}

/// Shading without changes: gentle slopes are not made steeper, levels are not blended.
const PLAIN: Look =
    Look { exaggeration: 1.0, gentle: 1.0, cell_px: UNBLENDED_PX, distance_m: 5000.0 };

/// With this cell size there is no blending, so each tile is shaded by its own slopes.
const UNBLENDED_PX: f64 = 1e-9;

/// The distance from which on the cells of the root look smaller than two pixels.
const ROOT_CHOSEN_M: f64 = 6500.0;

/// Draws tiles straight from above. All ground has one tint, so colours depend only on slopes.
fn draw(gpu: &Gpu, payloads: &[TilePayload], look: Look) -> Drawing {
    draw_beneath(gpu, None, payloads, look)
}

/// Same as [`draw`], for the children of a tile.
fn draw_beneath(
    gpu: &Gpu,
    parent: Option<&TilePayload>,
    payloads: &[TilePayload],
    look: Look,
) -> Drawing {
    let mut style = Style::road_atlas();
    style.tint.stops.iter_mut().for_each(|(_, rgb)| *rgb = [0.8; 3]);
    style.light.valley_haze = 0.0;
    style.light.gentle = look.gentle;
    let scale = PlanScale::uniform([1.0; 2]);
    let geometry = |payload: &TilePayload| {
        let margin = (WIDTH_MARGIN_M, scale);
        let mapping = Mapping::OnTriangles;
        TileGeometry::from_payload(payload, None, &frame(), QUANTUM_M, margin, mapping).unwrap()
    };
    let above = parent.map(|parent| SlopeChain::new(gpu, &geometry(parent), None));
    let buffers: Vec<TileBuffers> = payloads
        .iter()
        .map(|payload| TileBuffers::new(gpu, &geometry(payload), above.as_ref()))
        .collect();
    let tiles: Vec<DrawTile<'_>> =
        buffers.iter().map(|buffers| DrawTile { buffers, skirt_depth_m: 0.0 }).collect();
    let camera = camera(400.0 * look.exaggeration, look.distance_m, 0.0, 0.0);
    let targets = Targets::new(gpu, camera.size_px, 1).unwrap();
    let view = FrameView {
        camera: &camera,
        style: &style,
        layers: PackageLooks::NONE,
        roads: RoadOptions::for_method(RoadMethod::None),
        exaggeration: look.exaggeration,
        point_scale: 1.0,
        height_range_m: [0.0, 1000.0],
        wall_m: 0.0,
        cell_px: look.cell_px,
        latitude_deg: 47.0,
        is_wireframe: false,
    };
    Renderer::new(gpu).draw(gpu, &view, &tiles, &targets);
    Drawing::read(gpu, &targets)
}

/// The green channel of each pixel of the ground, 0 to 255; `None` outside the ground.
fn greys(drawing: &Drawing) -> Vec<Option<i32>> {
    let texels = drawing.ground.as_chunks::<4>().0;
    texels.iter().map(|[_, green, _, alpha]| (*alpha == 255).then_some(i32::from(*green))).collect()
}

/// Differences of two drawings at their common pixels, in a square of this many pixels around the
/// middle, the smallest first.
fn differences(one: &Drawing, other: &Drawing, side_px: f64) -> Vec<i32> {
    let middle = one.size_px.map(|side| f64::from(side) / 2.0);
    let inside = one
        .pixels()
        .filter(|(_, at)| (at.x - middle[0]).abs().max((at.y - middle[1]).abs()) < side_px / 2.0);
    let greys = [greys(one), greys(other)];
    let mut both: Vec<i32> =
        inside.filter_map(|(at, _)| Some((greys[0][at]? - greys[1][at]?).abs())).collect();
    assert!(both.len() as f64 > side_px * side_px / 2.0, "the ground fills the square");
    both.sort_unstable();
    both
}

/// Maximum amount, in grey levels, by which neighbouring pixels of two tiles differ more than the
/// pixels next to them.
fn largest_step(drawing: &Drawing) -> i32 {
    let greys = greys(drawing);
    let width = drawing.size_px[0] as usize;
    let mut largest = 0;
    let mut crossings = 0;
    for stride in [1, width] {
        for at in 3 * stride..greys.len() - 3 * stride {
            if drawing.owners[at] == drawing.owners[at + stride] {
                continue;
            }
            let line = [at - stride, at, at + stride, at + 2 * stride].map(|at| greys[at]);
            let [Some(a), Some(b), Some(c), Some(d)] = line else { continue };
            crossings += 1;
            largest = largest.max((c - b).abs() - (b - a).abs().max((d - c).abs()));
        }
    }
    assert!(crossings > 800, "{crossings} pixels at a border");
    largest
}

#[test]
fn shading_does_not_depend_on_the_triangles() {
    let Some(gpu) = gpu() else { return };
    let steep = |x: f64, y: f64| 400.0 + 30.0 * (x / 90.0).sin() * (y / 110.0).cos();
    let [fine, coarse] = [2, 64].map(|step| finest(step, &steep));
    let difference = |one: &[TilePayload], other: &[TilePayload]| {
        // Near the middle, the eye sees the same plan position even if the ground is some metres
        // higher.
        *differences(&draw(&gpu, one, PLAIN), &draw(&gpu, other, PLAIN), 60.0).last().unwrap()
    };
    let with = difference(&fine, &coarse);
    assert!(with <= 3, "{with} grey levels");
    let without = without_relief(coarse);
    let difference = difference(&fine, &without);
    assert!(
        difference > 15,
        "without a relief the triangles show, but differ by {difference} only"
    );
}

#[test]
fn there_is_no_step_between_tiles() {
    let Some(gpu) = gpu() else { return };
    let step = largest_step(&draw(&gpu, &finest(32, &hills), PLAIN));
    assert!(step <= 1, "{step} grey levels");
    // Each tile alone: the heights beyond its border are different.
    let children = TileId::ROOT.children();
    let alone: Vec<TilePayload> = children.map(|id| tile(id, 32, &hills, Some(390.0))).collect();
    let step = largest_step(&draw(&gpu, &alone, PLAIN));
    assert!(step > 4, "the measure sees a step of {step} grey levels only");
}

/// Differences between the root and its children at the distance from which on the root may be
/// drawn: this is the step where two levels meet. The smallest first.
fn level_steps(gpu: &Gpu, height_m: &dyn Fn(f64, f64) -> f64, cell_px: f64) -> Vec<i32> {
    let look = Look { gentle: Style::road_atlas().light.gentle, cell_px, ..PLAIN };
    let look = Look { distance_m: ROOT_CHOSEN_M, ..look };
    let root = tile(TileId::ROOT, 32, height_m, None);
    let children = draw_beneath(gpu, Some(&root), &finest(64, height_m), look);
    differences(&draw(gpu, &[root], look), &children, 300.0)
}

/// Where two levels meet, shading continues without a step: at the distance where the parent may be
/// drawn, a tile looks like its parent. The style is the default, which shades gentle slopes as if
/// they were steeper. Without blending the same ground has steps.
#[test]
fn levels_meet_within_a_grey_level() {
    let Some(gpu) = gpu() else { return };
    // Waves of five cells of the root, ten of the children.
    let rough = |x: f64, y: f64| hills(x, y) + 6.0 * (x / 16.0).sin() * (y / 17.0).cos();
    for (name, height_m, unblended) in
        [("smooth", &hills as &dyn Fn(f64, f64) -> f64, 4), ("rough", &rough, 15)]
    {
        let [blended, own] =
            [2.0, UNBLENDED_PX].map(|cell_px| level_steps(&gpu, height_m, cell_px));
        let figures = |all: &[i32]| (all[all.len() * 199 / 200], all[all.len() - 1]);
        println!(
            "{name}: 99.5 % and most, grey levels: {:?}; not blended {:?}",
            figures(&blended),
            figures(&own)
        );
        assert!(figures(&blended).1 <= 1, "{name}: {:?}", figures(&blended));
        assert!(figures(&own).1 >= unblended, "{name}: the measure sees nothing");
    }
}

/// Below a tile without a relief, and near the eye, a tile is shaded only by its own slopes.
#[test]
fn near_the_eye_tiles_have_their_own_slopes() {
    let Some(gpu) = gpu() else { return };
    let rough = |x: f64, y: f64| hills(x, y) + 6.0 * (x / 16.0).sin() * (y / 17.0).cos();
    let root = tile(TileId::ROOT, 32, &rough, None);
    let bare = TilePayload { relief: None, ..root.clone() };
    let children = finest(64, &rough);
    let own = |look| draw(&gpu, &children, look).ground;
    // The children's cells look two pixels large.
    let near = Look { cell_px: 2.0, distance_m: 2200.0, ..PLAIN };
    assert!(draw_beneath(&gpu, Some(&root), &children, near).ground == own(near));
    let far = Look { cell_px: 2.0, distance_m: ROOT_CHOSEN_M, ..PLAIN };
    assert!(draw_beneath(&gpu, Some(&root), &children, far).ground != own(far));
    assert!(draw_beneath(&gpu, Some(&bare), &children, far).ground == own(far));
}

/// Without blending, two levels differ by at most a grey level on smooth ground, except for one
/// pixel in two hundred, with three: the light on slopes that face it differs more than a clamped
/// cosine would.
#[test]
fn levels_by_themselves_differ_by_a_grey_level_on_smooth_ground() {
    let Some(gpu) = gpu() else { return };
    let root = [tile(TileId::ROOT, 32, &hills, None)];
    let all =
        differences(&draw(&gpu, &root, PLAIN), &draw(&gpu, &finest(64, &hills), PLAIN), 440.0);
    let most_of = all[all.len() * 199 / 200];
    println!("levels differ by {most_of} and {} grey levels at most", all[all.len() - 1]);
    assert!(most_of <= 1 && all[all.len() - 1] <= 3, "{most_of}, {}", all[all.len() - 1]);
    // Without reliefs they differ by the detail that their triangles omit.
    let [root, finest] = [vec![tile(TileId::ROOT, 32, &hills, None)], finest(128, &hills)];
    let bare = [root, finest].map(without_relief);
    let all = differences(&draw(&gpu, &bare[0], PLAIN), &draw(&gpu, &bare[1], PLAIN), 440.0);
    assert!(all[all.len() - 1] > 3, "the measure sees nothing");
}

#[test]
fn stretched_ground_is_shaded_as_ground_of_that_height() {
    let Some(gpu) = gpu() else { return };
    let stretched = draw(&gpu, &finest(32, &hills), Look { exaggeration: 2.0, ..PLAIN });
    let high = draw(&gpu, &finest(32, &|x, y| 2.0 * hills(x, y)), PLAIN);
    // The eye is at another height over the second ground, so only common pixels near the middle
    // are compared.
    let (one, other) = (greys(&stretched), greys(&high));
    let [width, height] = stretched.size_px.map(|side| side as usize);
    for row in height / 2 - 2..height / 2 + 2 {
        for column in width / 2 - 2..width / 2 + 2 {
            let at = row * width + column;
            let (one, other) = (one[at].unwrap(), other[at].unwrap());
            assert!((one - other).abs() <= 2, "{one} and {other}");
        }
    }
}
