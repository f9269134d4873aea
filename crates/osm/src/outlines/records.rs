//! What is sorted on the way from objects to areas and boundaries.

use corniche_areas::AreaObject;
use corniche_geom::LatticePoint;
use corniche_store::SortRecord;

use crate::{
    AreaLoss,
    location::{self, Location},
    records::Origin,
    wire::{
        push_bytes, push_signed, push_varint, take_array, take_bytes, take_number, take_signed,
    },
};

/// A way or relation with the tags of an area, or a coastline. Ways come first, each kind by id.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct ObjectRecord {
    pub(crate) object: AreaObject,
    pub(crate) origin: Origin,
    /// The number of its class; `None` of a coastline that is no area.
    pub(crate) class: Option<u8>,
    pub(crate) is_coastline: bool,
    /// Empty for none.
    pub(crate) name: Box<str>,
    /// The ways of its outline; a way names itself.
    pub(crate) ways: Box<[Member]>,
}

/// A way of an outline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Member {
    pub(crate) way_id: i64,
    /// Whether the relation gives it the role `inner`. This is only asked where other ways are missing.
    pub(crate) is_inner: bool,
}

/// What is taken on from an object to its area.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Known {
    pub(crate) object: AreaObject,
    pub(crate) class: Option<u8>,
    pub(crate) is_coastline: bool,
    pub(crate) name: Box<str>,
}

/// A way that an object needs. Objects are numbered in the order of their records.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct MemberRecord {
    pub(crate) member: Member,
    pub(crate) object_number: u64,
}

/// A way of an object's outline with its places.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct OutlineWayRecord {
    pub(crate) object_number: u64,
    pub(crate) member: Member,
    pub(crate) line: OutlineLine,
}

/// What is known of a way of an outline.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum OutlineLine {
    /// The way is not in the file.
    NoWay,
    /// Some of its nodes are not.
    NoNodes,
    /// Some of its nodes are not on Earth.
    OutOfRange,
    /// Places in whole 1e-7 degrees.
    Points(Box<[Location]>),
}

impl OutlineLine {
    pub(crate) fn of(locations: Vec<Location>) -> Self {
        if locations.contains(&location::MISSING) {
            Self::NoNodes
        } else if locations.contains(&location::OUT_OF_RANGE) {
            Self::OutOfRange
        } else {
            Self::Points(locations.into())
        }
    }
}

impl OutlineWayRecord {
    /// The places of its nodes, or why there is no area or line with it.
    pub(crate) fn points(&self) -> Result<&[Location], AreaLoss> {
        match &self.line {
            OutlineLine::NoWay => Err(AreaLoss::MissingWays),
            OutlineLine::NoNodes => Err(AreaLoss::MissingNodes),
            OutlineLine::OutOfRange => Err(AreaLoss::OutOfRange),
            OutlineLine::Points(points) => Ok(points),
        }
    }
}

/// A place as a point of the lattice of 1e-7 degrees, and back.
pub(crate) fn to_point([lon, lat]: Location) -> LatticePoint {
    LatticePoint::new(lon.into(), lat.into())
}

/// The place of a point of the lattice of 1e-7 degrees.
pub(crate) fn degrees_of(point: LatticePoint) -> [f64; 2] {
    [point.u as f64 / 1e7, point.v as f64 / 1e7]
}

impl ObjectRecord {
    /// Splits off what makes the area; what is left are the ways.
    pub(crate) fn into_known(self) -> (Known, Box<[Member]>) {
        let Self { object, class, is_coastline, name, ways, .. } = self;
        (Known { object, class, is_coastline, name }, ways)
    }
}

impl Member {
    fn encode(self, bytes: &mut Vec<u8>) {
        bytes.push(u8::from(self.is_inner));
        push_signed(bytes, self.way_id);
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        let [is_inner] = take_array(bytes)?;
        Some(Self { way_id: take_signed(bytes)?, is_inner: is_inner == 1 })
    }
}

const NO_CLASS: u8 = 255;

