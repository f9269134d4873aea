//! Encodes the objects of a layer in a tile as a section.

use corniche_geom::{GridFrame, LatticeBounds, TileId};
use corniche_layers::{LayerGeometry, OsmObject};
use corniche_varints::{push_varint, to_zigzag};

use super::{
    attribute_columns::{put_column, texts_of},
    decode::decode,
    layer_object::{LayerCoding, LayerObject, LayerShape},
    plane_points::{is_on_lattice, put_points},
    ring_coder::RingCoder,
    text_table::TextWriter,
};
use crate::{
    layer_slot::LayerSlot,
    limits::{
        MAX_LAYER_NAMES, MAX_LAYER_OBJECTS, MAX_LAYER_VALUES, MAX_POINTS, MAX_RINGS, MAX_TEXT_BYTES,
    },
    payload::{
        builder::Section,
        damage::{DecodeError, EncodeError, refuse_if},
        number_codes::{MOST_SPACING, put_planes},
        range_coder::BitWriter,
        section_kind::SectionKind,
    },
};

impl Section {
    /// Returns the section of a layer with these bytes, which came from [`Section::into_bytes`].
    #[must_use]
    pub fn of_layer(slot: LayerSlot, bytes: Vec<u8>) -> Self {
        Self { kind: SectionKind::Layer(slot), bytes }
    }

    /// Returns the objects in the section of a layer with this coding.
    ///
    /// # Errors
    /// When the bytes are damaged.
    pub fn objects(
        &self,
        tile: TileId,
        frame: &GridFrame,
        coding: &LayerCoding,
    ) -> Result<Vec<LayerObject>, DecodeError> {
        let objects = decode(&self.bytes, coding, frame.tile_lattice_bounds(tile));
        objects.map_err(self.kind.damaged(tile))
    }
}

/// Encodes the objects of a layer in a tile; `None` if there are none. Equal objects result in
/// equal bytes.
///
/// `step` is the spacing of the lattice for the points of the tile's level, in steps of the
/// package's lattice. All points of lines and points are on it; for those of areas it only affects
/// the number of bytes.
///
/// # Errors
/// When a point is outside the tile or off the lattice, an object does not fit the layer's table,
/// has too few points, or there are more of them than readers accept.
pub fn encode_layer(
    tile: TileId,
    frame: &GridFrame,
    slot: LayerSlot,
    coding: &LayerCoding,
    step: i64,
    objects: &[LayerObject],
) -> Result<Option<Section>, EncodeError> {
    if objects.is_empty() {
        return Ok(None);
    }
    let bounds = frame.tile_lattice_bounds(tile);
    let bytes = encode(objects, coding, step, bounds);
    let bytes = bytes.map_err(SectionKind::Layer(slot).refused(tile))?;
    Ok(Some(Section::of_layer(slot, bytes)))
}

fn encode(
    objects: &[LayerObject],
    coding: &LayerCoding,
    step: i64,
    bounds: LatticeBounds,
) -> Result<Vec<u8>, &'static str> {
    const TOO_MANY: &str = "more objects, points or texts than readers accept";
    refuse_if(!(1..=MOST_SPACING).contains(&step), "a lattice with a spacing of 0")?;
    objects.iter().try_for_each(|object| check(object, coding, step, bounds))?;
    let values = || objects.iter().flat_map(|object| &object.values).flatten();
    let texts = || values().flat_map(texts_of);
    let rings = || objects.iter().flat_map(|object| object.shape.rings());
    let points = || objects.iter().flat_map(|object| object.shape.points());
    // Languages are texts, too, so that this is at least the number of names.
    refuse_if(
        objects.len() > MAX_LAYER_OBJECTS
            || objects.len() * coding.attributes.len() > MAX_LAYER_VALUES
            || texts().count() > MAX_LAYER_NAMES
            || texts().map(str::len).sum::<usize>() > MAX_TEXT_BYTES
            || rings().count() > MAX_RINGS
            || points().count() > MAX_POINTS,
        TOO_MANY,
    )?;
    let texts = TextWriter::new(texts().collect());
    refuse_if(!texts.is_small(), TOO_MANY)?;
    let mut out = Vec::new();
    push_varint(&mut out, step.cast_unsigned());
    push_varint(&mut out, objects.len() as u64);
    put_heads(&mut out, objects);
    texts.put(&mut out);
    for (index, &kind) in coding.attributes.iter().enumerate() {
        let column = objects.iter().map(|object| object.values[index].as_ref());
        put_column(&mut out, kind, column, &texts);
    }
    match coding.geometry {
        LayerGeometry::Line => {
            let lengths: Vec<u64> =
                objects.iter().map(|object| object.shape.points().count() as u64 - 2).collect();
            put_planes(&mut out, &lengths);
            put_points(&mut out, points(), step, bounds);
        }
        LayerGeometry::Area => put_areas(&mut out, objects, step, bounds)?,
        LayerGeometry::Point => put_points(&mut out, points(), step, bounds),
    }
    Ok(out)
}

