//! The stretches of an extract's roads from junction to junction, as a router reads them.

use std::{
    collections::{BTreeMap, HashMap},
    fmt::Write as _,
    path::Path,
};

use corniche_areas::AreaObject;
use corniche_geom::LatticePoint;
use corniche_network::{Breaks, Chain, ChainNumber, Chains, Link, Network};
use corniche_roads::{FunctionalRoadClass, Oneway, Structure};
use corniche_tileset::FilePackage;
use corniche_work::{Observer, Stage};

use crate::{
    deck_lines::{Carrier, lay_on_deck},
    dem_ground::{DemLine, DemNodes},
    error::{ElevationError, FeaturesError},
    feature::oneway,
    features::{About, FeatureRequest, FeatureSource},
    grades::{GRADE_LENGTH_M, MeasuredChains},
    heights::{Elevation, dem_heights},
    measures::{ProfileGrades, profile_of},
    piece::{Vertex, larger},
    road_query::{RoadQuery, named_ways},
    span_facts::SpanFacts,
    vector::{
        Field, FieldKind, Record, Shape, ShapeKind, Value, VectorFile, fields, fields_of, real,
        text,
    },
};

/// Lines of a network lie on its ways: half a metre allows for nothing but rounding.
const NEAR_STEPS: f64 = 500.0;
/// Edges are told of after so many.
const TOLD_EDGES: usize = 1024;

/// What was exported.
#[derive(Debug, Clone, PartialEq)]
pub struct EdgesSummary {
    /// Edges written.
    pub edges: u64,
    /// Edges of which no part lies on ground; they are left out.
    pub without_ground: u64,
    /// Edges with a height that is not known, because they leave the ground, or nothing carries their bridge or tunnel: they have no ascent.
    pub without_ascent: u64,
    /// True length in plan, metres.
    pub length_m: f64,
    /// What heights are, in words.
    pub heights: String,
    /// How far heights are from the elevation files between vertices at most, metres; without bridges and tunnels.
    pub height_tolerance_m: f64,
    /// The bridges and tunnels of the network.
    pub spans: SpanFacts,
}

/// What is known of an edge.
struct Edge<'a> {
    ends: [Option<i64>; 2],
    ways: String,
    shares: Shares<'a>,
    grades: Option<ProfileGrades>,
    /// At its nodes, as other edges share them, or of its own line where it is alone there.
    heights_m: [Option<f64>; 2],
}

/// What an edge is made of, by length in metres.
#[derive(Default)]
struct Shares<'a> {
    length_m: f64,
    kinds: BTreeMap<(FunctionalRoadClass, &'a str), f64>,
    bridge_m: f64,
    tunnel_m: f64,
    /// Permitted directions, relative to the edge.
    oneways: Vec<Oneway>,
}

fields! { FIELDS, edge: &Edge<'_>:
    "from_node", Integer64, "", "id of the node where it begins; null where a way is cut", edge.ends[0];
    "to_node", Integer64, "", "id of the node where it ends; null where a way is cut", edge.ends[1];
    "ways", Text, "", "ids of its ways in their order, each with `f` where the edge runs along the way and `b` where it runs against it",
        edge.ways.as_str();
    "class", Integer, "", "functional road class of the largest part",
        edge.shares.largest().0.map(|class| i64::from(class.number()));
    "highway", Text, "", "OSM's `highway` of the largest part", text(edge.shares.largest().1);
    "oneway", Text, "", "`yes` (from the first to the last node), `-1` (against it), `no`, or `mixed`",
        edge.shares.oneway();
    "length_m", Real, "m", "true length in plan, on the ellipsoid of WGS84", real(edge.shares.length_m);
    "ascent_m", Real, "m", "sum of all that the smooth line rises from the first to the last node; null where a height is not known",
        edge.grades.map(|grades| real(grades.ascent_m));
    "descent_m", Real, "m", "sum of all that it falls from the first to the last node", edge.grades.map(|grades| real(grades.descent_m));
    "ascent_back_m", Real, "m", "sum of all that it rises on the way back", edge.grades.map(|grades| real(grades.descent_m));
    "descent_back_m", Real, "m", "sum of all that it falls on the way back", edge.grades.map(|grades| real(grades.ascent_m));
    "weighted_grade_pct", Real, "%", "size of the grade, up or down, weighted by length", edge.weighted_pct().map(real);
    "steepest_pct", Real, "%", "steepest grade over 50 m or more, up or down; null where it is shorter",
        edge.grades.and_then(|grades| grades.steepest).map(|grade| real(100.0 * grade));
    "from_height_m", Real, "m", "height of the smooth line at the first node: the same for all edges there, but of a way that only touches a deck its own",
        edge.heights_m[0].map(real);
    "to_height_m", Real, "m", "height of the smooth line at the last node", edge.heights_m[1].map(real);
    "bridge_share", Real, "", "part of its length on bridges, 0 to 1", real(edge.shares.share(edge.shares.bridge_m));
    "tunnel_share", Real, "", "part of its length in tunnels, 0 to 1", real(edge.shares.share(edge.shares.tunnel_m));
}

