//! Edges of the road network: stretches of an extract's roads from junction to junction, for
//! routers.

use std::{
    collections::{BTreeMap, HashMap},
    path::Path,
};

use corniche_geom::LatticePoint;
use corniche_layers::OsmObject;
use corniche_network::{Breaks, Chain, ChainNumber, Chains, Link, Network};
use corniche_roads::{FunctionalRoadClass, Oneway, Structure};
use corniche_tileset::FilePackage;
use corniche_work::{Observer, Stage};

use crate::{
    deck_lines::{Carrier, lay_on_deck},
    dem_ground::{DemLine, DemNodes},
    error::{ElevationError, FeaturesError},
    feature::oneway,
    features::{FeatureRequest, FeatureSource},
    grades::{GRADE_LENGTH_M, MeasuredChains},
    heights::{Elevation, dem_heights},
    measures::{ProfileGrades, profile_of},
    piece::{Vertex, larger},
    road_query::{RoadQuery, meant_ways},
    span_facts::SpanFacts,
    vector::{
        FeatureField, FeatureGeometry, FeatureRecord, FieldKind, FieldValue, ShapeKind,
        StyledClasses, VectorFile, fields, fields_of, real, text,
    },
};

/// Lines of a network are on their ways: half a metre allows for rounding only.
const NEAR_STEPS: f64 = 500.0;
/// Progress is reported after this many edges.
const TOLD_EDGES: usize = 1024;

/// The figures of an export of edges.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EdgesSummary {
    /// Edges written.
    pub edges: u64,
    /// Edges without any part on ground; they are skipped.
    pub without_ground: u64,
    /// Edges without ascent and descent, because a height is unknown: they leave the ground, or
    /// nothing carries their bridge or tunnel.
    pub without_ascent: u64,
    /// True length in plan, metres.
    pub length_m: f64,
    /// What heights refer to, in words.
    pub heights: String,
    /// The largest distance of lines from the elevation files, between vertices too, metres;
    /// bridges and tunnels excluded.
    pub height_tolerance_m: f64,
    /// The bridges and tunnels of the network.
    pub spans: SpanFacts,
}

/// The geometry, heights and attributes of an edge.
struct Edge<'a> {
    ends: [Option<i64>; 2],
    ways: String,
    shares: Shares<'a>,
    grades: Option<ProfileGrades>,
    /// Heights at both OSM nodes, shared with the other edges there, or taken from the edge's own
    /// line if no other edge shares the node.
    heights_m: [Option<f64>; 2],
}

/// The composition of an edge: lengths in metres by attribute.
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
    "from_node", Integer64, "", "id of the OSM node where the edge begins; null if a way is cut there", edge.ends[0];
    "to_node", Integer64, "", "id of the OSM node where the edge ends; null if a way is cut there", edge.ends[1];
    "ways", Text, "", "ids of its ways in order, each followed by `f` (the edge has the direction of the way) or `b` (the opposite)",
        edge.ways.as_str();
    "class", Integer, "", "functional road class with the largest share of the length",
        edge.shares.largest().0.map(|class| i64::from(class.number()));
    "highway", Text, "", "OSM's `highway` value with the largest share of the length", text(edge.shares.largest().1);
    "oneway", Text, "", "`yes` (from `from_node` to `to_node`), `-1` (in the opposite direction), `no` or `mixed`",
        edge.shares.oneway();
    "length_m", Real, "m", "2D length (in plan), on the WGS84 ellipsoid", real(edge.shares.length_m);
    "ascent_m", Real, "m", "total ascent of the smooth line from `from_node` to `to_node`; null if a height is unknown",
        edge.metres(|grades| grades.ascent_m);
    "descent_m", Real, "m", "total descent in the same direction; null if a height is unknown", edge.metres(|grades| grades.descent_m);
    "ascent_back_m", Real, "m", "total ascent in the opposite direction; null if a height is unknown", edge.metres(|grades| grades.descent_m);
    "descent_back_m", Real, "m", "total descent in the opposite direction; null if a height is unknown", edge.metres(|grades| grades.ascent_m);
    "weighted_grade_pct", Real, "%", "mean grade without sign, weighted by length; null if a height is unknown", edge.weighted_pct().map(real);
    "steepest_pct", Real, "%", "steepest grade, up or down, over 50 m or more; null if the edge is shorter or a height is unknown",
        edge.grades.and_then(|grades| grades.steepest).map(|grade| real(100.0 * grade));
    "from_height_m", Real, "m", "height of the smooth line at `from_node`: the same for all edges that meet there, except that a way that only touches a deck keeps its own height",
        edge.heights_m[0].map(real);
    "to_height_m", Real, "m", "height of the smooth line at `to_node`", edge.heights_m[1].map(real);
    "bridge_share", Real, "", "share of its length on bridges, 0 to 1", real(edge.shares.share(edge.shares.bridge_m));
    "tunnel_share", Real, "", "share of its length in tunnels, 0 to 1", real(edge.shares.share(edge.shares.tunnel_m));
}

