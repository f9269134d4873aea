//! The ground of spans where a package has no ground, or ground that differs from that of a build
//! without bounds.
//!
//! Whole spans are solved, even if bounds cut them. So supports beyond the bounds need ground: the
//! ground that the finest tile there has when it is meshed without bounds. The mesh of a tile that
//! is cut differs from it. Spans that extend into whole tiles use the ground of the whole tile at
//! all of their supports, so that whole tiles are the same with and without bounds.

use std::collections::{BTreeMap, HashSet};

use corniche_dem::{Dem, GridPlan};
use corniche_geom::{
    GridFrame, LatticeBounds, LatticePoint, LatticeRegion, NodeIndex, NodeWindow, TILE_CELLS,
    TILE_NODES, TileId,
};
use corniche_spec::{BuildObserver, levels::Levels};
use corniche_tileset::OuterGround;
use corniche_tin::{Placement, Surface, TinSpec};
use corniche_work::workers;

use super::span_network::SpanNetwork;
use crate::ExtractError;

/// A place where a span needs ground.
#[derive(Debug, Clone, Copy)]
pub struct AskedPlace {
    pub(crate) at: LatticePoint,
    /// Whether the package's own finest tiles have ground there.
    pub(crate) has_own: bool,
    /// The span that needs the ground.
    pub(crate) span: usize,
}

/// A source of ground outside the package.
pub trait OuterGrounds: Sync {
    /// Returns the height of each place, metres; `None` where the package's own ground applies.
    ///
    /// # Errors
    /// See [`ExtractError`].
    fn heights_m(
        &self,
        network: &SpanNetwork,
        places: &[AskedPlace],
    ) -> Result<Vec<Option<f64>>, ExtractError>;
}

/// The ground that a package records.
impl OuterGrounds for &[OuterGround] {
    fn heights_m(
        &self,
        _: &SpanNetwork,
        places: &[AskedPlace],
    ) -> Result<Vec<Option<f64>>, ExtractError> {
        let known: BTreeMap<LatticePoint, f64> =
            self.iter().map(|own| (own.at, own.height_m)).collect();
        Ok(places.iter().map(|place| known.get(&place.at).copied()).collect())
    }
}

/// Column and row of a finest tile, also outside the root.
type TileIndex = [i64; 2];

/// Elevation files of which only a part was requested.
pub struct WholeDem<'a> {
    /// The elevation files.
    pub dem: &'a Dem,
    /// The grid plan of the requested part.
    pub plan: &'a GridPlan,
    /// Tolerances of levels.
    pub levels: &'a Levels,
    /// The rectangle of all elevation data.
    pub whole: LatticeBounds,
    /// Worker threads.
    pub threads: usize,
    /// Receives progress.
    pub observer: &'a dyn BuildObserver,
}

impl WholeDem<'_> {
    fn frame(&self) -> &GridFrame {
        &self.plan.frame
    }

    /// The finest tiles that contain a place, borders included.
    fn tiles_at(&self, at: LatticePoint) -> impl Iterator<Item = TileIndex> + use<'_> {
        let [column, row] = self.frame().tile_column_row(self.frame().max_level(), at);
        let beside = [1, 0].map(|west| [1, 0].map(|north| [column - west, row - north]));
        beside.into_iter().flatten().filter(move |&tile| self.bounds_of(tile).contains(at))
    }

    /// The nodes of a tile, with `halo` more nodes around it.
    fn window(&self, [column, row]: TileIndex, halo: usize) -> NodeWindow {
        let root = self.frame().root_corner();
        let corner = NodeIndex { i: root.i + column * TILE_CELLS, j: root.j - row * TILE_CELLS };
        NodeWindow { corner, stride: 1, columns: TILE_NODES, rows: TILE_NODES }.with_halo(halo)
    }

    /// The south-western and the north-eastern node of a tile.
    fn nodes_of(&self, tile: TileIndex, halo: usize) -> [NodeIndex; 2] {
        let window = self.window(tile, halo);
        let [low, high] = [window.node(0, window.rows - 1), window.node(window.columns - 1, 0)];
        [low, high]
    }

    fn bounds_of(&self, tile: TileIndex) -> LatticeBounds {
        self.frame().lattice_bounds(self.nodes_of(tile, 0))
    }

    /// Whether a tile is the same as without bounds, as far as there are data.
    fn is_whole(&self, tile: TileIndex) -> bool {
        let Some(clip) = &self.plan.clip else { return true };
        let frame = self.frame();
        let own = frame.lattice_bounds(self.nodes_of(tile, 1)).intersection(&self.whole);
        let asked = frame.lattice_bounds(clip.nodes);
        let is_inside = asked.contains(own.min) && asked.contains(own.max);
        let is_left = |region: &LatticeRegion| {
            let nodes = region.nodes(frame.node_steps(frame.max_level()), &self.window(tile, 1));
            nodes.into_iter().all(|is_left| is_left)
        };
        is_inside && self.plan.polygon.as_deref().is_none_or(is_left)
    }

    /// Returns for each elevation file whether its samples are needed for these places.
    ///
    /// # Errors
    /// See [`ExtractError`].
    pub fn needed_files(&self, places: &[LatticePoint]) -> Result<Vec<bool>, ExtractError> {
        let mut is_needed: Vec<bool> = Vec::new();
        for tile in self.by_tile(places.iter().copied().enumerate()).into_keys() {
            let mut part = self.plan.clone();
            [part.south_west, part.north_east] = self.nodes_of(tile, 1);
            let of_tile = self.dem.needed_files(&part)?;
            is_needed.resize(of_tile.len(), false);
            is_needed.iter_mut().zip(of_tile).for_each(|(all, own)| *all |= own);
        }
        Ok(is_needed)
    }

    fn by_tile(
        &self,
        places: impl Iterator<Item = (usize, LatticePoint)>,
    ) -> BTreeMap<TileIndex, Vec<usize>> {
        let mut by_tile: BTreeMap<TileIndex, Vec<usize>> = BTreeMap::new();
        for (index, at) in places {
            for tile in self.tiles_at(at) {
                by_tile.entry(tile).or_default().push(index);
            }
        }
        by_tile
    }
}