fn check(
    object: &LayerObject,
    coding: &LayerCoding,
    step: i64,
    bounds: LatticeBounds,
) -> Result<(), &'static str> {
    let LayerObject { class, values, shape, .. } = object;
    let are_of_kind = values.len() == coding.attributes.len()
        && values
            .iter()
            .zip(&coding.attributes)
            .all(|(value, &kind)| value.as_ref().is_none_or(|value| value.is_of(kind)));
    refuse_if(
        usize::from(*class) >= coding.classes || !are_of_kind,
        "an object that does not fit the layer's table",
    )?;
    let is_on_lattice = || shape.points().all(|point| is_on_lattice(point, step));
    let is_inside = || shape.points().all(|&point| bounds.contains(point));
    match (coding.geometry, shape) {
        (LayerGeometry::Line, LayerShape::Line(points)) => {
            if points.len() < 2 {
                Err("a line of fewer than two points")
            } else if points.array_windows().any(|[one, next]| one == next) {
                Err("a line with two equal points in succession")
            } else if !is_on_lattice() {
                Err("a point that is not on the lattice")
            } else {
                Ok(())
            }
        }
        (LayerGeometry::Area, LayerShape::Area(polygons)) => {
            if polygons.is_empty() || polygons.iter().any(|polygon| polygon.rings.is_empty()) {
                Err("an area without rings")
            } else if shape.rings().any(|ring| ring.len() < 3) {
                Err("a ring of fewer than three points")
            } else if !is_inside() {
                Err("a point outside the tile")
            } else {
                Ok(())
            }
        }
        (LayerGeometry::Point, LayerShape::Point(_)) if !is_inside() => {
            Err("a point outside the tile")
        }
        (LayerGeometry::Point, LayerShape::Point(_)) if !is_on_lattice() => {
            Err("a point that is not on the lattice")
        }
        (LayerGeometry::Point, LayerShape::Point(_)) => Ok(()),
        _ => Err("an object of another geometry than the layer's"),
    }
}

/// Writes class and type of each object, then its id as the difference from the id before.
fn put_heads(out: &mut Vec<u8>, objects: &[LayerObject]) {
    let (mut kinds, mut ids) = (Vec::new(), Vec::new());
    let mut last = 0_i64;
    for LayerObject { class, object, .. } in objects {
        let (kind, id) = match *object {
            OsmObject::Node(id) => (0, id),
            OsmObject::Way(id) => (1, id),
            OsmObject::Relation(id) => (2, id),
        };
        kinds.push(u64::from(*class) << 2 | kind);
        ids.push(to_zigzag(id.wrapping_sub(last)));
        last = id;
    }
    put_planes(out, &kinds);
    put_planes(out, &ids);
}

/// Writes the numbers of polygons, rings and points, then all points as range-coded bits.
fn put_areas(
    out: &mut Vec<u8>,
    objects: &[LayerObject],
    step: i64,
    bounds: LatticeBounds,
) -> Result<(), &'static str> {
    let mut counts = [const { Vec::new() }; 3];
    let mut coder = RingCoder::new(bounds, step);
    let mut bits = BitWriter::new(Vec::new());
    for object in objects {
        let LayerShape::Area(polygons) = &object.shape else { continue };
        counts[0].push(polygons.len() as u64 - 1);
        for polygon in polygons {
            counts[1].push(polygon.rings.len() as u64 - 1);
            for ring in &polygon.rings {
                counts[2].push(ring.len() as u64 - 3);
                for &point in ring {
                    // A step of 2^32 or more has no code; writers choose coarser lattices.
                    refuse_if(
                        coder.code_point(&mut bits, Some(point)) != Ok(point),
                        "a point too far from the previous one",
                    )?;
                }
                coder.end_ring();
            }
        }
    }
    for column in &counts {
        put_planes(out, column);
    }
    out.extend(bits.finish());
    Ok(())
}
