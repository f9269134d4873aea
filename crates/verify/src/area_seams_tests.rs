//! The check of area seams finds an area that a tile lacks, and reports no outline along a border.

use corniche_geom::NodeIndex;
use corniche_tileset::{AreaPolygon, LayerShape};

use super::*;

/// Three levels of tiles around a common corner, with cells of 10 m.
fn frame() -> GridFrame {
    GridFrame::new([0.0, 0.0], 10.0, NodeIndex { i: -512, j: 512 }, 2).unwrap()
}

/// The finest tile north-west of that corner.
fn tile() -> TileId {
    TileId::new(2, 1, 1).unwrap()
}

/// The seams of the tile in the east and in the south.
fn seams() -> [TileSeam; 2] {
    [Beside::East, Beside::South].map(|beside| TileSeam::new(&frame(), tile(), beside, None))
}

fn record(object: OsmObject, rings: &[&[[i64; 2]]]) -> LayerObject {
    let points = |ring: &[[i64; 2]]| ring.iter().map(|&[u, v]| LatticePoint::new(u, v)).collect();
    let polygons = rings.iter().map(|ring| AreaPolygon { rings: vec![points(ring)] }).collect();
    LayerObject { class: 0, object, values: Vec::new(), shape: LayerShape::Area(polygons) }
}

#[test]
fn what_an_area_covers_of_a_line() {
    let object = OsmObject::Way(1);
    // Two parts that touch on the line, one next to the line, and a corner on the line.
    let areas = [record(
        object,
        &[
            &[[-9, 10], [0, 10], [0, 20], [-9, 20]],
            &[[-9, 30], [0, 20], [0, 30]],
            &[[-9, 40], [-1, 40], [-1, 50]],
            &[[-9, 60], [0, 60], [-9, 70]],
        ],
    )];
    let [east, south] = seams();
    assert_eq!(east.covered(&areas), BTreeMap::from([(object, vec![[10, 30]])]));
    assert_eq!(south.covered(&areas), BTreeMap::new());
    let areas = [record(object, &[&[[-9, 0], [-4, 0], [-9, 5]]])];
    assert_eq!(south.covered(&areas), BTreeMap::from([(object, vec![[-9, -4]])]));
}

#[test]
fn stretches_without_others() {
    for (stretches, others, left) in [
        (&[[0, 9]][..], &[][..], &[[0, 9]][..]),
        (&[[0, 9]], &[[0, 9]], &[]),
        (&[[0, 9]], &[[2, 3], [5, 12]], &[[0, 2], [3, 5]]),
        (&[[0, 4], [6, 9]], &[[-3, 1], [3, 7]], &[[1, 3], [7, 9]]),
        (&[[0, 4], [6, 9]], &[[4, 6], [9, 11]], &[[0, 4], [6, 9]]),
        (&[[0, 1], [2, 3], [4, 5]], &[[0, 5]], &[]),
    ] {
        assert_eq!(without(stretches, others), left, "{stretches:?} without {others:?}");
    }
}

/// Like in the drawing of the module: only the first tile covers the line from one corner of the
/// outline to another.
#[test]
fn an_outline_that_runs_along_the_line_is_not_broken() {
    for seam in seams() {
        let [first, last] = seam.whole;
        let step = seam.step;
        let crossing = first + 5 * step + 3;
        let [one, other] = [first + 7 * step, last - 2 * step];
        for (covered, expected) in [
            ([[crossing, other], [crossing, one]], &[][..]),
            ([[crossing, one], [crossing, other]], &[]),
            ([[one, last], [one, other]], &[]),
            ([[first, last], [one, last]], &[]),
            // No corners of an outline.
            ([[crossing, other], [one, other]], &[[crossing, one]]),
            ([[one, other], [one, other - 1]], &[[other - 1, other]]),
            ([[one + 1, last], [other, last]], &[[one + 1, other]]),
        ] {
            let found = seam.broken(covered.each_ref().map(std::slice::from_ref));
            assert_eq!(found, expected, "{covered:?}");
        }
    }
}

#[test]
fn an_area_that_a_tile_lacks_is_broken() {
    for seam in seams() {
        let [first, last] = seam.whole;
        let crossing = first + 5 * seam.step + 3;
        for covered in
            [[crossing, last], [first, crossing], [crossing, crossing + 900], [first, last]]
        {
            assert_eq!(seam.broken([&[covered], &[]]), [covered]);
            assert_eq!(seam.broken([&[], &[covered]]), [covered]);
        }
    }
}

/// A line without points of the level's lattice has no outline along it.
#[test]
fn no_outline_runs_along_a_line_beside_the_lattice() {
    for seam in seams() {
        let corners = [seam.whole[0] + seam.step, seam.whole[0] + 2 * seam.step];
        assert_eq!(seam.broken([&[corners], &[]]), [[0; 2]; 0]);
        let beside = TileSeam { at: seam.at + 1, ..seam };
        assert_eq!(beside.broken([&[corners], &[]]), [corners]);
    }
}

/// Outlines are cut at the bounds of the build, which are nodes of the finest level.
#[test]
fn outlines_end_at_the_edge_of_the_bounds() {
    for (seam, beside) in seams().into_iter().zip([Beside::East, Beside::South]) {
        let [corner, edge] = [seam.whole[0] + seam.step, seam.whole[0] + 7 * seam.step + 1];
        assert_eq!(seam.broken([&[[corner, edge]], &[]]), [[corner, edge]]);
        let max = LatticePoint::new(edge, edge);
        let clip = LatticeBounds { min: LatticePoint::new(i64::MIN, i64::MIN), max };
        let seam = TileSeam::new(&frame(), tile(), beside, Some(clip));
        assert_eq!(seam.broken([&[[corner, edge]], &[]]), [[0; 2]; 0]);
    }
}
