//! The export of a package's roads, from tiles to file.

use std::{
    collections::{BTreeMap, BTreeSet},
    path::Path,
};

use corniche_geom::TileId;
use corniche_layers::OsmObject;
use corniche_network::Network;
use corniche_roads::{FunctionalRoadClass, Structure, grade_limit};
use corniche_tileset::{FilePackage, tile_of_order};
use corniche_work::Observer;

use crate::{
    cut::cut_at_bounds,
    deck_lines::{Carrier, lay_on_deck},
    dem_ground::{DemLine, DemNodes, off_dem_m},
    error::{CoordinatesError, ElevationError, FeaturesError, SelectionError},
    feature::{FeatureRoad, HeightSource, Smooth, road_fields, road_values},
    features::{FeatureRequest, FeatureSource, Features, RoadFeatures, write_features},
    grades::{MeasuredChains, SmoothLine, Smoothing, grades_of, most_steps, stretch_of_way},
    heights::{Elevation, dem_heights, height_bound, sample_bound_m},
    join::{JoinedLine, lines},
    measures::{Measures, Profiled},
    piece::{PieceHeights, WayPiece, larger},
    places::Places,
    read,
    road_query::{RoadQuery, meant_ways},
    span_facts::{SpanFacts, least_free_heights},
    vector::{FeatureGeometry, FeatureRecord, Layer, ShapeKind, StyledClasses},
};

/// The figures of an export of roads.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ExportSummary {
    /// The level whose roads were exported.
    pub level: u8,
    /// Features written.
    pub features: u64,
    /// Ways with at least one feature.
    pub ways: u64,
    /// True length in plan, metres.
    pub length_2d_m: f64,
    /// Vertices of all lines on the ground.
    pub vertices: u64,
    /// What the heights of the features refer to, in words.
    pub heights: String,
    /// The largest distance of lines from the elevation files, over their whole length, metres;
    /// bridges and tunnels off the ground excluded. `None` if it is unknown.
    pub height_tolerance_m: Option<f64>,
    /// The largest distance of the package's triangles from the elevation files' samples, metres.
    pub sample_tolerance_m: f64,
    /// The largest distance of the package's triangles from the elevation files along the lines,
    /// metres; `None` if they were not compared.
    pub ground_tolerance_m: Option<f64>,
    /// The bridges and tunnels of the network, if there is one.
    pub spans: Option<SpanFacts>,
}

/// The source of the heights of roads.
#[derive(Debug, Clone, Copy, Default)]
pub struct RoadHeights<'a> {
    /// The elevation files. Without them, heights are those of the package's triangles.
    pub elevation: Option<Elevation<'a>>,
    /// The roads of the package's extract. With them and the elevation files, grades are those of
    /// chains from junction to junction.
    pub network: Option<&'a Network>,
}

/// Writes the roads of a package to a new file at `path`. While it writes, the same folder also
/// contains unnamed temporary files for sorting, and temporary files of GDAL. After an error the
/// file at `path` is incomplete.
///
/// # Errors
/// When the package has no roads or no such level, the request cannot be met, the package is
/// corrupt, or something cannot be written.
pub fn export_roads(
    package: &FilePackage,
    request: &FeatureRequest<FunctionalRoadClass>,
    features: RoadFeatures,
    road: Option<&RoadQuery>,
    heights: RoadHeights<'_>,
    path: &Path,
    observer: &dyn Observer,
) -> Result<ExportSummary, FeaturesError> {
    let manifest = package.manifest();
    SelectionError::check_roads(package)?;
    let source = FeatureSource::new(package, request)?;
    let meant = meant_ways(package, source.level, road, observer)?;
    let measure = |elevation| -> Result<OnDem<'_>, ElevationError> {
        let measure =
            |network| MeasuredChains::measure(network, &source.places, elevation, observer);
        let chains = heights.network.map(measure).transpose()?;
        let decks = chains.as_ref().map(|chains| &chains.decks.decks);
        Ok(OnDem {
            nodes: DemNodes::new(elevation, &manifest.frame),
            free_heights_m: decks.map(least_free_heights).unwrap_or_default(),
            chains,
            most_steps: most_steps(manifest, source.level),
            deck: None,
        })
    };
    let dem = heights.elevation.map(measure).transpose()?;
    let chains = dem.as_ref().and_then(|dem| dem.chains.as_ref());
    let spans = chains.map(|chains| chains.decks.facts.clone());
    let mut roads = Roads {
        classes: &request.classes,
        by_piece: features == RoadFeatures::Pieces,
        meant,
        dem,
        summary: ExportSummary {
            level: source.level,
            heights: source.places.heights.clone(),
            sample_tolerance_m: sample_bound_m(manifest, source.level),
            spans,
            ..ExportSummary::default()
        },
    };
    write_features(&mut roads, &source, path, observer)?;
    Ok(roads.summary)
}

