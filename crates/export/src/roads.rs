//! The whole way of roads out of a package.

use std::{
    collections::{BTreeMap, BTreeSet},
    path::Path,
};

use corniche_areas::AreaObject;
use corniche_geom::TileId;
use corniche_network::Network;
use corniche_roads::{FunctionalRoadClass, Structure, grade_limit};
use corniche_tileset::{FilePackage, tile_of_order};
use corniche_work::Observer;

use crate::{
    cut::cut_at_bounds,
    deck_lines::{Carrier, lay_on_deck},
    dem_ground::{DemLine, DemNodes, off_dem_m},
    error::{CoordinatesError, ElevationError, FeaturesError, SelectionError},
    feature::{HeightSource, Road, Smooth, road_fields, road_values},
    features::{About, FeatureRequest, FeatureSource, Features, RoadFeatures, write_features},
    grades::{MeasuredChains, SmoothLine, Smoothing, grades_of, most_steps, stretch_of_way},
    heights::{Elevation, dem_heights, height_bound, sample_bound_m},
    join::{Line, lines},
    measures::{Measures, Profiled},
    piece::{Piece, PieceHeights, PieceKey, larger},
    places::Places,
    read,
    road_query::{RoadQuery, named_ways},
    span_facts::{SpanFacts, least_free_heights},
    vector::{Record, Shape, ShapeKind},
};

/// What was exported.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportSummary {
    /// The level whose roads were taken.
    pub level: u8,
    /// Features written.
    pub features: u64,
    /// Ways of which there is something.
    pub ways: u64,
    /// True length in plan, metres.
    pub length_2d_m: f64,
    /// Vertices of all lines on the ground.
    pub vertices: u64,
    /// What the heights of the features are, in words.
    pub heights: String,
    /// How far lines are from the elevation files at most, over their whole length, metres; without bridges and tunnels off the ground. `None` where
    /// that is not known.
    pub height_tolerance_m: Option<f64>,
    /// How far the package's triangles are from the elevation files' samples at most, metres.
    pub sample_tolerance_m: f64,
    /// How far the package's triangles are from the elevation files along the lines at most, metres; `None` where they were not compared.
    pub ground_tolerance_m: Option<f64>,
    /// The bridges and tunnels of the network, where there is one.
    pub spans: Option<SpanFacts>,
}

/// Where heights of roads are taken from.
#[derive(Debug, Clone, Copy, Default)]
pub struct RoadHeights<'a> {
    /// The elevation files; without them heights are those of the package's triangles.
    pub elevation: Option<Elevation<'a>>,
    /// The roads of the package's extract: with them, and the elevation files, grades are those of chains from junction to junction.
    pub network: Option<&'a Network>,
}

/// Writes the roads of a package to a new file at `path`. Beside it, in the same folder, are unnamed files for sorting, and
/// what GDAL needs while it writes. After an error the file at `path` is of no use.
///
/// # Errors
/// When the package has no roads or no such level, the request cannot be met, the package is damaged, or something cannot be
/// written.
pub fn export_roads(
    package: &FilePackage,
    (request, features, road): (
        &FeatureRequest<FunctionalRoadClass>,
        RoadFeatures,
        Option<&RoadQuery>,
    ),
    heights: RoadHeights<'_>,
    path: &Path,
    observer: &dyn Observer,
) -> Result<ExportSummary, FeaturesError> {
    let manifest = package.manifest();
    SelectionError::check_roads(package)?;
    let source = FeatureSource::new(package, request)?;
    let named = road.map(|road| named_ways(package, source.level, Some(road), observer));
    let meant = named.transpose()?.map(|named| named.meant);
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
        by_piece: features == RoadFeatures::Pieces,
        meant,
        dem,
        summary: ExportSummary {
            level: source.level,
            features: 0,
            ways: 0,
            length_2d_m: 0.0,
            vertices: 0,
            heights: source.places.heights.clone(),
            height_tolerance_m: None,
            sample_tolerance_m: sample_bound_m(manifest, source.level),
            ground_tolerance_m: None,
            spans,
        },
    };
    write_features(&mut roads, &source, path, observer)?;
    Ok(roads.summary)
}

