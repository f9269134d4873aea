//! A package on a web server, read by range requests, with a cache of its own.

use std::{
    cell::{Cell, RefCell},
    rc::Rc,
};

use corniche_live::{RangeCache, merged_ranges};
use corniche_tileset::{ByteSource, SourceError};
use futures_channel::oneshot;
use wasm_bindgen_futures::spawn_local;
use web_sys::AbortController;

use crate::{
    fetch::{UNREACHABLE, diagnosed, range, sent},
    host::{Host, pause},
    problem::Problem,
};

/// The number of tries of a request that failed in transit.
const TRIES: u32 = 3;

/// The pause before a retry.
const REST_MS: f64 = 300.0;

/// Whether the same request may succeed a moment later.
fn may_pass(problem: &Problem) -> bool {
    matches!(problem.kind, "network" | UNREACHABLE)
}

/// The traffic of the server so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Traffic {
    pub(crate) requests: u32,
    pub(crate) bytes: u64,
}

/// A package on a web server. Clones share what they have read.
#[derive(Clone)]
pub(crate) struct WebSource(Rc<Shared>);

struct Shared {
    address: String,
    file_bytes: u64,
    version: Option<String>,
    cache: RefCell<RangeCache>,
    waiting: RefCell<Vec<Waiting>>,
    traffic: Cell<Traffic>,
    /// The last problem: errors of reading have no kind.
    problem: RefCell<Option<Problem>>,
}

/// A range that was requested and is not being fetched yet.
struct Waiting {
    offset: u64,
    length: u64,
    answer: oneshot::Sender<Result<Vec<u8>, Problem>>,
    ticket: Rc<Ticket>,
}

/// The ticket of a caller that waits for a range. Dropping it means that the caller does not wait
/// any more.
#[derive(Default)]
struct Ticket(RefCell<Option<Rc<Request>>>);

/// A request in progress, for one range or several.
struct Request {
    /// The number of callers that wait for the request.
    wanted: Cell<usize>,
    controller: RefCell<Option<AbortController>>,
}

/// Gives up the ticket when the waiting future is dropped, answered or not.
struct Leaving(Rc<Ticket>);

impl Drop for Leaving {
    fn drop(&mut self) {
        let Some(request) = self.0.0.take() else { return };
        request.wanted.set(request.wanted.get().saturating_sub(1));
        if request.wanted.get() == 0
            && let Some(controller) = request.controller.take()
        {
            controller.abort();
        }
    }
}

impl WebSource {
    /// Takes the beginning of the file, which the page has requested, and requests it again if it
    /// was lost.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub(crate) async fn open(address: &str, host: &Host) -> Result<Self, Problem> {
        let bytes = [0, u64::from(host.head_bytes()).max(1) - 1];
        let mut tries = 0;
        let head = loop {
            tries += 1;
            let head = if tries == 1 {
                sent(host.head(), bytes).await
            } else {
                range(address, bytes, &controller()?.signal()).await
            };
            match head {
                // The map is not needed any more, and its requests were cancelled.
                Err(problem) if host.is_over() => return Err(problem),
                Err(problem) if may_pass(&problem) && tries < TRIES => pause(REST_MS).await,
                Err(problem) => return Err(diagnosed(address, problem).await),
                Ok(head) => break head,
            }
        };
        let traffic = Traffic { requests: tries, bytes: head.bytes.len() as u64 };
        let mut cache = RangeCache::default();
        cache.put(0, head.bytes.into());
        Ok(Self(Rc::new(Shared {
            address: address.to_owned(),
            file_bytes: head.file_bytes,
            version: head.version,
            cache: RefCell::new(cache),
            waiting: RefCell::default(),
            traffic: Cell::new(traffic),
            problem: RefCell::default(),
        })))
    }

    /// The traffic of the server so far.
    pub(crate) fn traffic(&self) -> Traffic {
        self.0.traffic.get()
    }

    /// The length of the file.
    pub(crate) fn file_bytes(&self) -> u64 {
        self.0.file_bytes
    }

    /// Takes the last problem, if there is one.
    pub(crate) fn take_problem(&self) -> Option<Problem> {
        self.0.problem.take()
    }
}

fn controller() -> Result<AbortController, Problem> {
    AbortController::new().map_err(|_| {
        Problem::new("other", "This browser cannot cancel requests.", "Update the browser.")
    })
}

