//! Checks the bridges and tunnels of all tiles: their ends, the side of the ground they are on,
//! their height order, and their agreement across tile borders.

use std::{
    collections::BTreeMap,
    sync::{Mutex, PoisonError},
};

use corniche_drape::OwnedBorders;
use corniche_geom::{LatticeBounds, LatticePoint, Polyline, StepBudget, TileId};
use corniche_layers::LinePlacement;
use corniche_pieces::layers::tile_section::SectionOfTile;
use corniche_roads::Structure;
use corniche_spans::{SpanKind, SpanReason};
use corniche_tileset::{
    LayerObject, LayerShape, Manifest, RunOwner, Sections, SpanHeight, SpanPoint, SpanRun,
    TilePayload, payload_sizes,
};
use corniche_tin::Surface;
use corniche_work::{Stage, locked};

use super::{
    checks::{CheckId, Findings},
    decoded_tiles::DecodedTiles,
    each_tile::{OfTile, RecordedSums, VerifyRun, look_at_sections},
    error::Result,
    near_index::NearIndex,
    span_order::{self, OrderedCrossing, RunPiece},
    tile_place::TilePlace,
    triangle_soup::TriangleSoup,
};

/// The tolerance of a bridge below the ground, and of a tunnel above the ground: points are rounded
/// to a lattice of a millimetre.
const SIDE_M: f64 = 0.01;
/// The tolerance of the height order of two crossing spans: their lines are simplified, which moves
/// the crossing.
const LEVEL_M: f64 = 0.05;
/// Two positions on the lattice within this many steps are the same.
const NEAR_STEPS: f64 = 2.0;

/// The limit of work for a tile, in steps: comparing a vertex with a segment of a run is one step.
const MOST_STEPS: u64 = 1 << 28;

/// An end of a way's line on the border of a tile: its level, the road's class or the layer, the
/// way and the position.
type BorderEnd = (u8, RunOwner, i64, LatticePoint);
/// The ends at each position: the height of a run in steps, or `None` on the ground.
type EndsByPlace = BTreeMap<BorderEnd, Vec<(TileId, Option<i64>)>>;

pub(crate) fn verify(run: &VerifyRun<'_>, findings: &mut Findings) -> Result<()> {
    let manifest = run.package.manifest();
    let record = manifest.spans.as_ref();
    let is_wanted = manifest.settings.spans && manifest.has_extract();
    findings.look(CheckId::SpanSums, record.is_some() == is_wanted, || {
        "spans are counted but the settings do not include them, or the other way round".to_owned()
    });
    let levels = record.map_or(&[][..], |record| &record.levels);
    let recorded = [RecordedSums::new("spans", levels)];
    let ends: Mutex<EndsByPlace> = Mutex::default();
    let crossings: Mutex<Vec<(TileId, OrderedCrossing)>> = Mutex::default();
    // The heights of both spans are rounded away from the ground.
    let least_m = LEVEL_M.max(2.0 * manifest.vertical.quantum_m);
    let look_at = |id| look_at(&run.tiles, id, least_m, (&ends, &crossings));
    let how = (Stage::VerifySpans, CheckId::SpanSums);
    look_at_sections(run, how, look_at, &recorded, findings)?;
    let crossings = crossings.into_inner().unwrap_or_else(PoisonError::into_inner);
    look_at_reversed(told(manifest, SpanReason::OrderReversed), crossings, findings);
    let ends = ends.into_inner().unwrap_or_else(PoisonError::into_inner);
    for ((level, _, way_id, at), of_tiles) in ends {
        let [(first, height), others @ ..] = &of_tiles[..] else { continue };
        let agree = others.iter().all(|(_, other)| other == height);
        look!(
            findings,
            SpanSeams,
            agree,
            "way {way_id} at {at:?} of level {level}: height {height:?} (in steps) in tile {first}, {others:?} in its neighbours"
        );
    }
    Ok(())
}

/// The crossings that contradict the order of layers: only these are returned. The others are
/// counted.
fn reversed(
    all: Vec<OrderedCrossing>,
    least_m: f64,
    findings: &mut Findings,
) -> Vec<OrderedCrossing> {
    let (reversed, ordered): (Vec<_>, Vec<_>) =
        all.into_iter().partition(|crossing| crossing.free_m < -least_m);
    for _ in ordered {
        findings.look(CheckId::SpanOrder, true, String::new);
    }
    reversed
}

