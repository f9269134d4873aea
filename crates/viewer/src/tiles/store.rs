use std::collections::BTreeMap;

use corniche_geom::{Bounds, TileId};

use super::{LoadTileError, MapExtent, TileGeometry, TileSource};
use crate::lod::{GroundSummary, Node, Request, TileTree};

/// More tiles than these are not loaded to find out where roads are.
const FEW_TILES: usize = 64;

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

    /// What a first view shows: where the roads of the coarsest level with roads are, else all of the data, whose rectangle is
    /// `data`. Loads the tiles down to that level, as long as they are few. `None` without any ground.
    ///
    /// # Errors
    /// When a tile cannot be read.
    pub fn map_extent(&mut self, data: Bounds) -> Result<Option<MapExtent>, LoadTileError> {
        let Some(ground) = self.coarsest_ground()? else { return Ok(None) };
        let mut level = vec![TileId::ROOT];
        while !level.is_empty() && level.len() <= FEW_TILES {
            let requests = level.iter().map(|&id| Request { id, coarseness: f64::INFINITY });
            self.load(&requests.collect::<Vec<_>>())?;
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
                .then(|| id.children().find(|child| self.plan_bounds(*child).contains(at)))
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
