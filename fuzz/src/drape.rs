//! Lines from any bytes are draped on ground from any bytes, and the result keeps every promise of
//! draping.

use arbitrary::{Result, Unstructured};
use corniche_drape::{
    DrapedLine, DrapedVertex, Neighbours, OwnedBorders, check, clip, clip_closed, extrude,
    positions,
};
use corniche_geom::{HeightGrid, LatticeBounds, LatticePoint, Polyline};
use corniche_testing::check_tin;
use corniche_tin::{Placement, Surface, TinSpec, triangulate};

/// Relative error of a length by rounding in f64.
const ROUNDING: f64 = 1e-9;

/// Drapes lines from these bytes on ground from these bytes. The result must be on the TIN, in
/// order, without repeated or lost parts.
///
/// The expected result is computed by simple means: positions in f64, and the ground under a
/// segment as the union of its parts in each triangle. Most coordinates are those of nodes or
/// halves between them.
///
/// # Panics
/// When draping breaks a promise.
pub fn drape(data: &[u8]) {
    // Missing bytes count as zeros. Bytes that give no ground or no line are not a case.
    let _ = case(&mut Unstructured::new(data));
}

fn case(bytes: &mut Unstructured<'_>) -> Result<()> {
    let node_steps = *bytes.choose(&[1_i64, 2, 3, 4, 12, 256, 1 << 15])?;
    let Some(surface) = surface(bytes, node_steps)? else { return Ok(()) };
    let owned = owned_borders(bytes)?;
    for _ in 0..bytes.int_in_range(1..=4)? {
        let points = (0..bytes.int_in_range(2..=9)?)
            .map(|_| {
                Ok(LatticePoint::new(
                    coordinate(bytes, node_steps)?,
                    -coordinate(bytes, node_steps)?,
                ))
            })
            .collect::<Result<Vec<_>>>()?;
        let Ok(line) = Polyline::new(points) else { continue };
        check_drape(&line, &surface);
        check_clip(&line, &surface, owned);
        check_extrude(&line, &surface, bytes.int_in_range(0..=4)? * node_steps);
    }
    Ok(())
}

/// A mesh of a few heights and gaps; `None` if there is no ground.
fn surface(bytes: &mut Unstructured<'_>, node_steps: i64) -> Result<Option<Surface>> {
    let (columns, rows) = (bytes.int_in_range(4..=9)?, bytes.int_in_range(4..=9)?);
    let max_error_m = *bytes.choose(&[0.5, 4.0, 40.0])?;
    let mut heights_m = Vec::with_capacity(columns * rows);
    for _ in 0..columns * rows {
        // A sixteenth of the nodes are gaps.
        let byte = bytes.arbitrary::<u8>()?;
        heights_m.push(if byte >= 240 { f32::NAN } else { f32::from(byte) / 4.0 });
    }
    let heights = HeightGrid::new(columns, rows, heights_m);
    let spec = TinSpec { max_error_m, quantum_m: 1.0 / 64.0 };
    let tin = match triangulate(&heights, spec) {
        Ok(tin) => tin,
        Err(error) => panic!("small heights make a TIN: {error}"),
    };
    check_tin(&tin);
    let placement = Placement {
        corner: LatticePoint::new(0, 0),
        node_steps: [node_steps; 2],
        quantum_m: spec.quantum_m,
    };
    Ok((!tin.is_empty()).then(|| Surface::new(&tin, placement)))
}

fn coordinate(bytes: &mut Unstructured<'_>, node_steps: i64) -> Result<i64> {
    Ok(match bytes.int_in_range(0..=9)? {
        0..=5 => bytes.int_in_range(-1..=9)? * node_steps,
        6 | 7 => bytes.int_in_range(-1..=17)? * node_steps / 2,
        8 => bytes.int_in_range(-node_steps..=9 * node_steps)?,
        _ => bytes.int_in_range(-(1 << 44)..=1 << 44)?,
    })
}

fn check_drape(line: &Polyline, surface: &Surface) {
    let draped = corniche_drape::drape(line, surface);
    let total = corniche_testing::length_steps(line);
    let mut on_steps = 0.0;
    let mut from = 0;
    for part in &draped.lines {
        assert_eq!(check(part, surface), Ok(()), "exactly on the TIN, in order");
        let at = match positions(part, surface) {
            Ok(at) => at,
            Err(error) => panic!("{error}"),
        };
        on_steps += at.windows(2).map(|pair| distance(pair[0], pair[1])).sum::<f64>();
        // The source points of a part, including those beyond its ends, are consecutive points of
        // the line, in order.
        let own = part.vertices.iter().filter_map(source);
        let own: Vec<_> = part.lead_in.into_iter().chain(own).chain(part.lead_out).collect();
        let stretch = line.points()[from..].windows(own.len()).position(|points| points == own);
        let Some(first) = stretch else { panic!("{own:?} is not in {:?}", &line.points()[from..]) };
        // The next part may start on the segment on which this one ends.
        from += first + own.len() - 1 - usize::from(part.lead_out.is_some());
    }
    let length_of =
        |segment: usize| line.points()[segment].distance_steps(line.points()[segment + 1]);
    let off_steps: f64 = draped
        .gaps
        .iter()
        .map(|gap| (gap.shares[1] - gap.shares[0]) * length_of(gap.segment))
        .sum();
    let error = (on_steps + off_steps - total).abs();
    assert!(error <= ROUNDING * total, "{on_steps} on, {off_steps} off, {total}");
    let ground_steps: f64 =
        line.points().windows(2).map(|pair| over_ground([pair[0], pair[1]], surface)).sum();
    assert!(
        (on_steps - ground_steps).abs() <= ROUNDING * total.max(1.0),
        "{on_steps} laid, {ground_steps} ground"
    );

    let Ok(back) = Polyline::new(line.points().iter().rev().copied().collect()) else { return };
    let back: Vec<_> =
        corniche_drape::drape(&back, surface).lines.iter().rev().map(turned).collect();
    assert_eq!(back, draped.lines, "the other way");
}