/// Checks that as many crossings contradict the order of their layers as the manifest records.
fn look_at_reversed(
    told: u64,
    mut crossings: Vec<(TileId, OrderedCrossing)>,
    findings: &mut Findings,
) {
    crossings.sort_by_key(|&(id, crossing)| (id, crossing.way_ids));
    for (number, (id, crossing)) in (1..).zip(crossings) {
        let OrderedCrossing { way_ids: [upper, lower], free_m } = crossing;
        findings.look(CheckId::SpanOrder, number <= told, || {
            let below_m = -free_m;
            format!(
                "in tile {id} way {upper} is {below_m:.3} m below way {lower}, whose layer is lower"
            )
        });
    }
}

/// The number of bridges or tunnels that the manifest lists for this reason.
fn told(manifest: &Manifest, wanted: SpanReason) -> u64 {
    let reasons = manifest.spans.iter().flat_map(|record| &record.counts.reasons);
    reasons.filter(|(reason, _)| reason == wanted.id()).map(|(_, count)| count).sum()
}

/// The data collected from all tiles: ends on borders, and crossings on the finest level that
/// contradict the order of layers.
type Collected<'a> = (&'a Mutex<EndsByPlace>, &'a Mutex<Vec<(TileId, OrderedCrossing)>>);

/// Checks the bridges and tunnels of a tile. The upper one of two crossing spans may be below the
/// other by `least_m`.
fn look_at(
    tiles: &DecodedTiles<'_>,
    id: TileId,
    least_m: f64,
    (ends, crossings): Collected<'_>,
) -> OfTile {
    let mut found = OfTile::default();
    // Unreadable tiles are reported by the check of tiles.
    let Some(bytes) = tiles.package.tile(id).ok().flatten() else { return found };
    let manifest = tiles.package.manifest();
    let quantum_m = manifest.vertical.quantum_m;
    let Ok(runs) = manifest.decode_spans(&bytes, id) else { return found };
    let of_structures = structures(&bytes, id, manifest);
    let of_layers = layer_lines(&bytes, id, manifest);
    if runs.is_empty() && of_structures.is_empty() && of_layers.is_empty() {
        return found;
    }
    let whole = tiles.tile_at(id);
    let alone;
    let payload = if let Some(payload) = whole.payload() {
        payload
    } else {
        // Damage of other sections is reported by the check of tiles.
        let wanted = Sections::TERRAIN.and(Sections::ROADS_GEO);
        let Ok(read) = manifest.decode(&bytes, id, wanted) else { return found };
        alone = read;
        &alone
    };
    let Some(terrain) = &payload.terrain else { return found };
    let surface = manifest.surface(id, &terrain.tin);
    let bounds = manifest.frame.tile_lattice_bounds(id);
    let work = StepBudget::new(MOST_STEPS);
    let lines = lines_of_structures((payload, &of_structures), of_layers, (&surface, &bounds));
    put_ends((id, &bounds), &lines, &runs, ends);
    let place = TilePlace::from_frame(&manifest.frame, id);
    let ground = tiles.ground(id);
    let tile = Tile { id, place, ground: &ground, surface: &surface, quantum_m, work: &work };
    for run in &runs {
        let is_of_structure = |structure: &(Structure, i8)| structure.0 == run.structure;
        let is_of_layer = run.owner.layer().is_some();
        let is_own = is_of_layer || of_structures.get(&run.way_id).is_some_and(is_of_structure);
        let own = lines.get(&(run.owner, run.way_id)).filter(|_| is_own);
        tile.look_at_ends(run, own, &mut found.findings);
        tile.look_at_side(run, own, &mut found.findings);
        if let Err(error) = work.check() {
            look!(
                found.findings,
                SpanSide,
                false,
                "tile {id}: it has more runs over more ground than any writer can have created: {error}"
            );
            break;
        }
    }
    // Lifts are those of the finest level.
    if id.z() == manifest.frame.max_level() {
        match span_order::crossings(&tile.pieces(&runs, &of_structures), &work) {
            Ok(all) => {
                let reversed = reversed(all, least_m, &mut found.findings);
                let reversed = reversed.into_iter().map(|crossing| (id, crossing));
                locked(crossings).extend(reversed);
            }
            Err(error) => look!(
                found.findings,
                SpanOrder,
                false,
                "tile {id}: more of its runs lie over each other than any writer can have created: {error}"
            ),
        }
    }
    let points = runs.iter().map(|run| run.points.len() as u64).sum();
    let bytes = payload_sizes(&bytes, id).map_or(0, |sizes| sizes.spans.stored);
    found.counts.push(SectionOfTile { parts: runs.len() as u64, points, bytes });
    found
}

