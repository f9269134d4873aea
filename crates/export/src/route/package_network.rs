//! The network of a package's own lines, which join where they share a point.

use std::collections::BTreeMap;

use corniche_geom::{LatticePoint, Polyline};
use corniche_network::{Network, NetworkBuilder};
use corniche_roads::Road;
use corniche_tileset::FilePackage;
use corniche_work::{Observer, Stage, workers::one_by_one};

use crate::{
    error::RouteError,
    join::lines,
    piece::{WayPiece, own_points},
    plane::nearest_point,
    read,
};

/// Returns the roads of a level as a network. Packages do not contain nodes, but no simplification
/// removes the points at which roads join. Ways on the ground, bridges and tunnels, or ways of
/// several layers cross without joining if they share a point within all of them.
pub(crate) fn package_network(
    package: &FilePackage,
    level: u8,
    observer: &dyn Observer,
) -> Result<Network, RouteError> {
    let mut by_way: BTreeMap<i64, Vec<WayPiece>> = BTreeMap::new();
    let tiles = read::tiles(package, level, None)?;
    one_by_one((observer, Stage::ExportTiles), &tiles, |&id| {
        for mut piece in read::all_pieces(package, id)? {
            // Crossings with the ground's triangles are not points of the road.
            piece.vertices = own_points(&piece.vertices).map(|(_, vertex)| *vertex).collect();
            by_way.entry(piece.key.way_id).or_default().push(piece);
        }
        Ok::<(), RouteError>(())
    })?;
    let mut roads = Vec::new();
    for pieces in by_way.into_values() {
        let first = &pieces[0];
        let (way_id, class) = (first.key.way_id, first.class);
        for line in lines(&pieces) {
            let points = line.vertices.iter().map(|vertex| nearest_point(vertex.at)).collect();
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

/// Finds the points at which roads join: their ends, and points that several roads share.
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
