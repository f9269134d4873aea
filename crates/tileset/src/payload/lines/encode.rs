//! Encodes boundaries as a section of their tile.

use corniche_geom::TileId;
use corniche_varints::{push_varint, to_zigzag};

use super::{FARTHEST, LineRecord, decode};
use crate::limits::{MAX_CLASSED_LINES, MAX_POINTS};
use crate::payload::builder::Section;
use crate::payload::damage::{DecodeError, EncodeError};
use crate::payload::number_codes::{MOST_SPACING, put_planes};
use crate::payload::section_kind::SectionKind;

impl Section {
    /// Returns the boundaries section with these bytes, which came from [`Section::into_bytes`].
    #[must_use]
    pub fn of_boundaries(bytes: Vec<u8>) -> Self {
        Self { kind: SectionKind::Boundaries, bytes }
    }

    /// Returns the boundaries in this section.
    ///
    /// # Errors
    /// When the bytes are damaged.
    pub fn boundaries(&self, tile: TileId) -> Result<Vec<LineRecord>, DecodeError> {
        decode(&self.bytes).map_err(self.kind.damaged(tile))
    }
}

/// Encodes the boundaries of a tile; `None` if there are none. Equal lines result in equal bytes.
///
/// All coordinates are multiples of `step`, in steps of the package's lattice.
///
/// # Errors
/// When a coordinate is not a multiple of `step`, a line has too few points or two equal points in
/// succession, or there are more lines than readers accept.
pub fn encode_boundaries(
    tile: TileId,
    step: i64,
    lines: &[LineRecord],
) -> Result<Option<Section>, EncodeError> {
    if lines.is_empty() {
        return Ok(None);
    }
    check(lines, step).map_err(SectionKind::Boundaries.refused(tile))?;
    let (mut last_id, mut last) = (0_i64, [0_i64; 2]);
    let mut columns = [const { Vec::new() }; 5];
    for line in lines {
        columns[0].push(u64::from(line.class.number()));
        columns[1].push(to_zigzag(line.way_id.wrapping_sub(last_id)));
        last_id = line.way_id;
        columns[2].push(line.points.len() as u64 - 2);
        for point in &line.points {
            for (axis, part) in [point.u, point.v].into_iter().enumerate() {
                let steps = part / step;
                columns[3 + axis].push(to_zigzag(steps - last[axis]));
                last[axis] = steps;
            }
        }
    }
    let mut bytes = Vec::new();
    push_varint(&mut bytes, step.cast_unsigned());
    push_varint(&mut bytes, lines.len() as u64);
    for column in &columns {
        put_planes(&mut bytes, column);
    }
    Ok(Some(Section::of_boundaries(bytes)))
}

fn check(lines: &[LineRecord], step: i64) -> Result<(), &'static str> {
    let points = || lines.iter().flat_map(|line| &line.points);
    if !(1..=MOST_SPACING).contains(&step) {
        return Err("a lattice with a spacing of 0");
    }
    if lines.iter().any(|line| line.points.len() < 2) {
        return Err("a boundary of fewer than two points");
    }
    if lines.iter().any(|line| line.points.array_windows().any(|[a, b]| a == b)) {
        return Err("a boundary with two equal points in succession");
    }
    let is_place = |part: i64| part % step == 0 && (-FARTHEST..=FARTHEST).contains(&part);
    if points().any(|point| !is_place(point.u) || !is_place(point.v)) {
        return Err("a point that is not on the lattice");
    }
    if lines.len() > MAX_CLASSED_LINES || points().count() > MAX_POINTS {
        return Err("more boundaries than readers accept");
    }
    Ok(())
}
