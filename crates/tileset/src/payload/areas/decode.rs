use corniche_areas::{AreaClass, AreaObject};
use corniche_geom::{LatticeBounds, LatticePoint};

use super::record::{AreaRecord, AreaRings};
use crate::limits::{MAX_AREA_RINGS, MAX_AREAS, MAX_POINTS};
use crate::payload::damage::Damage;
use crate::payload::number_codes::{Cursor, Planes, unzigzag};

/// The columns of numbers that a section is made of.
pub(crate) struct Columns<'a> {
    step: i64,
    count: usize,
    pub(crate) classes: Planes<'a>,
    pub(crate) objects: Planes<'a>,
    pub(crate) name_bytes: Planes<'a>,
    pub(crate) polygons: Planes<'a>,
    pub(crate) names: &'a [u8],
    pub(crate) rings: Planes<'a>,
    pub(crate) points: Planes<'a>,
    pub(crate) steps: [Planes<'a>; 2],
    pub(crate) beside: [Planes<'a>; 2],
}

impl<'a> Columns<'a> {
    /// Takes a section apart.
    pub(crate) fn read(bytes: &'a [u8]) -> Result<Self, Damage> {
        let cursor = &mut Cursor::new(bytes);
        let step =
            i64::try_from(cursor.varint()?).ok().filter(|step| (1..=MOST_STEP).contains(step));
        let step = step.ok_or(Damage::Invalid { what: "the spacing of the areas' lattice" })?;
        let count = cursor.bounded(MAX_AREAS, "number of areas")?;
        let [classes, objects, name_bytes, polygons] = [
            cursor.planes(count)?,
            cursor.planes(count)?,
            cursor.planes(count)?,
            cursor.planes(count)?,
        ];
        let length = total(name_bytes, 0, cursor.left(), "bytes of all names")?;
        let names = cursor.take(length)?;
        let polygons_count = total(polygons, 1, MAX_AREA_RINGS, "number of polygons")?;
        let rings = cursor.planes(polygons_count)?;
        let rings_count = total(rings, 1, MAX_AREA_RINGS, "number of rings")?;
        let points = cursor.planes(rings_count)?;
        let points_count = total(points, 3, MAX_POINTS, "number of points")?;
        let steps = [cursor.planes(points_count)?, cursor.planes(points_count)?];
        let beside = [cursor.planes(points_count)?, cursor.planes(points_count)?];
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
            steps,
            beside,
        };
        Ok(columns)
    }
}

/// Reads the section's bytes. All points lie in `bounds`.
pub(crate) fn decode(bytes: &[u8], bounds: LatticeBounds) -> Result<Vec<AreaRecord>, Damage> {
    let columns = Columns::read(bytes)?;
    let Columns { step, count, classes, objects, name_bytes, polygons, .. } = columns;
    let Columns { names, rings, points, steps, beside, .. } = columns;
    let ([east, north], [beside_east, beside_north]) = (steps, beside);
    let mut names = Cursor::new(names);
    let from = |corner: i64| corner.div_euclid(step);
    let mut east =
        Places { steps: east.iter(), beside: beside_east.iter(), step, last: from(bounds.min.u) };
    let mut north =
        Places { steps: north.iter(), beside: beside_north.iter(), step, last: from(bounds.min.v) };
    let (mut rings, mut points) = (rings.iter(), points.iter());
    let mut areas = Vec::with_capacity(count);
    let mut id = 0_i64;
    let heads = classes.iter().zip(objects.iter()).zip(name_bytes.iter()).zip(polygons.iter());
    for (((class, object), name_bytes), polygons) in heads {
        let number = u8::try_from(class >> 1).ok().and_then(AreaClass::from_number);
        let class_of = number.ok_or(Damage::Invalid { what: "a class of areas" })?;
        id = id.wrapping_add(unzigzag(object));
        let name = str::from_utf8(names.take(name_bytes as usize)?)
            .map_err(|_| Damage::Invalid { what: "a name that is no UTF-8" })?;
        let mut parts = Vec::new();
        for _ in 0..=polygons {
            let mut of_part = Vec::new();
            for _ in 0..=rings.next().unwrap_or_default() {
                let points = points.next().unwrap_or_default() + 3;
                let point = |_| {
                    let point = LatticePoint::new(east.next()?, north.next()?);
                    let is_inside = bounds.contains(point);
                    is_inside
                        .then_some(point)
                        .ok_or(Damage::Invalid { what: "a point outside the tile" })
                };
                of_part.push((0..points).map(point).collect::<Result<_, _>>()?);
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

/// No coarse lattice is wider than a tile of 2^40 steps.
const MOST_STEP: i64 = 1 << 40;

/// The sum of numbers with `each` added to every one; refused beyond `most`, before anything is allocated for it.
fn total(numbers: Planes<'_>, each: u64, most: usize, what: &'static str) -> Result<usize, Damage> {
    let mut sum = 0_u64;
    for number in numbers.iter() {
        sum = sum.saturating_add(number).saturating_add(each);
        if sum > most as u64 {
            return Err(Damage::TooLarge { what, length: sum, limit: most as u64 });
        }
    }
    Ok(sum as usize)
}

/// Coordinates along an axis.
struct Places<S, B> {
    steps: S,
    beside: B,
    step: i64,
    /// In steps of the coarse lattice.
    last: i64,
}

impl<S: Iterator<Item = u64>, B: Iterator<Item = u64>> Places<S, B> {
    fn next(&mut self) -> Result<i64, Damage> {
        let wrong = Damage::Invalid { what: "a point outside the tile" };
        let by = unzigzag(self.steps.next().unwrap_or_default());
        let beside = i64::try_from(self.beside.next().unwrap_or_default());
        let last = self.last.checked_add(by);
        let place = last.and_then(|last| last.checked_mul(self.step)?.checked_add(beside.ok()?));
        self.last = last.unwrap_or_default();
        place.ok_or(wrong)
    }
}
