//! True lengths of roads, in whole micrometres, so that parts add up exactly.

use corniche_drape::{ClippedPart, Gap};
use corniche_geom::{
    CoordinateTable, GridFrame, LatticeBounds, LatticePoint, Polyline, Projection, along, dot,
    known_line_length_m, line_length_m, wgs84,
};

use crate::true_areas::degrees;

/// Micrometres per metre.
pub const UM: f64 = 1e6;

/// The largest error of a cut along an even segment, metres.
const EVEN_M: f64 = 1e-3;
/// Segments of at most this many working metres are even: no map's scale changes by more over this
/// length.
const SHORT_M: f64 = 100.0;

/// True lengths of roads. Each segment has one length: the length of the straight line on the map.
/// Its pieces are cut at whole micrometres along it: where the scale hardly changes, in proportion;
/// elsewhere, at the true lengths from its start. Adjacent pieces share the cut, so the lengths of
/// all pieces of a segment add up to its length exactly.
pub struct TrueLengths<'a> {
    frame: GridFrame,
    /// Longitudes and latitudes inside the table's bounds come from this table, others from PROJ.
    table: Option<&'a CoordinateTable>,
    projection: &'a (dyn Projection + Sync),
}

impl<'a> TrueLengths<'a> {
    /// Measures lengths on a package's lattice.
    pub fn new(
        frame: GridFrame,
        table: &'a CoordinateTable,
        projection: &'a (dyn Projection + Sync),
    ) -> Self {
        Self { frame, table: Some(table), projection }
    }

    /// Measures lengths by PROJ alone: such lengths do not depend on the extent of a package, as
    /// the package's table does.
    pub fn projected(frame: GridFrame, projection: &'a (dyn Projection + Sync)) -> Self {
        Self { frame, table: None, projection }
    }

    /// The true length of each segment of a line by PROJ alone, micrometres.
    #[must_use]
    pub fn projected_segments_um(&self, line: &Polyline) -> Vec<u64> {
        Self::projected(self.frame, self.projection).segments_um(line)
    }

    /// The true length of each segment of a line, micrometres.
    #[must_use]
    pub fn segments_um(&self, line: &Polyline) -> Vec<u64> {
        let positions: Vec<[f64; 2]> =
            line.points().iter().map(|&point| self.frame.position_m(point)).collect();
        let table = self.table_of(line.points());
        let mut positions_deg = positions.clone();
        if let Some(table) = table {
            for position in &mut positions_deg {
                *position = table.wgs84_from_working(*position);
            }
        } else if self.projection.wgs84_from_working(&mut positions_deg).is_err() {
            positions_deg.fill([f64::NAN; 2]);
        }
        let degrees = |at| self.degrees(table, at);
        positions_deg
            .array_windows()
            .zip(positions.array_windows())
            .zip(line.points().array_windows::<2>())
            .map(|((&ends_deg, &ends), [from, to])| {
                let true_m = known_line_length_m(ends, ends_deg, &degrees);
                // Far outside the area of the CRS a position may have no longitude and latitude;
                // then the length in working metres is used.
                let plain_m = from.distance_steps(*to) * self.frame.lattice_step_m();
                ((if true_m.is_finite() { true_m } else { plain_m }) * UM).round() as u64
            })
            .collect()
    }

