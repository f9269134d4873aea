//! Decodes the areas section. Damage is detected before memory is allocated for it.

use corniche_areas::{AreaClass, AreaObject};
use corniche_geom::{LatticeBounds, LatticePoint};
use corniche_varints::zigzag;

use super::coded_rings::RingCoder;
use super::record::{AreaRecord, AreaRings};
use crate::limits::{MAX_AREA_RINGS, MAX_AREAS, MAX_POINTS};
use crate::payload::damage::Damage;
use crate::payload::number_codes::{Cursor, Planes};
use crate::payload::range_coder::BitReader;

/// The columns of numbers of a section, and its points.
struct Columns<'a> {
    step: i64,
    count: usize,
    classes: Planes<'a>,
    objects: Planes<'a>,
    name_bytes: Planes<'a>,
    polygons: Planes<'a>,
    names: &'a [u8],
    rings: Planes<'a>,
    points: Planes<'a>,
    places: PlacesOfSection<'a>,
}

/// The encoded points of a section.
enum PlacesOfSection<'a> {
    /// East and north: steps on the coarse lattice, and the remainders.
    Planes { steps: [Planes<'a>; 2], beside: [Planes<'a>; 2] },
    /// Range-coded bits.
    Coded(&'a [u8]),
}

impl<'a> Columns<'a> {
    /// Splits a section into its columns.
    fn read(bytes: &'a [u8], is_coded: bool) -> Result<Self, Damage> {
        let cursor = &mut Cursor::new(bytes);
        let step = cursor.spacing("the spacing of the areas' lattice")?;
        let count = cursor.bounded(MAX_AREAS, "number of areas")?;
        let [classes, objects, name_bytes, polygons] = cursor.columns(count)?;
        let length = name_bytes.total(0, cursor.left(), "bytes of all names")?;
        let names = cursor.take(length)?;
        let polygons_count = polygons.total(1, MAX_AREA_RINGS, "number of polygons")?;
        let rings = cursor.planes(polygons_count)?;
        let rings_count = rings.total(1, MAX_AREA_RINGS, "number of rings")?;
        let points = cursor.planes(rings_count)?;
        let points_count = points.total(3, MAX_POINTS, "number of points")?;
        let places = if is_coded {
            PlacesOfSection::Coded(cursor.take(cursor.left())?)
        } else {
            let [steps, beside] = [cursor.columns(points_count)?, cursor.columns(points_count)?];
            PlacesOfSection::Planes { steps, beside }
        };
        cursor.finish()?;
        let columns = Self {
            step,
            count,
            classes,
            objects,
            name_bytes,
            polygons,
            names,
            rings,
            points,
            places,
        };
        Ok(columns)
    }
}

/// Decodes the section's bytes; if `is_coded`, its points are range-coded bits. All points are in
/// `bounds`.
pub(crate) fn decode(
    bytes: &[u8],
    is_coded: bool,
    bounds: LatticeBounds,
) -> Result<Vec<AreaRecord>, Damage> {
    let columns = Columns::read(bytes, is_coded)?;
    let step = columns.step;
    match columns.places {
        PlacesOfSection::Coded(bits) => {
            let mut bits = BitReader::new(bits);
            let mut coder = RingCoder::new(bounds, step);
            let areas = columns.areas(|count| {
                let mut ring = Vec::new();
                for _ in 0..count {
                    bits.check_end()?;
                    ring.push(coder.code_point(&mut bits, None)?);
                }
                coder.end_ring();
                Ok(ring)
            })?;
            bits.finish()?;
            Ok(areas)
        }
        PlacesOfSection::Planes { steps, beside } => {
            let [mut east, mut north] = [0, 1].map(|axis| Places {
                steps: steps[axis].iter(),
                beside: beside[axis].iter(),
                step,
                last: [bounds.min.u, bounds.min.v][axis].div_euclid(step),
            });
            columns.areas(|count| {
                let point = |_| {
                    let point = LatticePoint::new(east.next()?, north.next()?);
                    let is_inside = bounds.contains(point);
                    is_inside.then_some(point).ok_or(Damage::Invalid("a point outside the tile"))
                };
                (0..count).map(point).collect()
            })
        }
    }
}

impl Columns<'_> {
    /// Assembles the areas from their rings, which `ring` reads one after another, each with a
    /// given number of points.
    fn areas(
        &self,
        mut ring: impl FnMut(u64) -> Result<Vec<LatticePoint>, Damage>,
    ) -> Result<Vec<AreaRecord>, Damage> {
        let Self { classes, objects, name_bytes, polygons, .. } = self;
        let mut names = Cursor::new(self.names);
        let (mut rings, mut points) = (self.rings.iter(), self.points.iter());
        let mut areas = Vec::with_capacity(self.count);
        let mut id = 0_i64;
        let heads = classes.iter().zip(objects.iter()).zip(name_bytes.iter()).zip(polygons.iter());
        for (((class, object), name_bytes), polygons) in heads {
            let number = u8::try_from(class >> 1).ok().and_then(AreaClass::from_number);
            let class_of = number.ok_or(Damage::Invalid("a class of areas"))?;
            id = id.wrapping_add(zigzag(object));
            let name = str::from_utf8(names.take(name_bytes as usize)?)
                .map_err(|_| Damage::Invalid("a name that is not UTF-8"))?;
            let mut parts = Vec::new();
            for _ in 0..=polygons {
                let mut of_part = Vec::new();
                for _ in 0..=rings.next().unwrap_or_default() {
                    of_part.push(ring(points.next().unwrap_or_default() + 3)?);
                }
                parts.push(AreaRings { rings: of_part });
            }
            areas.push(AreaRecord {
                object: if class & 1 == 1 { AreaObject::Relation(id) } else { AreaObject::Way(id) },
                class: class_of,
                name: name.to_owned(),
                polygons: parts,
            });
        }
        Ok(areas)
    }
}

/// Decodes coordinates along an axis.
struct Places<S, B> {
    steps: S,
    beside: B,
    step: i64,
    /// The last coordinate, in steps of the coarse lattice.
    last: i64,
}

impl<S: Iterator<Item = u64>, B: Iterator<Item = u64>> Places<S, B> {
    fn next(&mut self) -> Result<i64, Damage> {
        let wrong = Damage::Invalid("a point outside the tile");
        let by = zigzag(self.steps.next().unwrap_or_default());
        let beside = i64::try_from(self.beside.next().unwrap_or_default());
        let last = self.last.checked_add(by);
        let place = last.and_then(|last| last.checked_mul(self.step)?.checked_add(beside.ok()?));
        self.last = last.unwrap_or_default();
        place.ok_or(wrong)
    }
}
