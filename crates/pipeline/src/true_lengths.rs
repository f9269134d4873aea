//! True lengths of roads, in whole micrometres, so that parts add up exactly.

use corniche_drape::{ClippedPart, Gap};
use corniche_geom::{
    CoordinateTable, GridFrame, LatticeBounds, LatticePoint, Polyline, Projection, wgs84,
};

/// Micrometres in a metre.
pub(crate) const UM: f64 = 1e6;

/// True lengths of roads. Each segment has one length, by the ellipsoid's radii of curvature at its middle. Pieces of a
/// segment have their shares of its length, cut at whole micrometres along it. Pieces that meet share the cut, so the
/// lengths of all pieces of a segment add up to its length exactly.
pub(crate) struct TrueLengths<'a> {
    frame: GridFrame,
    /// Longitudes and latitudes inside its bounds come from this table, others from PROJ.
    table: &'a CoordinateTable,
    projection: &'a (dyn Projection + Sync),
}

impl<'a> TrueLengths<'a> {
    pub(crate) fn new(
        frame: GridFrame,
        table: &'a CoordinateTable,
        projection: &'a (dyn Projection + Sync),
    ) -> Self {
        Self { frame, table, projection }
    }

    /// The true length of each segment of a line, micrometres.
    pub(crate) fn segments_um(&self, line: &Polyline) -> Vec<u64> {
        let positions_deg = self.positions_deg(line.points());
        positions_deg
            .windows(2)
            .zip(line.points().windows(2))
            .map(|(pair_deg, pair)| {
                let true_m = wgs84::short_distance_m(pair_deg[0], pair_deg[1]);
                // Far outside the area of the CRS a position may have no longitude and latitude; then the length in working metres is taken.
                let plain_m = pair[0].distance_steps(pair[1]) * self.frame.lattice_step_m();
                ((if true_m.is_finite() { true_m } else { plain_m }) * UM).round() as u64
            })
            .collect()
    }

    fn positions_deg(&self, points: &[LatticePoint]) -> Vec<[f64; 2]> {
        let mut positions: Vec<[f64; 2]> =
            points.iter().map(|&point| self.frame.position_m(point)).collect();
        let bounds = self.table.bounds();
        let is_tabulated = LatticeBounds::of(points).is_some_and(|own| {
            let [min, max] = [own.min, own.max].map(|point| self.frame.position_m(point));
            min[0] >= bounds.min_x
                && min[1] >= bounds.min_y
                && max[0] <= bounds.max_x
                && max[1] <= bounds.max_y
        });
        if is_tabulated {
            for position in &mut positions {
                *position = self.table.wgs84_from_working(*position);
            }
        } else if self.projection.wgs84_from_working(&mut positions).is_err() {
            positions.fill([f64::NAN; 2]);
        }
        positions
    }
}

/// Where each segment of a line begins along a road, micrometres, the first one at `from_um`.
pub(crate) fn starts_um(from_um: u64, segments_um: &[u64]) -> Vec<u64> {
    let next = |along_um: &mut u64, length_um: &u64| {
        let from_um = *along_um;
        *along_um += length_um;
        Some(from_um)
    };
    segments_um.iter().scan(from_um, next).collect()
}

/// How far along a segment from p to q a point on it lies, as a share of the segment: 0 at p, 1 at q, and the same from
/// whichever tile it is asked.
pub(crate) fn share([p, q]: [LatticePoint; 2], at: LatticePoint) -> f64 {
    let along = |point: LatticePoint| {
        i128::from(point.u - p.u) * i128::from(q.u - p.u)
            + i128::from(point.v - p.v) * i128::from(q.v - p.v)
    };
    along(at) as f64 / along(q) as f64
}

/// Where each segment of a part begins and ends along the segment of the line that it belongs to, micrometres.
/// `segments_um` are the true lengths of the line's segments.
pub(crate) fn pieces_um<'a>(
    line: &'a Polyline,
    part: &'a ClippedPart,
    segments_um: &'a [u64],
) -> impl Iterator<Item = [u64; 2]> + 'a {
    let pairs = part.line.points().windows(2);
    pairs.zip(&part.segments).map(|(pair, &segment)| {
        let whole = [line.points()[segment], line.points()[segment + 1]];
        [pair[0], pair[1]].map(|at| cut_um(share(whole, at), segments_um[segment]))
    })
}

/// How much of a part lies over the gaps that were found when it was draped, micrometres. `pieces` are those of
/// [`pieces_um`]: a gap takes its shares of them.
pub(crate) fn gaps_um(pieces: &[[u64; 2]], gaps: &[Gap]) -> u64 {
    let within = |[from, to]: [u64; 2], share: f64| from + cut_um(share, to - from);
    gaps.iter()
        .map(|gap| {
            let piece = pieces[gap.segment];
            let [from, to] = gap.shares.map(|share| within(piece, share));
            to - from
        })
        .sum()
}

/// Where a share of a segment ends, in whole micrometres from its start.
pub(crate) fn cut_um(share: f64, segment_um: u64) -> u64 {
    // A point is rounded to the lattice and may lie a little beyond the end.
    (share.clamp(0.0, 1.0) * segment_um as f64).round() as u64
}

#[cfg(test)]
#[path = "true_lengths_tests.rs"]
mod tests;
