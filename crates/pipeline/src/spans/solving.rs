//! The heights of all bridges and tunnels, level by level, and their runs by tile.
//!
//! Spans go through many tiles, and decks of a level need the ground of that level at all their supports, so they are solved when all tiles are
//! there. Of all tiles together the network of bridges and tunnels is in memory, and nothing else.

use std::{
    collections::{BTreeMap, BTreeSet},
    sync::Arc,
};

use corniche_geom::{LatticePoint, TileId};
use corniche_spans::{Decks, SpanKind, SpanProblem, SpanReason};
use corniche_tileset::{SpanRun, SpansSection, encode_spans, pmtiles_order};
use corniche_tin::{Placement, Surface, Tin};

use super::{
    runs::runs_of,
    span_network::{OnRoad, SpanInputs, SpanNetwork},
    totals::SpanTotals,
};
use crate::{
    BuildError, Observer, Stage,
    artifacts::{self, Kind},
    layers::{SectionLayer, tile_section::TileSection},
    roads::ground_lines,
    workers,
};

/// Ends of lines are where they are to within this, micrometres: a few steps of the lattice.
const NEAR_END_UM: u64 = 5_000;

/// Where the ground is on the wrong side of a bridge or a tunnel by more than this on the finest level, it is told, metres.
const MOST_WITHIN_M: f64 = 1.0;

/// What solving needs.
pub(crate) struct SpanSolving<'a> {
    pub(crate) of: SpanInputs<'a>,
    pub(crate) quantum_m: f64,
    /// The TIN of a coarse tile; `None` where it has no ground.
    pub(crate) tin: &'a TinOfTile<'a>,
    pub(crate) threads: usize,
    pub(crate) observer: &'a dyn Observer,
}

type TinOfTile<'a> = dyn Fn(TileId) -> Result<Option<Tin>, BuildError> + Sync + 'a;