fn source(vertex: &DrapedVertex) -> Option<LatticePoint> {
    match *vertex {
        DrapedVertex::Source { point, .. } => Some(point),
        _ => None,
    }
}

fn turned(line: &DrapedLine) -> DrapedLine {
    let vertices = line.vertices.iter().rev().copied().collect();
    DrapedLine { lead_in: line.lead_out, vertices, lead_out: line.lead_in }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (b[0] - a[0]).hypot(b[1] - a[1])
}

/// Length of p → q over ground: the union of its parts in each triangle, with their ends as
/// fractions in f64.
fn over_ground([p, q]: [LatticePoint; 2], surface: &Surface) -> f64 {
    let area = |a: LatticePoint, b: LatticePoint, c: LatticePoint| {
        let wide = |x: i64, y: i64| i128::from(y) - i128::from(x);
        wide(a.u, b.u) * wide(a.v, c.v) - wide(a.v, b.v) * wide(a.u, c.u)
    };
    let mut parts: Vec<[f64; 2]> = Vec::new();
    for corners in surface.triangles() {
        let at = corners.map(|vertex| surface.points()[vertex as usize]);
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        for k in 0..3 {
            let (a, b) = (at[k], at[(k + 1) % 3]);
            let (at_p, at_q) = (area(a, b, p), area(a, b, q));
            let meets = at_p as f64 / (at_p - at_q) as f64;
            match (at_p >= 0, at_q >= 0) {
                (true, true) => {}
                (false, false) => to = -1.0,
                (true, false) => to = to.min(meets),
                (false, true) => from = from.max(meets),
            }
        }
        if from < to {
            parts.push([from, to]);
        }
    }
    parts.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let (mut covered, mut reached) = (0.0, 0.0_f64);
    for [from, to] in parts {
        covered += (to - from.max(reached)).max(0.0);
        reached = reached.max(to);
    }
    covered * p.distance_steps(q)
}

/// Which of 16 stretches of a border have ground on one side and on the other.
fn owned_borders(bytes: &mut Unstructured<'_>) -> Result<[OwnedBorders; 2]> {
    let (west, east) = (bytes.arbitrary::<u16>()?, bytes.arbitrary::<u16>()?);
    let there = |cells: u16, row: i64| cells >> (row.clamp(0, 255) / 16) & 1 == 1;
    let tile = |neighbour_east, inner, outer, at: i64| {
        OwnedBorders::among(Neighbours { east: neighbour_east, south: false }).where_ground(
            // Outside the borders that are not shared there is no ground, inside the tile there is.
            move |column, row| match column {
                _ if column == at => there(inner, row),
                -1 | 256 => there(outer, row) && (column == 256) == (at == 255),
                _ => (0..256).contains(&row),
            },
        )
    };
    Ok([tile(true, west, east, 255), tile(false, east, west, 0)])
}

/// Two adjacent tiles: everything in their union is in exactly one of them.
fn check_clip(line: &Polyline, surface: &Surface, owned: [OwnedBorders; 2]) {
    let Some(all) = LatticeBounds::around(surface.points()) else { return };
    let middle = all.min.u.midpoint(all.max.u);
    if middle == all.min.u || line.points().iter().any(|p| p.u.abs().max(p.v.abs()) > 1 << 30) {
        return;
    }
    let west = LatticeBounds { max: LatticePoint::new(middle, all.max.v), ..all };
    let east = LatticeBounds { min: LatticePoint::new(middle, all.min.v), ..all };
    let mut kept_steps = 0.0;
    for (bounds, owned) in [west, east].into_iter().zip(owned) {
        for part in clip(line, &bounds, owned) {
            assert!(part.points().iter().all(|&point| bounds.contains(point)), "outside: {part:?}");
            kept_steps += corniche_testing::length_steps(&part);
        }
    }
    let whole_steps: f64 = clip_closed(line, &all).iter().map(corniche_testing::length_steps).sum();
    // Cuts are rounded to the lattice: by half a step on each side of at most five borders per
    // segment.
    let slack = 5.0 * line.points().len() as f64;
    assert!(
        (kept_steps - whole_steps).abs() <= slack,
        "{kept_steps} in two tiles, {whole_steps} in one"
    );
}

/// Checks that ranges include the ground under the segment's own vertices.
fn check_extrude(line: &Polyline, surface: &Surface, margin_steps: i64) {
    for sv in extrude(line, surface, margin_steps) {
        assert_eq!(sv.points.len(), sv.ground_range_m.len() + 1);
        for (pair, &[low_m, high_m]) in sv.points.windows(2).zip(&sv.ground_range_m) {
            assert!(low_m.is_finite() && low_m <= high_m && high_m.is_finite());
            for &point in pair {
                if let Some(triangle) = surface.locate(point) {
                    let height_m = surface.height_at_point_m(triangle, point);
                    assert!(
                        (low_m..=high_m).contains(&height_m),
                        "{height_m} not in {low_m}..{high_m}"
                    );
                }
            }
        }
    }
}
