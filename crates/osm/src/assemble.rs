//! Builds roads from ways and the coordinates of their nodes.

use std::ops::Range;

use corniche_geom::{LatticePoint, OnSeamedMap, Polyline, Seam, line_length_m, split_at_seam};
use corniche_roads::{FunctionalRoadClass, MetNodes, Railway, Road, RoadAttributes, Structure};

use crate::{
    ExtractDefect, LeftOutReason, ReadOsmError, location,
    location::Location,
    read_request::LatticePlacement,
    records::Stop,
    self_crossings::self_crossings,
    to_and_fro::go_to_and_fro,
    way_bytes::{LeftOutWay, Track, WayKind},
};

/// A way without its nodes.
#[derive(Debug)]
pub(crate) struct PlainWay {
    pub(crate) way_id: i64,
    pub(crate) kind: WayKind,
    /// The ids of the way's nodes; empty if ids are not requested.
    pub(crate) node_ids: Vec<i64>,
    /// The range of stops that belong to the way, among those of its batch.
    pub(crate) stops: Range<usize>,
}

/// The result of assembling one way.
#[derive(Debug, Default)]
pub(crate) struct AssembledWay {
    /// The roads of the way. A skipped way has roads only if it carries bridges and tunnels.
    pub(crate) roads: Vec<Road>,
    /// What the roads are instead, if the way is no road.
    pub(crate) railway: Option<Railway>,
    pub(crate) defects: Vec<ExtractDefect>,
    /// The reason why the way is skipped, its `highway` value and its length in micrometres.
    pub(crate) left_out: Option<(LeftOutReason, String, u64)>,
}

/// Builds the roads of some ways, in the order of the ways. All points are converted in one call.
pub(crate) fn assemble(
    some: Vec<PlainWay>,
    all_stops: &[Stop],
    placing: LatticePlacement<'_>,
) -> Result<Vec<AssembledWay>, ReadOsmError> {
    let stops_of = |way: &PlainWay| &all_stops[way.stops.clone()];
    let has_line = |way: &&PlainWay| match &way.kind {
        WayKind::Road(..) | WayKind::Railway(_) => true,
        // Other ways join it by the ids of its nodes.
        WayKind::LeftOut(way_kind) => way_kind.carrier.is_some() && !way.node_ids.is_empty(),
    };
    let stops = some.iter().filter(has_line).flat_map(stops_of);
    let positions_deg: Vec<_> = stops.filter_map(|stop| location::degrees(stop.location)).collect();
    let points = (placing.place)(&positions_deg);
    if points.len() != positions_deg.len() {
        return Err(ReadOsmError::Place { expected: positions_deg.len(), got: points.len() });
    }
    let mut points = points.into_iter();
    let assemble = |way: PlainWay| {
        let has_line = has_line(&&way);
        let PlainWay { way_id, kind, node_ids, stops } = way;
        let stops = &all_stops[stops];
        match kind {
            WayKind::Road(class, attributes) => {
                let (node_ids, is_carrier) = (&*node_ids, false);
                let what = What { way_id, class, attributes, node_ids, is_carrier };
                assemble_way(what, stops, &mut points, placing)
            }
            WayKind::LeftOut(LeftOutWay { reason, highway, carrier, railway }) => {
                let length_um = length_um(stops.iter().map(|stop| stop.location));
                let mut roads = Vec::new();
                if let Some(carrier) = carrier.filter(|_| has_line) {
                    let what = What::carrier(way_id, carrier, highway.clone(), &node_ids);
                    roads = assemble_way(what, stops, &mut points, placing).roads;
                }
                let left_out = Some((reason, highway, length_um));
                AssembledWay { roads, railway, left_out, ..AssembledWay::default() }
            }
            WayKind::Railway(Track { kind, structure, layer }) => {
                let what = What::carrier(way_id, (structure, layer), String::new(), &node_ids);
                let roads = assemble_way(what, stops, &mut points, placing).roads;
                AssembledWay { roads, railway: Some(kind), ..AssembledWay::default() }
            }
        }
    };
    Ok(some.into_iter().map(assemble).collect())
}

