//! The edge of a rectangle, clockwise from its north-western corner.

use corniche_geom::{LatticeBounds, LatticePoint};

/// How far inside a point lies, steps; 0 on the edge, negative outside.
pub(crate) fn edge_distance(
    point: LatticePoint,
    LatticeBounds { min, max }: &LatticeBounds,
) -> i64 {
    let distances = [point.u - min.u, max.u - point.u, point.v - min.v, max.v - point.v];
    distances.into_iter().min().unwrap_or_default()
}

pub(crate) fn nearest_on_edge(point: LatticePoint, bounds: &LatticeBounds) -> LatticePoint {
    let LatticeBounds { min, max } = *bounds;
    let candidates = [
        LatticePoint::new(min.u, point.v),
        LatticePoint::new(max.u, point.v),
        LatticePoint::new(point.u, min.v),
        LatticePoint::new(point.u, max.v),
    ];
    candidates.into_iter().min_by_key(|&on_edge| squared_distance(point, on_edge)).unwrap_or(point)
}

pub(crate) fn squared_distance(a: LatticePoint, b: LatticePoint) -> i128 {
    let [east, north] = [a.u - b.u, a.v - b.v].map(i128::from);
    east * east + north * north
}

/// How far along the edge a point of it lies, clockwise from the north-western corner.
pub(crate) fn along_edge(point: LatticePoint, LatticeBounds { min, max }: &LatticeBounds) -> i128 {
    let [width, height] = sides(min, max);
    let from = |a: i64, b: i64| i128::from(a) - i128::from(b);
    if point.v == max.v {
        from(point.u, min.u)
    } else if point.u == max.u {
        width + from(max.v, point.v)
    } else if point.v == min.v {
        width + height + from(max.u, point.u)
    } else {
        2 * width + height + from(point.v, min.v)
    }
}

/// The corners clockwise from the north-western one.
pub(crate) fn corners(LatticeBounds { min, max }: &LatticeBounds) -> Vec<LatticePoint> {
    vec![LatticePoint::new(min.u, max.v), *max, LatticePoint::new(max.u, min.v), *min]
}

pub(crate) fn point_on_edge(
    along: i128,
    LatticeBounds { min, max }: &LatticeBounds,
) -> LatticePoint {
    let [width, height] = sides(min, max);
    let step = |steps: i128| i64::try_from(steps).unwrap_or_default();
    if along <= width {
        LatticePoint::new(min.u + step(along), max.v)
    } else if along <= width + height {
        LatticePoint::new(max.u, max.v - step(along - width))
    } else if along <= 2 * width + height {
        LatticePoint::new(max.u - step(along - width - height), min.v)
    } else {
        LatticePoint::new(min.u, min.v + step(along - 2 * width - height))
    }
}

/// East and north.
fn sides(min: &LatticePoint, max: &LatticePoint) -> [i128; 2] {
    [[max.u, min.u], [max.v, min.v]].map(|[high, low]| i128::from(high) - i128::from(low))
}

/// How far along the edge its corners lie.
pub(crate) fn corner_places(LatticeBounds { min, max }: &LatticeBounds) -> [i128; 4] {
    let [width, height] = sides(min, max);
    [0, width, width + height, 2 * width + height]
}

/// How long the edge is.
pub(crate) fn perimeter(LatticeBounds { min, max }: &LatticeBounds) -> i128 {
    2 * sides(min, max).iter().sum::<i128>()
}
