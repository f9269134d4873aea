//! How far each node of a layer is from the nearest higher one.
//!
//! The distance ranks peaks without a DEM: it depends on the extract alone, so it is the same in
//! every part and cut of a package. (Isolation, or dominance distance, of summits.)

use std::{f64::consts::PI, iter::Peekable};

use corniche_layers::{AttributeKind, AttributeValue, DerivedNumber, LayerTable};
use corniche_store::{append_record, take_record};
use rstar::{RTree, primitives::GeomWithData};

use crate::{
    failed::Failed,
    location::{self, Location, degrees},
    looked::check_held,
    outlines::records::{ObjectRecord, take_values},
    reading::ExtractReading,
    spool::Spool,
};

/// Mean radius of the Earth, metres (IUGG: (2 a + b) / 3 of GRS 80).
const EARTH_RADIUS_M: f64 = 6_371_008.8;
/// What a node with a height takes in memory: its records here, and its share of the tree.
const NODE_BYTES: u64 = 256;

/// The isolation of each node of a layer, if its table asks for it.
pub(crate) struct NodeIsolations {
    /// The number of the attribute that has the distance.
    attribute: usize,
    /// The distances of the nodes that have a height, by the number of the node.
    distances_m: Peekable<std::vec::IntoIter<(u64, f64)>>,
    /// The number of the next node.
    next: u64,
}

/// A node with a height.
struct HighNode {
    number: u64,
    at: Location,
    height: f64,
}

impl NodeIsolations {
    /// Reads the nodes, and returns them again with their distances; `None` if the table does not
    /// ask for them.
    pub(crate) fn measure<'a>(
        reading: &ExtractReading<'a>,
        table: &LayerTable,
        (nodes, held_bytes): (Spool<'a>, u64),
    ) -> Result<(Spool<'a>, Option<Self>), Failed> {
        let wanted = AttributeKind::Derived(DerivedNumber::Isolation);
        let Some(attribute) = table.attributes().position(|(_, kind)| kind == wanted) else {
            return Ok((nodes, None));
        };
        let heights = table.attributes().position(|(key, _)| key == DerivedNumber::HEIGHT_KEY);
        let mut again = Spool::new(reading.request.scratch, reading.shares().spool / 2);
        let (mut high, mut count): (Vec<HighNode>, u64) = (Vec::new(), 0);
        let mut nodes = nodes.read();
        while let Some(node) = nodes.next(take_record::<ObjectRecord>)? {
            reading.check_stop_at(count)?;
            let values = take_values(&node.values)?;
            let height = heights.and_then(|index| values.into_iter().nth(index)?);
            let at = node.at.unwrap_or(location::MISSING);
            if let (Some(AttributeValue::Number(height)), true) = (height, degrees(at).is_some()) {
                check_held(reading, held_bytes + NODE_BYTES * high.len() as u64)?;
                high.push(HighNode { number: count, at, height });
            }
            again.push(|bytes| append_record(bytes, node))?;
            count += 1;
        }
        let distances_m = distances(high, |done| reading.check_stop_at(done))?;
        let distances_m = distances_m.into_iter().peekable();
        Ok((again, Some(Self { attribute, distances_m, next: 0 })))
    }

    /// Sets the distance among the values of the next node.
    pub(crate) fn set_next(&mut self, values: &mut [Option<AttributeValue>]) {
        let number = self.next;
        self.next += 1;
        let distance = self.distances_m.next_if(|&(of, _)| of == number).map(|(_, own)| own);
        if let Some(value) = values.get_mut(self.attribute) {
            *value = distance.map(AttributeValue::Number);
        }
    }
}

/// Returns the distance of each node to the nearest higher one in whole metres, by number. Of two
/// nodes with one height, the first counts as the higher one. The highest node has half the Earth's
/// circumference. `check` is called with the number of nodes that are done.
fn distances<E>(
    mut high: Vec<HighNode>,
    check: impl Fn(u64) -> Result<(), E>,
) -> Result<Vec<(u64, f64)>, E> {
    high.sort_by(|one, other| {
        other.height.total_cmp(&one.height).then(one.number.cmp(&other.number))
    });
    let mut distances = Vec::with_capacity(high.len());
    let mut higher: RTree<GeomWithData<[f64; 3], ()>> = RTree::new();
    for (done, node) in (0..).zip(&high) {
        check(done)?;
        let at = unit_vector(node.at);
        let nearest = higher.nearest_neighbor(&at);
        let angle = nearest.map_or(PI, |nearest| {
            let squared: f64 =
                at.iter().zip(nearest.geom()).map(|(one, other)| (one - other).powi(2)).sum();
            2.0 * libm::asin((squared.sqrt() / 2.0).min(1.0))
        });
        distances.push((node.number, (EARTH_RADIUS_M * angle).round()));
        higher.insert(GeomWithData::new(at, ()));
    }
    distances.sort_unstable_by_key(|&(number, _)| number);
    Ok(distances)
}

/// The point of a sphere of radius 1 in this direction.
fn unit_vector(at: Location) -> [f64; 3] {
    let [lon, lat] = at.map(|angle| (f64::from(angle) / 1e7).to_radians());
    let across = libm::cos(lat);
    [across * libm::cos(lon), across * libm::sin(lon), libm::sin(lat)]
}

#[cfg(test)]
#[path = "isolation_tests.rs"]
mod tests;