/// An export of roads in progress.
struct Roads<'a> {
    classes: &'a [FunctionalRoadClass],
    by_piece: bool,
    /// The ways to export, if the user named roads.
    meant: Option<BTreeSet<i64>>,
    dem: Option<OnDem<'a>>,
    summary: ExportSummary,
}

/// The inputs of heights and grades from the elevation files.
struct OnDem<'a> {
    nodes: DemNodes<'a>,
    chains: Option<MeasuredChains<'a>>,
    /// The largest distance of lines from their ways, lattice steps.
    most_steps: f64,
    /// The least clearance between each bridge or tunnel and the roads that it crosses, by way.
    free_heights_m: BTreeMap<i64, f64>,
    /// The decks of the last requested way: pieces of a way often follow each other.
    deck: Option<(i64, Vec<SmoothLine>)>,
}

impl Features for Roads<'_> {
    type TilePiece = WayPiece;
    fn layer(&self, source: &FeatureSource<'_>) -> Layer {
        let what = if self.by_piece { "Pieces of roads" } else { "Roads" };
        let cells = source.cells();
        let (from, laid) = match self.dem {
            None => (HeightSource::Ground, format!("laid on terrain with {cells}")),
            Some(_) => (HeightSource::Dem, "laid on the elevation files".to_owned()),
        };
        let fields = road_fields(self.by_piece, from);
        let named = ("roads", StyledClasses::Roads);
        source.layer(named, ShapeKind::Lines, fields, &format!("{what} {laid}"))
    }

    fn heights_told(&self, source: &FeatureSource<'_>) -> Option<String> {
        if self.dem.is_none() {
            height_bound(source.package.manifest(), source.level)
        } else {
            let tolerance_m = self.summary.height_tolerance_m.unwrap_or_default();
            Some(dem_heights(tolerance_m, self.summary.spans.is_some()))
        }
    }

    fn pieces(
        &mut self,
        FeatureSource { package, bounds, places, .. }: &FeatureSource<'_>,
        tile: TileId,
    ) -> Result<Vec<WayPiece>, FeaturesError> {
        let mut found = Vec::new();
        // With elevation files, the distances are measured.
        for piece in read::pieces(package, tile, self.classes, self.dem.is_none())? {
            if self.meant.as_ref().is_some_and(|meant| !meant.contains(&piece.key.way_id)) {
                continue;
            }
            let cut = cut_at_bounds(piece, *bounds, &|at| places.wgs84(at));
            match &mut self.dem {
                None => found.extend(cut),
                Some(dem) => found.extend(dem.laid(cut, places)?),
            }
        }
        Ok(found)
    }

    fn object(piece: &WayPiece) -> OsmObject {
        OsmObject::Way(piece.key.way_id)
    }

    fn records(
        &mut self,
        source: &FeatureSource<'_>,
        pieces: &[WayPiece],
    ) -> Result<Vec<FeatureRecord>, FeaturesError> {
        let first = &pieces[0];
        let is_same =
            |piece: &WayPiece| piece.class == first.class && piece.attributes == first.attributes;
        if !pieces.iter().all(is_same) {
            return Err(FeaturesError::Differs { object: Self::object(first) });
        }
        self.summary.ways += 1;
        let chains = self.dem.as_ref().and_then(|dem| dem.chains.as_ref());
        let way = chains.map(|chains| chains.of_way(first.key.way_id)).unwrap_or_default();
        if !self.by_piece {
            let heights = pieces.iter().map(|piece| piece.heights).reduce(PieceHeights::with);
            let of = WayPiece { heights: heights.unwrap_or(first.heights), ..first.clone() };
            return Ok(vec![self.record(&source.places, &of, &lines(pieces), &way)?]);
        }
        let of_piece = |piece: &WayPiece| {
            let line = JoinedLine { vertices: piece.vertices.clone(), joins: Vec::new() };
            Ok(self.record(&source.places, piece, &[line], &way)?)
        };
        pieces.iter().map(of_piece).collect()
    }
}