/// The GEO lines of a bridge or a tunnel: positions in lattice steps, with heights.
struct WayLines {
    /// The first and the last position of each line.
    ends: Vec<[[f64; 2]; 2]>,
    /// The straight pieces of all lines.
    pieces: Vec<[[f64; 3]; 2]>,
    near: NearIndex,
}

impl WayLines {
    fn new(lines: &[Vec<[f64; 3]>]) -> Self {
        let flat = |[u, v, _]: [f64; 3]| [u, v];
        let ends_of = |line: &Vec<[f64; 3]>| Some([flat(*line.first()?), flat(*line.last()?)]);
        let pieces: Vec<[[f64; 3]; 2]> =
            lines.iter().flat_map(|line| line.array_windows().copied()).collect();
        let near = NearIndex::new(pieces.iter().map(|piece| piece.map(flat)));
        Self { ends: lines.iter().filter_map(ends_of).collect(), pieces, near }
    }

    /// The pieces near a box, and perhaps others.
    fn near(
        &self,
        corners: [[f64; 2]; 2],
        work: &StepBudget,
    ) -> impl Iterator<Item = [[f64; 3]; 2]> {
        // Positions along a line have the same tolerance beyond its ends as across the line.
        self.near.near(corners, 2.0 * NEAR_STEPS, work).map(|number| self.pieces[number])
    }
}

/// Lines by class or layer and way.
type Lines = BTreeMap<(RunOwner, i64), WayLines>;

/// The ways of a tile that are bridges or tunnels, with their layers.
fn structures(bytes: &[u8], id: TileId, manifest: &Manifest) -> BTreeMap<i64, (Structure, i8)> {
    let read = manifest.decode(bytes, id, Sections::ATTRIBUTES);
    let records = read.map(|payload| payload.attributes).unwrap_or_default();
    let ways = records
        .into_iter()
        .map(|record| (record.way_id, (record.attributes.structure, record.attributes.layer)));
    ways.filter(|(_, (structure, _))| *structure != Structure::Ground).collect()
}

/// A line of a layer in a tile.
struct LineOfLayer {
    owner: RunOwner,
    way_id: i64,
    line: Polyline,
}

/// The lines of a tile that may be on bridges and in tunnels and are in layers; damage of their
/// sections is reported by the check of tiles.
fn layer_lines(bytes: &[u8], id: TileId, manifest: &Manifest) -> Vec<LineOfLayer> {
    let with_spans =
        manifest.layers().filter(|(_, record)| record.table.placement == LinePlacement::Spans);
    with_spans
        .flat_map(|(slot, _)| {
            let objects = manifest.decode_layer(bytes, id, slot).unwrap_or_default();
            objects.into_iter().map(move |object| (slot, object))
        })
        .filter_map(|(slot, LayerObject { object, shape, .. })| match shape {
            LayerShape::Line(points) => {
                let (owner, way_id) = (RunOwner::Layer(slot), object.id());
                Some(LineOfLayer { owner, way_id, line: Polyline::new(points).ok()? })
            }
            _ => None,
        })
        .collect()
}