/// The fields of edges, in their order.
#[must_use]
pub fn edge_fields() -> Vec<Field> {
    fields_of(FIELDS)
}

/// Writes the edges of a network to a new file at `path`: each is there once, from the node with the smaller id. Their lines lie on the elevation
/// files and on decks; ascents and grades are those of smooth lines. After an error the file at `path` is of no use.
///
/// # Errors
/// When the request cannot be met, an elevation file cannot be read, or something cannot be written.
pub fn export_edges(
    package: &FilePackage,
    (request, road): (&FeatureRequest<FunctionalRoadClass>, Option<&RoadQuery>),
    (elevation, network): (Elevation<'_>, &Network),
    path: &Path,
    observer: &dyn Observer,
) -> Result<EdgesSummary, FeaturesError> {
    let source = FeatureSource::new(package, request)?;
    let named = road.map(|road| named_ways(package, source.level, Some(road), observer));
    let named = named.transpose()?;
    let frame = &package.manifest().frame;
    // Edges that reach the package's data are whole.
    let plan = elevation.plan.of_whole_data();
    let elevation = Elevation { plan: &plan, ..elevation };
    let mut nodes = DemNodes::new(elevation, frame);
    let places = &source.places;
    let measured = MeasuredChains::measure(network, places, elevation, observer)?;
    let about = About {
        fields: edge_fields(),
        description: format!("Roads from junction to junction. Heights: {}.", places.heights),
        metadata: vec![("HEIGHTS", places.heights.clone())],
    };
    let layer = source.layer("edges", ShapeKind::Lines, about);
    let mut file = VectorFile::create(path, request.format, layer)?;
    let mut summary = EdgesSummary {
        edges: 0,
        without_ground: 0,
        without_ascent: 0,
        length_m: 0.0,
        heights: places.heights.clone(),
        height_tolerance_m: 0.0,
        spans: measured.decks.facts.clone(),
    };
    let edges = Chains::of(network, Breaks::Junctions);
    let mut numbers: Vec<ChainNumber> = edges.numbers().collect();
    if let Some(named) = &named {
        let is_meant = |link: &Link| named.meant.contains(&network.way_of(*link).way_id);
        numbers.retain(|&number| edges.get(number).links.iter().any(is_meant));
    }
    observer.begin(Stage::ExportFeatures, Some(numbers.len() as u64));
    for some in numbers.chunks(TOLD_EDGES) {
        observer.check()?;
        for &number in some {
            let chain = edges.get(number);
            if !measured.reaches(&chain) {
                continue;
            }
            let LaidEdge { lines, decks } = laid(&measured, &mut nodes, &chain)?;
            if lines.is_empty() {
                summary.without_ground += 1;
                continue;
            }
            let profile = measured.profile(chain.links, &decks);
            let nodes_m = node_heights(&measured, &chain);
            let own_m = |place: Option<&[f64; 2]>| place.map(|&[_, height_m]| height_m);
            let own_m =
                profile.as_ref().map(|profile| [profile.first(), profile.last()].map(own_m));
            let own_m = own_m.unwrap_or_default();
            let edge = Edge {
                ends: chain.ends.map(|node| network.node_id(node)),
                ways: ways_text(network, &chain),
                shares: Shares::of(&measured, &chain),
                grades: profile.as_deref().map(grades_of),
                heights_m: [0, 1].map(|end| nodes_m[end].or(own_m[end])),
            };
            summary.edges += 1;
            summary.length_m += edge.shares.length_m;
            summary.without_ascent += u64::from(edge.grades.is_none());
            let object = AreaObject::Way(network.way_of(chain.links[0]).way_id);
            let mut carried = Vec::new();
            for line in lines {
                summary.height_tolerance_m =
                    summary.height_tolerance_m.max(line.tolerance_m.unwrap_or(0.0));
                carried.extend(places.carry(object, &line.vertices)?);
            }
            let values = FIELDS.iter().map(|(_, value)| value(&edge)).collect();
            file.push(Record { values, shape: Shape::Lines(carried) })?;
        }
        observer.advance(Stage::ExportFeatures, some.len() as u64);
    }
    file.tell_heights(dem_heights(summary.height_tolerance_m, true));
    file.finish()?;
    observer.end(Stage::ExportFeatures);
    Ok(summary)
}

/// An edge on the elevation files, and on the decks of its bridges and tunnels.
struct LaidEdge {
    lines: Vec<DemLine>,
    /// Distances and heights along the lines of its bridges and tunnels, by the numbers of their links; lines with a gap are not there.
    decks: HashMap<usize, Vec<[f64; 2]>>,
}

fn laid(
    measured: &MeasuredChains<'_>,
    nodes: &mut DemNodes<'_>,
    chain: &Chain<'_>,
) -> Result<LaidEdge, ElevationError> {
    let network = measured.network;
    let distance_m = measured.places.metric();
    let mut lines: Vec<DemLine> = Vec::new();
    let mut decks = HashMap::new();
    let mut first_link = 0;
    for links in chain.links.chunk_by(|one, other| {
        let [one, other] = [one, other].map(|link| network.way_of(*link).structure);
        one == Structure::Ground && other == Structure::Ground
    }) {
        let vertex =
            |point: LatticePoint| Vertex { at: point.in_steps(), z_m: f64::NAN, is_source: true };
        let points = network.points_of_chain(&Chain { links, ..*chain });
        let line: Vec<Vertex> = points.into_iter().map(vertex).collect();
        let structure = network.way_of(links[0]).structure;
        let way = match structure {
            Structure::Ground => Vec::new(),
            _ => measured.of_link(links[0]),
        };
        let is_turned = links[0].is_against;
        let carrier = Carrier { structure, way: &way, most_steps: NEAR_STEPS, is_turned };
        for own in lay_on_deck(nodes, &line, &carrier, &distance_m)? {
            if own.on_deck && own.has_end == [true; 2] {
                decks.insert(first_link, profile_of(&own.vertices, &distance_m));
            }
            let ends = lines.last().and_then(|line| line.vertices.last());
            let goes_on = own.has_end[0]
                && ends.map(|end| end.at) == own.vertices.first().map(|first| first.at);
            match lines.last_mut().filter(|line| goes_on && line.has_end[1]) {
                Some(before) => {
                    before.vertices.extend(own.vertices.into_iter().skip(1));
                    before.tolerance_m = larger(before.tolerance_m, own.tolerance_m);
                    before.has_end[1] = own.has_end[1];
                }
                None => lines.push(own),
            }
        }
        first_link += links.len();
    }
    Ok(LaidEdge { lines, decks })
}

/// The grades of an edge. Files have had −0 for what a level edge falls.
fn grades_of(profile: &[[f64; 2]]) -> ProfileGrades {
    let falls = profile.array_windows().map(|[from, to]| (-(to[1] - from[1])).max(0.0));
    ProfileGrades { descent_m: falls.sum(), ..ProfileGrades::of([profile], GRADE_LENGTH_M) }
}

/// The heights of both nodes that other edges share; none on a bridge or in a tunnel, whose own height counts there.
fn node_heights(measured: &MeasuredChains<'_>, chain: &Chain<'_>) -> [Option<f64>; 2] {
    let structure = |link: Option<&Link>| link.map(|link| measured.network.way_of(*link).structure);
    let links = [chain.links.first(), chain.links.last()];
    let is_on_ground = links.map(|link| structure(link) == Some(Structure::Ground));
    [0, 1].map(|end| measured.node_m(chain.ends[end]).filter(|_| is_on_ground[end]))
}

impl Edge<'_> {
    fn weighted_pct(&self) -> Option<f64> {
        let grades = self.grades?;
        let length_m = self.shares.length_m;
        (length_m > 0.0).then(|| 100.0 * (grades.ascent_m + grades.descent_m) / length_m)
    }
}

