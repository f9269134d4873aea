//! Decodes the section of a layer. Damage is detected before memory is allocated for it.

use corniche_geom::{LatticeBounds, LatticePoint};
use corniche_layers::{LayerGeometry, OsmObject};
use corniche_varints::zigzag;

use super::{
    attribute_columns::ColumnReader,
    layer_object::{AreaPolygon, LayerCoding, LayerObject, LayerShape},
    plane_points::PointReader,
    ring_coder::RingCoder,
    text_table::TextReader,
};
use crate::{
    limits::{MAX_LAYER_OBJECTS, MAX_LAYER_VALUES, MAX_POINTS, MAX_RINGS},
    payload::{
        damage::{Damage, Result},
        number_codes::{Cursor, Planes},
        range_coder::BitReader,
    },
};

const OUTSIDE: Damage = Damage::Invalid("a point outside the tile");

/// Decodes the section's bytes. Rings and points are in `bounds`.
pub(crate) fn decode(
    bytes: &[u8],
    coding: &LayerCoding,
    bounds: LatticeBounds,
) -> Result<Vec<LayerObject>> {
    let cursor = &mut Cursor::new(bytes);
    let step = cursor.spacing("the spacing of a layer's lattice")?;
    let count = cursor.bounded(MAX_LAYER_OBJECTS, "number of objects")?;
    let values = count * coding.attributes.len();
    Damage::limit("number of attribute values", values as u64, MAX_LAYER_VALUES)?;
    let [kinds, ids]: [Planes<'_>; 2] = cursor.columns(count)?;
    let mut texts = TextReader::read(cursor)?;
    let mut columns = Vec::with_capacity(coding.attributes.len());
    for &kind in &coding.attributes {
        columns.push(ColumnReader::read(cursor, kind, count)?);
    }
    let mut shapes = ShapeReader::read(cursor, coding.geometry, count, step, bounds)?;
    cursor.finish()?;
    let mut objects = Vec::with_capacity(count);
    let mut id = 0_i64;
    for (kind, by) in kinds.iter().zip(ids.iter()) {
        let class = u8::try_from(kind >> 2).ok().filter(|&of| usize::from(of) < coding.classes);
        id = id.wrapping_add(zigzag(by));
        let object = match kind & 3 {
            0 => OsmObject::Node(id),
            1 => OsmObject::Way(id),
            2 => OsmObject::Relation(id),
            _ => return Err(Damage::Invalid("a type of object")),
        };
        objects.push(LayerObject {
            class: class.ok_or(Damage::Invalid("a class"))?,
            object,
            values: columns
                .iter_mut()
                .map(|column| column.next(&mut texts))
                .collect::<Result<_, _>>()?,
            shape: shapes.next()?,
        });
    }
    shapes.finish()?;
    Ok(objects)
}

/// The shapes of a section's objects while they are read.
enum ShapeReader<'a> {
    Lines { lengths: Numbers<'a>, points: PointReader<'a> },
    Areas(Box<AreaReader<'a>>),
    Points { points: PointReader<'a>, bounds: LatticeBounds },
}

type Numbers<'a> = Box<dyn Iterator<Item = u64> + 'a>;

struct AreaReader<'a> {
    polygons: Numbers<'a>,
    rings: Numbers<'a>,
    points: Numbers<'a>,
    bits: BitReader<'a>,
    coder: RingCoder,
}

impl<'a> ShapeReader<'a> {
    fn read(
        cursor: &mut Cursor<'a>,
        geometry: LayerGeometry,
        count: usize,
        step: i64,
        bounds: LatticeBounds,
    ) -> Result<Self> {
        const POINTS: &str = "number of points";
        Ok(match geometry {
            LayerGeometry::Line => {
                let lengths = cursor.planes(count)?;
                let points = lengths.total(2, MAX_POINTS, POINTS)?;
                let points = PointReader::read(cursor, points, step, bounds)?;
                Self::Lines { lengths: Box::new(lengths.iter()), points }
            }
            LayerGeometry::Area => {
                let polygons = cursor.planes(count)?;
                let polygons_count = polygons.total(1, MAX_RINGS, "number of polygons")?;
                let rings = cursor.planes(polygons_count)?;
                let rings_count = rings.total(1, MAX_RINGS, "number of rings")?;
                let points = cursor.planes(rings_count)?;
                points.total(3, MAX_POINTS, POINTS)?;
                Self::Areas(Box::new(AreaReader {
                    polygons: Box::new(polygons.iter()),
                    rings: Box::new(rings.iter()),
                    points: Box::new(points.iter()),
                    bits: BitReader::new(cursor.take(cursor.left())?),
                    coder: RingCoder::new(bounds, step),
                }))
            }
            LayerGeometry::Point => {
                let points = PointReader::read(cursor, count, step, bounds)?;
                Self::Points { points, bounds }
            }
        })
    }

    fn next(&mut self) -> Result<LayerShape> {
        match self {
            Self::Lines { lengths, points } => {
                let length = lengths.next().unwrap_or_default() + 2;
                let line = (0..length).map(|_| points.next());
                let line = line.collect::<Result<Vec<LatticePoint>>>()?;
                Damage::invalid_if(
                    line.array_windows().any(|[one, next]| one == next),
                    "a line with two equal points in succession",
                )?;
                Ok(LayerShape::Line(line))
            }
            Self::Areas(areas) => {
                let polygons = areas.polygons.next().unwrap_or_default();
                let polygons = (0..=polygons).map(|_| areas.polygon()).collect::<Result<_, _>>()?;
                Ok(LayerShape::Area(polygons))
            }
            Self::Points { points, bounds } => {
                let point = points.next()?;
                bounds.contains(point).then_some(LayerShape::Point(point)).ok_or(OUTSIDE)
            }
        }
    }

    fn finish(self) -> Result<()> {
        if let Self::Areas(areas) = self { areas.bits.finish() } else { Ok(()) }
    }
}

impl AreaReader<'_> {
    fn polygon(&mut self) -> Result<AreaPolygon> {
        let mut rings = Vec::new();
        for _ in 0..=self.rings.next().unwrap_or_default() {
            let mut ring = Vec::new();
            for _ in 0..self.points.next().unwrap_or_default() + 3 {
                self.bits.check_end()?;
                ring.push(self.coder.code_point(&mut self.bits, None)?);
            }
            self.coder.end_ring();
            rings.push(ring);
        }
        Ok(AreaPolygon { rings })
    }
}
