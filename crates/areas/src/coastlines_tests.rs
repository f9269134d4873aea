//! Coastlines in any order are joined to chains and rings, and cut where they cross the edge.

use super::*;

fn coast(way_id: i64, points: &[(i64, i64)]) -> Coastline {
    Coastline { way_id, points: points.iter().map(|&(u, v)| LatticePoint::new(u, v)).collect() }
}

fn region(corners: &[(i64, i64)]) -> LatticeRegion {
    let corners = corners.iter().map(|&(u, v)| LatticePoint::new(u, v)).collect();
    LatticeRegion::new(&[vec![corners]]).unwrap()
}

fn bounds() -> LatticeRegion {
    region(&[(0, 0), (100, 0), (100, 60), (0, 60)])
}

fn points(chain: &CoastlineChain) -> Vec<(i64, i64)> {
    chain.points.iter().map(|point| (point.u, point.v)).collect()
}

#[test]
fn ways_in_any_order_make_chains_and_rings() {
    let chains = join(vec![
        coast(7, &[(3, 3), (4, 4)]),
        coast(5, &[(1, 1), (2, 2)]),
        coast(6, &[(2, 2), (3, 3)]),
        coast(9, &[(50, 10), (60, 10), (55, 20)]),
        coast(8, &[(55, 20), (50, 10)]),
        coast(4, &[(9, 9)]),
    ]);
    assert_eq!(chains.len(), 2);
    assert_eq!(points(&chains[0]), [(1, 1), (2, 2), (3, 3), (4, 4)]);
    assert_eq!(chains[0].ways, [5, 6, 7]);
    assert!(!chains[0].is_ring() && chains[1].is_ring());
    assert_eq!(points(&chains[1]), [(55, 20), (50, 10), (60, 10), (55, 20)]);
}

/// If points of a way cannot be converted, the way has several parts.
#[test]
fn all_runs_of_a_way_count() {
    let chains = join(vec![coast(5, &[(1, 1), (2, 2)]), coast(5, &[(8, 8), (9, 9)])]);
    assert_eq!(chains.iter().map(points).collect::<Vec<_>>(), [[(1, 1), (2, 2)], [(8, 8), (9, 9)]]);
}

#[test]
fn a_chain_is_cut_where_it_crosses_the_edge() {
    let chain = |points: &[(i64, i64)]| join(vec![coast(1, points)]).remove(0);
    let cut_points = |points_of: &[(i64, i64)]| {
        cut(&chain(points_of), &bounds()).iter().map(points).collect::<Vec<_>>()
    };
    // The line passes through two sides, with a vertex inside.
    assert_eq!(cut_points(&[(-20, 10), (20, 30), (20, 90)]), [[(0, 20), (20, 30), (20, 60)]]);
    // The line passes a corner outside the rectangle.
    assert_eq!(cut_points(&[(-10, 10), (10, -10)]), [[(0, 0); 0]; 0]);
    assert_eq!(cut_points(&[(-5, 10), (15, -10)]), [[(0, 5), (5, 0)]]);
    assert!(cut_points(&[(-10, 5), (5, -11)]).is_empty());
    // The line leaves and enters again; a touch from inside does not divide it.
    assert_eq!(
        cut_points(&[(50, 30), (50, 60), (60, 30), (60, 90), (70, 90), (70, 30)]),
        [vec![(50, 30), (50, 60), (60, 30), (60, 60)], vec![(70, 60), (70, 30)]]
    );
    // A ring that begins inside and leaves once is one part.
    assert_eq!(
        cut_points(&[(90, 10), (110, 10), (110, 20), (90, 20), (90, 10)]),
        [[(100, 20), (90, 20), (90, 10), (100, 10)]]
    );
}

/// Edges in any direction cut the lines; the ends are rounded.
#[test]
fn a_chain_is_cut_by_a_region_that_is_no_rectangle() {
    let diamond = region(&[(0, -50), (50, 0), (0, 50), (-50, 0)]);
    let chain = join(vec![coast(1, &[(-90, 0), (-20, 0), (0, 81), (20, 0), (49, 1)])]).remove(0);
    let parts: Vec<_> = cut(&chain, &diamond).iter().map(points).collect();
    assert_eq!(parts, [vec![(-50, 0), (-20, 0), (-10, 40)], vec![(10, 40), (20, 0), (49, 1)]]);
}