/// The fields of edges, in their order.
#[must_use]
pub fn edge_fields() -> Vec<FeatureField> {
    fields_of(FIELDS)
}

/// Writes the edges of a network to a new file at `path`. Each edge is written once, starting at
/// the OSM node with the smaller id. Lines are on the elevation files and decks; ascents and grades
/// are measured on smoothed lines. After an error the file at `path` is incomplete.
///
/// # Errors
/// When the request cannot be met, an elevation file cannot be read, or something cannot be
/// written.
pub fn export_edges(
    package: &FilePackage,
    (request, road): (&FeatureRequest<FunctionalRoadClass>, Option<&RoadQuery>),
    (elevation, network): (Elevation<'_>, &Network),
    path: &Path,
    observer: &dyn Observer,
) -> Result<EdgesSummary, FeaturesError> {
    let source = FeatureSource::new(package, request)?;
    let meant = meant_ways(package, source.level, road, observer)?;
    let frame = &package.manifest().frame;
    // Edges that reach the package's data are exported whole.
    let plan = elevation.plan.of_whole_data();
    let elevation = Elevation { plan: &plan, ..elevation };
    let mut nodes = DemNodes::new(elevation, frame);
    let places = &source.places;
    let measured = MeasuredChains::measure(network, places, elevation, observer)?;
    let called = ("edges", StyledClasses::Roads);
    let what = "Roads from junction to junction";
    let layer = source.layer(called, ShapeKind::Lines, edge_fields(), what);
    let mut file = VectorFile::create(path, request.format, layer)?;
    let mut summary = EdgesSummary {
        heights: places.heights.clone(),
        spans: measured.decks.facts.clone(),
        ..EdgesSummary::default()
    };
    let edges = Chains::from_network(network, Breaks::Junctions);
    let mut numbers: Vec<ChainNumber> = edges.numbers().collect();
    if let Some(meant) = meant {
        let is_meant = |link: &Link| meant.contains(&network.way_of(*link).way_id);
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
            let (lines, decks) = laid(&measured, &mut nodes, &chain)?;
            if lines.is_empty() {
                summary.without_ground += 1;
                continue;
            }
            let profile = measured.profile(chain.links, &decks);
            let nodes_m = node_heights(&measured, &chain);
            let ends = profile.as_ref().map(|profile| [profile.first(), profile.last()]);
            let own_m = ends.unwrap_or_default().map(|end| end.map(|&[_, height_m]| height_m));
            let edge = Edge {
                ends: chain.ends.map(|node| network.node_id(node)),
                ways: ways_text(network, &chain),
                shares: Shares::from_chain(&measured, &chain),
                grades: profile.as_deref().map(grades_of),
                heights_m: [0, 1].map(|end| nodes_m[end].or(own_m[end])),
            };
            summary.edges += 1;
            summary.length_m += edge.shares.length_m;
            summary.without_ascent += u64::from(edge.grades.is_none());
            let object = OsmObject::Way(network.way_of(chain.links[0]).way_id);
            let mut carried = Vec::new();
            for line in lines {
                summary.height_tolerance_m =
                    summary.height_tolerance_m.max(line.tolerance_m.unwrap_or(0.0));
                carried.extend(places.carry(object, &line.vertices)?);
            }
            let values = FIELDS.iter().map(|(_, value)| value(&edge)).collect();
            file.push(FeatureRecord { values, shape: FeatureGeometry::Lines(carried) })?;
        }
        observer.advance(Stage::ExportFeatures, some.len() as u64);
    }
    file.tell_heights(dem_heights(summary.height_tolerance_m, true));
    file.finish()?;
    observer.end(Stage::ExportFeatures);
    Ok(summary)
}