/// Roads on their way into a file.
struct Roads<'a> {
    by_piece: bool,
    /// The ways that are taken, if roads are named.
    meant: Option<BTreeSet<i64>>,
    dem: Option<OnDem<'a>>,
    summary: ExportSummary,
}

/// What heights and grades of the elevation files are made from.
struct OnDem<'a> {
    nodes: DemNodes<'a>,
    chains: Option<MeasuredChains<'a>>,
    /// How far lines may be beside their ways, lattice steps.
    most_steps: f64,
    /// The least height between each bridge or tunnel and what it crosses, by way.
    free_heights_m: BTreeMap<i64, f64>,
    /// The decks of the way that was asked for last: pieces of a way often come one after the other.
    deck: Option<(i64, Vec<SmoothLine>)>,
}

impl Features for Roads<'_> {
    type Class = FunctionalRoadClass;
    type Piece = Piece;
    const SHAPES: ShapeKind = ShapeKind::Lines;

    fn name(&self) -> &'static str {
        "roads"
    }

    fn about(&self, source: &FeatureSource<'_, FunctionalRoadClass>) -> About {
        let what = if self.by_piece { "Pieces of roads" } else { "Roads" };
        let (cells, heights) = (source.cells(), &source.places.heights);
        let from = if self.dem.is_some() { HeightSource::Dem } else { HeightSource::Ground };
        let laid = match from {
            HeightSource::Ground => format!("laid on terrain with {cells}"),
            HeightSource::Dem => "laid on the elevation files".to_owned(),
        };
        About {
            fields: road_fields(self.by_piece, from),
            description: format!("{what} {laid}. Heights: {heights}."),
            metadata: vec![
                ("HEIGHTS", heights.clone()),
                ("VERTICAL_DATUM_OF_PACKAGE", source.package.manifest().vertical.datum.clone()),
            ],
        }
    }

    fn heights_told(&self, source: &FeatureSource<'_, FunctionalRoadClass>) -> Option<String> {
        if self.dem.is_none() {
            height_bound(source.package.manifest(), source.level)
        } else {
            let tolerance_m = self.summary.height_tolerance_m.unwrap_or_default();
            Some(dem_heights(tolerance_m, self.summary.spans.is_some()))
        }
    }

    fn pieces(
        &mut self,
        FeatureSource { package, request, places, .. }: &FeatureSource<'_, FunctionalRoadClass>,
        tile: TileId,
    ) -> Result<Vec<Piece>, FeaturesError> {
        let mut found = Vec::new();
        let is_meant = |piece: &Piece| {
            self.meant.as_ref().is_none_or(|meant| meant.contains(&piece.key.way_id))
        };
        // Elevation files tell distances themselves.
        let read = if self.dem.is_some() { read::pieces } else { read::bounded_pieces };
        let mut pieces = read(package, tile, &request.classes)?;
        pieces.retain(is_meant);
        for piece in pieces {
            let cut = match &request.bounds {
                None => vec![piece],
                Some(bounds) => cut_at_bounds(&piece, bounds, &|at| places.wgs84(at)),
            };
            match &mut self.dem {
                None => found.extend(cut),
                Some(dem) => found.extend(dem.laid(cut, places)?),
            }
        }
        Ok(found)
    }

    fn object(piece: &Piece) -> AreaObject {
        AreaObject::Way(piece.key.way_id)
    }

    fn records(
        &mut self,
        source: &FeatureSource<'_, FunctionalRoadClass>,
        pieces: &[Piece],
    ) -> Result<Vec<Record>, FeaturesError> {
        let Some(first) = pieces.first() else { return Ok(Vec::new()) };
        let is_same =
            |piece: &Piece| piece.class == first.class && piece.attributes == first.attributes;
        if !pieces.iter().all(is_same) {
            return Err(FeaturesError::Differs { object: Self::object(first) });
        }
        self.summary.ways += 1;
        let chains = self.dem.as_ref().and_then(|dem| dem.chains.as_ref());
        let way = chains.map(|chains| chains.of_way(first.key.way_id)).unwrap_or_default();
        if !self.by_piece {
            let heights = pieces.iter().map(|piece| piece.heights).reduce(PieceHeights::with);
            let of = Piece { heights: heights.unwrap_or(first.heights), ..first.clone() };
            return Ok(vec![self.record(&source.places, &of, &lines(pieces), &way)?]);
        }
        let of_piece = |piece: &Piece| {
            let line = Line { vertices: piece.vertices.clone(), joins: Vec::new() };
            Ok(self.record(&source.places, piece, &[line], &way)?)
        };
        pieces.iter().map(of_piece).collect()
    }
}

