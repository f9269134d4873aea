//! Computes the heights of all bridges and tunnels, level by level, and their runs by tile.
//!
//! Spans extend over many tiles, and decks of a level need the ground of that level at all their
//! supports, so they are solved when all tiles are complete. Memory holds the network of bridges
//! and tunnels of all tiles, and nothing else.

use std::{
    collections::{BTreeMap, BTreeSet},
    sync::Arc,
};

use corniche_geom::{LatticePoint, TileId};
use corniche_spans::{Decks, SpanKind, SpanProblem, SpanReason};
use corniche_spec::{
    BuildObserver,
    artifacts::{self, ArtifactKind},
};
use corniche_tileset::{
    OuterGround, RunOwner, SpanRun, encode_spans, limits::MAX_SPAN_POINTS, pmtiles_order,
};
use corniche_tin::{Surface, Tin};
use corniche_work::{Stage, workers};

use super::{
    outer_ground::{AskedPlace, OuterGrounds},
    runs::runs_of,
    span_network::{SpanInputs, SpanNetwork},
    totals::SpanTotals,
};
use crate::{
    ExtractError,
    layers::{SectionLayer, tile_section::TileSection},
    roads::ground_lines,
};

/// If the ground is on the wrong side of a bridge or a tunnel by more than this on the finest
/// level, metres, it is reported.
const MOST_WITHIN_M: f64 = 1.0;

/// The inputs and resources for solving.
pub struct SpanSolving<'a> {
    /// The bridges and tunnels to solve.
    pub of: SpanInputs<'a>,
    /// The height step, metres.
    pub quantum_m: f64,
    /// Returns the TIN of a tile; `None` if it has no ground.
    pub tin: &'a TinOfTile<'a>,
    /// The ground where the package has no ground, or not that of whole tiles.
    pub outer: &'a dyn OuterGrounds,
    /// Worker threads.
    pub threads: usize,
    /// Receives progress.
    pub observer: &'a dyn BuildObserver,
}

type TinOfTile<'a> = dyn Fn(TileId) -> Result<Option<Tin>, ExtractError> + Sync + 'a;

