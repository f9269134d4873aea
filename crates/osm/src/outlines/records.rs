//! The records that are sorted on the way from objects to areas, lines and points.

use std::io;

use corniche_geom::LatticePoint;
use corniche_layers::{AttributeValue, OsmObject};
use corniche_store::{SerdeRecord, take_record};
use serde::{Deserialize, Serialize};

use crate::{
    AreaLoss,
    location::{self, Location},
    records::Origin,
    spool::damaged,
};

/// An object of a layer, or a coastline. Nodes come before ways, and ways before relations; each
/// type is sorted by id.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) struct ObjectRecord {
    pub(crate) object: OsmObject,
    pub(crate) origin: Origin,
    /// The number of its class; `None` for a coastline that is not an area.
    pub(crate) class: Option<u8>,
    pub(crate) is_coastline: bool,
    /// The values of its attributes, as bytes; see [`take_values`].
    pub(crate) values: Box<[u8]>,
    /// The numbers of the attributes with values that are not of their kind.
    pub(crate) unread: Box<[u8]>,
    /// The ways of its outline; a way references itself.
    pub(crate) ways: Box<[Member]>,
    /// The position of a node.
    pub(crate) at: Option<Location>,
}

/// A way of an outline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) struct Member {
    pub(crate) way_id: i64,
    /// Whether the relation gives the way the role `inner`. The role is used only if other ways are
    /// missing.
    pub(crate) is_inner: bool,
}

/// A way that an object needs. Objects are numbered in the order of their records.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) struct MemberRecord {
    pub(crate) member: Member,
    pub(crate) object_number: u64,
}

/// A way of an object's outline with its positions.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) struct OutlineWayRecord {
    pub(crate) object_number: u64,
    pub(crate) member: Member,
    /// The positions of the way, or the reason why there is no area or line with it.
    pub(crate) line: Result<OutlinePoints, AreaLoss>,
}

/// The positions of a way of an outline in units of 1e-7 degrees.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) struct OutlinePoints(#[serde(with = "differences")] pub(crate) Box<[Location]>);

impl OutlinePoints {
    pub(crate) fn from_locations(locations: &[Location]) -> Result<Self, AreaLoss> {
        if locations.contains(&location::MISSING) {
            Err(AreaLoss::MissingNodes)
        } else if locations.contains(&location::OUT_OF_RANGE) {
            Err(AreaLoss::OutOfRange)
        } else {
            Ok(Self(locations.into()))
        }
    }
}

impl OutlineWayRecord {
    /// Returns the positions of its nodes, or the reason why there is no area or line with it.
    pub(crate) fn points(&self) -> Result<&[Location], AreaLoss> {
        self.line.as_ref().map(|points| &*points.0).map_err(|&loss| loss)
    }
}

/// Serialises positions as differences from the previous position, which takes less than half the
/// bytes.
mod differences {
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    use crate::{
        location::Location,
        wire::{push_signed, take_signed},
    };

    pub(crate) fn serialize<S: Serializer>(
        places: &[Location],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let mut bytes = Vec::with_capacity(4 * places.len());
        let mut before: Location = [0; 2];
        for &place in places {
            for axis in 0..2 {
                push_signed(&mut bytes, i64::from(place[axis]) - i64::from(before[axis]));
            }
            before = place;
        }
        bytes.serialize(serializer)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Box<[Location]>, D::Error> {
        let bytes = Vec::<u8>::deserialize(deserializer)?;
        let mut rest = bytes.as_slice();
        let mut place: Location = [0; 2];
        let mut places = Vec::with_capacity(bytes.len() / 4);
        while !rest.is_empty() {
            for on_axis in &mut place {
                let next = take_signed(&mut rest).and_then(|by| by.checked_add((*on_axis).into()));
                let next = next.and_then(|next| next.try_into().ok());
                *on_axis =
                    next.ok_or_else(|| D::Error::custom("coordinate differences are missing"))?;
            }
            places.push(place);
        }
        Ok(places.into())
    }
}

/// Returns the values of an object's attributes.
pub(crate) fn take_values(mut bytes: &[u8]) -> io::Result<Vec<Option<AttributeValue>>> {
    take_record(&mut bytes).ok_or_else(damaged)
}

/// Returns the point of a position on the lattice of 1e-7 degrees.
pub(crate) fn to_point([lon, lat]: Location) -> LatticePoint {
    LatticePoint::new(lon.into(), lat.into())
}

/// Returns the position of a point on the lattice of 1e-7 degrees.
pub(crate) fn degrees_of(point: LatticePoint) -> [f64; 2] {
    [point.u as f64 / 1e7, point.v as f64 / 1e7]
}

impl SerdeRecord for ObjectRecord {
    fn extra_bytes(&self) -> usize {
        self.values.len() + self.unread.len() + size_of_val(&*self.ways) + 48
    }
}

impl SerdeRecord for MemberRecord {}

impl SerdeRecord for OutlineWayRecord {
    fn extra_bytes(&self) -> usize {
        self.points().map_or(0, |points| size_of_val(points) + 16)
    }
}

#[cfg(test)]
#[path = "records_tests.rs"]
mod tests;