impl OnDem<'_> {
    /// Returns the remaining parts of a piece, on the ground of the elevation files.
    fn laid(
        &mut self,
        cut: Vec<WayPiece>,
        places: &Places<'_>,
    ) -> Result<Vec<WayPiece>, ElevationError> {
        let Self { nodes, chains, most_steps, deck, .. } = self;
        let mut laid = Vec::new();
        for piece in cut {
            let ground_m = off_dem_m(nodes, &piece.vertices)?;
            let (way_id, structure) = (piece.key.way_id, piece.attributes.structure);
            if let Some(chains) = chains
                && structure != Structure::Ground
                && deck.as_ref().is_none_or(|(known, _)| *known != way_id)
            {
                *deck = Some((way_id, chains.of_way(way_id)));
            }
            let way = deck.as_ref().map_or(&[][..], |(_, way)| way);
            let carrier = Carrier { structure, way, most_steps: *most_steps, is_turned: false };
            for DemLine { vertices, tolerance_m, has_end, on_deck } in
                lay_on_deck(nodes, &piece.vertices, &carrier, &places.metric())?
            {
                let heights = PieceHeights { tolerance_m, ground_m, on_deck, has_deck: on_deck };
                let part = piece.part(laid.len() as u32, vertices, has_end);
                laid.push(WayPiece { heights, ..part });
            }
        }
        Ok(laid)
    }

    /// Returns the grades of lines of a way; `way` contains its smooth lines, if they are known.
    fn smooth(&self, of: &WayPiece, lines: &[Profiled<'_>], way: &[SmoothLine]) -> Smooth {
        let unknown = Smooth {
            grades: None,
            most_off_m: 0.0,
            is_of_chain: false,
            limit_pct: grade_limit(&of.attributes.highway),
            free_height_m: self.free_heights_m.get(&of.key.way_id).copied(),
        };
        if of.attributes.structure != Structure::Ground && !of.heights.on_deck {
            return unknown;
        }
        let mut parts = Vec::new();
        let mut most_off_m = 0.0_f64;
        let mut is_of_chain = !way.is_empty();
        let smoothing = Smoothing::of_frame(&self.nodes.frame);
        for Profiled { line, profile } in lines {
            let length_m = profile.last().map_or(0.0, |last| last[0]);
            let found = stretch_of_way(way, &line.vertices, length_m, self.most_steps);
            is_of_chain &= found.is_some();
            // A deck is smooth by itself, and on the ground where the ground obstructs it.
            if of.heights.on_deck {
                parts.push(SmoothLine::itself(profile));
                continue;
            }
            let Some([from_m, to_m]) = found else {
                let own = SmoothLine::of_profile(profile, smoothing);
                most_off_m = most_off_m.max(own.most_off_m(profile));
                parts.push(own);
                continue;
            };
            // Simplified lines are shorter than their ways.
            let on_way = |&[at_m, height_m]: &[f64; 2]| {
                [from_m + at_m * (to_m - from_m) / length_m, height_m]
            };
            let profile: Vec<[f64; 2]> = profile.iter().map(on_way).collect();
            for own in way.iter().map(|line| line.part([from_m, to_m])) {
                most_off_m = most_off_m.max(own.most_off_m(&profile));
                parts.push(own);
            }
        }
        Smooth { grades: Some(grades_of(&parts)), most_off_m, is_of_chain, ..unknown }
    }
}

impl Roads<'_> {
    fn record(
        &mut self,
        places: &Places<'_>,
        of: &WayPiece,
        lines: &[JoinedLine],
        way: &[SmoothLine],
    ) -> Result<FeatureRecord, CoordinatesError> {
        let WayPiece { key, heights, .. } = of;
        let profiled = Profiled::from_lines(lines, &places.metric());
        let measures = Measures::from_lines(&profiled);
        let summary = &mut self.summary;
        summary.features += 1;
        summary.length_2d_m += measures.length_2d_m;
        summary.vertices += measures.vertices_out;
        summary.height_tolerance_m = larger(summary.height_tolerance_m, heights.tolerance_m);
        summary.ground_tolerance_m = larger(summary.ground_tolerance_m, heights.ground_m);
        let piece = tile_of_order(key.tile).filter(|_| self.by_piece).map(|tile| (tile, key.part));
        let road = FeatureRoad {
            of,
            parts: lines.len(),
            measures,
            smooth: self.dem.as_ref().map(|dem| dem.smooth(of, &profiled, way)),
            piece,
        };
        let mut carried = Vec::with_capacity(lines.len());
        for line in lines {
            carried.extend(places.carry(Self::object(of), &line.vertices)?);
        }
        Ok(FeatureRecord { values: road_values(&road), shape: FeatureGeometry::Lines(carried) })
    }
}