/// Distances and heights along the lines of an edge's bridges and tunnels, by link number; lines
/// with a gap are missing.
type DeckProfiles = HashMap<usize, Vec<[f64; 2]>>;

/// Returns an edge on the elevation files, and on the decks of its bridges and tunnels.
fn laid(
    measured: &MeasuredChains<'_>,
    nodes: &mut DemNodes<'_>,
    chain: &Chain<'_>,
) -> Result<(Vec<DemLine>, DeckProfiles), ElevationError> {
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
    Ok((lines, decks))
}

/// Returns the grades of an edge. The descent of a level edge is −0, as it has always been in
/// files.
fn grades_of(profile: &[[f64; 2]]) -> ProfileGrades {
    let falls = profile.array_windows().map(|[from, to]| (-(to[1] - from[1])).max(0.0));
    ProfileGrades {
        descent_m: falls.sum(),
        ..ProfileGrades::from_profiles([profile], GRADE_LENGTH_M)
    }
}

/// Returns the heights at both ends that other edges share; none on a bridge or in a tunnel, where
/// the edge has its own height.
fn node_heights(measured: &MeasuredChains<'_>, chain: &Chain<'_>) -> [Option<f64>; 2] {
    let is_on_ground =
        |link: &&Link| measured.network.way_of(**link).structure == Structure::Ground;
    let links = [chain.links.first(), chain.links.last()].map(|link| link.filter(is_on_ground));
    [0, 1].map(|end| links[end].and_then(|_| measured.node_m(chain.ends[end])))
}

impl Edge<'_> {
    fn metres(&self, of: fn(&ProfileGrades) -> f64) -> Option<f64> {
        self.grades.as_ref().map(of).map(real)
    }

    fn weighted_pct(&self) -> Option<f64> {
        let grades = self.grades?;
        let length_m = self.shares.length_m;
        (length_m > 0.0).then(|| 100.0 * (grades.ascent_m + grades.descent_m) / length_m)
    }
}

/// Returns the ways of an edge with their directions; repetitions in a row are written once.
fn ways_text(network: &Network, chain: &Chain<'_>) -> String {
    let mut ways: Vec<(i64, bool)> =
        chain.links.iter().map(|link| (network.way_of(*link).way_id, link.is_against)).collect();
    ways.dedup();
    let text = |(way_id, is_against)| format!("{way_id}{}", if is_against { 'b' } else { 'f' });
    ways.into_iter().map(text).collect::<Vec<String>>().join(" ")
}

impl<'a> Shares<'a> {
    fn from_chain(measured: &MeasuredChains<'a>, chain: &Chain<'_>) -> Self {
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

    /// Returns the class and tag with the largest share; of equal shares, the more important class.
    fn largest(&self) -> (Option<FunctionalRoadClass>, &'a str) {
        // Of equal maxima, `max_by` returns the last.
        let kinds = self.kinds.iter().rev().max_by(|(_, one), (_, other)| one.total_cmp(other));
        kinds.map_or((None, ""), |(&(class, highway), _)| (Some(class), highway))
    }

    fn oneway(&self) -> &'static str {
        match self.oneways[..] {
            [first, ref others @ ..] if others.iter().all(|other| *other == first) => oneway(first),
            _ => "mixed",
        }
    }
}
