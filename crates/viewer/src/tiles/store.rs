//! The tiles that were loaded so far, for a picture that needs all of them at once.

use std::{
    collections::{BTreeMap, BTreeSet},
    iter,
    num::NonZeroUsize,
    thread,
};

use corniche_geom::{Bounds, TileId};
use corniche_work::workers::in_order;

use super::{LoadTileError, MapExtent, TileGeometry, TileSource};
use crate::lod::{Drawn, GroundSummary, Node, Request, TileTree};

/// More tiles than these are not loaded to find out where roads are.
const FEW_TILES: usize = 64;

/// So many threads load tiles at most: more would compete with one that draws, each takes memory of its own, and far away all ask one server.
pub const MOST_LOADERS: usize = 4;

/// A tile is shaded with its own slopes and with those of so many tiles above it.
pub(crate) const MOST_SLOPES_ABOVE: usize = 3;

/// The tiles loaded so far. Of tiles that are only passed while tiles are chosen it holds errors and heights. Only in a page, where there are no threads, is
/// their source one that threads cannot share.
pub struct TileStore<'a, S: ?Sized = dyn TileSource + Sync + 'a> {
    source: &'a S,
    tiles: BTreeMap<TileId, TileGeometry>,
    /// The summaries of all tiles that were read in any way.
    summaries: BTreeMap<TileId, Option<GroundSummary>>,
    /// Tiles of which nothing but slopes is drawn.
    coarser: BTreeMap<TileId, TileGeometry>,
}

/// What is to be loaded of a tile for a picture.
#[derive(Debug, Clone, Copy)]
enum Wanted {
    Whole(TileId),
    Slopes(TileId),
}

impl<'a, S: TileSource + ?Sized> TileStore<'a, S> {
    /// An empty store of the tiles of `source`.
    #[must_use]
    pub fn new(source: &'a S) -> Self {
        Self {
            source,
            tiles: BTreeMap::new(),
            summaries: BTreeMap::new(),
            coarser: BTreeMap::new(),
        }
    }

    /// Loads the requested tiles, in order, if they are not loaded yet.
    ///
    /// # Errors
    /// At the first tile that cannot be read.
    pub fn load(&mut self, requests: &[Request]) -> Result<(), LoadTileError> {
        for request in requests {
            self.load_tile(request.id)?;
        }
        Ok(())
    }

    fn load_tile(&mut self, id: TileId) -> Result<(), LoadTileError> {
        if !self.tiles.contains_key(&id) {
            let tile = self.source.load(id)?;
            self.summaries.insert(id, tile.summary);
            self.tiles.insert(id, tile);
        }
        Ok(())
    }

