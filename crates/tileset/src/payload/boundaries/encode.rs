//! The boundaries of a tile are encoded as a section.

use corniche_geom::TileId;
use corniche_varints::{push_varint, to_zigzag};

use super::{BoundaryRecord, FARTHEST, MOST_STEP, decode};
use crate::limits::{MAX_BOUNDARIES, MAX_POINTS};
use crate::payload::damage::{DecodeError, EncodeError};
use crate::payload::envelope::{self, Content, SectionSize};
use crate::payload::number_codes::put_planes;
use crate::payload::section_kind::Kind;

/// A tile's boundaries as the section of a payload.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BoundariesSection {
    bytes: Vec<u8>,
}

impl BoundariesSection {
    /// Its bytes.
    #[must_use]
    pub fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }

    /// The boundaries that it holds.
    ///
    /// # Errors
    /// When the bytes are damaged.
    pub fn decode(&self, tile: TileId) -> Result<Vec<BoundaryRecord>, DecodeError> {
        let part = Kind::Boundaries.name();
        decode(&self.bytes).map_err(|damage| DecodeError { tile, part, damage })
    }

    /// The section with these bytes, which [`BoundariesSection::into_bytes`] gave.
    #[must_use]
    pub fn from_bytes(bytes: Vec<u8>) -> Self {
        Self { bytes }
    }
}

/// Encodes the boundaries of a tile; `None` if there are none. Equal boundaries make equal bytes.
///
/// All coordinates are multiples of `step`, steps of the package's lattice.
///
/// # Errors
/// When a point is no multiple, a boundary has too few points or one twice in a row, or there is more than a reader accepts.
pub fn encode_boundaries(
    tile: TileId,
    step: i64,
    boundaries: &[BoundaryRecord],
) -> Result<Option<BoundariesSection>, EncodeError> {
    if boundaries.is_empty() {
        return Ok(None);
    }
    check(boundaries, step).map_err(|what| EncodeError::Unencodable {
        tile,
        section: Kind::Boundaries.name(),
        what,
    })?;
    let (mut last_id, mut last) = (0_i64, [0_i64; 2]);
    let mut columns = [const { Vec::new() }; 5];
    for boundary in boundaries {
        columns[0].push(u64::from(boundary.class.number()));
        columns[1].push(to_zigzag(boundary.way_id.wrapping_sub(last_id)));
        last_id = boundary.way_id;
        columns[2].push(boundary.points.len() as u64 - 2);
        for point in &boundary.points {
            for (axis, part) in [point.u, point.v].into_iter().enumerate() {
                let steps = part / step;
                columns[3 + axis].push(to_zigzag(steps - last[axis]));
                last[axis] = steps;
            }
        }
    }
    let mut bytes = Vec::new();
    push_varint(&mut bytes, step.cast_unsigned());
    push_varint(&mut bytes, boundaries.len() as u64);
    for column in &columns {
        put_planes(&mut bytes, column);
    }
    Ok(Some(BoundariesSection { bytes }))
}

fn check(boundaries: &[BoundaryRecord], step: i64) -> Result<(), &'static str> {
    let points = || boundaries.iter().flat_map(|boundary| &boundary.points);
    if !(1..=MOST_STEP).contains(&step) {
        return Err("a lattice without spacing");
    }
    if boundaries.iter().any(|boundary| boundary.points.len() < 2) {
        return Err("a boundary of less than two points");
    }
    if boundaries.iter().any(|boundary| boundary.points.array_windows().any(|[a, b]| a == b)) {
        return Err("a boundary with a point twice");
    }
    let is_place = |part: i64| part % step == 0 && (-FARTHEST..=FARTHEST).contains(&part);
    if points().any(|point| !is_place(point.u) || !is_place(point.v)) {
        return Err("a point beside the lattice");
    }
    if boundaries.len() > MAX_BOUNDARIES || points().count() > MAX_POINTS {
        return Err("more boundaries than readers accept");
    }
    Ok(())
}

/// A payload with boundaries more; all its other sections stay as they are. Returns the size of the new section, too.
///
/// # Errors
/// When the bytes are no payload of the tile, or it has boundaries already.
pub fn with_boundaries(
    payload: &[u8],
    tile: TileId,
    boundaries: BoundariesSection,
) -> Result<(Vec<u8>, SectionSize), EncodeError> {
    let section = (Kind::Boundaries, Content::Raw(boundaries.bytes));
    let (bytes, sizes) = envelope::with_section(payload, tile, section, "beside other boundaries")?;
    Ok((bytes, sizes.last().copied().unwrap_or_default()))
}