impl SpanSolving<'_> {
    /// Solves bridges and tunnels, and keeps the sections of all tiles.
    pub(crate) fn solve(&self) -> Result<SpanTotals, BuildError> {
        let SpanInputs { store, frame, .. } = self.of;
        let observer = self.observer;
        let network = SpanNetwork::load(&self.of)?;
        let mut by_level: BTreeMap<u8, Vec<TileId>> = BTreeMap::new();
        for item in store.items(Kind::SpanGround as u8) {
            let id = artifacts::tile_of(Kind::SpanGround.item(item))?;
            by_level.entry(id.z()).or_default().push(id);
        }
        let all = by_level.values().map(Vec::len).sum::<usize>();
        observer.begin(Stage::Spans, Some(all as u64));
        let finest = frame.max_level();
        let grounds_m = self.finest_grounds(
            &network.places(),
            by_level.get(&finest).map_or(&[][..], Vec::as_slice),
        )?;
        let decks = Decks::solve(Arc::clone(&network.spans), &network.crossings, &grounds_m);
        let joints = network.joints();
        let mut within: BTreeSet<SpanProblem> = BTreeSet::new();
        for (level, tiles) in by_level {
            let of_level;
            let decks = if level == finest {
                &decks
            } else {
                of_level = decks.on(&self.grounds_of(level, &joints)?);
                &of_level
            };
            workers::in_order_unless_cancelled(
                observer,
                self.threads,
                tiles.len(),
                || Ok(()),
                |(), index| self.put_section((&network, decks), tiles[index]),
                |_, found| {
                    if level == finest {
                        within.extend(found);
                    }
                    observer.advance(Stage::Spans, 1);
                    Ok::<(), BuildError>(())
                },
            )?;
        }
        observer.end(Stage::Spans);
        Ok(SpanTotals::of(&decks, within))
    }

    /// The ground of the finest level at places along bridges and tunnels, whose lines there lie in `tiles`.
    fn finest_grounds(
        &self,
        places: &[Option<OnRoad>],
        tiles: &[TileId],
    ) -> Result<Vec<Option<f64>>, BuildError> {
        let mut wanted: Vec<(OnRoad, usize)> = Vec::with_capacity(places.len());
        wanted.extend(
            places.iter().enumerate().filter_map(|(index, place)| Some(((*place)?, index))),
        );
        wanted.sort_unstable();
        let mut grounds_m = vec![None; places.len()];
        for &id in tiles {
            self.observer.check()?;
            for line in ground_lines::get(self.of.store, id)? {
                let ordinal = line.ordinal;
                let [Some(first), Some(last)] = [line.vertices.first(), line.vertices.last()]
                else {
                    continue;
                };
                // Lengths are rounded: what is as near as this to an end is at it.
                let [from_um, to_um] = [first.along_um, last.along_um];
                let begin = OnRoad { ordinal, along_um: from_um.saturating_sub(NEAR_END_UM) };
                let own = &wanted[wanted.partition_point(|(place, _)| *place < begin)..];
                for &(place, index) in own {
                    if place.ordinal != ordinal || place.along_um > to_um + NEAR_END_UM {
                        break;
                    }
                    let height_m = line.height_m(place.along_um.clamp(from_um, to_um));
                    grounds_m[index] = grounds_m[index].or(height_m);
                }
            }
        }
        Ok(grounds_m)
    }

    /// The ground of a level at points of the lattice.
    fn grounds_of(
        &self,
        level: u8,
        points: &[LatticePoint],
    ) -> Result<Vec<Option<f64>>, BuildError> {
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
            let placement = Placement::of_tile(self.of.frame, id, self.quantum_m);
            let surface = Surface::new(&tin, placement);
            for index in indices {
                let located = surface.locate(points[index]);
                let height_m =
                    located.map(|triangle| surface.height_at_point_m(triangle, points[index]));
                grounds_m[index] = grounds_m[index].or(height_m);
            }
        }
        Ok(grounds_m)
    }

    /// The tiles of a level that hold a point, on their borders too.
    fn tiles_at(&self, level: u8, point: LatticePoint) -> impl Iterator<Item = TileId> + use<> {
        let frame = *self.of.frame;
        let [column, row] = frame.tile_column_row(level, point);
        let beside = [0, 1].map(|east| [0, 1].map(|south| [column - east, row - south]));
        beside.into_iter().flatten().filter_map(move |[column, row]| {
            let id = TileId::new(level, column.try_into().ok()?, row.try_into().ok()?).ok()?;
            frame.tile_lattice_bounds(id).contains(point).then_some(id)
        })
    }

    /// Keeps the runs of a tile. Returns which of its bridges and tunnels the ground has, not they.
    fn put_section(
        &self,
        (network, decks): (&SpanNetwork, &Decks),
        id: TileId,
    ) -> Result<Vec<SpanProblem>, BuildError> {
        let mut lines = ground_lines::get(self.of.store, id)?;
        lines.sort_by_key(|line| {
            (
                line.class,
                line.way_id,
                line.ordinal,
                line.vertices.first().map(|first| first.along_um),
            )
        });
        let mut runs: Vec<SpanRun> = Vec::new();
        let mut within = Vec::new();
        for line in &lines {
            let of_line = runs_of(line, (network, decks), self.quantum_m);
            runs.extend(of_line.runs);
            if of_line.within_m > MOST_WITHIN_M {
                let reason = match line.kind() {
                    SpanKind::Bridge => SpanReason::DeckInGround,
                    SpanKind::Tunnel => SpanReason::TunnelAboveGround,
                };
                within.push(SpanProblem { reason, way_id: line.way_id });
            }
        }
        let points = runs.iter().map(|run| run.points.len() as u64).sum();
        let counts = [runs.len() as u64, points];
        let tile = (SectionLayer::Spans, pmtiles_order(id));
        TileSection::put(tile, self.of.store, counts, |id| {
            Ok(encode_spans(id, self.of.frame, &runs)?.map(SpansSection::into_bytes))
        })?;
        Ok(within)
    }
}