    /// The table, if all these points are within its bounds.
    fn table_of(&self, points: &[LatticePoint]) -> Option<&'a CoordinateTable> {
        let (table, own) = (self.table?, LatticeBounds::around(points)?);
        let is_within =
            |&point: &LatticePoint| table.bounds().contains(self.frame.position_m(point));
        [own.min, own.max].iter().all(is_within).then_some(table)
    }

    fn degrees(&self, table: Option<&CoordinateTable>, at: [f64; 2]) -> [f64; 2] {
        if let Some(table) = table {
            return table.wgs84_from_working(at);
        }
        degrees(self.projection, at)
    }

    /// The end of a fraction `share` of a segment of this length, in whole micrometres from its
    /// start.
    fn cut_um(&self, segment: [LatticePoint; 2], share: f64, segment_um: u64) -> u64 {
        // A point is rounded to the lattice and may be slightly beyond the end.
        let share = share.clamp(0.0, 1.0);
        let is_end = share <= 0.0 || share >= 1.0;
        let working_m = segment[0].distance_steps(segment[1]) * self.frame.lattice_step_m();
        if is_end || working_m <= SHORT_M {
            return part_um(share, segment_um);
        }
        let table = self.table_of(&segment);
        let degrees = |at| self.degrees(table, at);
        let ends = segment.map(|point| self.frame.position_m(point));
        let at = |share: f64| along(ends[0], ends[1], share);
        // Quarters are compared, because both halves have equal lengths if the scale is the same on
        // both sides of the middle.
        let places = [ends[0], at(0.25), at(0.5), at(0.75), ends[1]].map(degrees);
        let quarters_m = [0, 1, 2, 3].map(|k| wgs84::short_distance_m(places[k], places[k + 1]));
        let [least_m, most_m] = [f64::min, f64::max].map(|of| quarters_m.into_iter().reduce(of));
        // A segment without longitude and latitude is not even, but no better cut is known.
        if least_m.zip(most_m).is_some_and(|(least_m, most_m)| most_m - least_m <= EVEN_M) {
            return part_um(share, segment_um);
        }
        let length_m = |from, to| line_length_m([from, to], &degrees);
        let [before_m, behind_m] = [length_m(ends[0], at(share)), length_m(at(share), ends[1])];
        let true_share = before_m / (before_m + behind_m);
        part_um(if true_share.is_finite() { true_share } else { share }, segment_um)
    }

    /// The distance of a point on a segment from the segment's start, in whole micrometres;
    /// `segment_um` is the segment's true length.
    #[must_use]
    pub fn along_um(&self, segment: [LatticePoint; 2], at: LatticePoint, segment_um: u64) -> u64 {
        self.cut_um(segment, share(segment, at), segment_um)
    }

    /// The start and end of each segment of a part along the line's segment to which it belongs,
    /// micrometres. `segments_um` are the true lengths of the line's segments.
    pub fn pieces_um(
        &self,
        line: &Polyline,
        part: &ClippedPart,
        segments_um: &[u64],
    ) -> impl Iterator<Item = [u64; 2]> {
        let pairs = part.line.points().array_windows::<2>();
        pairs.zip(&part.segments).map(|(pair, &segment)| {
            let whole = [line.points()[segment], line.points()[segment + 1]];
            let [from, to] = pair.map(|at| self.along_um(whole, at, segments_um[segment]));
            [from, to.max(from)]
        })
    }

    /// The sum of the lengths of all segments of these parts, micrometres; see [`Self::pieces_um`].
    #[must_use]
    pub fn parts_um(&self, line: &Polyline, parts: &[ClippedPart], segments_um: &[u64]) -> u64 {
        let pieces = parts.iter().flat_map(|part| self.pieces_um(line, part, segments_um));
        pieces.map(|[from, to]| to - from).sum()
    }

    /// The distance of a part's start along its line, and the lengths of the part's segments,
    /// micrometres. `segments_um` are the true lengths of the line's segments.
    #[must_use]
    pub fn part_um(
        &self,
        line: &Polyline,
        part: &ClippedPart,
        segments_um: &[u64],
    ) -> (u64, Vec<u64>) {
        let pieces: Vec<[u64; 2]> = self.pieces_um(line, part, segments_um).collect();
        let first = part.segments.first();
        let before_um: u64 = first.map_or(0, |&first| segments_um[..first].iter().sum());
        let from_um = before_um + pieces.first().map_or(0, |[from, _]| *from);
        (from_um, pieces.iter().map(|[from, to]| to - from).collect())
    }

    /// The length of a part that is over the gaps found when the part was draped, micrometres.
    /// `pieces` are those of [`Self::pieces_um`]: a gap is cut out of them.
    #[must_use]
    pub fn gaps_um(&self, part: &ClippedPart, pieces: &[[u64; 2]], gaps: &[Gap]) -> u64 {
        gaps.iter()
            .map(|gap| {
                let [from, to] = pieces[gap.segment];
                let ends = [part.line.points()[gap.segment], part.line.points()[gap.segment + 1]];
                let [from, to] = gap.shares.map(|share| self.cut_um(ends, share, to - from));
                to.saturating_sub(from)
            })
            .sum()
    }
}

/// The start of each segment of a line along a road, micrometres; the first segment starts at
/// `from_um`.
#[must_use]
pub fn starts_um(from_um: u64, segments_um: &[u64]) -> Vec<u64> {
    let next = |along_um: &mut u64, length_um: &u64| {
        let from_um = *along_um;
        *along_um += length_um;
        Some(from_um)
    };
    segments_um.iter().scan(from_um, next).collect()
}

/// The position of a point on a segment from p to q, as a fraction of the segment: 0 at p, 1 at q.
/// The result is the same for every tile.
#[must_use]
pub fn share([p, q]: [LatticePoint; 2], at: LatticePoint) -> f64 {
    dot(p, q, at) as f64 / dot(p, q, q) as f64
}

fn part_um(share: f64, segment_um: u64) -> u64 {
    (share * segment_um as f64).round() as u64
}

#[cfg(test)]
#[path = "true_lengths_tests.rs"]
mod tests;