/// Returns the true length, in micrometres, of a way that is not on the map. Its segments are
/// straight in degrees; segments at a node without coordinates do not count.
pub(crate) fn length_um(locations: impl Iterator<Item = Location>) -> u64 {
    const UM: f64 = 1e6;
    let (mut sum, mut last): (u64, Option<[f64; 2]>) = (0, None);
    for place in locations.map(location::degrees) {
        if let (Some(from), Some(to)) = (last, place) {
            let to = [Seam::of_degrees().around(from[0]).image(to[0]), to[1]];
            sum += (line_length_m([from, to], &|at| at) * UM).round() as u64;
        }
        last = place;
    }
    sum
}

/// The properties that all roads of a way share.
struct What<'a> {
    way_id: i64,
    class: FunctionalRoadClass,
    attributes: RoadAttributes,
    /// One id per stop, or none at all.
    node_ids: &'a [i64],
    /// Whether the way is no road here, but carries or crosses bridges and tunnels; then each node
    /// counts at which it may carry or meet another way.
    is_carrier: bool,
}

/// A node of a way on the lattice.
#[derive(Clone, Copy)]
struct PlacedNode {
    point: LatticePoint,
    /// Whether two roads reference the node, or one road does so twice. A cut at the seam must be
    /// preserved, too.
    is_fixed: bool,
    /// The same for roads and the ways that carry them.
    is_met: bool,
    /// The OSM id; `None` at a cut on the seam, and if ids are not requested.
    id: Option<i64>,
}

impl OnSeamedMap for PlacedNode {
    fn x(&self) -> f64 {
        self.point.x()
    }

    fn with_x(self, x: f64) -> Self {
        Self { point: self.point.with_x(x), ..self }
    }

    fn towards(self, other: Self, share: f64) -> Self {
        let point = self.point.towards(other.point, share);
        Self { point, is_fixed: true, is_met: false, id: None }
    }

    fn is_at(&self, other: &Self) -> bool {
        self.point == other.point
    }
}

/// Cuts the way where points are missing, merges equal neighbours, and builds a road from each
/// piece.
///
/// ```text
///  nodes   1 ─ 2 ─ ? ─ 4 ─ 5 ─ 5 ─ 6 ─ ?        joining 2 and 4 would draw a road where none may be
///  roads   1 ─ 2       4 ─ 5 ───── 6
/// ```
///
/// A way that crosses the seam of the map continues at the other end as another road. This is not a
/// defect.
fn assemble_way(
    way: What<'_>,
    stops: &[Stop],
    points: &mut impl Iterator<Item = Option<LatticePoint>>,
    placing: LatticePlacement<'_>,
) -> AssembledWay {
    let way_id = way.way_id;
    let mut assembled = AssembledWay::default();
    let (mut missing, mut out_of_range, mut outside, mut duplicates, mut strays) = (0, 0, 0, 0, 0);
    let mut pieces: Vec<Vec<PlacedNode>> = vec![Vec::with_capacity(stops.len())];
    let (mut same_places, mut met_places) = (Vec::new(), Vec::new());
    for (index, stop) in stops.iter().enumerate() {
        // The node has coordinates: it takes the next converted point.
        let is_known = location::degrees(stop.location).is_some();
        let point = if is_known { points.next().flatten() } else { None };
        match (point, pieces.last_mut()) {
            (Some(point), Some(piece)) => match piece.last_mut() {
                Some(last) if last.point == point => {
                    duplicates += 1;
                    let next = way.placed(point, index, stop);
                    let pair = last.id.zip(next.id).map(|(one, other)| [one, other]);
                    // Of several nodes at one point, those at which other roads may join take
                    // precedence.
                    if next.is_fixed && last.is_fixed {
                        same_places.extend(pair);
                    } else if next.is_met && last.is_met {
                        met_places.extend(pair);
                    }
                    let is_met = last.is_met || next.is_met;
                    if (next.is_fixed, next.is_met) > (last.is_fixed, last.is_met) {
                        *last = next;
                    }
                    last.is_met = is_met;
                }
                _ => piece.push(way.placed(point, index, stop)),
            },
            _ if is_known => outside += 1,
            _ if stop.location == location::OUT_OF_RANGE => out_of_range += 1,
            _ => missing += 1,
        }
        if point.is_none() {
            pieces.push(Vec::new());
        }
    }
    if stops.len() < 2 {
        assembled.defects.push(ExtractDefect::TooFewNodes { way_id, nodes: stops.len() as u32 });
        return assembled;
    }
    let (mut crossings, mut roads) = (0, 0);
    for piece in pieces {
        let count = piece.len() as u32;
        let parts = split_at_seam(piece, placing.seam);
        let before = assembled.roads.len();
        assembled.roads.extend(parts.into_iter().filter_map(|part| road(&way, part)));
        let own = &assembled.roads[before..];
        crossings += own.iter().map(|road| self_crossings(road.line.points())).sum::<u32>();
        strays += if own.is_empty() { count } else { 0 };
        roads += u32::from(!own.is_empty());
    }
    let lines: Vec<_> = assembled.roads.iter().map(|road| &road.line).collect();
    let is_to_and_fro = go_to_and_fro(&lines, placing.square_steps);
    if is_to_and_fro {
        assembled.roads.clear();
    }
    // Nearly every way is one road, so its texts need not be copied.
    if let Some((last, others)) = assembled.roads.split_last_mut() {
        for road in others {
            road.attributes.clone_from(&way.attributes);
        }
        last.attributes = way.attributes;
    }
    if let Some(first) = assembled.roads.first_mut() {
        first.same_places = same_places;
        first.met.same_places = met_places;
    }
    for (count, defect) in [
        (missing, ExtractDefect::MissingNodes { way_id, points: missing }),
        (out_of_range, ExtractDefect::OutOfRange { way_id, points: out_of_range }),
        (outside, ExtractDefect::OutsideProjection { way_id, points: outside }),
        (duplicates, ExtractDefect::DuplicatePoints { way_id, points: duplicates }),
        (strays.min(roads), ExtractDefect::StrayPoints { way_id, points: strays }),
        (roads.saturating_sub(1), ExtractDefect::Split { way_id, roads }),
        (u32::from(roads == 0), ExtractDefect::NoLine { way_id }),
        (u32::from(is_to_and_fro), ExtractDefect::ToAndFro { way_id }),
        (crossings, ExtractDefect::SelfCrossing { way_id, crossings }),
    ] {
        if count > 0 {
            assembled.defects.push(defect);
        }
    }
    assembled
}

