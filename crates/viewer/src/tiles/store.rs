//! The tiles loaded so far, for a picture that needs all of them at once.

use std::{
    collections::{BTreeMap, BTreeSet},
    iter,
    num::NonZeroUsize,
    thread,
};

use corniche_geom::{Bounds, TileId};
use corniche_work::workers::in_order;

use super::{CatalogTree, LoadTileError, MapExtent, TileGeometry, TileSource};
use crate::lod::{DrawnTile, GroundSummary, TileTree};

/// Maximum number of tiles that are loaded to find out where roads are.
const FEW_TILES: usize = 64;

/// Maximum number of loader threads: more would compete with the drawing thread, each needs memory
/// of its own, and with a remote package all of them send requests to one server.
pub const MOST_LOADERS: usize = 4;

/// Number of ancestors whose slopes shade a tile, besides its own slopes.
pub(crate) const MOST_SLOPES_ABOVE: usize = 3;

/// The tiles loaded so far. For tiles that are only visited during tile selection it holds errors
/// and heights. Only in a web page, which has no threads, may the source be one that threads cannot
/// share.
pub struct TileStore<'a, S: ?Sized = dyn TileSource + Sync + 'a> {
    source: &'a S,
    tiles: BTreeMap<TileId, TileGeometry>,
    /// The summaries of all tiles that were read in any way.
    summaries: BTreeMap<TileId, Option<GroundSummary>>,
    /// Tiles of which only slopes are drawn.
    coarser: BTreeMap<TileId, TileGeometry>,
}

/// The part of a tile to load for a picture.
#[derive(Debug, Clone, Copy)]
enum WantedTile {
    Whole(TileId),
    Slopes(TileId),
}

impl<'a, S: TileSource + ?Sized> TileStore<'a, S> {
    /// Creates an empty store for the tiles of `source`.
    #[must_use]
    pub fn new(source: &'a S) -> Self {
        Self {
            source,
            tiles: BTreeMap::new(),
            summaries: BTreeMap::new(),
            coarser: BTreeMap::new(),
        }
    }

    /// Loads a tile, unless it is loaded already.
    ///
    /// # Errors
    /// When the tile cannot be read.
    pub fn load(&mut self, id: TileId) -> Result<(), LoadTileError> {
        if !self.tiles.contains_key(&id) {
            let tile = self.source.load(id)?;
            self.summaries.insert(id, tile.summary);
            self.tiles.insert(id, tile);
        }
        Ok(())
    }

    /// Reads errors and heights of a tile, unless they are known already. For [`TileTree`] the tile
    /// then counts as loaded.
    ///
    /// # Errors
    /// When the tile cannot be read.
    pub fn pass(&mut self, id: TileId) -> Result<(), LoadTileError> {
        if !self.summaries.contains_key(&id) {
            self.summaries.insert(id, self.source.summary(id)?);
        }
        Ok(())
    }

    /// The tiles as a tree for tile selection, with the ground of the loaded and visited tiles.
    #[must_use]
    pub fn tree(&self) -> impl TileTree {
        CatalogTree { catalog: self.source, ground_of: |id| self.summaries.get(&id).copied() }
    }

    /// The missing parts of drawn tiles, and of their ancestors whose slopes shade them.
    fn missing(&self, drawn: &[DrawnTile]) -> Vec<WantedTile> {
        let whole = drawn.iter().map(|drawn| drawn.id).filter(|id| !self.tiles.contains_key(id));
        let above = |drawn: &DrawnTile| {
            iter::successors(drawn.id.parent(), |id| id.parent()).take(MOST_SLOPES_ABOVE)
        };
        let above: BTreeSet<TileId> = drawn.iter().flat_map(above).collect();
        let slopes = above.into_iter().filter(|id| self.with_slopes(*id).is_none());
        whole.map(WantedTile::Whole).chain(slopes.map(WantedTile::Slopes)).collect()
    }

    /// Whether the tile or any descendant exists.
    #[must_use]
    pub fn exists(&self, id: TileId) -> bool {
        self.source.exists(id)
    }

