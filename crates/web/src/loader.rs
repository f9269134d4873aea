//! Loads the tiles of a map: bytes by ranges, decoding in the workers.

use std::{
    cell::RefCell,
    collections::{BTreeMap, BTreeSet},
    rc::Rc,
    sync::Arc,
};

use corniche_geom::TileId;
use corniche_live::{Loaded, TileLoader, formatting::with_causes};
use corniche_tileset::{OpenError, ReadError};
use corniche_viewer::tiles::{LoadTileError, PackageTiles, TileGeometry};
use futures_util::future::{AbortHandle, abortable};
use wasm_bindgen_futures::spawn_local;

use crate::{
    decoders::{DecodedParts, Decoders},
    host::{Host, pause},
    problem::Problem,
    source::WebSource,
};

/// A tile that the server did not send is requested again after this time, and then after twice as
/// long each time …
const FIRST_REST_MS: f64 = 2000.0;
/// … but not after longer than this.
const LAST_REST_MS: f64 = 30_000.0;

/// The tiles of a package, and their decoder.
pub(crate) struct Tileset {
    pub(crate) package: Arc<PackageTiles<WebSource>>,
    pub(crate) decoders: Decoders,
}

impl Tileset {
    /// Reads and decodes a tile.
    ///
    /// # Errors
    /// When the tile cannot be read or is corrupt.
    pub(crate) async fn load(
        &self,
        id: TileId,
        reading: &DecodedParts,
    ) -> Result<TileGeometry, LoadTileError> {
        let payload = self.package.payload_for(id, reading.sections).await?;
        self.decoders.decode(payload, id, reading).await
    }

    /// The reason why a tile did not arrive: the problem of its server, as reported by the source
    /// if possible, or its bytes.
    pub(crate) fn problem_of(&self, error: &LoadTileError) -> Problem {
        let Some(why) = of_server(error) else {
            let advice = "Download or build the package again.";
            return Problem::new("damaged", with_causes(error), advice);
        };
        let told = self.package.package.source().take_problem();
        told.unwrap_or_else(|| Problem::new("network", why, ""))
    }
}

/// The arrived tiles, and those being loaded.
#[derive(Default)]
struct State {
    arrived: Vec<Loaded>,
    under_way: BTreeMap<TileId, Load>,
    /// Tiles that arrived before they were requested: those of the first view.
    ready: BTreeMap<TileId, TileGeometry>,
    /// Tiles that the server does not send. They are requested again from time to time; meanwhile
    /// coarser tiles are drawn.
    troubled: BTreeSet<TileId>,
    /// Problems of the server that have not been reported yet.
    problems: Vec<Problem>,
}

/// A tile being loaded.
struct Load {
    handle: AbortHandle,
    /// Whether the tile was requested, and not only predicted.
    is_asked: bool,
}

/// The loader of a map.
#[derive(Clone)]
pub(crate) struct PageLoader {
    tiles: Rc<Tileset>,
    host: Host,
    reading: Rc<RefCell<DecodedParts>>,
    state: Rc<RefCell<State>>,
}

impl PageLoader {
    /// Creates the loader for the parts in `reading`. `ready` are tiles that were decoded already.
    pub(crate) fn new(
        tiles: Rc<Tileset>,
        host: Host,
        reading: DecodedParts,
        ready: BTreeMap<TileId, TileGeometry>,
    ) -> Self {
        let state = State { ready, ..State::default() };
        Self {
            tiles,
            host,
            reading: Rc::new(RefCell::new(reading)),
            state: Rc::new(RefCell::new(state)),
        }
    }

    /// Changes the parts of tiles that are read; returns whether they changed.
    pub(crate) fn read_otherwise(&self, reading: DecodedParts) -> bool {
        let is_other = *self.reading.borrow() != reading;
        if is_other {
            self.reading.replace(reading);
            let mut state = self.state.borrow_mut();
            state.ready.clear();
            state.stop();
        }
        is_other
    }

