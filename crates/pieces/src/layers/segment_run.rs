//! Consecutive segments of a way's line as a level shows it, with their true lengths.

use corniche_geom::{LatticePoint, Polyline};
use corniche_varints::{push_signed, push_varint, take_number, take_signed};

/// Consecutive segments of the level's line that may touch the tile or its margin.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SegmentRun {
    pub line: Polyline,
    /// The true length of each segment in micrometres: on the finest level, and for bridges and
    /// tunnels on all levels if spans are requested. Simplified segments have the length of the
    /// source line. Otherwise empty.
    pub(crate) segments_um: Vec<u64>,
    /// Distance of its start along the road, micrometres; 0 if lengths are not known.
    pub(crate) from_um: u64,
    /// The nodes at which other roads may join: the indices of their points, and their ids. Only on
    /// the finest level and if spans are requested.
    pub nodes: Vec<(u32, i64)>,
}

impl SegmentRun {
    /// Appends the run; see [`SegmentRun::take`].
    pub(crate) fn push_to(&self, bytes: &mut Vec<u8>, before: &mut LatticePoint) {
        let points = self.line.points();
        push_varint(bytes, points.len() as u64);
        for &point in points {
            push_signed(bytes, point.u.wrapping_sub(before.u));
            push_signed(bytes, point.v.wrapping_sub(before.v));
            *before = point;
        }
        push_varint(bytes, self.segments_um.len() as u64);
        for &segment_um in &self.segments_um {
            push_varint(bytes, segment_um);
        }
        push_varint(bytes, self.from_um);
        push_varint(bytes, self.nodes.len() as u64);
        for &(index, node_id) in &self.nodes {
            push_varint(bytes, index.into());
            push_signed(bytes, node_id);
        }
    }

    /// Takes a run from the front of its bytes. `before` is the last point of the run before.
    pub(crate) fn take(rest: &mut &[u8], before: &mut LatticePoint) -> Option<Self> {
        let count = take_count(rest)?;
        let mut points = Vec::with_capacity(count);
        for _ in 0..count {
            let [u, v] = [take_signed(rest)?, take_signed(rest)?];
            *before = LatticePoint::new(before.u.wrapping_add(u), before.v.wrapping_add(v));
            points.push(*before);
        }
        let lengths = take_count(rest)?;
        let mut segments_um = Vec::with_capacity(lengths);
        for _ in 0..lengths {
            segments_um.push(take_number(rest)?);
        }
        let from_um = take_number(rest)?;
        let of_nodes = take_count(rest)?;
        let mut nodes = Vec::with_capacity(of_nodes);
        for _ in 0..of_nodes {
            nodes.push((take_number(rest)?, take_signed(rest)?));
        }
        let mut lengths_um = segments_um.iter();
        lengths_um.try_fold(from_um, |sum: u64, length_um| sum.checked_add(*length_um))?;
        let line = Polyline::new(points).ok()?;
        // Equal neighbours would have been merged, so a run has none.
        let is_whole = line.points().len() == count && (lengths == 0 || lengths == count - 1);
        is_whole.then_some(Self { line, segments_um, from_um, nodes })
    }
}

/// Reads the number of items that follow, each at least a byte long: never more than there are
/// bytes.
pub(crate) fn take_count(rest: &mut &[u8]) -> Option<usize> {
    take_number(rest).filter(|count| *count <= rest.len())
}
