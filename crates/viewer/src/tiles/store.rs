use std::collections::BTreeMap;

use corniche_geom::{Bounds, TileId};

use super::{LoadTileError, MapExtent, TileGeometry, TileSource};
use crate::lod::{GroundSummary, Node, Request, TileTree};

/// The tiles loaded so far.
pub struct TileStore<'a> {
    source: &'a dyn TileSource,
    tiles: BTreeMap<TileId, TileGeometry>,
}

impl<'a> TileStore<'a> {
    /// An empty store of the tiles of `source`.
    #[must_use]
    pub fn new(source: &'a dyn TileSource) -> Self {
        Self { source, tiles: BTreeMap::new() }
    }

    /// Loads the requested tiles, in order, if they are not loaded yet.
    ///
    /// # Errors
    /// At the first tile that cannot be read.
    pub fn load(&mut self, requests: &[Request]) -> Result<(), LoadTileError> {
        for request in requests {
            if !self.tiles.contains_key(&request.id) {
                self.tiles.insert(request.id, self.source.load(request.id)?);
            }
        }
        Ok(())
    }

    /// Whether the tile or anything beneath it exists.
    #[must_use]
    pub fn exists(&self, id: TileId) -> bool {
        self.source.exists(id)
    }

    /// How many tiles are loaded.
    #[must_use]
    pub fn len(&self) -> usize {
        self.tiles.len()
    }

    /// Whether no tile is loaded.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.tiles.is_empty()
    }

    /// A loaded tile.
    #[must_use]
    pub fn get(&self, id: TileId) -> Option<&TileGeometry> {
        self.tiles.get(&id)
    }

    /// The ground of the root tile, which it loads: the lowest and highest true height of all ground, and the error of the
    /// coarsest ground. `None` without any ground.
    ///
    /// # Errors
    /// When the root cannot be read.
    pub fn coarsest_ground(&mut self) -> Result<Option<GroundSummary>, LoadTileError> {
        if !self.exists(TileId::ROOT) {
            return Ok(None);
        }
        self.load(&[Request { id: TileId::ROOT, coarseness: f64::INFINITY }])?;
        Ok(self.get(TileId::ROOT).and_then(|root| root.summary))
    }

    /// What a first view shows, told by the root tile, which it loads; `data` is the rectangle of the data. `None` without any
    /// ground.
    ///
    /// # Errors
    /// When the root cannot be read.
    pub fn map_extent(&mut self, data: Bounds) -> Result<Option<MapExtent>, LoadTileError> {
        let has_ground = self.coarsest_ground()?.is_some();
        let root = self.get(TileId::ROOT).filter(|_| has_ground);
        Ok(root.map(|root| root.map_extent(data)))
    }

    /// True height of the ground at a position, from the finest tile there; loads the tiles down to it.
    ///
    /// # Errors
    /// When a tile cannot be read.
    pub fn ground_height_m(&mut self, at: [f64; 2]) -> Result<Option<f64>, LoadTileError> {
        let mut found = None;
        let mut next = self.source.exists(TileId::ROOT).then_some(TileId::ROOT);
        while let Some(id) = next {
            self.load(&[Request { id, coarseness: f64::INFINITY }])?;
            found = self.get(id).and_then(|tile| tile.ground_height_m(at)).or(found);
            next = (id.z() < self.max_level())
                .then(|| id.children().find(|child| holds(&self.plan_bounds(*child), at)))
                .flatten()
                .filter(|child| self.source.exists(*child));
        }
        Ok(found)
    }
}

impl TileTree for TileStore<'_> {
    fn node(&self, id: TileId) -> Node {
        match self.tiles.get(&id) {
            Some(tile) => Node::Loaded(tile.summary),
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

fn holds(bounds: &Bounds, [x, y]: [f64; 2]) -> bool {
    (bounds.min_x..=bounds.max_x).contains(&x) && (bounds.min_y..=bounds.max_y).contains(&y)
}
