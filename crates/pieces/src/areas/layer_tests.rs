//! The parts of an area add up on every level, and neighbours share their borders.

use std::{
    collections::{BTreeMap, BTreeSet},
    sync::LazyLock,
};

use corniche_areas::{OutlineWay, assemble};
use corniche_geom::{LatticePoint, NodeIndex};
use corniche_layers::{LayerTable, OsmObject};
use corniche_presets::{layer_preset, parse_layer_table};
use corniche_testing::FlatProjection;
use corniche_tileset::LayerObject;
use corniche_verify::area_seams::{Beside, TileSeam};
use proptest::prelude::*;

use super::*;

static TABLE: LazyLock<LayerTable> =
    LazyLock::new(|| parse_layer_table(layer_preset("areas").unwrap()).unwrap());

const PROJECTION: FlatProjection =
    FlatProjection { origin_m: [0.0; 2], origin_deg: [0.0; 2], metres_per_degree: [1e5; 2] };

/// Three levels of tiles, 10 m cells.
fn frame() -> GridFrame {
    GridFrame::new([0.0, 0.0], 10.0, NodeIndex { i: -512, j: 512 }, 2).unwrap()
}

/// The root tile as a whole.
fn root() -> &'static AreaExtent {
    static WHOLE: LazyLock<AreaExtent> =
        LazyLock::new(|| AreaExtent::of_rectangle(frame().tile_lattice_bounds(TileId::ROOT)));
    &WHOLE
}

fn splitting(frame: &GridFrame) -> AreaSplitting<'_> {
    let [south_west, north_east] = [[-512, -512], [511, 511]].map(|[i, j]| NodeIndex { i, j });
    let data = DataTiles::between(frame, south_west, north_east);
    let plan = PlanSplitting { table: &TABLE, frame, data, clip: None, polygon: None };
    AreaSplitting { plan, extent: root(), projection: &PROJECTION }
}

/// A star around a position, with a hole.
fn star(center: [i64; 2], radii: &[i64]) -> LayerArea {
    let ring = |part: f64| -> Vec<LatticePoint> {
        let corner = |(number, radius): (usize, &i64)| {
            let angle = number as f64 / radii.len() as f64 * std::f64::consts::TAU;
            let [u, v] =
                [angle.cos(), angle.sin()].map(|along| (along * part * *radius as f64) as i64);
            LatticePoint::new(center[0] + u, center[1] + v)
        };
        let corners: Vec<LatticePoint> = radii.iter().enumerate().map(corner).collect();
        corners.iter().chain(corners.first()).copied().collect()
    };
    let rings = [ring(1.0), ring(0.3)];
    let ways = rings.each_ref().map(|points| OutlineWay { points });
    area(assemble(&ways).unwrap().polygons)
}

fn area(polygons: Vec<Polygon>) -> LayerArea {
    LayerArea { object: OsmObject::Way(5), class: 1, values: vec![None], polygons, area_m2: 1.0 }
}

fn record(area: &LayerArea, polygons: Vec<AreaPolygon>) -> LayerObject {
    let LayerArea { object, class, values, .. } = area.clone();
    LayerObject { class, object, values, shape: LayerShape::Area(polygons) }
}

/// The parts of an area by level and tile.
fn by_level(
    splitting: &AreaSplitting<'_>,
    area: &LayerArea,
) -> BTreeMap<u8, BTreeMap<TileId, LayerObject>> {
    let mut by_level: BTreeMap<u8, BTreeMap<TileId, LayerObject>> = BTreeMap::new();
    for (id, polygons) in splitting.split(area).unwrap() {
        by_level.entry(id.z()).or_default().insert(id, record(area, polygons));
    }
    by_level
}

fn doubled_area(object: &LayerObject) -> i128 {
    let of_ring = |ring: &Vec<LatticePoint>| -> i128 {
        let next = ring.iter().cycle().skip(1);
        ring.iter().zip(next).map(|(&a, &b)| corniche_geom::cross(ring[0], a, b)).sum()
    };
    object.shape.rings().map(of_ring).sum()
}