/// The lines of bridges and tunnels on the ground of a tile, and all lines of layers that may be
/// some: a layer does not say which are.
fn lines_of_structures(
    (payload, structures): (&TilePayload, &BTreeMap<i64, (Structure, i8)>),
    of_layers: Vec<LineOfLayer>,
    (surface, bounds): (&Surface, &LatticeBounds),
) -> Lines {
    let work = &StepBudget::new(MOST_STEPS);
    let mut lines: BTreeMap<_, Vec<Vec<[f64; 3]>>> = BTreeMap::new();
    let on_structures =
        payload.roads_geo.iter().filter(|road| structures.contains_key(&road.way_id));
    for road in on_structures {
        if let Ok(vertices) = corniche_drape::positions(&road.line, surface) {
            let key = (RunOwner::Road(road.class), road.way_id);
            lines.entry(key).or_default().push(vertices);
        }
    }
    for LineOfLayer { owner, way_id, line } in of_layers {
        for part in corniche_drape::clip(&line, bounds, OwnedBorders::ALL) {
            // More lines over more ground than any writer can have created: runs of the rest end on
            // no line, which is reported.
            let Ok(draped) = corniche_drape::drape_within(&part, surface, work) else { continue };
            let on_ground = draped.lines.iter();
            let on_ground =
                on_ground.filter_map(|line| corniche_drape::positions(line, surface).ok());
            lines.entry((owner, way_id)).or_default().extend(on_ground);
        }
    }
    lines.into_iter().map(|(key, own)| (key, WayLines::new(&own))).collect()
}

/// Adds the ends of lines on the border of a tile, with the heights of runs that end there.
fn put_ends(
    (id, bounds): (TileId, &LatticeBounds),
    lines: &Lines,
    runs: &[SpanRun],
    all: &Mutex<EndsByPlace>,
) {
    let mut own: BTreeMap<BorderEnd, Option<i64>> = BTreeMap::new();
    for (&(owner, way_id), own_lines) in lines {
        for &[u, v] in own_lines.ends.iter().flatten() {
            let at = LatticePoint::new(u.round() as i64, v.round() as i64);
            if bounds.has_on_border(at) {
                own.entry((id.z(), owner, way_id, at)).or_default();
            }
        }
    }
    for run in runs {
        for end in [run.points.first(), run.points.last()].into_iter().flatten() {
            if let (SpanHeight::Steps(steps), true) = (end.height, bounds.has_on_border(end.at)) {
                own.insert((id.z(), run.owner, run.way_id, end.at), Some(steps));
            }
        }
    }
    let mut all = locked(all);
    for (place, height) in own {
        all.entry(place).or_default().push((id, height));
    }
}

/// A tile with its ground.
struct Tile<'a> {
    id: TileId,
    place: TilePlace,
    ground: &'a TriangleSoup,
    surface: &'a Surface,
    quantum_m: f64,
    work: &'a StepBudget,
}