/// The ways of an edge, each once in a row, with their directions.
fn ways_text(network: &Network, chain: &Chain<'_>) -> String {
    let mut ways: Vec<(i64, bool)> =
        chain.links.iter().map(|link| (network.way_of(*link).way_id, link.is_against)).collect();
    ways.dedup();
    let mut text = String::new();
    for (way_id, is_against) in ways {
        let space = if text.is_empty() { "" } else { " " };
        // Writing to a String cannot fail.
        let _ = write!(text, "{space}{way_id}{}", if is_against { 'b' } else { 'f' });
    }
    text
}

impl<'a> Shares<'a> {
    fn of(measured: &MeasuredChains<'a>, chain: &Chain<'_>) -> Self {
        let network = measured.network;
        let mut shares = Self::default();
        for &link in chain.links {
            let (way, own_m) = (network.way_of(link), measured.link_m(link));
            shares.length_m += own_m;
            *shares.kinds.entry((way.class, network.highway_of(way))).or_default() += own_m;
            match way.structure {
                Structure::Ground => {}
                Structure::Bridge => shares.bridge_m += own_m,
                Structure::Tunnel => shares.tunnel_m += own_m,
            }
            shares.oneways.push(match (way.oneway, link.is_against) {
                (Oneway::Forward, true) => Oneway::Backward,
                (Oneway::Backward, true) => Oneway::Forward,
                (oneway, _) => oneway,
            });
        }
        shares
    }

    fn share(&self, part_m: f64) -> f64 {
        if self.length_m > 0.0 { part_m / self.length_m } else { 0.0 }
    }

    /// What most of it is; of equal parts the more important class.
    fn largest(&self) -> (Option<FunctionalRoadClass>, &'a str) {
        let mut most: Option<((FunctionalRoadClass, &'a str), f64)> = None;
        for (&kind, &own_m) in &self.kinds {
            if most.is_none_or(|(_, most_m)| own_m > most_m) {
                most = Some((kind, own_m));
            }
        }
        most.map_or((None, ""), |((class, highway), _)| (Some(class), highway))
    }

    fn oneway(&self) -> &'static str {
        match self.oneways.split_first() {
            Some((first, others)) if others.iter().all(|other| other == first) => oneway(*first),
            _ => "mixed",
        }
    }
}
