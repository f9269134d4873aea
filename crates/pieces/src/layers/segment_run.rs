//! Consecutive segments of a way's line as a level shows it, with their true lengths.

use corniche_geom::{LatticePoint, Polyline, TileId};
use corniche_spec::{levels::Levels, tiles_near::for_each_tile_near, true_lengths::starts_um};
use corniche_varints::{push_signed, push_varint, take_number, take_signed};

/// Consecutive segments of the level's line that may touch the tile or its margin.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SegmentRun {
    pub line: Polyline,
    /// The true length of each segment in micrometres: on the finest level, and for bridges and
    /// tunnels on all levels if spans are requested. Simplified segments have the length of the
    /// source line. Otherwise empty.
    pub segments_um: Vec<u64>,
    /// Distance of its start along the road, micrometres; 0 if lengths are not known.
    pub from_um: u64,
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

/// A line as a level shows it, or a stretch of it near a tile.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct LevelPart {
    pub points: Vec<LatticePoint>,
    /// The position of each point along the line, micrometres; empty if lengths are not known.
    pub along_um: Vec<u64>,
}

impl LevelPart {
    /// The points of a line that simplification keeps, each moved by `place`. Equal neighbours
    /// count as one point.
    pub(crate) fn new(
        (points, along_um): (&[LatticePoint], &[u64]),
        kept: &[usize],
        place: impl Fn(LatticePoint) -> LatticePoint,
    ) -> Self {
        let mut part = Self::default();
        for (number, &index) in (1..).zip(kept) {
            let (at, own_um) = (place(points[index]), along_um.get(index).copied());
            if part.points.last() != Some(&at) {
                part.points.push(at);
                part.along_um.extend(own_um);
            } else if let (true, Some(last_um)) = (number == kept.len(), part.along_um.last_mut()) {
                // Of two points in one place, the line's end counts: decks end there.
                *last_um = own_um.unwrap_or(*last_um);
            }
        }
        part
    }

    /// The runs of consecutive segments near each tile that `is_wanted`: the first and the last
    /// segment.
    pub(crate) fn runs(
        &self,
        level: u8,
        levels: &Levels,
        is_wanted: impl Fn(TileId) -> bool,
    ) -> Vec<(TileId, [usize; 2])> {
        let mut near = Vec::new();
        for (segment, pair) in self.points.array_windows().enumerate() {
            for_each_tile_near(*pair, level, levels, |id| {
                if is_wanted(id) {
                    near.push((id, segment));
                }
            });
        }
        near.sort_unstable();
        let runs = near.chunk_by(|(one, at), (other, next)| one == other && at + 1 == *next);
        runs.map(|run| (run[0].0, [run[0].1, run[run.len() - 1].1])).collect()
    }

    /// The stretch from segment `first` to segment `last`, both included.
    pub(crate) fn stretch(&self, [first, last]: [usize; 2]) -> Self {
        Self {
            points: self.points[first..=last + 1].to_vec(),
            along_um: self.along_um.get(first..=last + 1).unwrap_or_default().to_vec(),
        }
    }

    /// The part as a run without nodes.
    pub(crate) fn run(self) -> Option<SegmentRun> {
        let Self { points, along_um } = self;
        Some(SegmentRun {
            line: Polyline::new(points).ok()?,
            segments_um: along_um.array_windows().map(|[from, to]| to - from).collect(),
            from_um: along_um.first().copied().unwrap_or_default(),
            nodes: Vec::new(),
        })
    }
}

/// The positions of all points of a line, from the lengths of its segments; empty without lengths.
pub(crate) fn alongs_um(from_um: u64, segments_um: &[u64]) -> Vec<u64> {
    if segments_um.is_empty() {
        return Vec::new();
    }
    let mut along_um = starts_um(from_um, segments_um);
    along_um.push(from_um + segments_um.iter().sum::<u64>());
    along_um
}

/// Reads the number of items that follow, each at least a byte long: never more than there are
/// bytes.
pub(crate) fn take_count(rest: &mut &[u8]) -> Option<usize> {
    take_number(rest).filter(|count| *count <= rest.len())
}