    /// Number of tiles that were read, in whole or in part.
    #[must_use]
    pub fn len(&self) -> usize {
        self.summaries.len()
    }

    /// Whether no tile was read.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.summaries.is_empty()
    }

    /// A tile whose slopes, at least, are loaded.
    #[must_use]
    pub fn with_slopes(&self, id: TileId) -> Option<&TileGeometry> {
        self.tiles.get(&id).or_else(|| self.coarser.get(&id))
    }

    /// A loaded tile.
    #[must_use]
    pub fn get(&self, id: TileId) -> Option<&TileGeometry> {
        self.tiles.get(&id)
    }

    /// The ground of the root tile: the lowest and highest true height of all ground, and the error
    /// of the coarsest ground. Reads nothing else of the root. `None` without any ground.
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

    /// The extent of the first view: the roads of the coarsest level with roads, otherwise all of
    /// the data, whose rectangle is `data`. Loads the tiles down to that level, as long as they are
    /// few. `None` without any ground.
    ///
    /// # Errors
    /// When a tile cannot be read.
    pub fn map_extent(&mut self, data: Bounds) -> Result<Option<MapExtent>, LoadTileError> {
        let Some(ground) = self.coarsest_ground()? else { return Ok(None) };
        // Without roads all levels would be searched for them in vain.
        let mut level = if self.source.may_have_roads() { vec![TileId::ROOT] } else { Vec::new() };
        while !level.is_empty() && level.len() <= FEW_TILES {
            for id in &level {
                self.load(*id)?;
            }
            let tiles: Vec<&TileGeometry> = level.iter().filter_map(|id| self.get(*id)).collect();
            if let Some(extent) = MapExtent::of_roads(&tiles, data) {
                return Ok(Some(extent));
            }
            if level[0].z() == self.source.frame().max_level() {
                break;
            }
            level = level.into_iter().flat_map(TileId::children).collect();
            level.retain(|id| self.source.exists(*id));
        }
        Ok(Some(MapExtent::of_data(data, ground.height_range_m)))
    }

    /// True height of the ground at a position, from the finest tile that has ground there, which
    /// it loads.
    ///
    /// # Errors
    /// When a tile cannot be read.
    pub fn ground_height_m(&mut self, at: [f64; 2]) -> Result<Option<f64>, LoadTileError> {
        for id in self.source.tiles_at(at).into_iter().rev() {
            self.load(id)?;
            let height_m = self.get(id).and_then(|tile| tile.ground_height_m(at));
            if height_m.is_some() {
                return Ok(height_m);
            }
        }
        Ok(None)
    }
}

impl<S: TileSource + Sync + ?Sized> TileStore<'_, S> {
    /// Loads the drawn tiles, and the slopes of the ancestors that shade them, with several
    /// threads. `check` is called before the first tile and after each.
    ///
    /// # Errors
    /// When a tile cannot be read, or `check` fails.
    pub fn load_drawn<E: From<LoadTileError> + Send>(
        &mut self,
        drawn: &[DrawnTile],
        check: impl Fn() -> Result<(), E>,
    ) -> Result<(), E> {
        let (source, wanted) = (self.source, self.missing(drawn));
        let processors = thread::available_parallelism().map_or(1, NonZeroUsize::get);
        let load = |wanted| match wanted {
            WantedTile::Whole(id) => source.load(id),
            WantedTile::Slopes(id) => source.load_slopes(id),
        };
        check()?;
        in_order(
            processors.min(MOST_LOADERS),
            wanted.len(),
            || Ok(()),
            |(), index| Ok(load(wanted[index])?),
            |index, tile| {
                let (tiles, id) = match wanted[index] {
                    WantedTile::Whole(id) => (&mut self.tiles, id),
                    WantedTile::Slopes(id) => (&mut self.coarser, id),
                };
                self.summaries.insert(id, tile.summary);
                tiles.insert(id, tile);
                check()
            },
        )
    }
}

#[cfg(test)]
#[path = "store_tests.rs"]
mod tests;
