//! Checks that each way has one class and one set of attributes, the same in every tile.

use std::{
    collections::{BTreeMap, BTreeSet},
    hash::{DefaultHasher, Hash as _, Hasher as _},
};

use corniche_geom::TileId;
use corniche_roads::RoadAttributes;
use corniche_tileset::TilePayload;

use super::checks::{CheckId, Findings, or_none};

/// The class and the attributes of a way in one tile: 24 bytes, so that all ways of a country fit
/// into memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct StoredWay {
    class: u8,
    /// A hash of the attributes.
    attributes: u64,
}

/// Checks a tile by itself, and returns the class and the attributes of each way.
pub(crate) fn of_tile(
    payload: &TilePayload,
    least_class: Option<u8>,
    findings: &mut Findings,
) -> Vec<(i64, StoredWay)> {
    let id = payload.id;
    let geo = payload.roads_geo.iter().map(|road| (road.way_id, road.class.number()));
    let sv = payload.roads_sv.iter().map(|road| (road.way_id, road.class.number()));
    let ways: BTreeSet<(i64, u8)> = geo.chain(sv).collect();
    for &(way_id, class) in &ways {
        look!(
            findings,
            Classes,
            least_class.is_some_and(|least| class <= least),
            "tile {id} has way {way_id} of class {class}, but its level shows classes up to {}",
            or_none(least_class)
        );
    }
    let named: Vec<i64> = payload.attributes.iter().map(|record| record.way_id).collect();
    let mut here: Vec<i64> = ways.iter().map(|&(way_id, _)| way_id).collect();
    here.dedup();
    findings.look(CheckId::Attributes, named == here, || {
        let missing = here.iter().find(|way| !named.contains(way));
        let needless = named.iter().find(|way| !here.contains(way));
        format!(
            "tile {id}: a way without attributes: {}; attributes without a way: {}",
            or_none(missing),
            or_none(needless)
        )
    });
    let attributes: BTreeMap<i64, u64> =
        payload.attributes.iter().map(|record| (record.way_id, hash(&record.attributes))).collect();
    ways.into_iter()
        .map(|(way_id, class)| {
            let attributes = attributes.get(&way_id).copied().unwrap_or_default();
            (way_id, StoredWay { class, attributes })
        })
        .collect()
}

/// A hash of all fields.
fn hash(attributes: &RoadAttributes) -> u64 {
    let mut hasher = DefaultHasher::new();
    attributes.hash(&mut hasher);
    hasher.finish()
}

/// The class and the attributes of each way in the first tile that has the way.
#[derive(Default)]
pub(crate) struct FirstWays {
    by_id: BTreeMap<i64, (TileId, StoredWay)>,
}

impl FirstWays {
    /// Compares the ways of a tile with those of earlier tiles.
    pub(crate) fn add(
        &mut self,
        id: TileId,
        facts: Vec<(i64, StoredWay)>,
        findings: &mut Findings,
    ) {
        for (way_id, found) in facts {
            let &mut (first, said) = self.by_id.entry(way_id).or_insert((id, found));
            look!(
                findings,
                Classes,
                said.class == found.class,
                "way {way_id} is of class {} in tile {id} and of class {} in tile {first}",
                found.class,
                said.class
            );
            look!(
                findings,
                Attributes,
                said.attributes == found.attributes,
                "the attributes of way {way_id} differ between tiles {id} and {first}"
            );
        }
    }
}