impl Shared {
    /// Sends all waiting requests.
    fn send(self: &Rc<Self>) {
        let waiting = self.waiting.take();
        let ranges: Vec<[u64; 2]> = waiting.iter().map(|one| [one.offset, one.length]).collect();
        let mut waiting: Vec<Option<Waiting>> = waiting.into_iter().map(Some).collect();
        for group in merged_ranges(&ranges) {
            let group: Vec<Waiting> =
                group.into_iter().filter_map(|place| waiting[place].take()).collect();
            let shared = Rc::clone(self);
            spawn_local(async move { shared.fetch(group).await });
        }
    }

    /// Fetches a group of ranges in one request, and answers each of them.
    async fn fetch(&self, mut group: Vec<Waiting>) {
        // Some callers may have stopped waiting since.
        group.retain(|one| !one.answer.is_canceled());
        let Some(first) = group.iter().map(|one| one.offset).min() else { return };
        let end = group.iter().map(|one| one.offset + one.length).max().unwrap_or(first);
        let request =
            Rc::new(Request { wanted: Cell::new(group.len()), controller: RefCell::default() });
        for one in &group {
            one.ticket.0.replace(Some(Rc::clone(&request)));
        }
        let got = self.tried([first, end - 1], &request).await;
        let bytes: Result<Rc<[u8]>, Problem> = got.map(Into::into);
        match &bytes {
            Ok(bytes) => self.cache.borrow_mut().put(first, Rc::clone(bytes)),
            Err(problem) if request.wanted.get() > 0 => {
                self.problem.replace(Some(problem.clone()));
            }
            Err(_) => {}
        }
        for one in group {
            let part = bytes.as_ref().map_err(Clone::clone).map(|bytes| {
                let at = (one.offset - first) as usize;
                bytes[at..at + one.length as usize].to_vec()
            });
            // Sending fails if nobody waits any more.
            let _ = one.answer.send(part);
        }
    }

    /// Fetches the bytes from `first` to `last`, with retries if they were lost in transit.
    async fn tried(&self, [first, last]: [u64; 2], request: &Request) -> Result<Vec<u8>, Problem> {
        let mut tries = 0;
        loop {
            tries += 1;
            let controller = controller()?;
            let signal = controller.signal();
            request.controller.replace(Some(controller));
            let answer = range(&self.address, [first, last], &signal).await;
            request.controller.take();
            let mut traffic = self.traffic.get();
            traffic.requests += 1;
            traffic.bytes += answer.as_ref().map_or(0, |answer| answer.bytes.len() as u64);
            self.traffic.set(traffic);
            match answer {
                // Nobody waits any more, and the request was cancelled.
                Err(problem) if request.wanted.get() == 0 => return Err(problem),
                Err(problem) if may_pass(&problem) && tries < TRIES => pause(REST_MS).await,
                Err(problem) => return Err(diagnosed(&self.address, problem).await),
                Ok(answer)
                    if answer.file_bytes != self.file_bytes || answer.version != self.version =>
                {
                    return Err(Problem::new(
                        "changed",
                        "The file on the server has changed since the map was opened.",
                        "Reload the map.",
                    ));
                }
                Ok(answer) => return Ok(answer.bytes),
            }
        }
    }
}

impl ByteSource for WebSource {
    async fn length(&self) -> Result<u64, SourceError> {
        Ok(self.0.file_bytes)
    }

    async fn read(&self, offset: u64, length: usize) -> Result<Vec<u8>, SourceError> {
        let shared = &self.0;
        if length == 0 {
            return Ok(Vec::new());
        }
        let mut found = shared.cache.borrow_mut().get(offset, length);
        if found.len() == length {
            return Ok(found);
        }
        // The first request ends within a tile: only the missing bytes are requested.
        let (offset, length) = (offset + found.len() as u64, length - found.len());
        let (answer, got) = oneshot::channel();
        let ticket = Rc::new(Ticket::default());
        let is_first = shared.waiting.borrow().is_empty();
        let waiting = Waiting { offset, length: length as u64, answer, ticket: Rc::clone(&ticket) };
        shared.waiting.borrow_mut().push(waiting);
        if is_first {
            let shared = Rc::clone(shared);
            // The requests are sent a microtask later, together with all others of the same turn.
            spawn_local(async move { shared.send() });
        }
        let leaving = Leaving(ticket);
        let got = got.await;
        drop(leaving);
        let dropped = || Err(Problem::new("other", "the request was dropped", ""));
        let rest = got.unwrap_or_else(|_| dropped()).map_err(|problem| SourceError {
            name: shared.address.clone(),
            offset,
            length,
            reason: problem.message,
            may_pass: problem.kind == "network",
        })?;
        found.extend(rest);
        Ok(found)
    }
}