impl OnDem<'_> {
    /// What is left of a piece, on the ground of the elevation files.
    fn laid(&mut self, cut: Vec<Piece>, places: &Places<'_>) -> Result<Vec<Piece>, ElevationError> {
        let Self { nodes, chains, most_steps, deck, .. } = self;
        let mut laid = Vec::new();
        for piece in cut {
            let ground_m = off_dem_m(nodes, &piece.vertices)?;
            let [first_end, last_end] = piece.goes_on;
            let (way_id, structure) = (piece.key.way_id, piece.attributes.structure);
            if let Some(chains) = chains
                && structure != Structure::Ground
                && deck.as_ref().is_none_or(|(known, _)| *known != way_id)
            {
                *deck = Some((way_id, chains.of_way(way_id)));
            }
            let way = deck.as_ref().map_or(&[][..], |(_, way)| way);
            let carrier = Carrier { structure, way, most_steps: *most_steps, is_turned: false };
            for DemLine { vertices, tolerance_m, has_end: [first, last], on_deck } in
                lay_on_deck(nodes, &piece.vertices, &carrier, &places.metric())?
            {
                laid.push(Piece {
                    key: PieceKey { cut: laid.len() as u32, ..piece.key },
                    vertices,
                    goes_on: [first && first_end, last && last_end],
                    heights: PieceHeights { tolerance_m, ground_m, on_deck, has_deck: on_deck },
                    ..piece.clone()
                });
            }
        }
        Ok(laid)
    }

    /// The grades of lines of a way, of which `way` are the smooth lines where these are known.
    fn smooth(&self, of: &Piece, lines: &[Profiled<'_>], way: &[SmoothLine]) -> Smooth {
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
            // A deck is smooth by itself, and on the ground where that is in its way.
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
            // Lines that are simplified are shorter than their ways.
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
        of: &Piece,
        lines: &[Line],
        way: &[SmoothLine],
    ) -> Result<Record, CoordinatesError> {
        let Piece { key, class, attributes, heights, .. } = of;
        let distance_m = places.metric();
        let profiled: Vec<Profiled<'_>> =
            lines.iter().map(|line| Profiled::of(line, &distance_m)).collect();
        let measures = Measures::of(&profiled);
        let summary = &mut self.summary;
        summary.features += 1;
        summary.length_2d_m += measures.length_2d_m;
        summary.vertices += measures.vertices_out;
        summary.height_tolerance_m = larger(summary.height_tolerance_m, heights.tolerance_m);
        summary.ground_tolerance_m = larger(summary.ground_tolerance_m, heights.ground_m);
        let piece = tile_of_order(key.tile).filter(|_| self.by_piece).map(|tile| (tile, key.part));
        let road = Road {
            way_id: key.way_id,
            class: *class,
            attributes,
            parts: lines.len(),
            measures,
            heights: *heights,
            smooth: self.dem.as_ref().map(|dem| dem.smooth(of, &profiled, way)),
            piece,
        };
        let mut carried = Vec::with_capacity(lines.len());
        for line in lines {
            carried.extend(places.carry(Self::object(of), &line.vertices)?);
        }
        Ok(Record { values: road_values(&road), shape: Shape::Lines(carried) })
    }
}