/// Asserts that neighbours cover the same sections of the line between them. Outlines of the area
/// that run along this line are excepted: an outline along the whole line cannot be distinguished
/// from a missing part.
fn assert_seams_hold(area: &LayerArea, tiles: &BTreeMap<TileId, LayerObject>) {
    let frame = &frame();
    let all = tiles
        .keys()
        .flat_map(|&id| [id, id.neighbour(-1, 0).unwrap_or(id), id.neighbour(0, -1).unwrap_or(id)]);
    for id in all.collect::<BTreeSet<TileId>>() {
        for beside in [Beside::East, Beside::South] {
            let Some(neighbour) = beside.neighbour(id) else { continue };
            let seam = TileSeam::new(frame, id, beside, None);
            let of = |id: TileId| tiles.get(&id).map_or(&[][..], std::slice::from_ref);
            let covered = [id, neighbour]
                .map(|id| seam.covered(of(id)).into_values().next().unwrap_or_default());
            let mut broken = seam.broken(covered.each_ref().map(Vec::as_slice));
            let step = splitting(frame).plan.step(id.z());
            let whole: Vec<Polygon> =
                area.polygons.iter().flat_map(|polygon| coarsen(polygon, step).unwrap()).collect();
            let outline = seam
                .covered(&[record(area, whole.iter().map(rings_of).collect())])
                .into_values()
                .flatten();
            let outline: Vec<[i64; 2]> = outline.collect();
            broken.retain(|[from, to]| !outline.iter().any(|[a, b]| a <= from && to <= b));
            assert_eq!(broken, [[0; 2]; 0], "{id} and {neighbour}: {covered:?}");
        }
    }
}

#[test]
fn steps_are_powers_of_two_that_double_from_level_to_level() {
    let frame = frame();
    let steps: Vec<i64> = (0..=2).map(|level| splitting(&frame).plan.step(level)).collect();
    let metres: Vec<f64> = steps.iter().map(|&step| step as f64 * frame.lattice_step_m()).collect();
    assert!(metres[2] <= 0.1 && metres[2] > 0.05, "{metres:?}");
    assert!(metres[1] <= 20.0 / 4.0 && metres[1] > 20.0 / 8.0, "{metres:?}");
    assert_eq!(steps[0], 2 * steps[1]);
}