    /// The problems of the server since the last call.
    pub(crate) fn take_problems(&self) -> Vec<Problem> {
        std::mem::take(&mut self.state.borrow_mut().problems)
    }

    /// Ends the prediction, since the first view is complete: predicted tiles that were not
    /// requested are not needed.
    pub(crate) fn end_foresight(&self) {
        let mut state = self.state.borrow_mut();
        state.ready.clear();
        state.under_way.retain(|_, load| {
            if !load.is_asked {
                load.handle.abort();
            }
            load.is_asked
        });
    }

    /// The number of tiles that wait because the server does not send them.
    pub(crate) fn troubled(&self) -> usize {
        self.state.borrow().troubled.len()
    }

    /// Loads tiles that will be requested soon.
    pub(crate) fn foresee(&self, ids: &[TileId]) {
        for id in ids {
            self.begin(*id, false);
        }
    }

    /// Starts loading a tile, if it is neither loaded nor being loaded.
    fn begin(&self, id: TileId, is_asked: bool) {
        let mut state = self.state.borrow_mut();
        if let Some(load) = state.under_way.get_mut(&id) {
            load.is_asked |= is_asked;
            return;
        }
        if state.ready.contains_key(&id) {
            return;
        }
        let (tiles, reading) = (Rc::clone(&self.tiles), self.reading.borrow().clone());
        let (for_load, host) = (Rc::clone(&self.state), self.host.clone());
        let (load, handle) = abortable(async move {
            let mut rest_ms = FIRST_REST_MS;
            loop {
                let tile = tiles.load(id, &reading).await;
                let is_asked = for_load.borrow().is_asked(id);
                let of_server = |error: &&LoadTileError| is_asked && of_server(error).is_some();
                let Some(error) = tile.as_ref().err().filter(of_server) else { return tile };
                let problem = tiles.problem_of(error);
                for_load.borrow_mut().meet(id, problem);
                host.wake();
                pause(rest_ms).await;
                rest_ms = (2.0 * rest_ms).min(LAST_REST_MS);
            }
        });
        state.under_way.insert(id, Load { handle, is_asked });
        let (state, host) = (Rc::clone(&self.state), self.host.clone());
        spawn_local(async move {
            let Ok(tile) = load.await else { return };
            let mut state = state.borrow_mut();
            state.troubled.remove(&id);
            let is_asked = state.under_way.remove(&id).is_some_and(|load| load.is_asked);
            match tile {
                tile if is_asked => state.arrived.push(Loaded { id, tile }),
                Ok(tile) => {
                    state.ready.insert(id, tile);
                }
                // The requester will get the error.
                Err(_) => {}
            }
            drop(state);
            if is_asked {
                host.wake();
            }
        });
    }
}

/// The reason why a tile did not arrive, if its server is to blame and not its bytes.
fn of_server(error: &LoadTileError) -> Option<String> {
    match error.source.downcast_ref::<ReadError>()? {
        ReadError::Source { source, .. } => Some(source.reason.clone()),
        ReadError::Directory { source: OpenError::Source(source), .. } => {
            Some(source.reason.clone())
        }
        _ => None,
    }
}

impl State {
    /// Whether a tile being loaded was requested.
    fn is_asked(&self, id: TileId) -> bool {
        self.under_way.get(&id).is_some_and(|load| load.is_asked)
    }

    /// Notes that the server did not send a tile.
    fn meet(&mut self, id: TileId, problem: Problem) {
        // Many tiles have the same problem; it is reported for the first of them.
        if self.troubled.is_empty() {
            self.problems.push(problem);
        }
        self.troubled.insert(id);
    }

    /// Cancels all loading.
    fn stop(&mut self) {
        self.troubled.clear();
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
                state.troubled.remove(id);
                dropped.push(*id);
            }
        }
        dropped
    }

    fn arrivals(&mut self) -> Vec<Loaded> {
        std::mem::take(&mut self.state.borrow_mut().arrived)
    }
}
