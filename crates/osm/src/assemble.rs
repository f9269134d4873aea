//! Makes roads from ways and the positions of their nodes.

use corniche_geom::{LatticePoint, Polyline};
use corniche_roads::Road;

use crate::{
    Defect, ReadOsmError, location,
    nodes::NodeTable,
    read_request::Place,
    self_crossings::self_crossings,
    ways::{RoadWay, Ways},
};

/// What became of one way.
#[derive(Debug, Default)]
pub(crate) struct Assembled {
    pub(crate) roads: Vec<Road>,
    pub(crate) defects: Vec<Defect>,
}

/// Makes roads of some ways, in their order. All their points are placed in one call.
pub(crate) fn assemble(
    some: &[RoadWay],
    ways: &Ways,
    table: &NodeTable,
    place: &Place<'_>,
) -> Result<Vec<Assembled>, ReadOsmError> {
    let mut positions_deg = Vec::new();
    let mut stops = Vec::new();
    for way in some {
        for &id in ways.node_ids_of(way) {
            let number = table.ids.number(id);
            let found = number.map_or(location::MISSING, |number| table.places.location(number));
            let position_deg = location::degrees(found);
            positions_deg.extend(position_deg);
            stops.push(Stop {
                is_fixed: number.is_some_and(|number| table.ids.is_shared(number)),
                place: match position_deg {
                    Some(_) => StopPlace::Known,
                    None if found == location::OUT_OF_RANGE => StopPlace::OutOfRange,
                    None => StopPlace::Missing,
                },
            });
        }
    }
    let points = place(&positions_deg);
    if points.len() != positions_deg.len() {
        return Err(ReadOsmError::Place { expected: positions_deg.len(), got: points.len() });
    }
    let mut points = points.into_iter();
    let mut rest = stops.as_slice();
    let mut assembled = Vec::with_capacity(some.len());
    for way in some {
        let (own, later) = rest.split_at(way.nodes_end - way.nodes_start);
        assembled.push(assemble_way(way, own, &mut points));
        rest = later;
    }
    Ok(assembled)
}

/// A node of a way.
struct Stop {
    is_fixed: bool,
    place: StopPlace,
}

enum StopPlace {
    /// The node has a position: the next one of the placed points.
    Known,
    OutOfRange,
    Missing,
}

/// Cuts the way where points are missing, merges equal neighbours, and makes a road of each piece.
///
/// ```text
///  nodes   1 ─ 2 ─ ? ─ 4 ─ 5 ─ 5 ─ 6 ─ ?        joining 2 and 4 would draw a road where none may be
///  roads   1 ─ 2       4 ─ 5 ───── 6
/// ```
fn assemble_way(
    way: &RoadWay,
    stops: &[Stop],
    points: &mut impl Iterator<Item = Option<LatticePoint>>,
) -> Assembled {
    let way_id = way.way_id;
    let mut assembled = Assembled::default();
    let (mut missing, mut out_of_range, mut outside, mut duplicates, mut strays) = (0, 0, 0, 0, 0);
    let mut pieces: Vec<Vec<(LatticePoint, bool)>> = vec![Vec::new()];
    for stop in stops {
        let point = match stop.place {
            StopPlace::Known => points.next().flatten(),
            StopPlace::OutOfRange | StopPlace::Missing => None,
        };
        match (&stop.place, point, pieces.last_mut()) {
            (StopPlace::Known, Some(point), Some(piece)) => match piece.last_mut() {
                Some((last, is_fixed)) if *last == point => {
                    duplicates += 1;
                    *is_fixed |= stop.is_fixed;
                }
                _ => piece.push((point, stop.is_fixed)),
            },
            (StopPlace::Known, ..) => outside += 1,
            (StopPlace::OutOfRange, ..) => out_of_range += 1,
            (StopPlace::Missing, ..) => missing += 1,
        }
        if point.is_none() {
            pieces.push(Vec::new());
        }
    }
    if stops.len() < 2 {
        assembled.defects.push(Defect::TooFewNodes { way_id, nodes: stops.len() as u32 });
        return assembled;
    }
    let mut crossings = 0;
    for piece in pieces {
        let count = piece.len() as u32;
        let road = road(way, piece);
        crossings += road.as_ref().map_or(0, |road| self_crossings(road.line.points()));
        strays += if road.is_none() { count } else { 0 };
        assembled.roads.extend(road);
    }
    let roads = assembled.roads.len() as u32;
    for (count, defect) in [
        (missing, Defect::MissingNodes { way_id, points: missing }),
        (out_of_range, Defect::OutOfRange { way_id, points: out_of_range }),
        (outside, Defect::OutsideProjection { way_id, points: outside }),
        (duplicates, Defect::DuplicatePoints { way_id, points: duplicates }),
        (strays.min(roads), Defect::StrayPoints { way_id, points: strays }),
        (roads.saturating_sub(1), Defect::Split { way_id, roads }),
        (u32::from(roads == 0), Defect::NoLine { way_id }),
        (crossings, Defect::SelfCrossing { way_id, crossings }),
    ] {
        if count > 0 {
            assembled.defects.push(defect);
        }
    }
    assembled
}

/// One road of a piece of a way; `None` when the piece has less than two points.
fn road(way: &RoadWay, piece: Vec<(LatticePoint, bool)>) -> Option<Road> {
    let last = piece.len().checked_sub(1)?;
    let is_kept = |(index, is_fixed): (usize, bool)| {
        (is_fixed || index == 0 || index == last).then_some(index as u32)
    };
    let fixed =
        piece.iter().map(|&(_, is_fixed)| is_fixed).enumerate().filter_map(is_kept).collect();
    // Equal neighbours are merged already, so the indices stay true.
    let line = Polyline::new(piece.into_iter().map(|(point, _)| point).collect()).ok()?;
    Some(Road {
        way_id: way.way_id,
        class: way.class,
        attributes: way.attributes.clone(),
        line,
        fixed,
    })
}
