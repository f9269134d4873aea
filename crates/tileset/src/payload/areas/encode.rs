//! Encodes the areas of a tile as a section.

use corniche_areas::AreaObject;
use corniche_geom::{GridFrame, LatticeBounds, LatticePoint, TileId};
use corniche_varints::{push_varint, to_zigzag};

use super::coded_rings::RingCoder;
use super::decode;
use super::record::AreaRecord;
use crate::limits::{MAX_AREA_RINGS, MAX_AREAS, MAX_POINTS, MAX_TEXT_BYTES};
use crate::payload::builder::Section;
use crate::payload::damage::{DecodeError, EncodeError};
use crate::payload::number_codes::put_planes;
use crate::payload::range_coder::BitWriter;
use crate::payload::section_kind::{AREAS, SectionKind};

impl Section {
    /// Returns the areas section of a tile with these bytes, which came from
    /// [`Section::into_bytes`].
    #[must_use]
    pub fn of_areas(mut bytes: Vec<u8>) -> Self {
        let is_coded = bytes.first() == Some(&1);
        bytes.drain(..bytes.len().min(1));
        Self { kind: if is_coded { AREAS.coded } else { AREAS.planes }, bytes }
    }

    /// Returns the areas in this section.
    ///
    /// # Errors
    /// When the bytes are damaged.
    pub fn areas(&self, tile: TileId, frame: &GridFrame) -> Result<Vec<AreaRecord>, DecodeError> {
        let bounds = frame.tile_lattice_bounds(tile);
        let areas = decode::decode(&self.bytes, self.kind == AREAS.coded, bounds);
        areas.map_err(SectionKind::Areas.damaged(tile))
    }
}

/// Encodes the areas of a tile; `None` if there are none. Equal areas result in equal bytes.
///
/// `step` is the spacing of the coarse lattice for the points of the tile's level, in steps of the
/// package's lattice; points on the tile's border may be off the coarse lattice. `step` only
/// affects the number of bytes.
///
/// # Errors
/// When a point is outside the tile, a polygon has no rings, a ring has too few points, or there
/// are more of them than readers accept.
pub fn encode_areas(
    tile: TileId,
    frame: &GridFrame,
    step: i64,
    areas: &[AreaRecord],
) -> Result<Option<Section>, EncodeError> {
    if areas.is_empty() {
        return Ok(None);
    }
    let bounds = frame.tile_lattice_bounds(tile);
    check(areas, &bounds, step).map_err(SectionKind::Areas.refused(tile))?;
    Ok(Some(section(areas, bounds, step, coded_places(areas, bounds, step))))
}

/// Encodes areas with their points in planes, as section kind 8 has them.
#[cfg(test)]
pub(crate) fn in_planes(areas: &[AreaRecord], bounds: LatticeBounds, step: i64) -> Section {
    section(areas, bounds, step, None)
}

/// Encodes a section with `coded` points, or with points in planes if there are none.
fn section(
    areas: &[AreaRecord],
    bounds: LatticeBounds,
    step: i64,
    coded: Option<Vec<u8>>,
) -> Section {
    let kind = if coded.is_some() { AREAS.coded } else { AREAS.planes };
    let mut columns = Columns::default();
    for area in areas {
        columns.push_area(area);
    }
    let mut bytes = Vec::new();
    push_varint(&mut bytes, step.cast_unsigned());
    push_varint(&mut bytes, areas.len() as u64);
    for column in [&columns.classes, &columns.objects, &columns.name_bytes, &columns.polygons] {
        put_planes(&mut bytes, column);
    }
    bytes.extend(&columns.names);
    put_planes(&mut bytes, &columns.rings);
    put_planes(&mut bytes, &columns.points);
    if let Some(coded) = coded {
        bytes.extend(coded);
    } else {
        for column in &columns.places(&bounds, step) {
            put_planes(&mut bytes, column);
        }
    }
    Section { kind, bytes }
}