impl OuterGrounds for WholeDem<'_> {
    fn heights_m(
        &self,
        network: &SpanNetwork,
        places: &[AskedPlace],
    ) -> Result<Vec<Option<f64>>, ExtractError> {
        let mut heights_m = vec![None; places.len()];
        if self.plan.clip.is_none() {
            return Ok(heights_m);
        }
        let mut known: BTreeMap<TileIndex, bool> = BTreeMap::new();
        let mut is_whole =
            |tile: TileIndex| *known.entry(tile).or_insert_with(|| self.is_whole(tile));
        let is_of_cut: Vec<bool> =
            places.iter().map(|place| !self.tiles_at(place.at).any(&mut is_whole)).collect();
        if !is_of_cut.contains(&true) {
            return Ok(heights_m);
        }
        let finest = self.frame().max_level();
        let frame = self.frame();
        let goes_into_whole = network.needed_where(|ends| {
            let Some(own) = LatticeBounds::around(&ends) else { return false };
            let [west, south] = frame.tile_column_row(finest, own.min);
            let [east, north] = frame.tile_column_row(finest, own.max);
            // Tiles outside the root do not belong to the package.
            let last = (1_i64 << finest) - 1;
            (north.max(0)..=south.min(last))
                .any(|row| (west.max(0)..=east.min(last)).any(|column| is_whole([column, row])))
        });
        // Several spans may need the same place, which has one ground.
        let of_whole: HashSet<LatticePoint> = places
            .iter()
            .filter(|place| goes_into_whole[place.span])
            .map(|place| place.at)
            .collect();
        let wanted = places.iter().zip(is_of_cut).enumerate().filter(|(_, (place, is_of_cut))| {
            let is_other = !place.has_own || of_whole.contains(&place.at);
            *is_of_cut && is_other && self.whole.contains(place.at)
        });
        let by_tile: Vec<(TileIndex, Vec<usize>)> =
            self.by_tile(wanted.map(|(index, (place, _))| (index, place.at))).into_iter().collect();
        let plan = self.plan.of_whole_data();
        let spec = TinSpec {
            max_error_m: self.levels.max_error_m(finest),
            quantum_m: self.levels.quantum_m(),
        };
        workers::in_order_unless_cancelled(
            self.observer,
            self.threads,
            &by_tile,
            || Ok(self.dem.reader(&plan)),
            |reader, (tile, indices)| {
                let heights = reader.window(self.window(*tile, 1))?.heights;
                if heights.count_heights() == 0 {
                    return Ok(vec![None; indices.len()]);
                }
                let failed = |source| {
                    let [x, y] = tile.map(|at| u32::try_from(at).unwrap_or_default());
                    let id = TileId::new(finest, x, y).unwrap_or(TileId::ROOT);
                    ExtractError::Triangulate { id, source }
                };
                let tin = corniche_tin::triangulate(&heights, spec).map_err(failed)?;
                let placement = Placement {
                    corner: frame.lattice_of_node(self.window(*tile, 0).corner),
                    node_steps: frame.node_steps(finest),
                    quantum_m: spec.quantum_m,
                };
                let surface = Surface::new(&tin, placement);
                let height_m = |&index: &usize| {
                    let at = places[index].at;
                    Some(surface.height_at_point_m(surface.locate(at)?, at))
                };
                Ok(indices.iter().map(height_m).collect::<Vec<Option<f64>>>())
            },
            |(_, indices), found: Vec<Option<f64>>| {
                for (&index, height_m) in indices.iter().zip(found) {
                    heights_m[index] = heights_m[index].or(height_m);
                }
                Ok::<(), ExtractError>(())
            },
        )?;
        Ok(heights_m)
    }
}

/// The rectangle of a grid's whole elevation data, from its corners in working metres.
#[must_use]
pub fn whole_rectangle(frame: &GridFrame, bounds: &corniche_geom::Bounds) -> LatticeBounds {
    let corner = |position_m| {
        let [u, v] = frame.fraction_of_position(position_m);
        LatticePoint::new(u.round() as i64, v.round() as i64)
    };
    LatticeBounds {
        min: corner([bounds.min_x, bounds.min_y]),
        max: corner([bounds.max_x, bounds.max_y]),
    }
}