    /// Reads errors and heights of a tile, if they are not known yet. For [`TileTree`] the tile is loaded then.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn pass(&mut self, id: TileId) -> Result<(), LoadTileError> {
        if !self.summaries.contains_key(&id) {
            self.summaries.insert(id, self.source.summary(id)?);
        }
        Ok(())
    }

    /// What is missing of tiles that are drawn, and of those above them with whose slopes they are shaded.
    fn missing(&self, drawn: &[Drawn]) -> Vec<Wanted> {
        let whole = drawn.iter().map(|drawn| drawn.id).filter(|id| !self.tiles.contains_key(id));
        let above = |drawn: &Drawn| {
            iter::successors(drawn.id.parent(), |id| id.parent()).take(MOST_SLOPES_ABOVE)
        };
        let above: BTreeSet<TileId> = drawn.iter().flat_map(above).collect();
        let slopes = above.into_iter().filter(|id| self.with_slopes(*id).is_none());
        whole.map(Wanted::Whole).chain(slopes.map(Wanted::Slopes)).collect()
    }

    /// Whether the tile or anything beneath it exists.
    #[must_use]
    pub fn exists(&self, id: TileId) -> bool {
        self.source.exists(id)
    }

    /// How many tiles were read, in whole or in part.
    #[must_use]
    pub fn len(&self) -> usize {
        self.summaries.len()
    }

    /// Whether no tile was read.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.summaries.is_empty()
    }

    /// A tile of which at least the slopes are loaded.
    #[must_use]
    pub fn with_slopes(&self, id: TileId) -> Option<&TileGeometry> {
        self.tiles.get(&id).or_else(|| self.coarser.get(&id))
    }

    /// A loaded tile.
    #[must_use]
    pub fn get(&self, id: TileId) -> Option<&TileGeometry> {
        self.tiles.get(&id)
    }

    /// The ground of the root tile, of which it reads no more: the lowest and highest true height of all ground, and the error of the
    /// coarsest ground. `None` without any ground.
    ///
    /// # Errors
    /// When the root cannot be read.
    pub fn coarsest_ground(&mut self) -> Result<Option<GroundSummary>, LoadTileError> {
        if !self.exists(TileId::ROOT) {
            return Ok(None);
        }
        self.pass(TileId::ROOT)?;
        Ok(self.summaries.get(&TileId::ROOT).copied().flatten())
    }

    /// What a first view shows: where the roads of the coarsest level with roads are, else all of the data, whose rectangle is
    /// `data`. Loads the tiles down to that level, as long as they are few. `None` without any ground.
    ///
    /// # Errors
    /// When a tile cannot be read.
    pub fn map_extent(&mut self, data: Bounds) -> Result<Option<MapExtent>, LoadTileError> {
        let Some(ground) = self.coarsest_ground()? else { return Ok(None) };
        // Without roads nothing tells where they are, and all levels would be searched for them.
        let mut level = if self.source.may_have_roads() { vec![TileId::ROOT] } else { Vec::new() };
        while !level.is_empty() && level.len() <= FEW_TILES {
            for id in &level {
                self.load_tile(*id)?;
            }
            let tiles: Vec<&TileGeometry> = level.iter().filter_map(|id| self.get(*id)).collect();
            if let Some(extent) = MapExtent::of_roads(&tiles, data) {
                return Ok(Some(extent));
            }
            if level[0].z() == self.max_level() {
                break;
            }
            level = level.into_iter().flat_map(TileId::children).collect();
            level.retain(|id| self.source.exists(*id));
        }
        Ok(Some(MapExtent::of_data(data, ground.height_range_m)))
    }

    /// True height of the ground at a position, from the finest tile that has ground there; loads it.
    ///
    /// # Errors
    /// When a tile cannot be read.
    pub fn ground_height_m(&mut self, at: [f64; 2]) -> Result<Option<f64>, LoadTileError> {
        for id in self.source.tiles_at(at).into_iter().rev() {
            self.load_tile(id)?;
            let height_m = self.get(id).and_then(|tile| tile.ground_height_m(at));
            if height_m.is_some() {
                return Ok(height_m);
            }
        }
        Ok(None)
    }
}

impl<S: TileSource + Sync + ?Sized> TileStore<'_, S> {
    /// Loads tiles that are drawn, and the slopes of those tiles above them that they are shaded with, by several threads. `check` is asked before the
    /// first and after each.
    ///
    /// # Errors
    /// When one of them cannot be read, or `check` fails.
    pub fn load_drawn<E: From<LoadTileError> + Send>(
        &mut self,
        drawn: &[Drawn],
        check: impl Fn() -> Result<(), E>,
    ) -> Result<(), E> {
        let (source, wanted) = (self.source, self.missing(drawn));
        let processors = thread::available_parallelism().map_or(1, NonZeroUsize::get);
        let load = |wanted| match wanted {
            Wanted::Whole(id) => source.load(id),
            Wanted::Slopes(id) => source.load_slopes(id),
        };
        check()?;
        in_order(
            processors.min(MOST_LOADERS),
            wanted.len(),
            || Ok(()),
            |(), index| Ok(load(wanted[index])?),
            |index, tile| {
                let (tiles, id) = match wanted[index] {
                    Wanted::Whole(id) => (&mut self.tiles, id),
                    Wanted::Slopes(id) => (&mut self.coarser, id),
                };
                self.summaries.insert(id, tile.summary);
                tiles.insert(id, tile);
                check()
            },
        )
    }
}

impl<S: TileSource + ?Sized> TileTree for TileStore<'_, S> {
    fn node(&self, id: TileId) -> Node {
        match self.summaries.get(&id) {
            Some(summary) => Node::Loaded(*summary),
            None if self.source.exists(id) => Node::Listed,
            None => Node::Absent,
        }
    }

    fn plan_bounds(&self, id: TileId) -> Bounds {
        self.source.frame().tile_bounds(id)
    }

    fn max_level(&self) -> u8 {
        self.source.frame().max_level()
    }
}

#[cfg(test)]
#[path = "store_tests.rs"]
mod tests;
