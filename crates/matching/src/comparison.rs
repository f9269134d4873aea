//! Compares the roads of the finest level with a photo or with the slope of the ground, and
//! measures their offsets.

use std::collections::BTreeMap;

use corniche_geom::TileId;
use corniche_photo::TexelWindow;
use corniche_roads::{FunctionalRoadClass, RoadAttributes};
use corniche_tileset::{FilePackage, Sections};
use corniche_work::{Observer, Stage, workers::one_by_one};
use geo::{Euclidean, Length as _, LineString};

use crate::{
    error::MatchError,
    images::{Images, MOST_TEXELS, MatchTarget, photos_of},
    report::{MatchReport, MatchedRegion, MatchedRoad},
    response::{RoadCrossSection, responses},
    samples::{RoadSample, samples},
    votes::{ShiftSearch, Votes},
};

/// The number of consecutive samples of a road that must agree on whether it is bright or dark.
const RUN: usize = 16;
/// Texels along a side of the blocks whose samples are compared together.
const BLOCK_TEXELS: i64 = 512;

/// The parameters of a comparison.
#[derive(Debug, Clone, PartialEq)]
pub struct MatchRequest {
    /// Classes of roads that are compared.
    pub classes: Vec<FunctionalRoadClass>,
    /// The search radius around roads, metres.
    pub radius_m: f64,
    /// The side of the squares for which offsets are reported, metres.
    pub region_m: f64,
}

/// Measures the offset of the roads of the finest level from the roads visible in `target`.
///
/// For each place on a road and each shift of it, the image is searched for a line: a middle that
/// is darker, or brighter, than both sides. The results along some sixty metres of a road vote for
/// each shift together, and the shift with most votes is the offset. Places next to the edge of the
/// image are skipped.
///
/// # Errors
/// When the package has no roads or cannot be read, a photo cannot be read, or `observer` requests
/// a stop.
pub fn match_roads(
    package: &FilePackage,
    target: &MatchTarget<'_>,
    request: &MatchRequest,
    observer: &dyn Observer,
) -> Result<MatchReport, MatchError> {
    let photos = photos_of(target)?;
    let images = Images::new(package, photos.as_ref());
    let texel_m = images.scale.texel_m.into_iter().reduce(f64::max).unwrap_or_default();
    let search = ShiftSearch::new(request.radius_m, texel_m);
    let mut matching = Matching { images, search, request, texel_m, found: VotesByWay::default() };
    let mut ids = package.tile_ids()?;
    ids.retain(|id| id.z() == package.manifest().frame.max_level());
    one_by_one((observer, Stage::Match), &ids, |&id| matching.tile(package, id))?;
    if matching.found.roads.is_empty() {
        return Err(MatchError::NoRoads);
    }
    Ok(matching.report())
}

struct Matching<'a> {
    images: Images<'a>,
    search: ShiftSearch,
    request: &'a MatchRequest,
    texel_m: f64,
    found: VotesByWay,
}

#[derive(Default)]
struct VotesByWay {
    all: Votes,
    regions: BTreeMap<[i64; 2], Votes>,
    roads: BTreeMap<i64, Road>,
}

struct Road {
    class: FunctionalRoadClass,
    attributes: RoadAttributes,
    lines: Vec<Vec<[f64; 2]>>,
    votes: Votes,
}

/// Consecutive samples on a road in a block.
struct Run {
    way_id: i64,
    profile: RoadCrossSection,
    samples: Vec<RoadSample>,
}

