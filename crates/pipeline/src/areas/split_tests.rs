use std::collections::BTreeMap;

use corniche_areas::{AreaClass, AreaObject, OutlineWay, assemble};
use corniche_geom::{LatticePoint, NodeIndex};
use proptest::prelude::*;

use super::*;

/// Three levels of tiles, 10 m cells.
fn frame() -> Frame {
    Frame::new([0.0, 0.0], 10.0, NodeIndex { i: -512, j: 512 }, 2).unwrap()
}

fn splitting(frame: &Frame) -> Splitting<'_> {
    let [south_west, north_east] = [[-512, -512], [511, 511]].map(|[i, j]| NodeIndex { i, j });
    Splitting { frame, data: DataTiles::between(frame, south_west, north_east), clip: None }
}

/// A star around a place, with a hole.
fn star(center: [i64; 2], radii: &[i64]) -> Area {
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
    Area {
        object: AreaObject::Way(5),
        class: AreaClass::Water,
        name: None,
        polygons: assemble(&ways).unwrap().polygons,
        area_m2: 1.0,
    }
}

fn doubled_area(parts: &[AreaRings]) -> i128 {
    let of_ring = |ring: &Vec<LatticePoint>| -> i128 {
        let next = ring.iter().cycle().skip(1);
        ring.iter().zip(next).map(|(&a, &b)| corniche_geom::cross(ring[0], a, b)).sum()
    };
    parts.iter().flat_map(|part| &part.rings).map(of_ring).sum()
}

/// Stretches of an upright line, the border of a tile, along which its parts run. A corner of the outline that touches the line from one side
/// is a point of the part on that side alone; both cover the same of the line.
fn along(parts: &[AreaRings], u: i64) -> Vec<[i64; 2]> {
    let mut pieces = Vec::new();
    for ring in parts.iter().flat_map(|part| &part.rings) {
        for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            if a.u == u && b.u == u {
                pieces.push([a.v.min(b.v), a.v.max(b.v)]);
            }
        }
    }
    pieces.sort_unstable();
    pieces.dedup_by(|later, piece| {
        let touches = later[0] <= piece[1];
        if touches {
            piece[1] = piece[1].max(later[1]);
        }
        touches
    });
    pieces
}

#[test]
fn steps_are_powers_of_two_that_double_from_level_to_level() {
    let frame = frame();
    let steps: Vec<i64> = (0..=2).map(|level| splitting(&frame).step(level)).collect();
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

    /// The parts of each level are the area, but for its coarse lattice; neighbours share the line between them.
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
        let mut by_level: BTreeMap<u8, BTreeMap<TileId, Vec<AreaRings>>> = BTreeMap::new();
        for (id, record) in splitting.split(&area).unwrap() {
            let bounds = frame.tile_lattice_bounds(id);
            let points = record.polygons.iter().flat_map(|part| &part.rings).flatten();
            prop_assert!(points.into_iter().all(|&point| bounds.contains(point)));
            by_level.entry(id.z()).or_default().insert(id, record.polygons);
        }
        for (level, tiles) in by_level {
            let sum: i128 = tiles.values().map(|parts| doubled_area(parts)).sum();
            // All of it is inside the root unless the star reaches beyond 5120 m.
            let around: i128 = 4 * radii.iter().map(|&radius| i128::from(radius)).sum::<i128>();
            let off = i128::from(splitting.step(level)) * around;
            let reach = 3000 + 1500;
            prop_assert!(reach < 5120 && (sum - whole).abs() <= off, "{level}: {sum} of {whole}");
            for (id, parts) in &tiles {
                let Some(east) = id.neighbour(1, 0) else { continue };
                let line = frame.tile_lattice_bounds(*id).max.u;
                // On the coarse lattice an edge of the outline itself can come to lie on the line: it has the area on one side alone.
                let near = |point: &&LatticePoint| (point.u - line).abs() <= splitting.step(level);
                let rings = area.polygons.iter().flat_map(Polygon::rings);
                if rings.map(|ring| ring.points().iter().filter(near).count()).any(|count| count > 1) {
                    continue;
                }
                let other = tiles.get(&east).map_or_else(Vec::new, |parts| along(parts, line));
                prop_assert_eq!(along(parts, line), other, "{} and {}", id, east);
            }
        }
    }
}
