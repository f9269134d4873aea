//! The network of a package's own lines: they join where they have a point in common.

use std::collections::BTreeMap;

use corniche_geom::{LatticePoint, Polyline};
use corniche_network::{Network, NetworkBuilder};
use corniche_roads::{FunctionalRoadClass, Road};
use corniche_tileset::FilePackage;
use corniche_work::{Observer, Stage, workers::one_by_one};

use crate::{error::RouteError, join::lines, piece::Piece, read};

/// The roads of a level as a network. Packages do not know nodes, but no simplification takes the points away at which roads join. Where ways on the
/// ground, bridges and tunnels, or ways of several layers have a point in common within them all, they cross and do not join.
pub(crate) fn package_network(
    package: &FilePackage,
    level: u8,
    classes: &[FunctionalRoadClass],
    observer: &dyn Observer,
) -> Result<Network, RouteError> {
    let mut by_way: BTreeMap<i64, Vec<Piece>> = BTreeMap::new();
    let tiles = read::tiles(package, level, None)?;
    one_by_one((observer, Stage::ExportTiles), &tiles, |&id| {
        for mut piece in read::pieces(package, id, classes)? {
            // Crossings with the ground's triangles are no points of the road.
            let last = piece.vertices.len() - 1;
            let mut index = 0;
            piece.vertices.retain(|vertex| {
                index += 1;
                vertex.is_source || index == 1 || index == last + 1
            });
            by_way.entry(piece.key.way_id).or_default().push(piece);
        }
        Ok::<(), RouteError>(())
    })?;
    let mut roads = Vec::new();
    for pieces in by_way.into_values() {
        let first = &pieces[0];
        let (way_id, class) = (first.key.way_id, first.class);
        for line in lines(&pieces) {
            let point = |at: [f64; 2]| {
                let [u, v] = at.map(|steps| steps.round() as i64);
                LatticePoint::new(u, v)
            };
            let points = line.vertices.iter().map(|vertex| point(vertex.at)).collect();
            if let Ok(line) = Polyline::new(points) {
                let attributes = first.attributes.clone();
                let (fixed, node_ids, same_places, met) = Default::default();
                roads.push(Road {
                    way_id,
                    class,
                    attributes,
                    line,
                    fixed,
                    node_ids,
                    same_places,
                    met,
                });
            }
        }
    }
    join(&mut roads);
    let mut builder = NetworkBuilder::default();
    for road in &roads {
        builder.push(road);
    }
    Ok(builder.finish())
}

/// Finds the points at which roads join: their ends, and points that several have in common.
fn join(roads: &mut [Road]) {
    let mut points: Vec<(LatticePoint, usize, u32)> = Vec::new();
    for (number, road) in roads.iter().enumerate() {
        points.extend((0..).zip(road.line.points()).map(|(index, point)| (*point, number, index)));
    }
    points.sort_unstable();
    let mut node_id = 0;
    let mut stops: Vec<Vec<(u32, i64)>> = vec![Vec::new(); roads.len()];
    for at_place in points.chunk_by(|one, other| one.0 == other.0) {
        let is_end = |&(_, number, index): &(LatticePoint, usize, u32)| {
            index == 0 || index as usize + 1 == roads[number].line.points().len()
        };
        let kind = |&(_, number, _): &(LatticePoint, usize, u32)| {
            let attributes = &roads[number].attributes;
            (attributes.structure as u8, attributes.layer)
        };
        if at_place.iter().any(is_end) {
            node_id += 1;
            for &(_, number, index) in at_place {
                stops[number].push((index, node_id));
            }
            continue;
        }
        let mut within: Vec<_> = at_place.to_vec();
        within.sort_by_key(kind);
        for level in within.chunk_by(|one, other| kind(one) == kind(other)) {
            if level.len() >= 2 {
                node_id += 1;
                for &(_, number, index) in level {
                    stops[number].push((index, node_id));
                }
            }
        }
    }
    for (road, mut stops) in roads.iter_mut().zip(stops) {
        stops.sort_unstable();
        (road.fixed, road.node_ids) = stops.into_iter().map(|(at, id)| (at, Some(id))).unzip();
    }
}

#[cfg(test)]
#[path = "package_network_tests.rs"]
mod tests;