impl Matching<'_> {
    fn tile(&mut self, package: &FilePackage, id: TileId) -> Result<(), MatchError> {
        let wanted = Sections::ROADS_GEO | Sections::ATTRIBUTES;
        let Some(payload) = package.payload(id, wanted)? else { return Ok(()) };
        let Some(terrain) = &payload.terrain else { return Ok(()) };
        let manifest = package.manifest();
        let surface = manifest.surface(id, &terrain.tin);
        let mut blocks: BTreeMap<[i64; 2], Vec<Run>> = BTreeMap::new();
        for road in &payload.roads_geo {
            if !self.request.classes.contains(&road.class) {
                continue;
            }
            let positions = corniche_drape::positions(&road.line, &surface)
                .map_err(|source| MatchError::Line { tile: id, source })?;
            let line: Vec<[f64; 2]> = positions
                .iter()
                .map(|&[u, v, _]| manifest.frame.position_of_fraction_m([u, v]))
                .collect();
            let at = payload.attributes.binary_search_by_key(&road.way_id, |known| known.way_id);
            let attributes = at.ok().map(|at| payload.attributes[at].attributes.clone());
            let attributes = attributes.unwrap_or_default();
            let profile = self.profile(road.class, &attributes);
            for sample in samples(&line) {
                let block = self.images.scale.texel_of(sample.at);
                let block = block.map(|at| (at.floor() as i64).div_euclid(BLOCK_TEXELS));
                let runs = blocks.entry(block).or_default();
                match runs.last_mut() {
                    Some(run) if run.way_id == road.way_id && run.samples.len() < RUN => {
                        run.samples.push(sample);
                    }
                    _ => runs.push(Run { way_id: road.way_id, profile, samples: vec![sample] }),
                }
            }
            let entry = self.found.roads.entry(road.way_id).or_insert_with(|| Road {
                class: road.class,
                attributes,
                lines: Vec::new(),
                votes: Votes::default(),
            });
            entry.lines.push(line);
        }
        if self.images.has(id) {
            for (block, runs) in blocks {
                self.block(id, block, &runs)?;
            }
        }
        Ok(())
    }

    /// Returns the cross-section to search for: with the tagged width, or the usual width of the
    /// class.
    fn profile(&self, class: FunctionalRoadClass, attributes: &RoadAttributes) -> RoadCrossSection {
        const USUAL_M: [f64; FunctionalRoadClass::COUNT] =
            [12.0, 10.0, 9.0, 7.5, 6.5, 5.5, 5.5, 3.5, 2.0];
        let usual_m = USUAL_M.get(usize::from(class.number())).copied().unwrap_or(4.0);
        let width_m = attributes.width_mm.map_or(usual_m, |width| f64::from(width.get()) / 1e3);
        RoadCrossSection::new(width_m, self.texel_m)
    }

    fn block(&mut self, id: TileId, block: [i64; 2], runs: &[Run]) -> Result<(), MatchError> {
        let reach_m = runs.iter().map(|run| run.profile.reach_m()).fold(0.0, f64::max)
            + self.search.reach_m() * std::f64::consts::SQRT_2;
        let margin = self.images.scale.texel_m.map(|texel_m| (reach_m / texel_m).ceil() as i64 + 2);
        let side = |axis: usize| {
            usize::try_from(BLOCK_TEXELS + 2 * margin[axis]).unwrap_or_default().min(MOST_TEXELS)
        };
        let window = TexelWindow {
            u: block[0] * BLOCK_TEXELS - margin[0],
            v: block[1] * BLOCK_TEXELS - margin[1],
            columns: side(0),
            rows: side(1),
        };
        let grey = self.images.window(id, window)?;
        let scale = self.images.scale;
        for run in runs {
            let mut together = vec![0.0; self.search.count()];
            let (mut samples, mut normals) = (0, [0.0; 3]);
            let mut region = None;
            for sample in &run.samples {
                let Some(answers) = responses(&grey, &scale, sample, run.profile, &self.search)
                else {
                    continue;
                };
                for (sum, answer) in together.iter_mut().zip(&answers) {
                    *sum += answer;
                }
                samples += 1;
                let [east, north] = sample.normal;
                for (sum, own) in normals.iter_mut().zip([east * east, east * north, north * north])
                {
                    *sum += own;
                }
                region.get_or_insert_with(|| {
                    sample.at.map(|at| (at / self.request.region_m).floor() as i64)
                });
            }
            let Some(region) = region else { continue };
            self.found.all.add(&together, samples, normals);
            self.found.regions.entry(region).or_default().add(&together, samples, normals);
            if let Some(road) = self.found.roads.get_mut(&run.way_id) {
                road.votes.add(&together, samples, normals);
            }
        }
        Ok(())
    }

    fn report(self) -> MatchReport {
        let Self { search, request, found, .. } = self;
        let length = |line: &Vec<[f64; 2]>| Euclidean.length(&LineString::from(line.clone()));
        let regions = found.regions.iter().map(|(place, votes)| MatchedRegion {
            center_m: place.map(|at| (at as f64 + 0.5) * request.region_m),
            samples: votes.samples,
            offset: votes.offset(&search),
        });
        let roads = found.roads.into_iter().map(|(way_id, road)| {
            let Road { class, attributes, lines, votes } = road;
            let offset = votes.offset(&search);
            let (across, bends) = votes.across();
            MatchedRoad {
                way_id,
                class,
                attributes,
                length_m: lines.iter().map(length).sum(),
                samples: votes.samples,
                offset,
                across_offset: votes.offset_along(across, &search),
                across,
                bends,
                lines,
            }
        });
        let roads: Vec<MatchedRoad> = roads.collect();
        MatchReport {
            all: found.all.offset(&search),
            length_m: roads.iter().map(|road| road.length_m).sum(),
            samples: found.all.samples,
            reach_m: search.reach_m(),
            step_m: search.step_m(),
            regions: regions.collect(),
            roads,
        }
    }
}
