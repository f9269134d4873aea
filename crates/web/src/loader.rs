//! Loads the tiles of a map: bytes by ranges, decoding in the workers.

use std::{cell::RefCell, collections::BTreeMap, rc::Rc, sync::Arc};

use corniche_geom::TileId;
use corniche_live::{Loaded, TileLoader};
use corniche_viewer::tiles::{LoadTileError, PackageTiles, TileGeometry};
use futures_util::future::{AbortHandle, abortable};
use wasm_bindgen_futures::spawn_local;

use crate::{decoders::Decoders, host::Host, source::WebSource};

/// The tiles of a package, and who decodes them.
pub(crate) struct Tileset {
    pub(crate) package: Arc<PackageTiles<WebSource>>,
    pub(crate) decoders: Decoders,
}

impl Tileset {
    /// Reads a tile and has it decoded.
    ///
    /// # Errors
    /// When it cannot be read or is damaged.
    pub(crate) async fn load(
        &self,
        id: TileId,
        decoder: &str,
    ) -> Result<TileGeometry, LoadTileError> {
        let payload = self.package.payload(id).await?;
        self.decoders.decode(payload, id, decoder).await
    }
}

/// What arrives, and what is under way.
#[derive(Default)]
struct State {
    arrived: Vec<Loaded>,
    under_way: BTreeMap<TileId, Load>,
    /// Tiles that are there before they are asked for: those of the first view.
    ready: BTreeMap<TileId, TileGeometry>,
}

/// A tile under way.
struct Load {
    handle: AbortHandle,
    /// Whether it was asked for, and not only foreseen.
    is_asked: bool,
}

/// The loader of a map.
#[derive(Clone)]
pub(crate) struct PageLoader {
    tiles: Rc<Tileset>,
    host: Host,
    /// What is read of tiles, as JSON.
    decoder: Rc<RefCell<String>>,
    state: Rc<RefCell<State>>,
}

impl PageLoader {
    /// Loads what `decoder` says. `ready` are tiles that were decoded already.
    pub(crate) fn new(
        tiles: Rc<Tileset>,
        host: Host,
        decoder: String,
        ready: BTreeMap<TileId, TileGeometry>,
    ) -> Self {
        let state = State { ready, ..State::default() };
        Self {
            tiles,
            host,
            decoder: Rc::new(RefCell::new(decoder)),
            state: Rc::new(RefCell::new(state)),
        }
    }

    /// From now on other parts of tiles are read; returns whether they are others.
    pub(crate) fn read_otherwise(&self, decoder: String) -> bool {
        let is_other = *self.decoder.borrow() != decoder;
        if is_other {
            self.decoder.replace(decoder);
            let mut state = self.state.borrow_mut();
            state.ready.clear();
            state.stop();
        }
        is_other
    }

    /// Loads tiles that will be asked for soon.
    pub(crate) fn foresee(&self, ids: &[TileId]) {
        for id in ids {
            self.begin(*id, false);
        }
    }

    /// Begins to load a tile, if it is neither there nor under way.
    fn begin(&self, id: TileId, is_asked: bool) {
        let mut state = self.state.borrow_mut();
        if let Some(load) = state.under_way.get_mut(&id) {
            load.is_asked |= is_asked;
            return;
        }
        if state.ready.contains_key(&id) {
            return;
        }
        let (tiles, decoder) = (Rc::clone(&self.tiles), self.decoder.borrow().clone());
        let (load, handle) = abortable(async move { tiles.load(id, &decoder).await });
        state.under_way.insert(id, Load { handle, is_asked });
        let (state, host) = (Rc::clone(&self.state), self.host.clone());
        spawn_local(async move {
            let Ok(tile) = load.await else { return };
            let mut state = state.borrow_mut();
            let is_asked = state.under_way.remove(&id).is_some_and(|load| load.is_asked);
            match tile {
                tile if is_asked => state.arrived.push(Loaded { id, tile }),
                Ok(tile) => {
                    state.ready.insert(id, tile);
                }
                // Who asks for it will be told.
                Err(_) => {}
            }
            drop(state);
            if is_asked {
                host.wake();
            }
        });
    }
}

impl State {
    /// Stops all that is under way.
    fn stop(&mut self) {
        for load in std::mem::take(&mut self.under_way).into_values() {
            load.handle.abort();
        }
    }
}

impl TileLoader for PageLoader {
    fn request(&mut self, ids: &[TileId]) {
        for &id in ids {
            let ready = self.state.borrow_mut().ready.remove(&id);
            if let Some(tile) = ready {
                self.state.borrow_mut().arrived.push(Loaded { id, tile: Ok(tile) });
                self.host.wake();
                continue;
            }
            self.begin(id, true);
        }
    }

    fn forget(&mut self) {
        let mut state = self.state.borrow_mut();
        state.stop();
        state.arrived.clear();
    }

    fn abandon(&mut self, ids: &[TileId]) -> Vec<TileId> {
        let mut state = self.state.borrow_mut();
        let mut dropped = Vec::new();
        for id in ids {
            if let Some(load) = state.under_way.remove(id) {
                load.handle.abort();
                dropped.push(*id);
            }
        }
        dropped
    }

    fn arrivals(&mut self) -> Vec<Loaded> {
        std::mem::take(&mut self.state.borrow_mut().arrived)
    }
}
