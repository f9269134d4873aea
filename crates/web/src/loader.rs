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
    decoders::{Decoders, Reading},
    host::{Host, pause},
    problem::Problem,
    source::WebSource,
};

/// A tile that the server did not give is asked for again after this time, and then after twice as long each time …
const FIRST_REST_MS: f64 = 2000.0;
/// … but not after longer than this.
const LAST_REST_MS: f64 = 30_000.0;

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
        reading: &Reading,
    ) -> Result<TileGeometry, LoadTileError> {
        let payload = self.package.payload_for(id, reading.sections).await?;
        self.decoders.decode(payload, id, reading).await
    }

    /// What is wrong where a tile did not come: its server, in the words of the source of its bytes where it has some, or its bytes.
    pub(crate) fn problem_of(&self, error: &LoadTileError) -> Problem {
        let Some(why) = of_server(error) else {
            let advice = "Fetch or build the package again.";
            return Problem::new("damaged", with_causes(error), advice);
        };
        let told = self.package.package.source().take_problem();
        told.unwrap_or_else(|| Problem::new("network", why, ""))
    }
}

/// What arrives, and what is under way.
#[derive(Default)]
struct State {
    arrived: Vec<Loaded>,
    under_way: BTreeMap<TileId, Load>,
    /// Tiles that are there before they are asked for: those of the first view.
    ready: BTreeMap<TileId, TileGeometry>,
    /// Tiles that the server does not give. They are asked for again from time to time; meanwhile what is coarser is drawn.
    troubled: BTreeSet<TileId>,
    /// What is wrong with the server, and nobody was told.
    problems: Vec<Problem>,
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
    reading: Rc<RefCell<Reading>>,
    state: Rc<RefCell<State>>,
}

impl PageLoader {
    /// Loads what `reading` says. `ready` are tiles that were decoded already.
    pub(crate) fn new(
        tiles: Rc<Tileset>,
        host: Host,
        reading: Reading,
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

    /// From now on other parts of tiles are read; returns whether they are others.
    pub(crate) fn read_otherwise(&self, reading: Reading) -> bool {
        let is_other = *self.reading.borrow() != reading;
        if is_other {
            self.reading.replace(reading);
            let mut state = self.state.borrow_mut();
            state.ready.clear();
            state.stop();
        }
        is_other
    }

    /// What went wrong with the server since this was asked last.
    pub(crate) fn take_problems(&self) -> Vec<Problem> {
        std::mem::take(&mut self.state.borrow_mut().problems)
    }

    /// The first view is complete: what was foreseen and not asked for is not needed.
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

    /// How many tiles wait because the server does not give them.
    pub(crate) fn troubled(&self) -> usize {
        self.state.borrow().troubled.len()
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

/// Why a tile did not come, where its server is to blame and not its bytes.
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
    /// Whether a tile under way was asked for.
    fn is_asked(&self, id: TileId) -> bool {
        self.under_way.get(&id).is_some_and(|load| load.is_asked)
    }

    /// The server did not give a tile.
    fn meet(&mut self, id: TileId, problem: Problem) {
        // Many tiles meet the same problem; it is told when the first of them does.
        if self.troubled.is_empty() {
            self.problems.push(problem);
        }
        self.troubled.insert(id);
    }

    /// Stops all that is under way.
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