#[test]
fn what_is_smaller_than_a_cell_is_left_out_on_coarse_levels() {
    let frame = frame();
    let metre = (1.0 / frame.lattice_step_m()) as i64;
    let parts =
        splitting(&frame).split(&star([100 * metre, 100 * metre], &[8 * metre; 12])).unwrap();
    assert_eq!(parts.iter().map(|(id, _)| id.z()).collect::<Vec<_>>(), [2]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// The parts on each level add up to the area, apart from the coarse lattice; neighbours share
    /// the line between them.
    #[test]
    fn parts_of_a_level_add_up_and_share_their_borders(
        center in [-1500_i64..1500, -1500_i64..1500],
        radii in prop::collection::vec(300_i64..3000, 5..30),
    ) {
        let frame = frame();
        let metre = (1.0 / frame.lattice_step_m()) as i64;
        let radii: Vec<i64> = radii.into_iter().map(|radius| radius * metre).collect();
        let area = star(center.map(|part| part * metre), &radii);
        let whole: i128 = area.polygons.iter().map(Polygon::doubled_area).sum();
        let splitting = splitting(&frame);
        for (level, tiles) in by_level(&splitting, &area) {
            for (&id, record) in &tiles {
                let bounds = frame.tile_lattice_bounds(id);
                prop_assert!(record.shape.points().all(|&point| bounds.contains(point)));
            }
            let sum: i128 = tiles.values().map(doubled_area).sum();
            // The whole star is inside the root unless it reaches beyond 5120 m.
            let around: i128 = 4 * radii.iter().map(|&radius| i128::from(radius)).sum::<i128>();
            let off = i128::from(splitting.plan.step(level)) * around;
            let reach = 3000 + 1500;
            prop_assert!(reach < 5120 && (sum - whole).abs() <= off, "{level}: {sum} of {whole}");
            assert_seams_hold(&area, &tiles);
        }
    }

    /// An area is clipped to a triangle anywhere: seams hold, nothing is outside, and the parts
    /// inside and outside add up to the area.
    #[test]
    fn areas_end_at_the_outline_of_a_polygon(
        center in [-1500_i64..1500, -1500_i64..1500],
        radii in prop::collection::vec(300_i64..3000, 5..30),
        corners in prop::array::uniform3([-4000_i64..4000, -4000_i64..4000]),
    ) {
        let frame = frame();
        let metre = (1.0 / frame.lattice_step_m()) as i64;
        let radii: Vec<i64> = radii.into_iter().map(|radius| radius * metre).collect();
        let area = star(center.map(|part| part * metre), &radii);
        let corner = |[u, v]: [i64; 2]| LatticePoint::new(u * metre, v * metre);
        let triangle = corners.map(corner).to_vec();
        let square = [[-9000, -9000], [9000, -9000], [9000, 9000], [-9000, 9000]].map(corner).to_vec();
        let Some(inside) = LatticeRegion::new(&[vec![triangle.clone()]]) else { return Ok(()) };
        let outside = LatticeRegion::new(&[vec![square, triangle]]).unwrap();
        let whole: BTreeMap<_, _> = by_level(&splitting(&frame), &area);
        let [within, beside] = [&inside, &outside].map(|region| {
            let plan = PlanSplitting { polygon: Some(region), ..splitting(&frame).plan };
            by_level(&AreaSplitting { plan, ..splitting(&frame) }, &area)
        });
        for (level, tiles) in &whole {
            let step = splitting(&frame).plan.step(*level);
            let mut sums = [0; 2];
            for (part, sum) in [&within, &beside].into_iter().zip(&mut sums) {
                let Some(tiles) = part.get(level) else { continue };
                assert_seams_hold(&area, tiles);
                *sum = tiles.values().map(doubled_area).sum::<i128>();
            }
            // `verify` tolerates the same amount: corners and crossings move by half a step, and
            // then to a nearby end.
            let around = inside.bounds().expanded(3 * step);
            let points = within.get(level).into_iter().flat_map(|tiles| tiles.values());
            let mut points = points.flat_map(|record| record.shape.points());
            prop_assert!(points.all(|&point| around.contains(point)));
            let all: i128 = tiles.values().map(doubled_area).sum();
            let off = i128::from(step) * 4 * (radii.iter().map(|&radius| i128::from(radius)).sum::<i128>() + 3 * 12_000 * i128::from(metre));
            prop_assert!((sums[0] + sums[1] - all).abs() <= off, "{level}: {sums:?} of {all}");
        }
    }

    /// Outlines that run along the lines between tiles, cross them at corners and next to corners,
    /// and leave them at any angle.
    #[test]
    fn seams_hold_where_outlines_run_along_them(
        cells in prop::collection::btree_set((-5_i64..5, -5_i64..5), 1..70),
        moved in prop::collection::vec((-2_i64..3, -2_i64..3), 121),
        side_cells in prop::sample::select(vec![3_i64, 16, 100]),
        fine in prop::sample::select(vec![0_i64, 0, 1, 17]),
    ) {
        let frame = frame();
        let splitting = splitting(&frame);
        let side = side_cells * frame.node_steps(2)[0];
        let place = |[x, y]: [i64; 2]| {
            let (east, north) = moved[(11 * (y + 5) + x + 5) as usize];
            LatticePoint::new(x * side + east * side / 6 + fine * east, y * side + north * side / 6 + fine * north)
        };
        let rings: Vec<Vec<LatticePoint>> = cells
            .iter()
            .map(|&(x, y)| [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1], [x, y]].map(place).to_vec())
            .collect();
        let ways: Vec<_> = rings.iter().map(|points| OutlineWay { points }).collect();
        let area = area(assemble(&ways).unwrap().polygons);
        for (_, tiles) in by_level(&splitting, &area) {
            assert_seams_hold(&area, &tiles);
        }
    }
}
