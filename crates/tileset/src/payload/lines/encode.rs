//! The lines of a layer are encoded as a section of their tile.

use corniche_areas::{ClassedLayer, line_text};
use corniche_geom::TileId;
use corniche_varints::{push_varint, to_zigzag};

use super::{FARTHEST, LineRecord, MOST_STEP, decode};
use crate::limits::{MAX_CLASSED_LINES, MAX_POINTS};
use crate::payload::builder::Section;
use crate::payload::damage::{DecodeError, EncodeError};
use crate::payload::number_codes::put_planes;
use crate::payload::section_kind::Kind;

impl Section {
    /// The lines of a layer with these bytes, which [`Section::into_bytes`] gave.
    #[must_use]
    pub fn of_lines(layer: ClassedLayer, bytes: Vec<u8>) -> Self {
        Self { kind: Kind::of_lines(layer), bytes }
    }

    /// The lines of a layer that it holds.
    ///
    /// # Errors
    /// When the bytes are damaged.
    pub fn lines(&self, layer: ClassedLayer, tile: TileId) -> Result<Vec<LineRecord>, DecodeError> {
        let part = self.kind.name();
        decode(&self.bytes, layer).map_err(|damage| DecodeError { tile, part, damage })
    }
}

/// Encodes the lines of a layer of a tile; `None` if there are none. Equal lines make equal bytes.
///
/// All coordinates are multiples of `step`, steps of the package's lattice.
///
/// # Errors
/// When a point is no multiple, a line has too few points or one twice in a row, or there is more than a reader accepts.
pub fn encode_lines(
    tile: TileId,
    layer: ClassedLayer,
    step: i64,
    lines: &[LineRecord],
) -> Result<Option<Section>, EncodeError> {
    if lines.is_empty() {
        return Ok(None);
    }
    check(layer, lines, step).map_err(|what| EncodeError::Unencodable {
        tile,
        section: Kind::of_lines(layer).name(),
        what,
    })?;
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
    Ok(Some(Section::of_lines(layer, bytes)))
}

fn check(layer: ClassedLayer, lines: &[LineRecord], step: i64) -> Result<(), &'static str> {
    let points = || lines.iter().flat_map(|line| &line.points);
    if !(1..=MOST_STEP).contains(&step) {
        return Err("a lattice without spacing");
    }
    if lines.iter().any(|line| line.points.len() < 2) {
        return Err(line_text!(layer, "a " one " of less than two points"));
    }
    if lines.iter().any(|line| line.points.array_windows().any(|[a, b]| a == b)) {
        return Err(line_text!(layer, "a " one " with a point twice"));
    }
    let is_place = |part: i64| part % step == 0 && (-FARTHEST..=FARTHEST).contains(&part);
    if points().any(|point| !is_place(point.u) || !is_place(point.v)) {
        return Err("a point beside the lattice");
    }
    if lines.len() > MAX_CLASSED_LINES || points().count() > MAX_POINTS {
        return Err(line_text!(layer, "more " many " than readers accept"));
    }
    Ok(())
}