impl Known {
    pub(crate) fn encode(&self, bytes: &mut Vec<u8>) {
        let (is_relation, id) = match self.object {
            AreaObject::Way(id) => (0, id),
            AreaObject::Relation(id) => (1, id),
        };
        // Classes are few.
        let class = self.class.unwrap_or(NO_CLASS);
        bytes.extend([is_relation, u8::from(self.is_coastline), class]);
        push_signed(bytes, id);
        push_bytes(bytes, self.name.as_bytes());
    }

    pub(crate) fn decode(bytes: &mut &[u8]) -> Option<Self> {
        let [is_relation, is_coastline, class] = take_array(bytes)?;
        let id = take_signed(bytes)?;
        let name = take_bytes(bytes)?;
        Some(Self {
            object: if is_relation == 1 { AreaObject::Relation(id) } else { AreaObject::Way(id) },
            class: (class != NO_CLASS).then_some(class),
            is_coastline: is_coastline == 1,
            name: str::from_utf8(name).ok()?.into(),
        })
    }
}

impl SortRecord for ObjectRecord {
    fn encode(&self, bytes: &mut Vec<u8>) {
        let Self { object, origin, class, is_coastline, name, ways } = self;
        let (class, is_coastline) = (*class, *is_coastline);
        Known { object: *object, class, is_coastline, name: name.clone() }.encode(bytes);
        origin.encode(bytes);
        push_varint(bytes, ways.len() as u64);
        ways.iter().for_each(|way| way.encode(bytes));
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        let Known { object, class, is_coastline, name } = Known::decode(bytes)?;
        let origin = Origin::decode(bytes)?;
        let count: u64 = take_number(bytes)?;
        let ways: Option<_> = (0..count).map(|_| Member::decode(bytes)).collect();
        Some(Self { object, origin, class, is_coastline, name, ways: ways? })
    }

    fn extra_bytes(&self) -> usize {
        self.name.len() + size_of_val(&*self.ways) + 32
    }
}

impl SortRecord for MemberRecord {
    fn encode(&self, bytes: &mut Vec<u8>) {
        self.member.encode(bytes);
        push_varint(bytes, self.object_number);
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        let member = Member::decode(bytes)?;
        Some(Self { member, object_number: take_number(bytes)? })
    }
}

impl SortRecord for OutlineWayRecord {
    fn encode(&self, bytes: &mut Vec<u8>) {
        push_varint(bytes, self.object_number);
        self.member.encode(bytes);
        let points: &[Location] = match &self.line {
            OutlineLine::NoWay => return bytes.push(0),
            OutlineLine::NoNodes => return bytes.push(1),
            OutlineLine::OutOfRange => return bytes.push(2),
            OutlineLine::Points(points) => points,
        };
        bytes.push(3);
        push_varint(bytes, points.len() as u64);
        let mut last = [0_i32; 2];
        for point in points {
            for (part, last) in point.iter().zip(&mut last) {
                push_signed(bytes, i64::from(*part) - i64::from(*last));
                *last = *part;
            }
        }
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        let object_number = take_number(bytes)?;
        let member = Member::decode(bytes)?;
        let line = match take_array(bytes)? {
            [0] => OutlineLine::NoWay,
            [1] => OutlineLine::NoNodes,
            [2] => OutlineLine::OutOfRange,
            _ => {
                let count: u64 = take_number(bytes)?;
                let mut last = [0_i32; 2];
                let mut next = || -> Option<Location> {
                    for last in &mut last {
                        let step = take_signed(bytes)?;
                        *last = i64::from(*last).checked_add(step)?.try_into().ok()?;
                    }
                    Some(last)
                };
                let points: Option<_> = (0..count).map(|_| next()).collect();
                OutlineLine::Points(points?)
            }
        };
        Some(Self { object_number, member, line })
    }

    fn extra_bytes(&self) -> usize {
        self.points().map_or(0, |points| size_of_val(points) + 16)
    }
}

#[cfg(test)]
#[path = "records_tests.rs"]
mod tests;