/// Encodes all points as range-coded bits; `None` if a point has no code (a step of 2^32 or more).
fn coded_places(areas: &[AreaRecord], bounds: LatticeBounds, step: i64) -> Option<Vec<u8>> {
    let mut coder = RingCoder::new(bounds, step);
    let mut bits = BitWriter::new(Vec::new());
    for ring in areas.iter().flat_map(AreaRecord::rings) {
        for &point in ring {
            if coder.code_point(&mut bits, Some(point)) != Ok(point) {
                return None;
            }
        }
        coder.end_ring();
    }
    Some(bits.finish())
}

fn check(areas: &[AreaRecord], bounds: &LatticeBounds, step: i64) -> Result<(), &'static str> {
    let rings = || areas.iter().flat_map(AreaRecord::rings);
    let polygons = areas.iter().flat_map(|area| &area.polygons);
    if step < 1 {
        return Err("a lattice with a spacing of 0");
    }
    if areas.iter().any(|area| area.polygons.is_empty())
        || polygons.clone().any(|part| part.rings.is_empty())
    {
        return Err("an area without rings");
    }
    if rings().any(|ring| ring.len() < 3) {
        return Err("a ring of fewer than three points");
    }
    if rings().flatten().any(|&point| !bounds.contains(point)) {
        return Err("a point outside the tile");
    }
    let points: usize = rings().map(Vec::len).sum();
    let texts: usize = areas.iter().map(|area| area.name.len()).sum();
    if areas.len() > MAX_AREAS
        || rings().count() > MAX_AREA_RINGS
        || points > MAX_POINTS
        || texts > MAX_TEXT_BYTES
    {
        return Err("more areas than readers accept");
    }
    Ok(())
}

#[derive(Default)]
struct Columns {
    classes: Vec<u64>,
    /// Twice the zigzag code of the id, plus 1 for relations; after the first object, of the
    /// difference to the id before.
    objects: Vec<u64>,
    name_bytes: Vec<u64>,
    names: Vec<u8>,
    polygons: Vec<u64>,
    /// The number of rings of each polygon, without the outer ring.
    rings: Vec<u64>,
    /// The number of points of each ring, minus three.
    points: Vec<u64>,
    all_points: Vec<LatticePoint>,
    last_id: i64,
}

impl Columns {
    fn push_area(&mut self, area: &AreaRecord) {
        let (is_relation, id) = match area.object {
            AreaObject::Way(id) => (0, id),
            AreaObject::Relation(id) => (1, id),
        };
        self.classes.push(u64::from(area.class.number()) << 1 | is_relation);
        self.objects.push(to_zigzag(id.wrapping_sub(self.last_id)));
        self.last_id = id;
        self.name_bytes.push(area.name.len() as u64);
        self.names.extend(area.name.as_bytes());
        self.polygons.push(area.polygons.len() as u64 - 1);
        for part in &area.polygons {
            self.rings.push(part.rings.len() as u64 - 1);
            for ring in &part.rings {
                self.points.push(ring.len() as u64 - 3);
                self.all_points.extend(ring);
            }
        }
    }

    /// East and north in steps of the coarse lattice, each as the difference from the point before,
    /// the first from the tile's south-western corner; then the remainder of each, which is 0
    /// except on borders.
    fn places(&self, bounds: &LatticeBounds, step: i64) -> [Vec<u64>; 4] {
        let mut columns = [const { Vec::new() }; 4];
        let mut last = [bounds.min.u, bounds.min.v].map(|part| part.div_euclid(step));
        for point in &self.all_points {
            for (axis, part) in [point.u, point.v].into_iter().enumerate() {
                let steps = part.div_euclid(step);
                columns[axis].push(to_zigzag(steps - last[axis]));
                columns[2 + axis].push(part.rem_euclid(step).cast_unsigned());
                last[axis] = steps;
            }
        }
        columns
    }
}