impl Tile<'_> {
    /// Checks that a run ends on the ground of its way, in the triangle that it names, or at an end
    /// of the way's line.
    fn look_at_ends(&self, run: &SpanRun, lines: Option<&WayLines>, findings: &mut Findings) {
        for end in [run.points.first(), run.points.last()].into_iter().flatten() {
            let [u, v] = end.at.in_steps();
            let is_near =
                |[a, b]: [f64; 2]| (a - u).abs() <= NEAR_STEPS && (b - v).abs() <= NEAR_STEPS;
            let holds = match end.height {
                SpanHeight::Ground { triangle } => {
                    let is_on_line = lines.is_some_and(|lines| {
                        let mut near = lines.near([[u, v]; 2], self.work);
                        near.any(|piece| share_of(piece, [u, v]).is_some())
                    });
                    is_on_line && self.holds(triangle, end.at)
                }
                SpanHeight::Steps(_) => lines.is_some_and(|lines| {
                    self.work.add(lines.ends.len());
                    lines.ends.iter().flatten().copied().any(is_near)
                }),
            };
            look!(
                findings,
                SpanEnds,
                holds,
                "a run of way {} in tile {} ends at {:?}",
                run.way_id,
                self.id,
                end.at
            );
        }
    }

    /// Whether a triangle of the tile contains a point. Where two triangles meet, a rounded point
    /// may lie a step outside its own triangle.
    fn holds(&self, triangle: u32, at: LatticePoint) -> bool {
        let is_there = (triangle as usize) < self.surface.triangles().len();
        let around =
            [-1, 0, 1].map(|du| [-1, 0, 1].map(|dv| LatticePoint::new(at.u + du, at.v + dv)));
        is_there && around.into_iter().flatten().any(|at| self.surface.triangle_holds(triangle, at))
    }

    /// The pieces of runs of roads with known heights. Lines of layers do not say which OSM layer
    /// they are on.
    fn pieces(&self, runs: &[SpanRun], ways: &BTreeMap<i64, (Structure, i8)>) -> Vec<RunPiece> {
        let of_run = |run: &SpanRun| {
            let kind = SpanKind::from_structure(run.structure);
            let tagged = ways.get(&run.way_id).map_or(0, |(_, layer)| *layer);
            let last = run.points.len().saturating_sub(2);
            let pairs = run.points.array_windows().enumerate().map(move |(index, [from, to])| {
                let kind = kind?;
                let is_end = [index == 0, index == last];
                let heights_m = [self.height_m(from)?, self.height_m(to)?];
                let (ends, layer) = ([from.at, to.at], tagged);
                Some(RunPiece { way_id: run.way_id, kind, layer, ends, is_end, heights_m })
            });
            pairs.flatten().collect::<Vec<_>>()
        };
        let of_roads = runs.iter().filter(|run| run.owner.layer().is_none());
        of_roads.flat_map(of_run).collect()
    }

    fn height_m(&self, point: &SpanPoint) -> Option<f64> {
        match point.height {
            SpanHeight::Steps(steps) => Some(steps as f64 * self.quantum_m),
            SpanHeight::Ground { .. } => self.ground_m(point.at.in_steps()),
        }
    }

    /// Checks that between its ends a bridge is above the ground and a tunnel below it, wherever
    /// the slope of the ground beneath changes.
    fn look_at_side(&self, run: &SpanRun, lines: Option<&WayLines>, findings: &mut Findings) {
        let away = if run.structure == Structure::Tunnel { -1.0 } else { 1.0 };
        let mut lowest_m = f64::INFINITY;
        for [from, to] in run.points.array_windows() {
            let (Some(from_m), Some(to_m)) = (self.height_m(from), self.height_m(to)) else {
                continue;
            };
            let [a, b] = [from.at.in_steps(), to.at.in_steps()];
            let ends = [[a[0], a[1], from_m], [b[0], b[1], to_m]];
            let is_beside =
                |of: [f64; 2], [u, v]: [f64; 2]| (of[0] - u).hypot(of[1] - v) <= NEAR_STEPS;
            let near = lines.into_iter().flat_map(|lines| lines.near([a, b], self.work));
            let inner = near.flatten().filter_map(|[u, v, ground_m]| {
                // The ends are checked separately: next to a cliff the ground changes within a
                // step.
                let share = share_of(ends, [u, v])
                    .filter(|_| !is_beside(a, [u, v]) && !is_beside(b, [u, v]))?;
                Some(away * (from_m + share * (to_m - from_m) - ground_m))
            });
            lowest_m = inner.fold(lowest_m, f64::min);
            for (point, own_m) in [(a, from_m), (b, to_m)] {
                if let Some(ground_m) = self.ground_m(point) {
                    lowest_m = lowest_m.min(away * (own_m - ground_m));
                }
            }
        }
        look!(
            findings,
            SpanSide,
            lowest_m >= -SIDE_M,
            "a run of way {} in tile {} is {:.3} m on the wrong side of the ground",
            run.way_id,
            self.id,
            -lowest_m
        );
    }

    fn ground_m(&self, at: [f64; 2]) -> Option<f64> {
        self.ground.height_m(self.place.cells(self.place.local_of(at)))
    }
}

/// The position of a point on a straight line in plan, as a fraction of the line; `None` if the
/// point is not on the line.
fn share_of([[au, av, _], [bu, bv, _]]: [[f64; 3]; 2], [u, v]: [f64; 2]) -> Option<f64> {
    let [du, dv] = [bu - au, bv - av];
    let length = du.hypot(dv);
    let along = ((u - au) * du + (v - av) * dv) / length;
    let across = ((u - au) * dv - (v - av) * du) / length;
    let is_on = across.abs() <= NEAR_STEPS && along >= -NEAR_STEPS && along <= length + NEAR_STEPS;
    is_on.then_some((along / length).clamp(0.0, 1.0))
}

#[cfg(test)]
#[path = "spans_tests.rs"]
mod tests;
