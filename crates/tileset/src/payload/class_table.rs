//! Lines by class: the table at the start of both road sections, and the heads of the lines, which
//! precede the points of each class.

use corniche_roads::FunctionalRoadClass;
use corniche_varints::zigzag;

use crate::{
    limits::{MAX_LINES, MAX_POINTS},
    payload::{
        damage::{Damage, Result},
        number_codes::{Cursor, take_room},
    },
};

/// A class, its number of lines, and their bytes.
pub(crate) type ClassBlob<'a> = (FunctionalRoadClass, usize, &'a [u8]);

/// Reads the table: the lines of each class that has any, in the order of classes.
pub(crate) fn decode<'a>(cursor: &mut Cursor<'a>) -> Result<Vec<ClassBlob<'a>>> {
    let mut counts = Vec::with_capacity(FunctionalRoadClass::COUNT);
    let mut all_lines = 0;
    for class in FunctionalRoadClass::all() {
        let lines = u32::from_le_bytes(cursor.array()?) as usize;
        let length = u32::from_le_bytes(cursor.array()?) as usize;
        Damage::invalid_if((lines == 0) != (length == 0), "the table of classes")?;
        all_lines += lines;
        counts.push((class, lines, length));
    }
    Damage::limit("lines of a section", all_lines as u64, MAX_LINES)?;
    counts.retain(|&(_, lines, _)| lines > 0);
    counts
        .into_iter()
        .map(|(class, lines, length)| Ok((class, lines, cursor.take(length)?)))
        .collect()
}

/// The fields of a line that are stored before its points.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct LineHead {
    pub way_id: i64,
    pub part: u32,
    /// Number of points.
    pub points: usize,
    /// Two flag bits, which depend on the kind of section.
    pub flags: u8,
}

/// Subtracts the points of a line from `room`, the number of points that its section may still
/// have.
pub(crate) fn take_points(room: &mut usize, points: usize) -> Result<()> {
    take_room(room, points, MAX_POINTS, "points of a section")
}

/// Checks that the lines of a class are sorted.
#[derive(Default)]
pub(crate) struct LineOrder {
    last: Option<(i64, u32)>,
}

impl LineOrder {
    /// Fails if `next` does not follow the line before it in the sort order.
    pub(crate) fn check(&mut self, next: &LineHead) -> Result<()> {
        let next = Some((next.way_id, next.part));
        Damage::invalid_if(next <= self.last, "lines are not sorted")?;
        self.last = next;
        Ok(())
    }
}

/// The heads of the lines of a class.
pub(crate) struct Heads {
    pub heads: Vec<LineHead>,
    /// Number of points of all lines.
    pub points: usize,
}

impl Heads {
    /// Reads the heads: all way ids as differences, then parts, then numbers of points with flags.
    /// The points are subtracted from `room`, the number that the section may still have.
    pub(crate) fn decode(cursor: &mut Cursor<'_>, lines: usize, room: &mut usize) -> Result<Self> {
        // Each line takes at least three bytes, so a wrong count in the table cannot allocate more
        // than the section allows.
        if lines > cursor.left() / 3 {
            return Err(Damage::TooShort);
        }
        let mut heads = vec![LineHead::default(); lines];
        let mut way_id = 0_i64;
        for head in &mut heads {
            way_id = way_id.wrapping_add(zigzag(cursor.varint()?));
            head.way_id = way_id;
        }
        for head in &mut heads {
            head.part = cursor.bounded(u32::MAX as usize, "number of a part")? as u32;
        }
        let mut points = 0;
        for head in &mut heads {
            let value = cursor.bounded(4 * MAX_POINTS, "number of points")?;
            (head.points, head.flags) = (value / 4, (value % 4) as u8);
            points += head.points;
            take_points(room, head.points)?;
        }
        let mut order = LineOrder::default();
        heads.iter().try_for_each(|head| order.check(head))?;
        Ok(Self { heads, points })
    }

    /// The number of points of each line.
    pub(crate) fn point_counts(&self) -> impl ExactSizeIterator<Item = usize> + Clone {
        self.heads.iter().map(|head| head.points)
    }
}

#[cfg(feature = "write")]
pub(crate) use write::{encode, put_heads};

#[cfg(feature = "write")]
mod write {
    use corniche_varints::{push_varint, to_zigzag};

    use super::{FunctionalRoadClass, LineHead, MAX_LINES, MAX_POINTS};
    use crate::payload::{damage::refuse_if, source_grid::SourceGrid};

    /// Writes the grid of a coded section, the table, and the lines of each class with `put`; also
    /// returns the number of bytes of each class.
    pub(crate) fn encode<R>(
        roads: &[R],
        grid: Option<SourceGrid<'_>>,
        key: impl Fn(&R) -> (FunctionalRoadClass, i64, u32),
        mut put: impl FnMut(&[R], &mut Vec<u8>) -> Result<(), &'static str>,
    ) -> Result<(Vec<u8>, [u64; FunctionalRoadClass::COUNT]), &'static str> {
        refuse_if(
            !roads.is_sorted_by(|a, b| key(a) < key(b)),
            "lines that are not sorted by class, way id and part, or occur twice",
        )?;
        refuse_if(roads.len() > MAX_LINES, "more than a million lines")?;
        let mut table = grid.map_or_else(Vec::new, |grid| grid.to_bytes().to_vec());
        let mut body = Vec::new();
        let mut class_bytes = [0; FunctionalRoadClass::COUNT];
        for (class, bytes) in FunctionalRoadClass::all().zip(&mut class_bytes) {
            let first = roads.partition_point(|road| key(road).0 < class);
            let end = roads.partition_point(|road| key(road).0 <= class);
            let before = body.len();
            if first < end {
                put(&roads[first..end], &mut body)?;
            }
            *bytes = (body.len() - before) as u64;
            table.extend(((end - first) as u32).to_le_bytes());
            table.extend((*bytes as u32).to_le_bytes());
        }
        table.extend(body);
        Ok((table, class_bytes))
    }

    /// The inverse of [`Heads::decode`](super::Heads::decode).
    pub(crate) fn put_heads(out: &mut Vec<u8>, heads: &[LineHead]) {
        let mut previous = 0_i64;
        for head in heads {
            push_varint(out, to_zigzag(head.way_id.wrapping_sub(previous)));
            previous = head.way_id;
        }
        for head in heads {
            push_varint(out, u64::from(head.part));
        }
        for head in heads {
            debug_assert!(head.points <= MAX_POINTS);
            push_varint(out, 4 * head.points as u64 + u64::from(head.flags));
        }
    }
}