impl<'a> What<'a> {
    /// Creates the properties of a way that is no road here.
    fn carrier(
        way_id: i64,
        (structure, layer): (Structure, i8),
        highway: String,
        node_ids: &'a [i64],
    ) -> Self {
        let attributes = RoadAttributes { structure, layer, highway, ..RoadAttributes::default() };
        Self { way_id, class: FunctionalRoadClass::LEAST, attributes, node_ids, is_carrier: true }
    }

    /// Returns the node of a stop with its point on the lattice.
    fn placed(&self, point: LatticePoint, index: usize, stop: &Stop) -> PlacedNode {
        let is_met = stop.is_met();
        let is_fixed = if self.is_carrier { is_met } else { stop.is_shared() };
        PlacedNode { point, is_fixed, is_met, id: self.node_ids.get(index).copied() }
    }
}

/// Returns the road of one piece of a way, still without attributes; `None` if the piece has fewer
/// than two points.
fn road(way: &What<'_>, piece: Vec<PlacedNode>) -> Option<Road> {
    let last = piece.len().checked_sub(1)?;
    let is_kept = |&index: &usize| piece[index].is_fixed || index == 0 || index == last;
    let fixed: Vec<u32> = (0..piece.len()).filter(is_kept).map(|index| index as u32).collect();
    let node_id = |&index: &u32| piece[index as usize].id;
    let node_ids = match way.node_ids {
        [] => Vec::new(),
        _ => fixed.iter().map(node_id).collect(),
    };
    let met = |index: usize| {
        let node = piece[index];
        Some((index as u32, node.id.filter(|_| node.is_met && !node.is_fixed)?))
    };
    let met =
        MetNodes { nodes: (0..piece.len()).filter_map(met).collect(), same_places: Vec::new() };
    // Equal neighbours are already merged, so the indices stay valid.
    let line = Polyline::new(piece.into_iter().map(|node| node.point).collect()).ok()?;
    Some(Road {
        way_id: way.way_id,
        class: way.class,
        attributes: RoadAttributes::default(),
        line,
        fixed,
        node_ids,
        same_places: Vec::new(),
        met,
    })
}