impl SpanSolving<'_> {
    /// Solves bridges and tunnels, and stores the sections of all tiles.
    ///
    /// # Errors
    /// See [`ExtractError`].
    pub fn solve(&self) -> Result<SpanTotals, ExtractError> {
        let SpanInputs { store, frame, .. } = self.of;
        let observer = self.observer;
        let network = SpanNetwork::load(&self.of)?;
        let mut by_level: BTreeMap<u8, Vec<TileId>> = BTreeMap::new();
        for item in store.items(ArtifactKind::SpanGround as u8) {
            let id = artifacts::tile_of(ArtifactKind::SpanGround.item(item))?;
            by_level.entry(id.z()).or_default().push(id);
        }
        let all = by_level.values().map(Vec::len).sum::<usize>();
        observer.begin(Stage::Spans, Some(all as u64));
        let finest = frame.max_level();
        let places = network.places();
        let needed: Vec<usize> =
            (0..places.len()).filter(|&index| places[index].span.is_some()).collect();
        let points: Vec<LatticePoint> = needed.iter().map(|&index| places[index].at).collect();
        let own_m = self.grounds_of(finest, &points)?;
        let asked: Vec<AskedPlace> = needed
            .iter()
            .zip(&own_m)
            .map(|(&index, own_m)| AskedPlace {
                at: places[index].at,
                has_own: own_m.is_some(),
                span: places[index].span.unwrap_or_default(),
            })
            .collect();
        let outer_m = self.outer.heights_m(&network, &asked)?;
        let mut grounds_m = vec![None; places.len()];
        for ((&index, &own_m), &outer_m) in needed.iter().zip(&own_m).zip(&outer_m) {
            grounds_m[index] = outer_m.or(own_m);
        }
        let decks = Decks::solve(Arc::clone(&network.spans), &network.crossings, &grounds_m);
        // The joints come first; those with ground in the package use the ground of the level, too.
        let joints = network.spans.joints().len();
        let joints = needed.partition_point(|&index| index < joints);
        let on_level = |level: u8| -> Result<Vec<Option<f64>>, ExtractError> {
            let mut of_level_m = vec![None; network.spans.joints().len()];
            let own_m = self.grounds_of(level, &points[..joints])?;
            for ((&index, own_m), outer_m) in needed.iter().zip(own_m).zip(&outer_m) {
                of_level_m[index] = own_m.or(*outer_m);
            }
            Ok(of_level_m)
        };
        let mut within: BTreeSet<SpanProblem> = BTreeSet::new();
        for (level, tiles) in by_level {
            let of_level;
            let decks = if level == finest {
                &decks
            } else {
                of_level = decks.on(&on_level(level)?);
                &of_level
            };
            workers::advance(
                (observer, Stage::Spans),
                self.threads,
                &tiles,
                || Ok::<(), ExtractError>(()),
                |(), &id| self.put_section((&network, decks), id),
                |_, found| {
                    if level == finest {
                        within.extend(found);
                    }
                    Ok(())
                },
            )?;
        }
        observer.end(Stage::Spans);
        let outer = asked.iter().zip(outer_m);
        let outer = outer.filter_map(|(place, height_m)| {
            Some(OuterGround { at: place.at, height_m: height_m? })
        });
        let is_without = |&&index: &&usize| grounds_m[index].is_none();
        let without_ground = needed.iter().filter(is_without).count() as u64;
        Ok(SpanTotals::from_network(&network, &decks, within, (outer.collect(), without_ground)))
    }

    /// The ground of a level at points of the lattice.
    fn grounds_of(
        &self,
        level: u8,
        points: &[LatticePoint],
    ) -> Result<Vec<Option<f64>>, ExtractError> {
        let mut by_tile: BTreeMap<TileId, Vec<usize>> = BTreeMap::new();
        for (index, &point) in points.iter().enumerate() {
            for id in self.tiles_at(level, point) {
                by_tile.entry(id).or_default().push(index);
            }
        }
        let mut grounds_m = vec![None; points.len()];
        for (id, indices) in by_tile {
            self.observer.check()?;
            let Some(tin) = (self.tin)(id)? else { continue };
            let surface = Surface::of_tile(&tin, self.of.frame, id, self.quantum_m);
            for index in indices {
                let located = surface.locate(points[index]);
                let height_m =
                    located.map(|triangle| surface.height_at_point_m(triangle, points[index]));
                grounds_m[index] = grounds_m[index].or(height_m);
            }
        }
        Ok(grounds_m)
    }

    /// The tiles of a level that contain a point, borders included.
    fn tiles_at(&self, level: u8, point: LatticePoint) -> impl Iterator<Item = TileId> + use<> {
        let frame = *self.of.frame;
        let [column, row] = frame.tile_column_row(level, point);
        let beside = [0, 1].map(|east| [0, 1].map(|south| [column - east, row - south]));
        beside.into_iter().flatten().filter_map(move |[column, row]| {
            let id = TileId::new(level, column.try_into().ok()?, row.try_into().ok()?).ok()?;
            frame.tile_lattice_bounds(id).contains(point).then_some(id)
        })
    }

    /// Stores the runs of a tile. Returns the bridges and tunnels that remain on the ground, and
    /// the ways that have more points than a tile can hold.
    fn put_section(
        &self,
        (network, decks): (&SpanNetwork, &Decks),
        id: TileId,
    ) -> Result<Vec<SpanProblem>, ExtractError> {
        let mut lines = ground_lines::get(self.of.store, id)?;
        lines.sort_by_key(|line| {
            (
                line.of.owner,
                line.of.way_id,
                line.of.line,
                line.vertices.first().map(|first| first.along_um),
            )
        });
        let mut runs: Vec<SpanRun> = Vec::new();
        let mut within = Vec::new();
        for line in &lines {
            let of_line = runs_of(line, (network, decks), self.quantum_m);
            runs.extend(of_line.runs);
            // The package has lines of layers only as chosen, and notes must not depend on that.
            if of_line.within_m > MOST_WITHIN_M && line.of.owner.layer().is_none() {
                let reason = match line.kind() {
                    SpanKind::Bridge => SpanReason::DeckInGround,
                    SpanKind::Tunnel => SpanReason::TunnelAboveGround,
                };
                within.push(SpanProblem::of_way(reason, line.of.way_id));
            }
        }
        let too_long = left_out(&mut runs);
        within.extend(too_long.map(|way_id| SpanProblem::of_way(SpanReason::TooIntricate, way_id)));
        let points = runs.iter().map(|run| run.points.len() as u64).sum();
        let counts = [runs.len() as u64, points];
        let tile = (SectionLayer::Spans, pmtiles_order(id));
        let encode = |id| encode_spans(id, self.of.frame, &runs);
        TileSection::put(tile, self.of.store, counts, encode)?;
        Ok(within)
    }
}

/// Removes the runs of lines of layers and then of roads, those of the ways with the most points
/// first, until readers accept the rest. Returns the removed ways.
fn left_out(runs: &mut Vec<SpanRun>) -> impl Iterator<Item = i64> + use<> {
    let mut of_ways: BTreeMap<(RunOwner, i64), usize> = BTreeMap::new();
    for run in runs.iter() {
        *of_ways.entry((run.owner, run.way_id)).or_default() += run.points.len();
    }
    let mut all: Vec<((RunOwner, i64), usize)> = of_ways.into_iter().collect();
    all.sort_unstable_by_key(|&(of, points)| (of.0.layer().is_some(), points, of));
    let mut points: usize = all.iter().map(|(_, points)| points).sum();
    let mut left_out = BTreeSet::new();
    while points > MAX_SPAN_POINTS
        && let Some((of, own)) = all.pop()
    {
        points -= own;
        left_out.insert(of);
    }
    runs.retain(|run| !left_out.contains(&(run.owner, run.way_id)));
    left_out.into_iter().map(|(_, way_id)| way_id)
}

#[cfg(test)]
#[path = "solving_tests.rs"]
mod tests;
