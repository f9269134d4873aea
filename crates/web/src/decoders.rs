//! The page's side of the workers that decode tiles.

use std::{cell::RefCell, collections::BTreeMap};

use corniche_geom::TileId;
use corniche_tileset::Sections;
use corniche_viewer::tiles::{LoadTileError, TileDecoder, TileGeometry};
use futures_channel::oneshot;
use js_sys::{Array, Object, Reflect, Uint8Array};
use wasm_bindgen::{JsCast as _, JsValue, prelude::wasm_bindgen};

use crate::{
    host::Host,
    problem::{json, object, thrown},
};

/// Pending jobs of workers.
#[derive(Default)]
struct Jobs {
    last: u32,
    under_way: BTreeMap<u32, Job>,
}

struct Job {
    host: Host,
    worker: u32,
    answer: oneshot::Sender<Result<Uint8Array, String>>,
}

impl Job {
    fn is_of(&self, host: &Host, worker: u32) -> bool {
        self.worker == worker && Object::is(self.host.as_ref(), host.as_ref())
    }
}

thread_local! {
    /// The jobs of all maps of the page.
    static JOBS: RefCell<Jobs> = RefCell::default();
}

/// The parts of tiles that are read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct DecodedParts {
    /// The [`TileDecoder`] as JSON, as workers receive it.
    decoder: String,
    /// The sections that the decoder needs.
    pub(crate) sections: Sections,
}

impl DecodedParts {
    /// The parts that a decoder reads.
    pub(crate) fn from_decoder(decoder: &TileDecoder) -> Self {
        Self { decoder: json(decoder), sections: decoder.sections() }
    }
}

/// The workers of one map.
pub(crate) struct Decoders {
    host: Host,
    workers: u32,
}

impl Decoders {
    /// Sends the metadata of the tiles' package to the workers.
    pub(crate) fn new(host: Host, metadata: &[u8]) -> Self {
        let workers = host.workers().max(1);
        for worker in 0..workers {
            let message = object(&[("metadata", Uint8Array::from(metadata).into())]);
            host.post(worker, &message, &Array::new());
        }
        Self { host, workers }
    }

    /// Decodes a tile in a worker.
    ///
    /// # Errors
    /// When the tile is corrupt, or its worker failed.
    pub(crate) async fn decode(
        &self,
        payload: Option<Vec<u8>>,
        id: TileId,
        reading: &DecodedParts,
    ) -> Result<TileGeometry, LoadTileError> {
        let failed = |reason: String| LoadTileError { id, source: reason.into() };
        let (answer, got) = oneshot::channel();
        let worker = self.least_busy();
        let job = JOBS.with_borrow_mut(|jobs| {
            jobs.last = jobs.last.wrapping_add(1);
            let job = Job { host: self.host.clone(), worker, answer };
            jobs.under_way.insert(jobs.last, job);
            jobs.last
        });
        let transfer = Array::new();
        let payload = payload.map_or(JsValue::NULL, |bytes| {
            let bytes = Uint8Array::from(&bytes[..]);
            transfer.push(&bytes.buffer());
            bytes.into()
        });
        let (z, x, y) = id.into();
        let message = object(&[
            ("job", job.into()),
            ("decoder", reading.decoder.as_str().into()),
            ("z", z.into()),
            ("x", x.into()),
            ("y", y.into()),
            ("payload", payload),
        ]);
        self.host.post(worker, &message, &transfer);
        let bytes =
            got.await.unwrap_or_else(|_| Err("the map was closed".to_owned())).map_err(failed)?;
        TileGeometry::from_bytes(&bytes.to_vec()).map_err(|error| failed(error.to_string()))
    }

    /// The worker with the fewest jobs; a job counts until its answer arrives, whether a caller
    /// waits for it or not.
    fn least_busy(&self) -> u32 {
        let jobs_of = |worker: &u32| {
            JOBS.with_borrow(|jobs| {
                jobs.under_way.values().filter(|job| job.is_of(&self.host, *worker)).count()
            })
        };
        (0..self.workers).min_by_key(jobs_of).unwrap_or(0)
    }
}

/// Handles the answer of a worker; call this with every message that a worker posts.
#[wasm_bindgen]
pub fn decoded(message: &JsValue) {
    let field = |name: &str| Reflect::get(message, &name.into()).unwrap_or(JsValue::UNDEFINED);
    let Some(number) = field("job").as_f64() else { return };
    let Some(job) = JOBS.with_borrow_mut(|jobs| jobs.under_way.remove(&(number as u32))) else {
        return;
    };
    let answer = match field("tile").dyn_into::<Uint8Array>() {
        Ok(tile) => Ok(tile),
        Err(_) => Err(field("error").as_string().unwrap_or_else(|| thrown(message))),
    };
    // Sending fails if nobody waits any more.
    let _ = job.answer.send(answer);
}

/// Handles the permanent failure of a worker of a map: its jobs are reported as failed.
#[wasm_bindgen]
pub fn worker_failed(host: &Host, worker: u32, why: &str) {
    let failed: Vec<Job> = JOBS.with_borrow_mut(|jobs| {
        let all = jobs.under_way.iter();
        let lost = all.filter(|(_, job)| job.is_of(host, worker)).map(|(number, _)| *number);
        let lost: Vec<u32> = lost.collect();
        lost.iter().filter_map(|number| jobs.under_way.remove(number)).collect()
    });
    for job in failed {
        let _ = job.answer.send(Err(format!("a worker failed: {why}")));
    }
}
